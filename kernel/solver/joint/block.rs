//! The coordinates of a joint locked in A's frame, solved as one block.

use super::super::SubstepParams;
use super::super::pair::Pair;
use super::dim::{ANGLE_AXES, ANGLES};
use super::place::{Gradient, Masses, Place, Response};
use crate::math::{Angular, DIM, Lane, Vector};
use crate::tuning::solver::NO_MASS;

/// Softness of a locked coordinate.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Softening<N> {
    /// Bias velocity per metre or radian of error, 1/s.
    pub(super) bias_rate: N,
    /// Softness added to the inverse effective mass: `share` times it, and `more` in 1/kg or 1/(kg m²).
    pub(super) share: N,
    pub(super) more: N,
    /// 1 for a spring, whose implicit step is complete before the relax pass; otherwise 0.
    pub(super) is_spring: N,
}

impl<N: Lane> Softening<N> {
    pub(super) const NONE: Self =
        Self { bias_rate: N::ZERO, share: N::ZERO, more: N::ZERO, is_spring: N::ZERO };

    /// The new impulse of the lower limit (side 0) or the upper one. `gap` is the value's distance above
    /// the limit, `rate` its rate, and `k` the rate added by a unit impulse. In the lanes of `both`, where
    /// both limits are equal, the lower limit acts both ways.
    #[inline(always)]
    pub(super) fn limit(
        &self,
        side: usize,
        both: N::Mask,
        (gap, rate, k): (N, N, N),
        before: N,
        params: &SubstepParams,
        biased: bool,
    ) -> N {
        let is_open = N::ZERO.lt(N::select(both, N::ZERO, gap));
        let softness = if biased { k * self.share + self.more } else { N::ZERO };
        let softness = N::select(is_open, N::ZERO, softness);
        let bias = if biased { self.bias_rate * gap } else { N::ZERO };
        let bias = N::select(is_open, gap * N::splat(params.inv_h), bias);
        let stiff = k + softness;
        let gives = N::ZERO.lt(stiff);
        let inverse = N::select(gives, N::ONE / N::select(gives, stiff, N::ONE), N::ZERO);
        let after = before - (rate + bias + softness * before) * inverse;
        let after = if side == 0 {
            N::select(both, after, after.max(N::ZERO))
        } else {
            N::select(both, N::ZERO, after.max(N::ZERO))
        };
        if biased { after } else { N::select(N::ZERO.lt(self.is_spring), before, after) }
    }
}

/// A coordinate of the block.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(super) struct Locked<N> {
    /// 1 if the coordinate is locked, otherwise 0.
    pub(super) is_locked: N,
    /// The value at which it is locked, m or rad.
    pub(super) target: N,
    pub(super) softening: Softening<N>,
    /// Accumulated impulse, N·s or N·m·s.
    pub(super) impulse: N,
}

impl<N: Lane> Locked<N> {
    pub(super) const FREE: Self =
        Self { is_locked: N::ZERO, target: N::ZERO, softening: Softening::NONE, impulse: N::ZERO };
}

/// The first `D` coordinates in a pass.
pub(super) struct Block<N, const D: usize> {
    pub(super) gradients: [Gradient<N>; D],
    pub(super) values: [N; D],
    pub(super) responses: [Response<N>; D],
}

/// The gradients and values of the first `D` coordinates. `angles` is only used if some of them are angles.
#[inline(always)]
pub(super) fn coordinates<N: Lane, const D: usize>(
    place: &Place<N>,
    of_world: N::Mask,
    angles: &[(N, Angular<N>); ANGLES],
) -> ([Gradient<N>; D], [N; D]) {
    let axes = place.axes(of_world);
    let mut values = [N::ZERO; D];
    let mut gradients = [Gradient::NONE; D];
    for k in 0..DIM.min(D) {
        values[k] = axes[k].dot(place.between);
        gradients[k] = place.gradient(axes[k], Angular::ZERO);
    }
    for i in 0..ANGLES {
        let (value, axis) = angles[i];
        if ANGLE_AXES[i] < D {
            values[ANGLE_AXES[i]] = value;
            gradients[ANGLE_AXES[i]] = Gradient { normal: Vector::ZERO, moments: [axis; 2] };
        }
    }
    (gradients, values)
}

/// The factored matrix of a block.
pub(super) struct Solved<N, const D: usize> {
    takes_part: [N; D],
    factors: Factors<N, D>,
}

impl<N: Lane, const D: usize> Block<N, D> {
    #[inline(always)]
    pub(super) fn new(place: &Place<N>, of_world: N::Mask, masses: &Masses<N>) -> Self {
        let angles = if D > DIM { place.angles() } else { Place::NO_ANGLES };
        let (gradients, values) = coordinates::<N, D>(place, of_world, &angles);
        let mut responses = [Response::NONE; D];
        for k in 0..D {
            responses[k] = masses.response(&gradients[k]);
        }
        Self { gradients, values, responses }
    }

    /// Applies the impulses of the rows.
    #[inline(always)]
    pub(super) fn push(&self, rows: &[Locked<N>], pair: &mut Pair<N>) {
        for (response, row) in self.responses.iter().zip(rows) {
            response.push(pair, row.impulse);
        }
    }

