//! 2D rotations, and the 2D parts of the transform synchronisation. `dim3.rs` exports the same names.

use bevy_ecs::{component::Component, reflect::ReflectComponent};
use bevy_math::{DQuat, Quat, Rot2};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::{
    Position,
    rotation64::{Rotation64, narrow, wide},
};
use crate::math::{FRAC_1_SQRT_2, Matrix, Quaternion, Scalar, Vector, Vector3};

/// The world rotation of a rigid body or collider: the cosine and sine of its angle, counter-clockwise.
///
/// ```
/// # use avian::{prelude::*, math::Vector};
/// let rotation = Rotation::degrees(45.0);
/// assert_eq!(rotation * rotation * Vector::X, Vector::Y);
/// ```
///
/// Multiplication renormalises, which keeps products of many rotations valid.
#[derive(Reflect, Clone, Copy, Component, Debug, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct Rotation {
    /// The cosine of the angle.
    pub cos: Scalar,
    /// The sine of the angle.
    pub sin: Scalar,
}

crate::type_path::type_path!(Rotation, "physics_transform::transform");

impl Default for Rotation {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Rotation {
    /// Placeholder that is replaced by the rotation of the `Transform` when the entity gets its body or
    /// collider.
    pub const PLACEHOLDER: Self = Self { cos: Scalar::MAX, sin: Scalar::MAX };
    /// No rotation.
    pub const IDENTITY: Self = Self { cos: 1.0, sin: 0.0 };
    /// Half a turn, π radians.
    pub const PI: Self = Self { cos: -1.0, sin: 0.0 };
    /// A quarter turn, π/2 radians.
    pub const FRAC_PI_2: Self = Self { cos: 0.0, sin: 1.0 };
    /// A sixth of a turn, π/3 radians.
    pub const FRAC_PI_3: Self = Self { cos: 0.5, sin: 0.866_025_403_784_438_6_f64 as Scalar };
    /// An eighth of a turn, π/4 radians.
    pub const FRAC_PI_4: Self = Self { cos: FRAC_1_SQRT_2, sin: FRAC_1_SQRT_2 };
    /// A twelfth of a turn, π/6 radians.
    pub const FRAC_PI_6: Self = Self { cos: 0.866_025_403_784_438_6_f64 as Scalar, sin: 0.5 };
    /// A sixteenth of a turn, π/8 radians.
    pub const FRAC_PI_8: Self =
        Self { cos: 0.923_879_532_511_286_7_f64 as Scalar, sin: 0.382_683_432_365_089_8_f64 as Scalar };

    /// The rotation by an angle in radians, counter-clockwise. An angle that is not finite gives NaN.
    pub fn radians(radians: Scalar) -> Self {
        let (sin, cos) = kernel::math::sin_cos(wide(radians));
        Self { cos: narrow(cos), sin: narrow(sin) }
    }

    /// The rotation by an angle in degrees, counter-clockwise.
    ///
    /// Multiples of 45° are exact: zeros and ones are 0 and 1, and at 45° the cosine equals the sine.
    pub fn degrees(degrees: Scalar) -> Self {
        // The remainder is exact, and so is subtracting the nearest quarter (Sterbenz's lemma).
        let turn = wide(degrees) % 360.0;
        let quarters = (turn / 90.0).round();
        let rest = turn - 90.0 * quarters;
        let (sin, cos) = if rest.abs() == 45.0 {
            (core::f64::consts::FRAC_1_SQRT_2.copysign(rest), core::f64::consts::FRAC_1_SQRT_2)
        } else {
            kernel::math::sin_cos(rest * (core::f64::consts::PI / 180.0))
        };
        // Adding zero turns −0 into 0.
        let (sin, cos) = match (quarters as i64).rem_euclid(4) {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        };
        Self { cos: narrow(cos + 0.0), sin: narrow(sin + 0.0) }
    }

    /// The rotation by an angle in radians.
    #[deprecated(note = "renamed to `radians`")]
    pub fn from_radians(radians: Scalar) -> Self {
        Self::radians(radians)
    }

    /// The rotation by an angle in degrees.
    #[deprecated(note = "renamed to `degrees`")]
    pub fn from_degrees(degrees: Scalar) -> Self {
        Self::degrees(degrees)
    }

    /// The rotation whose angle has this sine and cosine. `sin² + cos²` should be 1.
    pub fn from_sin_cos(sin: Scalar, cos: Scalar) -> Self {
        Self { cos, sin }
    }

    /// The angle in radians, in −π … π.
    pub fn as_radians(self) -> Scalar {
        narrow(kernel::math::atan2(wide(self.sin), wide(self.cos)))
    }

    /// The angle in degrees, in −180 … 180.
    pub fn as_degrees(self) -> Scalar {
        narrow(kernel::math::atan2(wide(self.sin), wide(self.cos)) * (180.0 / core::f64::consts::PI))
    }

