//! Fills body rows with several threads.
#![expect(unsafe_code, reason = "rows are written through a shared view, each by the thread that claimed it")]

use super::{BodyRow, BodyRows, Limits, MassRow, Motion, gyro::Gyro, spin::Spin};
use crate::data::Parts;
use crate::math::{InvInertia, Rot};
use core::sync::atomic::{AtomicBool, Ordering};

/// The content of a body row.
#[derive(Clone, Copy, Debug)]
pub struct FilledBody {
    /// Velocity.
    pub row: BodyRow,
    /// Inverse mass.
    pub mass: MassRow,
    /// Acceleration and damping.
    pub motion: Motion,
}

impl FilledBody {
    /// An immovable body at rest.
    pub fn at_rest() -> Self {
        Self { row: BodyRow::REST, mass: MassRow::default(), motion: Motion::FREE }
    }
}

/// Limits and spins of the bodies that one thread filled. Passed to [`BodyRows::add_special`].
#[derive(Clone, Debug, Default)]
pub struct SpecialBodies {
    limits: Vec<(usize, Limits)>,
    spins: Vec<(usize, Gyro, Rot)>,
}

impl SpecialBodies {
    /// Limits a body's velocity.
    #[inline]
    pub fn limit(&mut self, row: usize, limits: Limits) {
        if !limits.is_none() {
            self.limits.push((row, limits));
        }
    }

    /// As [`BodyRows::spin`].
    #[inline]
    pub fn spin(&mut self, row: usize, inv_inertia: InvInertia, rotation: Rot) {
        if let Some(gyro) = Gyro::of(inv_inertia) {
            self.spins.push((row, gyro, rotation));
        }
    }
}

/// Body rows that several threads fill. The first thread that claims a row fills it.
pub struct BodyFiller<'a> {
    claims: &'a [AtomicBool],
    rows: Parts<'a, BodyRow>,
    masses: Parts<'a, MassRow>,
    motions: Parts<'a, Motion>,
}

impl BodyFiller<'_> {
    /// Fills a row. Returns false and does nothing for the dummy, a filled row, or a row beyond the last.
    #[inline(always)]
    pub fn fill(&self, row: usize, body: &FilledBody) -> bool {
        if self.claims.get(row).is_none_or(|claim| claim.swap(true, Ordering::Relaxed)) {
            return false;
        }
        debug_assert!(body.mass.inv_mass() >= 0.0, "an inverse mass of {}", body.mass.inv_mass());
        // SAFETY: the filler borrows the rows mutably, and only the thread that claimed a row takes it, once.
        unsafe {
            *self.rows.one(row) = body.row;
            *self.masses.one(row) = body.mass;
            *self.motions.one(row) = body.motion;
        }
        true
    }
}

impl BodyRows {
    /// Prepares all rows except the dummy for filling by several threads.
    pub fn filler(&mut self) -> BodyFiller<'_> {
        let Self { rows, masses, motions, claims, .. } = self;
        claims.reset(rows.len());
        BodyFiller {
            claims: &claims.0,
            rows: Parts::of(rows),
            masses: Parts::of(masses),
            motions: Parts::of(motions),
        }
    }

    /// Fills all unclaimed rows with immovable bodies at rest.
    pub fn fill_rest(&mut self) {
        for row in 0..self.rows.len() {
            if self.claims.0.get_mut(row).is_none_or(|claim| !*claim.get_mut()) {
                self.set_at_rest(row);
            }
        }
    }

    /// Adds the limits and spins that a thread recorded, and clears its lists. The order of calls makes no
    /// difference.
    pub fn add_special(&mut self, special: &mut SpecialBodies) {
        for (row, limits) in special.limits.drain(..) {
            self.limit(row, limits);
        }
        let spins = special.spins.drain(..);
        for (row, spin) in spins.map(|(row, gyro, rotation)| (row, Spin::new(gyro, rotation))) {
            self.add_spin(row, spin);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Angular, Vector};
    use crate::thread_pool::ThreadPool;

    fn body(speed: f32) -> FilledBody {
        FilledBody { row: BodyRow::new(Vector::X * speed, Angular::ZERO), ..FilledBody::at_rest() }
    }

    /// The contract of the filler: each row has one writer, and the dummy has none.
    #[test]
    fn each_row_is_filled_once() {
        let mut rows = BodyRows::default();
        rows.reset(3, 997);
        let filler = rows.filler();
        let fills = core::sync::atomic::AtomicUsize::new(0);
        let pool = ThreadPool::new(4);
        pool.wake();
        pool.run(64, |block, _| {
            for row in (0..1100).filter(|row| row % 7 != 3) {
                let filled = filler.fill(row, &body((block + 1) as f32));
                fills.fetch_add(usize::from(filled), Ordering::Relaxed);
            }
        });
        rows.fill_rest();
        let speed = |row: usize| rows.rows[row].velocity().0.x;
        assert_eq!(fills.into_inner(), (1..1001).filter(|row| row % 7 != 3).count());
        assert_eq!(speed(0), 0.0);
        assert!((1..1001).all(|row| (speed(row) == 0.0) == (row % 7 == 3)));
    }
}
