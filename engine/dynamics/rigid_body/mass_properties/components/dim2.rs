//! Angular inertia in 2D: a scalar. `dim3.rs` has the tensors of 3D.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_math::Vec2;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use super::{AngularInertiaError, CenterOfMass, ComputedCenterOfMass};
use crate::math::{AdjustPrecision, ComputeMassProperties, MassProperties, RecipOrZero, Scalar, Vector};

/// The angular inertia of a body about its centre of mass, or of a part of the body on a descendant, in
/// kg·m².
///
/// It replaces the inertia of the collider on the same entity. The body's total, [`ComputedAngularInertia`],
/// is the sum over the body and its descendants about the common centre of mass. With
/// [`NoAutoAngularInertia`](super::NoAutoAngularInertia) it is only the body's own inertia. Infinity is
/// allowed. Negative values and NaN count as 0, with a warning.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
#[doc(alias = "MomentOfInertia")]
pub struct AngularInertia(pub f32);

crate::type_path::type_path!(AngularInertia, "dynamics::rigid_body::mass_properties::components");

impl AngularInertia {
    /// No inertia.
    pub const ZERO: Self = Self(0.0);

    /// The inertia of a shape of `mass` kg about its centroid.
    pub fn from_shape<T: ComputeMassProperties>(shape: &T, mass: f32) -> Self {
        Self(shape.angular_inertia(mass))
    }

    /// The inertia about an axis `offset` metres off the centre of mass, by the parallel axis theorem:
    /// I + m d².
    pub fn shifted(&self, mass: f32, offset: Vec2) -> f32 {
        self.0 + mass * offset.length_squared()
    }

    /// Whether the value is valid: neither negative nor NaN.
    pub(in super::super) fn is_valid(self) -> bool {
        self.0 >= 0.0
    }
}

/// The total angular inertia of a body about its centre of mass, in kg·m². Stored as its inverse, so an
/// infinite inertia is 0. An inertia of 0 also means infinite.
///
/// Computed from [`AngularInertia`] and the colliders. Static bodies have infinite inertia. Write it only
/// with [`NoAutoAngularInertia`](super::NoAutoAngularInertia).
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
#[doc(alias = "ComputedMomentOfInertia")]
pub struct ComputedAngularInertia {
    inverse: Scalar,
}

crate::type_path::type_path!(
    ComputedAngularInertia,
    "dynamics::rigid_body::mass_properties::components::computed"
);

impl Default for ComputedAngularInertia {
    fn default() -> Self {
        Self::INFINITY
    }
}

impl ComputedAngularInertia {
    /// Infinite inertia: the body cannot be rotated.
    pub const INFINITY: Self = Self { inverse: 0.0 };

    /// An inertia in kg·m²; 0 means infinite. Negative values and NaN panic in debug builds and give infinite
    /// inertia in release builds.
    pub fn new(angular_inertia: Scalar) -> Self {
        let result = Self::try_new(angular_inertia);
        debug_assert!(result.is_ok(), "an inertia is not negative and not NaN, this is {angular_inertia}");
        result.unwrap_or(Self::INFINITY)
    }

    /// An inertia in kg·m²; 0 means infinite. Negative values and NaN are errors.
    pub fn try_new(angular_inertia: Scalar) -> Result<Self, AngularInertiaError> {
        check(angular_inertia).map(|()| Self { inverse: angular_inertia.recip_or_zero() })
    }

    /// An inertia from its inverse in 1/(kg·m²). Negative values and NaN panic in debug builds and give
    /// infinite inertia in release builds.
    pub fn from_inverse(inverse_angular_inertia: Scalar) -> Self {
        let result = Self::try_from_inverse(inverse_angular_inertia);
        debug_assert!(result.is_ok(), "an inverse inertia is not negative and not NaN");
        result.unwrap_or(Self::INFINITY)
    }

    /// An inertia from its inverse in 1/(kg·m²). Negative values and NaN are errors.
    pub fn try_from_inverse(inverse_angular_inertia: Scalar) -> Result<Self, AngularInertiaError> {
        check(inverse_angular_inertia).map(|()| Self { inverse: inverse_angular_inertia })
    }

    /// The inertia in kg·m², 0 if infinite.
    pub fn value(self) -> Scalar {
        self.inverse.recip_or_zero()
    }

    /// 1 / inertia in 1/(kg·m²), 0 if infinite.
    pub fn inverse(self) -> Scalar {
        self.inverse
    }

    /// The inverse, to be written. It must stay non-negative.
    pub fn inverse_mut(&mut self) -> &mut Scalar {
        &mut self.inverse
    }

    /// Replaces the inertia.
    pub fn set(&mut self, angular_inertia: impl Into<ComputedAngularInertia>) {
        *self = angular_inertia.into();
    }

    /// The inertia of a body of `mass` kg about an axis at `offset` metres from its centre of mass, by the
    /// parallel axis theorem: I + m d². If the inertia is infinite, the result is 0, which means infinite.
    pub fn shifted(&self, mass: Scalar, offset: Vector) -> Scalar {
        if self.is_infinite() { 0.0 } else { self.value() + mass * offset.length_squared() }
    }

