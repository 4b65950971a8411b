//! Blows: manifolds that close fast within a substep are struck before any other pass sees them, normals and friction
//! together, whatever their restitution.
//!
//! A blow is solved in rounds. All manifolds that close now are struck at once: what falls flat on several pieces stays flat,
//! and a ball that hits two others gives both the same. What an impact sets in motion may strike others, in the next round, as
//! in Newton's cradle (Smith, Kaufman, Vouga, Tamstorf, Grinspun, "Reflections on Simultaneous Impact", 2012).
//!
//! A round has two phases (Poisson). Compression stops the approach of all points, with λ ≥ 0 and Coulomb's cone; it
//! never gains energy, and the velocities after it do not depend on the order of points. Restitution returns a
//! share of each impulse.
//!
//! Bodies move with their old velocity until they touch: each is displaced by the time until then, times the change of its velocity.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::impact::{Striking, Struck};
use super::input::Item;
use super::{BodyRow, RowView};
use crate::contact::ContactTable;
use crate::data::BitSet;
use crate::graph::DisjointSets;
use crate::math::{Angular, MAX_POINTS, Vector, max, min};
use crate::thread_pool::ThreadPool;

/// Maximum number of rounds in a substep. Fewer stop a chain of impacts sooner: each round reaches one body further.
pub(super) const ROUNDS: usize = 32;

/// Maximum number of sweeps over a group. Fewer tilt what lands on many pieces.
const SWEEPS: usize = 96;

/// When sweeps end.
#[derive(Clone, Copy)]
struct Ending {
    /// They change velocities by less than this share of the fastest approach. More tilts what falls flat.
    tolerance: f32,
    /// This many make the least change smaller by less than a hundredth: a body is jammed between others that do not yield.
    /// Fewer end sweeps that would still converge.
    hopeless: usize,
}

/// Where something bounces, its height depends on the rest.
const BOUNCING: Ending = Ending { tolerance: 2.0e-6, hopeless: 8 };
const DULL: Ending = Ending { tolerance: 1.0e-4, hopeless: 8 };

/// The manifolds that are struck in a substep. Buffers are kept between steps.
#[derive(Clone, Debug, Default)]
pub(super) struct Blows {
    /// Those found in a round, by worker.
    pub(super) found: Vec<Vec<Struck>>,
    /// Body rows that were struck in this step.
    pub(super) reached: BitSet,
    /// Those of this substep, in order of groups.
    struck: Vec<Struck>,
    /// Struck body rows of this substep, in ascending order.
    bodies: Vec<u32>,
    sets: DisjointSets,
    /// By worker.
    groups: Vec<Vec<StruckBody>>,
    /// Of all rounds of the step.
    given: Vec<Given>,
    /// The time from the start of the step to the end of this substep, in seconds.
    pub(super) elapsed: f32,
}

/// What a manifold got in a round.
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
    /// The sum of the normal impulses of its points, on the second body, in world axes, N·s.
    pub impulse: Vector,
    /// The approach speed along the normal that accelerations of the bodies added since the start of the step, m/s.
    pub gained: f32,
}

/// A body of a group.
#[derive(Clone, Copy, Debug)]
struct StruckBody {
    row: u32,
    /// The velocity before the round.
    before: (Vector, Angular),
    /// The time until the first of its points touches, in seconds.
    time: f32,
}

impl Blows {
    /// Starts a step.
    pub(super) fn begin_step(&mut self) {
        self.reached.clear();
        self.given.clear();
        self.elapsed = 0.0;
    }

    /// Starts a substep.
    pub(super) fn begin(&mut self) {
        self.struck.clear();
    }

    /// The blows of the step, in the order of time. A manifold may be struck several times.
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

    /// Solves a round with the manifolds that were found. Returns whether any was due.
    pub(super) fn strike(&mut self, first_dynamic: u32, striking: &Striking, pool: &ThreadPool) -> bool {
        if self.found.iter().all(Vec::is_empty) {
            return false;
        }
        self.merge_found();
        self.find_groups(first_dynamic);
        let Self { struck, groups, given, reached, .. } = self;
        let mut any = false;
        for group in struck.chunk_by(|a, b| a.group == b.group).filter(|group| is_due(group)) {
            any = true;
            group.iter().flat_map(|one| movable(one, first_dynamic)).for_each(|row| _ = reached.insert(row));
        }
        let of_groups = struck.chunk_by_mut(|a, b| a.group == b.group).filter(|group| is_due(group));
        pool.each_into(groups, of_groups, |bodies, group| {
            // SAFETY: no two groups have a body that may be written in common.
            unsafe { solve(group, bodies, first_dynamic, striking) };
        });
        for one in struck.iter_mut() {
            let impulses = one.impulses();
            if impulses.iter().any(|impulse| *impulse > 0.0) {
                let (normal, gained) = (one.row.normal, one.gained);
                given.push(Given { item: one.item, impulses, normal, gained });
            }
            one.rest();
        }
        any
    }

    /// Adds what was found to the struck manifolds. What was struck in an earlier round is replaced.
    fn merge_found(&mut self) {
        let Self { found, struck, .. } = self;
        struck.extend(found.iter_mut().flat_map(|found| found.drain(..)));
        struck.sort_unstable_by_key(|one| (one.item.id, one.item.index, one.is_old));
        struck.dedup_by(|old, new| {
            let is_same = (old.item.id, old.item.index) == (new.item.id, new.item.index);
            new.is_jammed |= is_same && old.is_jammed;
            is_same
        });
    }

