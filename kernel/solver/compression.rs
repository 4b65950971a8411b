//! Sweeps of compression over struck manifolds, several side by side.
//!
//! A sweep goes through the manifolds of a group in their order. Two without a movable body in common may change places, and no bit
//! changes. So a manifold has a level, one above the highest of those before it that move one of its bodies, and those of one level,
//! of all groups, are solved side by side, one in each lane.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::group::Progress;
use super::pair::Pair;
use super::struck::Struck;
use super::{BodyRow, ContactRow, RowView};
#[cfg(target_arch = "x86_64")]
use crate::math::F32x8;
use crate::math::{Angular, Entry, F32x4, Job, Lane, MAX_POINTS, TangentFrame, Vector, Width};

/// The place of a lane without a manifold.
const NONE: u32 = u32::MAX;

/// Fewer manifolds than this for each row of lanes are solved one by one.
const WORTH_LANES: usize = 2;

/// What a worker keeps between compressions.
#[derive(Clone, Debug, Default)]
pub(super) struct Compression {
    /// By manifold, its bodies among those of the batch. [`NONE`] for those that nothing moves.
    ends: Vec<[u32; 2]>,
    /// By manifold, its group. [`NONE`] if it is not due.
    groups: Vec<u32>,
    /// By body, the highest level so far.
    tops: Vec<u32>,
    /// By manifold, its level; [`NONE`] if its group is not open.
    levels: Vec<u32>,
    /// By level, the first place of its manifolds.
    starts: Vec<u32>,
    /// The manifolds in the lanes of all rows, level by level.
    order: Vec<u32>,
    ones: Vec<Side<f32>>,
    four: Vec<Side<F32x4>>,
    #[cfg(target_arch = "x86_64")]
    eight: Vec<Side<F32x8>>,
}

/// Struck manifolds side by side.
#[derive(Clone, Debug)]
struct Side<N: Lane> {
    row: ContactRow<N, Vector<N>, MAX_POINTS>,
    moments: [[Angular<N>; 2]; MAX_POINTS],
    /// 1 for points that take part, else 0.
    takes_part: [N; MAX_POINTS],
    /// 1 for manifolds of open groups, else 0.
    open: N,
    /// The number of sweeps in which impulses rise.
    rise: N,
    /// The largest change of velocity in the last sweep, m/s.
    change: N,
}

impl Compression {
    /// Starts a batch.
    pub(super) fn begin(&mut self) {
        self.ends.clear();
        self.groups.clear();
    }

    /// Leaves out some manifolds that are not due.
    pub(super) fn leave_out(&mut self, count: usize) {
        self.ends.resize(self.ends.len() + count, [NONE; 2]);
        self.groups.resize(self.groups.len() + count, NONE);
    }

    /// Adds the manifolds of a group, given the places of its body rows that may be written among all of the batch.
    pub(super) fn add(&mut self, group: &[Struck], number: usize, place: impl Fn(u32) -> Option<usize>) {
        let end = |[row]: [u32; 1]| place(row).map_or(NONE, |place| place as u32);
        self.ends.extend(group.iter().map(|one| one.row.ids.map(end)));
        self.groups.resize(self.ends.len(), number as u32);
    }

    /// Compresses open groups until each is closed, in at most `most` sweeps.
    ///
    /// # Safety
    /// Until it returns, no other thread reads or writes the bodies of the manifolds that may be written, or writes the others.
    pub(super) unsafe fn run(
        &mut self,
        struck: &mut [Struck],
        (groups, bodies): (&mut [Progress], usize),
        rows: &RowView<BodyRow>,
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
            let of = Sweeping { struck, groups, group_of, order, rows, most };
            // SAFETY: by the contract.
            unsafe {
                match width {
                    _ if !is_wide => f32::enter_widest((), width, SweepJob { of, sides: ones }),
                    #[cfg(target_arch = "x86_64")]
                    Width::Eight(avx2) => F32x8::enter(avx2, SweepJob { of, sides: &mut self.eight }),
                    _ => F32x4::enter((), SweepJob { of, sides: four }),
                }
            }
        }
    }

    /// Puts the manifolds of open groups into lanes. Returns their number.
    fn schedule(&mut self, groups: &[Progress], bodies: usize, lanes: usize) -> usize {
        let Self { ends, groups: group_of, tops, levels, starts, order, .. } = self;
        tops.clear();
        tops.resize(bodies, 0);
        levels.clear();
        starts.clear();
        let mut count = 0;
        for (ends, group) in ends.iter().zip(&*group_of) {
            if !groups.get(*group as usize).is_some_and(Progress::is_open) {
                levels.push(NONE);
                continue;
            }
            let top = |end: &u32| tops.get(*end as usize).copied().unwrap_or(0);
            let level = top(&ends[0]).max(top(&ends[1]));
            for end in ends {
                if let Some(top) = tops.get_mut(*end as usize) {
                    *top = level + 1;
                }
            }
            levels.push(level);
            starts.resize(starts.len().max(level as usize + 1), 0);
            starts[level as usize] += 1;
            count += 1;
        }
        let mut first = 0;
        for start in starts.iter_mut() {
            first += core::mem::replace(start, first).next_multiple_of(lanes as u32);
        }
        order.clear();
        order.resize(first as usize, NONE);
        for (level, manifold) in levels.iter().zip(0..) {
            if let Some(place) = starts.get_mut(*level as usize) {
                order[*place as usize] = manifold;
                *place += 1;
            }
        }
        count
    }
}

