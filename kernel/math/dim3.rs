//! The algebra of space. `dim2.rs` has the same types with the same operations.

use super::{Lane, Num, Scalar};

mod tensor3;

/// The number of spatial dimensions.
pub const DIM: usize = 3;
/// Maximum number of points of a manifold after reduction.
pub const MAX_POINTS: usize = 4;

/// A direction, offset or linear velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vector<N = f32> {
    /// Rightwards.
    pub x: N,
    /// Upwards.
    pub y: N,
    /// Towards the viewer.
    pub z: N,
}

/// An angular velocity, torque or moment, along its axis, right-handed.
pub type Angular<N = f32> = Vector<N>;

/// An inertia tensor, in kg·m².
pub type Inertia<N = f32> = SymTensor<N>;

/// The inverse of an inertia tensor, in 1 / (kg·m²). A body with 0 does not turn.
pub type InvInertia<N = f32> = SymTensor<N>;

/// A symmetric 3 × 3 matrix: an [`Inertia`] or an [`InvInertia`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SymTensor<N = f32> {
    /// Diagonal, x.
    pub xx: N,
    /// Diagonal, y.
    pub yy: N,
    /// Diagonal, z.
    pub zz: N,
    /// Off the diagonal, x and y.
    pub xy: N,
    /// Off the diagonal, x and z.
    pub xz: N,
    /// Off the diagonal, y and z.
    pub yz: N,
}

/// A rotation, as a unit quaternion.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Rot<N = f32> {
    /// Imaginary, i.
    pub x: N,
    /// Imaginary, j.
    pub y: N,
    /// Imaginary, k.
    pub z: N,
    /// Real.
    pub w: N,
}

impl Vector {
    /// The unit vector to the right.
    pub const X: Self = Self { x: 1.0, y: 0.0, z: 0.0 };
    /// The unit vector upwards.
    pub const Y: Self = Self { x: 0.0, y: 1.0, z: 0.0 };
    /// The unit vector towards the viewer.
    pub const Z: Self = Self { x: 0.0, y: 0.0, z: 1.0 };
    /// All components 1.
    pub const ONE: Self = Self { x: 1.0, y: 1.0, z: 1.0 };
    /// The unit vectors.
    pub const AXES: [Self; DIM] = [Self::X, Self::Y, Self::Z];

    /// Makes a vector from its components.
    #[inline]
    pub const fn from_array(v: [f32; DIM]) -> Self {
        Self { x: v[0], y: v[1], z: v[2] }
    }

    /// The components, in order.
    #[inline]
    pub const fn to_array(self) -> [f32; DIM] {
        [self.x, self.y, self.z]
    }

    /// Widens a local vector to world precision.
    #[inline(always)]
    pub fn to_world(self) -> Vector<Scalar> {
        Vector { x: self.x as Scalar, y: self.y as Scalar, z: self.z as Scalar }
    }

    /// The same vector in `f64`.
    #[inline(always)]
    pub(crate) fn widen(self) -> Vector<f64> {
        Vector { x: f64::from(self.x), y: f64::from(self.y), z: f64::from(self.z) }
    }

    /// Each component's absolute value.
    #[inline]
    pub fn abs(self) -> Self {
        Self { x: self.x.abs(), y: self.y.abs(), z: self.z.abs() }
    }

    /// The componentwise minimum.
    #[inline]
    pub fn min(self, other: Self) -> Self {
        Self {
            x: super::min(self.x, other.x),
            y: super::min(self.y, other.y),
            z: super::min(self.z, other.z),
        }
    }

    /// The componentwise maximum.
    #[inline]
    pub fn max(self, other: Self) -> Self {
        Self {
            x: super::max(self.x, other.x),
            y: super::max(self.y, other.y),
            z: super::max(self.z, other.z),
        }
    }

    /// The smallest component.
    #[inline]
    pub fn min_element(self) -> f32 {
        super::min(super::min(self.x, self.y), self.z)
    }

    /// The largest component.
    #[inline]
    pub fn max_element(self) -> f32 {
        super::max(super::max(self.x, self.y), self.z)
    }

    /// Whether no component is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        // `x * 0.0` is 0 unless x is infinite or NaN. The sum needs no branch.
        self.x * 0.0 + self.y * 0.0 + self.z * 0.0 == 0.0
    }
}

impl Vector<Scalar> {
    /// Narrows a difference of world positions.
    #[inline(always)]
    pub fn to_local(self) -> Vector {
        Vector { x: self.x as f32, y: self.y as f32, z: self.z as f32 }
    }

