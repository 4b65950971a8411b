//! Compression sweeps over struck manifolds, several of them in SIMD lanes.
//!
//! A sweep visits the manifolds of a group in order. Two consecutive manifolds without a common dynamic
//! body may be swapped without changing any bit. Each manifold therefore has a level: one above the highest
//! level of the earlier manifolds that move one of its bodies. Manifolds of one level, of all groups, are
//! solved in parallel, one per lane.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::pair::Pair;
use super::struck::Struck;
use super::{BodyRow, ContactRow, RowView};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{Angular, Entry, F32x4, Job, Lane, MAX_POINTS, TangentFrame, Vector, Width, max, min};
use crate::tuning::solver::ROUND_OF_SWEEPS;
use core::ops::Range;

/// Marks the absence of a manifold, body, group or level.
const NONE: u32 = u32::MAX;

/// Lanes are used if a row has more than this many manifolds on average. Wide rows take as long as two or
/// three single ones.
const WORTH_LANES: usize = 2;

/// Buffers of a worker, kept between compressions.
#[derive(Clone, Debug, Default)]
pub(super) struct Compression {
    /// By manifold, the indices of its bodies in the batch. [`NONE`] for a body that no impulse moves.
    bodies: Vec<[u32; 2]>,
    /// By manifold, its group. [`NONE`] if the group is not due.
    groups: Vec<u32>,
    /// By body, the lowest level that its next manifold may have.
    body_levels: Vec<u32>,
    /// By manifold, its level; [`NONE`] if its group is not open.
    levels: Vec<u32>,
    /// By level, the first index of its manifolds in `order`.
    level_starts: Vec<u32>,
    /// The manifolds in the lanes of all rows, level by level.
    order: Vec<u32>,
    ones: Vec<CompressionRow<f32>>,
    four: Vec<CompressionRow<F32x4>>,
    #[cfg(target_arch = "x86_64")]
    eight: Vec<CompressionRow<F32x8>>,
}

/// Struck manifolds, one per lane.
#[derive(Clone, Debug)]
struct CompressionRow<N: Lane> {
    contact: ContactRow<N, Vector<N>, MAX_POINTS>,
    moments: [[Angular<N>; 2]; MAX_POINTS],
    /// 1 for points that take part in the impact, 0 for others.
    takes_part: [N; MAX_POINTS],
    /// 1 for manifolds of open groups, 0 for others.
    open: N,
    /// The number of sweeps over which impulses rise.
    rise: N,
    /// The largest velocity change of the last sweep, m/s.
    change: N,
}

/// Progress of the sweeps over a group.
#[derive(Clone, Debug)]
pub(super) struct Progress {
    /// The manifolds of the group, as a range of the batch.
    pub(super) manifolds: Range<usize>,
    /// The bodies of the group.
    pub(super) bodies: Range<usize>,
    /// The number of sweeps over which impulses rise evenly.
    rise: usize,
    /// Sweeps end when velocities change by at most this, m/s.
    tolerance: f32,
    /// The largest velocity change of the current sweep, m/s.
    change: f32,
    /// The smallest change per sweep in the current round of sweeps, and in the previous round.
    least: [f32; 2],
    sweeps: usize,
    is_open: bool,
    /// Whether sweeps stopped converging.
    pub(super) is_stuck: bool,
}

impl Progress {
    pub(super) fn new([manifolds, bodies]: [Range<usize>; 2], rise: usize, tolerance: f32) -> Self {
        let least = [f32::INFINITY; 2];
        Self {
            manifolds,
            bodies,
            rise,
            tolerance,
            change: 0.0,
            least,
            sweeps: 0,
            is_open: true,
            is_stuck: false,
        }
    }

    /// Restarts the count of sweeps, without a rise.
    pub(super) fn restart(&mut self) {
        *self = Self::new([self.manifolds.clone(), self.bodies.clone()], 1, self.tolerance);
    }

    /// Whether the group needs more sweeps.
    #[inline(always)]
    pub(super) fn is_open(&self) -> bool {
        self.is_open
    }

