//! Coordinates of a joint that are solved one by one: limits, motors and distances.

use super::super::SubstepParams;
use super::super::pair::Pair;
use super::block::{Block, Locked, Softening, Solved};
use super::def::Drive;
use super::dim::{ANGLES, TURNING};
use super::place::{Gradient, Place, Response};
use crate::math::{Angular, DIM, Lane};
use crate::tuning::solver::NO_MASS;

/// Motors or springs, one per lane.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct MotorRow<N> {
    /// Stiffness and damping, per effective mass.
    pub(super) of_mass: [N; 2],
    /// Additional stiffness and damping, N/m and N·s/m, or for angles N·m/rad and N·m·s/rad.
    pub(super) besides: [N; 2],
    pub(super) target_velocity: N,
    pub(super) target_position: N,
    /// Maximum impulse of a substep, N·s or N·m·s. 0 without a motor.
    pub(super) most: N,
    pub(super) impulse: N,
}

impl<N: Lane> MotorRow<N> {
    const NONE: Self = Self {
        of_mass: [N::ZERO; 2],
        besides: [N::ZERO; 2],
        target_velocity: N::ZERO,
        target_position: N::ZERO,
        most: N::ZERO,
        impulse: N::ZERO,
    };

    /// Solves the motor at a rate and value of the coordinate. `k` is the rate added by a unit impulse, and
    /// `mass` is 1/`k` for the case without a spring. Returns the change of the impulse, and the share of
    /// another impulse that the motor would absorb.
    #[inline(always)]
    fn drive(&mut self, (rate, value): (N, N), (k, mass): (N, N), h: f32) -> (N, N) {
        let stiffness = self.of_mass[0] * mass + self.besides[0];
        let damping = self.of_mass[1] * mass + self.besides[1];
        let resistance = damping + stiffness * N::splat(h);
        let drives = N::and(N::ZERO.lt(resistance), N::ZERO.lt(k));
        let safe = N::select(drives, resistance, N::ONE);
        let softness = N::ONE / (safe * N::splat(h));
        let bias = (stiffness * (value - self.target_position) - damping * self.target_velocity) / safe;
        let before = self.impulse;
        let after = before - (rate + bias + softness * before) / (k + softness);
        self.impulse = N::select(drives, after, N::ZERO).max(-self.most).min(self.most);
        (self.impulse - before, N::select(drives, k / (k + softness), N::ZERO))
    }
}

/// Single coordinates, one per lane.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Single<N> {
    /// Weights of the shifts, of the distance and of the angles: one of them is 1.
    pub(super) along: [N; DIM],
    pub(super) apart: N,
    pub(super) about: [N; ANGLES],
    /// Minimum and maximum value.
    pub(super) limits: [N; 2],
    pub(super) softening: Softening<N>,
    /// Impulses of the lower and the upper limit, N·s or N·m·s. Never negative, unless both limits are
    /// equal.
    pub(super) impulses: [N; 2],
    pub(super) spring: MotorRow<N>,
    pub(super) motor: MotorRow<N>,
    /// Whole turns added to the angle: a multiple of 2π.
    pub(super) turns: N,
    /// The last value of an angle that counts turns; for other angles, the value that the angle must be
    /// close to.
    pub(super) near: N,
    /// 1 if the angle counts whole turns, otherwise 0.
    pub(super) counts_turns: N,
    /// 1 if the block may lock a component coordinate of this coordinate, otherwise 0.
    pub(super) may_contradict: N,
}

impl<N: Lane> Single<N> {
    /// No coordinate.
    pub(super) const NONE: Self = Self {
        along: [N::ZERO; DIM],
        apart: N::ZERO,
        about: [N::ZERO; ANGLES],
        limits: [N::ZERO; 2],
        softening: Softening::NONE,
        impulses: [N::ZERO; 2],
        spring: MotorRow::NONE,
        motor: MotorRow::NONE,
        turns: N::ZERO,
        near: N::ZERO,
        counts_turns: N::ZERO,
        may_contradict: N::ZERO,
    };

    /// The gradient and value of the coordinate, given the angles at `place`.
    #[inline(always)]
    pub(super) fn gradient(
        &mut self,
        place: &Place<N>,
        angles: &[(N, Angular<N>); ANGLES],
    ) -> (Gradient<N>, N) {
        let axes = place.axes(N::ONE.lt(N::ZERO));
        let (distance, direction) = place.apart();
        let (mut normal, mut value) = (direction * self.apart, distance * self.apart);
        for k in 0..DIM {
            normal += axes[k] * self.along[k];
            value += axes[k].dot(place.between) * self.along[k];
        }
        let mut turn = Angular::ZERO;
        for i in 0..ANGLES {
            let ((mut angle, axis), weight) = (angles[i], self.about[i]);
            if i == TURNING {
                angle += self.count(angle, weight);
            }
            turn += axis * weight;
            value += angle * weight;
        }
        (place.gradient(normal, turn), value)
    }

