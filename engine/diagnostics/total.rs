//! The duration of whole steps.

use super::{PhysicsDiagnosticsSystems, Within, diagnostic_paths, list, registry::Registered};
use crate::schedule::{PhysicsSchedule, PhysicsStepSystems};
use bevy_app::{App, Plugin};
use bevy_diagnostic::{Diagnostic, DiagnosticPath, Diagnostics, RegisterDiagnostic};
use bevy_ecs::prelude::*;
use bevy_platform::time::Instant;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

/// Counts and times whole steps, in [`PhysicsTotalDiagnostics`].
pub struct PhysicsTotalDiagnosticsPlugin;

impl Plugin for PhysicsTotalDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<Start>();
        list::<PhysicsTotalDiagnostics>(app, Within::Nothing);
        let rest = Diagnostic::new(PhysicsTotalDiagnostics::MISCELLANEOUS.clone());
        app.register_diagnostic(rest.with_suffix("ms"));
        app.world_mut().resource_mut::<Registered>().paths.push(PhysicsTotalDiagnostics::MISCELLANEOUS);
        app.add_systems(
            PhysicsSchedule,
            (
                (|mut start: ResMut<Start>| start.0 = Some(Instant::now()))
                    .before(PhysicsDiagnosticsSystems::Reset)
                    .before(PhysicsStepSystems::First),
                (end_step, write_rest)
                    .chain()
                    .after(PhysicsStepSystems::Last)
                    .before(PhysicsDiagnosticsSystems::WriteDiagnostics),
            ),
        );
    }
}

/// Number and duration of steps.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct PhysicsTotalDiagnostics {
    /// Number of steps since the app started.
    pub step_number: u32,
    /// Duration of the last step: a run of [`PhysicsSchedule`], without reading and writing of `Transform`.
    pub step_time: Duration,
}

diagnostic_paths! {
    PhysicsTotalDiagnostics {
        timer STEP_TIME: "avian/total_step_time" = step_time,
        counter STEP_NUMBER: "avian/step_number" = step_number,
    }
    reset keep
}

impl PhysicsTotalDiagnostics {
    /// `avian/miscellaneous`: path of the time in the last step that no other timer covers, in milliseconds.
    pub const MISCELLANEOUS: &'static DiagnosticPath = &DiagnosticPath::const_new("avian/miscellaneous");
}

/// Keeps both values: the step number grows, and each step overwrites the time.
fn keep(_: ResMut<PhysicsTotalDiagnostics>) {}

/// When the current step began.
#[derive(Resource, Default)]
struct Start(Option<Instant>);

fn end_step(start: Res<Start>, mut total: ResMut<PhysicsTotalDiagnostics>) {
    total.step_number = total.step_number.wrapping_add(1);
    total.step_time = start.0.map_or(Duration::ZERO, |start| start.elapsed());
}

/// Writes the time that no timer covers.
fn write_rest(world: &World, mut diagnostics: Diagnostics) {
    let total = world.resource::<PhysicsTotalDiagnostics>().step_time;
    let rest = total.saturating_sub(world.resource::<Registered>().timed(world));
    diagnostics.add_measurement(PhysicsTotalDiagnostics::MISCELLANEOUS, || rest.as_secs_f64() * 1000.0);
}
