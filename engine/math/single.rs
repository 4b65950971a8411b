//! `f32` as the precision of the public API: the scalar, the vectors and matrices, and the conversions to it.

use bevy_math::{DMat3, DQuat, DVec2, DVec3, Mat3, Quat, Vec2, Vec3};
use glam_matrix_extras::{SymmetricDMat2, SymmetricDMat3, SymmetricMat2, SymmetricMat3};

use super::AdjustPrecision;

/// The floating-point type of positions, velocities and all other public quantities without a precision in
/// their name: `f32` with the feature `f32`, `f64` with the feature `f64`.
pub type Scalar = f32;
/// π / 2.
pub const FRAC_PI_2: Scalar = core::f32::consts::FRAC_PI_2;
/// π.
pub const PI: Scalar = core::f32::consts::PI;
/// 2 π, a full turn in radians.
pub const TAU: Scalar = core::f32::consts::TAU;
/// 1 / √2.
pub const FRAC_1_SQRT_2: Scalar = core::f32::consts::FRAC_1_SQRT_2;

/// A 2D vector in [`Scalar`] precision.
pub type Vector2 = Vec2;
/// A 3D vector in [`Scalar`] precision.
pub type Vector3 = Vec3;
/// A 2 × 2 matrix in [`Scalar`] precision.
pub type Matrix2 = bevy_math::Mat2;
/// A 3 × 3 matrix in [`Scalar`] precision.
pub type Matrix3 = Mat3;
/// A symmetric 2 × 2 matrix in [`Scalar`] precision.
pub type SymmetricMatrix2 = SymmetricMat2;
/// A symmetric 3 × 3 matrix in [`Scalar`] precision.
pub type SymmetricMatrix3 = SymmetricMat3;
/// A quaternion in [`Scalar`] precision.
pub type Quaternion = Quat;

/// Implements [`AdjustPrecision`] with one expression per source type.
macro_rules! adjust_precision {
    ($($source:ty => $adjusted:ty: |$value:ident| $conversion:expr;)+) => {$(
        impl AdjustPrecision for $source {
            type Adjusted = $adjusted;
            #[inline]
            fn adjust_precision(&self) -> $adjusted {
                let $value = *self;
                $conversion
            }
        }
    )+};
}

adjust_precision! {
    f32 => Scalar: |v| v;
    f64 => Scalar: |v| v as f32;
    Vec3 => Vector3: |v| v;
    DVec3 => Vector3: |v| v.as_vec3();
    Vec2 => Vector2: |v| v;
    DVec2 => Vector2: |v| v.as_vec2();
    Quat => Quaternion: |v| v;
    DQuat => Quaternion: |v| v.as_quat();
    Mat3 => Matrix3: |v| v;
    DMat3 => Matrix3: |v| v.as_mat3();
    SymmetricMat2 => SymmetricMatrix2: |v| v;
    SymmetricDMat2 => SymmetricMatrix2: |v| v.as_symmetric_mat2();
    SymmetricMat3 => SymmetricMatrix3: |v| v;
    SymmetricDMat3 => SymmetricMatrix3: |v| v.as_symmetric_mat3();
}
