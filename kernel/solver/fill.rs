//! Rows of bodies, filled by several threads at once.
#![expect(unsafe_code, reason = "rows are written through a shared view, each by the thread that claimed it")]

use super::{BodyRow, BodyRows, Limits, MassRow, Motion, body::Spin, gyro::Gyro};
use crate::data::Parts;
use crate::math::{InvInertia, Rot};
use core::sync::atomic::{AtomicBool, Ordering};

/// All that a row of a body holds.
#[derive(Clone, Copy, Debug)]
pub struct FilledBody {
    /// Velocity.
    pub row: BodyRow,
    /// Inverse mass.
    pub mass: MassRow,
    /// What changes the velocity.
    pub motion: Motion,
}

impl FilledBody {
    /// A body at rest that nothing moves.
    pub fn still() -> Self {
        Self { row: BodyRow::REST, mass: MassRow::default(), motion: Motion::FREE }
    }
}

/// What some of the bodies have that one thread filled; added to the others by [`BodyRows::add_few`].
#[derive(Clone, Debug, Default)]
pub struct FewBodies {
    limits: Vec<(usize, Limits)>,
    spins: Vec<(usize, Gyro, Rot)>,
}

impl FewBodies {
    /// Limits a body's velocity.
    #[inline]
    pub fn limit(&mut self, row: usize, limits: Limits) {
        if !limits.is_none() {
            self.limits.push((row, limits));
        }
    }

    /// Has a dynamic body turn by its own spin, if its inverse inertia, in its own frame, makes it. `rotation` is the
    /// body's when the step begins.
    #[inline]
    pub fn spin(&mut self, row: usize, inv_inertia: InvInertia, rotation: Rot) {
        if let Some(gyro) = Gyro::of(inv_inertia) {
            self.spins.push((row, gyro, rotation));
        }
    }
}

/// Rows that several threads fill at once. The thread that claims a row first fills it.
pub struct BodyFiller<'a> {
    claims: &'a [AtomicBool],
    rows: Parts<'a, BodyRow>,
    masses: Parts<'a, MassRow>,
    motions: Parts<'a, Motion>,
}

impl BodyFiller<'_> {
    /// Fills a row. Returns false, and does nothing, if it is the dummy's, filled already, or beyond the last.
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
    /// Has several threads fill all rows but the dummy's, of which none counts as filled.
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

    /// Fills the rows that no thread filled with bodies at rest that nothing moves.
    pub fn still_unfilled(&mut self) {
        for row in 0..self.rows.len() {
            if self.claims.0.get_mut(row).is_none_or(|claim| !*claim.get_mut()) {
                self.still(row);
            }
        }
    }

    /// Adds what a thread noted of the bodies it filled, and leaves it empty. The order makes no difference.
    pub fn add_few(&mut self, few: &mut FewBodies) {
        for (row, limits) in few.limits.drain(..) {
            self.limit(row, limits);
        }
        for spin in few.spins.drain(..).map(|(row, gyro, rotation)| Spin::new(row as u32, gyro, rotation)) {
            self.add_spin(spin);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Angular, Vector};
    use crate::thread_pool::ThreadPool;

    fn body(speed: f32) -> FilledBody {
        FilledBody { row: BodyRow::new(Vector::X * speed, Angular::ZERO), ..FilledBody::still() }
    }

    /// The contract of the view: a row has one writer, whoever asks for it, and the dummy none.
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
        rows.still_unfilled();
        let speed = |row: usize| rows.rows[row].velocity().0.x;
        assert_eq!(fills.into_inner(), (1..1001).filter(|row| row % 7 != 3).count());
        assert_eq!(speed(0), 0.0);
        assert!((1..1001).all(|row| (speed(row) == 0.0) == (row % 7 == 3)));
    }
}
