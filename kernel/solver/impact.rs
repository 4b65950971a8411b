//! One manifold that is struck: how a row finds that it closes fast, and what the impact does to its two bodies.
//! [`Blows`](super::blow::Blows) solves impacts of many manifolds together.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::bearing::Bearing;
use super::input::Item;
use super::pair::{Pair, lanes_of_body};
use super::{BodyRow, ContactRow, InvMass, Motion, PointRow, RowView, SubstepParams};
use crate::math::{Angular, Ids, Lane, MAX_POINTS, Tangent, TangentFrame, TangentMass, Vector, max, min};
use core::cmp::Ordering;

/// Data of impacts, apart from the rows that every pass reads.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct ImpactRow<N: Lane> {
    /// The mixed coefficient of restitution.
    pub restitution: N,
    /// 1 if a point may be struck in this step: it closes fast at the start, or one of the bodies was struck. -1 if one of
    /// them overlaps another deeply: what was placed into one another has not met. Else 0.
    pub watched: N,
}

impl<N: Lane> Default for ImpactRow<N> {
    fn default() -> Self {
        Self { restitution: N::ZERO, watched: N::ZERO }
    }
}

/// Points that would touch within this many substeps are due: what touches at the end of a substep is struck before the solve
/// pass may stop it.
const DUE: f32 = 1.005;

/// Points that would touch within this many substeps are struck together with those that are due: of what lands flat, rounding
/// decides which points are.
const NEARLY: f32 = 1.01;

/// Points that are apart by less than this share of the fade of friction (1 mm) take part in an impact: they touch.
const TOUCHING: f32 = 0.05;

/// Where the points of a row are, and how fast they approach.
pub(super) struct Motions<N, const P: usize> {
    /// The moments of the normal about both centres of mass.
    moments: [[Angular<N>; 2]; P],
    /// Normal velocities, negative if they close, m/s.
    speeds: [N; P],
    /// Separations now, in metres.
    gaps: [N; P],
}

impl<N: Lane, M: InvMass<N>, const P: usize> ContactRow<N, M, P> {
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the row.
    #[inline(always)]
    unsafe fn motions(&self, rows: &RowView<BodyRow>) -> Motions<N, P> {
        // SAFETY: by the contract.
        let pair = unsafe { Pair::load(rows, &self.ids) };
        // SAFETY: by the contract.
        let [(pa, qa), (pb, qb)] = unsafe {
            [BodyRow::gather_delta::<N>(rows, &self.ids[0]), BodyRow::gather_delta::<N>(rows, &self.ids[1])]
        };
        let n = self.normal;
        let shift = (pb - pa).dot(n);
        let mut motions =
            Motions { moments: [[Angular::ZERO; 2]; P], speeds: [N::ZERO; P], gaps: [N::ZERO; P] };
        for i in 0..P {
            let (ra, rb) = (self.points[i].anchor, self.points[i].anchor - self.offset);
            let (ma, mb) = (ra.cross(n), rb.cross(n));
            let moved = shift + qb.shift_along(rb, mb, n) - qa.shift_along(ra, ma, n);
            motions.gaps[i] = self.points[i].separation + moved;
            motions.moments[i] = [ma, mb];
            motions.speeds[i] = pair.along(n, [ma, mb]);
        }
        motions
    }

    /// The lanes with a point that closes faster than a blow and touches within `time` seconds, as bits.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the row.
    #[inline(always)]
    pub(super) unsafe fn struck_lanes(
        &self,
        rows: &RowView<BodyRow>,
        params: &SubstepParams,
        time: f32,
    ) -> u32 {
        // SAFETY: by the contract.
        let Motions { speeds, gaps, .. } = unsafe { self.motions(rows) };
        let (slowest, time, mut lanes) = (N::splat(-params.blow_speed), N::splat(time * NEARLY), 0);
        for i in 0..P {
            let is_struck = N::and(speeds[i].lt(slowest), (gaps[i] + speeds[i] * time).le(N::ZERO));
            lanes |= N::bits(N::and(is_struck, N::ZERO.lt(self.points[i].mass)));
        }
        lanes
    }

