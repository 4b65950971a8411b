//! Where shapes will meet that do not touch now.
//!
//! The plane at the present closest points is no wall: what passes by would be stopped by it, and a point far out on a
//! turning body moves along an arc. So the pair is followed to when it meets (conservative advancement, after B. Mirtich).
//! The solver gets the contact of that time, with separations that bring it there. A pair that does not meet has none.

use super::input::{NarrowPhaseInput, smaller};
use super::record::{Contact, Manifold};
use crate::manifold::{self, LocalManifold};
use crate::math::{Rot, Vector, WorldPose, max, min};
use crate::table::{BodyPose, MOST_TURN, NONE};

/// Most steps of conservative advancement. A pair that takes more meets where it then is.
const MAX_ROUNDS: usize = 24;

/// Shapes meet when they are no farther apart than the tolerance and this share of the smaller one's reach. More stops what
/// passes by; less takes more rounds.
const MET: f32 = 0.02;

/// Shapes that move past each other meet at this share of that.
const MET_STRAIGHT: f32 = 0.1;

/// Bodies that turn by more than this in the step, in radians, are not cast past what they are near to.
const MOST_STRAIGHT_TURN: f32 = 0.75;

/// The solver lets points close no further than they may by the end of the first substep after the step. So points count
/// as pushing that close within this many steps, the most that can be.
const AHEAD: f32 = 2.0;

/// The poses at a time within the step: when the shapes meet, or in its middle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// The pose of A's collider.
    pub(super) pose_a: WorldPose,
    /// The pose of A's body.
    pub(super) body_a: BodyPose,
    /// From A's to B's centre of mass.
    pub(super) offset: Vector,
    /// How far the bodies turn until then.
    turns: [Rot; 2],
    /// How far B's centre of mass shifts against A's until then.
    shift: Vector,
}

/// One side of a contact at some time within the step.
pub(super) struct Placed {
    body: BodyPose,
    turn: Rot,
    pub(super) shape: WorldPose,
}

/// Follows two native shapes, `gap` apart without margins, to the time when they meet in this step. `local` has their
/// present points, if there are any within `prediction`, and receives those of that time, else none.
#[inline(never)]
pub(super) fn find_meeting<S>(
    input: &NarrowPhaseInput<S>,
    contact: &mut Contact,
    poses: [&BodyPose; 2],
    mut gap: f32,
    prediction: f32,
    local: &mut LocalManifold,
) -> Option<Meeting> {
    let farthest = input.farthest(contact, prediction);
    if gap > farthest || (local.count == 0 && !(farthest > prediction)) {
        return None;
    }
    let [a, b] = contact.colliders;
    let shapes = [&input.colliders[a].def.shape, &input.colliders[b].def.shape];
    let mut motion = Motion::new(input, contact);
    if local.count > 0 {
        motion.met *= MET_STRAIGHT;
    }
    let margin = input.margin(contact);
    let mut offset = (poses[1].center - poses[0].center).to_local();
    let end = min(input.dt, MOST_TURN / max(motion.spins[0], motion.spins[1]));
    let mut rotation = input.colliders.poses[a as usize].rotation;
    let mut time = 0.0;
    for round in 1..=MAX_ROUNDS {
        let rate = match local.count {
            0 => motion.fastest(offset),
            _ => motion.closing(rotation.rotate(local.normal), offset),
        };
        // A smallest step, so that the advance does not slow down without end.
        time += max(gap, 0.5 * motion.met) / rate;
        if !(rate > 0.0 && time < end) {
            break;
        }
        let placed = place_at(input, contact, poses, time);
        offset = (placed[1].body.center - placed[0].body.center).to_local();
        rotation = placed[0].shape.rotation;
        let relative = placed[0].shape.relative(&placed[1].shape);
        // What is farther away than the rest of the motion does not meet.
        let rest = max(farthest * (1.0 - time / input.dt), input.near(contact)) + margin;
        manifold::collide(shapes[0], shapes[1], &relative, rest, &mut contact.cache, local);
        gap = local.lower_bound() - margin;
        if gap <= motion.met || (round == MAX_ROUNDS && local.count > 0) {
            // Points that only turning brings together are found again when they are near.
            let prediction = prediction + margin;
            manifold::collide(shapes[0], shapes[1], &relative, prediction, &mut contact.cache, local);
            if local.count == 0 {
                return None;
            }
            return Some(Meeting::new(&placed, poses));
        }
    }
    local.count = 0;
    None
}

/// Whether two shapes that have points, and do not touch, may pass each other by in this step: their motion may cross the
/// plane between them.
#[inline(always)]
pub(super) fn may_pass_by<S>(
    input: &NarrowPhaseInput<S>,
    contact: &Contact,
    poses: [&BodyPose; 2],
    local: &LocalManifold,
) -> bool {
    let motion = Motion::new(input, contact);
    let gap = local.lower_bound() - input.margin(contact);
    let normal = input.colliders.poses[contact.colliders[0] as usize].rotation.rotate(local.normal);
    let offset = (poses[1].center - poses[0].center).to_local();
    // The solver keeps the arms of the step's start. What turns farther gains energy if it is pushed where it comes to.
    let turn = |side: usize| if motion.arms[side] > 0.0 { motion.spins[side] * input.dt } else { 0.0 };
    let is_straight = max(turn(0), turn(1)) < MOST_STRAIGHT_TURN;
    is_straight
        && gap > MET_STRAIGHT * motion.met
        && motion.closing(normal, offset) * (AHEAD * input.dt) > gap
}