    /// The sine and the cosine of the angle.
    pub const fn sin_cos(self) -> (Scalar, Scalar) {
        (self.sin, self.cos)
    }

    /// Rotates a vector.
    #[deprecated(note = "use the `Mul` implementation")]
    pub fn rotate(&self, vec: Vector) -> Vector {
        self * vec
    }

    /// The length of the pair (cos, sin): 1 for a rotation.
    pub fn length(self) -> Scalar {
        self.length_squared().sqrt()
    }

    /// The squared length of the pair (cos, sin).
    pub fn length_squared(self) -> Scalar {
        self.cos * self.cos + self.sin * self.sin
    }

    /// One over the length; infinite for length zero.
    pub fn length_recip(self) -> Scalar {
        1.0 / self.length()
    }

    /// Normalised to length 1; `None` if the length is zero or not finite.
    pub fn try_normalize(self) -> Option<Self> {
        let length = self.length();
        (length.is_finite() && length > 0.0).then(|| Self { cos: self.cos / length, sin: self.sin / length })
    }

    /// Normalised to length 1; unchanged if the length is zero or not finite.
    pub fn normalize(self) -> Self {
        self.try_normalize().unwrap_or(self)
    }

    /// One Newton step towards length 1, without a square root. For pairs with a length close to 1.
    pub fn fast_renormalize(self) -> Self {
        let factor = 0.5 * (3.0 - self.length_squared());
        Self { cos: self.cos * factor, sin: self.sin * factor }
    }

    /// Whether neither number is infinite or NaN.
    pub fn is_finite(self) -> bool {
        self.cos.is_finite() && self.sin.is_finite()
    }

    /// Whether a number is NaN.
    pub fn is_nan(self) -> bool {
        self.cos.is_nan() || self.sin.is_nan()
    }

    /// Whether the length is 1 within about 1e-4.
    pub fn is_normalized(self) -> bool {
        (self.length_squared() - 1.0).abs() <= 2e-4
    }

    /// Whether the angle is less than about 0.003°.
    pub fn is_near_identity(self) -> bool {
        self.cos > 0.0 && self.sin.abs() < 5e-5
    }

    /// The angle in radians from `self` to `other`, in −π … π.
    pub fn angle_between(self, other: Self) -> Scalar {
        let (c, s) = (wide(self.cos), wide(self.sin));
        let (oc, os) = (wide(other.cos), wide(other.sin));
        narrow(kernel::math::atan2(c * os - s * oc, c * oc + s * os))
    }

    /// The angle in radians from `self` to `end`, in −π … π. In 3D this is a rotation vector.
    pub(crate) fn turn_to(self, end: Self) -> Scalar {
        self.angle_between(end)
    }

    /// The inverse rotation.
    pub fn inverse(self) -> Self {
        Self { cos: self.cos, sin: -self.sin }
    }

    /// Rotated by a small angle in radians: a first-order step, renormalised.
    pub fn add_angle_fast(&self, radians: Scalar) -> Self {
        Self { cos: self.cos - radians * self.sin, sin: self.sin + radians * self.cos }.normalize()
    }

    /// Interpolates from `self` (`s` = 0) to `end` (`s` = 1) along the chord, and renormalises. Opposite
    /// rotations give `self`.
    pub fn nlerp(self, end: Self, s: Scalar) -> Self {
        let mix = Self { cos: self.cos + (end.cos - self.cos) * s, sin: self.sin + (end.sin - self.sin) * s };
        mix.try_normalize().unwrap_or(self)
    }

    /// Interpolates from `self` (`s` = 0) to `end` (`s` = 1) at constant angular speed along the shorter arc.
    pub fn slerp(self, end: Self, s: Scalar) -> Self {
        self * Self::radians(self.angle_between(end) * s)
    }

    /// Rotates a vector.
    #[inline]
    pub(super) fn rotate_vector(self, v: Vector) -> Vector {
        Vector::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }

    /// Rotates a vector about the z axis.
    fn rotate_vector3(self, v: Vector3) -> Vector3 {
        Vector3::new(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y, v.z)
    }

    /// The product: `other` first, then `self`. Renormalised.
    #[inline]
    pub(super) fn then_of(self, other: Self) -> Self {
        Self {
            cos: self.cos * other.cos - self.sin * other.sin,
            sin: self.sin * other.cos + self.cos * other.sin,
        }
        .normalize()
    }

    /// The rotation in the kernel's precision.
    pub(crate) fn to_kernel(self) -> kernel::math::Rot {
        kernel::math::Rot { cos: self.cos as f32, sin: self.sin as f32 }
    }

