//! Writes rows to components, and updates sleep timers.

use bevy_ecs::{
    change_detection::ContiguousMut,
    prelude::*,
    system::{SystemChangeTick, SystemParam},
};
use bevy_time::Time;
use kernel::{
    math::WorldPose,
    solver::{BodyRows, Solver},
    table::{BodyPose, NONE},
    thread_pool::ThreadPool,
};

use crate::{
    columns::{Column, PIECE, Put, is_change_tracked},
    dynamics::{
        ids::BodyId,
        integrator::CustomPositionIntegration,
        quarantine::{is_finite, quarantine},
        rigid_body::{AngularVelocity, LinearVelocity, RigidBodyDisabled, sleeping::SleepTimer},
        solver::{diagnostics::SolverDiagnostics, substeps::StepSolver},
        tables::{Bodies, is_minority},
    },
    math::{angular_from_kernel, vector_from_kernel},
    physics_transform::{Position, Rotation, pose_from_kernel, said_pose, world_pose},
    scan::{IN_TABLES, Since},
    schedule::Physics,
    threads::Threads,
};

/// Components that receive a body's motion.
type Output = (
    &'static BodyId,
    &'static mut Position,
    &'static mut Rotation,
    &'static mut LinearVelocity,
    &'static mut AngularVelocity,
    Option<&'static mut SleepTimer>,
);

/// Components that show whether the app moved a body.
type Watched = (Entity, Ref<'static, Position>, Ref<'static, Rotation>);

/// Queries for poses that the app changed within the step.
#[derive(SystemParam)]
pub(crate) struct MovedWithin<'w, 's> {
    watched: Query<'w, 's, Watched, With<BodyId>>,
    ids: Query<'w, 's, &'static BodyId>,
    bodies: ResMut<'w, Bodies>,
}

impl MovedWithin<'_, '_> {
    /// Records the bodies with a row whose pose changed since a tick, if `differs` holds for the previous and
    /// the current pose of the components.
    fn note(&mut self, since: Since, differs: impl Fn(&WorldPose, &WorldPose) -> bool) {
        let Bodies { table, seen, entities, listed, moved_within, .. } = &mut *self.bodies;
        let mut note = |entity: Entity, position: Position, rotation: Rotation| {
            let id = self.ids.get(entity).map_or(NONE, |id| id.0);
            let said = said_pose(&position, &rotation);
            if id != NONE && table.row(id) != 0 && differs(&seen[id as usize], &said) {
                moved_within.push((id, position, rotation));
            }
        };
        if is_minority(listed.len(), [self.watched.iter().size_hint()]) {
            let some = listed.iter().map(|id| entities[*id as usize]);
            for (entity, position, rotation) in self.watched.iter_many(some) {
                if since.is_new(position.last_changed()) || since.is_new(rotation.last_changed()) {
                    note(entity, *position, *rotation);
                }
            }
            return;
        }
        for (entities, position, rotation) in self.watched.contiguous_iter().expect(IN_TABLES) {
            let columns = [position.changed_ticks_slice(), rotation.changed_ticks_slice()];
            since.rows(columns, |row| note(entities[row], position[row], rotation[row]));
        }
    }
}

/// Records the awake bodies whose pose the app changed since poses were read for this step.
pub(crate) fn note_moved_within(mut moved: MovedWithin, system: SystemChangeTick) {
    moved.bodies.moved_within.clear();
    let since = Since::new(moved.bodies.read, system);
    moved.note(since, |seen, said| seen != said);
    moved.bodies.read = system.this_run();
}

/// Records awake bodies whose pose the app changed while bodies were finished. Their previous pose is
/// unknown.
pub(crate) fn note_moved_late(mut moved: MovedWithin, system: SystemChangeTick) {
    let since = Since::new(moved.bodies.read, system);
    moved.note(since, |_, _| true);
}

