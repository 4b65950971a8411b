//! 3D rotations, and the 3D parts of the transform synchronisation. `dim2.rs` exports the same names.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::{component::Component, reflect::ReflectComponent};
use bevy_math::{DQuat, Quat};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use core::ops::Mul;

use super::{
    Position,
    rotation64::{Rotation64, narrow, wide},
};
use crate::math::{Quaternion, Scalar, Vector};

/// The world rotation of a rigid body or collider, as a unit quaternion.
///
/// Multiplication renormalises, which keeps products of many rotations valid. Products are computed in
/// scalars, so their bits do not depend on vector instructions.
#[derive(Reflect, Clone, Copy, Component, Debug, Default, Deref, DerefMut, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct Rotation(pub Quaternion);

crate::type_path::type_path!(Rotation, "physics_transform::transform");

impl Rotation {
    /// Placeholder that is replaced by the rotation of the `Transform` when the entity gets its body or
    /// collider.
    pub const PLACEHOLDER: Self =
        Self(Quaternion::from_xyzw(Scalar::MAX, Scalar::MAX, Scalar::MAX, Scalar::MAX));
    /// No rotation.
    pub const IDENTITY: Self = Self(Quaternion::IDENTITY);

    /// The angle in radians between two rotations, in 0 … π.
    pub fn angle_between(self, other: Self) -> Scalar {
        narrow(self.to_f64().inverse().mul(other.to_f64()).angle())
    }

    /// The inverse rotation.
    pub fn inverse(&self) -> Self {
        Self(Quaternion::from_xyzw(-self.0.x, -self.0.y, -self.0.z, self.0.w))
    }

    /// Interpolates from `self` (`t` = 0) to `end` (`t` = 1) along the chord of the shorter arc, and
    /// renormalises.
    pub fn nlerp(self, end: Self, t: Scalar) -> Self {
        let (a, b) = (self.to_f64(), end.to_f64());
        let b = if a.dot(b) < 0.0 { b.negated() } else { b };
        Self::from_f64(a.mix(1.0 - wide(t), b, wide(t)).normalized()).unwrap_or(self)
    }

    /// Interpolates from `self` (`t` = 0) to `end` (`t` = 1) at constant angular speed along the shorter arc.
    ///
    /// `(sin((1 − t) θ) a + sin(t θ) b) / sin θ` with `cos θ = a · b` (Shoemake, "Animating Rotation with
    /// Quaternion Curves", 1985). If θ vanishes, along the chord.
    pub fn slerp(self, end: Self, t: Scalar) -> Self {
        let (a, b) = (self.to_f64(), end.to_f64());
        let b = if a.dot(b) < 0.0 { b.negated() } else { b };
        let angle = 0.5 * a.inverse().mul(b).angle();
        if angle < 1e-6 {
            return self.nlerp(end, t);
        }
        let t = wide(t);
        let mix = a.mix(kernel::math::sin((1.0 - t) * angle), b, kernel::math::sin(t * angle));
        Self::from_f64(mix.normalized()).unwrap_or(self)
    }

    /// The rotation vector from `self` to `end` in world axes, in rad, along the shorter arc.
    pub(crate) fn turn_to(self, end: Self) -> Vector {
        let turn = end.to_f64().mul(self.to_f64().inverse());
        let turn = if turn.w < 0.0 { turn.negated() } else { turn };
        // sin(angle/2), the factor of the axis in the quaternion.
        let sine = (turn.x * turn.x + turn.y * turn.y + turn.z * turn.z).sqrt();
        let factor = if sine > 0.0 { turn.angle() / sine } else { 2.0 };
        Vector::new(narrow(turn.x * factor), narrow(turn.y * factor), narrow(turn.z * factor))
    }

    /// One Newton step towards length 1, without a square root. For quaternions with a length close to 1.
    pub fn fast_renormalize(self) -> Self {
        let q = self.0;
        let square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
        let factor = 0.5 * (3.0 - square);
        Self(Quaternion::from_xyzw(q.x * factor, q.y * factor, q.z * factor, q.w * factor))
    }

    /// Rotates a vector: `v + w t + u × t` with `t = 2 u × v`, for q = (u, w).
    #[inline]
    pub(super) fn rotate_vector(self, v: Vector) -> Vector {
        let q = self.0;
        let tx = 2.0 * (q.y * v.z - q.z * v.y);
        let ty = 2.0 * (q.z * v.x - q.x * v.z);
        let tz = 2.0 * (q.x * v.y - q.y * v.x);
        Vector::new(
            v.x + q.w * tx + (q.y * tz - q.z * ty),
            v.y + q.w * ty + (q.z * tx - q.x * tz),
            v.z + q.w * tz + (q.x * ty - q.y * tx),
        )
    }

