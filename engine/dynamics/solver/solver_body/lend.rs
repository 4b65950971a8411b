//! Copies between the rows of bodies and their [`SolverBody`], if systems of the app query it.
//!
//! Rows are authoritative while the solver runs, components while systems of the app run. Therefore each of
//! the solver's systems in a substep begins with [`take_back`] and ends with [`lend_again`]. Both do nothing
//! if the component is not registered in the world: then no system of the app queries it.

use bevy_ecs::{prelude::*, schedule::ScheduleLabel, system::SystemState};
use kernel::{data::BitSet, solver::BodyRow, table::NONE};

use super::{SolverBody, SolverBodyFlags, SolverBodyInertia, dim::is_gyroscopic};
use crate::{
    dynamics::{
        ids::BodyId,
        quarantine::quarantine,
        rigid_body::{RigidBodyQueryReadOnly, RigidBodyQueryReadOnlyItem},
        solver::{
            schedule::SubstepSchedule,
            step_solver::{OwnSubstepSystems, StepSolver},
        },
        tables::Bodies,
    },
    physics_transform::{PreSolveDeltaPosition, PreSolveDeltaRotation},
};

/// Bodies with the component, and the tables of their rows.
type LentBodies<'w, 's> = (
    Query<'w, 's, (Entity, &'static BodyId, &'static mut SolverBody)>,
    ResMut<'w, StepSolver>,
    Res<'w, Bodies>,
);

/// Bodies that receive the component.
type Borrowers<'w, 's> =
    (Query<'w, 's, (RigidBodyQueryReadOnly, Has<SolverBody>)>, Res<'w, StepSolver>, Res<'w, Bodies>);

/// Queries and buffers, reused between calls.
#[derive(Resource)]
pub(crate) struct Lending {
    lent: SystemState<LentBodies<'static, 'static>>,
    borrowers: SystemState<Borrowers<'static, 'static>>,
    turned: BitSet,
}

impl FromWorld for Lending {
    fn from_world(world: &mut World) -> Self {
        Self { lent: SystemState::new(world), borrowers: SystemState::new(world), turned: BitSet::new() }
    }
}

/// Whether a system of the app queries the state of bodies.
pub(crate) fn is_asked_for(world: &World) -> bool {
    let components = world.components();
    components.component_id::<SolverBody>().is_some()
        || components.component_id::<SolverBodyInertia>().is_some()
}

/// Builds the substep schedule if the app changed it. This makes its systems known before they run.
fn build_substeps(world: &mut World) {
    let own = world.get_resource::<OwnSubstepSystems>();
    let schedule = world.get_resource::<Schedules>().and_then(|schedules| schedules.get(SubstepSchedule));
    let (Some(own), Some(schedule)) = (own, schedule) else { return };
    if schedule.systems().is_err() && !own.are_all_of(schedule) {
        // Running the schedule reports the error.
        world.schedule_scope(SubstepSchedule.intern(), |world, schedule| _ = schedule.initialize(world));
    }
}

/// At the start of the solver: gives all bodies with a row the components with the current state, and removes
/// the components from all other bodies.
pub(crate) fn lend_bodies(world: &mut World) {
    build_substeps(world);
    if !is_asked_for(world) {
        return;
    }
    end_lending(world);
    world.init_resource::<Lending>();
    world.resource_scope(|world, mut lending: Mut<Lending>| {
        let mut filled = Vec::new();
        {
            let Ok((bodies, solver, tables)) = lending.borrowers.get(world) else { return };
            for (i, &id) in tables.listed.iter().enumerate() {
                let row = &solver.kernel.bodies.rows[1 + i];
                if let Ok((body, has_state)) = bodies.get(tables.entities[id as usize]) {
                    filled.push((
                        body.entity,
                        has_state,
                        SolverBody::of_row(row, flags(&body)),
                        inertia(&body),
                    ));
                }
            }
        }
        for (entity, has_state, state, inertia) in filled {
            let mut body = world.entity_mut(entity);
            match body.get_components_mut::<(&mut SolverBody, &mut SolverBodyInertia)>() {
                Ok((mut old_state, mut old_inertia)) if has_state => {
                    (*old_state, *old_inertia) = (state, inertia);
                }
                _ => _ = body.insert((state, inertia)),
            }
        }
    });
}