    /// Applies `f` to each component, for rounding modes other than to nearest.
    #[inline]
    pub fn map_to_f32(self, f: impl Fn(Scalar) -> f32) -> Vector {
        Vector { x: f(self.x), y: f(self.y), z: f(self.z) }
    }

    /// Whether no component of a world position is infinite or NaN.
    #[inline]
    pub fn is_finite_world(self) -> bool {
        // `x * 0.0` is 0 unless x is infinite or NaN. The sum needs no branch.
        self.x * 0.0 + self.y * 0.0 + self.z * 0.0 == 0.0
    }
}

impl Vector<f64> {
    /// Rounded to `f32`.
    #[inline(always)]
    pub(crate) fn narrow(self) -> Vector {
        Vector { x: self.x as f32, y: self.y as f32, z: self.z as f32 }
    }

    /// The largest absolute value of a component; infinite if a component is not finite.
    pub(crate) fn largest(self) -> f64 {
        let finite = self.x * 0.0 + self.y * 0.0 + self.z * 0.0 == 0.0;
        if finite { self.x.abs().max(self.y.abs()).max(self.z.abs()) } else { f64::INFINITY }
    }
}

impl<N: Num> Vector<N> {
    /// All components 0.
    pub const ZERO: Self = Self { x: N::ZERO, y: N::ZERO, z: N::ZERO };

    /// The dot product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y + self.z * other.z
    }
    /// The cross product `self × other`: a moment, or the velocity `ω × r` of a point at `r`.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Self {
        Self {
            x: self.y * other.z - self.z * other.y,
            y: self.z * other.x - self.x * other.z,
            z: self.x * other.y - self.y * other.x,
        }
    }
    /// The componentwise product.
    #[inline(always)]
    pub fn scale(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y, z: self.z * other.z }
    }
    /// The dot product with itself.
    #[inline(always)]
    pub fn length_squared(self) -> N {
        self.dot(self)
    }
    /// The Euclidean length.
    #[inline(always)]
    pub fn length(self) -> N {
        self.length_squared().sqrt()
    }
}

impl<N: Lane> Vector<N> {
    /// The same vector in every lane.
    #[inline(always)]
    pub fn splat(v: Vector) -> Self {
        Self { x: N::splat(v.x), y: N::splat(v.y), z: N::splat(v.z) }
    }
    /// Reads lane `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Vector {
        Vector { x: self.x.get(i), y: self.y.get(i), z: self.z.get(i) }
    }
    /// Writes lane `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: Vector) {
        self.x.set(i, v.x);
        self.y.set(i, v.y);
        self.z.set(i, v.z);
    }
}

impl<N: Num> Default for Rot<N> {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl<N: Num> Rot<N> {
    /// No turn.
    pub const IDENTITY: Self = Self { x: N::ZERO, y: N::ZERO, z: N::ZERO, w: N::ONE };

    /// The columns of the rotation matrix: the rotated axes.
    #[inline(always)]
    pub fn axes(self) -> [Vector<N>; DIM] {
        let Self { x, y, z, w } = self;
        let (x2, y2, z2) = (x + x, y + y, z + z);
        let (xx, yy, zz) = (x * x2, y * y2, z * z2);
        let (xy, xz, yz) = (x * y2, x * z2, y * z2);
        let (wx, wy, wz) = (w * x2, w * y2, w * z2);
        [
            Vector { x: N::ONE - (yy + zz), y: xy + wz, z: xz - wy },
            Vector { x: xy - wz, y: N::ONE - (xx + zz), z: yz + wx },
            Vector { x: xz + wy, y: yz - wx, z: N::ONE - (xx + yy) },
        ]
    }

