//! The systems that drive dynamic movers. Each mover finds the ground below, and gets the forces of its
//! spring and its drive.
//!
//! The spring is integrated implicitly, so that it is stable at any rate. With x the distance above the rest
//! height, v its rate, and h the length of the step, the acceleration is the value at the end of the step,
//!
//! ```text
//! a = -k (x + h (v + h a)) - c (v + h a),   k = (2π f)²,   c = 2 ζ (2π f)
//! ```
//!
//! (E. Catto, "Soft Constraints", GDC 2011). It is applied as an impulse at the start of the step, so that
//! the final velocity holds for the whole step: a turning platform is followed exactly. Gravity acts
//! throughout the step and is balanced by a force, so that the spring does not sag.

use bevy_ecs::prelude::*;
use bevy_time::Time;

use super::{
    bodies::{BodiesAround, Motion, borne},
    controller::{CharacterInput, CharacterLanded, CharacterLeftGround, CharacterState, GroundState},
    dynamic_mover::DynamicMover,
    move_and_slide::{MoveAndSlide, MoveAndSlideConfig},
    mover::{Mover, Sweep},
    system::{feet_of, solidity},
    velocity_project::vector,
    walker::Walker,
};
use crate::{
    collision::collider::{Collider, CollisionLayers, LayerMask},
    dynamics::{
        ids::BodyId,
        integrator::Gravity,
        rigid_body::{
            GravityScale, LinearVelocity, RigidBody, RigidBodyDisabled,
            forces::{Forces, WriteRigidBodyForces},
            mass_properties::components::ComputedMass,
        },
        solver::workers::WorkerCount,
    },
    math::{AdjustPrecision, AngularVector, Scalar, TAU, Vector},
    physics_transform::{Position, Rotation},
    schedule::Physics,
    threads::Threads,
};

/// Maximum distance at which a mover without a spring touches the ground, in metres: contacts of the solver
/// rest within it.
const TOUCHING: Scalar = 0.02;

/// Maximum speed that the load of one step gives unsteady ground, in m/s. A larger value throws light crates
/// when the mover steps on their edge; with a smaller value the mover sinks into them.
const MAX_KICK: Scalar = 10.0;

/// The forces on a mover in the coming step.
#[derive(Component, Clone, Debug, Default)]
pub(super) struct MoverPlan {
    /// The force in N.
    force: Vector,
    /// The impulse in N·s.
    impulse: Vector,
    /// The body that gets the opposite force and impulse, and the point where they act.
    ground: Option<(Entity, Vector)>,
    landed: Option<CharacterLanded>,
    left: Option<CharacterLeftGround>,
}

/// A mover and its components.
type Hovering = (
    Entity,
    &'static DynamicMover,
    &'static CharacterInput,
    &'static mut CharacterState,
    &'static mut MoverPlan,
    (&'static Collider, &'static Position, &'static Rotation, Option<&'static CollisionLayers>),
    (&'static RigidBody, &'static LinearVelocity, &'static ComputedMass, Option<&'static GravityScale>),
);

/// The ground below a mover.
struct Below {
    entity: Entity,
    body: Option<Entity>,
    motion: Option<Motion>,
    point: Vector,
    normal: Vector,
    /// Whether the ground can be walked on.
    is_floor: bool,
    /// The distance from the collider to the ground.
    gap: Scalar,
    /// The mean velocity of the point and the surface of the ground in the step.
    velocity: Vector,
    /// The inverse effective mass of the ground at the point, along the missing velocity and upwards: 0 if it
    /// is not dynamic.
    inverse: [Scalar; 2],
}

