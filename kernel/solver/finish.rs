//! After the last substep: from rows back to the tables.
#![expect(unsafe_code, reason = "bodies are changed by several threads, each its own")]

use super::{BodyRow, Solver};
use crate::data::Parts;
use crate::math::{Rot, WorldPose};
use crate::table::{BodyTable, Velocity};
use std::sync::{Mutex, PoisonError};

/// How many bodies a member of the team finishes at a stretch.
const BLOCK: usize = 256;

impl Solver {
    /// Folds the motion of each body into its pose, notes its velocity if it is dynamic, and counts the time for
    /// which it has been at rest. `listed` are the bodies in the order of their rows, from row 1; `frames` receives
    /// the frame of each that [moved](BodyRow::is_moved), by its id.
    ///
    /// Returns the rows whose result is not finite, in no order: these bodies keep pose and velocity.
    pub fn finish(
        &mut self,
        bodies: &mut BodyTable,
        listed: &[u32],
        frames: &mut [WorldPose],
        dt: f32,
    ) -> Vec<u32> {
        let first_dynamic = self.bodies.first_dynamic as usize;
        let rows = &self.bodies.rows[1..];
        let parts = bodies.parts();
        let frames = Parts::of(frames);
        let lost = Mutex::new(Vec::new());
        let finish = |row: usize, id: usize, motion: &BodyRow| {
            if parts.rows[id] as usize != row {
                return;
            }
            // SAFETY: no two bodies have one row, and each row is finished once.
            let (body, pose, velocity, frame) = unsafe {
                (parts.bodies.one(id), parts.poses.one(id), parts.velocities.one(id), frames.one(id))
            };
            let ((v, w), (moved, turned)) = (motion.velocity(), motion.delta());
            let mut new = *pose;
            if motion.is_moved() {
                new.center = pose.center + moved.to_world();
                new.rotation = turned.mul(pose.rotation).renormalized();
            }
            let placed = new.center.is_finite_world() & new.rotation.is_finite();
            if !(placed & v.is_finite() & w.is_finite()) {
                lost.lock().unwrap_or_else(PoisonError::into_inner).push(row as u32);
                return;
            }
            if row >= first_dynamic {
                new.speed = v.length();
                *velocity = Velocity { linear: v, angular: w };
            }
            *pose = new;
            if motion.is_moved() {
                *frame = new.frame(body.local_center);
            }
            let angle_squared = Rot::IDENTITY.difference(turned).length_squared();
            let rests = body.rest_speed.admits(moved, angle_squared, dt);
            body.sleep_timer = if rests { body.sleep_timer + dt } else { 0.0 };
        };
        let blocks = listed.chunks(BLOCK).zip(rows.chunks(BLOCK)).enumerate();
        self.team.each(blocks, |(block, (ids, rows))| {
            for (i, (id, motion)) in ids.iter().zip(rows).enumerate() {
                finish(1 + block * BLOCK + i, *id as usize, motion);
            }
        });
        lost.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}
