//! Detection of contact rows that close fast, and extraction of their lanes for blows.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::mass_scaling::MassScaling;
use super::pair::{Pair, lanes_of_body};
use super::{BodyRow, ContactRow, InvMass, PointRow, RowView, SubstepParams};
use crate::math::{Angular, Ids, Lane, MAX_POINTS, Tangent, TangentFrame, TangentMass, Vector, max, min};
use crate::tuning::solver::NEARLY;

/// Data of impacts, apart from the rows that every pass reads.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct ImpactRow<N: Lane> {
    /// The mixed coefficient of restitution.
    pub restitution: N,
    /// 1 if a point may be struck in this step: it closes fast at the start, or one of the bodies was
    /// struck. -1 if one of the bodies overlaps another deeply: bodies that were placed inside one another
    /// have not collided. Otherwise 0.
    pub watched: N,
}

impl<N: Lane> Default for ImpactRow<N> {
    fn default() -> Self {
        Self { restitution: N::ZERO, watched: N::ZERO }
    }
}

/// Positions and approach speeds of the points of a row.
pub(super) struct Motions<N, const P: usize> {
    /// The moments of the normal about both centres of mass.
    pub(super) moments: [[Angular<N>; 2]; P],
    /// Normal velocities, negative if they close, m/s.
    pub(super) speeds: [N; P],
    /// Current separations, in metres.
    pub(super) gaps: [N; P],
}

impl<N: Lane, M: InvMass<N>, const P: usize> ContactRow<N, M, P> {
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the row.
    #[inline(always)]
    pub(super) unsafe fn motions(&self, rows: &RowView<BodyRow>) -> Motions<N, P> {
        // SAFETY: by the contract.
        let (moments, speeds) = unsafe { self.speeds(rows) };
        // SAFETY: by the contract.
        let gaps = unsafe { self.gaps(rows, &moments) };
        Motions { moments, speeds, gaps }
    }

    /// The moments of the normal and the normal velocities, as in [`motions`](Self::motions).
    ///
    /// # Safety
    /// As [`motions`](Self::motions).
    #[inline(always)]
    unsafe fn speeds(&self, rows: &RowView<BodyRow>) -> ([[Angular<N>; 2]; P], [N; P]) {
        // SAFETY: by the contract.
        let pair = unsafe { Pair::load(rows, &self.ids) };
        let (n, mut moments, mut speeds) = (self.normal, [[Angular::ZERO; 2]; P], [N::ZERO; P]);
        for i in 0..P {
            let (ra, rb) = (self.points[i].anchor, self.points[i].anchor - self.offset);
            moments[i] = [ra.cross(n), rb.cross(n)];
            speeds[i] = pair.along(n, moments[i]);
        }
        (moments, speeds)
    }

    /// The separations, as in [`motions`](Self::motions), given the moments of the normal.
    ///
    /// # Safety
    /// As [`motions`](Self::motions).
    #[inline(always)]
    unsafe fn gaps(&self, rows: &RowView<BodyRow>, moments: &[[Angular<N>; 2]; P]) -> [N; P] {
        // SAFETY: by the contract.
        let [(pa, qa), (pb, qb)] = unsafe {
            [BodyRow::gather_delta::<N>(rows, &self.ids[0]), BodyRow::gather_delta::<N>(rows, &self.ids[1])]
        };
        let (n, mut gaps) = (self.normal, [N::ZERO; P]);
        let shift = (pb - pa).dot(n);
        for i in 0..P {
            let (ra, rb) = (self.points[i].anchor, self.points[i].anchor - self.offset);
            let [ma, mb] = moments[i];
            let moved = shift + qb.shift_along(rb, mb, n) - qa.shift_along(ra, ma, n);
            gaps[i] = self.points[i].separation + moved;
        }
        gaps
    }

    /// The lanes among `lanes` with a point that closes at more than the blow speed and touches within
    /// `time` seconds, as bits.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the row.
    #[inline(always)]
    pub(super) unsafe fn struck_lanes(
        &self,
        lanes: u32,
        rows: &RowView<BodyRow>,
        params: &SubstepParams,
        time: f32,
    ) -> u32 {
        // SAFETY: by the contract.
        let (moments, speeds) = unsafe { self.speeds(rows) };
        let (slowest, time, mut any) = (N::splat(-params.blow_speed), N::splat(time * NEARLY), 0);
        let mut is_fast = [N::ZERO.lt(N::ZERO); P];
        for i in 0..P {
            is_fast[i] = N::and(speeds[i].lt(slowest), N::ZERO.lt(self.points[i].mass));
            any |= N::bits(is_fast[i]);
        }
        // Few lanes close fast. The others need no gaps.
        if any & lanes == 0 {
            return 0;
        }
        // SAFETY: by the contract.
        let (gaps, mut struck) = (unsafe { self.gaps(rows, &moments) }, 0);
        for i in 0..P {
            struck |= N::bits(N::and(is_fast[i], (gaps[i] + speeds[i] * time).le(N::ZERO)));
        }
        struck & lanes
    }

