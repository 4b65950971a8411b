//! Limits, springs and motors along a coordinate of a tree of joints: one row of its link.
//!
//! Acting in parallel, each law wants the impulse −G (v + b), with the rate v of the coordinate, a bias b
//! and a conductance G. Their sum is the impulse −ΣG (v + ΣG b / ΣG), which is a row with the softness 1 /
//! ΣG.
//!
//! Pivoting determines the active limits and the motors at their maximum: a limit that would pull is
//! deactivated, a limit that would be passed is activated, and the tree is solved again.

use super::super::SubstepParams;
use super::single::{MotorRow, Single};
use super::tree_scratch::Coordinate;
use crate::math::Lane;
use crate::tuning::solver::NO_MASS;

/// Indices of the laws along a coordinate.
const LIMIT: usize = 0;
const SPRING: usize = 1;
const MOTOR: usize = 2;

/// 1 where the mask is set, otherwise 0.
#[inline(always)]
pub(super) fn number<N: Lane>(mask: N::Mask) -> N {
    N::select(mask, N::ONE, N::ZERO)
}

/// Lanes in which a number is positive.
#[inline(always)]
pub(super) fn is<N: Lane>(number: N) -> N::Mask {
    N::ZERO.lt(number)
}

/// Lanes of the first mask that are not in the second one.
#[inline(always)]
fn without<N: Lane>(mask: N::Mask, but: N::Mask) -> N::Mask {
    N::and(mask, N::select(but, N::ZERO, N::ONE).eq(N::ONE))
}

/// Adds in the lanes of a mask.
#[inline(always)]
fn add_where<N: Lane>(to: &mut N, mask: N::Mask, change: N) {
    *to = N::select(mask, *to + change, *to);
}

/// The law of a limit, spring or motor.
#[derive(Clone, Copy, Debug)]
struct Law<N> {
    /// G. 0 if the law is inactive.
    conductance: N,
    bias: N,
}

impl<N: Lane> Law<N> {
    const NONE: Self = Self { conductance: N::ZERO, bias: N::ZERO };

    #[inline(always)]
    fn acts(&self) -> N::Mask {
        is(self.conductance)
    }

    /// The law, active only in the lanes of a mask.
    #[inline(always)]
    fn only(self, mask: N::Mask) -> Self {
        Self { conductance: N::select(mask, self.conductance, N::ZERO), bias: self.bias }
    }

    /// The impulse of the law at a rate of the coordinate.
    #[inline(always)]
    fn asks(&self, rate: N) -> N {
        -self.conductance * (rate + self.bias)
    }
}

impl<N: Lane> MotorRow<N> {
    /// The law in a substep. Coefficients per mass refer to the mass that the coordinate moves in the tree.
    #[inline(always)]
    fn law(&self, at: &Coordinate<N>, h: f32) -> Law<N> {
        let h = N::splat(h);
        let moves = is(at.left);
        let left = N::select(moves, at.left, N::ONE);
        let mut of_law = self.besides;
        for i in 0..2 {
            let is_of_mass = N::and(is(self.of_mass[i]), moves);
            of_law[i] = N::select(is_of_mass, self.of_mass[i] / left + self.besides[i], self.besides[i]);
        }
        let [stiffness, damping] = of_law;
        let resistance = damping + h * stiffness;
        let acts = N::and(is(self.most), is(resistance));
        let off = at.value - self.target_position;
        let bias = (stiffness * off - damping * self.target_velocity) / N::select(acts, resistance, N::ONE);
        Law { conductance: N::select(acts, h * resistance, N::ZERO), bias }
    }

    /// Lanes in which the law is per mass.
    #[inline(always)]
    fn is_per_mass(&self) -> N::Mask {
        N::and(is(self.most), N::or(is(self.of_mass[0]), is(self.of_mass[1])))
    }
}

impl<N: Lane> Single<N> {
    /// Lanes in which both limits are equal, so that the limit acts in both directions.
    #[inline(always)]
    fn is_locked(&self) -> N::Mask {
        self.limits[0].eq(self.limits[1])
    }

    /// The limit with an impulse, as 1 for the lower or the upper one.
    #[inline(always)]
    pub(super) fn held(&self) -> [N; 2] {
        let lower = N::or(self.is_locked(), is(self.impulses[0]));
        [number(lower), number(without::<N>(is(self.impulses[1]), lower))]
    }

