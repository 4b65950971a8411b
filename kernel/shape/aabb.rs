//! The axis-aligned box of the trees. Always `f32`, rounded outward from `f64` positions.

use crate::math::{DIM, Rot, Vector, WorldVector};

/// An axis-aligned box. Empty if any `min` is above its `max`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Aabb {
    /// The lower corner, in metres.
    pub min: Vector,
    /// The upper corner, in metres.
    pub max: Vector,
}

impl Default for Aabb {
    fn default() -> Self {
        Self::EMPTY
    }
}

/// The largest `f32` that is not above `v`.
#[cfg(feature = "f64")]
fn round_down(v: f64) -> f32 {
    let r = v as f32;
    if f64::from(r) > v { r.next_down() } else { r }
}

/// The largest `f32` that is not above `v`.
#[cfg(not(feature = "f64"))]
#[inline(always)]
fn round_down(v: f32) -> f32 {
    v
}

impl Aabb {
    /// Contains nothing; the neutral element of [`union`](Self::union).
    pub const EMPTY: Self = Self {
        min: Vector::from_array([f32::INFINITY; DIM]),
        max: Vector::from_array([f32::NEG_INFINITY; DIM]),
    };
    /// Contains everything. The bounds are finite, so their differences are too.
    pub const EVERYTHING: Self =
        Self { min: Vector::from_array([-1.0e18; DIM]), max: Vector::from_array([1.0e18; DIM]) };

    /// The box with the given corners.
    #[inline]
    pub const fn new(min: Vector, max: Vector) -> Self {
        Self { min, max }
    }

    /// The smallest box around some points.
    pub fn around(points: impl IntoIterator<Item = Vector>) -> Self {
        points.into_iter().fold(Self::EMPTY, |b, p| Self { min: b.min.min(p), max: b.max.max(p) })
    }

    /// The box around this local box at a world position, rounded outward.
    #[inline]
    #[allow(clippy::useless_conversion, reason = "Scalar may be f32 or f64")]
    pub fn at(&self, position: WorldVector) -> Self {
        let (low, high) = (position + self.min.to_world(), -(position + self.max.to_world()));
        Self { min: low.map_to_f32(round_down), max: -high.map_to_f32(round_down) }
    }

    /// Whether the two boxes have a point in common; touching counts.
    #[inline(always)]
    pub fn overlaps(&self, other: &Self) -> bool {
        let a = self.min.to_array();
        let b = self.max.to_array();
        let c = other.min.to_array();
        let d = other.max.to_array();
        (0..DIM).fold(true, |all, i| all & (a[i] <= d[i]) & (c[i] <= b[i]))
    }

    /// The distance between the boxes along the axis with the largest distance, in metres; at most 0 if they
    /// overlap.
    #[inline(always)]
    pub fn gap(&self, other: &Self) -> f32 {
        (self.min - other.max).max(other.min - self.max).max_element()
    }

    /// Whether `other` lies in this box; touching from inside counts.
    #[inline(always)]
    pub fn contains(&self, other: &Self) -> bool {
        let a = self.min.to_array();
        let b = self.max.to_array();
        let c = other.min.to_array();
        let d = other.max.to_array();
        (0..DIM).fold(true, |all, i| all & (a[i] <= c[i]) & (d[i] <= b[i]))
    }

