//! The motion of a character among colliders: along the ground, up steps, and through the air.
//!
//! On the ground the input is a horizontal displacement. Surfaces that are not floors act as vertical walls.
//! So the motion is solved in the horizontal plane alone, and floors then determine the lift. Neither slopes
//! nor walls change the speed of the character.

use super::{
    move_and_slide::MoveAndSlideConfig,
    mover::{EDGE, Mover, Recovery, Sweep},
    planes::{Plane, add_facing},
    velocity_project::along,
};
use crate::{
    math::{AdjustPrecision, AsF32, Dir, Scalar, Vector, to_f32},
    spatial_query::NearPart,
};
use bevy_ecs::prelude::*;

/// Maximum number of sweeps per move. The rest of the move is lost.
const SWEEPS: usize = 6;

/// A character climbs a step that it walks into at up to 75 degrees from straight on: the cosine.
const CLIMBING: Scalar = 0.258_819;

/// Normals with a greater dot product count as one: the cosine of 5 degrees.
const SIMILAR: Scalar = 0.996_194_7;

/// The minimum share of its speed at which a character that touches a collider counts as parting from it.
const PARTING: Scalar = 1.0e-3;

/// A part that a character touches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) part: NearPart,
    /// The normal of the ground, if the part is ground: at an edge the normal of the adjacent face.
    pub(super) floor: Option<Vector>,
}

impl Contact {
    /// Whether the part is ground, and its own normal is the ground normal.
    fn is_face(&self) -> bool {
        self.floor == Some(self.part.normal)
    }
}

/// A moving character.
pub(super) struct Walker<'a> {
    pub(super) mover: Mover<'a>,
    pub(super) position: Vector,
    /// The lowest point relative to the position, along `up`: negative.
    pub(super) feet: Scalar,
    pub(super) up: Vector,
    /// The cosine of the steepest slope.
    pub(super) least_cosine: Scalar,
    pub(super) step_height: Scalar,
    pub(super) step_depth: Scalar,
    pub(super) recovery: Recovery,
    /// The parts that the character moved into, each with the displacement in a whole step that was stopped
    /// there.
    pub(super) met: Vec<(NearPart, Vector)>,
    /// The last climbed step, and the total height of all climbed steps.
    pub(super) climbed: Option<(Entity, Scalar)>,
}

impl<'a> Walker<'a> {
    /// A walker that climbs no steps, at a position, with the height of its feet along `up`, and its steepest
    /// slope in radians.
    pub(super) fn new(
        mover: Mover<'a>,
        position: Vector,
        (up, feet): (Vector, Scalar),
        max_slope: Scalar,
        config: &MoveAndSlideConfig,
    ) -> Self {
        let unit = mover.unit;
        Self {
            mover,
            position,
            feet,
            up,
            least_cosine: kernel::math::cos(f64::from(to_f32(max_slope))).adjust_precision(),
            step_height: 0.0,
            step_depth: 0.0,
            recovery: Recovery {
                rounds: config.depenetration_iterations,
                error: config.max_depenetration_error * unit,
                deepest: config.penetration_rejection_threshold * unit,
                up,
            },
            met: Vec::new(),
            climbed: None,
        }
    }
}

