//! Type aliases of 3D, and conversions to and from the kernel's types. `dim2.rs` exports the same names.

use bevy_math::{Dir3, Ray3d, Vec3};
use kernel::math as k;

use super::{AsF32, Matrix3, Scalar, SymmetricMatrix3, Vector3};

/// The number of spatial dimensions.
pub const DIM: usize = 3;
/// A vector of the crate's dimension, in [`Scalar`] precision.
pub type Vector = Vector3;
/// A square matrix of the crate's dimension, in [`Scalar`] precision.
pub type Matrix = Matrix3;
/// A symmetric matrix of the crate's dimension, in [`Scalar`] precision.
pub type SymmetricMatrix = SymmetricMatrix3;
/// A direction of unit length.
pub type Dir = Dir3;

/// A ray in `f32`.
pub(crate) type Ray = Ray3d;
/// A rotation in queries.
#[cfg(feature = "default-collider")]
pub(crate) type RotationValue = super::Quaternion;
/// An angular velocity, torque or moment.
pub(crate) type AngularVector = Vector;
/// No angular velocity.
pub(crate) const NO_SPIN: AngularVector = Vector::ZERO;
/// The inverse of an infinite angular inertia.
pub(crate) const NO_INERTIA: SymmetricTensor = SymmetricTensor::ZERO;
/// A vector in the tangent space of a normal.
pub(crate) type TangentVector = super::Vector2;
/// An angular inertia.
pub(crate) type SymmetricTensor = SymmetricMatrix3;
/// A vector in `f32`, independent of the public precision.
pub(crate) type VectorF32 = Vec3;
pub(crate) use bevy_heavy::{
    ComputeMassProperties3d as ComputeMassProperties, MassProperties3d as MassProperties,
};

/// The matrix of the cross product with `v`: `skew_symmetric_mat3(v) * w = v × w`.
#[inline]
pub fn skew_symmetric_mat3(v: Vector3) -> Matrix3 {
    Matrix3::from_cols(
        Vector3::new(0.0, v.z, -v.y),
        Vector3::new(-v.z, 0.0, v.x),
        Vector3::new(v.y, -v.x, 0.0),
    )
}

/// The spatial part of a point.
#[inline]
pub(crate) fn vector_from_xyz([x, y, z]: [f64; 3]) -> Vector {
    Vector::new(x as Scalar, y as Scalar, z as Scalar)
}

/// A position for the kernel, in full precision.
#[inline]
pub(crate) fn world_to_kernel(v: Vector) -> k::WorldVector {
    k::Vector { x: v.x, y: v.y, z: v.z }
}

/// A position from the kernel, in full precision.
#[inline]
pub(crate) fn world_from_kernel(v: k::WorldVector) -> Vector {
    Vector { x: v.x, y: v.y, z: v.z }
}

/// A velocity or other vector that is not a position, narrowed for the kernel.
#[inline]
pub(crate) fn vector_to_kernel(v: Vector) -> k::Vector {
    world_to_kernel(v).to_local()
}

/// A velocity or other vector that is not a position, widened to the public precision.
#[inline]
pub(crate) fn vector_from_kernel(v: k::Vector) -> Vector {
    world_from_kernel(v.to_world())
}

/// An angular velocity or torque, narrowed for the kernel.
#[inline]
pub(crate) fn angular_to_kernel(v: AngularVector) -> k::Angular {
    vector_to_kernel(v)
}

/// An angular velocity or torque, widened to the public precision.
#[inline]
pub(crate) fn angular_from_kernel(v: k::Angular) -> AngularVector {
    vector_from_kernel(v)
}

/// An inverse angular inertia, narrowed for the kernel.
#[inline]
pub(crate) fn inv_inertia_to_kernel(inverse: SymmetricTensor) -> k::InvInertia {
    let m = inverse.f32();
    k::InvInertia { xx: m.m00, yy: m.m11, zz: m.m22, xy: m.m01, xz: m.m02, yz: m.m12 }
}

/// An inverse angular inertia, widened to the public precision.
#[inline]
pub(crate) fn inv_inertia_from_kernel(inverse: k::InvInertia) -> SymmetricTensor {
    let k::InvInertia { xx, yy, zz, xy, xz, yz } = inverse;
    let [m00, m11, m22, m01, m02, m12] = [xx, yy, zz, xy, xz, yz].map(Scalar::from);
    SymmetricTensor { m00, m01, m02, m11, m12, m22 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_skew_matrix_is_the_cross_product() {
        let (v, w) = (Vector3::new(1.0, 2.0, 3.0), Vector3::new(-4.0, 0.5, 2.0));
        assert_eq!(skew_symmetric_mat3(v) * w, v.cross(w));
    }

    #[test]
    fn the_kernel_gives_back_what_it_got() {
        let v = Vector::new(1.5, -2.0, 8.0);
        assert_eq!(world_from_kernel(world_to_kernel(v)), v);
        assert_eq!(vector_from_kernel(vector_to_kernel(v)), v);
        assert_eq!(angular_from_kernel(angular_to_kernel(v)), v);
        let m = SymmetricTensor::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
        // The kernel's product equals the matrix product.
        let applied = inv_inertia_to_kernel(m).apply(vector_to_kernel(v));
        assert_eq!(vector_from_kernel(applied), m * v);
    }
}