    /// Turns a vector: v + 2 w (u × v) + 2 u × (u × v), with u the imaginary part.
    #[inline(always)]
    pub fn rotate(self, v: Vector<N>) -> Vector<N> {
        let u = Vector { x: self.x, y: self.y, z: self.z };
        let t = u.cross(v);
        let t = t + t;
        v + t * self.w + u.cross(t)
    }
    /// Turns a vector the other way.
    #[inline(always)]
    pub fn inverse_rotate(self, v: Vector<N>) -> Vector<N> {
        self.inverse().rotate(v)
    }
    /// The rotation the other way.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        Self { x: -self.x, y: -self.y, z: -self.z, w: self.w }
    }
    /// `other` first, then `self`. Not renormalised.
    #[inline(always)]
    pub fn mul(self, o: Self) -> Self {
        Self {
            x: self.w * o.x + self.x * o.w + self.y * o.z - self.z * o.y,
            y: self.w * o.y + self.y * o.w + self.z * o.x - self.x * o.z,
            z: self.w * o.z + self.z * o.w + self.x * o.y - self.y * o.x,
            w: self.w * o.w - self.x * o.x - self.y * o.y - self.z * o.z,
        }
    }
    /// The displacement of the tip of `arm` along `normal` when the arm turns: n · (R r − r), given r × n.
    /// With the quaternion (u, w) it is 2 (w u · (r × n) + (u · r)(u · n) − (u · u)(r · n)).
    #[inline(always)]
    pub fn shift_along(self, arm: Vector<N>, arm_cross_normal: Angular<N>, normal: Vector<N>) -> N {
        let u = Vector { x: self.x, y: self.y, z: self.z };
        let half = self.w * u.dot(arm_cross_normal) + u.dot(arm) * u.dot(normal)
            - u.length_squared() * arm.dot(normal);
        half + half
    }
    /// The displacement of a vector when it is turned the other way: R⁻¹ v − v, exact also for small turns.
    #[inline(always)]
    pub fn unturn(self, v: Vector<N>) -> Vector<N> {
        let u = Vector { x: self.x, y: self.y, z: self.z };
        let t = v.cross(u);
        let t = t + t;
        t * self.w - u.cross(t)
    }
    /// Turns a vector by a small turn. Its length stays exact to rounding even after many turns.
    #[inline(always)]
    pub fn turn_little(self, v: Vector<N>) -> Vector<N> {
        self.rotate(v)
    }
    /// Scaled to unit length.
    #[inline(always)]
    pub fn normalized(self) -> Self {
        let length = (self.x * self.x + self.y * self.y + self.z * self.z + self.w * self.w).sqrt();
        Self { x: self.x / length, y: self.y / length, z: self.z / length, w: self.w / length }
    }
    /// Turned further by the small rotation vector `delta`, by one normalised Euler step `q + ½ δ q`.
    #[inline(always)]
    pub fn integrated(self, delta: Angular<N>) -> Self {
        let half = N::ONE / (N::ONE + N::ONE);
        let d = delta * half;
        Self {
            x: self.x + d.x * self.w + d.y * self.z - d.z * self.y,
            y: self.y + d.y * self.w + d.z * self.x - d.x * self.z,
            z: self.z + d.z * self.w + d.x * self.y - d.y * self.x,
            w: self.w - d.x * self.x - d.y * self.y - d.z * self.z,
        }
        .normalized()
    }
}

impl<N: Lane> Rot<N> {
    /// The same rotation in every lane.
    #[inline(always)]
    pub fn splat(v: Rot) -> Self {
        Self { x: N::splat(v.x), y: N::splat(v.y), z: N::splat(v.z), w: N::splat(v.w) }
    }
    /// Scaled to unit length. Lengths within 0.05 % of 1, as after a product, use three terms of (1 + e)^-½:
    /// cheap, and exact to rounding.
    #[inline(always)]
    pub fn renormalized(self) -> Self {
        let e = self.x * self.x + self.y * self.y + self.z * self.z + self.w * self.w - N::ONE;
        let near = self.scaled(N::ONE - e * (N::splat(0.5) - N::splat(0.375) * e));
        let far = N::lt(N::splat(1.0e-6), e * e);
        if N::any(far) { Self::select(far, self.normalized(), near) } else { near }
    }
    /// The rotation vector of a small turn: twice the imaginary part of the quaternion.
    #[inline(always)]
    pub fn small_turn(self) -> Angular<N> {
        Vector { x: self.x, y: self.y, z: self.z } * N::splat(2.0)
    }
    /// The small turn from one rotation to another.
    #[inline(always)]
    pub fn difference(self, other: Self) -> Angular<N> {
        self.inverse().mul(other).small_turn()
    }
    /// The cosine of the rotation's angle.
    #[inline(always)]
    pub fn cos_angle(self) -> N {
        N::splat(2.0) * self.w * self.w - N::ONE
    }
    /// The rotation of lane `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Rot {
        Rot { x: self.x.get(i), y: self.y.get(i), z: self.z.get(i), w: self.w.get(i) }
    }
    /// Sets the rotation of lane `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: Rot) {
        self.x.set(i, v.x);
        self.y.set(i, v.y);
        self.z.set(i, v.z);
        self.w.set(i, v.w);
    }
    fn scaled(self, factor: N) -> Self {
        Self { x: self.x * factor, y: self.y * factor, z: self.z * factor, w: self.w * factor }
    }
    /// `a` where the mask is set, else `b`.
    #[inline(always)]
    pub fn select(mask: N::Mask, a: Self, b: Self) -> Self {
        Self {
            x: N::select(mask, a.x, b.x),
            y: N::select(mask, a.y, b.y),
            z: N::select(mask, a.z, b.z),
            w: N::select(mask, a.w, b.w),
        }
    }
}

