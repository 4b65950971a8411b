//! From components to rows: the awake bodies of this step, and what the app changed by hand.

use bevy_ecs::{prelude::*, query::QueryData};
use bevy_log::warn_once;
use kernel::{
    math::{AxisLocks, InvInertia, Vector as KernelVector, max},
    solver::{BodyRow, MassRow, Motion},
    table::{BodyKind, NONE, Velocity},
};

use crate::{
    dynamics::{
        integrator::{CustomPositionIntegration, CustomVelocityIntegration, Gravity},
        lifecycle::BodyId,
        quarantine::quarantine,
        rigid_body::{
            AngularDamping, AngularVelocity, Dominance, GravityScale, LinearDamping, LinearVelocity,
            LockedAxes, MaxAngularSpeed, MaxLinearSpeed,
            mass_properties::components::{ComputedAngularInertia, ComputedCenterOfMass, ComputedMass},
        },
        solver::StepSolver,
        tables::{Bodies, Tables},
    },
    math::{Scalar, angular_to_kernel, inv_inertia_to_kernel, to_f32, vector_to_kernel},
    physics_transform::{Position, Rotation, world_pose},
};

/// The pose, velocity and mass of a body, as the app sees it.
#[derive(QueryData)]
pub(crate) struct BodyInput {
    pub(crate) id: &'static BodyId,
    position: &'static Position,
    rotation: &'static Rotation,
    linear_velocity: &'static LinearVelocity,
    angular_velocity: &'static AngularVelocity,
    mass: &'static ComputedMass,
    inertia: &'static ComputedAngularInertia,
    center: &'static ComputedCenterOfMass,
    options: MotionInput,
}

/// What most bodies do not have.
#[derive(QueryData)]
pub(crate) struct MotionInput {
    gravity_scale: Option<&'static GravityScale>,
    linear_damping: Option<&'static LinearDamping>,
    angular_damping: Option<&'static AngularDamping>,
    max_speed: Option<&'static MaxLinearSpeed>,
    max_angular_speed: Option<&'static MaxAngularSpeed>,
    locks: Option<&'static LockedAxes>,
    dominance: Option<&'static Dominance>,
    own_velocity: Has<CustomVelocityIntegration>,
    own_position: Has<CustomPositionIntegration>,
}

/// A finite value that is not negative: negative and NaN count as none, infinite as the largest.
fn positive(value: Option<Scalar>) -> f32 {
    match value.map(to_f32) {
        Some(v) if v > 0.0 => v.min(f32::MAX),
        _ => 0.0,
    }
}

/// Gravity for the kernel. One that is not finite would undo every body at once: it counts as none.
fn finite_gravity(gravity: &Gravity) -> KernelVector {
    let vector = vector_to_kernel(gravity.0);
    if vector.is_finite() {
        return vector;
    }
    warn_once!("a gravity of {} is not finite, none is used instead", gravity.0);
    KernelVector::ZERO
}

/// A limit: none, negative or NaN do not limit.
fn limit(value: Option<Scalar>) -> f32 {
    match value.map(to_f32) {
        Some(v) if v >= 0.0 => v,
        _ => f32::INFINITY,
    }
}

impl BodyInputItem<'_, '_> {
    fn velocity(&self) -> Velocity {
        Velocity {
            linear: vector_to_kernel(self.linear_velocity.0),
            angular: angular_to_kernel(self.angular_velocity.0),
        }
    }

    /// Whether pose and velocity are numbers; what is not keeps out of the simulation.
    fn is_finite(&self) -> bool {
        let velocity = self.velocity();
        let pose = world_pose(self.position, self.rotation);
        velocity.linear.is_finite()
            && velocity.angular.is_finite()
            && pose.position.is_finite_world()
            && pose.rotation.is_finite()
    }
}

