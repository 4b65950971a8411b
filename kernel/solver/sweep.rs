//! Bodies that moved far stop where they meet something; see [`ccd`](crate::ccd).
#![expect(unsafe_code, reason = "rows of bodies are changed by several threads, each its own")]

use super::{BodyRow, BodyRows, RowView, Solver, gyro::*};
use crate::ccd::{Path, SweepBuffers, SweepInput, Swept};
use crate::contact::ManifoldSource;
use crate::math::{Angular, Vector, max};
use crate::thread_pool::ThreadPool;
use std::sync::{Mutex, PoisonError};

/// Number of bodies in a block of the job. More leaves workers idle at the end, fewer cost more claims.
const BLOCK: usize = 64;

/// Number of swept bodies in a block of the job.
const SWEPT_BLOCK: usize = 8;

impl Solver {
    /// Puts bodies back that moved far in the substeps and met what does not move. `listed` are the bodies in the order of
    /// rows, from row 1. `workers` are buffers, kept between steps.
    pub fn stop_fast<S: ManifoldSource>(
        &mut self,
        input: &SweepInput<S>,
        listed: &[u32],
        workers: &mut Vec<SweepBuffers<S::Workspace>>,
        pool: &ThreadPool,
    ) {
        let first_dynamic = self.bodies.first_dynamic();
        let listed = &listed[..listed.len().min(self.bodies.rows.len().saturating_sub(1))];
        let BodyRows { motions, rows, moved, .. } = &mut self.bodies;
        let rows = &RowView::over(rows, first_dynamic);
        let stopped = Mutex::new(Vec::new());
        pool.each_into(workers, listed.chunks(BLOCK).enumerate(), |buffers, (block, ids)| {
            for (i, &body) in ids.iter().enumerate() {
                let row = (1 + block * BLOCK + i) as u32;
                if row < first_dynamic || input.bodies.row(body) != row {
                    continue;
                }
                // SAFETY: no two bodies have one row, and the reference does not outlive the copy.
                let moved: BodyRow = unsafe { *rows.get(row) };
                let (way, turn) = moved.delta();
                // What turns by more than half a turn seems to turn less.
                let angle = max(turn.small_turn().length(), moved.velocity().1.length() * input.dt);
                if !input.is_far(body, way.length(), angle) || !input.may_meet(body, way) {
                    continue;
                }
                let path = path(input, body, &moved);
                let fraction = input.stop(body, &path, buffers);
                if fraction < 1.0 {
                    let acceleration = motions[row as usize].acceleration;
                    // SAFETY: as above; the copy is no reference.
                    unsafe {
                        rows.put(row, |row| {
                            put_back(row, &path, fraction, acceleration);
                            // Contacts do not stop a body that spins fast: it would be put back in every step, and keep its speed.
                            if fraction == 0.0 {
                                row.set_velocity(Vector::ZERO, Angular::ZERO);
                            }
                        });
                    };
                    stopped.lock().unwrap_or_else(PoisonError::into_inner).push(row);
                }
            }
        });
        let stopped = stopped.into_inner().unwrap_or_else(PoisonError::into_inner);
        for row in stopped {
            moved.insert(row);
            mark_outdated(input, listed[row as usize - 1], &mut self.outdated);
        }
    }

    /// Puts bodies back that are swept against what moves, and what they met, kinematic bodies too. Each stops at the first of
    /// its impacts.
    pub fn stop_swept<S: ManifoldSource>(
        &mut self,
        input: &SweepInput<S>,
        swept: &[(u32, Swept)],
        workers: &mut Vec<SweepBuffers<S::Workspace>>,
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
        let mut stops: Vec<_> = workers.iter_mut().flat_map(|worker| worker.stops.drain(..)).collect();
        stops.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        stops.dedup_by_key(|stop| stop.0);
        let paths: Vec<_> = stops.iter().map(|(body, _)| path_of(*body)).collect();
        for ((body, fraction), path) in stops.into_iter().zip(paths) {
            if let Some(path) = path {
                let row = input.bodies.row(body) as usize;
                let acceleration = self.bodies.motions[row].acceleration;
                put_back(&mut self.bodies.rows[row], &path, fraction, acceleration);
                self.bodies.moved.insert(row as u32);
                mark_outdated(input, body, &mut self.outdated);
            }
        }
    }
}

/// Notes the contacts of a body that was put back. It met what the narrow phase had no points for, so that has to look again.
fn mark_outdated<S: ManifoldSource>(input: &SweepInput<S>, body: u32, outdated: &mut Vec<u32>) {
    for collider in input.colliders.of_body(body, input.bodies) {
        outdated.extend(input.contacts.of_collider(collider, input.colliders));
    }
}

/// Puts a body back to a fraction of its path, without a gain of energy.
///
/// What it gains of potential energy, its speed loses: a body that is stopped on its way down would fall the same way
/// twice. Its angular velocity is turned back with it: a rod that spins about its own axis goes on spinning about that axis.
fn put_back(row: &mut BodyRow, path: &Path, fraction: f32, acceleration: Vector) {
    let ((v, w), (_, end)) = (row.velocity(), row.delta());
    let (way, turn) = path.delta(fraction);
    row.set_delta(way, turn);
    let (square, gained) = (v.length_squared(), 2.0 * acceleration.dot(path.way - way));
    let kept = if gained > 0.0 && square > 0.0 { max(1.0 - gained / square, 0.0).sqrt() } else { 1.0 };
    row.set_velocity(v * kept, to_world(turn, to_body(end, w)));
}

/// The path of a body in this step.
fn path<S>(input: &SweepInput<S>, body: u32, moved: &BodyRow) -> Path {
    let (way, turn) = moved.delta();
    let spin = moved.velocity().1 * input.dt;
    Path::new(input.bodies.poses[body as usize], input.bodies[body].local_center, way, turn, spin)
}
