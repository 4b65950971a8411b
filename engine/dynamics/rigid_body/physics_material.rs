//! Materials of surfaces: friction, restitution, and the rules that combine the materials of two colliders.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::math::Scalar;

/// The rule that combines the coefficients of two touching surfaces.
///
/// If the surfaces have different rules, the rule further down the list is used.
#[derive(Reflect, Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[reflect(Debug, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub enum CoefficientCombine {
    /// The mean, `(a + b) / 2`.
    Average = 1,
    /// The geometric mean, `√(a b)`; 0 if the product is negative.
    GeometricMean = 2,
    /// The smaller coefficient.
    Min = 3,
    /// The product, `a b`.
    Multiply = 4,
    /// The larger coefficient.
    Max = 5,
}

impl CoefficientCombine {
    /// Combines two coefficients by this rule. Symmetric in `a` and `b`.
    pub fn mix(&self, a: Scalar, b: Scalar) -> Scalar {
        match self {
            Self::Average => (a + b) * 0.5,
            Self::GeometricMean => {
                let product = a * b;
                if product > 0.0 { product.sqrt() } else { 0.0 }
            }
            Self::Min => a.min(b),
            Self::Multiply => a * b,
            Self::Max => a.max(b),
        }
    }
}

/// The friction of colliders that have no [`Friction`], neither their own nor their body's.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(Resource, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct DefaultFriction(pub Friction);

/// The restitution of colliders that have no [`Restitution`], neither their own nor their body's.
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(Resource, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct DefaultRestitution(pub Restitution);

/// Friction of a surface: the coefficients of Coulomb's law, `|tangent force| ≤ μ · normal force`.
///
/// Usual values are between 0 (ice) and 1 (rubber). Larger values are allowed, negative values count as 0. On
/// a body it applies to all its colliders without a `Friction` of their own. [`DefaultFriction`] applies to
/// all other colliders.
///
/// The solver uses the dynamic coefficient only.
///
/// ```
/// # use avian::prelude::*;
/// let ice = Friction::new(0.02).with_combine_rule(CoefficientCombine::Min);
/// let rubber = Friction::new(1.0);
/// // `Min` comes after `Average`, so the ice decides.
/// assert_eq!(ice.combine(rubber).dynamic_coefficient, 0.02);
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, PartialOrd)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct Friction {
    /// The coefficient while the surfaces slide, dimensionless. 0.5 by default.
    pub dynamic_coefficient: Scalar,
    /// The coefficient up to which the surfaces do not slide, dimensionless. 0.5 by default.
    pub static_coefficient: Scalar,
    /// The rule that combines this surface's coefficients with another's.
    pub combine_rule: CoefficientCombine,
}

impl Default for Friction {
    fn default() -> Self {
        Self::new(0.5)
    }
}

impl Friction {
    /// No friction.
    pub const ZERO: Self =
        Self { dynamic_coefficient: 0.0, static_coefficient: 0.0, combine_rule: CoefficientCombine::Average };

    /// Friction with the same dynamic and static coefficient, combined by the mean.
    pub fn new(friction_coefficient: Scalar) -> Self {
        Self {
            dynamic_coefficient: friction_coefficient,
            static_coefficient: friction_coefficient,
            ..Self::ZERO
        }
    }

    /// The same coefficients with another rule.
    #[must_use]
    pub fn with_combine_rule(&self, combine_rule: CoefficientCombine) -> Self {
        Self { combine_rule, ..*self }
    }

    /// The same friction with another dynamic coefficient.
    #[must_use]
    pub fn with_dynamic_coefficient(&self, coefficient: Scalar) -> Self {
        Self { dynamic_coefficient: coefficient, ..*self }
    }

    /// The same friction with another static coefficient.
    #[must_use]
    pub fn with_static_coefficient(&self, coefficient: Scalar) -> Self {
        Self { static_coefficient: coefficient, ..*self }
    }

    /// The friction between two surfaces, by their combine rules.
    #[must_use]
    pub fn combine(&self, other: Self) -> Self {
        let rule = self.combine_rule.max(other.combine_rule);
        Self {
            dynamic_coefficient: rule.mix(self.dynamic_coefficient, other.dynamic_coefficient),
            static_coefficient: rule.mix(self.static_coefficient, other.static_coefficient),
            combine_rule: rule,
        }
    }
}

impl From<Scalar> for Friction {
    fn from(coefficient: Scalar) -> Self {
        Self::new(coefficient)
    }
}