    /// The number of sweeps over which impulses rise evenly.
    #[inline(always)]
    pub(super) fn rise(&self) -> usize {
        self.rise
    }

    /// The number of completed sweeps. Odd-numbered sweeps run backward.
    #[inline(always)]
    pub(super) fn sweeps(&self) -> usize {
        self.sweeps
    }

    /// Records a velocity change of the current sweep, m/s.
    #[inline(always)]
    pub(super) fn note(&mut self, change: f32) {
        self.change = max(self.change, change);
    }

    /// Ends a sweep if the group is open. Closes the group after at most `most` sweeps. Returns whether
    /// this call closed it.
    #[inline(always)]
    pub(super) fn end_sweep(&mut self, most: usize) -> bool {
        if !self.is_open {
            return false;
        }
        let change = core::mem::take(&mut self.change);
        self.sweeps += 1;
        if self.sweeps >= self.rise {
            self.is_open = change > self.tolerance;
            self.least[0] = min(self.least[0], change);
            if self.is_open && self.sweeps.is_multiple_of(ROUND_OF_SWEEPS) {
                self.is_stuck = self.least[0] > 0.99 * self.least[1];
                self.is_open = !self.is_stuck;
                self.least = [f32::INFINITY, self.least[0]];
            }
        }
        self.is_open &= self.sweeps < most;
        !self.is_open
    }
}

impl Compression {
    /// Starts a batch.
    pub(super) fn begin(&mut self) {
        self.bodies.clear();
        self.groups.clear();
    }

    /// Adds manifolds of a group that is not due.
    pub(super) fn leave_out(&mut self, count: usize) {
        self.bodies.resize(self.bodies.len() + count, [NONE; 2]);
        self.groups.resize(self.groups.len() + count, NONE);
    }

    /// Adds the manifolds of a group. `place` maps a dynamic body row to its index in the batch.
    pub(super) fn add(&mut self, group: &[Struck], number: usize, place: impl Fn(u32) -> Option<usize>) {
        let end = |[row]: [u32; 1]| place(row).map_or(NONE, |place| place as u32);
        self.bodies.extend(group.iter().map(|one| one.row.ids.map(end)));
        self.groups.resize(self.bodies.len(), number as u32);
    }

    /// Compresses open groups until all are closed, in at most `most` sweeps each.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the dynamic bodies of the manifolds, or
    /// writes their other bodies.
    pub(super) unsafe fn run(
        &mut self,
        struck: &mut [Struck],
        (groups, bodies): (&mut [Progress], usize),
        body_rows: &RowView<BodyRow>,
        (width, most): (Width, usize),
    ) {
        while groups.iter().any(Progress::is_open) {
            let lanes = match width {
                #[cfg(target_arch = "x86_64")]
                Width::Eight(_) => F32x8::WIDTH,
                _ => F32x4::WIDTH,
            };
            let count = self.schedule(groups, bodies, lanes);
            let is_wide = self.order.len() / lanes * WORTH_LANES < count;
            if !is_wide {
                self.schedule(groups, bodies, 1);
            }
            let Self { order, groups: group_of, ones, four, .. } = self;
            let operands = Operands { struck, groups, group_of, order, body_rows, most };
            // SAFETY: by the contract.
            unsafe {
                match width {
                    _ if !is_wide => f32::enter_widest((), width, SweepJob { operands, rows: ones }),
                    #[cfg(target_arch = "x86_64")]
                    Width::Eight(avx2) => F32x8::enter(avx2, SweepJob { operands, rows: &mut self.eight }),
                    _ => F32x4::enter((), SweepJob { operands, rows: four }),
                }
            }
        }
    }

