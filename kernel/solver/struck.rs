//! A struck manifold, and the effect of the impact on its two bodies. Manifolds of a
//! [group](super::impact_group) are solved together.
#![expect(unsafe_code, reason = "rows of bodies are shared by threads")]

use super::impact::Motions;
use super::input::Item;
use super::mass_scaling::MassScaling;
use super::pair::Pair;
use super::{BodyRow, ContactRow, Motion, PointRow, RowView, SubstepParams};
use crate::math::{Angular, Ids, Lane, MAX_POINTS, Tangent, TangentFrame, Vector, max, min};
use crate::tuning::solver::{NEARLY, TOUCHING};
use core::cmp::Ordering;

/// A struck manifold.
#[derive(Clone, Debug)]
pub(super) struct Struck {
    /// The contact, and the number of its manifold.
    pub(super) item: Item,
    /// The row of the manifold, with the impulses of the current phase.
    pub(super) row: ContactRow<f32, Vector, MAX_POINTS>,
    /// The number of the group. Bodies that impacts connect are in one group.
    pub(super) group: u32,
    /// The closing speed of the fastest struck point, m/s. 0 if no point is struck in this round.
    pub(super) speed: f32,
    /// Whether a point that closes fast touches within the substep.
    pub(super) is_due: bool,
    /// Whether the manifold was struck in an earlier round.
    pub(super) is_old: bool,
    /// Whether impulses failed to stop the manifold in an earlier round: its bodies are jammed, and further
    /// rounds would not help.
    pub(super) is_jammed: bool,
    /// Whether a point bounces.
    pub(super) bounces: bool,
    /// The time from the start of the substep until the first point touches, in seconds. Negative if it
    /// touched before.
    pub(super) time: f32,
    /// The approach speed along the normal that accelerations have added since the start of the step, m/s.
    pub(super) gained: f32,
    pub(super) moments: [[Angular; 2]; MAX_POINTS],
    /// The ratio of a point's restitution impulse to its compression impulse. Negative for points that take
    /// no part.
    returned: [f32; MAX_POINTS],
    /// The normal impulses of compression, N·s, during the phase of restitution.
    stopped: [f32; MAX_POINTS],
    /// The velocities before the current phase.
    before: Pair<f32>,
}

/// Marks a point that takes no part in an impact.
const ABSENT: f32 = -1.0;

/// Operands of [`Struck::of`] that are the same for all manifolds.
#[derive(Clone, Copy)]
pub(super) struct Striking<'a> {
    pub(super) bodies: RowView<'a, BodyRow>,
    pub(super) motions: &'a [Motion],
    pub(super) mass_scaling: &'a MassScaling,
    pub(super) params: &'a SubstepParams,
    /// The time within which points are struck, in seconds.
    pub(super) time: f32,
    /// The time from the start of the step to the end of the substep, in seconds.
    pub(super) elapsed: f32,
}

