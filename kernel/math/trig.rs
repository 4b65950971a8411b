//! The kernel's own sine, cosine and arc tangent, in `f64`: the same bits on every machine, which libm does
//! not guarantee. Taylor series after range reduction, accurate to about one unit in the last place of `f64`.
//! Rounded to `f32`, results are the nearest `f32` except for rare ties.

use super::Lane;

/// π/2 in three parts. The first two have 33 bits, so `k` times them is exact for `k < 2^20`.
const HALF_PI: [f64; 3] = [1.5707963267341256, 6.077100506303966e-11, 2.0222662487959506e-21];
/// Larger arguments are first reduced to one turn by the (exact) remainder.
const LARGE: f64 = 1.0e6;
/// (−1)^n / (2n+1)! from n = 1.
const SIN: [f64; 9] = [
    -0.16666666666666666,
    0.008333333333333333,
    -0.0001984126984126984,
    2.7557319223985893e-06,
    -2.505210838544172e-08,
    1.6059043836821613e-10,
    -7.647163731819816e-13,
    2.8114572543455206e-15,
    -8.22063524662433e-18,
];
/// (−1)^n / (2n)! from n = 2.
const COS: [f64; 8] = [
    0.041666666666666664,
    -0.001388888888888889,
    2.48015873015873e-05,
    -2.755731922398589e-07,
    2.08767569878681e-09,
    -1.1470745597729725e-11,
    4.779477332387385e-14,
    -1.5619206968586225e-16,
];
/// atan(i / 8).
const ATAN_EIGHTHS: [f64; 9] = [
    0.0,
    0.12435499454676144,
    0.24497866312686414,
    0.35877067027057225,
    0.4636476090008061,
    0.5585993153435624,
    0.6435011087932844,
    0.7188299996216245,
    core::f64::consts::FRAC_PI_4,
];

/// tan π/8.
const TAN_EIGHTH: f32 = 0.414_213_56;
/// Coefficients of (atan z − z) / z³ in z².
const ATAN: [f32; 4] = [-0.333_329_5, 0.199_777_1, -0.138_776_86, 0.080_537_446];

/// The sine and cosine of an angle in radians; NaN for an infinite or NaN angle.
pub fn sin_cos(angle: f64) -> (f64, f64) {
    if !angle.is_finite() {
        return (f64::NAN, f64::NAN);
    }
    let angle = if angle.abs() > LARGE { angle % core::f64::consts::TAU } else { angle };
    let turns = (angle * core::f64::consts::FRAC_2_PI).round();
    let x = angle - turns * HALF_PI[0] - turns * HALF_PI[1] - turns * HALF_PI[2];
    let square = x * x;
    let sin = x + x * square * horner(&SIN, square);
    let cos = 1.0 - 0.5 * square + square * square * horner(&COS, square);
    match (turns as i64).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The sine of an angle in radians.
pub fn sin(angle: f64) -> f64 {
    sin_cos(angle).0
}

/// The cosine of an angle in radians.
pub fn cos(angle: f64) -> f64 {
    sin_cos(angle).1
}

/// The angle of the point `(x, y)` in radians, in −π … π; 0 for the origin, NaN for a NaN.
pub fn atan2(y: f64, x: f64) -> f64 {
    use core::f64::consts::{FRAC_PI_2, PI};
    if x.is_nan() || y.is_nan() {
        return f64::NAN;
    }
    let (ax, ay) = (x.abs(), y.abs());
    let steep = ay > ax;
    let (small, large) = if steep { (ax, ay) } else { (ay, ax) };
    let ratio = match (large == 0.0, large.is_infinite(), small.is_infinite()) {
        (true, ..) => 0.0,
        (_, true, true) => 1.0,
        (_, true, false) => 0.0,
        _ => small / large,
    };
    let first = atan_unit(ratio);
    let first = if steep { FRAC_PI_2 - first } else { first };
    let half = if x.is_sign_negative() { PI - first } else { first };
    if y.is_sign_negative() { -half } else { half }
}

/// The angle of the point `(x, y)` in radians, in −π … π, to within 1e-6; 0 for the origin.
///
/// The polynomial is from Cephes' `atanf`, for ratios up to tan π/8; larger ratios are turned back by π/4.
#[inline(always)]
pub fn atan2_lanes<N: Lane>(y: N, x: N) -> N {
    use core::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    let (ax, ay) = (x.max(-x), y.max(-y));
    let (small, large) = (ax.min(ay), ax.max(ay));
    let ratio = small / N::select(N::ZERO.lt(large), large, N::ONE);
    let is_wide = N::splat(TAN_EIGHTH).lt(ratio);
    let turned = (ratio - N::ONE) / (ratio + N::ONE);
    let z = N::select(is_wide, turned, ratio);
    let s = z * z;
    let mut polynomial = N::ZERO;
    for c in ATAN.iter().rev() {
        polynomial = polynomial * s + N::splat(*c);
    }
    let angle = z + z * s * polynomial + N::select(is_wide, N::splat(FRAC_PI_4), N::ZERO);
    let angle = N::select(ax.lt(ay), N::splat(FRAC_PI_2) - angle, angle);
    let angle = N::select(x.lt(N::ZERO), N::splat(PI) - angle, angle);
    N::select(y.lt(N::ZERO), -angle, angle)
}

/// The arc tangent for 0 ≤ z ≤ 1: atan z = atan c + atan((z − c) / (1 + z c)), c the nearest eighth.
fn atan_unit(z: f64) -> f64 {
    let eighth = (z * 8.0).round();
    let c = eighth / 8.0;
    let t = (z - c) / (1.0 + z * c);
    let s = t * t;
    let series = s
        * (-1.0 / 3.0 + s * (1.0 / 5.0 + s * (-1.0 / 7.0 + s * (1.0 / 9.0 + s * (-1.0 / 11.0 + s / 13.0)))));
    ATAN_EIGHTHS[eighth as usize] + (t + t * series)
}

/// c0 + c1 x + c2 x² + …
fn horner(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_the_platform() {
        for i in -20_000..20_000 {
            let angle = f64::from(i) * 0.001_37;
            let (s, c) = sin_cos(angle);
            assert!((s - angle.sin()).abs() < 4e-16, "sin {angle}");
            assert!((c - angle.cos()).abs() < 4e-16, "cos {angle}");
            assert!((atan2(s, c) - s.atan2(c)).abs() < 1e-15, "atan2 at {angle}");
        }
        for big in [1e7, -3.3e9, 1e15] {
            assert!((sin(big) - big.sin()).abs() < 1e-1);
            assert!((sin(big) * sin(big) + cos(big) * cos(big) - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn special_values() {
        use core::f64::consts::PI;
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(atan2(0.0, 0.0), 0.0);
        assert_eq!(atan2(0.0, -1.0), PI);
        assert_eq!(atan2(-1.0, 0.0), -PI / 2.0);
        assert_eq!(atan2(f64::INFINITY, f64::INFINITY), PI / 4.0);
        assert!(sin(f64::INFINITY).is_nan() && atan2(f64::NAN, 1.0).is_nan());
    }

    #[test]
    fn an_eighth_turn_has_equal_sine_and_cosine_in_f32() {
        let (s, c) = sin_cos(f64::from(core::f32::consts::FRAC_PI_4));
        assert_eq!(s as f32, c as f32);
    }
}
