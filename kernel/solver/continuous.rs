//! Stops bodies that moved far at their first impact; see [`ccd`](crate::ccd).

use super::{BodyRow, Solver, gyro::*};
use crate::ccd::{Path, SweepBuffers, SweepInput, Swept};
use crate::data::BitSet;
use crate::graph::ConstraintKind;
use crate::math::{Angular, Vector, max, min};
use crate::thread_pool::ThreadPool;

/// Number of bodies in a block of the job. More leaves workers idle at the end, fewer cost more claims.
const BLOCK: usize = 64;

/// Number of swept bodies in a block of the job.
const SWEPT_BLOCK: usize = 8;

impl Solver {
    /// Moves fast bodies back to their first impact with static geometry, each together with the bodies
    /// joined to it. `listed` are the bodies in row order, from row 1. `workers` are buffers, kept between
    /// steps.
    pub fn stop_fast(
        &mut self,
        input: &SweepInput,
        listed: &[u32],
        workers: &mut Vec<SweepBuffers>,
        pool: &ThreadPool,
    ) {
        let first_dynamic = self.bodies.first_dynamic();
        let listed = &listed[..listed.len().min(self.bodies.rows.len().saturating_sub(1))];
        let rows = &self.bodies.rows;
        pool.each_into(workers, listed.chunks(BLOCK).enumerate(), |buffers, (block, ids)| {
            for (i, &body) in ids.iter().enumerate() {
                let row = (1 + block * BLOCK + i) as u32;
                if row < first_dynamic || input.bodies.row(body) != row {
                    continue;
                }
                let moved = &rows[row as usize];
                let (way, turn) = moved.delta();
                // A body that rotates by more than half a turn seems to rotate less by `turn`.
                let angle = max(turn.small_turn().length(), moved.velocity().1.length() * input.dt);
                if !input.is_far(body, way.length(), angle) || !input.may_meet(body, way) {
                    continue;
                }
                let fraction = input.stop(body, &path(input, body, moved), buffers);
                if fraction < 1.0 {
                    buffers.stops.push((body, fraction));
                }
            }
        });
        self.put_back_all(input, workers, |row, fraction| {
            // Contacts do not stop a body that spins fast: it would be moved back in every step and keep
            // its speed.
            if fraction == 0.0 {
                row.set_velocity(Vector::ZERO, Angular::ZERO);
            }
        });
    }

    /// Moves back bodies that are swept against moving bodies, and the bodies they met, including kinematic
    /// ones. Each body stops at its first impact.
    pub fn stop_swept(
        &mut self,
        input: &SweepInput,
        swept: &[(u32, Swept)],
        workers: &mut Vec<SweepBuffers>,
        pool: &ThreadPool,
    ) {
        if swept.is_empty() {
            return;
        }
        let rows = &self.bodies.rows;
        let path_of = |body: u32| match input.bodies.row(body) {
            0 => None,
            row => rows.get(row as usize).map(|row| path(input, body, row)),
        };
        pool.each_into(workers, swept.chunks(SWEPT_BLOCK), |buffers, swept| {
            swept.iter().for_each(|(body, swept)| input.stop_swept(*body, swept, &path_of, buffers));
        });
        self.put_back_all(input, workers, |_, _| ());
    }

    /// Moves all stopped bodies back, each to its first impact, together with the bodies joined to them.
    /// Calls `stopped` for each, with the fraction of the step.
    fn put_back_all(
        &mut self,
        input: &SweepInput,
        workers: &mut [SweepBuffers],
        stopped: impl Fn(&mut BodyRow, f32),
    ) {
        let mut stops: Vec<_> = workers.iter_mut().flat_map(|worker| worker.stops.drain(..)).collect();
        if stops.is_empty() {
            return;
        }
        stops.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        stops.dedup_by_key(|stop| stop.0);
        for (body, fraction) in self.joined(input, &stops) {
            let row = input.bodies.row(body) as usize;
            let Some(moved) = self.bodies.rows.get_mut(row).filter(|_| row > 0) else { continue };
            let path = path(input, body, moved);
            put_back(moved, &path, fraction, self.bodies.motions[row].acceleration);
            stopped(moved, fraction);
            self.bodies.moved.insert(row as u32);
            mark_outdated(input, body, &mut self.outdated);
        }
    }

    /// All stopped bodies and the bodies joined to them, each with its fraction of the step. `stops` is
    /// sorted by body id. Joined bodies stop together, at the first impact of the group; otherwise the
    /// joints would open by the distance that one body moves back. A body that cannot move at all (fraction
    /// 0) stops alone: it would hold the others in the air.
    fn joined(&self, input: &SweepInput, stops: &[(u32, f32)]) -> Vec<(u32, f32)> {
        let own = |body: u32| stops.binary_search_by_key(&body, |stop| stop.0).ok().map(|k| stops[k].1);
        let first_dynamic = self.bodies.first_dynamic();
        let joints = input.bodies.constraints(ConstraintKind::Joint);
        let (mut seen, mut all) = (BitSet::default(), Vec::new());
        for (body, _) in stops.iter().copied() {
            let mut next = all.len();
            let start = next;
            if seen.insert(body) {
                all.push((body, 1.0));
            }
            while let Some((body, _)) = all.get(next).copied() {
                next += 1;
                for id in joints.of_body(body).filter(|id| self.joints.holds(*id)) {
                    let stops = |other: u32| input.bodies.row(other) >= first_dynamic || own(other).is_some();
                    let others = joints.get(id).bodies.into_iter().filter(|other| stops(*other));
                    all.extend(others.filter(|other| seen.insert(*other)).map(|other| (other, 1.0)));
                }
            }
            let group = &mut all[start..];
            let impacts = group.iter().filter_map(|one| own(one.0)).filter(|fraction| *fraction > 0.0);
            let first = impacts.fold(1.0, min);
            group.iter_mut().for_each(|one| one.1 = if own(one.0) == Some(0.0) { 0.0 } else { first });
        }
        all.retain(|one| one.1 < 1.0);
        all
    }
}

/// Marks the contacts of a body that was moved back as outdated. The narrow phase had no points where the
/// body met the other one, so it has to update these contacts.
fn mark_outdated(input: &SweepInput, body: u32, outdated: &mut Vec<u32>) {
    for collider in input.colliders.of_body(body, input.bodies) {
        outdated.extend(input.contacts.of_collider(collider, input.colliders));
    }
}

/// Moves a body back to a fraction of its path, without a gain of energy.
///
/// Its speed drops by the potential energy that the body gains: a body that is stopped while it falls would
/// fall the same distance twice. Its angular velocity is rotated back as well, so that a rod that spins
/// about its own axis goes on spinning about that axis.
fn put_back(row: &mut BodyRow, path: &Path, fraction: f32, acceleration: Vector) {
    let ((v, w), (_, end)) = (row.velocity(), row.delta());
    let (way, turn) = path.delta(fraction);
    row.set_delta(way, turn);
    let (square, gained) = (v.length_squared(), 2.0 * acceleration.dot(path.way - way));
    let kept = if gained > 0.0 && square > 0.0 { max(1.0 - gained / square, 0.0).sqrt() } else { 1.0 };
    row.set_velocity(v * kept, to_world(turn, to_body(end, w)));
}

/// The path of a body in this step.
fn path(input: &SweepInput, body: u32, moved: &BodyRow) -> Path {
    let (way, turn) = moved.delta();
    let spin = moved.velocity().1 * input.dt;
    Path::new(input.bodies.poses[body as usize], input.bodies[body].local_center, way, turn, spin)
}