impl Struck {
    /// A struck manifold from its row, with the current closing speeds.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the row.
    pub(super) unsafe fn of(
        item: Item,
        mut row: ContactRow<f32, Vector, MAX_POINTS>,
        restitution: f32,
        striking: &Striking,
    ) -> Self {
        let Striking { params, time, elapsed, .. } = *striking;
        row.take_true_masses(striking.mass_scaling);
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
        // Contacts are predicted by velocities alone, so acceleration may have closed a contact this deep
        // before it is found.
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
            stopped: [0.0; MAX_POINTS],
            before: Pair::default(),
        };
        for i in (0..MAX_POINTS).filter(|i| row.points[*i].mass > 0.0) {
            let (speed, gap) = (-speeds[i], gaps[i]);
            if speed > params.blow_speed && gap <= speed * time * NEARLY {
                struck.is_due |= gap <= speed * time * (0.5 * (1.0 + NEARLY));
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

    /// A struck manifold from its row. All points with a mass take part.
    #[cfg(test)]
    pub(super) fn of_row(mut row: ContactRow<f32, Vector, MAX_POINTS>) -> Self {
        row.weigh_points();
        row.weigh_friction(&TangentFrame::new(row.normal));
        let moments = row
            .points
            .map(|point| [point.anchor, point.anchor - row.offset].map(|arm| arm.cross(row.normal)));
        Self {
            item: Item { id: 0, index: 0 },
            returned: row.points.map(|point| if point.mass > 0.0 { 0.0 } else { ABSENT }),
            row,
            group: 0,
            speed: 1.0,
            is_due: true,
            is_old: false,
            is_jammed: false,
            bounces: false,
            time: 0.0,
            gained: 0.0,
            moments,
            stopped: [0.0; MAX_POINTS],
            before: Pair::default(),
        }
    }

    /// An order by position for manifolds of the same bodies. Ids of contacts depend on the contacts that
    /// existed before.
    pub(super) fn in_order(&self, other: &Self) -> Ordering {
        let places = [self, other].map(|one| one.row.points[0].anchor.to_array());
        let by_place = || {
            let all = places[0].iter().zip(&places[1]).map(|(a, b)| a.total_cmp(b));
            all.fold(Ordering::Equal, Ordering::then)
        };
        let by_id = || (self.item.id, self.item.index).cmp(&(other.item.id, other.item.index));
        by_place().then_with(by_id)
    }

    /// Whether a point takes part in the impact.
    #[inline(always)]
    pub(super) fn takes_part(&self, point: usize) -> bool {
        self.returned[point] >= 0.0
    }

    /// Starts compression.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the manifold.
    pub(super) unsafe fn begin(&mut self, rows: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        self.before = unsafe { Pair::load(rows, &self.row.ids) };
    }

    /// Ends compression: impulses from here on are restitution impulses, starting from zero friction.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the manifold.
    pub(super) unsafe fn stop(&mut self, rows: &RowView<BodyRow>) {
        self.stopped = self.row.points.map(|point| point.impulse);
        self.row.forget();
        // SAFETY: by the contract.
        unsafe { self.begin(rows) };
    }

    /// Applies to each point the share of its compression impulse that it returns.
    ///
    /// # Safety
    /// Until the call returns, no other thread reads or writes the dynamic bodies of the manifold, or
    /// writes its other bodies.
    pub(super) unsafe fn restitute(&mut self, rows: &RowView<BodyRow>) {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.row.ids) };
        for i in (0..MAX_POINTS).filter(|i| self.stopped[*i] > 0.0) {
            let impulse = self.stopped[i] * self.returned[i];
            self.row.points[i].impulse = impulse;
            self.row.push(
                &mut pair,
                self.row.normal * impulse,
                self.moments[i].map(|moment| moment * impulse),
            );
        }
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.row.ids) };
    }

    /// The work of the impulses of the current phase, J, in two parts: the work at the velocities before
    /// the phase, and the work at half of the velocity changes by the impulses of all manifolds. Scaling
    /// all impulses of a group by s scales the first part by s and the second by s².
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the manifold.
    pub(super) unsafe fn work(&self, rows: &RowView<BodyRow>) -> [f32; 2] {
        // SAFETY: by the contract.
        let now = unsafe { Pair::load(rows, &self.row.ids) };
        let [before, now] = [self.before, now].map(|pair| self.power(&pair));
        [before, 0.5 * (now - before)]
    }

    /// The impulses of the current phase times velocities at the contact, J.
    fn power(&self, pair: &Pair<f32>) -> f32 {
        let Self { row, moments, .. } = self;
        let normal = row.points.iter().zip(moments);
        let normal: f32 =
            normal.map(|(point, moments)| point.impulse * pair.along(row.normal, *moments)).sum();
        let frame = TangentFrame::new(row.normal);
        let [slip, impulse] = [row.slip(pair, &frame), row.tangent_impulse].map(|along| frame.expand(along));
        normal + impulse.dot(slip) + row.twist.power(row.normal, &pair.w)
    }

    /// Scales the normal impulses of the current phase.
    pub(super) fn scale(&mut self, share: f32) {
        self.row.points.iter_mut().for_each(|point| point.impulse *= share);
    }

    /// The normal velocities of the points, m/s.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the manifold.
    unsafe fn speeds(&self, rows: &RowView<BodyRow>) -> [f32; MAX_POINTS] {
        // SAFETY: by the contract.
        let pair = unsafe { Pair::load(rows, &self.row.ids) };
        self.moments.map(|moments| pair.along(self.row.normal, moments))
    }

    /// One sweep of friction alone. Returns the largest velocity change, m/s.
    ///
    /// # Safety
    /// As [`restitute`](Self::restitute).
    pub(super) unsafe fn solve_coulomb(&mut self, rows: &RowView<BodyRow>) -> f32 {
        // SAFETY: by the contract.
        let mut pair = unsafe { Pair::load(rows, &self.row.ids) };
        let change = self.row.solve_coulomb(&mut pair);
        // SAFETY: by the contract.
        unsafe { pair.store(rows, &self.row.ids) };
        change
    }

    /// Marks the manifold as jammed if it still closes fast.
    ///
    /// # Safety
    /// Until the call returns, no other thread writes the bodies of the manifold.
    pub(super) unsafe fn find_jam(&mut self, rows: &RowView<BodyRow>, params: &SubstepParams) {
        // SAFETY: by the contract.
        let speeds = unsafe { self.speeds(rows) };
        let closes = |(speed, share): (&f32, &f32)| *share >= 0.0 && *speed < -params.blow_speed;
        self.is_jammed |= speeds.iter().zip(&self.returned).any(closes);
    }

    /// The greatest share that a stopped point returns.
    pub(super) fn share(&self) -> f32 {
        let is_stopped = |(_, point): &(&f32, &PointRow<f32>)| point.impulse > 0.0;
        let stopped = self.returned.iter().zip(&self.row.points).filter(is_stopped);
        stopped.fold(0.0, |most, (share, _)| max(most, *share))
    }

    /// The normal impulses of this round, N·s.
    pub(super) fn impulses(&self) -> [f32; MAX_POINTS] {
        core::array::from_fn(|i| self.stopped[i] + self.row.points[i].impulse)
    }

    /// Ends the round. In the next round the manifold begins without impulses, and none of its points is
    /// struck unless found again.
    pub(super) fn rest(&mut self) {
        self.row.forget();
        self.stopped = [0.0; MAX_POINTS];
        (self.speed, self.is_due, self.is_old, self.bounces) = (0.0, false, true, false);
        self.returned = self.returned.map(|share| if share < 0.0 { share } else { 0.0 });
    }
}

