//! The motion of one character through the coming step.

use bevy_ecs::prelude::*;

use super::{
    bodies::{BodiesAround, Motion, borne},
    controller::{
        Carrier, CharacterClimbed, CharacterController, CharacterHit, CharacterInput, CharacterLanded,
        CharacterLeftGround, CharacterState, GroundState,
    },
    move_and_slide::MoveAndSlide,
    planes::{Plane, way_out},
    walker::{Contact, Walker},
};
use crate::{
    collision::collider::LayerMask,
    math::{AngularVector, Scalar, Vector},
    spatial_query::NearPart,
};

/// Maximum distance in metres that a body moves into a character in one step and is still avoided.
const FARTHEST_PUSH: Scalar = 1.0;

/// The time in which a drawn character catches up with most of a climbed step, in seconds.
const SMOOTHING: Scalar = 0.08;

/// The actions of a character in the coming step.
#[derive(Component, Clone, Debug, Default)]
pub(super) struct CharacterPlan {
    pub(super) velocity: Vector,
    pub(super) landed: Option<CharacterLanded>,
    pub(super) left: Option<CharacterLeftGround>,
    pub(super) climbed: Option<CharacterClimbed>,
    pub(super) hits: Vec<CharacterHit>,
    pub(super) pushes: Vec<Push>,
}

/// A force in N on a dynamic body during the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Push {
    pub(super) body: Entity,
    pub(super) point: Vector,
    pub(super) force: Vector,
}

/// The data for planning.
pub(super) struct Surroundings<'a> {
    pub(super) moves: &'a MoveAndSlide<'a, 'a>,
    pub(super) bodies: &'a BodiesAround<'a, 'a>,
    pub(super) pushers: &'a [Motion],
    pub(super) gravity: Scalar,
    pub(super) time: Scalar,
}

impl Surroundings<'_> {
    /// Whether a collider belongs to a character in one of the given layers.
    pub(super) fn is_friend(&self, friends: LayerMask, entity: Entity) -> bool {
        is_friend(self.moves, self.bodies, friends, entity)
    }
}

/// Whether a collider belongs to a character in one of the given layers.
pub(super) fn is_friend(
    moves: &MoveAndSlide,
    bodies: &BodiesAround,
    friends: LayerMask,
    entity: Entity,
) -> bool {
    let Ok((.., layers)) = moves.colliders.get(entity) else { return false };
    let memberships = layers.copied().unwrap_or_default().memberships;
    memberships & friends != LayerMask::NONE
        && bodies.body_of(entity).is_some_and(|body| bodies.is_character(body))
}

/// The plan of one character while it is made.
pub(super) struct Planning<'a> {
    pub(super) around: &'a Surroundings<'a>,
    pub(super) walker: Walker<'a>,
    pub(super) state: CharacterState,
    pub(super) plan: CharacterPlan,
    pub(super) entity: Entity,
    pub(super) controller: &'a CharacterController,
    pub(super) input: CharacterInput,
    pub(super) gravity: Vector,
    pub(super) unit: Scalar,
    /// The position to which the carrier brought the character.
    pub(super) ridden_to: Vector,
    /// The velocity at the start of the step that does not come from walking.
    pub(super) carried: Vector,
}