/// Restitution of a surface: the ratio of separation speed to approach speed, from 0 (the default, no bounce)
/// to 1 (full bounce).
///
/// Slow impacts do not bounce, see
/// [`SolverConfig::restitution_threshold`](crate::dynamics::solver::SolverConfig::restitution_threshold).
/// [`DefaultRestitution`] applies to colliders without the component.
///
/// ```
/// # use avian::prelude::*;
/// let ball = Restitution::new(0.8).with_combine_rule(CoefficientCombine::Max);
/// assert_eq!(ball.combine(Restitution::PERFECTLY_INELASTIC).coefficient, 0.8);
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, PartialOrd)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct Restitution {
    /// The ratio of separation speed to approach speed, dimensionless.
    pub coefficient: Scalar,
    /// The rule that combines this surface's coefficient with another's.
    pub combine_rule: CoefficientCombine,
}

impl Default for Restitution {
    fn default() -> Self {
        Self::ZERO
    }
}

impl Restitution {
    /// No bounce.
    pub const ZERO: Self = Self { coefficient: 0.0, combine_rule: CoefficientCombine::Average };
    /// No bounce: bodies stay in contact.
    pub const PERFECTLY_INELASTIC: Self = Self::ZERO;
    /// Full bounce: kinetic energy is conserved.
    pub const PERFECTLY_ELASTIC: Self = Self { coefficient: 1.0, ..Self::ZERO };

    /// Restitution with this coefficient, combined by the mean.
    pub fn new(coefficient: Scalar) -> Self {
        Self { coefficient, ..Self::ZERO }
    }

    /// The same coefficient with another rule.
    #[must_use]
    pub fn with_combine_rule(&self, combine_rule: CoefficientCombine) -> Self {
        Self { combine_rule, ..*self }
    }

    /// The restitution between two surfaces, by their combine rules.
    #[must_use]
    pub fn combine(&self, other: Self) -> Self {
        let rule = self.combine_rule.max(other.combine_rule);
        Self { coefficient: rule.mix(self.coefficient, other.coefficient), combine_rule: rule }
    }
}

impl From<Scalar> for Restitution {
    fn from(coefficient: Scalar) -> Self {
        Self::new(coefficient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: [CoefficientCombine; 5] = [
        CoefficientCombine::Average,
        CoefficientCombine::GeometricMean,
        CoefficientCombine::Min,
        CoefficientCombine::Multiply,
        CoefficientCombine::Max,
    ];

    #[test]
    fn each_rule_is_what_its_name_says() {
        let expected = [0.625, 0.5, 0.25, 0.25, 1.0];
        for (rule, expected) in RULES.into_iter().zip(expected) {
            assert_eq!(rule.mix(0.25, 1.0), expected, "{rule:?}");
            assert_eq!(rule.mix(1.0, 0.25), expected, "{rule:?} is symmetric");
        }
        assert_eq!(CoefficientCombine::GeometricMean.mix(-1.0, 1.0), 0.0);
    }

    #[test]
    fn the_later_rule_wins_whoever_brings_it() {
        for (i, first) in RULES.into_iter().enumerate() {
            for (j, second) in RULES.into_iter().enumerate() {
                let (a, b) = (Friction::new(0.2), Friction::new(0.9));
                let (a, b) = (a.with_combine_rule(first), b.with_combine_rule(second));
                let winner = RULES[i.max(j)];
                assert_eq!(a.combine(b).combine_rule, winner);
                assert_eq!(a.combine(b).dynamic_coefficient, winner.mix(0.2, 0.9));
                assert_eq!(a.combine(b), b.combine(a));
                let (a, b) = (Restitution::new(0.2), Restitution::new(0.9));
                let (a, b) = (a.with_combine_rule(first), b.with_combine_rule(second));
                assert_eq!(a.combine(b).coefficient, winner.mix(0.2, 0.9));
                assert_eq!(a.combine(b), b.combine(a));
            }
        }
    }

    #[test]
    fn static_and_dynamic_friction_are_combined_apart() {
        let a = Friction::new(0.4).with_static_coefficient(0.8);
        let b = Friction::from(0.2).with_dynamic_coefficient(0.0);
        let both = a.combine(b);
        assert!(
            (both.dynamic_coefficient - 0.2).abs() < 1e-6 && (both.static_coefficient - 0.5).abs() < 1e-6
        );
    }

    #[test]
    fn the_fallbacks_are_the_defaults() {
        assert_eq!(DefaultFriction::default().0, Friction::new(0.5));
        assert_eq!(DefaultRestitution::default().0, Restitution::PERFECTLY_INELASTIC);
    }
}
