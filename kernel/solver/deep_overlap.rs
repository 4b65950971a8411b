//! Split impulses: counts deep overlaps by body. Split impulses push deep overlap out by moving bodies
//! without changing their velocities.

use super::BodyRows;
use super::input::RowInput;
use crate::contact::ContactFlags;
use crate::tuning::solver::WARM_CONTACTS;

/// Number of deeply overlapping contacts of each dynamic body, by row. Empty in steps without deep overlap.
///
/// If a body overlaps many others deeply, as when a crowd is spawned in one place, its contacts work
/// against each other. Contacts in a crowd therefore push less, and warm-start from a share of their last
/// impulses.
#[derive(Clone, Debug, Default)]
pub(super) struct DeepCounts(Vec<u32>);

impl DeepCounts {
    pub(super) fn count(&mut self, input: &RowInput, bodies: &BodyRows) {
        self.0.clear();
        if !input.contacts.any_deep {
            return;
        }
        self.0.resize(bodies.rows.len(), 0);
        for id in input.contacts.active() {
            let contact = input.contacts.get(id);
            if contact.flags.has(ContactFlags::DEEP) && contact.slot.is_some() {
                for body in contact.bodies {
                    let row = input.row_of(body);
                    self.0[row as usize] += u32::from(row >= bodies.first_dynamic);
                }
            }
        }
    }

    /// Whether any contact overlaps deeply.
    pub(super) fn any(&self) -> bool {
        !self.0.is_empty()
    }

    /// Number of deep contacts of the less crowded dynamic body of a contact, at least 1.
    #[inline(always)]
    fn crowd(&self, rows: [u32; 2], first_dynamic: u32) -> f32 {
        let count = rows.into_iter().filter(|r| *r >= first_dynamic).map(|r| self.0[r as usize]).min();
        count.unwrap_or(1).max(1) as f32
    }

    /// Share of the push-out speed of a contact between two body rows with n deep contacts: n^(−3/4). With
    /// 1/n, which bounds any sum of pushes, a hundred bodies in one place hardly move in five seconds,
    /// since most pushes cancel. With 1/√n, the sum of random pushes, an overfull container does not calm
    /// down.
    #[inline(always)]
    pub(super) fn share(&self, rows: [u32; 2], first_dynamic: u32) -> f32 {
        if !self.any() {
            return 1.0;
        }
        let root = self.crowd(rows, first_dynamic).sqrt();
        1.0 / (root * root.sqrt())
    }

    /// Share of the last impulses with which a contact between two body rows warm-starts. One sweep does
    /// not converge for a body with dozens of contacts: if they started from all of their impulses, the
    /// error would grow from substep to substep.
    #[inline(always)]
    pub(super) fn warm_share(&self, rows: [u32; 2], first_dynamic: u32) -> f32 {
        crate::math::min(1.0, WARM_CONTACTS / self.crowd(rows, first_dynamic))
    }

    /// Whether one of these bodies overlaps another deeply.
    #[inline(always)]
    pub(super) fn concern(&self, rows: [u32; 2]) -> bool {
        rows.iter().any(|row| self.0[*row as usize] > 0)
    }
}