/// Whether the solver would push at some point if the bodies kept their velocities.
pub(super) fn pushes<S>(
    input: &NarrowPhaseInput<S>,
    contact: &Contact,
    poses: [&BodyPose; 2],
    local: &LocalManifold,
) -> bool {
    let frame = &input.colliders.poses[contact.colliders[0] as usize];
    let normal = frame.rotation.rotate(local.normal);
    let margin = input.margin(contact);
    local.points().iter().any(|p| {
        let place = frame.transform(p.point);
        let [a, b] = [0, 1].map(|side| {
            let velocity = input.velocity(contact, side);
            velocity.linear + velocity.angular.cross((place - poses[side].center).to_local())
        });
        (a - b).dot(normal) * (AHEAD * input.dt) > p.separation - margin
    })
}

/// How fast two shapes may close in this step.
struct Motion {
    /// The velocity of B against A.
    linear: Vector,
    spins: [f32; 2],
    arms: [f32; 2],
    extents: [f32; 2],
    /// The distance at which they count as having met.
    met: f32,
}

impl Motion {
    fn new<S>(input: &NarrowPhaseInput<S>, contact: &Contact) -> Self {
        let reaches = input.reaches(contact);
        let extents = reaches.map(|reach| reach.extent);
        let [a, b] = [input.velocity(contact, 0), input.velocity(contact, 1)];
        Self {
            linear: b.linear - a.linear,
            spins: [a.angular.length(), b.angular.length()],
            arms: reaches.map(|reach| reach.arm),
            extents,
            met: min(input.tolerance, MET * smaller(extents)),
        }
    }

    /// An upper bound of the speed at which turning brings the shapes together. They meet no farther out than the other
    /// shape reaches; `offset` is from A's to B's centre of mass.
    fn turning(&self, offset: Vector) -> f32 {
        let far = offset.length();
        let arm = |side: usize| match self.extents[1 - side] {
            0.0 => self.arms[side],
            other => min(self.arms[side], far + other),
        };
        arm(0) * self.spins[0] + arm(1) * self.spins[1]
    }

    /// An upper bound of the speed at which the shapes close.
    fn fastest(&self, offset: Vector) -> f32 {
        self.linear.length() + self.turning(offset)
    }

    /// The same along a normal from A to B: the slab between the shapes is not crossed sooner.
    fn closing(&self, normal: Vector, offset: Vector) -> f32 {
        self.turning(offset) - self.linear.dot(normal)
    }
}

/// Both sides of the contact, `time` seconds after the step's start.
pub(super) fn place_at<S>(
    input: &NarrowPhaseInput<S>,
    contact: &Contact,
    poses: [&BodyPose; 2],
    time: f32,
) -> [Placed; 2] {
    core::array::from_fn(|side| {
        let (body, collider) = (contact.bodies[side], contact.colliders[side]);
        let shape = input.colliders.poses[collider as usize];
        let mut placed = Placed { body: *poses[side], turn: Rot::IDENTITY, shape };
        if body != NONE {
            let velocity = input.bodies.velocities[body as usize];
            placed.turn = Rot::IDENTITY.turned_by(velocity.angular * time);
            placed.body.center += (velocity.linear * time).to_world();
            placed.body.rotation = placed.turn.mul(poses[side].rotation);
            let frame = placed.body.frame(input.bodies[body].local_center);
            placed.shape = frame.then(&input.colliders[collider].def.local);
        }
        placed
    })
}

impl Meeting {
    /// From both sides at that time, and the poses of their bodies at the step's start.
    pub(super) fn new(placed: &[Placed; 2], poses: [&BodyPose; 2]) -> Self {
        let offset = (placed[1].body.center - placed[0].body.center).to_local();
        Self {
            pose_a: placed[0].shape,
            body_a: placed[0].body,
            offset,
            turns: [placed[0].turn, placed[1].turn],
            shift: offset - (poses[1].center - poses[0].center).to_local(),
        }
    }

    /// Changes the separations of a manifold to those at the step's start. The solver moves the bodies with these arms, and
    /// so reaches the given separations at that time.
    pub(super) fn rewind(&self, m: &mut Manifold) {
        let n = m.normal;
        let cores = [n * m.radii[0], self.offset - n * m.radii[1]];
        let along = self.shift.dot(n);
        for p in &mut m.points[..usize::from(m.count)] {
            let shifts: [f32; 2] = core::array::from_fn(|side| {
                let arm = p.anchor - cores[side];
                self.turns[side].shift_along(arm, arm.cross(n), n)
            });
            p.separation -= along + shifts[1] - shifts[0];
            p.frozen_separation = p.separation;
        }
    }
}