/// Keeps bodies that the app moved within the step at the app's pose, plus their displacement in the step.
/// The tables keep the simulated pose: the next step treats the difference like any other change by the app.
pub(crate) fn keep_moved_within(
    mut poses: Query<(&mut Position, &mut Rotation)>,
    solver: Res<StepSolver>,
    mut bodies: ResMut<Bodies>,
) {
    let Bodies { table, entities, moved_within, .. } = &mut *bodies;
    for (id, position, rotation) in moved_within.drain(..) {
        let row = table.row(id);
        let body = &solver.kernel.bodies.rows[row as usize];
        let Ok(mut pose) = poses.get_mut(entities[id as usize]) else { continue };
        let from = world_pose(&position, &rotation);
        let (way, turn) = body.delta();
        let center = from.transform(table[id].local_center) + way.to_world();
        let moved =
            BodyPose { center, rotation: turn.mul(from.rotation).renormalized(), ..Default::default() };
        let moved = moved.frame(table[id].local_center);
        // A pose that is not finite is left unchanged, and the next step refuses it.
        let (position, rotation) =
            if body.is_moved() && is_finite(&moved) { pose_from_kernel(moved) } else { (position, rotation) };
        pose.0.set_if_neq(position);
        pose.1.set_if_neq(rotation);
        table[id].sleep_timer = 0.0;
    }
}

/// Adds the displacement of each awake body to its pose, and updates sleep timers.
///
/// A body with a result that is not finite keeps its pose, stops, and is disabled with one warning. This
/// prevents NaN from spreading.
pub(crate) fn finish_bodies(
    own: Query<&BodyId, (With<CustomPositionIntegration>, Without<RigidBodyDisabled>)>,
    (mut solver, threads): (ResMut<StepSolver>, Res<Threads>),
    time: Res<Time<Physics>>,
    mut bodies: ResMut<Bodies>,
    mut diagnostics: ResMut<SolverDiagnostics>,
    mut commands: Commands,
) {
    let start = bevy_platform::time::Instant::now();
    let dt = time.delta_secs();
    let kept = own.iter().filter_map(|id| keep_in_place(id.0, &mut solver.kernel, &bodies, dt));
    let kept: Vec<_> = kept.collect();
    let Bodies { table, seen, listed, entities, .. } = &mut *bodies;
    let mut lost = solver.kernel.finish(table, listed, seen, dt, &threads.pool);
    for (id, timer) in kept {
        table[id].sleep_timer = timer;
    }
    lost.sort_unstable();
    for row in lost {
        let id = listed[row as usize - 1];
        solver.kernel.bodies.set_at_rest(row as usize);
        quarantine(entities[id as usize], Some(table.frame(id)), &mut commands);
    }
    diagnostics.finalize += start.elapsed();
}

/// Writes pose and velocity of each awake body if they changed.
pub(crate) fn scatter_bodies(
    mut outputs: Query<Output, Without<RigidBodyDisabled>>,
    (solver, threads): (Res<StepSolver>, Res<Threads>),
    mut bodies: ResMut<Bodies>,
    system: SystemChangeTick,
    mut diagnostics: ResMut<SolverDiagnostics>,
) {
    let start = bevy_platform::time::Instant::now();
    bodies.written = system.this_run();
    let Bodies { listed, entities, some, .. } = &mut *bodies;
    let looks_up = is_minority(listed.len(), [outputs.iter().size_hint()]) || is_change_tracked();
    let mut some = core::mem::take(some);
    if looks_up {
        some.clear();
        some.extend(listed.iter().map(|id| entities[*id as usize]));
    }
    let results = Results { bodies: &bodies, rows: &solver.kernel.bodies };
    if looks_up {
        let mut found = outputs.iter_many_mut(&*some);
        while let Some((id, position, rotation, linear, angular, timer)) = found.fetch_next() {
            results.put(*id, (position, rotation), (linear, angular), timer);
        }
    } else {
        for table in outputs.contiguous_iter_mut().expect(IN_TABLES) {
            put_table(table, &results, &threads.pool);
        }
    }
    bodies.some = some;
    diagnostics.finalize += start.elapsed();
}

