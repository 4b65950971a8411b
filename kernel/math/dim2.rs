//! The algebra of the plane. `dim3.rs` has the same types with the same operations.

use super::{Lane, Num, Scalar};

/// The number of spatial dimensions.
pub const DIM: usize = 2;
/// Maximum number of points of a manifold after reduction.
pub const MAX_POINTS: usize = 2;

/// A direction, offset or linear velocity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Vector<N = f32> {
    /// Rightwards.
    pub x: N,
    /// Upwards.
    pub y: N,
}

/// An angular velocity, torque or moment: a number about the axis out of the plane, counter-clockwise.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct Angular<N = f32> {
    /// About the axis out of the plane.
    pub z: N,
}

/// A moment of inertia, in kg·m².
pub type Inertia<N = f32> = SymTensor<N>;

/// The inverse of a moment of inertia, in 1 / (kg·m²). A body with 0 does not turn.
pub type InvInertia<N = f32> = SymTensor<N>;

/// An [`Inertia`] or an [`InvInertia`]: in the plane one number.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C)]
pub struct SymTensor<N = f32> {
    /// About the axis out of the plane.
    pub zz: N,
}

/// A rotation, as the cosine and sine of its angle.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Rot<N = f32> {
    /// The cosine of the angle.
    pub cos: N,
    /// The sine of the angle.
    pub sin: N,
}

impl Vector {
    /// The unit vector to the right.
    pub const X: Self = Self { x: 1.0, y: 0.0 };
    /// The unit vector upwards.
    pub const Y: Self = Self { x: 0.0, y: 1.0 };
    /// All components 1.
    pub const ONE: Self = Self::splat_const(1.0);
    /// The unit vectors.
    pub const AXES: [Self; DIM] = [Self::X, Self::Y];

    const fn splat_const(v: f32) -> Self {
        Self { x: v, y: v }
    }

    /// Makes a vector from its components.
    #[inline]
    pub const fn from_array(v: [f32; DIM]) -> Self {
        Self { x: v[0], y: v[1] }
    }

    /// The components, in order.
    #[inline]
    pub const fn to_array(self) -> [f32; DIM] {
        [self.x, self.y]
    }

    /// Widens a local vector to world precision.
    #[inline(always)]
    pub fn to_world(self) -> Vector<Scalar> {
        Vector { x: self.x as Scalar, y: self.y as Scalar }
    }

    /// The vector turned by a quarter counter-clockwise.
    #[inline]
    pub fn perp(self) -> Self {
        Self { x: -self.y, y: self.x }
    }

    /// The scalar cross product, `x1 y2 − y1 x2`.
    #[inline]
    pub fn perp_dot(self, other: Self) -> f32 {
        self.x * other.y - self.y * other.x
    }

    /// The same vector in `f64`.
    #[inline(always)]
    pub(crate) fn widen(self) -> Vector<f64> {
        Vector { x: f64::from(self.x), y: f64::from(self.y) }
    }

    /// Each component's absolute value.
    #[inline]
    pub fn abs(self) -> Self {
        Self { x: self.x.abs(), y: self.y.abs() }
    }

    /// The componentwise minimum.
    #[inline]
    pub fn min(self, other: Self) -> Self {
        Self { x: super::min(self.x, other.x), y: super::min(self.y, other.y) }
    }

    /// The componentwise maximum.
    #[inline]
    pub fn max(self, other: Self) -> Self {
        Self { x: super::max(self.x, other.x), y: super::max(self.y, other.y) }
    }

    /// The smallest component.
    #[inline]
    pub fn min_element(self) -> f32 {
        super::min(self.x, self.y)
    }

    /// The largest component.
    #[inline]
    pub fn max_element(self) -> f32 {
        super::max(self.x, self.y)
    }

    /// Whether no component is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        // `x * 0.0` is 0 unless x is infinite or NaN. The sum needs no branch.
        self.x * 0.0 + self.y * 0.0 == 0.0
    }
}

impl Vector<Scalar> {
    /// Narrows a difference of world positions.
    #[inline(always)]
    pub fn to_local(self) -> Vector {
        Vector { x: self.x as f32, y: self.y as f32 }
    }

    /// Applies `f` to each component, for rounding modes other than to nearest.
    #[inline]
    pub fn map_to_f32(self, f: impl Fn(Scalar) -> f32) -> Vector {
        Vector { x: f(self.x), y: f(self.y) }
    }