    /// The multiple of 2π that brings an angle closest to `near`.
    #[inline(always)]
    fn count(&mut self, angle: N, weight: N) -> N {
        let full = N::splat(core::f32::consts::TAU);
        let (half, off) = (N::splat(core::f32::consts::PI), angle + self.turns - self.near);
        let turns = N::select(half.lt(off), self.turns - full, self.turns);
        self.turns = N::select(off.lt(-half), turns + full, turns) * weight;
        let now = angle + self.turns;
        self.near = N::select(N::ZERO.lt(self.counts_turns), now, self.near);
        self.turns
    }

    /// Solves spring, motor and limits, and changes the impulses of the block so that it stays solved. With
    /// bias, or without bias as in the relax pass, where motors and springs are left out.
    #[inline(always)]
    pub(super) fn solve<const D: usize>(
        &mut self,
        (gradient, value): (&Gradient<N>, N),
        alone: Response<N>,
        (block, solved, rows): (&Block<N, D>, &Solved<N, D>, &mut [Locked<N>]),
        pair: &mut Pair<N>,
        params: &SubstepParams,
        biased: bool,
    ) {
        let (response, kept) = block.beside(solved, alone);
        let change = self.act((gradient, value), (&response, &alone), pair, params, biased);
        for k in 0..D {
            rows[k].impulse -= kept[k] * change;
        }
    }

    /// Solves spring, motor and limits. `response` is the response to a unit impulse, `alone` the response
    /// without other joints. Returns the change of the impulse.
    ///
    /// If the block may lock a component of the coordinate, impulses are computed with the mass without the
    /// block. To shorten a distance perpendicular to a locked shift, the body would otherwise have to move
    /// along the other axis without bound.
    #[inline(always)]
    fn act(
        &mut self,
        (gradient, value): (&Gradient<N>, N),
        (response, alone): (&Response<N>, &Response<N>),
        pair: &mut Pair<N>,
        params: &SubstepParams,
        biased: bool,
    ) -> N {
        let (k, own) = (response.along(gradient), alone.along(gradient));
        // A single row cannot move a coordinate that the block already locks.
        let moves = (own * N::splat(NO_MASS)).lt(k);
        let k = N::select(moves, k + (own - k) * self.may_contradict, N::ZERO);
        let before = self.impulse();
        let mass = N::select(moves, N::ONE / N::select(moves, k, N::ONE), N::ZERO);
        if biased {
            self.drive(gradient, response, (value, k, mass), pair, params.h);
        }
        let both = self.limits[0].eq(self.limits[1]);
        for side in 0..2 {
            let sign = if side == 0 { N::ONE } else { -N::ONE };
            let gap = (value - self.limits[side]) * sign;
            let before = self.impulses[side];
            let at = (gap, gradient.rate(pair) * sign, k);
            let after = self.softening.limit(side, both, at, before, params, biased);
            let after = N::select(moves, after, N::ZERO);
            self.impulses[side] = after;
            response.push(pair, (after - before) * sign);
        }
        self.impulse() - before
    }

    /// Solves the spring, then the motor. The motor's impulse changes the spring's impulse as well.
    #[inline(always)]
    fn drive(
        &mut self,
        gradient: &Gradient<N>,
        response: &Response<N>,
        (value, k, mass): (N, N, N),
        pair: &mut Pair<N>,
        h: f32,
    ) {
        let (change, taken) = self.spring.drive((gradient.rate(pair), value), (k, mass), h);
        response.push(pair, change);
        let left = N::ONE - taken;
        let (change, _) = self.motor.drive((gradient.rate(pair), value), (k * left, mass), h);
        response.push(pair, change * left);
        self.spring.impulse -= change * taken;
    }

    /// The total impulse along the coordinate.
    #[inline(always)]
    pub(super) fn impulse(&self) -> N {
        self.impulses[0] - self.impulses[1] + self.spring.impulse + self.motor.impulse
    }
}

/// Stiffness and damping of a law per effective mass, and in absolute units.
pub(super) fn laws(drive: &Drive) -> ([f32; 2], [f32; 2]) {
    match *drive {
        Drive::Spring(spring) => {
            let omega = core::f32::consts::TAU * spring.frequency;
            ([omega * omega, 2.0 * spring.damping_ratio * omega], [0.0; 2])
        }
        Drive::Acceleration { stiffness, damping } => ([stiffness, damping], [0.0; 2]),
        Drive::Force { stiffness, damping } => ([0.0; 2], [stiffness, damping]),
    }
}

/// The multiple of 2π that brings an angle closest to another.
pub(super) fn turns_near(angle: f32, near: f32) -> f32 {
    let full = core::f32::consts::TAU;
    let turns = ((near - angle) / full).round();
    if turns.is_finite() { turns * full } else { 0.0 }
}
