//! Reads components into body rows, and detects changes by the app.

use bevy_ecs::{change_detection::ContiguousRef, prelude::*, query::QueryData, system::SystemChangeTick};
use bevy_log::warn_once;
use core::ops::Range;
use kernel::{
    math::{AxisLocks, Vector as KernelVector, WorldPose, max},
    solver::{BodyFiller, BodyRow, FilledBody, Limits, MassRow, Motion, SpecialBodies},
    table::{BodyKind, BodyTable, NONE, RestSpeed, Velocity},
};

use crate::{
    columns::pieces,
    dynamics::{
        ids::BodyId,
        integrator::{CustomVelocityIntegration, Gravity},
        quarantine::{is_finite, quarantine},
        rigid_body::{
            AngularDamping, AngularVelocity, Dominance, GravityScale, LinearDamping, LinearVelocity,
            LockedAxes, MaxAngularSpeed, MaxLinearSpeed, RigidBodyDisabled,
            mass_properties::components::{ComputedAngularInertia, ComputedCenterOfMass, ComputedMass},
            sleeping::{SleepThreshold, SleepTimer, SleepingDisabled},
        },
        solver::{config::PhysicsLengthUnit, diagnostics::SolverDiagnostics, substeps::StepSolver},
        tables::{Bodies, Tables, is_minority},
    },
    math::{Scalar, angular_to_kernel, inv_inertia_to_kernel, to_f32, vector_to_kernel},
    physics_transform::{Position, Rotation, said_pose, world_pose},
    scan::{IN_TABLES, Since},
    threads::Threads,
};

/// Pose and velocity of a body, as components.
#[derive(QueryData)]
#[query_data(contiguous(mutable))]
pub(crate) struct StateInput {
    id: &'static BodyId,
    position: &'static Position,
    rotation: &'static Rotation,
    linear_velocity: &'static LinearVelocity,
    angular_velocity: &'static AngularVelocity,
    center: &'static ComputedCenterOfMass,
}

impl<'w, 's> StateInputContiguousItem<'w, 's> {
    /// The body at a row of the table.
    #[inline(always)]
    fn row(&self, i: usize) -> StateInputItem<'w, 's> {
        StateInputItem {
            id: &self.id[i],
            position: &self.position[i],
            rotation: &self.rotation[i],
            linear_velocity: &self.linear_velocity[i],
            angular_velocity: &self.angular_velocity[i],
            center: &self.center[i],
        }
    }
}

/// Components that define a body's row.
#[derive(QueryData)]
#[query_data(contiguous(mutable))]
pub(crate) struct BodyInput {
    entity: Entity,
    id: &'static BodyId,
    linear_velocity: &'static LinearVelocity,
    angular_velocity: &'static AngularVelocity,
    mass: &'static ComputedMass,
    inertia: &'static ComputedAngularInertia,
}

/// Components that few bodies have.
#[derive(QueryData)]
#[query_data(contiguous(mutable))]
pub(crate) struct MotionInput {
    gravity_scale: Option<&'static GravityScale>,
    linear_damping: Option<&'static LinearDamping>,
    angular_damping: Option<&'static AngularDamping>,
    max_speed: Option<&'static MaxLinearSpeed>,
    max_angular_speed: Option<&'static MaxAngularSpeed>,
    locks: Option<&'static LockedAxes>,
    dominance: Option<&'static Dominance>,
    disabled: Has<RigidBodyDisabled>,
    own_velocity: Has<CustomVelocityIntegration>,
}

impl MotionInputItem<'_, '_> {
    /// None of these components.
    const NONE: Self = Self {
        gravity_scale: None,
        linear_damping: None,
        angular_damping: None,
        max_speed: None,
        max_angular_speed: None,
        locks: None,
        dominance: None,
        disabled: false,
        own_velocity: false,
    };
}

impl<'w, 's> BodyInputContiguousItem<'w, 's> {
    /// The body at a row of the table.
    #[inline(always)]
    fn row(&self, i: usize) -> BodyInputItem<'w, 's> {
        BodyInputItem {
            entity: self.entity[i],
            id: &self.id[i],
            linear_velocity: &self.linear_velocity[i],
            angular_velocity: &self.angular_velocity[i],
            mass: &self.mass[i],
            inertia: &self.inertia[i],
        }
    }
}

