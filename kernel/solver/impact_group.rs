//! The impact of a group of manifolds that bodies connect, in two phases (Poisson).
//!
//! Compression stops the approach of all points, with λ ≥ 0 and Coulomb's cone. It never gains energy, and
//! the velocities after it do not depend on the order of points. If several manifolds have friction, the
//! impulses that stop an impact are not unique: there, impulses rise together, as they do in time, so that
//! the result does not depend on the order of manifolds either.
//!
//! Restitution returns a share of each normal impulse. Its friction is limited by the returned impulses,
//! since the compression impulses are spent. Poisson's law alone may gain energy: friction that pushes a
//! body into the ground makes the compression impulse larger than the approach requires, and is gone when
//! the impulse is returned. The returned energy is therefore at most e² times the energy that compression
//! took (Stronge), where e is the greatest share. Without friction, equal shares return exactly this
//! energy.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::compression::{Compression, Progress};
use super::struck::{Striking, Struck, is_due, movable};
use super::{BodyRow, RowView};
use crate::math::{Angular, Vector, Width, max, min};
use crate::tuning::solver::{BOUNCE_TOLERANCE, CONVERGED, ROUND_OF_SWEEPS};
use core::ops::Range;

/// A body of a group.
#[derive(Clone, Copy, Debug)]
pub(super) struct StruckBody {
    row: u32,
    /// The velocity before the round.
    before: (Vector, Angular),
    /// The velocity after compression.
    slow: (Vector, Angular),
    /// The time until the first point of the body touches, in seconds.
    time: f32,
}

/// Buffers of a worker, kept between batches of groups.
#[derive(Clone, Debug, Default)]
pub(super) struct GroupBuffers {
    /// The bodies of all groups, group by group.
    bodies: Vec<StruckBody>,
    groups: Vec<Progress>,
    compression: Compression,
    /// Number of manifold solves since the caller last took this count.
    pub(super) solved: usize,
}

/// Solves the impacts of the due groups of a batch, in at most `most_sweeps` sweeps.
///
/// # Safety
/// Until the call returns, no other thread reads or writes the dynamic bodies of the groups, or writes
/// their other bodies.
pub(super) unsafe fn solve(
    batch: &mut [Struck],
    GroupBuffers { bodies, groups, compression, solved }: &mut GroupBuffers,
    (first_dynamic, width, most_sweeps): (u32, Width, usize),
    striking: &Striking,
) {
    let rows = &striking.bodies;
    bodies.clear();
    groups.clear();
    compression.begin();
    let mut end = 0;
    for group in batch.chunk_by_mut(|a, b| a.group == b.group) {
        let manifolds = end..end + group.len();
        end = manifolds.end;
        if !is_due(group) {
            compression.leave_out(group.len());
            continue;
        }
        // SAFETY: by the contract.
        let range = unsafe { list_bodies(group, bodies, first_dynamic, rows) };
        let place = |row: u32| bodies[range.clone()].binary_search_by_key(&row, |body| body.row);
        compression.add(group, groups.len(), |row| place(row).ok().map(|k| range.start + k));
        let fastest = group.iter().fold(0.0, |fastest, one| max(fastest, one.speed));
        let bounces = group.iter().any(|one| one.bounces);
        // If a point bounces, its rebound height depends on the remaining error.
        let tolerance = if bounces { BOUNCE_TOLERANCE } else { CONVERGED };
        let shares = bounces && group.len() > 1 && group.iter().any(|one| one.row.friction > 0.0);
        let rise = if shares { ROUND_OF_SWEEPS } else { 1 };
        groups.push(Progress::new([manifolds, range], rise, tolerance * fastest));
        // SAFETY: by the contract.
        group.iter_mut().for_each(|one| unsafe { one.begin(rows) });
    }
    // SAFETY: by the contract.
    unsafe { compression.run(batch, (groups, bodies.len()), rows, (width, most_sweeps)) };
    for progress in groups {
        let (group, bodies) = (&mut batch[progress.manifolds.clone()], &mut bodies[progress.bodies.clone()]);
        *solved += progress.sweeps() * group.len();
        // SAFETY: by the contract.
        *solved += unsafe { finish(group, (progress, most_sweeps), bodies, striking) } * group.len();
    }
}

