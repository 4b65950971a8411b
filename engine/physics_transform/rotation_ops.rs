//! Operations of rotations that are the same in both dimensions: products, conversions from
//! transforms, easing.

use bevy_math::curve::{FunctionCurve, Interval, easing::Ease};
use bevy_transform::components::{GlobalTransform, Transform};
use core::ops::{Mul, MulAssign};

use super::Rotation;
use crate::math::{AdjustPrecision, AsF32, Dir, Scalar, Vector};

by_reference!(Rotation, Vector => Vector, |rotation, v| rotation.rotate_vector(v));
by_reference!(Rotation, Dir => Dir, |rotation, direction| {
    // The direction is normalised, since the rotation may deviate from unit length. For a rotation that is
    // zero or NaN the direction is returned unchanged.
    let v: Vector = direction.adjust_precision();
    Dir::new(rotation.rotate_vector(v).f32()).unwrap_or(direction)
});

impl Mul for Rotation {
    type Output = Self;
    /// The product: `other` first, then `self`. Renormalised.
    fn mul(self, other: Self) -> Self {
        self.then_of(other)
    }
}

impl MulAssign for Rotation {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl From<Transform> for Rotation {
    fn from(transform: Transform) -> Self {
        Self::from(transform.rotation)
    }
}

impl From<GlobalTransform> for Rotation {
    fn from(transform: GlobalTransform) -> Self {
        Self::from(&transform)
    }
}

impl From<&GlobalTransform> for Rotation {
    fn from(transform: &GlobalTransform) -> Self {
        Self::from(transform.rotation())
    }
}

impl Ease for Rotation {
    fn interpolating_curve_unbounded(start: Self, end: Self) -> impl bevy_math::Curve<Self> {
        FunctionCurve::new(Interval::EVERYWHERE, move |t: f32| start.slerp(end, Scalar::from(t)))
    }
}