    /// Assigns the manifolds of open groups to lanes. Returns their number.
    fn schedule(&mut self, groups: &[Progress], bodies: usize, lanes: usize) -> usize {
        let Self { bodies: bodies_of, groups: group_of, body_levels, levels, level_starts, order, .. } = self;
        body_levels.clear();
        body_levels.resize(bodies, 0);
        levels.clear();
        level_starts.clear();
        let mut count = 0;
        for (ends, group) in bodies_of.iter().zip(&*group_of) {
            if !groups.get(*group as usize).is_some_and(Progress::is_open) {
                levels.push(NONE);
                continue;
            }
            let top = |end: &u32| body_levels.get(*end as usize).copied().unwrap_or(0);
            let level = top(&ends[0]).max(top(&ends[1]));
            for end in ends {
                if let Some(top) = body_levels.get_mut(*end as usize) {
                    *top = level + 1;
                }
            }
            levels.push(level);
            level_starts.resize(level_starts.len().max(level as usize + 1), 0);
            level_starts[level as usize] += 1;
            count += 1;
        }
        let mut first = 0;
        for start in level_starts.iter_mut() {
            first += core::mem::replace(start, first).next_multiple_of(lanes as u32);
        }
        order.clear();
        order.resize(first as usize, NONE);
        for (level, manifold) in levels.iter().zip(0..) {
            if let Some(place) = level_starts.get_mut(*level as usize) {
                order[*place as usize] = manifold;
                *place += 1;
            }
        }
        count
    }
}

/// The operands of sweeps.
struct Operands<'a> {
    struck: &'a mut [Struck],
    groups: &'a mut [Progress],
    group_of: &'a [u32],
    order: &'a mut [u32],
    body_rows: &'a RowView<'a, BodyRow>,
    most: usize,
}

/// Sweeps until at least half of the manifolds belong to closed groups.
struct SweepJob<'a, N: Lane> {
    operands: Operands<'a>,
    rows: &'a mut Vec<CompressionRow<N>>,
}

impl<N: Lane> Job for SweepJob<'_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        let Self { operands: Operands { struck, groups, group_of, order, body_rows, most }, rows } = self;
        rows.clear();
        let mut count = 0;
        for lanes in order.chunks(N::WIDTH) {
            let mut row = CompressionRow::none();
            for (lane, manifold) in lanes.iter().enumerate() {
                if let Some(one) = struck.get(*manifold as usize) {
                    row.set(lane, one, groups[group_of[*manifold as usize] as usize].rise());
                    count += 1;
                }
            }
            row.contact.weigh_friction(&TangentFrame::new(row.contact.normal));
            rows.push(row);
        }
        let mut open = count;
        while 2 * open > count {
            // All open groups have had the same number of sweeps.
            let Some(sweeps) = groups.iter().find(|group| group.is_open()).map(Progress::sweeps) else {
                break;
            };
            let is_backward = sweeps % 2 == 1;
            for k in 0..rows.len() {
                let k = if is_backward { rows.len() - 1 - k } else { k };
                // SAFETY: by the contract.
                unsafe { rows[k].compress(body_rows, is_backward, sweeps as f32) };
            }
            for (row, lanes) in rows.iter().zip(order.chunks(N::WIDTH)) {
                for (lane, manifold) in lanes.iter().enumerate() {
                    if *manifold != NONE {
                        groups[group_of[*manifold as usize] as usize].note(row.change.get(lane));
                    }
                }
            }
            let mut any_closed = false;
            for group in groups.iter_mut() {
                any_closed |= group.end_sweep(most);
            }
            if any_closed {
                for (row, lanes) in rows.iter_mut().zip(order.chunks_mut(N::WIDTH)) {
                    for (lane, manifold) in lanes.iter_mut().enumerate() {
                        if *manifold != NONE && !groups[group_of[*manifold as usize] as usize].is_open() {
                            row.store(lane, &mut struck[*manifold as usize]);
                            row.open.set(lane, 0.0);
                            *manifold = NONE;
                            open -= 1;
                        }
                    }
                }
            }
        }
        for (row, lanes) in rows.iter().zip(order.chunks(N::WIDTH)) {
            for (lane, manifold) in lanes.iter().enumerate() {
                if let Some(one) = struck.get_mut(*manifold as usize) {
                    row.store(lane, one);
                }
            }
        }
    }
}