    /// The smallest box around both.
    #[inline(always)]
    pub fn union(&self, other: &Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The intersection of both; empty if they do not overlap.
    #[inline]
    pub fn intersection(&self, other: &Self) -> Self {
        Self { min: self.min.max(other.min), max: self.max.min(other.max) }
    }

    /// The box with every face moved outward by `margin` metres.
    #[inline]
    pub fn grown(&self, margin: f32) -> Self {
        let m = Vector::ONE * margin;
        Self { min: self.min - m, max: self.max + m }
    }

    /// The box swept along `motion`.
    #[inline]
    pub fn swept(&self, motion: Vector) -> Self {
        Self { min: self.min + motion.min(Vector::ZERO), max: self.max + motion.max(Vector::ZERO) }
    }

    /// The box around this box turned by `rotation` about the origin.
    pub fn rotated(&self, rotation: Rot) -> Self {
        let center = rotation.rotate(self.center());
        let half = rotate_half(self.half(), rotation);
        Self { min: center - half, max: center + half }
    }

    /// The middle.
    #[inline]
    pub fn center(&self) -> Vector {
        (self.min + self.max) * 0.5
    }

    /// Half of the size.
    #[inline]
    pub fn half(&self) -> Vector {
        (self.max - self.min) * 0.5
    }

    /// A measure of how likely a random ray or box is to hit: half the perimeter in 2D, half the surface in
    /// 3D.
    #[inline]
    pub fn cost(&self) -> f32 {
        let d = (self.max - self.min).to_array();
        if DIM == 2 { d[0] + d[1] } else { d[0] * d[1] + d[DIM - 1] * (d[0] + d[1]) }
    }

    /// The corners.
    pub fn corners(&self) -> [Vector; 1 << DIM] {
        core::array::from_fn(|i| {
            let (a, b) = (self.min.to_array(), self.max.to_array());
            Vector::from_array(core::array::from_fn(|k| if i >> k & 1 == 0 { a[k] } else { b[k] }))
        })
    }

    /// Whether all bounds are numbers and no `min` is above its `max`.
    pub fn is_valid(&self) -> bool {
        let (a, b) = (self.min.to_array(), self.max.to_array());
        (0..DIM).all(|i| a[i].is_finite() && b[i].is_finite() && a[i] <= b[i])
    }

    /// The distance along a ray at which it enters the box, 0 if it starts inside; `None` if it misses the
    /// box or enters it beyond `max_distance`. `inverse` is the componentwise inverse of the direction.
    #[inline]
    pub fn ray_entry(&self, origin: Vector, inverse: Vector, max_distance: f32) -> Option<f32> {
        let (mut enter, mut exit) = (0.0f32, max_distance);
        let (lo, hi) = (self.min.to_array(), self.max.to_array());
        let (o, inv) = (origin.to_array(), inverse.to_array());
        for i in 0..DIM {
            // For a ray along a face, 0 · ∞ is NaN, which the min/max rule drops.
            let (a, b) = ((lo[i] - o[i]) * inv[i], (hi[i] - o[i]) * inv[i]);
            enter = crate::math::max(crate::math::min(a, b), enter);
            exit = crate::math::min(crate::math::max(a, b), exit);
        }
        (enter <= exit).then_some(enter)
    }
}

/// The half size of a box of half size `half` turned by `rotation`: |R| half.
#[inline]
pub(super) fn rotate_half(half: Vector, rotation: Rot) -> Vector {
    let axes = rotation.axes();
    let h = half.to_array();
    (0..DIM).fold(Vector::ZERO, |sum, i| sum + axes[i].abs() * h[i])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_overlap_and_contain() {
        let a = Aabb::new(Vector::ZERO, Vector::ONE);
        let b = Aabb::new(Vector::ONE, Vector::ONE * 2.0);
        assert!(a.overlaps(&b) && b.overlaps(&a), "touching counts");
        assert!(!a.overlaps(&Aabb::new(Vector::ONE * 1.01, Vector::ONE * 2.0)));
        assert!(a.union(&b).contains(&a) && !a.contains(&b));
        assert!(!Aabb::EMPTY.overlaps(&a) && Aabb::EVERYTHING.contains(&a));
        assert_eq!(Aabb::EMPTY.union(&a), a);
    }

    #[test]
    fn a_world_box_contains_what_it_surrounds_at_any_distance() {
        let local = Aabb::new(Vector::ONE * -0.3, Vector::ONE * 0.7);
        for k in 0..20 {
            let position = Vector::ONE.to_world() * (1.1 + 12_345.678 * k as crate::math::Scalar);
            let b = local.at(position);
            for i in 0..DIM {
                let (lo, hi) = (b.min.to_array()[i], b.max.to_array()[i]);
                let p = position.x;
                assert!(lo as crate::math::Scalar <= p + (-0.3f32) as crate::math::Scalar);
                assert!(hi as crate::math::Scalar >= p + 0.7f32 as crate::math::Scalar);
            }
        }
    }

    #[test]
    fn rays_enter_boxes() {
        let b = Aabb::new(Vector::ONE * -1.0, Vector::ONE);
        let inverse = Vector::from_array(Vector::X.to_array().map(|v| 1.0 / v));
        let from = Vector::X * -3.0;
        assert_eq!(b.ray_entry(from, inverse, 10.0), Some(2.0));
        assert_eq!(b.ray_entry(from, inverse, 1.0), None);
        assert_eq!(b.ray_entry(Vector::ZERO, inverse, 10.0), Some(0.0));
        assert_eq!(b.ray_entry(from + Vector::Y * 3.0, inverse, 10.0), None);
    }
}
