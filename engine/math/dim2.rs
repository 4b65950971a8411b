//! Type aliases of 2D, and conversions to and from the kernel's types. `dim3.rs` exports the same names.

use bevy_math::{Dir2, Ray2d, Vec2};
use kernel::math as k;

use super::{AdjustPrecision, Matrix2, Scalar, SymmetricMatrix2, Vector2};

/// The number of spatial dimensions.
pub const DIM: usize = 2;
/// A vector of the crate's dimension, in [`Scalar`] precision.
pub type Vector = Vector2;
/// A square matrix of the crate's dimension, in [`Scalar`] precision.
pub type Matrix = Matrix2;
/// A symmetric matrix of the crate's dimension, in [`Scalar`] precision.
pub type SymmetricMatrix = SymmetricMatrix2;
/// A direction of unit length.
pub type Dir = Dir2;

/// A ray in `f32`.
pub(crate) type Ray = Ray2d;
/// A rotation in queries: an angle in radians.
#[cfg(feature = "default-collider")]
pub(crate) type RotationValue = Scalar;
/// An angular velocity, torque or moment.
pub(crate) type AngularVector = Scalar;
/// No angular velocity.
pub(crate) const NO_SPIN: AngularVector = 0.0;
/// The inverse of an infinite angular inertia.
pub(crate) const NO_INERTIA: SymmetricTensor = 0.0;
/// A vector in the tangent space of a normal.
pub(crate) type TangentVector = Scalar;
/// An angular inertia.
pub(crate) type SymmetricTensor = Scalar;
/// A vector in `f32`, independent of the public precision.
pub(crate) type VectorF32 = Vec2;
pub(crate) use bevy_heavy::{
    ComputeMassProperties2d as ComputeMassProperties, MassProperties2d as MassProperties,
};

/// The spatial part of a point.
#[inline]
pub(crate) fn vector_from_xyz([x, y, _]: [f64; 3]) -> Vector {
    Vector::new(x as Scalar, y as Scalar)
}

/// A position for the kernel, in full precision.
#[inline]
pub(crate) fn world_to_kernel(v: Vector) -> k::WorldVector {
    k::Vector { x: v.x, y: v.y }
}

/// A position from the kernel, in full precision.
#[inline]
pub(crate) fn world_from_kernel(v: k::WorldVector) -> Vector {
    Vector { x: v.x, y: v.y }
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
    k::Angular { z: v as f32 }
}

/// An angular velocity or torque, widened to the public precision.
#[inline]
pub(crate) fn angular_from_kernel(v: k::Angular) -> AngularVector {
    v.z.adjust_precision()
}

/// An inverse angular inertia, narrowed for the kernel.
#[inline]
pub(crate) fn inv_inertia_to_kernel(inverse: SymmetricTensor) -> k::InvInertia {
    k::InvInertia { zz: inverse as f32 }
}

/// An inverse angular inertia, widened to the public precision.
#[inline]
pub(crate) fn inv_inertia_from_kernel(inverse: k::InvInertia) -> SymmetricTensor {
    inverse.zz.adjust_precision()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernel_gives_back_what_it_got() {
        let v = Vector::new(1.5, -2.0);
        assert_eq!(world_from_kernel(world_to_kernel(v)), v);
        assert_eq!(vector_from_kernel(vector_to_kernel(v)), v);
        assert_eq!(angular_from_kernel(angular_to_kernel(0.25)), 0.25);
    }
}