impl<N: Lane> CompressionRow<N> {
    #[inline(always)]
    fn none() -> Self {
        Self {
            contact: ContactRow::default(),
            moments: [[Angular::ZERO; 2]; MAX_POINTS],
            takes_part: [N::ZERO; MAX_POINTS],
            open: N::ZERO,
            rise: N::ONE,
            change: N::ZERO,
        }
    }

    /// Copies a manifold into a lane.
    #[inline(always)]
    fn set(&mut self, lane: usize, one: &Struck, rise: usize) {
        self.contact.set(lane, &one.row);
        for i in 0..MAX_POINTS {
            for side in 0..2 {
                self.moments[i][side].set(lane, one.moments[i][side]);
            }
            self.takes_part[i].set(lane, if one.takes_part(i) { 1.0 } else { 0.0 });
        }
        self.open.set(lane, 1.0);
        self.rise.set(lane, rise as f32);
    }

    /// Stores the impulses of a lane.
    #[inline(always)]
    fn store(&self, lane: usize, one: &mut Struck) {
        for (point, of) in one.row.points.iter_mut().zip(&self.contact.points) {
            point.impulse = of.impulse.get(lane);
        }
        one.row.tangent_impulse = self.contact.tangent_impulse.get(lane);
        one.row.twist.set_impulse(0, self.contact.twist.impulse(lane));
    }

    /// One sweep: stops a share of the approach of each point, then solves friction.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the dynamic bodies of the manifolds, or
    /// writes their other bodies.
    #[inline(always)]
    unsafe fn compress(&mut self, body_rows: &RowView<BodyRow>, is_backward: bool, sweeps: f32) {
        // SAFETY: by the contract.
        let before = unsafe { Pair::load(body_rows, &self.contact.ids) };
        let (n, open) = (self.contact.normal, N::ZERO.lt(self.open));
        let share = N::ONE / (self.rise - N::splat(sweeps)).max(N::ONE);
        let (mut pair, mut change) = (before, N::ZERO);
        for k in 0..MAX_POINTS {
            let i = if is_backward { MAX_POINTS - 1 - k } else { k };
            let (mass, impulse) = (self.contact.points[i].mass, self.contact.points[i].impulse);
            let takes_part = N::ZERO.lt(self.takes_part[i]);
            let new = (impulse - share * mass * pair.along(n, self.moments[i])).max(N::ZERO);
            let new = N::select(takes_part, new, impulse);
            let delta = new - impulse;
            self.contact.points[i].impulse = new;
            change = change.max(N::select(takes_part, delta.max(-delta) / mass, N::ZERO));
            let [a, b] = self.moments[i];
            self.contact.push(&mut pair, n * delta, [a * delta, b * delta]);
        }
        self.change = change.max(self.contact.solve_coulomb(&mut pair));
        // SAFETY: by the contract.
        unsafe { pair.or_where_not(open, before).store(body_rows, &self.contact.ids) };
    }
}

#[cfg(test)]
mod tests {
    use super::super::gyro::round;
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn manifolds_of_a_body_keep_their_order(
            manifolds in prop::collection::vec((0u32..12, 0u32..16, 0u32..4), 0..80),
            lanes in prop::sample::select(vec![1usize, 4, 8]),
        ) {
            // Each group has bodies of its own. Ends from 12 on are bodies that no impulse moves, and the
            // last group is not due.
            let mut compression = Compression::default();
            for (a, b, group) in &manifolds {
                let end = |body: u32| if body < 12 { group * 12 + body } else { NONE };
                compression.bodies.push([end(*a), end(*b)]);
                compression.groups.push(if *group < 3 { *group } else { NONE });
            }
            let groups = vec![Progress::new([0..0, 0..0], 1, 0.0); 3];
            let count = compression.schedule(&groups, 36, lanes);
            let mut places = vec![None; manifolds.len()];
            for (place, manifold) in compression.order.iter().enumerate().filter(|(_, manifold)| **manifold != NONE) {
                prop_assert_eq!(places[*manifold as usize].replace(place / lanes), None);
            }
            prop_assert_eq!(count, places.iter().flatten().count());
            for (i, place) in places.iter().enumerate() {
                prop_assert_eq!(place.is_some(), manifolds[i].2 < 3);
                let Some(place) = place else { continue };
                for j in (0..i).filter(|j| places[*j].is_some()) {
                    let [one, other] = [i, j].map(|k| compression.bodies[k]);
                    if one.iter().any(|end| *end != NONE && other.contains(end)) {
                        prop_assert!(places[j] < Some(*place), "{j} before {i}");
                    }
                }
            }
        }