    /// 1 in lanes whose motor is at its maximum.
    #[inline(always)]
    pub(super) fn is_capped(&self) -> N {
        let MotorRow { impulse, most, .. } = self.motor;
        number(N::and(is(most), most.le(impulse.max(-impulse))))
    }

    /// Whether its laws depend on the mass that the coordinate moves.
    #[inline(always)]
    pub(super) fn is_per_mass(&self) -> bool {
        N::any(N::or(self.spring.is_per_mass(), self.motor.is_per_mass()))
    }

    /// Whether it has an active law that is warm-started.
    #[inline(always)]
    pub(super) fn is_warm(&self) -> bool {
        N::any(is(self.spring.most + self.motor.most + self.softening.is_spring))
    }

    /// The law of one limit in a pass; inactive if the limit takes no part.
    #[inline(always)]
    fn limit_law(&self, side: usize, at: &Coordinate<N>, params: &SubstepParams, biased: bool) -> Law<N> {
        let softening = &self.softening;
        let past = at.value - self.limits[side];
        let is_past = if side == 0 { is(past) } else { past.lt(N::ZERO) };
        let is_open = without::<N>(is_past, self.is_locked());
        let bias_rate = N::select(is_open, N::splat(params.inv_h), softening.bias_rate);
        let bias = bias_rate * past;
        let bias = if biased { bias } else { N::select(is_open, bias, N::ZERO) };
        let gives = if biased { at.alone * softening.share + softening.more } else { N::ZERO };
        let gives = N::select(is_open, N::ZERO, gives).max(at.alone * N::splat(NO_MASS));
        let mut acts = is(at.alone);
        if !biased {
            acts = without::<N>(acts, is(softening.is_spring));
        }
        let conductance = N::select(acts, N::ONE / N::select(acts, gives, N::ONE), N::ZERO);
        Law { conductance, bias }
    }

    /// The laws of limit, spring and motor in a pass.
    #[inline(always)]
    fn laws(&self, at: &Coordinate<N>, params: &SubstepParams, biased: bool) -> [Law<N>; 3] {
        let mut laws = [Law::NONE; 3];
        let [lower, upper] = [is(at.held[0]), is(at.held[1])];
        if N::any(N::or(lower, upper)) {
            let of_lower = self.limit_law(0, at, params, biased);
            let of_upper = self.limit_law(1, at, params, biased);
            laws[LIMIT] = Law {
                conductance: N::select(lower, of_lower.conductance, of_upper.conductance),
                bias: N::select(lower, of_lower.bias, of_upper.bias),
            }
            .only(N::or(lower, upper));
        }
        if biased {
            laws[SPRING] = self.spring.law(at, params.h);
            laws[MOTOR] = self.motor.law(at, params.h).only(at.is_capped.eq(N::ZERO));
        }
        laws
    }

    /// The softness of all active laws. Not positive if none is active.
    #[inline(always)]
    pub(super) fn softness(&self, at: &Coordinate<N>, params: &SubstepParams, biased: bool) -> N {
        let laws = self.laws(at, params, biased);
        let sum = laws[0].conductance + laws[1].conductance + laws[2].conductance;
        N::select(is(sum), N::ONE / N::select(is(sum), sum, N::ONE), N::ZERO)
    }

    /// The velocity that the row wants at the current rate.
    #[inline(always)]
    pub(super) fn wanted(&self, at: &Coordinate<N>, rate: N, params: &SubstepParams, biased: bool) -> N {
        let laws = self.laws(at, params, biased);
        let parts = self.parts();
        let (mut sum, mut asked) = (N::ZERO, N::ZERO);
        for part in 0..3 {
            let Law { conductance, bias } = laws[part];
            let more = conductance * bias + parts[part];
            sum += conductance;
            asked += N::select(is(conductance), more, N::ZERO);
        }
        let acts = is(sum);
        N::select(acts, -(rate + asked / N::select(acts, sum, N::ONE)), N::ZERO)
    }

    /// The impulses of limit, spring and motor.
    #[inline(always)]
    fn parts(&self) -> [N; 3] {
        [self.impulses[0] - self.impulses[1], self.spring.impulse, self.motor.impulse]
    }

    /// Adds to the impulse of one law in the lanes of a mask.
    #[inline(always)]
    fn add(&mut self, at: &Coordinate<N>, part: usize, mask: N::Mask, change: N) {
        match part {
            LIMIT => {
                let upper = is(at.held[1]);
                add_where(&mut self.impulses[0], without::<N>(mask, upper), change);
                add_where(&mut self.impulses[1], N::and(mask, upper), -change);
            }
            SPRING => add_where(&mut self.spring.impulse, mask, change),
            _ => add_where(&mut self.motor.impulse, mask, change),
        }
    }

