//! System sets of the solver in a step and in a substep.

mod plugin;

pub use plugin::SolverSchedulePlugin;

use bevy_ecs::{prelude::*, schedule::ScheduleLabel};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bevy_time::Time;
use core::time::Duration;

use crate::schedule::{Physics, Substeps};

/// One substep, run [`SubstepCount`] times per step in [`SolverSystems::Substep`], in the order
/// [`Velocity`](crate::dynamics::integrator::IntegrationSystems::Velocity),
/// [`WarmStart`](SubstepSolverSystems::WarmStart),
/// [`SolveConstraints`](SubstepSolverSystems::SolveConstraints),
/// [`Position`](crate::dynamics::integrator::IntegrationSystems::Position),
/// [`Relax`](SubstepSolverSystems::Relax), [`Damping`](SubstepSolverSystems::Damping).
///
/// While the schedule contains only the engine's own systems, without run conditions, one kernel call per
/// substep replaces it, with the same result.
///
/// Systems run one after the other, and an ambiguous order is an error. Within this schedule the generic
/// [`Time`] is [`Time<Substeps>`](Substeps).
#[derive(Debug, Hash, PartialEq, Eq, Clone, ScheduleLabel)]
pub struct SubstepSchedule;

/// System sets of the solver, in this order, in
/// [`PhysicsStepSystems::Solver`](crate::schedule::PhysicsStepSystems::Solver).
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SolverSystems {
    /// Fill the rows of awake bodies.
    PrepareSolverBodies,
    /// Joints are prepared.
    PrepareJoints,
    /// Build the rows of touching contacts.
    PrepareContactConstraints,
    /// Before the substeps.
    PreSubstep,
    /// [`SubstepSchedule`] runs [`SubstepCount`] times.
    Substep,
    /// After the substeps.
    PostSubstep,
    /// Apply restitution.
    Restitution,
    /// Write the rows of bodies to components.
    Finalize,
    /// Store contact impulses, for the warm start of the next step.
    StoreContactImpulses,
}

/// The former name of [`SolverSystems`].
#[deprecated(since = "0.4.0", note = "renamed to `SolverSystems`")]
pub type SolverSet = SolverSystems;

/// System sets of the solver in a substep, in [`SubstepSchedule`].
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum SubstepSolverSystems {
    /// Apply the impulses of the last substep or step.
    WarmStart,
    /// Solve velocities with soft bias, which reduces overlap and joint errors.
    SolveConstraints,
    /// Solve velocities without bias, so that correcting positions adds no velocity.
    Relax,
    /// Joint damping.
    Damping,
}

/// The former name of [`SubstepSolverSystems`].
#[deprecated(since = "0.4.0", note = "renamed to `SubstepSolverSystems`")]
pub type SubstepSolverSet = SubstepSolverSystems;

/// Number of substeps per step. 6 by default. 0 counts as 1.
///
/// Contacts are computed once per step, and the solver runs once per substep. More substeps make stacks and
/// joints stiffer, and cost only solver time.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_app::App;
/// # let mut app = App::new();
/// app.insert_resource(SubstepCount(12));
/// ```
#[derive(Debug, Reflect, Resource, Clone, Copy, PartialEq, Eq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Resource, Default, PartialEq)]
pub struct SubstepCount(pub u32);

impl Default for SubstepCount {
    fn default() -> Self {
        Self(6)
    }
}

/// The length of each of `count` substeps in a step of length `step`.
///
/// Rounded down to nanoseconds, the unit of [`Duration`]. The solver uses the quotient of seconds.
pub(crate) fn substep_delta(step: Duration, count: SubstepCount) -> Duration {
    step / count.0.max(1)
}

/// Advances [`Time<Substeps>`](Substeps) to the end of the first substep, so systems before the substeps know
/// their length. Each later substep advances it.
pub(crate) fn start_substep_clock(
    mut substeps: ResMut<Time<Substeps>>,
    physics: Res<Time<Physics>>,
    count: Res<SubstepCount>,
) {
    advance_substep(&mut substeps, substep_delta(physics.delta(), *count));
}

/// Advances the substep clock by one substep, at most to the maximum time.
pub(crate) fn advance_substep(clock: &mut Time<Substeps>, delta: Duration) {
    let left = Duration::MAX - clock.elapsed();
    clock.advance_by(delta.min(left));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_substeps_are_one() {
        let step = Duration::from_millis(12);
        assert_eq!(substep_delta(step, SubstepCount(0)), step);
        assert_eq!(substep_delta(step, SubstepCount(1)), step);
        assert_eq!(substep_delta(step, SubstepCount(6)), Duration::from_millis(2));
    }
}
