//! Warm start by body: repeats the velocity change by impulses that each body had in the last substep.
//!
//! Rows and masses stay the same through a step. From the second substep on, applying the impulses of the
//! last relax pass therefore changes a body's velocity exactly as the last substep did: the velocity after
//! relaxing minus the velocity before warm starting. Adding this change takes one pass over bodies instead
//! of one over contacts.
//!
//! Velocity changes by anything that is not accumulated are left out: free spin, velocity limits and
//! rolling resistance.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::body::Gains;
use super::{BodyRow, BodyRows, GainRow, RowView};
use crate::data::Parts;
use crate::thread_pool::ThreadPool;

/// Bodies per block of the job. More leaves workers idle at the end, fewer cost more claims.
const BLOCK: usize = 512;

impl BodyRows {
    /// Starts the gains of a substep, before impulses are applied. Returns whether the warm start was
    /// applied by adding the gains of the last substep.
    pub(super) fn begin_gains(&mut self, pool: &ThreadPool) -> bool {
        // Bodies that rotate far are seen with a different angular velocity in each substep.
        let adds = self.gains_known == Gains::Known && self.fast_turns.list().is_empty();
        if self.gains_known == Gains::Unused {
            return false;
        }
        self.each_gain(pool, |gain, row| gain.begin(row, adds));
        adds
    }

    /// Ends the gains of a substep, after its impulses were applied.
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

    /// Adds `share` times their velocity to the gains of bodies with free spin or limits, whose velocity
    /// changes other than by impulses. A call with −1 before the change and one with 1 after it exclude the
    /// change from the gains.
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
