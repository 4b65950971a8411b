//! Settings of the solver: the length unit, [`SolverConfig`], and the contact softness, which is derived from
//! them in every step.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_log::{warn, warn_once};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bevy_time::Time;

use super::{
    schedule::SubstepCount,
    softness_parameters::{SoftnessCoefficients, SoftnessParameters},
};
use crate::{
    math::{Scalar, to_f32},
    schedule::{Physics, TimePrecisionAdjusted},
};

/// Overlap of resting contacts, times the [`PhysicsLengthUnit`]. Other tolerances of contacts are multiples
/// of it. A smaller value makes resting contacts flicker, a larger value makes overlap visible.
pub(crate) const LINEAR_SLOP: f64 = 0.005;

/// The approximate length of a metre in units of the app: the size of a typical object.
///
/// Tolerances and thresholds that are lengths or speeds are multiplied by it. This makes a 2D game with
/// characters of 100 pixels as stable as a game with characters of 1 unit. It does not scale positions,
/// velocities or [`Gravity`](crate::dynamics::integrator::Gravity). 1 by default. Set it before anything
/// moves. If gravity and the sizes of all moving bodies indicate that it was forgotten,
/// `LengthUnitCheckPlugin` warns once.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_app::App;
/// # use bevy_transform::TransformPlugin;
/// App::new().add_plugins((TransformPlugin, PhysicsPlugins::default().with_length_unit(100.0)));
/// ```
#[derive(Resource, Clone, Debug, Deref, DerefMut, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Resource, Default, Debug, PartialEq)]
pub struct PhysicsLengthUnit(pub Scalar);

crate::type_path::type_path!(PhysicsLengthUnit, "dynamics::solver::plugin");

impl Default for PhysicsLengthUnit {
    fn default() -> Self {
        Self(1.0)
    }
}

impl PhysicsLengthUnit {
    /// `unit`, or 1 with a warning if it is zero, negative, infinite or NaN.
    pub(super) fn valid_or_default(unit: Scalar) -> Self {
        if unit.is_finite() && unit > 0.0 {
            Self(unit)
        } else {
            warn!("a physics length unit of {unit} is not a positive length, 1 is used instead");
            Self::default()
        }
    }

    /// The unit, or 1 with one warning if it is zero, negative, infinite or NaN.
    pub(crate) fn metres(&self) -> f32 {
        let unit = to_f32(self.0);
        if unit.is_finite() && unit > 0.0 {
            return unit;
        }
        warn_once!("a physics length unit of {} is not a positive length, 1 is used instead", self.0);
        1.0
    }
}

/// Settings of contacts: stiffness, speeds, restitution. "LU" means [`PhysicsLengthUnit`].
#[derive(Resource, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Resource, Default, Debug, PartialEq)]
pub struct SolverConfig {
    /// The damping ratio ζ of overlap recovery. 10 by default. Values above 1 remove overlap without
    /// oscillation, lower values are springier.
    pub contact_damping_ratio: Scalar,
    /// The frequency of overlap recovery, as a multiple of the highest frequency that the timestep resolves.
    /// 1.5 by default. Higher values are stiffer, but cause jitter.
    pub contact_frequency_factor: Scalar,
    /// Maximum speed at which overlap is pushed out, in LU/s. 4 by default. Higher values shoot overlapping
    /// bodies apart.
    pub max_overlap_solve_speed: Scalar,
    /// Fraction of the last step's impulses for the warm start. 1 by default. With 0 stacks sag.
    pub warm_start_coefficient: Scalar,
    /// Minimum approach speed for restitution, in LU/s. 1 by default. With 0 bodies never come to rest.
    pub restitution_threshold: Scalar,
    /// Number of restitution passes after the last substep, for bodies that continuous collision detection
    /// stopped. 1 by default. Impacts within substeps do not depend on it.
    pub restitution_iterations: usize,
}

crate::type_path::type_path!(SolverConfig, "dynamics::solver::plugin");

impl Default for SolverConfig {
    fn default() -> Self {
        Self {
            contact_damping_ratio: 10.0,
            contact_frequency_factor: 1.5,
            max_overlap_solve_speed: 4.0,
            warm_start_coefficient: 1.0,
            restitution_threshold: 1.0,
            restitution_iterations: 1,
        }
    }
}

/// Softness of contacts. Computed from [`SolverConfig`] and the timestep in every step.
#[derive(Resource, Clone, Copy, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Resource, Default, PartialEq)]
pub struct ContactSoftnessCoefficients {
    /// Softness of contacts between dynamic bodies.
    pub dynamic: SoftnessCoefficients,
    /// Softness of contacts of a dynamic body with a static or kinematic body: twice as stiff, which lets the
    /// ground support a pile.
    pub non_dynamic: SoftnessCoefficients,
}