/// Puts what the app says of a body into the table: its pose if it is another than the engine wrote, its
/// centre of mass, its velocity. Returns whether it was moved by hand.
fn read_in(id: u32, body: &BodyInputItem, tables: &mut Tables) -> bool {
    let bodies = &mut tables.bodies.table;
    let center = vector_to_kernel(body.center.0);
    let frame = world_pose(body.position, body.rotation);
    let moved = bodies.frame(id) != frame;
    let recentered = bodies[id].local_center != center && center.is_finite();
    bodies.set_velocity(id, body.velocity());
    if moved || recentered {
        if recentered {
            bodies[id].local_center = center;
        }
        bodies.teleport(id, frame);
        let Tables { bodies, colliders, .. } = tables;
        let colliders = &mut **colliders;
        let mut next = bodies.table[id].first_collider;
        while next != NONE {
            colliders.stale.insert(next);
            colliders.table.update_reach(next, &bodies.table);
            next = colliders.table.next_of_body(next);
        }
    }
    moved
}

/// Sees what the app did to bodies that are static or asleep: moved ones wake what they touch, and they
/// themselves wake if they can.
pub(crate) fn wake_changed(
    changed: Query<
        (Entity, BodyInput),
        Or<(Changed<Position>, Changed<Rotation>, Changed<LinearVelocity>, Changed<AngularVelocity>)>,
    >,
    gravity: Res<Gravity>,
    scaled: Query<&BodyId, Changed<GravityScale>>,
    mut tables: Tables,
    mut commands: Commands,
) {
    for (entity, body) in &changed {
        let id = body.id.0;
        if id == NONE || tables.bodies.table[id].awake {
            continue;
        }
        if !body.is_finite() {
            quarantine(entity, Some(tables.bodies.table.frame(id)), &mut commands);
            continue;
        }
        let old = tables.bodies.table.velocities[id as usize];
        let moved = read_in(id, &body, &mut tables);
        if moved {
            tables.link().wake_touching(id);
        }
        if moved || old != tables.bodies.table.velocities[id as usize] {
            tables.link().wake_body(id);
        }
    }
    for id in scaled.iter().filter(|id| id.0 != NONE) {
        tables.link().wake_body(id.0);
    }
    if gravity.is_changed() {
        for id in 0..tables.bodies.entities.len() as u32 {
            if tables.bodies.table.ids.is_live(id) && tables.bodies.table[id].kind == BodyKind::Dynamic {
                tables.link().wake_body(id);
            }
        }
    }
}

/// A kinematic body is awake exactly while it moves.
pub(crate) fn wake_kinematic(query: Query<(&LinearVelocity, &AngularVelocity)>, mut tables: Tables) {
    let ids: Vec<u32> = tables.bodies.kinematic.iter().collect();
    for id in ids {
        let entity = tables.bodies.entities[id as usize];
        let Ok((v, w)) = query.get(entity) else { continue };
        let (v, w) = (vector_to_kernel(v.0), angular_to_kernel(w.0));
        let moves = v != KernelVector::ZERO || w.length_squared() != 0.0;
        tables.link().set_kinematic_awake(id, moves);
    }
}

/// Reads pose and velocity of every awake body, before anything is computed from them.
pub(crate) fn read_awake(query: Query<BodyInput>, mut tables: Tables) {
    let awake: Vec<u32> =
        tables.bodies.table.awake_kinematic().chain(tables.bodies.table.awake_dynamic()).collect();
    let entities: Vec<Entity> = awake.iter().map(|id| tables.bodies.entities[*id as usize]).collect();
    let mut read = |body: BodyInputItem| {
        let id = body.id.0;
        if id == NONE || !tables.bodies.table[id].awake || !body.is_finite() {
            return;
        }
        let before = tables.bodies.table.velocities[id as usize];
        if read_in(id, &body, &mut tables) {
            tables.link().wake_touching(id);
        }
        if tables.bodies.table.velocities[id as usize] != before {
            tables.bodies.table[id].sleep_timer = 0.0;
        }
    };
    if is_minority(awake.len(), &query) {
        query.iter_many(entities).for_each(read);
    } else {
        query.iter().for_each(&mut read);
    }
}