/// Plans the forces of each mover.
pub(super) fn plan_movers(
    mut movers: Query<Hovering, Without<RigidBodyDisabled>>,
    moves: MoveAndSlide,
    bodies: BodiesAround,
    gravity: Res<Gravity>,
    clock: Res<Time<Physics>>,
    (mut threads, workers): (ResMut<Threads>, Res<WorkerCount>),
) {
    let time = clock.delta_secs_f64().adjust_precision();
    if !(time > 0.0) {
        return;
    }
    threads.wake_for_characters(movers.iter().len(), workers.0, || workers.resolve());
    let all: Vec<_> = movers.iter_mut().collect();
    threads.pool.each(all.into_iter(), |(entity, mover, input, mut state, mut plan, place, body)| {
        let (shape, position, rotation, layers) = place;
        let (kind, velocity, mass, scale) = body;
        *plan = MoverPlan::default();
        let is_finite = position.is_finite() && velocity.is_finite() && input.velocity.is_finite();
        if !kind.is_dynamic() || !is_finite || !(mass.value() > 0.0) {
            return;
        }
        let up = vector(mover.up);
        let unit = moves.length_unit.0;
        let was_grounded = state.is_grounded();
        let rest = (mover.float_height * unit).max(0.0);
        let reach = if rest > 0.0 { mover.snap_distance * unit } else { TOUCHING * unit };
        let is_solid = solidity(&moves, &bodies, LayerMask::NONE, layers);
        let config = MoveAndSlideConfig::default();
        let walker = Walker::new(
            Mover {
                queries: &moves.spatial_query,
                is_solid: &is_solid,
                ignored: bodies.colliders_of(entity).collect(),
                shape,
                rotation: (*rotation).into(),
                filter: &mover.filter,
                skin: 0.0,
                unit,
            },
            position.0,
            (up, feet_of(shape, rotation, up)),
            mover.max_slope,
            &config,
        );
        let gravity = gravity.0 * scale.map_or(1.0, |scale| scale.0);
        let hover = Hover { walker, mover, velocity: velocity.0, gravity, time, rest, mass: mass.value() };
        let below = hover.below(rest + reach.max(0.0), &bodies);
        hover.plan(entity, (&bodies, below), input, &mut state, &mut plan);
        if was_grounded && !state.is_grounded() {
            plan.left = Some(CharacterLeftGround { character: entity, fall: state.fall });
        }
    });
}

/// A mover in the coming step.
struct Hover<'a> {
    walker: Walker<'a>,
    mover: &'a DynamicMover,
    velocity: Vector,
    gravity: Vector,
    time: Scalar,
    /// The rest height.
    rest: Scalar,
    mass: Scalar,
}