impl<'w, 's> MotionInputContiguousItem<'w, 's> {
    /// Whether no body of the table has any of these components: cheaper than a check of each body.
    fn is_none(&self) -> bool {
        let speeds = self.max_speed.is_none() && self.max_angular_speed.is_none();
        let damping = self.linear_damping.is_none() && self.angular_damping.is_none();
        let rest = self.gravity_scale.is_none() && self.locks.is_none() && self.dominance.is_none();
        speeds && damping && rest && !self.disabled && !self.own_velocity
    }

    /// The body at a row of the table.
    fn row(&self, i: usize) -> MotionInputItem<'w, 's> {
        MotionInputItem {
            gravity_scale: self.gravity_scale.map(|all| &all[i]),
            linear_damping: self.linear_damping.map(|all| &all[i]),
            angular_damping: self.angular_damping.map(|all| &all[i]),
            max_speed: self.max_speed.map(|all| &all[i]),
            max_angular_speed: self.max_angular_speed.map(|all| &all[i]),
            locks: self.locks.map(|all| &all[i]),
            dominance: self.dominance.map(|all| &all[i]),
            disabled: self.disabled,
            own_velocity: self.own_velocity,
        }
    }
}

/// A finite value of at least 0. Negative values and NaN become 0, infinity becomes the largest number.
fn positive(value: Option<Scalar>) -> f32 {
    match value.map(to_f32) {
        Some(v) if v > 0.0 => v.min(f32::MAX),
        _ => 0.0,
    }
}

/// Gravity for the kernel. A value that is not finite becomes zero, because it would disable all bodies.
fn finite_gravity(gravity: &Gravity) -> KernelVector {
    let vector = vector_to_kernel(gravity.0);
    if vector.is_finite() {
        return vector;
    }
    warn_once!("a gravity of {} is not finite, none is used instead", gravity.0);
    KernelVector::ZERO
}

/// A limit. A missing, negative or NaN limit becomes infinity.
fn limit(value: Option<Scalar>) -> f32 {
    match value.map(to_f32) {
        Some(v) if v >= 0.0 => v,
        _ => f32::INFINITY,
    }
}

fn velocity(linear: &LinearVelocity, angular: &AngularVelocity) -> Velocity {
    Velocity { linear: vector_to_kernel(linear.0), angular: angular_to_kernel(angular.0) }
}

/// Changes of a body by the app since the engine last wrote it.
#[derive(Clone, Copy, Debug, Default)]
struct Change {
    moved: bool,
    pushed: bool,
}

/// Writes a body's components to the table: the pose if it differs from the engine's last write, the centre
/// of mass, and the velocity. A body that is not finite is reset and disabled.
#[inline]
fn read_in(entity: Entity, body: &StateInputItem, tables: &mut Tables, commands: &mut Commands) -> Change {
    let id = body.id.0;
    let Bodies { table: bodies, seen, kept, .. } = &*tables.bodies;
    let velocity = velocity(body.linear_velocity, body.angular_velocity);
    let center = vector_to_kernel(body.center.0);
    let said = said_pose(body.position, body.rotation);
    let asleep = !bodies[id].awake && bodies[id].kind == BodyKind::Dynamic;
    let held = if asleep { kept.get(id as usize) } else { None }.unwrap_or(&bodies.velocities[id as usize]);
    let change = Change { moved: seen[id as usize] != said, pushed: *held != velocity };
    let recentered = bodies[id].local_center != center && center.is_finite();
    if !(change.moved || change.pushed || recentered) {
        return change;
    }
    let frame = world_pose(body.position, body.rotation);
    if !(velocity.linear.is_finite() && velocity.angular.is_finite() && is_finite(&frame)) {
        quarantine(entity, Some(bodies.frame(id)), commands);
        return Change::default();
    }
    tables.bodies.table.set_velocity(id, velocity);
    tables.bodies.seen[id as usize] = said;
    if change.moved || recentered {
        place(id, frame, recentered.then_some(center), tables);
    }
    change
}