impl Walker<'_> {
    pub(super) fn horizontal(&self, v: Vector) -> Vector {
        v - self.up * v.dot(self.up)
    }

    /// The lowest point of the character, directly below its position.
    pub(super) fn foot(&self) -> Vector {
        self.position + self.up * self.feet
    }

    /// The contacts of the character. A walking character also stands on edges of ground.
    pub(super) fn contacts(&self, stopped_by: Option<NearPart>, is_walking: bool) -> Vec<Contact> {
        let parts = self.mover.touching(self.position, stopped_by);
        parts.into_iter().map(|part| Contact { floor: self.floor_of(&part, is_walking), part }).collect()
    }

    /// The ground normal at a part: `None` if it is too steep.
    pub(super) fn floor_of(&self, part: &NearPart, is_walking: bool) -> Option<Vector> {
        let rise = part.normal.dot(self.up);
        if rise >= self.least_cosine {
            return Some(part.normal);
        }
        let height = (part.points[0] - self.foot()).dot(self.up);
        if !is_walking || rise < EDGE || height > self.step_height {
            return None;
        }
        // Casts a ray from above at the adjacent face of the edge.
        let aside = self.mover.skin.max(self.mover.slack());
        let inward = -self.horizontal(part.normal).normalize_or_zero();
        let from = part.points[0] + (inward + self.up) * aside;
        let down = Dir::new(-self.up.f32()).ok()?;
        let is_it = |entity| entity == part.entity;
        let hit = self.mover.queries.cast_ray_predicate(
            from,
            down,
            2.0 * aside,
            true,
            self.mover.filter,
            &is_it,
        )?;
        (hit.normal.dot(self.up) >= self.least_cosine).then_some(hit.normal)
    }

    /// The point of the ground collider below the middle of the foot, if there is one.
    pub(super) fn below_foot(&self, ground: Entity) -> Option<Vector> {
        let aside = self.mover.skin.max(self.mover.slack());
        let from = self.foot() + self.up * aside;
        let down = Dir::new(-self.up.f32()).ok()?;
        let is_it = |entity| entity == ground;
        let queries = self.mover.queries;
        let hit = queries.cast_ray_predicate(from, down, 4.0 * aside, true, self.mover.filter, &is_it)?;
        Some(from - self.up * hit.distance)
    }

    /// The best ground among the contacts: the flattest one, and a face before an equally flat edge.
    pub(super) fn ground(contacts: &[Contact], up: Vector) -> Option<Contact> {
        let rank = |contact: &&Contact| (contact.part.normal.dot(up), contact.is_face());
        let grounds = contacts.iter().filter(|contact| contact.floor.is_some());
        grounds.max_by(|a, b| rank(a).0.total_cmp(&rank(b).0).then(rank(a).1.cmp(&rank(b).1))).copied()
    }

    /// How far a floor lifts the character over a horizontal displacement.
    pub(super) fn lift(&self, floor: Vector, way: Vector) -> Scalar {
        -floor.dot(way) / floor.dot(self.up)
    }

    /// Walks by a horizontal displacement, on a floor. Returns the motion of the last sweep, scaled to the
    /// whole displacement, so that the motion can continue.
    pub(super) fn walk(&mut self, way: Vector, mut floor: Vector) -> Vector {
        let mut left: Scalar = 1.0;
        let mut stopped_by: Option<Sweep> = None;
        let mut motion = Vector::ZERO;
        for _ in 0..SWEEPS {
            if way == Vector::ZERO {
                break;
            }
            let contacts = self.contacts(stopped_by.map(|hit| hit.part), true);
            if let Some(share) = self.climb_one(&contacts, way * left) {
                left *= 1.0 - share;
                stopped_by = None;
                floor = self.up;
                if left > 0.0 {
                    continue;
                }
                break;
            }
            motion = self.along_contacts(&contacts, way, &mut floor);
            let movement = motion * left;
            if !(movement.length() > 0.0) {
                break;
            }
            stopped_by = self.mover.sweep(self.position, movement);
            let Some(hit) = stopped_by else {
                self.position += movement;
                break;
            };
            let share = (hit.distance / movement.length()).min(1.0);
            self.position += movement * share;
            left *= 1.0 - share;
        }
        motion
    }

    /// The motion along walls and floors. Updates the floor under the character.
    fn along_contacts(&mut self, contacts: &[Contact], way: Vector, floor: &mut Vector) -> Vector {
        let mut walls = Vec::new();
        for contact in contacts.iter().filter(|contact| !contact.is_face()) {
            let flat = self.horizontal(contact.part.normal);
            // A flat ceiling does not count as a wall.
            if flat.length() > EDGE && flat.dot(way) < 0.0 {
                add_facing(&mut walls, flat.normalize(), way, SIMILAR);
                self.met.push((contact.part, way));
            }
        }
        let mut ahead = along(way, &walls);
        let floors: Vec<Vector> = contacts.iter().filter_map(|contact| contact.floor).collect();
        let steepest =
            floors.iter().copied().max_by(|a, b| self.lift(*a, ahead).total_cmp(&self.lift(*b, ahead)));
        *floor = steepest.unwrap_or(*floor);
        let mut lift = self.lift(*floor, ahead);
        let motion = ahead + self.up * lift;
        let is_closing = |contact: &Contact| {
            let normal = contact.part.normal;
            normal.dot(self.up) < -EDGE && normal.dot(motion) < -PARTING * motion.length()
        };
        if lift > 0.0 && contacts.iter().any(is_closing) {
            // The ceiling blocks the slope, so the slope is a wall.
            let flat = self.horizontal(*floor).normalize_or_zero();
            walls.push(Plane::facing(flat));
            ahead = along(way, &walls);
            lift = 0.0;
        }
        ahead + self.up * lift
    }

    /// Climbs the first step that the displacement leads into. Returns the walked share of the displacement.
    fn climb_one(&mut self, contacts: &[Contact], way: Vector) -> Option<Scalar> {
        let length = way.length();
        let is_ahead = |contact: &&Contact| {
            let normal = contact.part.normal;
            let flat = self.horizontal(normal).normalize_or_zero();
            !contact.is_face() && normal.dot(self.up) > -EDGE && -flat.dot(way) > CLIMBING * length
        };
        let step = contacts.iter().find(is_ahead)?.part.entity;
        self.climb(way, step)
    }

    /// Moves up, ahead and down again: onto a step, if there is ground within the step height, and room
    /// above.
    fn climb(&mut self, way: Vector, step: Entity) -> Option<Scalar> {
        let length = way.length();
        let ahead = way / length;
        let free = |from: Vector, way: Vector| {
            let length = way.length();
            self.mover.sweep(from, way).map_or(length, |hit| hit.distance.min(length))
        };
        let rise = free(self.position, self.up * self.step_height);
        let raised = self.position + self.up * rise;
        let room = free(raised, ahead * length.max(self.step_depth));
        if !(rise > self.mover.slack() && room >= self.step_depth) {
            return None;
        }
        let forward = room.min(length);
        let above = raised + ahead * forward;
        let hit = self.mover.sweep(above, -self.up * rise)?;
        // A round foot would roll over higher edges.
        if (hit.part.points[0] - self.foot()).dot(self.up) > self.step_height {
            return None;
        }
        let landed = above - self.up * hit.distance;
        let height = rise - hit.distance;
        let before = core::mem::replace(&mut self.position, landed);
        if height <= self.mover.slack() || self.floor_of(&hit.part, true).is_none() {
            self.position = before;
            return None;
        }
        let so_far = self.climbed.map_or(0.0, |(_, height)| height);
        self.climbed = Some((step, so_far + height));
        Some(forward / length)
    }

    /// Moves down onto ground within reach. Returns false if there is none.
    pub(super) fn snap(&mut self, reach: Scalar) -> bool {
        let Some(hit) = self.mover.sweep(self.position, -self.up * reach) else { return false };
        let before = self.position;
        self.position -= self.up * hit.distance;
        let is_ground = self.floor_of(&hit.part, true).is_some();
        if !is_ground {
            self.position = before;
        }
        is_ground
    }

    /// Falls for a time, with an additional horizontal velocity of its own. Returns the ground on which it
    /// lands, the speed, and the time left.
    pub(super) fn fly(
        &mut self,
        fall: &mut Vector,
        own: Vector,
        gravity: Vector,
        time: Scalar,
    ) -> Option<(Contact, Scalar, Scalar)> {
        // The mean velocity of the step gives the exact path.
        let mean = *fall + gravity * (0.5 * time);
        let mut falling = mean;
        let mut left = time;
        let mut stopped_by: Option<Sweep> = None;
        let (mut planes, mut walls) = (Vec::new(), Vec::new());
        for _ in 0..SWEEPS {
            let contacts = self.contacts(stopped_by.map(|hit| hit.part), false);
            for contact in contacts {
                let normal = contact.part.normal;
                let velocity = falling + along(own, &walls);
                if normal.dot(velocity) > PARTING * velocity.length() {
                    continue;
                }
                if contact.floor.is_some() && normal.dot(falling) < 0.0 {
                    return Some((contact, -falling.dot(self.up), left));
                }
                self.met.push((contact.part, velocity * time));
                add_facing(&mut planes, normal, mean, SIMILAR);
                let flat = self.horizontal(normal);
                if flat.length() > EDGE {
                    add_facing(&mut walls, flat.normalize(), own, SIMILAR);
                }
            }
            falling = along(mean, &planes);
            let movement = (falling + along(own, &walls)) * left;
            if !(movement.length() > 0.0) {
                break;
            }
            stopped_by = self.mover.sweep(self.position, movement);
            let Some(hit) = stopped_by else {
                self.position += movement;
                break;
            };
            let share = (hit.distance / movement.length()).min(1.0);
            self.position += movement * share;
            left *= 1.0 - share;
        }
        *fall = along(falling + gravity * (0.5 * time), &planes);
        None
    }

    /// Moves by a displacement, sliding along obstacles. Returns whether it completed the displacement.
    pub(super) fn shift(&mut self, way: Vector) -> bool {
        let mut left: Scalar = 1.0;
        let mut motion = way;
        let mut stopped_by: Option<Sweep> = None;
        for _ in 0..SWEEPS {
            if motion == Vector::ZERO {
                return way == Vector::ZERO;
            }
            let parts = self.mover.touching(self.position, stopped_by.map(|hit| hit.part));
            let mut planes = Vec::new();
            parts.iter().for_each(|part| add_facing(&mut planes, part.normal, way, SIMILAR));
            motion = along(way, &planes);
            let movement = motion * left;
            if !(movement.length() > 0.0) {
                break;
            }
            stopped_by = self.mover.sweep(self.position, movement);
            let Some(hit) = stopped_by else {
                self.position += movement;
                return motion == way;
            };
            let share = (hit.distance / movement.length()).min(1.0);
            self.position += movement * share;
            left *= 1.0 - share;
        }
        false
    }
}