impl ContactRow<f32, Vector, MAX_POINTS> {
    /// Clears the impulses, at the start of a phase.
    fn forget(&mut self) {
        self.points.iter_mut().for_each(|point| point.impulse = 0.0);
        self.tangent_impulse = Tangent::ZERO;
        self.twist.set_impulse(0, 0.0);
    }
}

impl<N: Lane, const P: usize> ContactRow<N, Vector<N>, P> {
    /// Solves the friction of an impact. Returns the approximate change of the slip, m/s.
    #[inline(always)]
    pub(super) fn solve_coulomb(&mut self, pair: &mut Pair<N>) -> N {
        let (before, pressure) = (self.tangent_impulse, self.pressure());
        self.solve_friction(pair, Vector::ZERO, pressure);
        (self.tangent_impulse - before).length() * self.tangent_mass.mean_inverse()
    }

    /// Copies one manifold into a lane, without the effective mass of friction.
    #[inline(always)]
    pub(super) fn set(&mut self, lane: usize, one: &ContactRow<f32, Vector, P>) {
        for side in 0..2 {
            self.ids[side].set(lane, one.ids[side][0]);
            self.inv_mass[side].set(lane, one.inv_mass[side]);
            self.inv_inertia[side].set(lane, one.inv_inertia[side]);
        }
        self.normal.set(lane, one.normal);
        self.offset.set(lane, one.offset);
        self.radius.set(lane, one.radius);
        self.friction.set(lane, one.friction);
        self.surface_velocity.set(lane, one.surface_velocity);
        self.center.set(lane, one.center);
        self.tangent_impulse.set(lane, one.tangent_impulse);
        self.twist.set(lane, &one.twist);
        for (point, of) in self.points.iter_mut().zip(&one.points) {
            point.mass.set(lane, of.mass);
            point.impulse.set(lane, of.impulse);
        }
    }
}

/// The dynamic body rows of a manifold.
pub(super) fn movable(one: &Struck, first_dynamic: u32) -> impl Iterator<Item = u32> + use<> {
    one.row.ids.into_iter().map(|[row]| row).filter(move |row| *row >= first_dynamic)
}

/// Whether a manifold of a group touches within the substep.
pub(super) fn is_due(group: &[Struck]) -> bool {
    group.iter().any(|one| one.is_due && !one.is_jammed)
}

/// The rebound of a point within a substep.
struct Bounce {
    restitution: f32,
    /// Approach speed that accelerations add in a substep, m/s.
    gained: f32,
    inv_h: f32,
}

impl Bounce {
    /// The speed at which a point leaves after it touches `time` seconds after the start of the substep.
    /// `approach` is the speed before the substep's accelerations, `speed` the speed after them.
    ///
    /// Symplectic Euler conserves E = ½ v² + g y − ½ g h v of a free fall exactly (v upward). The speed w
    /// makes E after the substep, at y = w (h − t), e² times the E before. The rebound height is e² of the
    /// fall height at any step length, and no energy is gained.
    fn parting(&self, time: f32, approach: f32, speed: f32) -> f32 {
        // g h and g t.
        let (gh, gt) = (self.gained, self.gained * self.inv_h * time);
        let kept = 0.5 * approach * approach + speed * gt + 0.5 * gh * approach;
        let b = 0.5 * gh - gt;
        (b * b + 2.0 * self.restitution * self.restitution * max(kept, 0.0)).sqrt() - b
    }
}