    /// Lane `i`, with room for any number of points and without impulses.
    pub(super) fn lane(&self, i: usize) -> ContactRow<f32, Vector, MAX_POINTS> {
        let side = |side: usize| {
            // Bodies of shared rows are split.
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
                impulse: 0.0,
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
    /// Computes the effective masses of points that have any.
    fn weigh_points(&mut self) {
        let arms = self.points.map(|point| [point.anchor, point.anchor - self.offset]);
        self.weigh(&arms.map(|arms| arms.map(|arm| arm.cross(self.normal))));
    }

    /// Computes the effective masses of points that have any, by the moments of the normal about both centres of mass.
    fn weigh(&mut self, moments: &[[Angular; 2]; MAX_POINTS]) {
        let (n, [ia, ib]) = (self.normal, self.inv_inertia);
        let linear = n.dot(self.inv_mass[0].scale(n)) + n.dot(self.inv_mass[1].scale(n));
        for (point, [ma, mb]) in self.points.iter_mut().zip(moments).filter(|(point, _)| point.mass > 0.0) {
            let k = linear + ma.dot(ia.apply(*ma)) + mb.dot(ib.apply(*mb));
            point.mass = if k > 0.0 { 1.0 / k } else { 0.0 };
        }
    }

    /// Takes back that bodies below heavy ones have more mass in contacts.
    fn take_true_masses(&mut self, bearing: &Bearing) {
        let shares = self.ids.map(|[row]| bearing.share(row));
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

    /// Turns the normal, and the arms of a body that impulses do not move, to when the first point touches: a paddle may turn far
    /// within a step. Returns the moments of the normal and the normal velocities then. `None` if no such body turns.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the row.
    unsafe fn turn_with_paddle(
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

/// A manifold that is struck.
#[derive(Clone, Debug)]
pub(super) struct Struck {
    /// The contact, and the number of its manifold.
    pub(super) item: Item,
    /// Its row. Impulses are those of the present round.
    pub(super) row: ContactRow<f32, Vector, MAX_POINTS>,
    /// The bodies that are connected by impacts have the same number.
    pub(super) group: u32,
    /// The speed at which the fastest point closes, m/s. 0 if none is struck in this round.
    pub(super) speed: f32,
    /// Whether a point that closes fast touches in time.
    pub(super) is_due: bool,
    /// Whether it was struck in an earlier round.
    pub(super) is_old: bool,
    /// Whether no impulse stopped it in an earlier round: its bodies are jammed. Further rounds would do no better.
    pub(super) is_jammed: bool,
    /// Whether a point bounces.
    pub(super) bounces: bool,
    /// The time from the start of the substep until the first point touches, in seconds. Negative if it has touched before.
    pub(super) time: f32,
    /// The approach speed along the normal that accelerations added since the start of the step, m/s.
    pub(super) gained: f32,
    moments: [[Angular; 2]; MAX_POINTS],
    /// The ratio of the impulse that a point returns to the one that stops it. Negative for points that do not take part.
    returned: [f32; MAX_POINTS],
    /// The normal impulses that stopped the points, N·s, and the normal velocities then, m/s.
    stopped: [[f32; MAX_POINTS]; 2],
}

/// A point that takes no part in an impact.
const ABSENT: f32 = -1.0;

/// Operands of [`Struck::of`] that all manifolds have in common.
#[derive(Clone, Copy)]
pub(super) struct Striking<'a> {
    pub(super) bodies: RowView<'a, BodyRow>,
    pub(super) motions: &'a [Motion],
    pub(super) bearing: &'a Bearing,
    pub(super) params: &'a SubstepParams,
    /// The time within which points are struck, in seconds.
    pub(super) time: f32,
    /// The time from the start of the step to the end of the substep, in seconds.
    pub(super) elapsed: f32,
}

impl Struck {
    /// A manifold by its row, as it closes now.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the row.
    pub(super) unsafe fn of(
        item: Item,
        mut row: ContactRow<f32, Vector, MAX_POINTS>,
        restitution: f32,
        striking: &Striking,
    ) -> Self {
        let Striking { params, time, elapsed, .. } = *striking;
        row.take_true_masses(striking.bearing);
        // SAFETY: by the contract.
        let Motions { mut moments, mut speeds, gaps } = unsafe { row.motions(&striking.bodies) };
        // SAFETY: by the contract.
        if let Some(turned) = unsafe { row.turn_with_paddle(&striking.bodies, &speeds, &gaps, time) } {
            (moments, speeds) = turned;
        }
        let [a, b] = [0, 1].map(|side: usize| striking.motions[row.ids[side][0] as usize].acceleration);
        let closing = (a - b).dot(row.normal);
        let gained = closing * params.h;
        let bounce = Bounce { restitution, gained, inv_h: params.inv_h };
        // Contacts are predicted by velocities alone: what closes by acceleration may be this deep when it is found.
        let unforeseen = 0.5 * max(gained, 0.0) * params.inv_h * params.dt * params.dt;
        let mut struck = Self {
            item,
            row,
            group: 0,
            speed: 0.0,
            is_due: false,
            is_old: false,
            is_jammed: false,
            bounces: false,
            time: f32::MAX,
            gained: closing * elapsed,
            moments,
            returned: [ABSENT; MAX_POINTS],
            stopped: [[0.0; MAX_POINTS]; 2],
        };
        for i in (0..MAX_POINTS).filter(|i| row.points[*i].mass > 0.0) {
            let (speed, gap) = (-speeds[i], gaps[i]);
            if speed > params.blow_speed && gap <= speed * time * NEARLY {
                struck.is_due |= gap <= speed * time * DUE;
                struck.speed = max(struck.speed, speed);
                let touch = max(gap, -unforeseen) / speed;
                struck.time = min(struck.time, touch);
                // After the last substep, time is counted from its end.
                let touch = if time > 0.0 { touch } else { params.h + touch };
                let approach = speed - gained;
                let is_elastic = approach > params.restitution_threshold;
                struck.bounces |= is_elastic && restitution > 0.0;
                struck.returned[i] =
                    if is_elastic { bounce.parting(touch, approach, speed) / speed } else { 0.0 };
            } else if gap <= TOUCHING * params.friction_fade {
                struck.returned[i] = 0.0;
            }
        }
        struck
    }

    /// An order of manifolds by their bodies and places. Ids of contacts depend on what else was there before.
    pub(super) fn in_order(&self, other: &Self) -> Ordering {
        let places = [self, other].map(|one| one.row.points[0].anchor.to_array());
        let by_place = || {
            let all = places[0].iter().zip(&places[1]).map(|(a, b)| a.total_cmp(b));
            all.fold(Ordering::Equal, Ordering::then)
        };
        let by_id = || (self.item.id, self.item.index).cmp(&(other.item.id, other.item.index));
        self.row.ids.cmp(&other.row.ids).then_with(by_place).then_with(by_id)
    }

    /// One sweep of compression: stops the approach of each point, then rubs. Returns the largest change of velocity, m/s.
    ///
    /// # Safety
    /// Until it returns, no other thread reads or writes the bodies of the manifold that may be written, or writes the others.
    pub(super) unsafe fn compress(&mut self, rows: &RowView<BodyRow>, is_backward: bool) -> f32 {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.row.ids) };
        let (n, mut change) = (self.row.normal, 0.0f32);
        for k in 0..MAX_POINTS {
            let i = if is_backward { MAX_POINTS - 1 - k } else { k };
            let PointRow { mass, impulse, .. } = self.row.points[i];
            if self.returned[i] < 0.0 {
                continue;
            }
            let new = max(impulse - mass * pair.along(n, self.moments[i]), 0.0);
            let delta = new - impulse;
            self.row.points[i].impulse = new;
            change = max(change, delta.abs() / mass);
            self.row.push(&mut pair, n * delta, self.moments[i].map(|moment| moment * delta));
        }
        change = max(change, self.row.rub(&mut pair));
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.row.ids) };
        change
    }