    /// Whether no component of a world position is infinite or NaN.
    #[inline]
    pub fn is_finite_world(self) -> bool {
        // `x * 0.0` is 0 unless x is infinite or NaN. The sum needs no branch.
        self.x * 0.0 + self.y * 0.0 == 0.0
    }
}

impl Vector<f64> {
    /// Rounded to `f32`.
    #[inline(always)]
    pub(crate) fn narrow(self) -> Vector {
        Vector { x: self.x as f32, y: self.y as f32 }
    }

    /// The largest absolute value of a component; infinite if a component is not finite.
    pub(crate) fn largest(self) -> f64 {
        let finite = self.x * 0.0 + self.y * 0.0 == 0.0;
        if finite { self.x.abs().max(self.y.abs()) } else { f64::INFINITY }
    }
}

impl<N: Num> Vector<N> {
    /// All components 0.
    pub const ZERO: Self = Self { x: N::ZERO, y: N::ZERO };

    /// The dot product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> N {
        self.x * other.x + self.y * other.y
    }
    /// The cross product `self × other`, as a moment.
    #[inline(always)]
    pub fn cross(self, other: Self) -> Angular<N> {
        Angular { z: self.x * other.y - self.y * other.x }
    }
    /// The componentwise product.
    #[inline(always)]
    pub fn scale(self, other: Self) -> Self {
        Self { x: self.x * other.x, y: self.y * other.y }
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
        Self { x: N::splat(v.x), y: N::splat(v.y) }
    }
    /// Reads lane `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Vector {
        Vector { x: self.x.get(i), y: self.y.get(i) }
    }
    /// Writes lane `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: Vector) {
        self.x.set(i, v.x);
        self.y.set(i, v.y);
    }
}

impl<N: Num> Angular<N> {
    /// No turn.
    pub const ZERO: Self = Self { z: N::ZERO };

    /// The velocity `ω × r` of a point at `r`.
    #[inline(always)]
    pub fn cross(self, r: Vector<N>) -> Vector<N> {
        Vector { x: -self.z * r.y, y: self.z * r.x }
    }
    /// The dot product.
    #[inline(always)]
    pub fn dot(self, other: Self) -> N {
        self.z * other.z
    }
    /// The dot product with itself.
    #[inline(always)]
    pub fn length_squared(self) -> N {
        self.z * self.z
    }
}

impl<N: Lane> Angular<N> {
    /// The magnitude. For -0 it is 0, so a quotient by it does not become -∞.
    #[inline(always)]
    pub fn length(self) -> N {
        (-self.z).max(self.z) + N::ZERO
    }
    /// Reads lane `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Angular {
        Angular { z: self.z.get(i) }
    }
    /// Writes lane `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, w: Angular) {
        self.z.set(i, w.z);
    }
}

impl Angular {
    /// Whether the value is neither infinite nor NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.z.is_finite()
    }
}

impl<N: Num> SymTensor<N> {
    /// All entries 0.
    pub const ZERO: Self = Self { zz: N::ZERO };

    /// Every entry times a factor.
    #[inline(always)]
    pub fn scaled(self, factor: N) -> Self {
        Self { zz: self.zz * factor }
    }
    /// The product with a vector. For an [`InvInertia`] it is the change of angular velocity by an angular
    /// impulse.
    #[inline(always)]
    pub fn apply(self, impulse: Angular<N>) -> Angular<N> {
        Angular { z: self.zz * impulse.z }
    }
}

impl<N: Lane> SymTensor<N> {
    /// `a` where the mask is set, else `b`.
    #[inline(always)]
    pub(crate) fn select(mask: N::Mask, a: Self, b: Self) -> Self {
        Self { zz: N::select(mask, a.zz, b.zz) }
    }

    /// R I R⁻¹; in 2D the same.
    #[inline(always)]
    pub(crate) fn turned(self, _rotation: Rot<N>) -> Self {
        self
    }

    /// Sum of the eigenvalues.
    #[inline(always)]
    pub fn trace(self) -> N {
        self.zz
    }

    /// Reads lane `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> SymTensor {
        SymTensor { zz: self.zz.get(i) }
    }

    /// Writes lane `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: SymTensor) {
        self.zz.set(i, v.zz);
    }
}

