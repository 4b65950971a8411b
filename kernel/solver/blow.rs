//! Blows: manifolds that close fast within a substep are struck before any other pass sees them, with
//! normal impulses and friction together, at any restitution.
//!
//! A blow is solved in rounds. All manifolds that close fast are struck at once: a body that lands flat on
//! several others stays flat, and a ball that hits two others gives both the same impulse. Bodies that an
//! impact sets in motion may strike others in the next round, as in Newton's cradle (Smith, Kaufman, Vouga,
//! Tamstorf, Grinspun, "Reflections on Simultaneous Impact", 2012).
//!
//! A round solves each [group](super::impact_group) of manifolds connected by bodies on its own.
//!
//! Bodies move with their old velocity until they touch: each is displaced by its velocity change,
//! reversed, times the time until touching.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::impact_group::{GroupBuffers, solve};
use super::input::Item;
use super::struck::{Striking, Struck, is_due, movable};
use crate::contact::ContactTable;
use crate::data::BitSet;
use crate::graph::DisjointSets;
use crate::math::{MAX_POINTS, Vector, Width};
use crate::thread_pool::ThreadPool;
use crate::tuning::solver::{BLOW_SWEEPS, BLOW_WORK, ROUND_OF_SWEEPS};

/// Minimum number of manifolds of a batch of groups, if several workers solve them. Smaller batches fill
/// fewer lanes.
const BATCH: usize = 64;

/// The manifolds that are struck in a substep. Buffers are kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Blows {
    /// Manifolds found in a round, one list per worker.
    pub(super) found: Vec<Vec<Struck>>,
    /// Body rows that were struck in this step.
    pub(super) reached: BitSet,
    /// Body rows that were struck for the first time in this step since contacts were last searched.
    pub(super) reached_anew: BitSet,
    /// Struck manifolds of this substep, in order of groups.
    struck: Vec<Struck>,
    /// Struck manifolds before they are sorted. Empty between rounds.
    unordered: Vec<Struck>,
    order: Vec<SortKey>,
    /// Struck body rows of this substep, in ascending order.
    bodies: Vec<u32>,
    sets: DisjointSets,
    /// By representative of a set, the first body of the set. Representatives depend on the order in which
    /// workers find manifolds; first bodies do not.
    firsts: Vec<u32>,
    /// Buffers of each worker.
    groups: Vec<GroupBuffers>,
    /// Approximate number of manifold solves in this substep.
    solved: usize,
    /// Impulses of all rounds of the step.
    given: Vec<Given>,
    /// Body rows struck since the caller last emptied this list, each with its time, in seconds from the
    /// start of the substep.
    pub(super) times: Vec<(u32, f32)>,
    /// The time from the start of the step to the end of this substep, in seconds.
    pub(super) elapsed: f32,
}

/// The sort key of a struck manifold, and its index in the unsorted list.
#[derive(Clone, Copy, Debug)]
struct SortKey {
    group: u32,
    rows: [u32; 2],
    at: u32,
}

/// The impulses of a manifold in a round.
#[derive(Clone, Debug)]
struct Given {
    item: Item,
    /// The normal impulses of its points, N·s.
    impulses: [f32; MAX_POINTS],
    normal: Vector,
    gained: f32,
}

/// The impulse that struck a manifold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ManifoldBlow {
    /// The contact of the manifold.
    pub contact: u32,
    /// The sum of the normal impulses of its points on the second body, in world axes, N·s.
    pub impulse: Vector,
    /// The approach speed along the normal that accelerations of the bodies have added since the start of
    /// the step, m/s.
    pub gained: f32,
}

impl Blows {
    /// Starts a step.
    pub(super) fn begin_step(&mut self) {
        self.reached.clear();
        self.reached_anew.clear();
        self.given.clear();
        self.elapsed = 0.0;
    }

    /// Starts a substep.
    pub(super) fn begin(&mut self) {
        self.struck.clear();
        self.times.clear();
        self.solved = 0;
    }

    /// Whether this substep has no work budget left for another round. Contacts that still close are left
    /// to the contact solver.
    pub(super) fn is_spent(&self) -> bool {
        self.solved >= BLOW_WORK
    }

    /// The blows of the step, ordered by time. A manifold may be struck several times.
    pub(super) fn given(&self) -> impl Iterator<Item = ManifoldBlow> {
        self.given.iter().map(|given| ManifoldBlow {
            contact: given.item.id,
            impulse: given.normal * given.impulses.iter().sum::<f32>(),
            gained: given.gained,
        })
    }

    /// The lanes with a body that was struck in this step, as bits.
    #[inline(always)]
    pub(super) fn reached_lanes(reached: &BitSet, rows: &[u32]) -> u32 {
        rows.iter().rev().fold(0, |lanes, row| lanes << 1 | u32::from(reached.contains(*row)))
    }

