//! Inertia of bodies within a step in 3D. `dim2.rs` exports the same names.

use kernel::math::AxisLocks;

use crate::{
    dynamics::rigid_body::mass_properties::components::ComputedAngularInertia,
    math::{MatExt, Scalar, SymmetricTensor, inv_inertia_from_kernel, inv_inertia_to_kernel},
};

/// An inverse inertia in world axes, zero about locked axes.
pub(super) fn locked_inertia(inverse: SymmetricTensor, locks: AxisLocks) -> SymmetricTensor {
    if locks.rotation() == 0 {
        return inverse;
    }
    inv_inertia_from_kernel(inv_inertia_to_kernel(inverse).locked(locks))
}

/// Whether the gyroscopic torque changes the rotation axis: the inertia is not equal about all axes.
pub(super) fn is_gyroscopic(inertia: &ComputedAngularInertia) -> bool {
    let inverse = inertia.inverse();
    let largest = inverse.m00.abs().max(inverse.m11.abs()).max(inverse.m22.abs());
    !inverse.is_isotropic(largest * Scalar::EPSILON * 16.0)
}