/// Removes the components from sleeping bodies and bodies without a row.
pub(crate) fn end_lending(world: &mut World) {
    if !is_asked_for(world) {
        return;
    }
    world.init_resource::<Lending>();
    world.resource_scope(|world, mut lending: Mut<Lending>| {
        let Ok((lent, _, tables)) = lending.lent.get_mut(world) else { return };
        let is_over = |id: u32| id == NONE || !tables.table[id].awake;
        let over: Vec<Entity> =
            lent.iter().filter(|(_, id, _)| is_over(id.0)).map(|(entity, ..)| entity).collect();
        for entity in over {
            world.entity_mut(entity).remove::<(
                SolverBody,
                SolverBodyInertia,
                PreSolveDeltaPosition,
                PreSolveDeltaRotation,
            )>();
        }
    });
}

/// Writes the changes by systems of the app to the rows. A body with a state that is not finite stops and is
/// disabled.
pub(crate) fn take_back(world: &mut World) {
    if !is_asked_for(world) || !world.contains_resource::<Lending>() {
        return;
    }
    world.resource_scope(|world, mut lending: Mut<Lending>| {
        let Lending { lent, turned, .. } = &mut *lending;
        turned.clear();
        let mut is_any_changed = false;
        let mut lost = Vec::new();
        {
            let Ok((lent, mut solver, tables)) = lent.get_mut(world) else { return };
            let rows = &mut solver.kernel.bodies;
            for (entity, id, body) in &lent {
                let row = if id.0 == NONE { 0 } else { tables.table.row(id.0) };
                if row == 0 {
                    continue;
                }
                let old = &mut rows.rows[row as usize];
                if body.is_of_row(old) {
                    continue;
                }
                is_any_changed = true;
                let new = body.to_row();
                if old.delta().1 != new.delta().1 {
                    turned.insert(row);
                }
                if is_finite(&new) {
                    *old = new;
                } else {
                    lost.push((row, entity, tables.table.frame(id.0)));
                }
            }
            for (row, ..) in &lost {
                rows.set_at_rest(*row as usize);
            }
            rows.restart_spins(turned);
            if is_any_changed {
                solver.kernel.follow_changes();
            }
        }
        lost.sort_unstable_by_key(|(row, ..)| *row);
        for (_, entity, frame) in lost {
            if let Some(mut body) = world.get_mut::<SolverBody>(entity) {
                *body = SolverBody { flags: body.flags, ..SolverBody::DUMMY };
            }
            quarantine(entity, Some(frame), &mut world.commands());
        }
        world.flush();
    });
}

/// Writes the rows to the components.
pub(crate) fn lend_again(world: &mut World) {
    if !is_asked_for(world) || !world.contains_resource::<Lending>() {
        return;
    }
    world.resource_scope(|world, mut lending: Mut<Lending>| {
        let Ok((mut lent, solver, tables)) = lending.lent.get_mut(world) else { return };
        for (_, id, mut body) in &mut lent {
            let row = if id.0 == NONE { 0 } else { tables.table.row(id.0) };
            if row != 0 {
                *body = SolverBody::of_row(&solver.kernel.bodies.rows[row as usize], body.flags);
            }
        }
    });
}

fn is_finite(row: &BodyRow) -> bool {
    let ((v, w), (way, turn)) = (row.velocity(), row.delta());
    v.is_finite() && w.is_finite() && way.is_finite() && turn.is_finite()
}

fn flags(body: &RigidBodyQueryReadOnlyItem) -> SolverBodyFlags {
    let locks = body.locked_axes.copied().unwrap_or_default();
    let mut flags = SolverBodyFlags(u32::from(locks.to_kernel().0));
    flags.set(SolverBodyFlags::IS_KINEMATIC, body.rb.is_kinematic());
    flags
        .set(SolverBodyFlags::GYROSCOPIC_MOTION, body.rb.is_dynamic() && is_gyroscopic(body.angular_inertia));
    flags
}

fn inertia(body: &RigidBodyQueryReadOnlyItem) -> SolverBodyInertia {
    SolverBodyInertia::new(
        body.mass.inverse(),
        body.effective_global_angular_inertia().inverse(),
        body.locked_axes.copied().unwrap_or_default(),
        body.dominance.map_or(0, |dominance| dominance.0),
        body.rb.is_dynamic(),
    )
}