    /// Converts a kernel rotation.
    pub(crate) fn from_kernel(rotation: kernel::math::Rot) -> Self {
        Self { cos: Scalar::from(rotation.cos), sin: Scalar::from(rotation.sin) }
    }

    /// The rotation about the z axis as a quaternion, by half angles: `w = √((1 + cos) / 2)`, `z = sin / 2w`.
    /// Of the equivalent forms, the one without cancellation is used.
    pub(super) fn to_f64(self) -> Rotation64 {
        let (c, s) = (wide(self.cos), wide(self.sin));
        let (z, w) = if c >= 0.0 {
            let w = (0.5 * (1.0 + c)).sqrt();
            (s / (2.0 * w), w)
        } else {
            let z = (0.5 * (1.0 - c)).sqrt().copysign(s);
            (z, s / (2.0 * z))
        };
        Rotation64 { x: 0.0, y: 0.0, z, w }
    }

    /// The rotation about z of a 3D rotation. `None` if it has no finite angle.
    pub(super) fn from_f64(turn: Rotation64) -> Option<Self> {
        let (z, w) = twist(turn);
        let length = z * z + w * w;
        if !(length > 0.0 && length.is_finite()) {
            return None;
        }
        Some(Self { cos: narrow((w * w - z * z) / length), sin: narrow(2.0 * (w * z) / length) })
    }
}

/// The component of a 3D rotation about z, as (z, w), not normalised. A rotation closer to "flipped" than to
/// "upright" (a sprite rotated half a turn about y or x, showing its back) is measured relative to the half
/// turn about y, so that a flip alone counts as no rotation: `(w + z k) j = w j − z i`.
fn twist(turn: Rotation64) -> (f64, f64) {
    let upright = turn.z * turn.z + turn.w * turn.w;
    let flipped = turn.x * turn.x + turn.y * turn.y;
    if upright >= flipped { (turn.z, turn.w) } else { (-turn.x, turn.y) }
}

/// The world rotation of an entity with the target rotation `rotation` and the current rotation `current`.
/// Only the component about z is replaced, a tilt is kept.
#[inline]
pub(super) fn world_rotation(rotation: Rotation, current: Rotation64) -> Rotation64 {
    let wanted = rotation.to_f64();
    if current.x == 0.0 && current.y == 0.0 {
        return wanted;
    }
    let (z, w) = twist(current);
    let old = Rotation64 { x: 0.0, y: 0.0, z, w }.normalized();
    wanted.mul(old.inverse().mul(current)).normalized()
}

/// Whether `read`, extracted from the tilted rotation `current`, differs from `held` only by rounding.
/// Without a tilt, bits are compared instead.
pub(super) fn is_rounding(read: Rotation, held: Rotation, current: Rotation64) -> bool {
    let tilted = current.x != 0.0 || current.y != 0.0;
    tilted && (read.cos - held.cos).abs() < 1e-6 && (read.sin - held.sin).abs() < 1e-6
}

/// The point with the spatial part `v` and the z of `rest`.
pub(super) fn xyz_with(v: Vector, rest: [f64; 3]) -> [f64; 3] {
    [wide(v.x), wide(v.y), rest[2]]
}

impl Position {
    /// The position with these coordinates, in metres.
    pub fn from_xy(x: Scalar, y: Scalar) -> Self {
        Self(Vector::new(x, y))
    }
}

by_reference!(Rotation, Vector3 => Vector3, |rotation, v| rotation.rotate_vector3(v));

impl From<Scalar> for Rotation {
    fn from(radians: Scalar) -> Self {
        Self::radians(radians)
    }
}

impl From<Rotation> for Scalar {
    fn from(rotation: Rotation) -> Self {
        rotation.as_radians()
    }
}

impl From<Rotation> for Matrix {
    fn from(rotation: Rotation) -> Self {
        Matrix::from_cols_array(&[rotation.cos, rotation.sin, -rotation.sin, rotation.cos])
    }
}

impl From<Matrix> for Rotation {
    /// The rotation that maps the x axis like the matrix.
    fn from(matrix: Matrix) -> Self {
        Self { cos: matrix.x_axis.x, sin: matrix.x_axis.y }.normalize()
    }
}

impl From<Rot2> for Rotation {
    fn from(rotation: Rot2) -> Self {
        Self { cos: Scalar::from(rotation.cos), sin: Scalar::from(rotation.sin) }
    }
}

impl From<Rotation> for Rot2 {
    fn from(rotation: Rotation) -> Self {
        Rot2 { cos: rotation.cos as f32, sin: rotation.sin as f32 }
    }
}

impl From<Rotation> for Quaternion {
    fn from(rotation: Rotation) -> Self {
        let turn = rotation.to_f64();
        Quaternion::from_xyzw(0.0, 0.0, narrow(turn.z), narrow(turn.w))
    }
}

impl From<Quat> for Rotation {
    /// The rotation about z of the quaternion.
    fn from(rotation: Quat) -> Self {
        Self::from_f64(Rotation64::from_quat(rotation)).unwrap_or(Self::IDENTITY)
    }
}

impl From<DQuat> for Rotation {
    /// The rotation about z of the quaternion.
    fn from(rotation: DQuat) -> Self {
        let [x, y, z, w] = rotation.to_array();
        Self::from_f64(Rotation64 { x, y, z, w }).unwrap_or(Self::IDENTITY)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::PI;

    #[test]
    fn eighths_of_a_turn_are_exact() {
        let eighth = Rotation::degrees(45.0);
        assert_eq!(eighth.cos, eighth.sin);
        assert_eq!(eighth * eighth * Vector::X, Vector::Y);
        let expected = [Vector::X, Vector::Y, -Vector::X, -Vector::Y];
        for quarters in -40i16..40 {
            let rotation = Rotation::degrees(Scalar::from(quarters) * 90.0);
            assert_eq!(rotation * Vector::X, expected[usize::from(quarters.rem_euclid(4) as u16)]);
            assert!(rotation.cos.to_bits() << 1 != 0 || rotation.cos.is_sign_positive(), "no negative zero");
            let half = rotation * Rotation::degrees(45.0);
            assert_eq!(half.cos.abs(), half.sin.abs());
        }
        let mut turned = Rotation::IDENTITY;
        for _ in 0..1000 {
            turned *= eighth;
        }
        assert_eq!(turned, Rotation::IDENTITY);
    }

    #[test]
    fn angles_go_in_and_come_out() {
        for step in -1000i16..1000 {
            let angle = Scalar::from(step) * 0.003_14;
            let rotation = Rotation::radians(angle);
            assert!((rotation.as_radians() - angle).abs() < 4e-7);
            assert!((Rotation::degrees(rotation.as_degrees()).angle_between(rotation)).abs() < 1e-6);
            assert!((rotation.length() - 1.0).abs() < 2e-7);
            let there = Rotation::from(Quaternion::from(rotation));
            assert!((there.cos - rotation.cos).abs() < 3e-7 && (there.sin - rotation.sin).abs() < 3e-7);
            assert!((Rotation::from(Matrix::from(rotation)).angle_between(rotation)).abs() < 1e-6);
            assert!((Scalar::from(Rotation::from(Rot2::from(rotation))) - angle).abs() < 1e-6);
        }
        for (constant, angle) in [
            (Rotation::PI, PI),
            (Rotation::FRAC_PI_2, PI / 2.0),
            (Rotation::FRAC_PI_3, PI / 3.0),
            (Rotation::FRAC_PI_4, PI / 4.0),
            (Rotation::FRAC_PI_6, PI / 6.0),
            (Rotation::FRAC_PI_8, PI / 8.0),
        ] {
            assert!((constant.as_radians() - angle).abs() < 2e-7);
        }
    }

    #[test]
    fn interpolation_is_even_and_goes_the_short_way() {
        let (a, b) = (Rotation::radians(3.0), Rotation::radians(-3.0));
        let whole = a.angle_between(b);
        assert!((whole - (2.0 * PI - 6.0)).abs() < 1e-6);
        for i in 0u8..=10 {
            let s = Scalar::from(i) / 10.0;
            assert!((a.angle_between(a.slerp(b, s)) - s * whole).abs() < 1e-6);
            assert!((a.nlerp(b, s).length() - 1.0).abs() < 1e-6);
        }
        assert_eq!(Rotation::IDENTITY.nlerp(Rotation::PI, 0.5), Rotation::IDENTITY);
        assert_eq!(a.try_normalize().map(|r| r.is_normalized()), Some(true));
        assert_eq!(Rotation { cos: 0.0, sin: 0.0 }.try_normalize(), None);
    }

    #[test]
    fn a_tilt_stays_and_a_flip_is_no_rotation() {
        let flip = Rotation64 { x: 0.0, y: 1.0, z: 0.0, w: 0.0 };
        assert_eq!(Rotation::from_f64(flip), Some(Rotation::IDENTITY));
        let tilt = Rotation64 { x: 0.3, y: -0.2, z: 0.1, w: 1.0 }.normalized();
        for current in [flip, tilt] {
            for degrees in [0.0, 10.0, 170.0, -90.0] {
                let rotation = Rotation::degrees(degrees);
                let written = world_rotation(rotation, current);
                let read = Rotation::from_f64(written).expect("a unit turn");
                assert!(read.angle_between(rotation).abs() < 1e-6);
                assert!(is_rounding(read, rotation, written));
                let again = world_rotation(rotation, written);
                assert!((again.dot(written) - 1.0).abs() < 1e-9, "written twice, turned twice");
            }
        }
    }
}