    /// The product: `other` first, then `self`. Renormalised if the result is finite.
    #[inline]
    pub(super) fn then_of(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        let x = a.w * b.x + a.x * b.w + (a.y * b.z - a.z * b.y);
        let y = a.w * b.y + a.y * b.w + (a.z * b.x - a.x * b.z);
        let z = a.w * b.z + a.z * b.w + (a.x * b.y - a.y * b.x);
        let w = a.w * b.w - (a.x * b.x + a.y * b.y + a.z * b.z);
        let length = (x * x + y * y + z * z + w * w).sqrt();
        if !(length > 0.0 && length.is_finite()) {
            return Self(Quaternion::from_xyzw(x, y, z, w));
        }
        Self(Quaternion::from_xyzw(x / length, y / length, z / length, w / length))
    }

    /// The rotation in the kernel's precision.
    pub(crate) fn to_kernel(self) -> kernel::math::Rot {
        let [x, y, z, w] = self.0.to_array();
        kernel::math::Rot { x: x as f32, y: y as f32, z: z as f32, w: w as f32 }
    }

    /// Converts a kernel rotation.
    pub(crate) fn from_kernel(rotation: kernel::math::Rot) -> Self {
        let kernel::math::Rot { x, y, z, w } = rotation;
        Self(Quaternion::from_xyzw(Scalar::from(x), Scalar::from(y), Scalar::from(z), Scalar::from(w)))
    }

    pub(super) fn to_f64(self) -> Rotation64 {
        let [x, y, z, w] = self.0.to_array();
        Rotation64 { x: wide(x), y: wide(y), z: wide(z), w: wide(w) }
    }

    /// Converts an `f64` rotation. It is renormalised if it deviates from unit length by more than rounding.
    /// `None` if it cannot be normalised.
    pub(super) fn from_f64(turn: Rotation64) -> Option<Self> {
        let square = turn.dot(turn);
        if !(square > 0.0 && square.is_finite()) {
            return None;
        }
        let turn = if (square - 1.0).abs() > 1e-6 { turn.normalized() } else { turn };
        Some(Self(Quaternion::from_xyzw(narrow(turn.x), narrow(turn.y), narrow(turn.z), narrow(turn.w))))
    }
}

/// The world rotation of an entity with the target rotation `rotation`.
pub(super) fn world_rotation(rotation: Rotation, _current: Rotation64) -> Rotation64 {
    rotation.to_f64()
}

/// Whether `read` differs from `held` only by rounding. Always false in 3D, where bits are compared instead.
pub(super) fn is_rounding(_read: Rotation, _held: Rotation, _current: Rotation64) -> bool {
    false
}

/// The point with the spatial part `v`.
pub(super) fn xyz_with(v: Vector, _rest: [f64; 3]) -> [f64; 3] {
    [wide(v.x), wide(v.y), wide(v.z)]
}

impl Position {
    /// The position with these coordinates, in metres.
    pub fn from_xyz(x: Scalar, y: Scalar, z: Scalar) -> Self {
        Self(Vector::new(x, y, z))
    }
}

/// `Rotation * Quaternion` and `Quaternion * Rotation`, by value and by reference on the left.
macro_rules! quaternion_products {
    ($($left:ty),+) => {$(
        impl Mul<Quaternion> for $left {
            type Output = Quaternion;
            fn mul(self, other: Quaternion) -> Quaternion {
                self.then_of(Rotation(other)).0
            }
        }
    )+};
    (quaternion $($left:ty),+) => {$(
        impl Mul<Rotation> for $left {
            type Output = Rotation;
            fn mul(self, other: Rotation) -> Rotation {
                let [x, y, z, w] = self.to_array();
                Rotation(Quaternion::from_xyzw(x, y, z, w)).then_of(other)
            }
        }
    )+};
}
quaternion_products!(Rotation, &Rotation, &mut Rotation);
quaternion_products!(quaternion Quaternion, &Quaternion, &mut Quaternion);

impl From<Rotation> for Quaternion {
    fn from(rotation: Rotation) -> Self {
        rotation.0
    }
}

impl From<Quat> for Rotation {
    fn from(rotation: Quat) -> Self {
        let [x, y, z, w] = rotation.to_array();
        Self(Quaternion::from_xyzw(Scalar::from(x), Scalar::from(y), Scalar::from(z), Scalar::from(w)))
    }
}

impl From<DQuat> for Rotation {
    fn from(rotation: DQuat) -> Self {
        let [x, y, z, w] = rotation.to_array();
        Self(Quaternion::from_xyzw(narrow(x), narrow(y), narrow(z), narrow(w)))
    }
}

