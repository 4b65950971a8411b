//! Inertia of bodies within a step in 2D. `dim3.rs` exports the same names.

use kernel::math::AxisLocks;

use crate::{
    dynamics::rigid_body::mass_properties::components::ComputedAngularInertia, math::SymmetricTensor,
};

/// An inverse inertia, zero where rotation is locked.
pub(super) fn locked_inertia(inverse: SymmetricTensor, locks: AxisLocks) -> SymmetricTensor {
    if locks.rotation() == 0 { inverse } else { 0.0 }
}

/// Whether the gyroscopic torque changes the rotation axis. Never in 2D.
pub(super) fn is_gyroscopic(_inertia: &ComputedAngularInertia) -> bool {
    false
}