    /// The inverse of [`shifted`](Self::shifted).
    pub fn shifted_inverse(&self, mass: Scalar, offset: Vector) -> Scalar {
        self.shifted(mass, offset).recip_or_zero()
    }

    /// Whether the inertia is neither infinite nor NaN.
    pub fn is_finite(self) -> bool {
        !self.is_infinite() && !self.is_nan()
    }

    /// Whether the body cannot be rotated by contacts and forces.
    pub fn is_infinite(self) -> bool {
        self.value() == 0.0 && !self.is_nan()
    }

    /// Whether the inertia is NaN. No constructor makes such an inertia.
    pub fn is_nan(self) -> bool {
        self.inverse.is_nan()
    }
}

fn check(value: Scalar) -> Result<(), AngularInertiaError> {
    if value.is_nan() {
        Err(AngularInertiaError::NaN)
    } else if value < 0.0 {
        Err(AngularInertiaError::Negative)
    } else {
        Ok(())
    }
}

impl From<Scalar> for ComputedAngularInertia {
    fn from(angular_inertia: Scalar) -> Self {
        Self::new(angular_inertia)
    }
}

impl From<AngularInertia> for ComputedAngularInertia {
    fn from(angular_inertia: AngularInertia) -> Self {
        Self::new(angular_inertia.0.adjust_precision())
    }
}

impl From<ComputedAngularInertia> for AngularInertia {
    fn from(angular_inertia: ComputedAngularInertia) -> Self {
        Self(angular_inertia.value() as f32)
    }
}

impl From<&MassProperties> for AngularInertia {
    fn from(properties: &MassProperties) -> Self {
        Self(properties.angular_inertia)
    }
}

impl core::ops::Mul<Scalar> for ComputedAngularInertia {
    type Output = Scalar;
    fn mul(self, factor: Scalar) -> Scalar {
        self.value() * factor
    }
}

impl core::ops::Mul<Vector> for ComputedAngularInertia {
    type Output = Vector;
    fn mul(self, factor: Vector) -> Vector {
        factor * self.value()
    }
}

impl CenterOfMass {
    /// Makes a centre of mass from its coordinates in metres.
    pub const fn new(x: f32, y: f32) -> Self {
        Self(Vec2::new(x, y))
    }
}

impl ComputedCenterOfMass {
    /// Makes a centre of mass from its coordinates in metres.
    pub const fn new(x: Scalar, y: Scalar) -> Self {
        Self(Vector::new(x, y))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_inertia_keeps_its_value_and_inverse() {
        let inertia = ComputedAngularInertia::new(4.0);
        assert_eq!((inertia.value(), inertia.inverse()), (4.0, 0.25));
        assert!(inertia.is_finite() && !inertia.is_infinite() && !inertia.is_nan());
        assert_eq!(ComputedAngularInertia::from_inverse(0.25), inertia);
        assert_eq!(AngularInertia::from(inertia), AngularInertia(4.0));
        assert_eq!(inertia * 0.5, 2.0);
        assert_eq!(inertia * Vector::X, Vector::new(4.0, 0.0));
        let mut other = ComputedAngularInertia::default();
        other.set(AngularInertia(4.0));
        assert_eq!(other, inertia);
        *other.inverse_mut() = 0.5;
        assert_eq!(other.value(), 2.0);
    }

    #[test]
    fn zero_and_infinity_are_infinite() {
        for value in [0.0, Scalar::INFINITY] {
            let inertia = ComputedAngularInertia::new(value);
            assert_eq!(inertia, ComputedAngularInertia::INFINITY);
            assert!(inertia.is_infinite() && !inertia.is_finite());
            assert_eq!(inertia.value(), 0.0);
            assert_eq!(inertia.shifted_inverse(3.0, Vector::X), 0.0);
        }
    }

    #[test]
    fn what_is_no_inertia_is_an_error() {
        assert_eq!(ComputedAngularInertia::try_new(-1.0), Err(AngularInertiaError::Negative));
        assert_eq!(ComputedAngularInertia::try_new(Scalar::NAN), Err(AngularInertiaError::NaN));
        assert_eq!(ComputedAngularInertia::try_from_inverse(-1.0), Err(AngularInertiaError::Negative));
        assert_eq!(ComputedAngularInertia::try_from_inverse(Scalar::NAN), Err(AngularInertiaError::NaN));
    }

    #[test]
    fn shifting_follows_the_parallel_axis_theorem() {
        assert_eq!(AngularInertia(4.0).shifted(2.0, Vec2::new(3.0, 4.0)), 54.0);
        assert_eq!(ComputedAngularInertia::new(4.0).shifted(2.0, Vector::new(3.0, 4.0)), 54.0);
        assert_eq!(ComputedAngularInertia::new(4.0).shifted_inverse(2.0, Vector::new(0.0, 1.0)), 1.0 / 6.0);
    }
}