/// Operations that are needed only in 3D.
impl Rotation64 {
    pub(crate) fn negated(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z, w: -self.w }
    }

    /// `a self + b other`.
    pub(crate) fn mix(self, a: f64, other: Self, b: f64) -> Self {
        Self {
            x: a * self.x + b * other.x,
            y: a * self.y + b * other.y,
            z: a * self.z + b * other.z,
            w: a * self.w + b * other.w,
        }
    }

    /// The angle of the rotation, in 0 … π.
    pub(crate) fn angle(self) -> f64 {
        let sine = (self.x * self.x + self.y * self.y + self.z * self.z).sqrt();
        2.0 * kernel::math::atan2(sine, self.w.abs())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Dir, PI};

    fn sample(i: u16) -> Rotation {
        let t = Scalar::from(i);
        let turn = Rotation64 {
            x: wide(t * 0.37) % 2.0 - 1.0,
            y: wide(t * 0.71) % 2.0 - 1.0,
            z: wide(t * 0.13) % 2.0 - 1.0,
            w: wide(t * 0.57) % 2.0 - 1.0,
        };
        Rotation::from_f64(turn.normalized()).expect("a unit turn")
    }

    #[test]
    fn quarters_are_exact() {
        let half = core::f64::consts::FRAC_1_SQRT_2;
        let quarter =
            Rotation::from_f64(Rotation64 { x: 0.0, y: 0.0, z: half, w: half }).expect("a unit turn");
        assert_eq!(quarter * quarter * Vector::X, -Vector::X);
        assert_eq!(quarter * quarter * (quarter * quarter) * Vector::X, Vector::X);
    }

    #[test]
    fn products_agree_with_the_quaternion_library() {
        for i in 0..200 {
            let (a, b) = (sample(i), sample(i + 1));
            let v = Vector::new(0.3, -2.0, 1.1);
            assert!((a * v).distance(a.0 * v) < 1e-5);
            assert!((a * (b * v)).distance(a * b * v) < 1e-5);
            assert!((a * a.inverse() * v).distance(v) < 1e-5);
            assert!((a * b.0).dot((a.0 * b).0).abs() > 1.0 - 1e-5);
            assert!(((a * b).0.length() - 1.0).abs() < 3e-7);
            let direction = a * Dir::X;
            assert!((direction.length() - 1.0).abs() < 1e-6);
            assert!((a.angle_between(b) - a.0.angle_between(b.0)).abs() < 2e-3);
        }
    }

    #[test]
    fn interpolation_is_even_and_goes_the_short_way() {
        for i in 0..100 {
            let (a, b) = (sample(i), sample(i + 7));
            let whole = a.angle_between(b);
            assert!((0.0..=PI + 1e-5).contains(&whole));
            for part in 0u8..=10 {
                let t = Scalar::from(part) / 10.0;
                let (slow, fast) = (a.slerp(b, t), a.nlerp(b, t));
                assert!((a.angle_between(slow) - t * whole).abs() < 1e-5);
                assert!((fast.0.length() - 1.0).abs() < 1e-6);
            }
            assert!(a.slerp(a, 0.5).0.dot(a.0) > 1.0 - 1e-6);
        }
        assert!(Rotation::from_f64(Rotation64 { x: 0.0, y: 0.0, z: 0.0, w: 0.0 }).is_none());
    }

    #[test]
    fn poses_survive_parents_that_shear_and_mirror() {
        use super::super::frame::{Frame, read_pose, same_rotation, same_translation, write_pose};
        use bevy_math::Vec3;
        use bevy_transform::components::{GlobalTransform, Transform};
        let scales = [Vec3::ONE, Vec3::new(1.0, 2.0, 0.5), Vec3::new(-1.0, 1.5, 1.0), Vec3::splat(-2.0)];
        for i in 0..400 {
            let link = |k: u16| {
                let [x, y, z, w] = sample(k).to_f64().to_quat().to_array();
                Transform::from_xyz(x * 9.0, y * 9.0, z * 9.0)
                    .with_rotation(Quat::from_xyzw(x, y, z, w))
                    .with_scale(scales[usize::from(k) % 4])
            };
            let (outer, inner, leaf) = (link(i), link(i / 4), link(i / 16));
            let frame = Frame::IDENTITY.child(&outer).child(&inner);
            let bevy = Position::from(GlobalTransform::from(outer) * inner * leaf).0;
            assert!(read_pose(Some(&frame), &leaf).0.distance(bevy) < 1e-3);
            let (position, rotation) = (Vector::new(1.0, -2.0, 3.0), sample(i + 3));
            let written = write_pose(Some(&frame), &leaf, position, rotation);
            let (read, turned) = read_pose(Some(&frame), &written);
            assert!(read.distance(position) < 1e-4);
            assert!(turned.expect("a unit turn").angle_between(rotation) < 1e-4);
            let again = write_pose(Some(&frame), &written, position, rotation);
            assert!(same_translation(&again, &written) && same_rotation(&again, &written));
        }
    }
}
