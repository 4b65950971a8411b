//! Bodies that moved far stop where they meet something; see [`ccd`](crate::ccd).
#![expect(unsafe_code, reason = "rows of bodies are changed by several threads, each its own")]

use super::{BodyRow, RowView, Solver, gyro::*};
use crate::ccd::{Path, SweepBuffers, SweepInput, Swept};
use crate::contact::ManifoldSource;
use crate::data::BitSet;
use crate::graph::ConstraintKind;
use crate::math::{Angular, Vector, max, min};
use crate::thread_pool::ThreadPool;

/// Number of bodies in a block of the job. More leaves workers idle at the end, fewer cost more claims.
const BLOCK: usize = 64;

/// Number of swept bodies in a block of the job.
const SWEPT_BLOCK: usize = 8;

impl Solver {
    /// Puts bodies back that moved far in the substeps and met what does not move, each with what it is joined to. `listed` are the
    /// bodies in the order of rows, from row 1. `workers` are buffers, kept between steps.
    pub fn stop_fast<S: ManifoldSource>(
        &mut self,
        input: &SweepInput<S>,
        listed: &[u32],
        workers: &mut Vec<SweepBuffers<S::Workspace>>,
        pool: &ThreadPool,
    ) {
        let first_dynamic = self.bodies.first_dynamic();
        let listed = &listed[..listed.len().min(self.bodies.rows.len().saturating_sub(1))];
        let rows = &RowView::over(&mut self.bodies.rows, first_dynamic);
        pool.each_into(workers, listed.chunks(BLOCK).enumerate(), |buffers, (block, ids)| {
            for (i, &body) in ids.iter().enumerate() {
                let row = (1 + block * BLOCK + i) as u32;
                if row < first_dynamic || input.bodies.row(body) != row {
                    continue;
                }
                // SAFETY: no thread writes bodies.
                let moved: BodyRow = unsafe { *rows.get(row) };
                let (way, turn) = moved.delta();
                // What turns by more than half a turn seems to turn less.
                let angle = max(turn.small_turn().length(), moved.velocity().1.length() * input.dt);
                if !input.is_far(body, way.length(), angle) || !input.may_meet(body, way) {
                    continue;
                }
                let fraction = input.stop(body, &path(input, body, &moved), buffers);
                if fraction < 1.0 {
                    buffers.stops.push((body, fraction));
                }
            }
        });
        self.put_back_all(input, workers, |row, fraction| {
            // Contacts do not stop a body that spins fast: it would be put back in every step, and keep its speed.
            if fraction == 0.0 {
                row.set_velocity(Vector::ZERO, Angular::ZERO);
            }
        });
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
        self.put_back_all(input, workers, |_, _| ());
    }

    /// Puts back all bodies that stop, each to the first of its impacts, and what they are joined to with them. Calls a function for
    /// those that met something, with their fraction of the step.
    fn put_back_all<S: ManifoldSource>(
        &mut self,
        input: &SweepInput<S>,
        workers: &mut [SweepBuffers<S::Workspace>],
        stopped: impl Fn(&mut BodyRow, f32),
    ) {
        let mut stops: Vec<_> = workers.iter_mut().flat_map(|worker| worker.stops.drain(..)).collect();
        if stops.is_empty() {
            return;
        }
        stops.sort_unstable_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)));
        stops.dedup_by_key(|stop| stop.0);
        let joined = self.joined(input, &stops);
        for (body, fraction, met) in joined {
            let row = input.bodies.row(body) as usize;
            let Some(moved) = self.bodies.rows.get_mut(row).filter(|_| row > 0) else { continue };
            let path = path(input, body, moved);
            put_back(moved, &path, fraction, self.bodies.motions[row].acceleration);
            if met {
                stopped(moved, fraction);
            }
            self.bodies.moved.insert(row as u32);
            mark_outdated(input, body, &mut self.outdated);
        }
    }

    /// All bodies that stop with some, given by ascending id, with the fraction of the step and whether they met something. What is joined
    /// stops together, or its joints would open by its way.
    fn joined<S>(&self, input: &SweepInput<S>, stops: &[(u32, f32)]) -> Vec<(u32, f32, bool)> {
        let own = |body: u32| stops.binary_search_by_key(&body, |stop| stop.0).ok().map(|k| stops[k].1);
        let (first_dynamic, mut seen, mut all) = (self.bodies.first_dynamic(), BitSet::default(), Vec::new());
        for (body, _) in stops {
            let start = all.len();
            let mut add = |body: u32, all: &mut Vec<_>| {
                if seen.insert(body) {
                    all.push((body, 1.0f32, own(body).is_some()));
                }
            };
            add(*body, &mut all);
            let mut next = start;
            while let Some((body, ..)) = all.get(next).copied() {
                next += 1;
                for kind in [ConstraintKind::Joint, ConstraintKind::Custom] {
                    let constraints = input.bodies.constraints(kind);
                    for id in constraints.of_body(body) {
                        let others = constraints.get(id).bodies.into_iter();
                        others
                            .filter(|other| input.bodies.row(*other) >= first_dynamic)
                            .for_each(|other| add(other, &mut all));
                    }
                }
            }
            let first = all[start..].iter().filter_map(|one| own(one.0)).fold(1.0, min);
            all[start..].iter_mut().for_each(|one| one.1 = first);
        }
        all
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