crate::type_path::type_path!(ContactSoftnessCoefficients, "dynamics::solver::plugin");

impl Default for ContactSoftnessCoefficients {
    fn default() -> Self {
        Self {
            dynamic: SoftnessParameters::new(10.0, 30.0).compute_coefficients(1.0 / 60.0),
            non_dynamic: SoftnessParameters::new(10.0, 60.0).compute_coefficients(1.0 / 60.0),
        }
    }
}

impl ContactSoftnessCoefficients {
    /// The softness of contacts in a step of `delta_secs` seconds with `substeps` substeps.
    ///
    /// A spring of frequency f is solved once per substep h, and its target moves once per step dt. Half the
    /// step rate, 1/(2 dt), is the highest frequency that steps can represent. A quarter of the substep rate,
    /// 0.25/h, is the highest that the solver integrates well (E. Catto, *Solver2D*, 2024). Hence
    ///
    /// ```text
    /// f = factor · min(1/(2 dt), 0.25/h),   h = dt / substeps
    /// ```
    ///
    /// for dynamic bodies, and 2 f if the other body is immovable.
    pub fn for_step(config: &SolverConfig, delta_secs: Scalar, substeps: u32) -> Self {
        let substep_secs = delta_secs / substeps.max(1) as Scalar;
        let highest = Scalar::min(0.5 / delta_secs, 0.25 / substep_secs);
        let frequency = config.contact_frequency_factor * highest;
        let coefficients =
            |hz| SoftnessParameters::new(config.contact_damping_ratio, hz).compute_coefficients(substep_secs);
        Self { dynamic: coefficients(frequency), non_dynamic: coefficients(2.0 * frequency) }
    }
}

/// Computes this step's softness from the settings.
pub(crate) fn update_contact_softness(
    mut softness: ResMut<ContactSoftnessCoefficients>,
    config: Res<SolverConfig>,
    substeps: Option<Res<SubstepCount>>,
    time: Res<Time<Physics>>,
) {
    let substeps = substeps.map_or(1, |count| count.0);
    let current = ContactSoftnessCoefficients::for_step(&config, time.delta_seconds_adjusted(), substeps);
    softness.set_if_neq(current);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn few_substeps_are_limited_by_the_substep_rate_and_many_by_the_step_rate() {
        let config = SolverConfig::default();
        let dt = 1.0 / 60.0;
        let by_hand = |hz: Scalar, h| SoftnessParameters::new(10.0, hz).compute_coefficients(h);
        // One substep: 0.25 · 60 Hz is below 60/2 Hz.
        let one = ContactSoftnessCoefficients::for_step(&config, dt, 1);
        assert_relative(one.dynamic, by_hand(1.5 * 15.0, dt));
        assert_relative(one.non_dynamic, by_hand(2.0 * 1.5 * 15.0, dt));
        // Six: 0.25 · 360 Hz is above it.
        let six = ContactSoftnessCoefficients::for_step(&config, dt, 6);
        assert_relative(six.dynamic, by_hand(1.5 * 30.0, dt / 6.0));
        assert_relative(six.non_dynamic, by_hand(2.0 * 1.5 * 30.0, dt / 6.0));
    }

    fn assert_relative(a: SoftnessCoefficients, b: SoftnessCoefficients) {
        for (a, b) in [(a.bias, b.bias), (a.mass_scale, b.mass_scale), (a.impulse_scale, b.impulse_scale)] {
            assert!((a - b).abs() <= 1e-5 * b.abs(), "{a} is not {b}");
        }
    }

    proptest! {
        #[test]
        fn no_configuration_gives_a_coefficient_that_is_no_number(
            damping in proptest::num::f64::ANY,
            factor in proptest::num::f64::ANY,
            nanos: u64,
            substeps: u32,
        ) {
            let config = SolverConfig {
                contact_damping_ratio: damping as Scalar,
                contact_frequency_factor: factor as Scalar,
                ..SolverConfig::default()
            };
            let dt = (nanos as f64 * 1e-9) as Scalar;
            let softness = ContactSoftnessCoefficients::for_step(&config, dt, substeps);
            for c in [softness.dynamic, softness.non_dynamic] {
                prop_assert!(c.bias >= 0.0 && c.bias.is_finite(), "{c:?}");
                prop_assert!((0.0..=1.0).contains(&c.mass_scale) && (0.0..=1.0).contains(&c.impulse_scale), "{c:?}");
            }
        }
    }

    #[test]
    fn a_length_unit_is_a_positive_length() {
        assert_eq!(PhysicsLengthUnit::valid_or_default(100.0).0, 100.0);
        for wrong in [0.0, -1.0, Scalar::NAN, Scalar::INFINITY] {
            assert_eq!(PhysicsLengthUnit::valid_or_default(wrong).0, 1.0);
        }
    }
}