impl Hover<'_> {
    /// The ground within reach below the collider.
    fn below(&self, reach: Scalar, bodies: &BodiesAround) -> Option<Below> {
        let walker = &self.walker;
        let hit: Sweep = walker.mover.sweep(walker.position, -walker.up * reach)?;
        let floor = walker.floor_of(&hit.part, true);
        let (entity, point) = (hit.part.entity, hit.part.points[0]);
        let body = bodies.body_of(entity);
        let motion = body.and_then(|body| bodies.motion_of(body, self.time));
        let carried = motion.map_or(Vector::ZERO, |motion| motion.displacement_at(point) / self.time);
        Some(Below {
            entity,
            body,
            motion,
            point,
            normal: floor.unwrap_or(hit.part.normal),
            is_floor: floor.is_some(),
            gap: hit.distance,
            velocity: carried + bodies.surface_of(entity),
            inverse: [0.0; 2],
        })
    }

    fn plan(
        &self,
        entity: Entity,
        (bodies, below): (&BodiesAround, Option<Below>),
        input: &CharacterInput,
        state: &mut CharacterState,
        plan: &mut MoverPlan,
    ) {
        let up = self.walker.up;
        let own = self.walker.horizontal(input.velocity);
        let before = (state.ground_entity, state.ground_velocity);
        let load = core::mem::take(&mut state.load);
        note_ground(state, below.as_ref());
        let Some(mut ground) = below.filter(|ground| self.is_caught(ground, state.is_grounded())) else {
            if state.is_grounded() {
                let body = before.0.and_then(|ground| bodies.body_of(ground));
                let is_dynamic = body.is_some_and(|body| bodies.is_dynamic(body));
                state.fall = self.kept_of(before.1, is_dynamic, own);
            }
            state.ground = match state.ground_entity {
                Some(_) => GroundState::OnSteepGround,
                None => GroundState::InAir,
            };
            let missing = own + self.walker.horizontal(state.fall) - self.walker.horizontal(self.velocity);
            plan.impulse = self.drive(missing, self.mover.max_air_acceleration) * self.time;
            return;
        };
        if !state.is_grounded() {
            let speed = (ground.velocity - self.velocity).dot(up);
            plan.landed = Some(CharacterLanded { character: entity, ground: ground.entity, speed });
        }
        state.ground = GroundState::OnGround;
        state.fall = Vector::ZERO;
        let is_dynamic = ground.motion.is_some_and(|motion| motion.kind.is_dynamic());
        plan.ground = ground.body.filter(|_| is_dynamic).map(|body| (body, ground.point));
        if let Some((body, point)) = plan.ground {
            let is_known = before.0 == Some(ground.entity);
            let yielded = if is_known { (before.1 - ground.velocity).dot(up) } else { 0.0 };
            let missing = self.walker.horizontal(own + ground.velocity - self.velocity);
            let directions = [missing.normalize_or_zero(), up];
            ground.inverse = directions.map(|along| bodies.inverse_mass_at(body, point, along));
            let gravity = -self.gravity.dot(up);
            // Ground that does not bear the mover lets it fall, so the load grows fast.
            let growing = (ground.inverse[1], 1.0);
            state.load = borne(load, yielded, (self.mass, gravity), growing, self.time);
            if !is_known || yielded.abs() > gravity * self.time {
                let kick = MAX_KICK * self.walker.mover.unit / (ground.inverse[1] * self.time);
                state.load = state.load.min(kick);
            }
        }
        if input.jump > 0.0 {
            let speed = ground.velocity.dot(up) + self.walker.lift(ground.normal, own).max(0.0) + input.jump;
            // Ground that bears the whole weight is as firm as the surface below it.
            let weight = -self.gravity.dot(up) * self.mass;
            let free = if weight > 0.0 { 1.0 - state.load / weight } else { 1.0 };
            let share = self.share(ground.inverse[1] * free);
            plan.impulse = up * ((speed - self.velocity.dot(up)) * self.mass * share);
            state.ground = GroundState::InAir;
            state.fall = self.kept_of(ground.velocity, is_dynamic, own);
            return;
        }
        let missing = own + ground.velocity - self.velocity;
        if self.rest > 0.0 {
            let drive = self.drive(self.walker.horizontal(missing), self.mover.max_acceleration);
            plan.impulse = (self.spring(&ground) + drive * self.share(ground.inverse[0])) * self.time;
            plan.force = -up * self.gravity.dot(up) * self.mass;
            if plan.ground.is_some() {
                plan.force = up * state.load;
            }
        } else {
            let along = |v: Vector| v - ground.normal * v.dot(ground.normal);
            let climb = up * self.walker.lift(ground.normal, own);
            let drive = self.drive(along(missing + climb), self.mover.max_acceleration);
            plan.impulse = drive * (self.share(ground.inverse[0]) * self.time);
            plan.force = -along(self.gravity) * self.mass;
        }
    }

    /// The ground velocity that the mover keeps in the air. From dynamic ground it keeps only the part that
    /// it already has: the ground may be a crate that it kicked.
    fn kept_of(&self, ground: Vector, is_dynamic: bool, own: Vector) -> Vector {
        let along = self.walker.horizontal(ground);
        let square = along.length_squared();
        if !(is_dynamic && square > 0.0) {
            return ground;
        }
        let carried = (self.velocity - own).dot(along) / square;
        ground - along * (1.0 - carried.clamp(0.0, 1.0))
    }

    /// The share of an impulse needed to change the velocity relative to a body with an inverse mass.
    fn share(&self, inverse: Scalar) -> Scalar {
        1.0 / (1.0 + self.mass * inverse)
    }

    /// Whether the ground carries the mover. A mover in the air is caught on its way down.
    fn is_caught(&self, ground: &Below, was_grounded: bool) -> bool {
        let touching = if self.rest > 0.0 { self.rest } else { TOUCHING * self.walker.mover.unit };
        ground.is_floor && (was_grounded || (ground.gap <= touching && self.rate(ground) <= 0.0))
    }

    /// The rate at which the gap grows, in m/s, while the mover moves along a slope.
    fn rate(&self, ground: &Below) -> Scalar {
        let relative = self.velocity - ground.velocity;
        let across = self.walker.horizontal(relative);
        relative.dot(self.walker.up) - self.walker.lift(ground.normal, across)
    }

    /// The force of the spring, in N.
    fn spring(&self, ground: &Below) -> Vector {
        let up = self.walker.up;
        let h = self.time;
        let omega = TAU * self.mover.frequency.max(0.0);
        let (k, c) = (omega * omega, 2.0 * self.mover.damping_ratio.max(0.0) * omega);
        let (x, v) = (ground.gap - self.rest, self.rate(ground));
        let acceleration = -(k * x + (c + h * k) * v) / (1.0 + h * c + h * h * k);
        up * (acceleration * self.mass * self.share(ground.inverse[1]))
    }

    /// The force that adds a velocity in one step, in N, limited by a maximum acceleration.
    fn drive(&self, missing: Vector, largest: Scalar) -> Vector {
        let largest = if largest > 0.0 { largest } else { 0.0 };
        (missing / self.time).clamp_length_max(largest) * self.mass
    }
}

