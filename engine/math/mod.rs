//! Numeric types of the public API: aliases for precision and dimension, conversions between precisions and
//! to the kernel's types, and matrix operations that glam lacks.
//!
//! ```
//! # use avian::math::*;
//! // Written once, this is an f32 or an f64, in the plane or in space.
//! let speed: Scalar = Vector::splat(3.0).length() * FRAC_1_SQRT_2;
//! assert!(speed > 2.9);
//! assert_eq!(1.5_f64.adjust_precision(), 1.5 as Scalar);
//! ```

#[cfg_attr(feature = "2d", path = "basis2.rs")]
#[cfg_attr(feature = "3d", path = "basis3.rs")]
mod basis;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
#[cfg(feature = "f64")]
mod double;
#[cfg(feature = "f32")]
mod single;

pub use basis::*;
pub use dim::*;
#[cfg(feature = "f64")]
pub use double::*;
#[cfg(feature = "f32")]
pub use single::*;

use bevy_math::{DMat2, DMat3, DQuat, DVec2, DVec3, Mat2, Mat3, Quat, Vec2, Vec3, Vec4};
use glam_matrix_extras::{SymmetricDMat2, SymmetricDMat3, SymmetricMat2, SymmetricMat3};

/// A scalar narrowed for the kernel.
#[inline(always)]
pub(crate) fn to_f32(value: Scalar) -> f32 {
    value as f32
}

/// Converts a value of either precision to [`Scalar`] precision.
pub trait AdjustPrecision {
    /// The same kind of value in [`Scalar`] precision.
    type Adjusted;
    /// The value in [`Scalar`] precision, rounded to nearest if that is the lower precision.
    fn adjust_precision(&self) -> Self::Adjusted;
}

/// Converts a value of either precision to `f32`, for rendering and Bevy's transforms.
pub trait AsF32 {
    /// The same kind of value in `f32`.
    type F32;
    /// The value in `f32`, rounded to nearest.
    fn f32(&self) -> Self::F32;
}

/// Implements [`AsF32`] for a type and its `f64` counterpart.
macro_rules! as_f32 {
    ($($single:ty, $double:ty, $narrow:ident;)+) => {$(
        impl AsF32 for $single {
            type F32 = Self;
            #[inline]
            fn f32(&self) -> Self {
                *self
            }
        }
        impl AsF32 for $double {
            type F32 = $single;
            #[inline]
            fn f32(&self) -> $single {
                self.$narrow()
            }
        }
    )+};
}

as_f32! {
    Vec2, DVec2, as_vec2;
    Vec3, DVec3, as_vec3;
    Quat, DQuat, as_quat;
    Mat2, DMat2, as_mat2;
    Mat3, DMat3, as_mat3;
    SymmetricMat2, SymmetricDMat2, as_symmetric_mat2;
    SymmetricMat3, SymmetricDMat3, as_symmetric_mat3;
}

impl AsF32 for Vec4 {
    type F32 = Self;
    #[inline]
    fn f32(&self) -> Self {
        *self
    }
}

/// The reciprocal of a quantity whose infinity is stored as zero, such as an inverse mass.
pub trait RecipOrZero {
    /// `1 / self`, or zero if the result is not finite: for zero, infinity, NaN, and numbers too small to
    /// invert. Applied per component for vectors.
    #[must_use]
    fn recip_or_zero(self) -> Self;
}

macro_rules! recip_or_zero {
    ($($scalar:ty),+; $($vector:ty { $($field:ident),+ }),+) => {
        $(impl RecipOrZero for $scalar {
            #[inline]
            fn recip_or_zero(self) -> Self {
                // A division instead of `recip` gives the same bits everywhere.
                let inverse = 1.0 / self;
                if inverse.is_finite() { inverse } else { 0.0 }
            }
        })+
        $(impl RecipOrZero for $vector {
            #[inline]
            fn recip_or_zero(self) -> Self {
                Self { $($field: self.$field.recip_or_zero()),+ }
            }
        })+
    };
}

recip_or_zero! { f32, f64; Vec2 { x, y }, DVec2 { x, y }, Vec3 { x, y, z }, DVec3 { x, y, z } }

/// Operations of square matrices for inertia tensors.
pub trait MatExt {
    /// The type of the entries.
    type Scalar;
    /// The inverse, or the zero matrix if there is no inverse: for a singular matrix, or a matrix with
    /// infinite or NaN entries.
    #[must_use]
    fn inverse_or_zero(self) -> Self;
    /// Whether the matrix is a multiple of the identity: all entries off the diagonal, and all differences on
    /// the diagonal, are at most `epsilon`.
    fn is_isotropic(&self, epsilon: Self::Scalar) -> bool;
}

