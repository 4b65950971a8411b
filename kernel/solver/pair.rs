//! Operands of rows between two bodies: velocities, and softness per lane.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::{BodyRow, RowView, Softness};
use crate::math::{Angular, Ids, Lane, Vector};

/// The velocities of a row's two bodies.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pair<N> {
    pub(super) v: [Vector<N>; 2],
    pub(super) w: [Angular<N>; 2],
}

impl<N: Lane> Pair<N> {
    /// # Safety
    /// Until the call returns, no other thread writes these rows.
    #[inline(always)]
    pub(super) unsafe fn load(rows: &RowView<BodyRow>, ids: &[N::Ids; 2]) -> Self {
        // SAFETY: by the contract.
        let [(va, wa), (vb, wb)] = unsafe {
            [BodyRow::gather_velocity::<N>(rows, &ids[0]), BodyRow::gather_velocity::<N>(rows, &ids[1])]
        };
        Self { v: [va, vb], w: [wa, wb] }
    }

    /// This pair where the mask is set, else `other`.
    #[inline(always)]
    pub(super) fn or_where_not(self, mask: N::Mask, other: Self) -> Self {
        let mut pair = other;
        for i in 0..2 {
            pair.v[i] = Vector::select(mask, self.v[i], other.v[i]);
            pair.w[i] = Angular::select(mask, self.w[i], other.w[i]);
        }
        pair
    }

    /// Velocity of B relative to A along `n`, at the point whose moments with `n` are given.
    #[inline(always)]
    pub(super) fn along(&self, n: Vector<N>, [ma, mb]: [Angular<N>; 2]) -> N {
        (self.v[1] - self.v[0]).dot(n) + self.w[1].dot(mb) - self.w[0].dot(ma)
    }

    /// # Safety
    /// Until the call returns, no other thread reads or writes the writable rows among these.
    #[inline(always)]
    pub(super) unsafe fn store(&self, rows: &RowView<BodyRow>, ids: &[N::Ids; 2]) {
        if N::SHARES {
            // SAFETY: by the contract.
            unsafe { self.store_shared(rows, ids) };
            return;
        }
        // SAFETY: by the contract.
        unsafe {
            BodyRow::scatter_velocity::<N>(rows, &ids[0], self.v[0], self.w[0]);
            BodyRow::scatter_velocity::<N>(rows, &ids[1], self.v[1], self.w[1]);
        }
    }
}

impl<N: Lane> Pair<N> {
    /// Adds the mean change of a body's lanes to its velocity, in the order of sides and lanes.
    ///
    /// # Safety
    /// As [`store`](Self::store).
    #[inline(always)]
    unsafe fn store_shared(&self, rows: &RowView<BodyRow>, ids: &[N::Ids; 2]) {
        // SAFETY: by the contract.
        let before = unsafe { Self::load(rows, ids) };
        for side in 0..2 {
            let share = N::ONE / lanes_of_body(ids, side);
            let (v, w) = (self.v[side] - before.v[side], self.w[side] - before.w[side]);
            // SAFETY: by the contract.
            unsafe { BodyRow::add_velocity::<N>(rows, &ids[side], v * share, w * share) };
        }
    }
}

/// For each lane, the number of lanes that hold its body, on either side.
#[inline(always)]
pub(super) fn lanes_of_body<N: Lane>(ids: &[N::Ids; 2], side: usize) -> N {
    let [a, b] = [ids[0].lanes(), ids[1].lanes()];
    let mut counts = N::ZERO;
    for lane in 0..N::WIDTH {
        let body = ids[side].lanes()[lane];
        let count = (0..N::WIDTH).map(|i| u8::from(a[i] == body) + u8::from(b[i] == body)).sum::<u8>();
        counts.set(lane, f32::from(count));
    }
    counts
}

/// [`Softness`] per lane.
#[derive(Clone, Copy)]
pub(super) struct SoftLanes<N> {
    pub(super) bias_rate: N,
    pub(super) mass_scale: N,
    pub(super) impulse_scale: N,
}

impl<N: Lane> SoftLanes<N> {
    #[inline(always)]
    pub(super) fn select(mask: N::Mask, a: &Softness, b: &Softness) -> Self {
        Self {
            bias_rate: N::select(mask, N::splat(a.bias_rate), N::splat(b.bias_rate)),
            mass_scale: N::select(mask, N::splat(a.mass_scale), N::splat(b.mass_scale)),
            impulse_scale: N::select(mask, N::splat(a.impulse_scale), N::splat(b.impulse_scale)),
        }
    }
}