    /// Solves the coordinates, with bias, or without bias as in the relax pass, where springs are left out.
    #[inline(always)]
    pub(super) fn solve(
        &self,
        rows: &mut [Locked<N>],
        pair: &mut Pair<N>,
        drift: Vector<N>,
        biased: bool,
    ) -> Solved<N, D> {
        let mut k = [[N::ZERO; D]; D];
        let mut wanted = [N::ZERO; D];
        let mut takes_part = [N::ZERO; D];
        for i in 0..D {
            let row = &rows[i];
            let soft = &row.softening;
            takes_part[i] = if biased { row.is_locked } else { row.is_locked * (N::ONE - soft.is_spring) };
            let own = self.responses[i].along(&self.gradients[i]);
            let mut rate = self.gradients[i].rate(pair);
            let mut diagonal = own;
            if biased {
                let error = self.values[i] - row.target;
                let error = if i < DIM { error } else { wrapped(error) };
                let softness = own * soft.share + soft.more;
                diagonal = own + softness;
                rate += soft.bias_rate * error + softness * row.impulse;
                rate += drift.dot(self.gradients[i].normal);
            }
            wanted[i] = -(rate * takes_part[i]);
            // A free coordinate takes part as an uncoupled unit row.
            k[i][i] = N::select(N::ZERO.lt(takes_part[i]), diagonal, N::ONE);
            for j in 0..i {
                k[i][j] = self.responses[i].along(&self.gradients[j]) * (takes_part[i] * takes_part[j]);
            }
        }
        let factors = Factors::of(k);
        let impulses = factors.solve(wanted);
        for i in 0..D {
            rows[i].impulse += impulses[i];
            self.responses[i].push(pair, impulses[i]);
        }
        Solved { takes_part, factors }
    }

    /// Projects a response so that it leaves the block solved. Also returns the impulses of the block per
    /// unit impulse of the response.
    #[inline(always)]
    pub(super) fn beside(&self, solved: &Solved<N, D>, mut response: Response<N>) -> (Response<N>, [N; D]) {
        let mut shared = [N::ZERO; D];
        for i in 0..D {
            shared[i] = response.along(&self.gradients[i]) * solved.takes_part[i];
        }
        let kept = solved.factors.solve(shared);
        for i in 0..D {
            response.add(&self.responses[i], -kept[i]);
        }
        (response, kept)
    }
}

/// Wraps an angle within one turn of 0 to −π … π.
#[inline(always)]
pub(super) fn wrapped<N: Lane>(angle: N) -> N {
    let (half, turn) = (N::splat(core::f32::consts::PI), N::splat(core::f32::consts::TAU));
    let angle = N::select(half.lt(angle), angle - turn, angle);
    N::select(angle.lt(-half), angle + turn, angle)
}

/// Factors of K = L D Lᵀ.
pub(super) struct Factors<N, const D: usize> {
    lower: [[N; D]; D],
    inverse: [N; D],
}

impl<N: Lane, const D: usize> Factors<N, D> {
    /// Factors a symmetric positive semidefinite K, given its lower half. Rows that depend on earlier rows,
    /// and rows that no impulse moves, are left out.
    #[inline(always)]
    pub(super) fn of(k: [[N; D]; D]) -> Self {
        let (mut lower, mut inverse) = (k, [N::ZERO; D]);
        for j in 0..D {
            let mut pivot = k[j][j];
            for m in 0..j {
                // `lower[j][m]` is still multiplied by D[m] here.
                let scaled = lower[j][m] * inverse[m];
                pivot -= scaled * lower[j][m];
                lower[j][m] = scaled;
            }
            let counts = (k[j][j] * N::splat(NO_MASS)).lt(pivot);
            inverse[j] = N::select(counts, N::ONE / N::select(counts, pivot, N::ONE), N::ZERO);
            for i in j + 1..D {
                for m in 0..j {
                    lower[i][j] -= lower[i][m] * lower[j][m];
                }
            }
        }
        Self { lower, inverse }
    }

    /// Solves K x = b.
    #[inline(always)]
    pub(super) fn solve(&self, b: [N; D]) -> [N; D] {
        let mut x = b;
        for i in 0..D {
            for m in 0..i {
                x[i] -= self.lower[i][m] * x[m];
            }
        }
        for i in 0..D {
            x[i] = x[i] * self.inverse[i];
        }
        for i in (0..D).rev() {
            for m in i + 1..D {
                x[i] -= self.lower[m][i] * x[m];
            }
        }
        x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn factors_solve_what_is_positive_definite(
            m in prop::array::uniform6(prop::array::uniform6(-1.0f32..1.0)),
            b in prop::array::uniform6(-10.0f32..10.0),
        ) {
            let k: [[f32; 6]; 6] = core::array::from_fn(|i| core::array::from_fn(|j| {
                let dot: f32 = (0..6).map(|n| m[i][n] * m[j][n]).sum();
                dot + if i == j { 0.5 } else { 0.0 }
            }));
            let x = Factors::of(k).solve(b);
            for i in 0..6 {
                let sum: f32 = (0..6).map(|j| k[i][j] * x[j]).sum();
                prop_assert!((sum - b[i]).abs() < 1.0e-3, "row {i}: {sum} for {}", b[i]);
            }
        }
    }

    #[test]
    fn rows_that_nothing_moves_are_left_out() {
        let k = [[2.0f32, 0.0, 0.0], [0.0, 0.0, 0.0], [2.0, 0.0, 2.0]];
        let x = Factors::of(k).solve([4.0, 1.0, 4.0]);
        assert_eq!(x, [2.0, 0.0, 0.0]);
    }
}