/// Moves a body to a pose, with all its colliders.
#[cold]
fn place(id: u32, frame: WorldPose, center: Option<KernelVector>, tables: &mut Tables) {
    let Tables { bodies, colliders, .. } = tables;
    let (bodies, colliders) = (&mut bodies.table, &mut **colliders);
    if let Some(center) = center {
        bodies[id].local_center = center;
    }
    bodies.teleport(id, frame);
    let mut next = bodies[id].first_collider;
    while next != NONE {
        colliders.stale.insert(next);
        colliders.table.update_reach(next, bodies);
        next = colliders.table.next_of_body(next);
    }
}

/// Components that are checked for changes on every body, moving or not.
type Watched = (
    Entity,
    Ref<'static, Position>,
    Ref<'static, Rotation>,
    Ref<'static, LinearVelocity>,
    Ref<'static, AngularVelocity>,
);

/// Applies changes of the app to static and sleeping bodies. A body that the app moved wakes the bodies that
/// it touches, and wakes itself unless it is static.
pub(crate) fn wake_changed(
    watched: Query<Watched, With<BodyId>>,
    states: Query<StateInput>,
    gravity: Res<Gravity>,
    scaled: Query<&BodyId, Changed<GravityScale>>,
    mut tables: Tables,
    mut commands: Commands,
    system: SystemChangeTick,
) {
    let written = tables.bodies.written;
    // Bodies put to sleep in this step keep this velocity and gravity: a level may be spawned asleep.
    let flipped = tables.bodies.table.flipped_set();
    let mut wake = |entity: Entity| {
        let Ok(body) = states.get(entity) else { return };
        let id = body.id.0;
        if id == NONE {
            return;
        }
        // Awake bodies are read later, but a kinematic body may come to rest before that.
        let row = &tables.bodies.table[id];
        if row.awake && row.kind != BodyKind::Kinematic {
            return;
        }
        let change = read_in(entity, &body, &mut tables, &mut commands);
        if change.moved {
            tables.contact_manager().wake_touching(id);
        }
        let kept = flipped.contains(id) && tables.bodies.table[id].kind == BodyKind::Dynamic;
        if change.moved || change.pushed && !kept {
            tables.contact_manager().wake_body(id);
        } else if change.pushed {
            tables.bodies.still(id);
        }
    };
    for (entities, position, rotation, linear, angular) in watched.contiguous_iter().expect(IN_TABLES) {
        let columns = [
            position.changed_ticks_slice(),
            rotation.changed_ticks_slice(),
            linear.changed_ticks_slice(),
            angular.changed_ticks_slice(),
        ];
        let since = Since::last_run(system);
        since.rows(columns, |row| {
            if columns.iter().any(|column| since.is_new(column[row]) && column[row] != written) {
                wake(entities[row]);
            }
        });
    }
    if scaled.is_empty() && !gravity.is_changed() {
        return;
    }
    for id in scaled.iter().filter(|id| id.0 != NONE && !flipped.contains(id.0)) {
        tables.contact_manager().wake_body(id.0);
    }
    if gravity.is_changed() {
        for id in (0..tables.bodies.entities.len() as u32).filter(|id| !flipped.contains(*id)) {
            if tables.bodies.table.ids.is_live(id) && tables.bodies.table[id].kind == BodyKind::Dynamic {
                tables.contact_manager().wake_body(id);
            }
        }
    }
}

/// A kinematic body is awake exactly while it moves. A body with zero velocity is put to rest here; a body
/// with a velocity was already woken by the change.
pub(crate) fn rest_kinematic(query: Query<(&LinearVelocity, &AngularVelocity)>, mut tables: Tables) {
    let at_rest = |entity: Entity| {
        let velocity = query.get(entity).map(|(v, w)| (vector_to_kernel(v.0), angular_to_kernel(w.0)));
        velocity.is_ok_and(|(v, w)| v == KernelVector::ZERO && w.length_squared() == 0.0)
    };
    let mut ids = core::mem::take(&mut tables.bodies.ids);
    ids.clear();
    let Bodies { table, entities, .. } = &*tables.bodies;
    ids.extend(table.awake_kinematic().filter(|id| at_rest(entities[*id as usize])));
    for &id in &ids {
        tables.contact_manager().set_kinematic_awake(id, false);
        // A resting body has no velocity in the table, so that setting the old velocity again is a change.
        tables.bodies.table.set_velocity(id, Velocity::default());
    }
    tables.bodies.ids = ids;
}