    /// Ends compression.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the manifold.
    pub(super) unsafe fn stop(&mut self, rows: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        self.stopped = [self.impulses(), unsafe { self.speeds(rows) }];
    }

    /// Makes each impulse that of compression and a share of it, which is a function of the share that the point returns.
    ///
    /// # Safety
    /// As [`compress`](Self::compress).
    pub(super) unsafe fn restitute(&mut self, rows: &RowView<BodyRow>, share: impl Fn(f32) -> f32) {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.row.ids) };
        for i in (0..MAX_POINTS).filter(|i| self.stopped[0][*i] > 0.0) {
            let more = self.stopped[0][i] * (1.0 + share(self.returned[i])) - self.row.points[i].impulse;
            self.row.points[i].impulse += more;
            let moments = self.moments[i].map(|moment| moment * more);
            self.row.push(&mut pair, self.row.normal * more, moments);
        }
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.row.ids) };
    }

    /// Twice the energy of the motion that restitution adds, J: over all manifolds of a group, the sum of impulses times
    /// changes of velocity.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the manifold.
    pub(super) unsafe fn added(&self, rows: &RowView<BodyRow>) -> f32 {
        // SAFETY: by the contract.
        let (impulses, speeds) = (self.impulses(), unsafe { self.speeds(rows) });
        let [stopping, before] = &self.stopped;
        (0..MAX_POINTS).map(|i| (impulses[i] - stopping[i]) * (speeds[i] - before[i])).sum()
    }

    /// The normal velocities of the points, m/s.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the manifold.
    unsafe fn speeds(&self, rows: &RowView<BodyRow>) -> [f32; MAX_POINTS] {
        // SAFETY: by the contract.
        let pair = unsafe { Pair::load(rows, &self.row.ids) };
        self.moments.map(|moments| pair.along(self.row.normal, moments))
    }

    /// One sweep of friction alone. Returns the largest change of velocity, m/s.
    ///
    /// # Safety
    /// As [`compress`](Self::compress).
    pub(super) unsafe fn rub(&mut self, rows: &RowView<BodyRow>) -> f32 {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.row.ids) };
        let change = self.row.rub(&mut pair);
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.row.ids) };
        change
    }

    /// Notes whether it still closes fast.
    ///
    /// # Safety
    /// Until it returns, no other thread writes the bodies of the manifold.
    pub(super) unsafe fn find_jam(&mut self, rows: &RowView<BodyRow>, params: &SubstepParams) {
        // SAFETY: by the contract.
        let speeds = unsafe { self.speeds(rows) };
        let closes = |(speed, share): (&f32, &f32)| *share >= 0.0 && *speed < -params.blow_speed;
        self.is_jammed |= speeds.iter().zip(&self.returned).any(closes);
    }

    /// The least and the greatest share that stopped points return; the least is `f32::MAX` if none is.
    pub(super) fn shares(&self) -> [f32; 2] {
        let is_stopped = |(share, point): &(&f32, &PointRow<f32>)| **share >= 0.0 && point.impulse > 0.0;
        let stopped = self.returned.iter().zip(&self.row.points).filter(is_stopped);
        stopped.fold([f32::MAX, 0.0], |[least, most], (share, _)| [min(least, *share), max(most, *share)])
    }

    /// The normal impulses of this round, N·s.
    pub(super) fn impulses(&self) -> [f32; MAX_POINTS] {
        self.row.points.map(|point| point.impulse)
    }

    /// Ends the round: the next one begins without impulses, and strikes nothing of this manifold by itself.
    pub(super) fn rest(&mut self) {
        self.row.points.iter_mut().for_each(|point| point.impulse = 0.0);
        self.row.tangent_impulse = Tangent::ZERO;
        self.row.twist.set_impulse(0, 0.0);
        (self.speed, self.is_due, self.is_old, self.bounces) = (0.0, false, true, false);
        self.returned = self.returned.map(|share| if share < 0.0 { share } else { 0.0 });
    }
}

