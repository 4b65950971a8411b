//! Gyroscopic torque: zero in 2D. `gyro3.rs` exports the same names.

use crate::math::{Angular, InvInertia, Rot};

/// Inertia for free spin: unused in 2D.
#[derive(Clone, Copy, Debug)]
pub(super) struct Gyro;

impl Gyro {
    /// `None`: in 2D the spin axis is constant.
    pub(super) fn of(_inv_inertia: InvInertia) -> Option<Self> {
        None
    }

    /// Whether a body rotates so far that constraints need a correction: never in 2D.
    pub(super) fn turns_far(&self, _w: Angular, _h: f32) -> bool {
        false
    }

    /// The axis of the smallest moment: none in 2D.
    pub(super) fn thin_axis(&self, _rotation: Rot) -> Angular {
        Angular::ZERO
    }

    /// The rotational energy: unused in 2D.
    pub(super) fn energy(&self, _rotation: Rot, _w: Angular) -> f32 {
        0.0
    }
}

/// The componentwise product.
pub(super) fn scale_angular(w: Angular, factors: Angular) -> Angular {
    Angular { z: w.z * factors.z }
}

/// An angular velocity is the same in all frames in 2D.
pub(super) fn to_body(_rotation: Rot, w: Angular) -> Angular {
    w
}

/// An angular velocity is the same in all frames in 2D.
pub(super) fn to_world(_rotation: Rot, w: Angular) -> Angular {
    w
}

/// The current rotation of a body.
pub(super) fn world_rotation(delta: Rot, start: Rot) -> Rot {
    delta.mul(start)
}

/// The swing of an axis: none in 2D.
pub(super) fn swing_of(_axis: Angular, _turn: Rot) -> Rot {
    Rot::IDENTITY
}

/// A rotation by an angle in radians, as an [`Angular`].
#[cfg(test)]
pub(super) fn spin(angle: f32) -> Angular {
    Angular { z: angle }
}

/// An isotropic inverse inertia.
#[cfg(test)]
pub(super) fn round(inverse: f32) -> InvInertia {
    InvInertia { zz: inverse }
}