/// Wakes kinematic bodies that rested at the start of the step and got a velocity since: they move in this
/// step. Sleeping dynamic bodies wake in the next step.
pub(crate) fn wake_kinematic_late(
    query: Query<(Ref<BodyId>, Ref<LinearVelocity>, Ref<AngularVelocity>)>,
    mut tables: Tables,
    system: SystemChangeTick,
) {
    let (written, since) = (tables.bodies.written, Since::last_run(system));
    let mut woken = core::mem::take(&mut tables.bodies.ids);
    woken.clear();
    for (ids, linear, angular) in query.contiguous_iter().expect(IN_TABLES) {
        let columns = [linear.changed_ticks_slice(), angular.changed_ticks_slice()];
        since.rows(columns, |row| {
            let id = ids[row].0;
            let is_new = columns.iter().any(|column| since.is_new(column[row]) && column[row] != written);
            if !is_new || id == NONE {
                return;
            }
            let body = &tables.bodies.table[id];
            let velocity = velocity(&linear[row], &angular[row]);
            let is_pushed =
                body.kind == BodyKind::Kinematic && !body.awake && velocity != Velocity::default();
            if is_pushed && velocity.linear.is_finite() && velocity.angular.is_finite() {
                tables.bodies.table.set_velocity(id, velocity);
                woken.push(id);
            }
        });
    }
    // The order of entities does not matter.
    woken.sort_unstable();
    for &id in &woken {
        tables.contact_manager().wake_body(id);
    }
    tables.bodies.ids = woken;
}

/// Components that define when a body is at rest, and for how long it has rested.
type RestInput = (Option<&'static SleepThreshold>, Has<SleepingDisabled>, Option<Ref<'static, SleepTimer>>);

/// Reads pose, velocity and sleep threshold of every awake body, before the step computes anything from them.
///
/// The thread pool finds the bodies whose components differ from the table, without writing. These bodies are
/// then read in the order of ids.
pub(crate) fn read_awake(
    query: Query<(StateInput, RestInput)>,
    (unit, threads): (Res<PhysicsLengthUnit>, Res<Threads>),
    mut tables: Tables,
    mut commands: Commands,
    mut found: Local<Vec<Vec<u32>>>,
    system: SystemChangeTick,
) {
    tables.bodies.read = system.this_run();
    tables.bodies.table.set_length_unit(unit.metres());
    let mut changed = core::mem::take(&mut tables.bodies.ids);
    changed.clear();
    let (unit, since) = (unit.metres(), Since::last_run(system));
    let table = &tables.bodies.table;
    if is_minority(table.awake_count(), [query.iter().size_hint()]) {
        changed.extend(table.awake_kinematic().chain(table.awake_dynamic()));
    } else {
        let differs = Differs { bodies: &tables.bodies, unit, since };
        for (bodies, rest) in query.contiguous_iter().expect(IN_TABLES) {
            threads.pool.each_into(&mut found, pieces(bodies.id.len()), |found, rows| {
                differs.among(&bodies, &rest, rows, found);
            });
        }
        found.iter_mut().for_each(|found| changed.append(found));
        changed.sort_unstable();
    }
    for &id in &changed {
        let entity = tables.bodies.entities[id as usize];
        let Ok((body, (threshold, sleepless, timer))) = query.get(entity) else { continue };
        tables.bodies.table[id].rest_speed = rest_speed(threshold, sleepless, unit);
        if let Some(timer) = timer
            && tables.bodies.is_set_by_app(timer.last_changed(), since)
        {
            // NaN becomes 0.
            tables.bodies.table[id].sleep_timer = max(timer.0, 0.0);
        }
        let change = read_in(entity, &body, &mut tables, &mut commands);
        if change.moved {
            tables.contact_manager().wake_touching(id);
        }
        if change.moved || change.pushed {
            tables.bodies.table[id].sleep_timer = 0.0;
        }
    }
    tables.bodies.ids = changed;
}