/// Lists the dynamic bodies of a group, by row. Returns their range.
///
/// # Safety
/// Until the call returns, no other thread writes the bodies of the group.
unsafe fn list_bodies(
    group: &[Struck],
    bodies: &mut Vec<StruckBody>,
    first_dynamic: u32,
    rows: &RowView<BodyRow>,
) -> Range<usize> {
    let start = bodies.len();
    for one in group {
        let time = if one.speed > 0.0 { one.time } else { f32::MAX };
        for row in movable(one, first_dynamic) {
            // SAFETY: by the contract.
            let before = unsafe { rows.get(row) }.velocity();
            bodies.push(StruckBody { row, before, slow: before, time });
        }
    }
    bodies[start..].sort_unstable_by(|a, b| a.row.cmp(&b.row).then(a.time.total_cmp(&b.time)));
    let mut end = start;
    for k in start..bodies.len() {
        if end == start || bodies[end - 1].row != bodies[k].row {
            bodies[end] = bodies[k];
            end += 1;
        }
    }
    bodies.truncate(end);
    start..end
}

/// Applies restitution to a compressed group, and displaces its bodies. Returns the number of friction
/// sweeps.
///
/// # Safety
/// As [`solve`].
unsafe fn finish(
    group: &mut [Struck],
    (progress, most_sweeps): (&mut Progress, usize),
    bodies: &mut [StruckBody],
    striking: &Striking,
) -> usize {
    let rows = &striking.bodies;
    if progress.is_stuck {
        // SAFETY: by the contract.
        group.iter_mut().for_each(|one| unsafe { one.find_jam(rows, striking.params) });
    }
    let mut sweeps = 0;
    let share = group.iter().map(Struck::share).fold(0.0, max);
    if share > 0.0 {
        // SAFETY: by the contract.
        let lost = -unsafe { work(group, rows) }.iter().sum::<f32>();
        for body in bodies.iter_mut() {
            // SAFETY: by the contract.
            body.slow = unsafe { rows.get(body.row) }.velocity();
        }
        // SAFETY: by the contract.
        group.iter_mut().for_each(|one| unsafe { one.stop(rows) });
        // SAFETY: by the contract.
        group.iter_mut().for_each(|one| unsafe { one.restitute(rows) });
        progress.restart();
        while progress.is_open() {
            let is_backward = progress.sweeps() % 2 == 1;
            for k in 0..group.len() {
                let k = if is_backward { group.len() - 1 - k } else { k };
                // SAFETY: by the contract.
                progress.note(unsafe { group[k].solve_coulomb(rows) });
            }
            progress.end_sweep(most_sweeps);
        }
        sweeps = progress.sweeps();
        // SAFETY: by the contract.
        unsafe { return_at_most(share * share * max(lost, 0.0), group, bodies, rows) };
    }

    for body in bodies.iter().filter(|body| body.time < f32::MAX) {
        let change = |row: &mut BodyRow| {
            let ((v, w), (position, rotation)) = (row.velocity(), row.delta());
            let time = min(body.time, striking.time);
            let turn = (body.before.1 - w) * time;
            row.set_delta(position + (body.before.0 - v) * time, rotation.turned_by(turn));
        };
        // SAFETY: by the contract.
        unsafe { rows.put(body.row, change) };
    }
    sweeps
}

/// Scales the impulses of restitution, and the velocity changes by them, to add at most `most` J of energy.
///
/// # Safety
/// As [`solve`].
unsafe fn return_at_most(most: f32, group: &mut [Struck], bodies: &[StruckBody], rows: &RowView<BodyRow>) {
    // SAFETY: by the contract.
    let [linear, square] = unsafe { work(group, rows) };
    if linear + square <= most || square <= 0.0 {
        return;
    }
    // Solves s · linear + s² · square = most for s.
    let half = 0.5 * linear;
    let share = ((half * half + square * most).sqrt() - half) / square;
    group.iter_mut().for_each(|one| one.scale(share));
    for StruckBody { row, slow: (v, w), .. } in bodies {
        let change = |row: &mut BodyRow| {
            let now = row.velocity();
            row.set_velocity(*v + (now.0 - *v) * share, *w + (now.1 - *w) * share);
        };
        // SAFETY: by the contract.
        unsafe { rows.put(*row, change) };
    }
}

/// The work of the impulses of the current phase, as [`Struck::work`].
///
/// # Safety
/// Until the call returns, no other thread writes the bodies of the group.
unsafe fn work(group: &[Struck], rows: &RowView<BodyRow>) -> [f32; 2] {
    // SAFETY: by the contract.
    group.iter().map(|one| unsafe { one.work(rows) }).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}
