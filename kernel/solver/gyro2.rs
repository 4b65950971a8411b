//! Gyroscopic torque: none in the plane. `gyro3.rs` exports the same names.

use crate::math::{Angular, InvInertia, Rot};

/// Whether turning does not change the spin axis: always in 2D.
pub(super) fn is_isotropic(_inv_inertia: InvInertia) -> bool {
    true
}

/// The angular velocity after `h` seconds of free spin: the same in 2D.
pub(super) fn gyroscopic(w: Angular, _rotation: Rot, _inv_inertia: InvInertia, _h: f32) -> Angular {
    w
}

/// The componentwise product.
pub(super) fn scale_angular(w: Angular, factors: Angular) -> Angular {
    Angular { z: w.z * factors.z }
}

/// A body's rotation now.
pub(super) fn world_rotation(delta: Rot, start: Rot) -> Rot {
    delta.mul(start)
}

/// A turn by an angle in radians.
#[cfg(test)]
pub(super) fn spin(angle: f32) -> Angular {
    Angular { z: angle }
}