    /// Distributes an impulse among the laws in the lanes of a mask, given the rate after it: each law gets
    /// its own impulse at this rate, and the stiffest law gets the rest.
    #[inline(always)]
    pub(super) fn share_out(
        &mut self,
        at: &Coordinate<N>,
        mask: N::Mask,
        (change, rate): (N, N),
        params: &SubstepParams,
        biased: bool,
    ) {
        let laws = self.laws(at, params, biased);
        let [a, b, c] = [laws[0].conductance, laws[1].conductance, laws[2].conductance];
        // The first of equally stiff laws.
        let stiffest = [N::and(b.le(a), c.le(a)), N::and(a.lt(b), c.le(b)), N::and(a.lt(c), b.lt(c))];
        let mut rest = change;
        for part in 0..3 {
            let law = &laws[part];
            let shares = N::and(without::<N>(law.acts(), stiffest[part]), mask);
            if N::any(shares) {
                let more = law.asks(rate) - self.parts()[part];
                self.add(at, part, shares, more);
                rest = N::select(shares, rest - more, rest);
            }
        }
        for part in 0..3 {
            self.add(at, part, N::and(stiffest[part], mask), rest);
        }
    }

    /// Updates the active limits and the motor for the solved rate, in the lanes of a mask. A limit that
    /// would pull is deactivated. A limit that would be passed by more than the tolerated speed is
    /// activated, if `adds` is set. A motor that exceeds its maximum is held there. Returns the lanes in
    /// which anything changed, and the impulse by which released limits and capped motors change.
    #[inline(always)]
    pub(super) fn pivot(
        &mut self,
        at: &mut Coordinate<N>,
        mask: N::Mask,
        (rate, tolerance, adds): (N, N, bool),
        params: &SubstepParams,
        biased: bool,
    ) -> (N::Mask, N) {
        let (mut changed, mut change) = (N::ONE.lt(N::ZERO), N::ZERO);
        let driven = N::and(is(self.motor.most), mask);
        if biased && N::any(driven) {
            let MotorRow { most, impulse, .. } = self.motor;
            let capped = N::and(is(at.is_capped), driven);
            let asked = self.motor.law(at, params.h).asks(rate);
            let asked = N::select(impulse.lt(N::ZERO), -asked, asked);
            let freed = if adds { N::and(capped, asked.lt(most)) } else { changed };
            let exceeds = without::<N>(N::and(driven, most.lt(impulse.max(-impulse))), capped);
            let most = N::select(impulse.lt(N::ZERO), -most, most);
            change = N::select(exceeds, most - impulse, N::ZERO);
            self.motor.impulse = N::select(exceeds, most, impulse);
            at.is_capped = N::select(freed, N::ZERO, N::select(exceeds, N::ONE, at.is_capped));
            changed = N::or(freed, exceeds);
        }
        let limited = without::<N>(mask, self.is_locked());
        let is_free = without::<N>(limited, is(at.held[0] + at.held[1]));
        for side in 0..2 {
            let pulls = N::and(is(at.held[side]), self.impulses[side].lt(N::ZERO));
            let pulls = N::and(limited, pulls);
            let given = if side == 0 { change - self.impulses[0] } else { change + self.impulses[1] };
            change = N::select(pulls, given, change);
            self.impulses[side] = N::select(pulls, N::ZERO, self.impulses[side]);
            at.held[side] = N::select(pulls, N::ZERO, at.held[side]);
            changed = N::or(changed, pulls);
        }
        if adds && N::any(is_free) {
            let (lower, upper) =
                (self.limit_law(0, at, params, biased), self.limit_law(1, at, params, biased));
            let is_passed = N::and(lower.acts(), (rate + lower.bias).lt(-tolerance));
            let lower = N::and(is_free, is_passed);
            let is_passed = N::and(upper.acts(), (-(rate + upper.bias)).lt(-tolerance));
            let upper = without::<N>(N::and(is_free, is_passed), lower);
            at.held[0] = N::select(lower, N::ONE, at.held[0]);
            at.held[1] = N::select(upper, N::ONE, at.held[1]);
            changed = N::or(changed, N::or(lower, upper));
        }
        (changed, change)
    }
}