        #[test]
        fn groups_side_by_side_come_to_the_bits_of_each_alone(
            sizes in prop::collection::vec(1usize..9, 1..8),
            seed in any::<u64>(),
            friction in prop::sample::select(vec![0.0f32, 0.6]),
        ) {
            let mut state = seed | 1;
            let mut random = || {
                state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                (state >> 40) as f32 / (1u64 << 23) as f32 - 1.0
            };
            let mut vector = move || Vector::from_array(core::array::from_fn(|_| random()));
            // Each group has four bodies of its own. Row 0 is static.
            let angular = |arm: Vector| arm.cross(Vector::X);
            let bodies: Vec<_> =
                (0..1 + 4 * sizes.len()).map(|_| BodyRow::new(vector(), angular(vector()))).collect();
            let groups: Vec<Vec<Struck>> = sizes.iter().enumerate().map(|(group, size)| (0..*size).map(|k| {
                let [a, b] = [1 + 4 * group + k % 4, if k % 3 == 0 { 0 } else { 1 + 4 * group + (k + 1) % 4 }];
                let ids = [[a as u32], [b as u32]];
                let mut row = ContactRow::<f32, Vector, MAX_POINTS> { ids, ..Default::default() };
                for side in 0..2 {
                    if row.ids[side][0] != 0 {
                        row.inv_mass[side] = Vector::ONE;
                        row.inv_inertia[side] = round(3.0);
                    }
                }
                row.normal = vector() + Vector::X * 2.0;
                row.normal = row.normal * (1.0 / row.normal.length());
                row.offset = vector();
                row.center = vector();
                row.friction = friction;
                for i in 0..1 + k % MAX_POINTS {
                    (row.points[i].anchor, row.points[i].mass) = (vector(), 1.0);
                }
                Struck::of_row(row)
            }).collect()).collect();
            let run = |groups: &[Vec<Struck>], first: usize, rows: &mut Vec<BodyRow>, width| {
                let mut struck: Vec<_> = groups.concat();
                let mut compression = Compression::default();
                let mut progress = Vec::new();
                for (number, group) in groups.iter().enumerate() {
                    compression.add(group, number, |row| (row > 0).then_some(row as usize));
                    let rise = if (first + number).is_multiple_of(2) { 1 } else { ROUND_OF_SWEEPS };
                    progress.push(Progress::new([0..0, 0..0], rise, 1.0e-3));
                }
                let count = rows.len();
                let view = RowView::over(rows, 1);
                // SAFETY: there is one thread.
                unsafe { compression.run(&mut struck, (&mut progress, count), &view, (width, 64)) };
                struck.iter().map(|one| one.row.points.map(|point| point.impulse.to_bits())).collect::<Vec<_>>()
            };
            let alone = |width| {
                let mut rows = bodies.clone();
                let impulses: Vec<_> = groups
                    .iter()
                    .enumerate()
                    .flat_map(|(number, group)| run(core::slice::from_ref(group), number, &mut rows, width))
                    .collect();
                (impulses, rows.iter().map(|row| format!("{:?}", row.velocity())).collect::<Vec<_>>())
            };
            let together = |width| {
                let mut rows = bodies.clone();
                let impulses = run(&groups, 0, &mut rows, width);
                (impulses, rows.iter().map(|row| format!("{:?}", row.velocity())).collect::<Vec<_>>())
            };
            let one = alone(Width::of(true));
            prop_assert_eq!(&one, &together(Width::of(true)));
            prop_assert_eq!(&one, &together(Width::of(false)));
        }
    }
}
