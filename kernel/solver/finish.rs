//! Writes the result of the last substep back from rows to the body table.
#![expect(unsafe_code, reason = "bodies are changed by several threads, each its own")]

use super::{BodyRow, RowView, Solver};
use crate::contact::CHORD;
use crate::data::{BitSet, Parts};
use crate::math::{F32x4, Ids, Lane, Rot, Vector, WorldPose};
use crate::table::{BodyParts, BodyTable, FAR, Velocity};
use crate::thread_pool::ThreadPool;
use crate::tuning::contact::RECYCLE_COS;
use std::sync::{Mutex, PoisonError};

/// Bodies per block of the job, a multiple of the widest lanes. More leaves workers idle at the end, fewer
/// cost more claims.
const BLOCK: usize = 256;

impl Solver {
    /// Adds the displacement of each body to its pose, stores the velocity of dynamic bodies, and updates
    /// sleep timers. `listed` are the bodies in the order of rows, from row 1. `frames` receives the frame
    /// of each body that [moved](BodyRow::is_moved), by id.
    ///
    /// Returns the rows with a non-finite result, in no particular order: these bodies keep pose and
    /// velocity. Bodies whose row now belongs to another body are skipped.
    pub fn finish(
        &mut self,
        bodies: &mut BodyTable,
        listed: &[u32],
        frames: &mut [WorldPose],
        dt: f32,
        pool: &ThreadPool,
    ) -> Vec<u32> {
        debug_assert!(dt.is_finite() && dt >= 0.0, "a step of {dt} s");
        let is_known = |id: &u32| (*id as usize) < frames.len() && bodies.ids.is_live(*id);
        debug_assert!(listed.iter().all(is_known), "listed bodies are in use and have frames");
        let listed = &listed[..listed.len().min(self.bodies.rows.len().saturating_sub(1))];
        let finish = Finish {
            first_dynamic: self.bodies.first_dynamic,
            rows: RowView::over(&mut self.bodies.rows, u32::MAX),
            bodies: bodies.parts(),
            frames: Parts::of(frames),
            dt,
            moved: &self.bodies.moved,
            lost: Mutex::new(Vec::new()),
        };
        pool.each(listed.chunks(BLOCK).enumerate(), |(block, ids)| {
            let first = (1 + block * BLOCK) as u32;
            let (fours, rest) = ids.as_chunks();
            for (i, ids) in fours.iter().enumerate() {
                finish.bodies::<F32x4>(first + (F32x4::WIDTH * i) as u32, ids);
            }
            for (i, id) in rest.iter().enumerate() {
                finish.bodies::<f32>(first + (F32x4::WIDTH * fours.len() + i) as u32, &[*id]);
            }
        });
        finish.lost.into_inner().unwrap_or_else(PoisonError::into_inner)
    }
}

/// The tables that are read and written.
struct Finish<'a> {
    rows: RowView<'a, BodyRow>,
    first_dynamic: u32,
    bodies: BodyParts<'a>,
    frames: Parts<'a, WorldPose>,
    dt: f32,
    /// As in [`BodyRows`](super::BodyRows).
    moved: &'a BitSet,
    lost: Mutex<Vec<u32>>,
}

impl Finish<'_> {
    /// Finishes one body per lane, with rows from `first` on. Each row is finished once.
    #[inline(always)]
    fn bodies<N: Lane>(&self, first: u32, ids: &N::Ids) {
        let &Self { ref rows, ref bodies, dt, .. } = self;
        let ids = ids.lanes();
        if !ids.iter().zip(first..).all(|(id, row)| bodies.rows[*id as usize] == row) {
            if N::WIDTH > 1 {
                ids.iter().zip(first..).for_each(|(id, row)| self.bodies::<f32>(row, &[*id]));
            }
            return;
        }
        let mut lanes = N::Ids::splat(first);
        let mut before = Rot::<N>::default();
        for (i, id) in ids.iter().enumerate() {
            lanes.set(i, first + i as u32);
            // SAFETY: no two bodies share a row, so no other thread uses this row.
            before.set(i, unsafe { bodies.poses.one(*id as usize) }.rotation);
        }
        // SAFETY: no row is written through this view.
        let (displacement, turn) = unsafe { BodyRow::gather_delta::<N>(rows, &lanes) };
        let rotation = turn.mul(before).renormalized();
        let displacement_squared = displacement.length_squared();
        let delta = turn;
        let turn = delta.small_turn();
        let angle_squared = turn.length_squared();
        let (way, angle) = (displacement.length(), angle_squared.sqrt());
        let is_near = N::bits(N::splat(RECYCLE_COS).le(delta.cos_angle()));
        for (i, id) in ids.iter().enumerate() {
            let (row, id) = (first + i as u32, *id as usize);
            // SAFETY: as above.
            let (body, pose) = unsafe { (bodies.bodies.one(id), bodies.poses.one(id)) };
            // SAFETY: no row is written through this view.
            let motion = unsafe { rows.get(row) };
            let (linear, angular) = motion.velocity();
            let (center, rotation) =
                (pose.center + Vector::get(&displacement, i).to_world(), Rot::get(&rotation, i));
            let placed = center.is_finite_world() & rotation.is_finite();
            if !(placed & linear.is_finite() & angular.is_finite()) {
                pose.travel = pose.travel.wrapping_add(FAR);
                self.lost.lock().unwrap_or_else(PoisonError::into_inner).push(row);
                continue;
            }
            if row >= self.first_dynamic {
                let velocity = Velocity { linear, angular };
                pose.speed = velocity.surface_speed(body.extent);
                // SAFETY: as above.
                *unsafe { bodies.velocities.one(id) } = velocity;
            }
            let way = way.get(i) + CHORD * body.extent * angle.get(i);
            let is_far = is_near >> i & 1 == 0 || self.moved.contains(row);
            // One unit more, as the travel is rounded down.
            let travel = if is_far { FAR } else { bodies.travel_scale.travelled(way) + u32::from(way > 0.0) };
            pose.travel = pose.travel.wrapping_add(travel);
            if motion.is_moved() {
                (pose.center, pose.rotation) = (center, rotation);
                // SAFETY: as above.
                *unsafe { self.frames.one(id) } = pose.frame(body.local_center);
            }
            let mut rests = body.rest_speed.admits(displacement_squared.get(i), angle_squared.get(i), dt);
            if row >= self.first_dynamic {
                rests |= body.rests_on_average(Vector::get(&displacement, i), turn.get(i), dt);
            }
            body.sleep_timer = if rests { body.sleep_timer + dt } else { 0.0 };
        }
    }
}