impl SymTensor {
    /// The inverse inertia in world axes of a body turned by `rotation`; in 2D it stays the same.
    #[inline]
    pub fn rotated(self, _rotation: Rot) -> Self {
        self
    }
    /// The tensor that [`rotated`](Self::rotated) turns.
    #[inline]
    pub(crate) fn blunt(self) -> Self {
        self
    }
    /// The inverse inertia of a body that does not turn about the axes in `locks`.
    #[inline]
    pub fn locked(self, locks: AxisLocks) -> Self {
        if locks.rotation() == 0 { self } else { Self::ZERO }
    }
}

impl<N: Num> Default for Rot<N> {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl<N: Num> Rot<N> {
    /// No turn.
    pub const IDENTITY: Self = Self { cos: N::ONE, sin: N::ZERO };

    /// Turns a vector.
    #[inline(always)]
    pub fn rotate(self, v: Vector<N>) -> Vector<N> {
        Vector { x: self.cos * v.x - self.sin * v.y, y: self.sin * v.x + self.cos * v.y }
    }
    /// Turns a vector the other way.
    #[inline(always)]
    pub fn inverse_rotate(self, v: Vector<N>) -> Vector<N> {
        Vector { x: self.cos * v.x + self.sin * v.y, y: self.cos * v.y - self.sin * v.x }
    }
    /// The rotation the other way.
    #[inline(always)]
    pub fn inverse(self) -> Self {
        Self { cos: self.cos, sin: -self.sin }
    }
    /// `other` first, then `self`. Not renormalised.
    #[inline(always)]
    pub fn mul(self, other: Self) -> Self {
        Self {
            cos: self.cos * other.cos - self.sin * other.sin,
            sin: self.sin * other.cos + self.cos * other.sin,
        }
    }
    /// The displacement of the tip of `arm` along `normal` when the arm turns: n · (R r − r), given r × n.
    /// In 2D (cos − 1) n · r + sin (r × n).
    #[inline(always)]
    pub fn shift_along(self, arm: Vector<N>, arm_cross_normal: Angular<N>, normal: Vector<N>) -> N {
        (self.cos - N::ONE) * arm.dot(normal) + self.sin * arm_cross_normal.z
    }
    /// The displacement of a vector when it is turned the other way: R⁻¹ v − v.
    #[inline(always)]
    pub fn unturn(self, v: Vector<N>) -> Vector<N> {
        let less = self.cos - N::ONE;
        Vector { x: less * v.x + self.sin * v.y, y: less * v.y - self.sin * v.x }
    }
    /// Turns a vector by a small turn. Its length stays exact to rounding even after many turns.
    #[inline(always)]
    pub fn turn_little(self, v: Vector<N>) -> Vector<N> {
        // 1 − cos = sin² / (1 + cos), without cancellation.
        let less = self.sin * self.sin / (N::ONE + self.cos);
        Vector { x: v.x - (less * v.x + self.sin * v.y), y: v.y - (less * v.y - self.sin * v.x) }
    }
    /// Scaled to unit length.
    #[inline(always)]
    pub fn normalized(self) -> Self {
        let length = (self.cos * self.cos + self.sin * self.sin).sqrt();
        Self { cos: self.cos / length, sin: self.sin / length }
    }
    /// Turned further by the small angle `delta`, by one normalised Euler step `q + ½ δ q`.
    #[inline(always)]
    pub fn integrated(self, delta: Angular<N>) -> Self {
        Self { cos: self.cos - delta.z * self.sin, sin: self.sin + delta.z * self.cos }.normalized()
    }
}

impl<N: Lane> Rot<N> {
    /// Scaled to unit length. Lengths within 0.05 % of 1, as after a product, use three terms of (1 + e)^-½:
    /// cheap, and exact to rounding.
    #[inline(always)]
    pub fn renormalized(self) -> Self {
        let e = self.cos * self.cos + self.sin * self.sin - N::ONE;
        let near = self.scaled(N::ONE - e * (N::splat(0.5) - N::splat(0.375) * e));
        let far = N::lt(N::splat(1.0e-6), e * e);
        if N::any(far) { Self::select(far, self.normalized(), near) } else { near }
    }
    /// The rotation vector of a small turn: the sine of its angle.
    #[inline(always)]
    pub fn small_turn(self) -> Angular<N> {
        Angular { z: self.sin }
    }
    /// The small turn from one rotation to another.
    #[inline(always)]
    pub fn difference(self, other: Self) -> Angular<N> {
        self.inverse().mul(other).small_turn()
    }
    /// The cosine of the rotation's angle.
    #[inline(always)]
    pub fn cos_angle(self) -> N {
        self.cos
    }
    /// The rotation of lane `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> Rot {
        Rot { cos: self.cos.get(i), sin: self.sin.get(i) }
    }
    /// Sets the rotation of lane `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: Rot) {
        self.cos.set(i, v.cos);
        self.sin.set(i, v.sin);
    }
    fn scaled(self, factor: N) -> Self {
        Self { cos: self.cos * factor, sin: self.sin * factor }
    }
    /// `a` where the mask is set, else `b`.
    #[inline(always)]
    pub fn select(mask: N::Mask, a: Self, b: Self) -> Self {
        Self { cos: N::select(mask, a.cos, b.cos), sin: N::select(mask, a.sin, b.sin) }
    }
}