/// The operands of sweeps.
struct Sweeping<'a> {
    struck: &'a mut [Struck],
    groups: &'a mut [Progress],
    group_of: &'a [u32],
    order: &'a mut [u32],
    rows: &'a RowView<'a, BodyRow>,
    most: usize,
}

/// Sweeps until half of the manifolds are of closed groups.
struct SweepJob<'a, N: Lane> {
    of: Sweeping<'a>,
    sides: &'a mut Vec<Side<N>>,
}

impl<N: Lane> Job for SweepJob<'_, N> {
    type Output = ();

    #[inline(always)]
    unsafe fn run(self) {
        let Self { of: Sweeping { struck, groups, group_of, order, rows, most }, sides } = self;
        sides.clear();
        let mut count = 0;
        for lanes in order.chunks(N::WIDTH) {
            let mut side = Side::none();
            for (lane, manifold) in lanes.iter().enumerate() {
                if let Some(one) = struck.get(*manifold as usize) {
                    side.set(lane, one, groups[group_of[*manifold as usize] as usize].rise());
                    count += 1;
                }
            }
            side.row.weigh_friction(&TangentFrame::new(side.row.normal));
            sides.push(side);
        }
        let mut open = count;
        while 2 * open > count {
            // All open groups have had as many sweeps.
            let Some(sweeps) = groups.iter().find(|group| group.is_open()).map(Progress::sweeps) else {
                break;
            };
            let is_backward = sweeps % 2 == 1;
            for k in 0..sides.len() {
                let k = if is_backward { sides.len() - 1 - k } else { k };
                // SAFETY: by the contract.
                unsafe { sides[k].compress(rows, is_backward, sweeps as f32) };
            }
            for (side, lanes) in sides.iter().zip(order.chunks(N::WIDTH)) {
                for (lane, manifold) in lanes.iter().enumerate() {
                    if *manifold != NONE {
                        groups[group_of[*manifold as usize] as usize].note(side.change.get(lane));
                    }
                }
            }
            let mut any_closed = false;
            for group in groups.iter_mut() {
                any_closed |= group.end_sweep(most);
            }
            if any_closed {
                for (side, lanes) in sides.iter_mut().zip(order.chunks_mut(N::WIDTH)) {
                    for (lane, manifold) in lanes.iter_mut().enumerate() {
                        if *manifold != NONE && !groups[group_of[*manifold as usize] as usize].is_open() {
                            side.store(lane, &mut struck[*manifold as usize]);
                            side.open.set(lane, 0.0);
                            *manifold = NONE;
                            open -= 1;
                        }
                    }
                }
            }
        }
        for (side, lanes) in sides.iter().zip(order.chunks(N::WIDTH)) {
            for (lane, manifold) in lanes.iter().enumerate() {
                if let Some(one) = struck.get_mut(*manifold as usize) {
                    side.store(lane, one);
                }
            }
        }
    }
}

impl<N: Lane> Side<N> {
    #[inline(always)]
    fn none() -> Self {
        Self {
            row: ContactRow::default(),
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
        self.row.set(lane, &one.row);
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
        for (point, of) in one.row.points.iter_mut().zip(&self.row.points) {
            point.impulse = of.impulse.get(lane);
        }
        one.row.tangent_impulse = self.row.tangent_impulse.get(lane);
        one.row.twist.set_impulse(0, self.row.twist.impulse(lane));
    }

    /// One sweep: stops a share of the approach of each point, then rubs.
    ///
    /// # Safety
    /// Until it returns, no other thread reads or writes the bodies of the manifolds that may be written, or writes the others.
    #[inline(always)]
    unsafe fn compress(&mut self, rows: &RowView<BodyRow>, is_backward: bool, sweeps: f32) {
        // SAFETY: by the contract.
        let before = unsafe { Pair::load(rows, &self.row.ids) };
        let (n, open) = (self.row.normal, N::ZERO.lt(self.open));
        let share = N::ONE / (self.rise - N::splat(sweeps)).max(N::ONE);
        let (mut pair, mut change) = (before, N::ZERO);
        for k in 0..MAX_POINTS {
            let i = if is_backward { MAX_POINTS - 1 - k } else { k };
            let (mass, impulse) = (self.row.points[i].mass, self.row.points[i].impulse);
            let takes_part = N::ZERO.lt(self.takes_part[i]);
            let new = (impulse - share * mass * pair.along(n, self.moments[i])).max(N::ZERO);
            let new = N::select(takes_part, new, impulse);
            let delta = new - impulse;
            self.row.points[i].impulse = new;
            change = change.max(N::select(takes_part, delta.max(-delta) / mass, N::ZERO));
            let [a, b] = self.moments[i];
            self.row.push(&mut pair, n * delta, [a * delta, b * delta]);
        }
        self.change = change.max(self.row.rub(&mut pair));
        // SAFETY: by the contract.
        unsafe { pair.or_where_not(open, before).store(rows, &self.row.ids) };
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn manifolds_of_a_body_keep_their_order(
            manifolds in prop::collection::vec((0u32..12, 0u32..16, 0u32..4), 0..80),
            lanes in prop::sample::select(vec![1usize, 4, 8]),
        ) {
            // Bodies of a group are its own. From 12 on nothing moves them, and the last group is not due.
            let mut compression = Compression::default();
            for (a, b, group) in &manifolds {
                let end = |body: u32| if body < 12 { group * 12 + body } else { NONE };
                compression.ends.push([end(*a), end(*b)]);
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
                    let [one, other] = [i, j].map(|k| compression.ends[k]);
                    if one.iter().any(|end| *end != NONE && other.contains(end)) {
                        prop_assert!(places[j] < Some(*place), "{j} before {i}");
                    }
                }
            }
        }
    }
}