/// Finds awake bodies whose components differ from the tables.
struct Differs<'a> {
    bodies: &'a Bodies,
    unit: f32,
    since: Since,
}

impl Differs<'_> {
    /// Adds the ids of these bodies among some rows of a table of components.
    fn among(
        &self,
        states: &StateInputContiguousItem,
        (thresholds, sleepless, timers): &(
            Option<&[SleepThreshold]>,
            bool,
            Option<ContiguousRef<SleepTimer>>,
        ),
        rows: Range<usize>,
        found: &mut Vec<u32>,
    ) {
        let timers = timers.as_ref().map(ContiguousRef::changed_ticks_slice);
        let differs = |i: usize| {
            let id = states.id[i].0;
            if id == NONE || !self.bodies.table[id].awake {
                return false;
            }
            let rest = rest_speed(thresholds.map(|all| &all[i]), *sleepless, self.unit);
            self.bodies.table[id].rest_speed != rest
                || timers.is_some_and(|ticks| self.bodies.is_set_by_app(ticks[i], self.since))
                || self.state_differs(id, &states.row(i))
        };
        found.extend(rows.filter(|i| differs(*i)).map(|i| states.id[i].0));
    }

    #[inline(always)]
    fn state_differs(&self, id: u32, body: &StateInputItem) -> bool {
        let Bodies { table, seen, .. } = self.bodies;
        seen[id as usize] != said_pose(body.position, body.rotation)
            || table.velocities[id as usize] != velocity(body.linear_velocity, body.angular_velocity)
            || table[id].local_center != vector_to_kernel(body.center.0)
    }
}

fn rest_speed(threshold: Option<&SleepThreshold>, sleepless: bool, unit: f32) -> RestSpeed {
    if sleepless {
        return RestSpeed::NEVER;
    }
    let SleepThreshold { linear, angular } = threshold.copied().unwrap_or_default();
    RestSpeed { linear: linear * unit, angular }
}

/// Gives every awake body a row, and fills it.
///
/// If most bodies are awake, the thread pool iterates over whole tables of components. If most bodies sleep,
/// the calling thread looks up entities. Rows are written by id in both cases, so the order of entities does
/// not matter.
pub(crate) fn gather_bodies(
    query: Query<(BodyInput, MotionInput)>,
    (gravity, threads): (Res<Gravity>, Res<Threads>),
    mut solver: ResMut<StepSolver>,
    mut bodies: ResMut<Bodies>,
    mut diagnostics: ResMut<SolverDiagnostics>,
    mut commands: Commands,
    mut gathered: Local<Vec<Gathered>>,
) {
    let start = bevy_platform::time::Instant::now();
    let Bodies { table, listed, entities, some, .. } = &mut *bodies;
    let kinematic = table.assign_rows(listed);
    let count = listed.len();
    let kernel = &mut solver.kernel;
    kernel.begin_step(kinematic, count - kinematic);
    let first_dynamic = kernel.bodies.first_dynamic() as usize;
    let filler = kernel.bodies.filler();
    let gather = Gather { gravity: finite_gravity(&gravity), table, filler, first_dynamic };
    if is_minority(count, [query.iter().size_hint()]) {
        if gathered.is_empty() {
            gathered.push(Gathered::default());
        }
        some.clear();
        some.extend(listed.iter().map(|id| entities[*id as usize]));
        query.iter_many(&*some).for_each(|(body, options)| gather.body(&body, &options, &mut gathered[0]));
    } else {
        for (bodies, options) in query.contiguous_iter().expect(IN_TABLES) {
            let is_plain = options.is_none();
            threads.pool.each_into(&mut gathered, pieces(bodies.id.len()), |gathered, rows| {
                for i in rows {
                    let options = if is_plain { MotionInputItem::NONE } else { options.row(i) };
                    gather.body(&bodies.row(i), &options, gathered);
                }
            });
        }
    }
    // A body may have lost a component within the step.
    if gathered.iter().map(|some| some.filled).sum::<usize>() < count {
        kernel.bodies.fill_rest();
    }
    let mut refused = Vec::new();
    for Gathered { filled, special, dominances, refused: some } in gathered.iter_mut() {
        *filled = 0;
        kernel.bodies.add_special(special);
        for (id, dominance) in dominances.drain(..) {
            table[id].dominance = dominance;
            table.any_dominance = true;
        }
        refused.append(some);
    }
    refused.sort_unstable();
    for id in refused {
        quarantine(entities[id as usize], Some(table.frame(id)), &mut commands);
    }
    diagnostics.prepare_constraints += start.elapsed();
}