    /// Finds groups of manifolds that bodies connect, and sorts by them.
    fn find_groups(&mut self, first_dynamic: u32) {
        let Self { struck, bodies, sets, .. } = self;
        struck.sort_unstable_by(Struck::in_order);
        bodies.clear();
        bodies.extend(struck.iter().flat_map(|one| movable(one, first_dynamic)));
        bodies.sort_unstable();
        bodies.dedup();
        sets.reset(bodies.len());
        let place = |row: u32| bodies.binary_search(&row).unwrap_or(0) as u32;
        for one in struck.iter() {
            if let [Some(a), Some(b)] = one.row.ids.map(|[row]| (row >= first_dynamic).then(|| place(row))) {
                sets.unite(a, b);
            }
        }
        for one in struck.iter_mut() {
            one.group = movable(one, first_dynamic).next().map_or(u32::MAX, |row| sets.find(place(row)));
        }
        struck.sort_unstable_by(|a, b| a.group.cmp(&b.group).then_with(|| a.in_order(b)));
    }

    /// Adds the impulses to the sums of the manifolds.
    pub(super) fn store(&self, contacts: &mut ContactTable) {
        if !contacts.sum_impulses {
            return;
        }
        let manifolds = contacts.manifolds_view();
        for Given { item, impulses, .. } in &self.given {
            // SAFETY: one thread uses the view, and one manifold of it at a time.
            let manifold = unsafe { manifolds.manifold(item.id, item.index) };
            let count = usize::from(manifold.count);
            for (point, impulse) in manifold.points[..count].iter_mut().zip(impulses) {
                point.total_impulse += impulse;
            }
        }
    }
}

/// Whether a manifold of a group touches in time.
fn is_due(group: &[Struck]) -> bool {
    group.iter().any(|one| one.is_due && !one.is_jammed)
}

/// The body rows of a manifold that may be written.
fn movable(one: &Struck, first_dynamic: u32) -> impl Iterator<Item = u32> + use<> {
    one.row.ids.into_iter().map(|[row]| row).filter(move |row| *row >= first_dynamic)
}

/// Solves the impacts of a group.
///
/// # Safety
/// Until it returns, no other thread reads or writes the bodies of the group that may be written, or writes the others.
unsafe fn solve(group: &mut [Struck], bodies: &mut Vec<StruckBody>, first_dynamic: u32, striking: &Striking) {
    let rows = &striking.bodies;
    bodies.clear();
    for one in group.iter() {
        let time = if one.speed > 0.0 { one.time } else { f32::MAX };
        for row in movable(one, first_dynamic) {
            // SAFETY: by the contract.
            let before = unsafe { rows.get(row) }.velocity();
            bodies.push(StruckBody { row, before, time });
        }
    }
    bodies.sort_unstable_by(|a, b| a.row.cmp(&b.row).then(a.time.total_cmp(&b.time)));
    bodies.dedup_by_key(|body| body.row);

    let fastest = group.iter().fold(0.0, |fastest, one| max(fastest, one.speed));
    let bounces = group.iter().any(|one| one.bounces);
    let ending = if bounces { &BOUNCING } else { &DULL };
    // SAFETY: by the contract.
    let is_hopeless =
        sweep(group, fastest, ending, |one, is_backward| unsafe { one.compress(rows, is_backward) });
    if is_hopeless {
        // SAFETY: by the contract.
        group.iter_mut().for_each(|one| unsafe { one.find_jam(rows, striking.params) });
    }
    let [least, most] =
        group.iter().map(Struck::shares).fold([f32::MAX, 0.0], |a, b| [min(a[0], b[0]), max(a[1], b[1])]);
    if most > 0.0 {
        // SAFETY: by the contract.
        unsafe { restitute(group, [least, most], rows) };
        // SAFETY: by the contract.
        sweep(group, fastest, ending, |one, _| unsafe { one.rub(rows) });
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

/// Returns to each point its share of the impulse that stopped it, but no more energy than if all returned the greatest
/// share. That one gains none: compression is a projection. In a narrow wedge of two restitutions, large impulses that
/// cancelled each other would not any more.
///
/// # Safety
/// As [`solve`].
unsafe fn restitute(group: &mut [Struck], [least, most]: [f32; 2], rows: &RowView<BodyRow>) {
    for one in group.iter_mut() {
        // SAFETY: by the contract.
        unsafe { one.stop(rows) };
    }
    let mut add = |share: &dyn Fn(f32) -> f32| -> f32 {
        for one in group.iter_mut() {
            // SAFETY: by the contract.
            unsafe { one.restitute(rows, share) };
        }
        // SAFETY: by the contract.
        group.iter().map(|one| unsafe { one.added(rows) }).sum()
    };
    if least < most {
        let (even, uneven) = (add(&|_| most), add(&|share| share));
        if uneven > even {
            let less = (max(even, 0.0) / uneven).sqrt();
            add(&|share| share * less);
        }
    } else {
        add(&|_| most);
    }
}

/// Sweeps over a group, forward and backward in turns, until velocities hardly change. Returns whether more sweeps would not help.
fn sweep(
    group: &mut [Struck],
    fastest: f32,
    ending: &Ending,
    mut solve: impl FnMut(&mut Struck, bool) -> f32,
) -> bool {
    // The least change of these sweeps and of those before.
    let [mut least, mut earlier] = [f32::INFINITY; 2];
    for count in 0..SWEEPS {
        let is_backward = count % 2 == 1;
        let mut change = 0.0;
        let mut one = |one: &mut Struck| change = max(change, solve(one, is_backward));
        if is_backward {
            group.iter_mut().rev().for_each(&mut one);
        } else {
            group.iter_mut().for_each(&mut one);
        }
        if change <= ending.tolerance * fastest {
            return false;
        }
        least = min(least, change);
        if count % ending.hopeless == ending.hopeless - 1 {
            if least > 0.99 * earlier {
                return true;
            }
            (earlier, least) = (least, f32::INFINITY);
        }
    }
    false
}
