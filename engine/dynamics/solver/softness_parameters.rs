//! Soft constraints: a spring defined by damping ratio and frequency, and its coefficients for a velocity
//! constraint.

use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::math::{Scalar, TAU};

/// Maximum of both values of [`SoftnessParameters`]: far above the values that a step resolves, and far below
/// the values whose squares overflow.
const LIMIT: Scalar = 1e9;

/// A damped spring, defined by frequency and damping ratio instead of stiffness. It behaves alike for all
/// masses.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Clone, PartialEq)]
pub struct SoftnessParameters {
    #[cfg_attr(feature = "serialize", serde(deserialize_with = "deserialize_sanitized"))]
    damping_ratio: Scalar,
    #[cfg_attr(feature = "serialize", serde(deserialize_with = "deserialize_sanitized"))]
    angular_frequency: Scalar,
}

/// Clamps deserialized values to the same limits as other values.
#[cfg(feature = "serialize")]
fn deserialize_sanitized<'de, D: serde::Deserializer<'de>>(deserializer: D) -> Result<Scalar, D::Error> {
    let value: Scalar = serde::Deserialize::deserialize(deserializer)?;
    // Angular frequencies go up to TAU times the limit.
    Ok(if value > 0.0 { value.min(TAU * LIMIT) } else { 0.0 })
}

impl SoftnessParameters {
    /// A spring with damping ratio ζ (0 oscillates forever, 1 returns fastest without oscillation, above 1 is
    /// slower) and an undamped frequency in Hz.
    ///
    /// Negative and NaN values count as 0, values above 10⁹ as 10⁹.
    pub fn new(damping_ratio: Scalar, frequency_hz: Scalar) -> Self {
        Self { damping_ratio: sanitized(damping_ratio), angular_frequency: TAU * sanitized(frequency_hz) }
    }

    /// The damping ratio ζ.
    pub fn damping_ratio(self) -> Scalar {
        self.damping_ratio
    }

    /// The undamped frequency in Hz.
    pub fn frequency(self) -> Scalar {
        self.angular_frequency / TAU
    }

    /// The undamped angular frequency ω in rad/s.
    pub const fn angular_frequency(self) -> Scalar {
        self.angular_frequency
    }

    /// The coefficients of this spring for a step of `delta_secs` seconds.
    ///
    /// With h the step and ω the angular frequency (E. Catto, *Soft Constraints*, GDC 2011, and
    /// *Solver2D*, 2024),
    ///
    /// ```text
    /// a1 = 2 ζ + h ω      a2 = h ω a1      a3 = 1 / (1 + a2)
    /// bias = ω / a1       mass_scale = a2 a3       impulse_scale = a3
    /// ```
    ///
    /// Any input is valid: a spring with zero frequency has no effect, and a step that is zero, negative or
    /// NaN counts as no step.
    pub fn compute_coefficients(self, delta_secs: Scalar) -> SoftnessCoefficients {
        let omega = self.angular_frequency;
        if omega == 0.0 {
            return SoftnessCoefficients { bias: 0.0, mass_scale: 0.0, impulse_scale: 1.0 };
        }
        let h = sanitized(delta_secs);
        let a1 = 2.0 * self.damping_ratio + h * omega;
        let a2 = h * omega * a1;
        let a3 = 1.0 / (1.0 + a2);
        // Without damping and step, a1 and a2 are 0: there is no impulse for any bias.
        let bias = if a1 > 0.0 { omega / a1 } else { 0.0 };
        SoftnessCoefficients { bias, mass_scale: a2 * a3, impulse_scale: a3 }
    }
}

/// `value` clamped to 0 … [`LIMIT`]; NaN becomes 0.
fn sanitized(value: Scalar) -> Scalar {
    if value > 0.0 { value.min(LIMIT) } else { 0.0 }
}

/// Coefficients of a soft velocity constraint: λ = −mass_scale · m · (v + bias · c) − impulse_scale · Σλ.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Clone, PartialEq)]
pub struct SoftnessCoefficients {
    /// Bias velocity per length of error, in 1/s.
    pub bias: Scalar,
    /// Fraction of the effective mass, 0 to 1.
    pub mass_scale: Scalar,
    /// Fraction of the accumulated impulse that is subtracted, 0 to 1. The sum with `mass_scale` is 1.
    pub impulse_scale: Scalar,
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An implicit Euler step of the spring x'' + 2ζω x' + ω² x = 0.
    fn spring_step(zeta: f64, omega: f64, h: f64, x: f64, v: f64) -> f64 {
        (v - h * omega * omega * x) / (1.0 + 2.0 * zeta * omega * h + h * h * omega * omega)
    }

    #[test]
    fn one_soft_impulse_is_an_implicit_step_of_the_spring() {
        for (zeta, hz, h) in [(0.1, 1.0, 0.01), (1.0, 5.0, 0.02), (10.0, 30.0, 1.0 / 360.0)] {
            let softness = SoftnessParameters::new(zeta, hz);
            let c = softness.compute_coefficients(h);
            for (x, v) in [(0.1, 0.0), (0.0, -2.0), (-0.3, 1.5)] {
                // Unit mass: the change of velocity is the impulse.
                let soft = v - c.mass_scale * (v + c.bias * x);
                let omega = core::f64::consts::TAU * f64::from(hz as f32);
                let exact = spring_step(
                    f64::from(zeta as f32),
                    omega,
                    f64::from(h as f32),
                    f64::from(x as f32),
                    f64::from(v as f32),
                );
                assert!((f64::from(soft as f32) - exact).abs() < 1e-5, "{soft} is not {exact}");
            }
        }
    }

    #[test]
    fn shares_sum_to_one() {
        for (zeta, hz, h) in [(0.0, 0.0, 0.0), (10.0, 45.0, 1.0 / 360.0), (0.0, 1e9, 1e9), (1e9, 1e-9, 1e-9)]
        {
            let c = SoftnessParameters::new(zeta, hz).compute_coefficients(h);
            assert!((c.mass_scale + c.impulse_scale - 1.0).abs() < 1e-6, "{c:?}");
        }
    }

    #[test]
    fn the_limits_are_nothing_and_rigid() {
        let nothing = SoftnessCoefficients { bias: 0.0, mass_scale: 0.0, impulse_scale: 1.0 };
        for spring in [(0.0, 0.0), (1.0, -1.0), (1.0, Scalar::NAN), (Scalar::NAN, Scalar::NAN)] {
            assert_eq!(SoftnessParameters::new(spring.0, spring.1).compute_coefficients(0.01), nothing);
        }
        let rigid = SoftnessParameters::new(1.0, Scalar::INFINITY).compute_coefficients(0.01);
        assert!(
            (rigid.bias - 100.0).abs() < 1e-3 && rigid.mass_scale > 0.999_999 && rigid.impulse_scale < 1e-6
        );
    }

    #[test]
    fn getters_return_what_went_in() {
        let softness = SoftnessParameters::new(0.5, 4.0);
        assert_eq!(softness.damping_ratio(), 0.5);
        assert!((softness.frequency() - 4.0).abs() < 1e-5);
        assert_eq!(softness.angular_frequency(), TAU * 4.0);
    }
}
