//! Where shapes will meet that are too far apart now, because a body turns.
//!
//! A point far out on a turning body goes along an arc. The normal from where it is now leads past what the arc meets, and
//! to what it passes by. So the pair is followed to when it meets (conservative advancement), and the solver gets the
//! contact as it is then, with the separations that bring it there.

use super::phase::{ManifoldSource, NarrowPhase, smaller};
use super::record::{Contact, Manifold};
use crate::manifold::{self, LocalManifold};
use crate::math::{Rot, Vector, WorldPose, max, min};
use crate::table::{BodyPose, MOST_TURN, NONE};

/// How many steps a pair is followed at most.
const ROUNDS: usize = 12;

/// Shapes meet that are no farther apart than this share of the smaller one's reach.
const MET: f32 = 0.02;

/// How a contact lies when its shapes meet in the course of the step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Meeting {
    /// Of A's collider.
    pub(super) pose_a: WorldPose,
    /// A's centre of mass, and B's from there.
    pub(super) body_a: BodyPose,
    pub(super) offset: Vector,
    /// How far the bodies turn until then.
    turns: [Rot; 2],
    /// How far B's centre of mass shifts against A's until then.
    shift: Vector,
}

/// A side of a contact at some time in the step.
struct Placed {
    body: BodyPose,
    turn: Rot,
    shape: WorldPose,
}

impl<S: ManifoldSource> NarrowPhase<'_, S> {
    /// Follows two native shapes that are `gap` apart, margins aside, to when they meet in this step only because one turns.
    /// `local` then has the points up to `prediction` apart, else none.
    #[inline(never)]
    pub(super) fn meeting(
        &self,
        contact: &mut Contact,
        poses: [&BodyPose; 2],
        mut gap: f32,
        prediction: f32,
        local: &mut LocalManifold,
    ) -> Option<Meeting> {
        let farthest = self.farthest(contact, prediction);
        if gap > farthest || !(farthest > prediction) {
            return None;
        }
        let [a, b] = contact.colliders;
        let shapes = [&self.colliders[a].def.shape, &self.colliders[b].def.shape];
        let reaches = self.reaches(contact);
        let velocities = [self.velocity(contact, 0), self.velocity(contact, 1)];
        let spins = velocities.map(|velocity| velocity.angular.length());
        let arms = [self.arm(contact, 0), self.arm(contact, 1)];
        let margin = self.margin(contact);
        let met = min(self.tolerance, MET * smaller([reaches[0].extent, reaches[1].extent]));
        let speed = (velocities[1].linear - velocities[0].linear).length();
        let end = min(self.dt, MOST_TURN / max(spins[0], spins[1]));
        let mut offset = (poses[1].center - poses[0].center).to_local();
        let mut time = 0.0;
        for _ in 0..ROUNDS {
            // No part of one comes nearer to the other faster than this. Where they meet is no farther out than the other is.
            let far = offset.length();
            let arm = |side: usize| match reaches[1 - side].extent {
                0.0 => arms[side],
                other => min(arms[side], far + other),
            };
            let rate = speed + arm(0) * spins[0] + arm(1) * spins[1];
            // What is near is not approached for ever.
            time += max(gap, 0.5 * met) / rate;
            if !(time < end) {
                break;
            }
            let placed: [Placed; 2] = core::array::from_fn(|side| self.at(contact, side, poses[side], time));
            offset = (placed[1].body.center - placed[0].body.center).to_local();
            let relative = placed[0].shape.relative(&placed[1].shape);
            let cache = &mut contact.cache;
            let mut look = |up_to: f32| {
                manifold::collide(shapes[0], shapes[1], &relative, up_to + margin, cache, local);
                nearest(local) - margin
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

    /// Where a side of the contact is at some time after the step's start.
    fn at(&self, contact: &Contact, side: usize, pose: &BodyPose, time: f32) -> Placed {
        let (body, collider) = (contact.bodies[side], contact.colliders[side]);
        let mut placed =
            Placed { body: *pose, turn: Rot::IDENTITY, shape: self.colliders.poses[collider as usize] };
        if body != NONE {
            let velocity = self.bodies.velocities[body as usize];
            placed.turn = Rot::IDENTITY.turned_by(velocity.angular * time);
            placed.body.center += (velocity.linear * time).to_world();
            placed.body.rotation = placed.turn.mul(pose.rotation);
            let frame = placed.body.frame(self.bodies[body].local_center);
            placed.shape = frame.then(&self.colliders[collider].def.local);
        }
        placed
    }
}

impl Meeting {
    /// Takes the separations of a manifold back to the step's start, so that the solver, which follows the bodies with these
    /// arms, comes to them at the right time.
    pub(super) fn take_back(&self, m: &mut Manifold) {
        let n = m.normal;
        let cores = [n * m.rounding[0], self.offset - n * m.rounding[1]];
        let along = self.shift.dot(n);
        for p in &mut m.points[..m.count as usize] {
            let shifts: [f32; 2] = core::array::from_fn(|side| {
                let arm = p.anchor - cores[side];
                self.turns[side].shift_along(arm, arm.cross(n), n)
            });
            p.separation -= along + shifts[1] - shifts[0];
            p.frozen_separation = p.separation;
        }
    }
}

/// How far apart two shapes are at least, margins not subtracted.
fn nearest(local: &LocalManifold) -> f32 {
    if local.count == 0 {
        return local.apart;
    }
    local.points().iter().fold(f32::INFINITY, |least, p| min(least, p.separation))
}