impl ContactRow<f32, Vector, MAX_POINTS> {
    /// Friction of an impact. Returns the change of the slip, m/s, about.
    fn rub(&mut self, pair: &mut Pair<f32>) -> f32 {
        let (before, pressure) = (self.tangent_impulse, self.pressure());
        if self.friction * pressure == 0.0 && before == Tangent::ZERO {
            return 0.0;
        }
        self.solve_friction(pair, Vector::ZERO, pressure);
        (self.tangent_impulse - before).length() * self.tangent_mass.mean_inverse()
    }
}

/// How a point rebounds within a substep.
struct Bounce {
    restitution: f32,
    /// Approach speed that accelerations add in a substep, m/s.
    gained: f32,
    inv_h: f32,
}

impl Bounce {
    /// The speed at which a point leaves that touches `time` seconds after the start of the substep. `approach` is the speed
    /// before the substep's accelerations, `speed` the one after.
    ///
    /// Symplectic Euler conserves E = ½ v² + g y − ½ g h v of a free fall exactly (v upward). The speed w makes E after
    /// the substep, at y = w (h − t), e² times the E before. The rebound height is e² of the fall height at any step
    /// length, and no energy is gained.
    fn parting(&self, time: f32, approach: f32, speed: f32) -> f32 {
        // g h and g t.
        let (gh, gt) = (self.gained, self.gained * self.inv_h * time);
        let kept = 0.5 * approach * approach + speed * gt + 0.5 * gh * approach;
        let b = 0.5 * gh - gt;
        (b * b + 2.0 * self.restitution * self.restitution * max(kept, 0.0)).sqrt() - b
    }
}