impl Rot {
    /// The same rotation in `f64`, of unit length.
    #[inline]
    pub(crate) fn widen(self) -> Rot<f64> {
        Rot { cos: f64::from(self.cos), sin: f64::from(self.sin) }.normalized()
    }
    /// The rotation by an angle in radians, counter-clockwise.
    pub fn from_angle(angle: f32) -> Self {
        let (sin, cos) = super::sin_cos(f64::from(angle));
        Self { cos: cos as f32, sin: sin as f32 }
    }
    /// The angle of the rotation, with the number of whole turns that brings it nearest to `hint`.
    pub fn angle_near(self, hint: Angular) -> Angular {
        let angle = super::atan2(f64::from(self.sin), f64::from(self.cos));
        let turns = ((f64::from(hint.z) - angle) / core::f64::consts::TAU).round();
        Angular { z: (angle + turns * core::f64::consts::TAU) as f32 }
    }
    /// Turned further by the angle `delta`, of any size.
    pub fn turned_by(self, delta: Angular) -> Self {
        Self::from_angle(delta.z).mul(self).normalized()
    }
    /// Scaled to unit length from any length. The bits stay the same if the length is 1 to rounding. NaN if
    /// all components are 0.
    pub fn admitted(self) -> Self {
        let [cos, sin] = [self.cos, self.sin].map(f64::from);
        let square = cos * cos + sin * sin;
        if (square - 1.0).abs() <= super::UNIT_TOLERANCE {
            return self;
        }
        let length = square.sqrt();
        Self { cos: (cos / length) as f32, sin: (sin / length) as f32 }
    }
    /// Whether no component is infinite or NaN.
    #[inline]
    pub fn is_finite(self) -> bool {
        self.cos * 0.0 + self.sin * 0.0 == 0.0
    }
    /// The columns of the rotation matrix: the rotated axes.
    #[inline]
    pub fn axes(self) -> [Vector; DIM] {
        [Vector { x: self.cos, y: self.sin }, Vector { x: -self.sin, y: self.cos }]
    }
}

/// Axes of the world along which a body does not move or about which it does not turn.
///
/// Bits as in Avian's `LockedAxes`: translation x, y at bits 5, 4; rotation at bit 0.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AxisLocks(pub u8);

impl AxisLocks {
    /// No locks.
    pub const NONE: Self = Self(0);

    /// The rotation bits; 0 if the rotation is not locked.
    #[inline]
    pub fn rotation(self) -> u8 {
        self.0 & 0b000_001
    }
    /// 1 along the free axes, 0 along the locked ones.
    #[inline]
    pub fn translation_factors(self) -> Vector {
        let free = |bit: u8| if self.0 & bit == 0 { 1.0 } else { 0.0 };
        Vector { x: free(0b100_000), y: free(0b010_000) }
    }
    /// 1 about the free axes, 0 about the locked ones.
    #[inline]
    pub fn rotation_factors(self) -> Angular {
        Angular { z: if self.rotation() == 0 { 1.0 } else { 0.0 } }
    }
    /// Whether any translation axis is locked.
    #[inline]
    pub fn is_translation_held(self) -> bool {
        self.0 & 0b110_000 != 0
    }
}

componentwise! { Vector { x, y } Angular { z } }