/// Records the ground below.
fn note_ground(state: &mut CharacterState, below: Option<&Below>) {
    let before = (state.ground_velocity, state.is_grounded());
    state.carrier = None;
    state.ground_entity = below.map(|ground| ground.entity);
    state.ground_point = below.map_or(Vector::ZERO, |ground| ground.point);
    state.ground_normal = below.map_or(Vector::ZERO, |ground| ground.normal);
    state.ground_spin = below.and_then(|ground| ground.motion).map_or(AngularVector::default(), |m| m.spin);
    state.ground_velocity = match below {
        Some(ground) => ground.velocity,
        // The velocity of the ground that the mover leaves.
        None if before.1 => before.0,
        None => Vector::ZERO,
    };
}

/// The components with which a mover is driven.
type Driven = (Entity, &'static BodyId, &'static mut MoverPlan, &'static mut CharacterInput);

/// Applies the forces of movers to the movers and the opposite forces to the ground, and sends their events
/// in order of ids.
pub(super) fn drive_movers(
    mut movers: Query<Driven, Without<RigidBodyDisabled>>,
    mut bodies: Query<Forces>,
    mut landed: MessageWriter<CharacterLanded>,
    mut left: MessageWriter<CharacterLeftGround>,
    mut commands: Commands,
) {
    let mut plans = Vec::new();
    for (entity, id, mut plan, mut input) in &mut movers {
        let plan = core::mem::take(&mut *plan);
        if input.jump != 0.0 {
            input.jump = 0.0;
        }
        plans.push((id.0, entity, plan));
    }
    plans.sort_by_key(|(id, ..)| *id);
    for (_, entity, plan) in plans {
        if let Ok(mut forces) = bodies.get_mut(entity) {
            forces.apply_force(plan.force);
            forces.apply_linear_impulse(plan.impulse);
        }
        if let Some((ground, point)) = plan.ground
            && let Ok(mut forces) = bodies.get_mut(ground)
        {
            forces.apply_force_at_point(-plan.force, point);
            forces.apply_linear_impulse_at_point(-plan.impulse, point);
        }
        if let Some(event) = plan.left {
            left.write(event);
            commands.trigger(event);
        }
        if let Some(event) = plan.landed {
            landed.write(event);
            commands.trigger(event);
        }
    }
}
