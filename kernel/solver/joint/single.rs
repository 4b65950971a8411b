//! Coordinates of a joint that are solved one by one: limits, motors, distances.

use super::super::SubstepParams;
use super::super::pair::Pair;
use super::block::{Block, Locked, NO_PIVOT, Softening, Solved};
use super::dim::{ANGLES, TURNING};
use super::place::{Gradient, Place, Response};
use crate::math::{Angular, DIM, Lane};

/// A motor of `N::WIDTH` lanes.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct MotorRow<N> {
    /// Stiffness and damping, times the effective mass.
    pub(super) of_mass: [N; 2],
    /// Stiffness and damping besides, in N/m and N·s/m, or of angles.
    pub(super) besides: [N; 2],
    pub(super) target_velocity: N,
    pub(super) target_position: N,
    /// Greatest impulse of a substep, N·s or N·m·s. 0 without a motor.
    pub(super) most: N,
    pub(super) impulse: N,
}

/// One coordinate of `N::WIDTH` lanes.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Single<N> {
    /// Weights of the coordinates of the frame, of the distance and of the angles: one of them is 1.
    pub(super) along: [N; DIM],
    pub(super) apart: N,
    pub(super) about: [N; ANGLES],
    /// Least and greatest value.
    pub(super) limits: [N; 2],
    pub(super) softening: Softening<N>,
    /// Impulses of the lower and the upper limit, N·s or N·m·s. Not negative, but where both limits are one.
    pub(super) impulses: [N; 2],
    pub(super) motor: MotorRow<N>,
    /// What is added to the angle for the turns that it has made: a multiple of 2π.
    pub(super) turns: N,
    /// Where the angle last was if it counts turns, else the value that it is to be near.
    pub(super) near: N,
    /// 1 if the angle counts turns, else 0.
    pub(super) counts_turns: N,
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
        motor: MotorRow {
            of_mass: [N::ZERO; 2],
            besides: [N::ZERO; 2],
            target_velocity: N::ZERO,
            target_position: N::ZERO,
            most: N::ZERO,
            impulse: N::ZERO,
        },
        turns: N::ZERO,
        near: N::ZERO,
        counts_turns: N::ZERO,
    };

    /// The gradient of the coordinate, and its value.
    #[inline(always)]
    pub(super) fn gradient(&mut self, place: &Place<N>) -> (Gradient<N>, N) {
        let axes = place.axes(N::ONE.lt(N::ZERO));
        let (distance, direction) = place.apart();
        let (mut normal, mut value) = (direction * self.apart, distance * self.apart);
        for (axis, weight) in axes.into_iter().zip(self.along) {
            normal += axis * weight;
            value += axis.dot(place.between) * weight;
        }
        let mut turn = Angular::ZERO;
        for (number, ((angle, axis), weight)) in place.angles().into_iter().zip(self.about).enumerate() {
            turn += axis * weight;
            let angle = if number == TURNING { angle + self.count(angle, weight) } else { angle };
            value += angle * weight;
        }
        (place.gradient(normal, turn), value)
    }

    /// The multiple of 2π that brings an angle nearest to where it is to be.
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

    /// Solves motor and limits, and changes the impulses of the block so that it stays solved. With bias, or without it as in
    /// the relax pass, where motors and springs are left out.
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
        for (row, share) in rows.iter_mut().zip(kept) {
            row.impulse -= share * change;
        }
    }

    /// Solves motor and limits by the response to a unit impulse, given the one without other joints. Returns the change of the
    /// impulse.
    #[inline(always)]
    pub(super) fn act(
        &mut self,
        (gradient, value): (&Gradient<N>, N),
        (response, alone): (&Response<N>, &Response<N>),
        pair: &mut Pair<N>,
        params: &SubstepParams,
        biased: bool,
    ) -> N {
        let k = response.along(gradient);
        // What the block holds already, a single row cannot move.
        let moves = (alone.along(gradient) * N::splat(NO_PIVOT)).lt(k);
        let k = N::select(moves, k, N::ZERO);
        let before = self.impulse();
        let mass = N::select(moves, N::ONE / N::select(moves, k, N::ONE), N::ZERO);
        if biased {
            self.drive(gradient, response, (value, k, mass), pair, params.h);
        }
        let both = self.limits[0].eq(self.limits[1]);
        for side in 0..2 {
            let sign = if side == 0 { N::ONE } else { -N::ONE };
            let gap = (value - self.limits[side]) * sign;
            let soft = &self.softening;
            let is_open = N::ZERO.lt(N::select(both, N::ZERO, gap));
            let softness = if biased { k * soft.share + soft.more } else { N::ZERO };
            let softness = N::select(is_open, N::ZERO, softness);
            let bias = if biased { soft.bias_rate * gap } else { N::ZERO };
            let bias = N::select(is_open, gap * N::splat(params.inv_h), bias);
            let rate = gradient.rate(pair) * sign;
            let stiff = k + softness;
            let gives = N::ZERO.lt(stiff);
            let inverse = N::select(gives, N::ONE / N::select(gives, stiff, N::ONE), N::ZERO);
            let before = self.impulses[side];
            let after = before - (rate + bias + softness * before) * inverse;
            // One row holds a coordinate whose limits are one, both ways.
            let after = if side == 0 {
                N::select(both, after, after.max(N::ZERO))
            } else {
                N::select(both, N::ZERO, after.max(N::ZERO))
            };
            let after = if biased { after } else { N::select(N::ZERO.lt(soft.is_spring), before, after) };
            let after = N::select(moves, after, N::ZERO);
            self.impulses[side] = after;
            response.push(pair, (after - before) * sign);
        }
        self.impulse() - before
    }

    #[inline(always)]
    fn drive(
        &mut self,
        gradient: &Gradient<N>,
        response: &Response<N>,
        (value, k, mass): (N, N, N),
        pair: &mut Pair<N>,
        h: f32,
    ) {
        let motor = &mut self.motor;
        let [stiffness, damping] = core::array::from_fn(|i| motor.of_mass[i] * mass + motor.besides[i]);
        let resistance = damping + stiffness * N::splat(h);
        let drives = N::and(N::ZERO.lt(resistance), N::ZERO.lt(k));
        let safe = N::select(drives, resistance, N::ONE);
        let softness = N::ONE / (safe * N::splat(h));
        let bias = (stiffness * (value - motor.target_position) - damping * motor.target_velocity) / safe;
        let change = (gradient.rate(pair) + bias + softness * motor.impulse) / (k + softness);
        let after = N::select(drives, motor.impulse - change, N::ZERO);
        let after = after.max(-motor.most).min(motor.most);
        response.push(pair, after - motor.impulse);
        motor.impulse = after;
    }

    /// The impulse along the coordinate.
    #[inline(always)]
    pub(super) fn impulse(&self) -> N {
        self.impulses[0] - self.impulses[1] + self.motor.impulse
    }
}

impl Single<f32> {
    /// Whether a pass would change anything, at a rate of the coordinate: there is a motor, an impulse, or a limit ahead.
    pub(super) fn may_act(&self, value: f32, rate: f32, h: f32) -> bool {
        let [min, max] = self.limits;
        let ahead = value + rate * h;
        let is_between = |x: f32| min < x && x < max;
        self.motor.most > 0.0 || self.impulses != [0.0; 2] || !(is_between(value) && is_between(ahead))
    }
}

/// The turns, a multiple of 2π, that bring an angle nearest to another.
pub(super) fn turns_near(angle: f32, near: f32) -> f32 {
    let full = core::f32::consts::TAU;
    let turns = ((near - angle) / full).round();
    if turns.is_finite() { turns * full } else { 0.0 }
}