    /// Solves a round with the found manifolds. Returns whether any manifold was due.
    pub(super) fn strike(
        &mut self,
        (first_dynamic, width): (u32, Width),
        striking: &Striking,
        pool: &ThreadPool,
    ) -> bool {
        self.find_groups(first_dynamic);
        self.sort();
        let Self { struck, groups, given, reached, reached_anew, times, solved, .. } = self;
        let mut count = 0;
        for group in struck.chunk_by(|a, b| a.group == b.group).filter(|group| is_due(group)) {
            count += group.len();
            for row in group.iter().flat_map(|one| movable(one, first_dynamic)) {
                if reached.insert(row) {
                    reached_anew.insert(row);
                }
            }
        }
        let most_sweeps = (BLOW_WORK.saturating_sub(*solved) / count.max(1)).min(BLOW_SWEEPS);
        let limits = (first_dynamic, width, most_sweeps.max(ROUND_OF_SWEEPS));
        let batch = if pool.workers() > 1 { BATCH.max(count / (4 * pool.workers())) } else { usize::MAX };
        let mut in_batch = 0;
        let batches = struck.chunk_by_mut(move |a, b| {
            in_batch += 1;
            let ends = a.group != b.group && in_batch >= batch;
            in_batch = if ends { 0 } else { in_batch };
            !ends
        });
        pool.each_into(groups, batches, |buffers, batch| {
            // SAFETY: no two groups have a dynamic body in common.
            unsafe { solve(batch, buffers, limits, striking) };
        });
        // Finding and sorting manifolds takes about as long as solving each of them once.
        *solved += struck.len();
        *solved += groups.iter_mut().map(|worker| core::mem::take(&mut worker.solved)).sum::<usize>();
        for one in struck.iter_mut() {
            let impulses = one.impulses();
            if impulses.iter().any(|impulse| *impulse > 0.0) {
                let (normal, gained) = (one.row.normal, one.gained);
                if one.speed > 0.0 {
                    times.extend(movable(one, first_dynamic).map(|row| (row, one.time)));
                }
                given.push(Given { item: one.item, impulses, normal, gained });
            }
            one.rest();
        }
        count > 0
    }

    /// Lists the manifolds struck in earlier rounds and the manifolds found in this one, grouped by bodies
    /// that connect them.
    fn find_groups(&mut self, first_dynamic: u32) {
        let Self { found, struck, unordered, order, bodies, sets, firsts, .. } = self;
        core::mem::swap(struck, unordered);
        unordered.extend(found.iter_mut().flat_map(|found| found.drain(..)));
        bodies.clear();
        bodies.extend(unordered.iter().flat_map(|one| movable(one, first_dynamic)));
        bodies.sort_unstable();
        bodies.dedup();
        sets.reset(bodies.len());
        let place = |row: u32| bodies.binary_search(&row).unwrap_or(0) as u32;
        for one in unordered.iter() {
            if let [Some(a), Some(b)] = one.row.ids.map(|[row]| (row >= first_dynamic).then(|| place(row))) {
                sets.unite(a, b);
            }
        }
        firsts.clear();
        firsts.resize(bodies.len(), u32::MAX);
        for body in 0..bodies.len() as u32 {
            let first = &mut firsts[sets.find(body) as usize];
            *first = body.min(*first);
        }
        order.clear();
        for (one, at) in unordered.iter_mut().zip(0..) {
            let body = movable(one, first_dynamic).next();
            one.group = body.map_or(u32::MAX, |row| firsts[sets.find(place(row)) as usize]);
            order.push(SortKey { group: one.group, rows: one.row.ids.map(|[row]| row), at });
        }
    }

    /// Sorts the struck manifolds. A manifold that was struck in an earlier round and found again is
    /// replaced: both copies are neighbours, because rows and anchors do not change within a step.
    fn sort(&mut self) {
        let Self { struck, unordered, order, .. } = self;
        order.sort_unstable_by(|a, b| {
            let [one, other] = [a, b].map(|key| &unordered[key.at as usize]);
            let by_rows = (a.group, a.rows).cmp(&(b.group, b.rows));
            by_rows.then_with(|| one.in_order(other)).then_with(|| one.is_old.cmp(&other.is_old))
        });
        struck.clear();
        for key in order.iter() {
            let one = &unordered[key.at as usize];
            match struck.last_mut() {
                Some(new) if new.item == one.item => new.is_jammed |= one.is_jammed,
                _ => struck.push(one.clone()),
            }
        }
        unordered.clear();
    }

    /// Adds the impulses of blows to the impulse sums of the manifolds.
    pub(super) fn store(&self, contacts: &mut ContactTable) {
        if !contacts.sum_impulses {
            return;
        }
        for Given { item, impulses, .. } in &self.given {
            let manifold = contacts.manifold_mut(item.id, item.index);
            let count = usize::from(manifold.count);
            for (point, impulse) in manifold.points[..count].iter_mut().zip(impulses) {
                point.total_impulse += impulse;
            }
        }
    }
}