macro_rules! mat_ext {
    ($($scalar:ident, $mat2:ident, $mat3:ident, $symmetric2:ident, $symmetric3:ident;)+) => {$(
        impl MatExt for $mat2 {
            type Scalar = $scalar;
            #[inline]
            fn inverse_or_zero(self) -> Self {
                let (x, y) = (self.x_axis, self.y_axis);
                let inverse = (x.x * y.y - y.x * x.y).recip_or_zero();
                Self::from_cols_array(&[y.y * inverse, -x.y * inverse, -y.x * inverse, x.x * inverse])
            }
            #[inline]
            fn is_isotropic(&self, epsilon: $scalar) -> bool {
                let (x, y) = (self.x_axis, self.y_axis);
                (x.x - y.y).abs() <= epsilon && x.y.abs() <= epsilon && y.x.abs() <= epsilon
            }
        }

        impl MatExt for $mat3 {
            type Scalar = $scalar;
            #[inline]
            fn inverse_or_zero(self) -> Self {
                // Rows of the inverse are the cross products of the columns over the determinant.
                let (x, y, z) = (self.x_axis, self.y_axis, self.z_axis);
                let (a, b, c) = (y.cross(z), z.cross(x), x.cross(y));
                let inverse = x.dot(a).recip_or_zero();
                Self::from_cols(a * inverse, b * inverse, c * inverse).transpose()
            }
            #[inline]
            fn is_isotropic(&self, epsilon: $scalar) -> bool {
                let (x, y, z) = (self.x_axis, self.y_axis, self.z_axis);
                let small = |v: $scalar| v.abs() <= epsilon;
                small(x.x - y.y) && small(y.y - z.z) && small(x.x - z.z)
                    && [x.y, x.z, y.x, y.z, z.x, z.y].into_iter().all(small)
            }
        }

        impl MatExt for $symmetric2 {
            type Scalar = $scalar;
            #[inline]
            fn inverse_or_zero(self) -> Self {
                let inverse = (self.m00 * self.m11 - self.m01 * self.m01).recip_or_zero();
                Self::new(self.m11 * inverse, -self.m01 * inverse, self.m00 * inverse)
            }
            #[inline]
            fn is_isotropic(&self, epsilon: $scalar) -> bool {
                (self.m00 - self.m11).abs() <= epsilon && self.m01.abs() <= epsilon
            }
        }

        impl MatExt for $symmetric3 {
            type Scalar = $scalar;
            #[inline]
            fn inverse_or_zero(self) -> Self {
                // The adjugate over the determinant.
                let Self { m00, m01, m02, m11, m12, m22 } = self;
                let (a, b, c) = (m11 * m22 - m12 * m12, m02 * m12 - m01 * m22, m01 * m12 - m02 * m11);
                let inverse = (m00 * a + m01 * b + m02 * c).recip_or_zero();
                Self::new(
                    a * inverse,
                    b * inverse,
                    c * inverse,
                    (m00 * m22 - m02 * m02) * inverse,
                    (m01 * m02 - m00 * m12) * inverse,
                    (m00 * m11 - m01 * m01) * inverse,
                )
            }
            #[inline]
            fn is_isotropic(&self, epsilon: $scalar) -> bool {
                let small = |v: $scalar| v.abs() <= epsilon;
                small(self.m00 - self.m11) && small(self.m11 - self.m22) && small(self.m00 - self.m22)
                    && small(self.m01) && small(self.m02) && small(self.m12)
            }
        }
    )+};
}

mat_ext! {
    f32, Mat2, Mat3, SymmetricMat2, SymmetricMat3;
    f64, DMat2, DMat3, SymmetricDMat2, SymmetricDMat3;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_has_no_reciprocal_gives_zero() {
        assert_eq!(4.0_f32.recip_or_zero(), 0.25);
        for v in [0.0_f32, -0.0, f32::INFINITY, f32::NEG_INFINITY, f32::NAN, 1e-45] {
            assert_eq!(v.recip_or_zero(), 0.0, "{v}");
        }
        assert_eq!(DVec3::new(0.0, 2.0, f64::NAN).recip_or_zero(), DVec3::new(0.0, 0.5, 0.0));
    }

    #[test]
    fn a_matrix_times_its_inverse_is_one() {
        let m = SymmetricDMat3::new(4.0, 1.0, -0.5, 3.0, 0.25, 5.0);
        assert!((m.to_mat3() * MatExt::inverse_or_zero(m).to_mat3()).abs_diff_eq(DMat3::IDENTITY, 1e-14));
        let m = DMat3::from_cols_array(&[1.0, 2.0, 3.0, 0.0, 1.0, 4.0, 5.0, 6.0, 0.0]);
        assert!((m * MatExt::inverse_or_zero(m)).abs_diff_eq(DMat3::IDENTITY, 1e-13));
        let m = Mat2::from_cols_array(&[1.0, 2.0, 3.0, 5.0]);
        assert_eq!(m * MatExt::inverse_or_zero(m), Mat2::IDENTITY);
        let m = SymmetricMat2::new(2.0, 1.0, 4.0);
        assert!((m.to_mat2() * MatExt::inverse_or_zero(m).to_mat2()).abs_diff_eq(Mat2::IDENTITY, 1e-6));
    }

    #[test]
    fn a_singular_matrix_inverts_to_zero() {
        assert_eq!(MatExt::inverse_or_zero(SymmetricMat3::ZERO), SymmetricMat3::ZERO);
        assert_eq!(MatExt::inverse_or_zero(Mat3::from_diagonal(Vec3::new(1.0, 0.0, 2.0))), Mat3::ZERO);
        assert_eq!(MatExt::inverse_or_zero(SymmetricDMat2::new(1.0, 1.0, 1.0)), SymmetricDMat2::ZERO);
    }

    #[test]
    fn only_multiples_of_the_identity_are_isotropic() {
        assert!(SymmetricMat3::from_diagonal(Vec3::splat(7.0)).is_isotropic(0.0));
        assert!(!SymmetricMat3::from_diagonal(Vec3::new(7.0, 7.0, 7.1)).is_isotropic(0.01));
        assert!(!Mat2::from_cols_array(&[1.0, 0.0, 0.5, 1.0]).is_isotropic(0.1));
        assert!(!DMat3::from_diagonal(DVec3::NAN).is_isotropic(1.0));
    }

    #[test]
    fn precision_goes_both_ways() {
        assert_eq!(Vec3::new(0.5, 1.0, 2.0).adjust_precision().f32(), Vec3::new(0.5, 1.0, 2.0));
        assert_eq!(DQuat::IDENTITY.adjust_precision().f32(), Quat::IDENTITY);
        let m = SymmetricDMat3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
        assert_eq!(m.f32(), SymmetricMat3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0));
    }
}
