//! What a test must know of space.

use crate::kernel::math::{Angular, InvInertia, Rot, Vector};
use crate::kernel::shape::MassProperties;

/// The inverse inertia of a body.
pub fn inverse_inertia(mass: &MassProperties) -> InvInertia {
    mass.inertia.inverse()
}

/// The rotation by an angle in the plane of x and y.
pub fn turned(angle: f32) -> Rot {
    Rot::from_axis_angle(Vector::Z, angle)
}

/// The part of an angular velocity in the plane of x and y.
pub fn spin_of(w: Angular) -> f32 {
    w.z
}

/// A box of the given size.
pub fn sized(x: f32, y: f32, depth: f32) -> Vector {
    Vector { x, y, z: depth }
}

/// The moment of inertia of a solid ball over m r².
pub const BALL_INERTIA: f32 = 0.4;

/// The kinetic energy of turning.
pub fn spin_energy(inverse: InvInertia, rotation: Rot, w: Angular) -> f64 {
    let local = rotation.inverse_rotate(w);
    0.5 * f64::from(local.dot(inverse.inverse().apply(local)))
}
