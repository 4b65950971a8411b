//! Gyroscopic torque: what keeps the angular momentum of a spinning body that is not a ball.
//! `gyro2.rs` exports the same names.

use crate::math::{Angular, InvInertia, Rot, Vector};

/// Whether the three moments are equal (within 1 ‰) and the tensor diagonal, so that ω × I ω vanishes.
pub(super) fn is_isotropic(i: InvInertia) -> bool {
    let size = i.xx.abs();
    let near = |a: f32| a.abs() <= 1.0e-3 * size;
    near(i.yy - i.xx) && near(i.zz - i.xx) && near(i.xy) && near(i.xz) && near(i.yz)
}

/// The angular velocity after `h` seconds of free spin, by one Newton step of the implicit equation
/// I (ω' − ω) + h ω' × I ω' = 0 in the body's frame (Catto, "Numerical Methods", GDC 2015).
pub(super) fn gyroscopic(w: Angular, rotation: Rot, inv_inertia: InvInertia, h: f32) -> Angular {
    // The inertia tensor itself; a body that some axis cannot turn about spins as it is.
    let inertia = inv_inertia.inverse();
    if inertia == InvInertia::ZERO {
        return w;
    }
    let local = rotation.inverse_rotate(w);
    let momentum = inertia.apply(local);
    let residual = local.cross(momentum) * h;
    // The Jacobian I + h ([ω]× I − [I ω]×), by its columns.
    let column =
        |axis: Vector| inertia.apply(axis) + (local.cross(inertia.apply(axis)) - momentum.cross(axis)) * h;
    let (x, y, z) = (column(Vector::X), column(Vector::Y), column(Vector::Z));
    let determinant = x.dot(y.cross(z));
    if !(determinant.abs() > 0.0) {
        return w;
    }
    // Cramer's rule for J δ = residual.
    let k = 1.0 / determinant;
    let change = Vector {
        x: residual.dot(y.cross(z)) * k,
        y: x.dot(residual.cross(z)) * k,
        z: x.dot(y.cross(residual)) * k,
    };
    rotation.rotate(local - change)
}

/// The componentwise product.
pub(super) fn scale_angular(w: Angular, factors: Angular) -> Angular {
    w.scale(factors)
}

/// A body's rotation now.
pub(super) fn world_rotation(delta: Rot, start: Rot) -> Rot {
    delta.mul(start)
}

/// A turn about x… by an angle in radians.
#[cfg(test)]
pub(super) fn spin(angle: f32) -> Angular {
    Vector::Z * angle
}
