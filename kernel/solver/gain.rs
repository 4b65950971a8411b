//! The warm start by body: what impulses gave each body in the last substep.
//!
//! Rows and masses stay the same through a step. So from the second substep on, the impulses of the last relax pass change a body's
//! velocity by just what the last substep did: its velocity after relaxing less that before warm starting. Adding it takes one pass
//! over bodies instead of one over contacts.
//!
//! What is not accumulated is left out: free spin, limits of velocity, and rolling resistance.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::body::Gains;
use super::{BodyRow, BodyRows, GainRow, RowView};
use crate::data::Parts;
use crate::thread_pool::ThreadPool;

/// Number of bodies in a block of the job. More leaves workers idle at the end, fewer cost more claims.
const BLOCK: usize = 512;

impl BodyRows {
    /// Before impulses are applied. Returns whether it has added to the velocities what the accumulated ones give.
    pub(super) fn begin_gains(&mut self, pool: &ThreadPool) -> bool {
        // Bodies that turn far are seen otherwise in each substep.
        let adds = self.gains_known == Gains::Known && self.fast_turns.list().is_empty();
        if self.gains_known == Gains::Unused {
            return false;
        }
        self.each_gain(pool, |gain, row| gain.begin(row, adds));
        adds
    }

    /// After the impulses of a substep were applied.
    pub(super) fn end_gains(&mut self, pool: &ThreadPool) {
        if self.gains_known == Gains::Unused {
            return;
        }
        self.gains_known = Gains::Known;
        self.each_gain(pool, |gain, row| gain.end(row));
    }

    /// Calls a function with the gain and row of each dynamic body.
    #[inline(always)]
    fn each_gain(&mut self, pool: &ThreadPool, change: impl Fn(&mut GainRow, &mut BodyRow) + Sync) {
        let Self { rows, gains, first_dynamic, .. } = self;
        let (first, count) = (*first_dynamic as usize, rows.len());
        let (rows, gains) = (Parts::of(rows), Parts::of(gains));
        pool.run((count - first).div_ceil(BLOCK), |block, _| {
            let start = first + block * BLOCK;
            let range = start..count.min(start + BLOCK);
            // SAFETY: a row is in one block.
            let (rows, gains) = unsafe { (rows.take(range.clone()), gains.take(range)) };
            gains.iter_mut().zip(rows).for_each(|(gain, row)| change(gain, row));
        });
    }

    /// Adds `share` of the velocities of those bodies to their gains whose velocity changes by other than impulses: with −1
    /// before the change and with 1 after it, the gains leave it out.
    pub(super) fn add_to_gains(&mut self, share: f32, pool: &ThreadPool) {
        if self.gains_known == Gains::Unused {
            return;
        }
        let Self { rows, gains, limits, spins, .. } = self;
        let (rows, gains) = (RowView::over(rows, u32::MAX), RowView::over(gains, 0));
        let add = |row: u32| {
            // SAFETY: no row is listed twice, and a list's item is in one block.
            unsafe {
                let (v, w) = rows.get(row).velocity();
                gains.put(row, |gain| gain.add(v * share, w * share));
            }
        };
        pool.run(spins.list().len().div_ceil(BLOCK), |block, _| {
            let block = spins.list().iter().skip(block * BLOCK).take(BLOCK);
            block.for_each(|(row, _)| add(*row));
        });
        limits.list().iter().filter(|(row, _)| !spins.contains(*row)).for_each(|(row, _)| add(*row));
    }
}