/// Whether so few bodies are awake that looking them up is cheaper than walking the tables of all.
fn is_minority(awake: usize, query: &Query<BodyInput>) -> bool {
    4 * awake < query.iter().size_hint().1.unwrap_or(0)
}

/// Gives every awake body its row and fills it.
///
/// Iterates tables where most bodies are awake and looks up entities where most sleep: rows are written
/// by id either way, so the order of entities does not matter.
pub(crate) fn gather_bodies(
    query: Query<BodyInput>,
    gravity: Res<Gravity>,
    mut solver: ResMut<StepSolver>,
    mut tables: Tables,
) {
    let Bodies { table, listed, .. } = &mut *tables.bodies;
    let kinematic = table.assign_rows(listed);
    let count = listed.len();
    solver.kernel.bodies.reset(kinematic, count - kinematic);
    let gather = Gather { gravity: finite_gravity(&gravity) };
    if is_minority(count, &query) {
        let entities: Vec<Entity> =
            tables.bodies.listed.iter().map(|id| tables.bodies.entities[*id as usize]).collect();
        for body in query.iter_many(entities) {
            gather.body(&body, &mut solver, &mut tables);
        }
    } else {
        for body in &query {
            gather.body(&body, &mut solver, &mut tables);
        }
    }
}

/// What is the same for all bodies.
struct Gather {
    gravity: KernelVector,
}

impl Gather {
    #[inline]
    fn body(&self, body: &BodyInputItem, solver: &mut StepSolver, tables: &mut Tables) {
        let id = body.id.0;
        if id == NONE {
            return;
        }
        let row = tables.bodies.table.rows[id as usize];
        if row == 0 || !body.is_finite() {
            return;
        }
        // The velocity may have been changed since it was read; the pose counts from the next step on.
        let velocity = body.velocity();
        let pose = tables.bodies.table.poses[id as usize];
        let rows = &mut solver.kernel.bodies;
        let row = row as usize;
        rows.rows[row] = BodyRow::new(velocity.linear, velocity.angular);
        let locks = body.options.locks.map_or(AxisLocks::NONE, |l| l.to_kernel());
        let dynamic = row >= rows.first_dynamic as usize;
        let dominance = body.options.dominance.map_or(0, |d| d.0);
        tables.bodies.table[id].dominance = dominance;
        tables.bodies.table.any_dominance |= dominance != 0;
        if dynamic {
            let inv_mass = max(to_f32(body.mass.inverse()), 0.0);
            let inv_mass = if locks.is_translation_full() || !inv_mass.is_finite() { 0.0 } else { inv_mass };
            let local = inv_inertia_to_kernel(body.inertia.inverse());
            let world = local.rotated(pose.rotation).locked(locks);
            rows.masses[row] = MassRow::new(inv_mass, world);
            rows.motions[row] = self.motion(&body.options, locks, local);
            rows.motions[row].rotation = pose.rotation;
        } else {
            rows.motions[row] = Motion { locks, ..Motion::FREE };
        }
    }

    fn motion(&self, options: &MotionInputItem, locks: AxisLocks, local: InvInertia) -> Motion {
        if options.own_velocity {
            return Motion { locks, ..Motion::FREE };
        }
        let scale: f32 = options.gravity_scale.map_or(1.0, |s| to_f32(s.0));
        let scale = if scale.is_finite() { scale } else { 1.0 };
        Motion {
            acceleration: self.gravity * scale,
            linear_damping: positive(options.linear_damping.map(|d| d.0)),
            angular_damping: positive(options.angular_damping.map(|d| d.0)),
            max_speed: limit(options.max_speed.map(|m| m.0)),
            max_angular_speed: limit(options.max_angular_speed.map(|m| m.0)),
            locks,
            local_inv_inertia: local,
            ..Motion::FREE
        }
    }
}
