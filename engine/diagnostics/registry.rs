//! The list of all timers and counters.

use crate::schedule::{PhysicsSchedule, PhysicsStepSystems};
use bevy_app::App;
use bevy_diagnostic::DiagnosticPath;
use bevy_ecs::{component::Mutable, prelude::*};
use core::{any::TypeId, time::Duration};

/// Sets for systems of diagnostics, in [`PhysicsSchedule`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum PhysicsDiagnosticsSystems {
    /// Resets timers and counters, before the step.
    Reset,
    /// Writes timers and counters to Bevy's `DiagnosticsStore`, after the step.
    WriteDiagnostics,
}

/// A resource with timers and counters, each with a path for Bevy's diagnostics.
pub trait PhysicsDiagnostics: Default + Resource<Mutability = Mutable> {
    /// Paths and values of the timers. They are written in milliseconds.
    fn timer_paths(&self) -> Vec<(&'static DiagnosticPath, Duration)> {
        Vec::new()
    }

    /// Paths and values of the counters.
    fn counter_paths(&self) -> Vec<(&'static DiagnosticPath, u32)> {
        Vec::new()
    }

    /// Prepares the resource for a step. The default implementation resets all values.
    fn reset(mut physics_diagnostics: ResMut<Self>) {
        *physics_diagnostics = Self::default();
    }

    /// Writes all values to Bevy's `DiagnosticsStore`.
    #[cfg(feature = "bevy_diagnostic")]
    fn write_diagnostics(physics_diagnostics: Res<Self>, mut diagnostics: bevy_diagnostic::Diagnostics) {
        for (path, duration) in physics_diagnostics.timer_paths() {
            diagnostics.add_measurement(path, || duration.as_secs_f64() * 1000.0);
        }
        for (path, count) in physics_diagnostics.counter_paths() {
            diagnostics.add_measurement(path, || f64::from(count));
        }
    }
}

/// Adds timers and counters to an app.
pub trait AppDiagnosticsExt {
    /// Adds the resource `T`, resets it before each step, and writes it to Bevy's diagnostics after each step
    /// if `PhysicsDiagnosticsPlugin` is added, before or after this call. A second call has no effect.
    fn register_physics_diagnostics<T: PhysicsDiagnostics>(&mut self);
}

impl AppDiagnosticsExt for App {
    fn register_physics_diagnostics<T: PhysicsDiagnostics>(&mut self) {
        if list::<T>(self, Within::Nothing) {
            self.add_systems(PhysicsSchedule, T::reset.in_set(PhysicsDiagnosticsSystems::Reset));
        }
    }
}

/// The registered types. They cost nothing unless a plugin writes them.
#[derive(Resource, Default)]
pub(super) struct Registered {
    types: Vec<TypeId>,
    /// The sum of the timers of each type whose timers cover parts of a step.
    timers: Vec<fn(&World) -> Duration>,
    #[cfg(feature = "bevy_diagnostic")]
    pub(super) writers: Writers,
    /// The paths that are written, in the order of registration.
    #[cfg(feature = "bevy_diagnostic")]
    pub(super) paths: Vec<&'static DiagnosticPath>,
}

#[cfg(feature = "bevy_diagnostic")]
impl Registered {
    /// Sum of all timers of the last step.
    pub(super) fn timed(&self, world: &World) -> Duration {
        self.timers.iter().map(|timed| timed(world)).sum()
    }
}

/// Sum of the timers of one type.
fn timed<T: PhysicsDiagnostics>(world: &World) -> Duration {
    let resource = world.get_resource::<T>();
    resource.map_or(Duration::ZERO, |timers| timers.timer_paths().iter().map(|(_, time)| *time).sum())
}

/// Whether the timers of a type cover parts of a step.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Within {
    /// The timers cover parts of a step that no other timer covers.
    Step,
    /// The timers do not count towards the step.
    Nothing,
}

/// Adds the systems that write each registered type.
#[cfg(feature = "bevy_diagnostic")]
#[derive(Default)]
pub(super) struct Writers {
    pub(super) list: Vec<fn(&mut App)>,
    pub(super) are_added: bool,
}

/// The list of registered types. The first call adds the list and orders the sets.
pub(super) fn registered(app: &mut App) -> Mut<'_, Registered> {
    if !app.world().contains_resource::<Registered>() {
        app.init_resource::<Registered>().configure_sets(
            PhysicsSchedule,
            (
                PhysicsDiagnosticsSystems::Reset.before(PhysicsStepSystems::First),
                PhysicsDiagnosticsSystems::WriteDiagnostics.after(PhysicsStepSystems::Last),
            ),
        );
    }
    app.world_mut().resource_mut::<Registered>()
}

/// Adds the resource `T`, which is reset elsewhere. Returns `false` if it was registered before.
pub(crate) fn list<T: PhysicsDiagnostics>(app: &mut App, within: Within) -> bool {
    app.init_resource::<T>();
    let mut registered = registered(app);
    let id = TypeId::of::<T>();
    if registered.types.contains(&id) {
        return false;
    }
    registered.types.push(id);
    if within == Within::Step {
        registered.timers.push(timed::<T>);
    }
    #[cfg(feature = "bevy_diagnostic")]
    if registered.writers.are_added {
        write::<T>(app);
    } else {
        registered.writers.list.push(write::<T>);
    }
    true
}

/// Adds the system that writes a resource, and registers its paths in Bevy.
#[cfg(feature = "bevy_diagnostic")]
fn write<T: PhysicsDiagnostics>(app: &mut App) {
    use bevy_diagnostic::{Diagnostic, RegisterDiagnostic};

    let names = T::default();
    let timers = names.timer_paths().into_iter().map(|(path, _)| (path, "ms"));
    for (path, suffix) in timers.chain(names.counter_paths().into_iter().map(|(path, _)| (path, ""))) {
        app.register_diagnostic(Diagnostic::new(path.clone()).with_suffix(suffix));
        app.world_mut().resource_mut::<Registered>().paths.push(path);
    }
    app.add_systems(
        PhysicsSchedule,
        T::write_diagnostics.in_set(PhysicsDiagnosticsSystems::WriteDiagnostics),
    );
}
