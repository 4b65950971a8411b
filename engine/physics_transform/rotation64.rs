//! 3D rotations in `f64` scalars. [`frame`](super::frame) explains the reason.

use bevy_math::Quat;

use crate::math::Scalar;

/// Widens to `f64`.
#[inline(always)]
#[allow(clippy::useless_conversion, reason = "Scalar may be f32 or f64")]
pub(crate) fn wide(value: Scalar) -> f64 {
    f64::from(value)
}

/// Narrows to the scalar.
#[inline(always)]
pub(crate) fn narrow(value: f64) -> Scalar {
    value as Scalar
}

/// A rotation in `f64`, as a quaternion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rotation64 {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) z: f64,
    pub(crate) w: f64,
}

/// A matrix by its columns.
pub(super) type Columns = [[f64; 3]; 3];

impl Rotation64 {
    pub(crate) const IDENTITY: Self = Self { x: 0.0, y: 0.0, z: 0.0, w: 1.0 };

    pub(crate) fn from_quat(q: Quat) -> Self {
        let [x, y, z, w] = q.to_array();
        Self { x: f64::from(x), y: f64::from(y), z: f64::from(z), w: f64::from(w) }
    }

    pub(crate) fn to_quat(self) -> Quat {
        Quat::from_xyzw(self.x as f32, self.y as f32, self.z as f32, self.w as f32)
    }

    /// The product: `other` first, then `self`. Not renormalised.
    pub(crate) fn mul(self, o: Self) -> Self {
        Self {
            x: self.w * o.x + self.x * o.w + (self.y * o.z - self.z * o.y),
            y: self.w * o.y + self.y * o.w + (self.z * o.x - self.x * o.z),
            z: self.w * o.z + self.z * o.w + (self.x * o.y - self.y * o.x),
            w: self.w * o.w - (self.x * o.x + self.y * o.y + self.z * o.z),
        }
    }

    pub(crate) fn inverse(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z, w: self.w }
    }

    pub(crate) fn dot(self, o: Self) -> f64 {
        self.x * o.x + self.y * o.y + self.z * o.z + self.w * o.w
    }

    /// Normalised to length 1; the identity if the length is zero or not finite.
    pub(crate) fn normalized(self) -> Self {
        let length = self.dot(self).sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return Self::IDENTITY;
        }
        Self { x: self.x / length, y: self.y / length, z: self.z / length, w: self.w / length }
    }

    /// Rotates a vector: `v + w t + u × t` with `t = 2 u × v`.
    pub(crate) fn rotate(self, v: [f64; 3]) -> [f64; 3] {
        let u = [self.x, self.y, self.z];
        let t = cross(u, v).map(|c| 2.0 * c);
        let ut = cross(u, t);
        [0, 1, 2].map(|i| v[i] + self.w * t[i] + ut[i])
    }

    pub(super) fn columns(self) -> Columns {
        [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(|axis| self.rotate(axis))
    }

    /// The rotation with these orthonormal columns (Shepperd, "Quaternion from Rotation Matrix", 1978). The
    /// largest of the four numbers is computed first, which avoids cancellation.
    pub(super) fn from_columns([x, y, z]: Columns) -> Self {
        let trace = x[0] + y[1] + z[2];
        let turn = if trace > 0.0 {
            Self { x: y[2] - z[1], y: z[0] - x[2], z: x[1] - y[0], w: 1.0 + trace }
        } else if x[0] >= y[1] && x[0] >= z[2] {
            Self { x: 1.0 + x[0] - y[1] - z[2], y: x[1] + y[0], z: z[0] + x[2], w: y[2] - z[1] }
        } else if y[1] >= z[2] {
            Self { x: x[1] + y[0], y: 1.0 - x[0] + y[1] - z[2], z: y[2] + z[1], w: z[0] - x[2] }
        } else {
            Self { x: z[0] + x[2], y: y[2] + z[1], z: 1.0 - x[0] - y[1] + z[2], w: x[1] - y[0] }
        };
        turn.normalized()
    }
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
