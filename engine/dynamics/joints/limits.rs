//! Limits of distances and angles.

use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::math::{Scalar, Vector};

/// Minimum and maximum value of a distance, or of a position along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, PartialEq)]
pub struct DistanceLimit {
    /// Minimum value, in metres.
    pub min: Scalar,
    /// Maximum value, in metres.
    pub max: Scalar,
}

crate::type_path::type_path!(DistanceLimit, "dynamics::joints");

impl DistanceLimit {
    /// A limit of exactly 0.
    pub const ZERO: Self = Self { min: 0.0, max: 0.0 };

    /// The limits `min` and `max`, in metres.
    pub const fn new(min: Scalar, max: Scalar) -> Self {
        Self { min, max }
    }

    /// The direction in which the second of two points must move to satisfy the limits, and the distance in
    /// metres. Both are zero within the limits.
    ///
    /// `separation` is the vector from the first point to the second.
    pub fn compute_correction(&self, separation: Vector) -> (Vector, Scalar) {
        let distance = separation.length();
        let excess = self.excess(distance);
        if excess == 0.0 || distance <= Scalar::EPSILON {
            return (Vector::ZERO, 0.0);
        }
        (separation * (-excess.signum() / distance), excess.abs())
    }

    /// The displacement of the second of two points along an axis of unit length that satisfies the limits,
    /// as a vector in metres.
    pub fn compute_correction_along_axis(&self, separation: Vector, axis: Vector) -> Vector {
        axis * -self.excess(separation.dot(axis))
    }

    /// The excess of a value over the limits: positive above them, negative below, zero within.
    fn excess(&self, value: Scalar) -> Scalar {
        excess(value, self.min, self.max)
    }
}

/// Minimum and maximum of an angle, in radians, counter-clockwise.
///
/// Angles are measured from the first body to the second. They may exceed a full turn: revolute joints count
/// turns.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, PartialEq)]
pub struct AngleLimit {
    /// Minimum angle, in radians.
    pub min: Scalar,
    /// Maximum angle, in radians.
    pub max: Scalar,
}

crate::type_path::type_path!(AngleLimit, "dynamics::joints");

impl AngleLimit {
    /// A limit of exactly 0.
    pub const ZERO: Self = Self { min: 0.0, max: 0.0 };

    /// The limits `min` and `max`, in radians.
    pub const fn new(min: Scalar, max: Scalar) -> Self {
        Self { min, max }
    }

    /// The excess of an angle over the limits: positive above them, negative below, zero within.
    pub(super) fn excess(&self, angle: Scalar) -> Scalar {
        excess(angle, self.min, self.max)
    }
}

fn excess(value: Scalar, min: Scalar, max: Scalar) -> Scalar {
    if value > max {
        value - max
    } else if value < min {
        value - min
    } else {
        0.0
    }
}

macro_rules! from_numbers {
    ($($limit:ident)+) => {$(
        impl From<Scalar> for $limit {
            /// Minimum and maximum both equal this value.
            fn from(value: Scalar) -> Self {
                Self::new(value, value)
            }
        }

        impl From<[Scalar; 2]> for $limit {
            fn from([min, max]: [Scalar; 2]) -> Self {
                Self::new(min, max)
            }
        }

        impl From<(Scalar, Scalar)> for $limit {
            fn from((min, max): (Scalar, Scalar)) -> Self {
                Self::new(min, max)
            }
        }
    )+};
}

from_numbers!(DistanceLimit AngleLimit);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corrections_lead_back_within_the_limits() {
        let limit = DistanceLimit::new(1.0, 2.0);
        for length in [0.25, 1.0, 1.5, 2.0, 5.0] {
            let separation = Vector::Y * length;
            let (direction, way) = limit.compute_correction(separation);
            let corrected = (separation + direction * way).length();
            assert!((corrected - length.clamp(1.0, 2.0)).abs() < 1e-5, "{length}: {corrected}");
            let along = separation + limit.compute_correction_along_axis(separation, Vector::Y);
            assert!((along.y - length.clamp(1.0, 2.0)).abs() < 1e-5, "{length}: {along}");
        }
        assert_eq!(limit.compute_correction(Vector::ZERO), (Vector::ZERO, 0.0), "no direction");
    }
}