/// Results of one worker, in addition to the filled rows.
#[derive(Default)]
pub(crate) struct Gathered {
    /// Number of rows.
    filled: usize,
    special: SpecialBodies,
    /// Bodies whose dominance differs from the table.
    dominances: Vec<(u32, i8)>,
    /// Bodies whose velocity is not finite.
    refused: Vec<u32>,
}

/// Inputs that are common to all bodies.
struct Gather<'a> {
    gravity: KernelVector,
    table: &'a BodyTable,
    filler: BodyFiller<'a>,
    first_dynamic: usize,
}

impl Gather<'_> {
    /// Fills a body's row, if it has one.
    #[inline(always)]
    fn body(&self, body: &BodyInputItem, options: &MotionInputItem, gathered: &mut Gathered) {
        let id = body.id.0;
        let row = if id == NONE { 0 } else { self.table.row(id) as usize };
        if row == 0 {
            return;
        }
        // The velocity may have changed since it was read. A changed pose takes effect in the next step, see
        // `note_moved_within`.
        let Velocity { linear, angular } = velocity(body.linear_velocity, body.angular_velocity);
        let finite = linear.is_finite() && angular.is_finite();
        if !finite {
            gathered.refused.push(id);
        }
        // Bodies that were quarantined in this step do not move until they are removed.
        if !finite || options.disabled {
            gathered.filled += usize::from(self.filler.fill(row, &FilledBody::at_rest()));
            return;
        }
        let mut filled = FilledBody { row: BodyRow::new(linear, angular), ..FilledBody::at_rest() };
        let locks = options.locks.map_or(AxisLocks::NONE, |l| l.to_kernel());
        let mut limits = Limits { locks, ..Limits::NONE };
        let dominance = options.dominance.map_or(0, |d| d.0);
        if dominance != self.table[id].dominance {
            gathered.dominances.push((id, dominance));
        }
        if row >= self.first_dynamic {
            let inv_mass = max(to_f32(body.mass.inverse()), 0.0);
            let inv_mass = if inv_mass.is_finite() { inv_mass } else { 0.0 };
            let local = inv_inertia_to_kernel(body.inertia.inverse());
            let rotation = self.table.poses[id as usize].rotation;
            filled.mass = MassRow::new(inv_mass, local.rotated(rotation).locked(locks));
            filled.motion = self.motion(options);
            if !options.own_velocity {
                limits.max_speed = limit(options.max_speed.map(|m| m.0));
                limits.max_angular_speed = limit(options.max_angular_speed.map(|m| m.0));
                gathered.special.spin(row, local, rotation);
            }
        }
        gathered.special.limit(row, limits);
        gathered.filled += usize::from(self.filler.fill(row, &filled));
    }

    fn motion(&self, options: &MotionInputItem) -> Motion {
        if options.own_velocity {
            return Motion::FREE;
        }
        let scale: f32 = options.gravity_scale.map_or(1.0, |s| to_f32(s.0));
        let scale = if scale.is_finite() { scale } else { 1.0 };
        Motion {
            acceleration: self.gravity * scale,
            linear_damping: positive(options.linear_damping.map(|d| d.0)),
            angular_damping: positive(options.angular_damping.map(|d| d.0)),
            ..Motion::FREE
        }
    }
}
