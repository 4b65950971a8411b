//! The impact of a group of manifolds that bodies connect, in two phases (Poisson).
//!
//! Compression stops the approach of all points, with λ ≥ 0 and Coulomb's cone. It never gains energy, and the velocities after
//! it do not depend on the order of points. Friction of several manifolds may share an impact in many ways: there impulses
//! rise together, as they do in time, and the result does not depend on the order of manifolds either.
//!
//! Restitution returns a share of each normal impulse. Its friction is limited by what is returned, since that of compression is
//! spent. Poisson's law alone may gain energy: friction that pushes a body into the ground makes compression larger than
//! what it stops, and is over when the impulse is returned. So no more energy is returned than e² of what compression took
//! (Stronge), e being the greatest share. Without friction that is what equal shares return, exactly.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::struck::{Striking, Struck};
use super::{BodyRow, RowView};
use crate::math::{Angular, Vector, max, min};
use crate::tuning::solver::{BOUNCE_TOLERANCE, CONVERGED, ROUND_OF_SWEEPS};

/// A body of a group.
#[derive(Clone, Copy, Debug)]
pub(super) struct StruckBody {
    row: u32,
    /// The velocity before the round.
    before: (Vector, Angular),
    /// The velocity after compression.
    slow: (Vector, Angular),
    /// The time until the first of its points touches, in seconds.
    time: f32,
}

/// What a worker keeps between groups.
#[derive(Clone, Debug, Default)]
pub(super) struct GroupBuffers {
    bodies: Vec<StruckBody>,
    /// How often a manifold was solved since the caller last took this.
    pub(super) solved: usize,
}

/// The body rows of a manifold that may be written.
pub(super) fn movable(one: &Struck, first_dynamic: u32) -> impl Iterator<Item = u32> + use<> {
    one.row.ids.into_iter().map(|[row]| row).filter(move |row| *row >= first_dynamic)
}

/// Solves the impacts of a group, with `most_sweeps` at most, but for a round of sweeps.
///
/// # Safety
/// Until it returns, no other thread reads or writes the bodies of the group that may be written, or writes the others.
pub(super) unsafe fn solve(
    group: &mut [Struck],
    GroupBuffers { bodies, solved }: &mut GroupBuffers,
    (first_dynamic, most_sweeps): (u32, usize),
    striking: &Striking,
) {
    let rows = &striking.bodies;
    let most_sweeps = most_sweeps.max(ROUND_OF_SWEEPS);
    bodies.clear();
    for one in group.iter() {
        let time = if one.speed > 0.0 { one.time } else { f32::MAX };
        for row in movable(one, first_dynamic) {
            // SAFETY: by the contract.
            let before = unsafe { rows.get(row) }.velocity();
            bodies.push(StruckBody { row, before, slow: before, time });
        }
    }
    bodies.sort_unstable_by(|a, b| a.row.cmp(&b.row).then(a.time.total_cmp(&b.time)));
    bodies.dedup_by_key(|body| body.row);

    let fastest = group.iter().fold(0.0, |fastest, one| max(fastest, one.speed));
    let bounces = group.iter().any(|one| one.bounces);
    // Where something bounces, its height depends on the rest.
    let tolerance = if bounces { BOUNCE_TOLERANCE } else { CONVERGED };
    let shares = bounces && group.len() > 1 && group.iter().any(|one| one.row.friction > 0.0);
    let rise = if shares { ROUND_OF_SWEEPS } else { 1 };
    // SAFETY: by the contract.
    group.iter_mut().for_each(|one| unsafe { one.begin(rows) });
    let calm = tolerance * fastest;
    // SAFETY: by the contract.
    let compress = |one: &mut Struck, is_backward, share| unsafe { one.compress(rows, is_backward, share) };
    let (sweeps, is_stuck) = sweep(group, (rise, most_sweeps), calm, compress);
    *solved += sweeps * group.len();
    if is_stuck {
        // SAFETY: by the contract.
        group.iter_mut().for_each(|one| unsafe { one.find_jam(rows, striking.params) });
    }
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
        // SAFETY: by the contract.
        let (sweeps, _) = sweep(group, (1, most_sweeps), calm, |one, _, _| unsafe { one.rub(rows) });
        *solved += sweeps * group.len();
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
}

/// Scales the impulses of restitution and what they changed so that they add no more than this energy, J.
///
/// # Safety
/// As [`solve`].
unsafe fn return_at_most(most: f32, group: &mut [Struck], bodies: &[StruckBody], rows: &RowView<BodyRow>) {
    // SAFETY: by the contract.
    let [linear, square] = unsafe { work(group, rows) };
    if linear + square <= most || square <= 0.0 {
        return;
    }
    // The root of s · linear + s² · square = most.
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

/// The work of the impulses of the present phase, as [`Struck::work`].
///
/// # Safety
/// Until it returns, no other thread writes the bodies of the group.
unsafe fn work(group: &[Struck], rows: &RowView<BodyRow>) -> [f32; 2] {
    // SAFETY: by the contract.
    group.iter().map(|one| unsafe { one.work(rows) }).fold([0.0; 2], |a, b| [a[0] + b[0], a[1] + b[1]])
}

/// Sweeps over a group, forward and backward in turns, until velocities change by no more than this, m/s. In the first `rise`
/// sweeps impulses rise evenly. Returns how many there were, and whether more would not help.
fn sweep(
    group: &mut [Struck],
    (rise, most): (usize, usize),
    calm: f32,
    mut solve: impl FnMut(&mut Struck, bool, f32) -> f32,
) -> (usize, bool) {
    // The least change of these sweeps and of those before.
    let [mut least, mut earlier] = [f32::INFINITY; 2];
    for count in 0..most {
        let is_backward = count % 2 == 1;
        let share = 1.0 / max(rise as f32 - count as f32, 1.0);
        let mut change = 0.0;
        let mut one = |one: &mut Struck| change = max(change, solve(one, is_backward, share));
        if is_backward {
            group.iter_mut().rev().for_each(&mut one);
        } else {
            group.iter_mut().for_each(&mut one);
        }
        if share < 1.0 {
            continue;
        }
        if change <= calm {
            return (count + 1, false);
        }
        least = min(least, change);
        if count % ROUND_OF_SWEEPS == ROUND_OF_SWEEPS - 1 {
            if least > 0.99 * earlier {
                return (count + 1, true);
            }
            (earlier, least) = (least, f32::INFINITY);
        }
    }
    (most, false)
}