impl Rot {
    /// The same rotation in `f64`, of unit length.
    #[inline]
    pub(crate) fn widen(self) -> Rot<f64> {
        Rot { x: f64::from(self.x), y: f64::from(self.y), z: f64::from(self.z), w: f64::from(self.w) }
            .normalized()
    }
    /// The rotation about the unit vector `axis` by an angle in radians, right-handed.
    pub fn from_axis_angle(axis: Vector, angle: f32) -> Self {
        let (sin, cos) = super::sin_cos(0.5 * f64::from(angle));
        let v = axis * (sin as f32);
        Self { x: v.x, y: v.y, z: v.z, w: cos as f32 }
    }
    /// The rotation as an axis times an angle, with the number of whole turns that brings it nearest to
    /// `hint`.
    pub fn angle_near(self, hint: Angular) -> Angular {
        let sign = if self.w < 0.0 { -1.0 } else { 1.0 };
        let [x, y, z, w] = [self.x, self.y, self.z, self.w].map(|c| f64::from(c) * sign);
        let sin = (x * x + y * y + z * z).sqrt();
        let angle = 2.0 * super::atan2(sin, w);
        let [a, b, c] = hint.to_array().map(f64::from);
        let (axis, along) = if sin > 1.0e-9 {
            let axis = [x / sin, y / sin, z / sin];
            (axis, a * axis[0] + b * axis[1] + c * axis[2])
        } else {
            let length = (a * a + b * b + c * c).sqrt();
            let k = if length > 0.0 { 1.0 / length } else { 0.0 };
            ([a * k, b * k, c * k], length)
        };
        let turns = ((along - angle) / core::f64::consts::TAU).round();
        let angle = angle + turns * core::f64::consts::TAU;
        let [x, y, z] = axis.map(|c| (c * angle) as f32);
        Angular { x, y, z }
    }
    /// Turned further by the rotation vector `delta`, of any length.
    pub fn turned_by(self, delta: Angular) -> Self {
        let [x, y, z] = delta.to_array().map(f64::from);
        let angle = (x * x + y * y + z * z).sqrt();
        let (sin, cos) = super::sin_cos(0.5 * angle);
        let k = if angle > 0.0 { sin / angle } else { 0.5 };
        let [x, y, z] = [x, y, z].map(|c| (c * k) as f32);
        Self { x, y, z, w: cos as f32 }.mul(self).normalized()
    }
    /// Whether no component is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.x * 0.0 + self.y * 0.0 + self.z * 0.0 + self.w * 0.0 == 0.0
    }
    /// Scaled to unit length from any length. The bits stay the same if the length is 1 to rounding. NaN if
    /// all components are 0.
    pub fn admitted(self) -> Self {
        let [x, y, z, w] = [self.x, self.y, self.z, self.w].map(f64::from);
        let square = x * x + y * y + z * z + w * w;
        if (square - 1.0).abs() <= super::UNIT_TOLERANCE {
            return self;
        }
        let length = square.sqrt();
        let [x, y, z, w] = [x, y, z, w].map(|c| (c / length) as f32);
        Self { x, y, z, w }
    }
}

/// Axes of the world along which a body does not move or about which it does not turn.
///
/// Bits as in Avian's `LockedAxes`: translation x, y, z at bits 5, 4, 3; rotation x, y, z at 2, 1, 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisLocks(pub u8);

impl AxisLocks {
    /// No locks.
    pub const NONE: Self = Self(0);

    /// The rotation bits; 0 if no rotation is locked.
    #[inline]
    pub fn rotation(self) -> u8 {
        self.0 & 0b000_111
    }
    /// 1 along the free axes, 0 along the locked ones.
    #[inline]
    pub fn translation_factors(self) -> Vector {
        let free = |bit: u8| if self.0 & bit == 0 { 1.0 } else { 0.0 };
        Vector { x: free(0b100_000), y: free(0b010_000), z: free(0b001_000) }
    }
    /// 1 about the free axes, 0 about the locked ones.
    #[inline]
    pub fn rotation_factors(self) -> Angular {
        let free = |bit: u8| if self.0 & bit == 0 { 1.0 } else { 0.0 };
        Vector { x: free(0b100), y: free(0b010), z: free(0b001) }
    }
    /// Whether any translation axis is locked.
    #[inline]
    pub fn is_translation_held(self) -> bool {
        self.0 & 0b111_000 != 0
    }
}

componentwise! { Vector { x, y, z } }
