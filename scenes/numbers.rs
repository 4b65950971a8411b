//! Numbers that are the same on every machine: random integers, sine and cosine.

/// A small random number generator (PCG-XSH-RR of M. O'Neill, "PCG: A Family of Simple Fast Space-Efficient
/// Statistically Good Algorithms for Random Number Generation", 2014).
#[derive(Clone, Debug)]
pub struct Rng {
    state: u64,
}

impl Rng {
    /// A generator; equal seeds give equal sequences.
    pub fn new(seed: u64) -> Self {
        let mut rng = Self { state: seed.wrapping_add(0x9e37_79b9_7f4a_7c15) };
        rng.next_u32();
        rng
    }

    /// Any 32 bits.
    pub fn next_u32(&mut self) -> u32 {
        let old = self.state;
        self.state = old.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let xored = (((old >> 18) ^ old) >> 27) as u32;
        xored.rotate_right((old >> 59) as u32)
    }

    /// A number in `low..high`. The 24 random bits fit the mantissa, so no rounding reaches `high` for spans
    /// that are not tiny beside `low`.
    pub fn between(&mut self, low: f32, high: f32) -> f32 {
        let unit = (self.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0);
        low + (high - low) * unit
    }

    /// An index below `n`; `n` is small beside 2³², so the modulo's bias does not matter. Zero for `n` = 0.
    pub fn below(&mut self, n: u32) -> u32 {
        if n == 0 { 0 } else { self.next_u32() % n }
    }
}

/// Sine and cosine of an angle in radians, by Taylor series in `f64`: only sums and products, hence the
/// same bits wherever it runs, unlike the platform's functions. Exact to `f32` for angles up to some
/// thousand turns.
pub fn sin_cos(angle: f32) -> (f32, f32) {
    let (sin, cos) = sin_cos_f64(f64::from(angle));
    (sin as f32, cos as f32)
}

/// Sine and cosine of half the angle: the parts of a unit quaternion.
pub fn half_turn_parts(angle: f32) -> (f32, f32) {
    let (sin, cos) = sin_cos_f64(0.5 * f64::from(angle));
    (sin as f32, cos as f32)
}

fn sin_cos_f64(angle: f64) -> (f64, f64) {
    use core::f64::consts::{FRAC_PI_2, TAU};
    let turns = (angle / TAU).round();
    let rest = angle - turns * TAU;
    let quarter = (rest / FRAC_PI_2).round();
    let x = rest - quarter * FRAC_PI_2;
    let (mut sin, mut cos, mut term) = (0.0, 0.0, 1.0);
    // |x| ≤ π/4, so the 18th term is below 1e-17.
    for n in 0..18u32 {
        match n % 4 {
            0 => cos += term,
            1 => sin += term,
            2 => cos -= term,
            _ => sin -= term,
        }
        term *= x / f64::from(n + 1);
    }
    match quarter as i32 {
        0 => (sin, cos),
        1 => (cos, -sin),
        -1 => (-cos, sin),
        _ => (-sin, -cos),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sine_and_cosine_agree_with_the_platform() {
        for i in -4000..4000 {
            let angle = i as f32 * 0.01;
            let (sin, cos) = sin_cos(angle);
            assert!((sin - angle.sin()).abs() < 2e-7, "sin {angle}");
            assert!((cos - angle.cos()).abs() < 2e-7, "cos {angle}");
        }
    }

    #[test]
    fn random_numbers_repeat_and_fill_their_range() {
        let (mut a, mut b) = (Rng::new(7), Rng::new(7));
        let (mut low, mut high, mut sum) = (1.0f32, 0.0f32, 0.0);
        for _ in 0..10_000 {
            let x = a.between(0.0, 1.0);
            assert_eq!(x, b.between(0.0, 1.0));
            low = low.min(x);
            high = high.max(x);
            sum += f64::from(x);
        }
        assert!(low >= 0.0 && low < 0.01 && high < 1.0 && high > 0.99);
        assert!((sum / 10_000.0 - 0.5).abs() < 0.02, "mean {}", sum / 10_000.0);
    }
}