    /// Lane `i` as a row with room for the maximum number of points, without impulses.
    pub(super) fn lane(&self, i: usize) -> ContactRow<f32, Vector, MAX_POINTS> {
        let side = |side: usize| {
            // In a shared row, the mass of a body is split among its lanes.
            let count = if N::SHARES { lanes_of_body::<N>(&self.ids, side).get(i) } else { 1.0 };
            let inertia = self.inv_inertia[side].get(i).scaled(1.0 / count);
            (self.inv_mass[side].diagonal().get(i) * (1.0 / count), inertia)
        };
        let [a, b] = [side(0), side(1)];
        let points = core::array::from_fn(|k| {
            self.points.get(k).map_or_else(PointRow::default, |point| PointRow {
                anchor: point.anchor.get(i),
                separation: point.separation.get(i),
                mass: point.mass.get(i),
                ..PointRow::default()
            })
        });
        let mut row = ContactRow {
            ids: [0, 1].map(|side: usize| [self.ids[side].lanes()[i]]),
            inv_mass: [a.0, b.0],
            inv_inertia: [a.1, b.1],
            normal: self.normal.get(i),
            offset: self.offset.get(i),
            radius: self.radius.get(i),
            roll_lever: 0.0,
            friction: self.friction.get(i),
            push_speed: 0.0,
            surface_velocity: self.surface_velocity.get(i),
            center: self.center.get(i),
            tangent_mass: TangentMass::default(),
            tangent_impulse: Tangent::ZERO,
            owed: 0.0,
            twist: self.twist.lane(i),
            points,
        };
        if N::SHARES {
            row.weigh_points();
        }
        row.weigh_friction(&TangentFrame::new(row.normal));
        row
    }
}

impl ContactRow<f32, Vector, MAX_POINTS> {
    /// Computes the effective masses of points with a nonzero mass.
    pub(super) fn weigh_points(&mut self) {
        let arms = self.points.map(|point| [point.anchor, point.anchor - self.offset]);
        self.weigh(&arms.map(|arms| arms.map(|arm| arm.cross(self.normal))));
    }

    /// Computes the effective masses of points with a nonzero mass, from the moments of the normal about
    /// both centres of mass.
    fn weigh(&mut self, moments: &[[Angular; 2]; MAX_POINTS]) {
        let (n, [ia, ib]) = (self.normal, self.inv_inertia);
        let linear = n.dot(self.inv_mass[0].scale(n)) + n.dot(self.inv_mass[1].scale(n));
        for (point, [ma, mb]) in self.points.iter_mut().zip(moments).filter(|(point, _)| point.mass > 0.0) {
            let k = linear + ma.dot(ia.apply(*ma)) + mb.dot(ib.apply(*mb));
            point.mass = if k > 0.0 { 1.0 / k } else { 0.0 };
        }
    }

    /// Restores the true masses of bodies that have a raised mass in contacts.
    pub(super) fn take_true_masses(&mut self, mass_scaling: &MassScaling) {
        let shares = self.ids.map(|[row]| mass_scaling.share(row));
        if shares == [Vector::ONE; 2] {
            return;
        }
        for (side, share) in shares.into_iter().enumerate() {
            let factors = Vector::from_array(share.to_array().map(|share| 1.0 / share));
            self.inv_mass[side] = self.inv_mass[side].scale(factors);
            self.inv_inertia[side] = self.inv_inertia[side].scaled(1.0 / share.min_element());
        }
        self.weigh_points();
        self.weigh_friction(&TangentFrame::new(self.normal));
    }

    /// Rotates the normal and the arms of a body that impulses do not move to the time when the first point
    /// touches: a paddle may rotate far within a step. Returns the moments of the normal and the normal
    /// velocities at that time. `None` if no such body rotates.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the row.
    pub(super) unsafe fn turn_with_paddle(
        &mut self,
        rows: &RowView<BodyRow>,
        speeds: &[f32; MAX_POINTS],
        gaps: &[f32; MAX_POINTS],
        time: f32,
    ) -> Option<([[Angular; 2]; MAX_POINTS], [f32; MAX_POINTS])> {
        // SAFETY: by the contract.
        let pair = unsafe { Pair::load(rows, &self.ids) };
        let turns = |side: &usize| self.inv_mass[*side].is_zero() && pair.w[*side] != Angular::ZERO;
        let side = [0, 1].into_iter().find(turns)?;
        let due = |(speed, gap): (&f32, &f32)| if *speed < 0.0 { max(*gap, 0.0) / -speed } else { time };
        let touch = speeds.iter().zip(gaps).map(due).fold(time, min);
        // SAFETY: by the contract.
        let turn = unsafe { rows.get(self.ids[side][0]) }.delta().1.turned_by(pair.w[side] * touch);
        let old = self.normal;
        let [mut ra, mut rb] = self.surface_arms();
        let arms = self.points.map(|point| [point.anchor, point.anchor - self.offset]);
        self.normal = turn.rotate(old);
        let moments = arms.map(|[a, b]| {
            let [a, b] = if side == 0 { [turn.rotate(a), b] } else { [a, turn.rotate(b)] };
            [a.cross(self.normal), b.cross(self.normal)]
        });
        if side == 0 {
            ra = turn.rotate(ra);
        } else {
            rb = turn.rotate(rb);
        }
        (self.center, self.offset) = (ra, ra - rb - self.normal * self.radius);
        self.weigh(&moments);
        self.weigh_friction(&TangentFrame::new(self.normal));
        Some((moments, moments.map(|moments| pair.along(self.normal, moments))))
    }
}
