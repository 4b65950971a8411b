//! The total mass and centre of mass of a body, for the solver.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use super::{CenterOfMass, Mass, MassError};
use crate::math::{AdjustPrecision, RecipOrZero, Scalar, Vector};

/// The total mass of a body, in kg. Stored as its inverse, so an infinite mass is 0. A mass of 0 also means
/// infinite.
///
/// Computed from [`Mass`] and the colliders. Static bodies have infinite mass. Kinematic bodies have the mass
/// of a dynamic body, without effect on contacts. Write it only with [`NoAutoMass`](super::NoAutoMass).
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ComputedMass {
    inverse: Scalar,
}

impl ComputedMass {
    /// Immovable.
    pub const INFINITY: Self = Self { inverse: 0.0 };

    /// A mass in kg; 0 means infinite. Negative values and NaN panic in debug builds and give infinite mass
    /// in release builds.
    pub fn new(mass: Scalar) -> Self {
        let result = Self::try_new(mass);
        debug_assert!(result.is_ok(), "a mass is not negative and not NaN, this is {mass}");
        result.unwrap_or(Self::INFINITY)
    }

    /// A mass in kg; 0 means infinite. Negative values and NaN are errors.
    pub fn try_new(mass: Scalar) -> Result<Self, MassError> {
        check(mass).map(|()| Self { inverse: mass.recip_or_zero() })
    }

    /// A mass from its inverse in 1/kg. Negative values and NaN panic in debug builds and give infinite mass
    /// in release builds.
    pub fn from_inverse(inverse_mass: Scalar) -> Self {
        let result = Self::try_from_inverse(inverse_mass);
        debug_assert!(result.is_ok(), "an inverse mass is not negative and not NaN, this is {inverse_mass}");
        result.unwrap_or(Self::INFINITY)
    }

    /// A mass from its inverse in 1/kg. Negative values and NaN are errors.
    pub fn try_from_inverse(inverse_mass: Scalar) -> Result<Self, MassError> {
        check(inverse_mass).map(|()| Self { inverse: inverse_mass })
    }

    /// The mass in kg, 0 if infinite.
    pub fn value(self) -> Scalar {
        self.inverse.recip_or_zero()
    }

    /// 1 / mass in 1/kg, 0 if infinite.
    pub fn inverse(self) -> Scalar {
        self.inverse
    }

    /// Replaces the mass.
    pub fn set(&mut self, mass: impl Into<ComputedMass>) {
        *self = mass.into();
    }

    /// Whether the mass is neither infinite nor NaN.
    pub fn is_finite(self) -> bool {
        !self.is_infinite() && !self.is_nan()
    }

    /// Whether the mass is infinite: no impulse moves the body.
    pub fn is_infinite(self) -> bool {
        self.value() == 0.0 && !self.is_nan()
    }

    /// Whether the mass is NaN. No constructor makes such a mass.
    pub fn is_nan(self) -> bool {
        self.inverse.is_nan()
    }
}

fn check(value: Scalar) -> Result<(), MassError> {
    if value.is_nan() {
        Err(MassError::NaN)
    } else if value < 0.0 {
        Err(MassError::Negative)
    } else {
        Ok(())
    }
}

impl From<Scalar> for ComputedMass {
    fn from(mass: Scalar) -> Self {
        Self::new(mass)
    }
}

impl From<Mass> for ComputedMass {
    fn from(mass: Mass) -> Self {
        Self::new(mass.0.adjust_precision())
    }
}

impl From<ComputedMass> for Mass {
    fn from(mass: ComputedMass) -> Self {
        Self(mass.value() as f32)
    }
}

/// The total centre of mass of a body, in the body's frame, in metres.
///
/// Computed from [`CenterOfMass`] and the colliders. Write it only with
/// [`NoAutoCenterOfMass`](super::NoAutoCenterOfMass).
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ComputedCenterOfMass(pub Vector);

impl ComputedCenterOfMass {
    /// The body's origin.
    pub const ZERO: Self = Self(Vector::ZERO);
}

impl From<CenterOfMass> for ComputedCenterOfMass {
    fn from(center: CenterOfMass) -> Self {
        Self(center.0.adjust_precision())
    }
}

impl From<ComputedCenterOfMass> for CenterOfMass {
    fn from(center: ComputedCenterOfMass) -> Self {
        use crate::math::AsF32;
        Self(center.0.f32())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mass_keeps_its_value_and_inverse() {
        let mass = ComputedMass::new(4.0);
        assert_eq!((mass.value(), mass.inverse()), (4.0, 0.25));
        assert!(mass.is_finite() && !mass.is_infinite() && !mass.is_nan());
        assert_eq!(ComputedMass::from_inverse(0.25), mass);
        assert_eq!(Mass::from(mass), Mass(4.0));
        assert_eq!(ComputedMass::from(Mass(4.0)), mass);
        let mut other = ComputedMass::INFINITY;
        other.set(4.0);
        assert_eq!(other, mass);
    }

    #[test]
    fn zero_and_infinity_are_infinite() {
        for mass in [0.0, Scalar::INFINITY] {
            let mass = ComputedMass::new(mass);
            assert_eq!(mass, ComputedMass::INFINITY);
            assert!(mass.is_infinite() && !mass.is_finite());
            assert_eq!((mass.value(), mass.inverse()), (0.0, 0.0));
        }
        assert_eq!(ComputedMass::default(), ComputedMass::INFINITY);
    }

    #[test]
    fn what_is_no_mass_is_an_error() {
        assert_eq!(ComputedMass::try_new(-1.0), Err(MassError::Negative));
        assert_eq!(ComputedMass::try_new(Scalar::NEG_INFINITY), Err(MassError::Negative));
        assert_eq!(ComputedMass::try_new(Scalar::NAN), Err(MassError::NaN));
        assert_eq!(ComputedMass::try_from_inverse(-1.0), Err(MassError::Negative));
        assert_eq!(ComputedMass::try_from_inverse(Scalar::NAN), Err(MassError::NaN));
    }

    #[test]
    fn centres_convert_both_ways() {
        let center = CenterOfMass::ZERO;
        assert_eq!(ComputedCenterOfMass::from(center), ComputedCenterOfMass::ZERO);
        assert_eq!(CenterOfMass::from(ComputedCenterOfMass::ZERO), center);
    }
}