impl Planning<'_> {
    /// Plans the step from a position.
    pub(super) fn run(&mut self, from: Vector) {
        let time = self.around.time;
        let up = self.walker.up;
        let before = (self.state.ground_entity, self.state.ground_velocity.dot(up));
        self.follow_carrier();
        self.recover();
        let own = self.input.velocity - up * self.input.velocity.dot(up);
        let was_grounded = self.state.is_grounded();
        let floor = was_grounded.then(|| self.floor_below()).flatten();
        match floor {
            Some(floor) if self.input.jump > 0.0 => {
                let normal = floor.floor.unwrap_or(up);
                let rise = self.walker.lift(normal, own).max(0.0);
                self.state.fall = self.carried + up * (self.input.jump + rise);
                self.leave();
                self.fall(own);
            }
            Some(floor) => self.walk(own, time, floor),
            None => {
                if was_grounded {
                    self.state.fall = self.carried;
                    self.leave();
                }
                self.fall(own);
            }
        }
        self.ride(time);
        self.yield_to_friends();
        self.make_way();
        self.plan.velocity = (self.walker.position - from) / time;
        self.note_hits();
        self.weigh(before);
        if let Some((collider, height)) = self.walker.climbed {
            self.plan.climbed = Some(CharacterClimbed { character: self.entity, collider, height });
            self.state.visual_offset -= height;
        }
        self.state.visual_offset *= SMOOTHING / (SMOOTHING + time);
    }

    /// Moves out of overlaps. Overlaps with dynamic bodies that are no floor are left to the solver. Of two
    /// characters each moves by half of the overlap.
    fn recover(&mut self) {
        let (bodies, walker) = (self.around.bodies, &self.walker);
        let share = |part: &NearPart| {
            let rise = part.normal.dot(walker.up);
            match bodies.body_of(part.entity) {
                Some(body) if rise < walker.least_cosine && bodies.is_dynamic(body) => 0.0,
                Some(body) if rise.abs() < walker.least_cosine && bodies.is_character(body) => 0.5,
                _ => 1.0,
            }
        };
        let out = walker.mover.recovery(walker.position, &walker.recovery, &share);
        self.walker.position += out;
    }

    /// Follows the carrier, if its pose differs from the expected one.
    fn follow_carrier(&mut self) {
        let Some(carrier) = self.state.carrier else { return };
        let Some(body) = self.around.bodies.motion_of(carrier.body, self.around.time) else { return };
        // A character that was moved elsewhere is no longer carried.
        let is_there = (self.walker.position - carrier.rider).length() <= self.walker.mover.skin;
        if !is_there {
            self.state.carrier = None;
            return;
        }
        let is_as_expected = (carrier.position, carrier.rotation) == (body.position, body.rotation);
        let velocity = body.velocity_at(self.walker.foot());
        let change = velocity - carrier.velocity;
        let slip = self.slip_after(carrier.body, carrier.slip, change);
        self.state.carrier = Some(Carrier { velocity, slip, ..carrier });
        if !is_as_expected || body.is_moving() {
            let way = body.position.0 + body.rotation * carrier.anchor - self.walker.foot();
            // The share of the displacement that comes from the change of velocity, and not from a teleport.
            let by_change = way.dot(change) / (change.length_squared() * self.around.time);
            let by_change = if by_change > 0.0 { by_change.min(1.0) } else { 0.0 };
            let slid = (slip - carrier.slip) * (self.around.time * by_change);
            self.shift_with(carrier.body, way + slid);
            if slid != Vector::ZERO {
                return;
            }
        }
        self.ridden_to = self.walker.position;
    }

    /// The slip velocity of the character on a carrier whose velocity changes. The character gets the share
    /// of the change that a body of the carrier's mass gives to a body of the character's mass. Friction then
    /// reduces the slip by g h per step. So only light carriers that jerk leave the character behind: a
    /// kicking limb does not throw it.
    fn slip_after(&self, carrier: Entity, slip: Vector, change: Vector) -> Vector {
        let (up, length) = (self.walker.up, change.length());
        let friction = self.gravity.length() * self.around.time;
        if !(friction > 0.0) {
            return Vector::ZERO;
        }
        let mut slip = slip;
        if length > 0.0 {
            let inverse = self.around.bodies.inverse_mass_at(carrier, self.walker.foot(), change / length);
            let relative = self.controller.mass.max(0.0) * inverse;
            if relative > 0.0 {
                slip -= change * (1.0 - 1.0 / (1.0 + relative));
            }
        }
        // The character does not slide into a rising carrier.
        slip -= up * slip.dot(up).min(0.0);
        let speed = slip.length();
        if speed > friction { slip * (1.0 - friction / speed) } else { Vector::ZERO }
    }

    /// Moves by a displacement, through the colliders of a body.
    fn shift_with(&mut self, body: Entity, way: Vector) -> bool {
        if way == Vector::ZERO {
            return true;
        }
        let count = self.walker.mover.ignored.len();
        self.walker.mover.ignored.extend(self.around.bodies.colliders_of(body));
        let is_free = self.walker.shift(way);
        self.walker.mover.ignored.truncate(count);
        is_free
    }

    /// The ground that a character on the ground touches, or the ground below it within reach.
    fn floor_below(&mut self) -> Option<Contact> {
        let find = |walker: &Walker| Walker::ground(&walker.contacts(None, true), walker.up);
        find(&self.walker).or_else(|| {
            let reach = self.controller.snap_distance * self.unit;
            self.walker.snap(reach).then(|| find(&self.walker)).flatten()
        })
    }

    /// Walks for a time, and stays on the ground if it continues.
    fn walk(&mut self, own: Vector, time: Scalar, floor: Contact) {
        let up = self.walker.up;
        let normal = floor.floor.unwrap_or(up);
        let before = self.walker.position;
        let climbed = self.walker.climbed.map_or(0.0, |(_, height)| height);
        let motion = self.walker.walk(own * time, normal);
        let mut contacts = self.walker.contacts(None, true);
        if Walker::ground(&contacts, up).is_none() {
            // Slopes down to the steepest one are followed at any speed.
            let moved = self.walker.position - before;
            let across = (moved - up * moved.dot(up)).length();
            let cosine = self.walker.least_cosine;
            let steepest = (1.0 - cosine * cosine).max(0.0).sqrt() / cosine.max(0.1);
            let reach = (self.controller.snap_distance * self.unit).max(across * steepest);
            let height = self.walker.position.dot(up);
            if self.walker.snap(reach) {
                contacts = self.walker.contacts(None, true);
                let along_slope = across * steepest + self.walker.mover.slack();
                let dropped = height - self.walker.position.dot(up);
                if dropped > along_slope {
                    self.state.visual_offset += dropped;
                }
            }
        }
        match Walker::ground(&contacts, up) {
            Some(ground) => self.stand_on(ground),
            None => {
                let climb = self.walker.climbed.map_or(0.0, |(_, height)| height) - climbed;
                let rise = if climb > 0.0 { 0.0 } else { motion.dot(up) / time };
                let slip = self.state.carrier.map_or(Vector::ZERO, |carrier| carrier.slip);
                self.state.fall = self.state.ground_velocity + slip + up * rise;
                self.leave();
                self.note_air(&contacts);
            }
        }
    }

    /// Falls through the step. If the character lands, it walks for the rest of the step.
    fn fall(&mut self, own: Vector) {
        let time = self.around.time;
        match self.walker.fly(&mut self.state.fall, own, self.gravity, time) {
            Some((ground, speed, left)) => {
                let character = self.entity;
                self.plan.landed = Some(CharacterLanded { character, ground: ground.part.entity, speed });
                self.stand_on(ground);
                self.walk(own, left, ground);
            }
            None => {
                let contacts = self.walker.contacts(None, false);
                self.note_air(&contacts);
            }
        }
    }

    /// Records the state of a character that is not on the ground.
    fn note_air(&mut self, contacts: &[Contact]) {
        let up = self.walker.up;
        let steepness = |contact: &&Contact| contact.part.normal.dot(up);
        let flattest = contacts.iter().max_by(|a, b| steepness(a).total_cmp(&steepness(b)));
        self.state.ground = match flattest {
            None => GroundState::InAir,
            Some(contact) if steepness(&contact) > 0.05 => GroundState::OnSteepGround,
            Some(_) => GroundState::NotSupported,
        };
        self.note_ground(flattest.copied());
        self.state.carrier = None;
    }

    /// Updates the character's position on its carrier after a move that is not walking.
    pub(super) fn moved_on(&mut self, way: Vector) {
        let Some(carrier) = &mut self.state.carrier else { return };
        carrier.rider = self.walker.position;
        if way != Vector::ZERO
            && let Some(body) = self.around.bodies.motion_of(carrier.body, self.around.time)
        {
            carrier.anchor += body.end().1.inverse() * way;
        }
    }

    fn stand_on(&mut self, ground: Contact) {
        self.state.ground = GroundState::OnGround;
        self.state.fall = Vector::ZERO;
        self.note_ground(Some(ground));
    }

    /// Records the ground with its velocity.
    fn note_ground(&mut self, ground: Option<Contact>) {
        let state = &mut self.state;
        state.ground_entity = ground.map(|ground| ground.part.entity);
        state.ground_point = ground.map_or(Vector::ZERO, |ground| ground.part.points[0]);
        state.ground_normal =
            ground.map_or(Vector::ZERO, |ground| ground.floor.unwrap_or(ground.part.normal));
        state.ground_velocity = Vector::ZERO;
        state.ground_spin = AngularVector::default();
        let Some(ground) = ground else { return };
        let entity = ground.part.entity;
        let body = self.around.bodies.body_of(entity);
        if let Some(motion) = body.and_then(|body| self.around.bodies.motion_of(body, self.around.time)) {
            state.ground_velocity = motion.velocity_at(self.walker.foot());
            state.ground_spin = motion.spin;
        }
        state.ground_velocity += self.around.bodies.surface_of(entity);
    }

    /// Moves with the motion of the ground in this step.
    fn ride(&mut self, time: Scalar) {
        let ground = self.state.ground_entity.filter(|_| self.state.is_grounded());
        let Some(ground) = ground else {
            self.state.carrier = None;
            return;
        };
        let surface = self.around.bodies.surface_of(ground) * time;
        let body = self.around.bodies.body_of(ground);
        let motion = body.and_then(|body| self.around.bodies.motion_of(body, time));
        let before = self.state.carrier;
        self.state.carrier = body.zip(motion).map(|(body, motion)| {
            let is_at_rest = self.walker.position == self.ridden_to;
            let known = before.filter(|known| known.body == body && is_at_rest);
            let anchor = known.map_or_else(|| motion.to_local(self.walker.foot()), |known| known.anchor);
            let (position, rotation) = motion.end();
            let way = if motion.is_moving() {
                position.0 + rotation * anchor - self.walker.foot()
            } else {
                Vector::ZERO
            };
            let start = self.walker.position;
            let velocity = motion.velocity_at(self.walker.foot());
            let slip = match before.filter(|before| before.body == body) {
                Some(before) => before.slip,
                None => {
                    let change = self.walker.horizontal(velocity - self.carried);
                    self.slip_after(body, Vector::ZERO, change)
                }
            };
            self.shift_with(body, if slip == Vector::ZERO { way } else { way + slip * time });
            // Obstacles moved the character on the body.
            let slid = self.walker.position - start - way;
            let anchor = if slid == Vector::ZERO { anchor } else { anchor + rotation.inverse() * slid };
            Carrier { body, position, rotation, anchor, rider: Vector::ZERO, velocity, slip }
        });
        if surface != Vector::ZERO {
            let normal = self.state.ground_normal;
            let start = self.walker.position;
            self.walker.shift(surface - normal * surface.dot(normal));
            self.moved_on(self.walker.position - start);
        }
        self.moved_on(Vector::ZERO);
    }

    /// Moves the character out of the way of kinematic bodies in this step.
    fn make_way(&mut self) {
        self.state.is_crushed = false;
        let position = self.walker.position;
        let reach = self.around.pushers.iter().map(|body| body.reach_at(position)).fold(0.0, Scalar::max);
        if !(reach > 0.0) {
            return;
        }
        let carrier = self.state.carrier.map(|carrier| carrier.body);
        let skin = self.walker.mover.skin;
        let mut planes = Vec::new();
        let mut pushing = Vec::new();
        for part in self.walker.mover.near(position, skin + reach.min(FARTHEST_PUSH * self.unit)) {
            let Some(body) = self.around.bodies.body_of(part.entity).filter(|body| Some(*body) != carrier)
            else {
                continue;
            };
            let Some(motion) = self.around.bodies.motion_of(body, self.around.time) else { continue };
            if !motion.kind.is_kinematic() || motion.is_character {
                continue;
            }
            let closing = motion.displacement_at(part.points[0]).dot(part.normal);
            let offset = skin - part.distance + closing;
            if closing > 0.0 && offset > 0.0 {
                planes.push(Plane { normal: part.normal, offset });
                pushing.push(body);
            }
        }
        if planes.is_empty() {
            return;
        }
        let tolerance = 0.1 * self.walker.mover.slack();
        let (way, is_out) = way_out(&planes, tolerance);
        let count = self.walker.mover.ignored.len();
        for body in pushing {
            self.walker.mover.ignored.extend(self.around.bodies.colliders_of(body));
        }
        self.walker.shift(way);
        self.walker.mover.ignored.truncate(count);
        let moved = self.walker.position - position;
        let left = |plane: &Plane| plane.offset - plane.normal.dot(moved);
        let is_stuck = planes.iter().any(|plane| left(plane) > skin);
        self.state.is_crushed = !is_out || is_stuck;
        self.moved_on(moved);
    }

    /// The character is no longer on the ground.
    fn leave(&mut self) {
        self.state.carrier = None;
        self.plan.left = Some(CharacterLeftGround { character: self.entity, fall: self.state.fall });
    }

    /// Reports the colliders that the character moved into, each once, and pushes dynamic bodies.
    fn note_hits(&mut self) {
        let character = self.entity;
        for (part, way) in core::mem::take(&mut self.walker.met) {
            if self.plan.hits.iter().any(|hit| hit.collider == part.entity) {
                continue;
            }
            let impulse = self.push(&part, way / self.around.time);
            let (collider, point, normal) = (part.entity, part.points[0], part.normal);
            self.plan.hits.push(CharacterHit { character, collider, point, normal, impulse });
        }
    }

    /// Pushes a dynamic body like a body of the character's mass that loses its speed to it, up to the
    /// maximum force. Returns the impulse.
    fn push(&mut self, part: &NearPart, velocity: Vector) -> Scalar {
        let around = self.around;
        let mass = self.controller.mass;
        let Some(body) = around.bodies.body_of(part.entity) else { return 0.0 };
        let Some(motion) = around.bodies.motion_of(body, around.time) else { return 0.0 };
        if !(motion.kind.is_dynamic() && mass > 0.0) {
            return 0.0;
        }
        // On the ground the character pushes horizontally, and does not lift.
        let up = self.walker.up;
        let is_level = self.state.is_grounded() && part.normal.dot(up).abs() < self.walker.least_cosine;
        let normal = if is_level { part.normal - up * part.normal.dot(up) } else { part.normal };
        let direction = -normal.normalize_or_zero();
        let point = part.points[0];
        let speed = (velocity - motion.velocity_at(point)).dot(direction);
        let inverse = around.bodies.inverse_mass_at(body, point, direction) + 1.0 / mass;
        let force = (speed / inverse / around.time).min(self.controller.max_push_force);
        if !(force > 0.0) {
            return 0.0;
        }
        self.plan.pushes.push(Push { body, point, force: direction * force });
        force * around.time
    }

    /// Applies the weight of the character to the dynamic body below. `before` is the ground of the last
    /// step, with its speed along `up`.
    fn weigh(&mut self, (before, speed): (Option<Entity>, Scalar)) {
        let load = core::mem::take(&mut self.state.load);
        let Some(ground) = self.state.ground_entity.filter(|_| self.state.is_grounded()) else { return };
        let Some(body) = self.around.bodies.body_of(ground) else { return };
        // A flat foot may touch at any of its points.
        let point = self.walker.below_foot(ground).unwrap_or(self.state.ground_point);
        let up = self.walker.up;
        let (mass, gravity) = (self.controller.mass, -self.gravity.dot(up));
        let inverse = self.around.bodies.inverse_mass_at(body, point, up);
        if !(mass > 0.0 && inverse > 0.0) {
            return;
        }
        let is_same = before == Some(ground);
        let (load, yielded) =
            if is_same { (load, speed - self.state.ground_velocity.dot(up)) } else { (0.0, 0.0) };
        self.state.load = borne(load, yielded, (mass, gravity), (inverse, 0.0), self.around.time);
        self.plan.pushes.push(Push { body, point, force: -up * self.state.load });
    }
}