/// Resets the displacement of a body with [`CustomPositionIntegration`]. Returns its id and its sleep timer,
/// which depends on its velocity.
fn keep_in_place(id: u32, solver: &mut Solver, bodies: &Bodies, dt: f32) -> Option<(u32, f32)> {
    let row = if id == NONE { 0 } else { bodies.table.row(id) };
    if row == 0 {
        return None;
    }
    let (v, w) = solver.bodies.rows[row as usize].velocity();
    solver.bodies.reset_delta(row);
    let body = &bodies.table[id];
    let rests = body.rest_speed.admits(v.length_squared() * dt * dt, w.length_squared() * dt * dt, dt);
    Some((id, if rests { body.sleep_timer + dt } else { 0.0 }))
}

/// Writes the bodies of one table of components, on all workers.
#[expect(clippy::type_complexity, reason = "an item of a query")]
fn put_table(
    (mut ids, position, rotation, linear, angular, timer): (
        &[BodyId],
        ContiguousMut<Position>,
        ContiguousMut<Rotation>,
        ContiguousMut<LinearVelocity>,
        ContiguousMut<AngularVelocity>,
        Option<ContiguousMut<SleepTimer>>,
    ),
    results: &Results,
    pool: &ThreadPool,
) {
    let mut ticks = (None, None, None, None, None);
    let mut position = Column::new(position, &mut ticks.0);
    let mut rotation = Column::new(rotation, &mut ticks.1);
    let mut linear = Column::new(linear, &mut ticks.2);
    let mut angular = Column::new(angular, &mut ticks.3);
    let mut timer = timer.map(|timer| Column::new(timer, &mut ticks.4));
    let pieces = core::iter::from_fn(|| {
        let ids = ids.split_off(..PIECE.min(ids.len())).filter(|ids| !ids.is_empty())?;
        let timer = timer.as_mut().map(Column::cut);
        Some((ids, position.cut(), rotation.cut(), linear.cut(), angular.cut(), timer))
    });
    pool.each(pieces, |(ids, position, rotation, linear, angular, timer)| {
        let poses = position.slots().zip(rotation.slots());
        let velocities = linear.slots().zip(angular.slots());
        let mut timers = timer.map(Column::slots);
        for ((id, pose), velocity) in ids.iter().zip(poses).zip(velocities) {
            let timer = timers.as_mut().and_then(Iterator::next);
            results.put(*id, pose, velocity, timer);
        }
    });
}

/// The computed motion of bodies.
struct Results<'a> {
    bodies: &'a Bodies,
    rows: &'a BodyRows,
}

impl Results<'_> {
    /// Writes the results of a body, if it has a row.
    #[inline(always)]
    fn put(
        &self,
        id: BodyId,
        (position, rotation): (impl Put<Position>, impl Put<Rotation>),
        (linear, angular): (impl Put<LinearVelocity>, impl Put<AngularVelocity>),
        timer: Option<impl Put<SleepTimer>>,
    ) {
        let Self { bodies: Bodies { table, seen, .. }, rows } = self;
        let row = if id.0 == NONE { 0 } else { table.row(id.0) };
        if row == 0 {
            return;
        }
        let body = &rows.rows[row as usize];
        if row >= rows.first_dynamic() {
            let (v, w) = body.velocity();
            linear.put(LinearVelocity(vector_from_kernel(v)));
            angular.put(AngularVelocity(angular_from_kernel(w)));
        }
        if body.is_moved() {
            let (at, turned) = pose_from_kernel(seen[id.0 as usize]);
            position.put(at);
            rotation.put(turned);
        }
        if let Some(timer) = timer {
            timer.put(SleepTimer(table[id.0].sleep_timer));
        }
    }
}
