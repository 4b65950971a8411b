//! Paths of timers and counters.

/// Defines the paths of a resource's timers and counters as constants, and implements
/// [`PhysicsDiagnostics`](super::PhysicsDiagnostics).
///
/// `reset` is the system that prepares the resource for a step.
macro_rules! diagnostic_paths {
    (
        $type:ident { $(timer $TIMER:ident: $timer:literal = $duration:ident,)* $(counter $COUNTER:ident: $counter:literal = $count:ident,)* }
        reset $reset:path
    ) => {
        impl $type {
            $(
                #[doc = concat!("`", $timer, "`: path of [`", stringify!($duration), "`](Self::", stringify!($duration), "), in milliseconds.")]
                pub const $TIMER: &'static $crate::diagnostics::DiagnosticPath =
                    &$crate::diagnostics::DiagnosticPath::const_new($timer);
            )*
            $(
                #[doc = concat!("`", $counter, "`: path of [`", stringify!($count), "`](Self::", stringify!($count), ").")]
                pub const $COUNTER: &'static $crate::diagnostics::DiagnosticPath =
                    &$crate::diagnostics::DiagnosticPath::const_new($counter);
            )*
        }

        impl $crate::diagnostics::PhysicsDiagnostics for $type {
            fn timer_paths(&self) -> Vec<(&'static $crate::diagnostics::DiagnosticPath, core::time::Duration)> {
                vec![$((Self::$TIMER, self.$duration)),*]
            }

            fn counter_paths(&self) -> Vec<(&'static $crate::diagnostics::DiagnosticPath, u32)> {
                vec![$((Self::$COUNTER, self.$count)),*]
            }

            fn reset(diagnostics: bevy_ecs::prelude::ResMut<Self>) {
                $reset(diagnostics);
            }
        }
    };
}
pub(crate) use diagnostic_paths;
