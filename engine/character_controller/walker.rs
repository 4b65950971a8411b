//! How a character moves among the colliders: along the ground, up steps, and through the air.
//!
//! On the ground it moves by a horizontal way. Whatever is no floor is a vertical wall to it, so that the way
//! is solved in the horizontal plane alone, and floors then tell how far it is lifted. So neither slopes nor
//! walls change its speed.

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

/// The most sweeps of one move. What is left of it then is lost.
const SWEEPS: usize = 6;

/// A character climbs a step that it walks into at up to 75 degrees from straight on: the cosine.
const CLIMBING: Scalar = 0.258_819;

/// Normals with a greater dot product count as one: the cosine of 5 degrees.
const SIMILAR: Scalar = 0.996_194_7;

/// The share of its speed at which a character may part from what it still meets.
const PARTING: Scalar = 1.0e-3;

/// A part that a character touches.
#[derive(Clone, Copy, Debug)]
pub(super) struct Contact {
    pub(super) part: NearPart,
    /// The normal of the ground, if it is ground: of the face beside at an edge.
    pub(super) floor: Option<Vector>,
}

impl Contact {
    /// Whether it is ground at which the part's own normal is that of the ground.
    fn is_face(&self) -> bool {
        self.floor == Some(self.part.normal)
    }
}

/// A character that moves.
pub(super) struct Walker<'a> {
    pub(super) mover: Mover<'a>,
    pub(super) position: Vector,
    /// From the position to the lowest point, along `up`: negative.
    pub(super) feet: Scalar,
    pub(super) up: Vector,
    /// The cosine of the steepest slope.
    pub(super) least_cosine: Scalar,
    pub(super) step_height: Scalar,
    pub(super) step_depth: Scalar,
    pub(super) recovery: Recovery,
    /// What it moved into, with the displacement in a whole step that was stopped there.
    pub(super) met: Vec<(NearPart, Vector)>,
    /// The last step climbed, and the height of all.
    pub(super) climbed: Option<(Entity, Scalar)>,
}

impl<'a> Walker<'a> {
    /// One that climbs no steps, at a position, with the height of its feet along `up`, and its steepest
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

    /// The lowest point of the character, below its position.
    pub(super) fn foot(&self) -> Vector {
        self.position + self.up * self.feet
    }

    /// What it touches. One that walks stands on edges of ground, too.
    pub(super) fn contacts(&self, stopped_by: Option<NearPart>, is_walking: bool) -> Vec<Contact> {
        let parts = self.mover.touching(self.position, stopped_by);
        parts.into_iter().map(|part| Contact { floor: self.floor_of(&part, is_walking), part }).collect()
    }

    /// The normal of the ground at a part: none where it is too steep.
    pub(super) fn floor_of(&self, part: &NearPart, is_walking: bool) -> Option<Vector> {
        let rise = part.normal.dot(self.up);
        if rise >= self.least_cosine {
            return Some(part.normal);
        }
        let height = (part.points[0] - self.foot()).dot(self.up);
        if !is_walking || rise < EDGE || height > self.step_height {
            return None;
        }
        // From above the face beside the edge, if there is one.
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

    /// The point of a collider that it stands on below the middle of its foot, if there is one.
    pub(super) fn below_foot(&self, ground: Entity) -> Option<Vector> {
        let aside = self.mover.skin.max(self.mover.slack());
        let from = self.foot() + self.up * aside;
        let down = Dir::new(-self.up.f32()).ok()?;
        let is_it = |entity| entity == ground;
        let queries = self.mover.queries;
        let hit = queries.cast_ray_predicate(from, down, 4.0 * aside, true, self.mover.filter, &is_it)?;
        Some(from - self.up * hit.distance)
    }

    /// The best ground of some contacts: the flattest face, or else an edge.
    pub(super) fn ground(contacts: &[Contact], up: Vector) -> Option<Contact> {
        let rank = |contact: &&Contact| (contact.part.normal.dot(up), contact.is_face());
        let grounds = contacts.iter().filter(|contact| contact.floor.is_some());
        grounds.max_by(|a, b| rank(a).0.total_cmp(&rank(b).0).then(rank(a).1.cmp(&rank(b).1))).copied()
    }

    /// How far a floor lifts on a horizontal way.
    pub(super) fn lift(&self, floor: Vector, way: Vector) -> Scalar {
        -floor.dot(way) / floor.dot(self.up)
    }

    /// Walks by a horizontal way, on a floor. Returns the way of the last sweep, as long as the
    /// whole: it leads on.
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

    /// The motion along walls and floors. Updates the floor that is walked on.
    fn along_contacts(&mut self, contacts: &[Contact], way: Vector, floor: &mut Vector) -> Vector {
        let mut walls = Vec::new();
        for contact in contacts.iter().filter(|contact| !contact.is_face()) {
            let flat = self.horizontal(contact.part.normal);
            // A flat ceiling is none.
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
            // No way up: the slope is a wall.
            let flat = self.horizontal(*floor).normalize_or_zero();
            walls.push(Plane::facing(flat));
            ahead = along(way, &walls);
            lift = 0.0;
        }
        ahead + self.up * lift
    }

    /// Climbs the first step that the way leads into. Returns the share of the way that was walked.
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

    /// Up, ahead and down again: onto a step, if there is ground within its height, and room above.
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
        // A round foot would roll over edges that are higher.
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

    /// Moves down onto ground within reach. False if there is none.
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

    /// Falls for a time, moving by its own velocity as well, which is horizontal. Returns the ground it came
    /// onto, with the speed, and the time left.
    pub(super) fn fly(
        &mut self,
        fall: &mut Vector,
        own: Vector,
        gravity: Vector,
        time: Scalar,
    ) -> Option<(Contact, Scalar, Scalar)> {
        // The mean velocity of the step: the path is exact.
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

    /// Moves by a displacement, sliding along what it meets. Returns whether it went all the way.
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
