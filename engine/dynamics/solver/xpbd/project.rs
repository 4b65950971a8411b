//! Converts the displacements by constraints to velocities.

use bevy_ecs::{
    prelude::*,
    schedule::{InternedSystemSet, SystemSet},
    system::SystemState,
};
use bevy_time::Time;

use super::XpbdSolverSystems;
use crate::{
    dynamics::solver::{
        schedule::SubstepSchedule,
        solver_body::{SolverBody, lend::is_asked_for},
    },
    math::AdjustPrecision,
    physics_transform::{PreSolveDeltaPosition, PreSolveDeltaRotation},
};

type Moved<'w, 's> = Query<
    'w,
    's,
    (&'static mut SolverBody, &'static mut PreSolveDeltaPosition, &'static mut PreSolveDeltaRotation),
>;

/// Bodies without components for their displacement.
type Lacking<'w, 's> = Query<'w, 's, Entity, (With<SolverBody>, Without<PreSolveDeltaPosition>)>;

/// Queries of bodies, used while the schedule contains constraints of the app.
#[derive(Resource)]
pub(super) struct PositionSolve {
    moved: SystemState<(Moved<'static, 'static>, Res<'static, Time>)>,
    lacking: SystemState<Lacking<'static, 'static>>,
}

impl FromWorld for PositionSolve {
    fn from_world(world: &mut World) -> Self {
        Self { moved: SystemState::new(world), lacking: SystemState::new(world) }
    }
}

/// Whether the app has systems that change positions.
fn is_used(world: &World) -> bool {
    let schedule = world.get_resource::<Schedules>().and_then(|schedules| schedules.get(SubstepSchedule));
    let Some(schedule) = schedule.filter(|_| is_asked_for(world)) else { return false };
    let has_systems = |set: InternedSystemSet| {
        schedule.graph().systems_in_set(set).is_ok_and(|systems| !systems.is_empty())
    };
    has_systems(XpbdSolverSystems::SolveUserConstraints.intern())
        || has_systems(XpbdSolverSystems::SolveConstraints.intern())
}

/// Before the substeps: gives bodies components for their displacement, if there are constraints.
pub(super) fn prepare_position_solve(world: &mut World) {
    if !is_used(world) {
        world.remove_resource::<PositionSolve>();
        return;
    }
    world.init_resource::<PositionSolve>();
    world.resource_scope(|world, mut solve: Mut<PositionSolve>| {
        let Ok(lacking) = solve.lacking.get(world) else { return };
        for entity in lacking.iter().collect::<Vec<_>>() {
            let pre_solve = (PreSolveDeltaPosition::default(), PreSolveDeltaRotation::default());
            world.entity_mut(entity).insert(pre_solve);
        }
    });
}

/// Before constraints move bodies: stores the displacements.
pub(super) fn record_pre_solve(world: &mut World) {
    if !world.contains_resource::<PositionSolve>() {
        return;
    }
    world.resource_scope(|world, mut solve: Mut<PositionSolve>| {
        let Ok((mut moved, _)) = solve.moved.get_mut(world) else { return };
        for (body, mut position, mut rotation) in &mut moved {
            (position.0, rotation.0) = (body.delta_position, body.delta_rotation);
        }
    });
}

/// After constraints have moved bodies: adds the velocities of these displacements.
pub(super) fn project_velocities(world: &mut World) {
    if !world.contains_resource::<PositionSolve>() {
        return;
    }
    world.resource_scope(|world, mut solve: Mut<PositionSolve>| {
        let Ok((mut moved, time)) = solve.moved.get_mut(world) else { return };
        let dt = time.delta_secs().adjust_precision();
        if dt == 0.0 {
            return;
        }
        for (mut body, position, rotation) in &mut moved {
            if !body.flags.is_dynamic() {
                continue;
            }
            if body.delta_position != position.0 {
                let way = body.delta_position - position.0;
                body.linear_velocity += way / dt;
            }
            if body.delta_rotation != rotation.0 {
                let turn = rotation.0.turn_to(body.delta_rotation);
                body.angular_velocity += turn / dt;
            }
        }
    });
}
