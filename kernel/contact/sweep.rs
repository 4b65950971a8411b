//! Where shapes will meet that are too far apart now, because a body turns.
//!
//! A point far out on a turning body moves along an arc. The normal at its present place misses what the arc meets, and
//! stops what only passes by. So the pair is followed to when it meets (conservative advancement). The solver gets the
//! contact of that time, with separations that bring it there.

use super::input::{NarrowPhaseInput, smaller};
use super::record::{Contact, Manifold};
use crate::manifold::{self, LocalManifold};
use crate::math::{Rot, Vector, WorldPose, max, min};
use crate::table::{BodyPose, MOST_TURN, NONE};

/// Most steps of conservative advancement. Pairs that take more are treated as not meeting.
const MAX_ROUNDS: usize = 12;

/// Shapes meet when they are no farther apart than this share of the smaller one's reach. Less takes more rounds.
const MET: f32 = 0.02;

/// The poses at the time within the step when the shapes meet.
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
struct Placed {
    body: BodyPose,
    turn: Rot,
    shape: WorldPose,
}

/// Follows two native shapes, `gap` apart without margins, to the time when they meet because one turns. `local` then
/// has the points up to `prediction` apart, else none.
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
    if gap > farthest || !(farthest > prediction) {
        return None;
    }
    let [a, b] = contact.colliders;
    let shapes = [&input.colliders[a].def.shape, &input.colliders[b].def.shape];
    let reaches = input.reaches(contact);
    let velocities = [input.velocity(contact, 0), input.velocity(contact, 1)];
    let spins = velocities.map(|velocity| velocity.angular.length());
    let arms = [input.arm(contact, 0), input.arm(contact, 1)];
    let margin = input.margin(contact);
    let met = min(input.tolerance, MET * smaller([reaches[0].extent, reaches[1].extent]));
    let speed = (velocities[1].linear - velocities[0].linear).length();
    let end = min(input.dt, MOST_TURN / max(spins[0], spins[1]));
    let mut offset = (poses[1].center - poses[0].center).to_local();
    let mut time = 0.0;
    for _ in 0..MAX_ROUNDS {
        // An upper bound of the closing speed. The shapes meet no farther out than the other shape reaches.
        let far = offset.length();
        let arm = |side: usize| match reaches[1 - side].extent {
            0.0 => arms[side],
            other => min(arms[side], far + other),
        };
        let rate = speed + arm(0) * spins[0] + arm(1) * spins[1];
        // A smallest step, so that the advance does not slow down without end.
        time += max(gap, 0.5 * met) / rate;
        if !(time < end) {
            break;
        }
        let placed: [Placed; 2] =
            core::array::from_fn(|side| place_at(input, contact, side, poses[side], time));
        offset = (placed[1].body.center - placed[0].body.center).to_local();
        let relative = placed[0].shape.relative(&placed[1].shape);
        let cache = &mut contact.cache;
        let mut look = |up_to: f32| {
            manifold::collide(shapes[0], shapes[1], &relative, up_to + margin, cache, local);
            lower_bound(local) - margin
        };
        gap = look(farthest);
        if gap <= met {
            look(prediction);
            if local.count == 0 {
                return None;
            }
            let before = (poses[1].center - poses[0].center).to_local();
            return Some(Meeting {
                pose_a: placed[0].shape,
                body_a: placed[0].body,
                offset,
                turns: [placed[0].turn, placed[1].turn],
                shift: offset - before,
            });
        }
    }
    local.count = 0;
    None
}

/// One side of the contact, `time` seconds after the step's start.
fn place_at<S>(
    input: &NarrowPhaseInput<S>,
    contact: &Contact,
    side: usize,
    pose: &BodyPose,
    time: f32,
) -> Placed {
    let (body, collider) = (contact.bodies[side], contact.colliders[side]);
    let mut placed =
        Placed { body: *pose, turn: Rot::IDENTITY, shape: input.colliders.poses[collider as usize] };
    if body != NONE {
        let velocity = input.bodies.velocities[body as usize];
        placed.turn = Rot::IDENTITY.turned_by(velocity.angular * time);
        placed.body.center += (velocity.linear * time).to_world();
        placed.body.rotation = placed.turn.mul(pose.rotation);
        let frame = placed.body.frame(input.bodies[body].local_center);
        placed.shape = frame.then(&input.colliders[collider].def.local);
    }
    placed
}

impl Meeting {
    /// Changes the separations of a manifold to those at the step's start. The solver moves the bodies with these arms, and
    /// so reaches the given separations at the time of the meeting.
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

/// A lower bound of the distance between the shapes, margins not subtracted.
fn lower_bound(local: &LocalManifold) -> f32 {
    if local.count == 0 {
        return local.gap;
    }
    local.points().iter().fold(f32::INFINITY, |least, p| min(least, p.separation))
}
