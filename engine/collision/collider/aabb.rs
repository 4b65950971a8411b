//! Boxes of a collider in the world: the tight one of this step, and the fat one in the trees.

use crate::math::{Scalar, Vector};
use bevy_derive::Deref;
use bevy_ecs::prelude::Component;
use bevy_ecs::reflect::ReflectComponent;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

/// The axis-aligned box around a collider in the world, in metres.
///
/// Updated by the engine in every step for colliders that moved.
#[derive(Reflect, Clone, Copy, Component, Debug, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct ColliderAabb {
    /// The lower corner.
    pub min: Vector,
    /// The upper corner.
    pub max: Vector,
}

crate::type_path::type_path!(ColliderAabb, "collision::collider");

impl Default for ColliderAabb {
    fn default() -> Self {
        Self::INVALID
    }
}

impl ColliderAabb {
    /// The empty box: merged with another box it gives that box.
    pub const INVALID: Self = Self { min: Vector::INFINITY, max: Vector::NEG_INFINITY };

    /// The box around `center` that reaches `half_size` to each side.
    pub fn new(center: Vector, half_size: Vector) -> Self {
        Self { min: center - half_size, max: center + half_size }
    }

    /// The box between two corners.
    pub fn from_min_max(min: Vector, max: Vector) -> Self {
        Self { min, max }
    }

    /// The box around a shape at the origin.
    #[cfg(feature = "default-collider")]
    pub fn from_shape(shape: &crate::parry::shape::SharedShape) -> Self {
        let aabb = shape.compute_local_aabb();
        Self { min: aabb.mins, max: aabb.maxs }
    }

    /// The middle.
    #[inline]
    pub fn center(self) -> Vector {
        self.min.midpoint(self.max)
    }

    /// The lengths of the sides.
    #[inline]
    pub fn size(self) -> Vector {
        self.max - self.min
    }

    /// The smallest box around both boxes.
    #[inline]
    pub fn merged(self, other: Self) -> Self {
        Self { min: self.min.min(other.min), max: self.max.max(other.max) }
    }

    /// The box with each side moved outward by `amount`.
    #[inline]
    pub fn grow(&self, amount: Vector) -> Self {
        Self { min: self.min - amount, max: self.max + amount }
    }

    /// The box with each side moved inward by `amount`. An axis on which the box is thinner than twice
    /// `amount` collapses to its middle.
    #[inline]
    pub fn shrink(&self, amount: Vector) -> Self {
        let center = self.center();
        Self { min: (self.min + amount).min(center), max: (self.max - amount).max(center) }
    }

    /// Whether two boxes overlap; touching counts.
    #[inline]
    pub fn intersects(&self, other: &Self) -> bool {
        self.min.cmple(other.max).all() && self.max.cmpge(other.min).all()
    }

    /// Whether `other` lies inside this box; touching counts.
    #[inline]
    pub fn contains(&self, other: &Self) -> bool {
        self.min.cmple(other.min).all() && self.max.cmpge(other.max).all()
    }
}

/// The box of a collider in the trees, larger than its [`ColliderAabb`]. The tree changes only when the tight
/// box leaves it.
#[derive(Reflect, Clone, Copy, Component, Debug, Default, Deref, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct EnlargedAabb(ColliderAabb);

crate::type_path::type_path!(EnlargedAabb, "collision::collider");

impl EnlargedAabb {
    /// An enlarged box that equals the given box.
    pub fn new(aabb: ColliderAabb) -> Self {
        Self(aabb)
    }

    /// If `aabb` is not inside this box, sets this box to `aabb` grown by `margin` (m) on all sides and
    /// returns true.
    pub fn update(&mut self, aabb: &ColliderAabb, margin: Scalar) -> bool {
        if self.0.contains(aabb) {
            return false;
        }
        self.0 = aabb.grow(Vector::splat(margin));
        true
    }

    /// The box.
    #[inline]
    pub fn get(&self) -> ColliderAabb {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_meet_contain_and_merge() {
        let a = ColliderAabb::new(Vector::ZERO, Vector::ONE);
        let b = ColliderAabb::from_min_max(Vector::ONE, Vector::ONE * 3.0);
        assert!(a.intersects(&b) && b.intersects(&a), "touching counts");
        assert!(!a.grow(Vector::splat(-0.1)).intersects(&b));
        assert_eq!(a.merged(b), ColliderAabb::from_min_max(Vector::NEG_ONE, Vector::ONE * 3.0));
        assert_eq!(ColliderAabb::INVALID.merged(a), a);
        assert!(a.merged(b).contains(&a) && !a.contains(&b) && !ColliderAabb::INVALID.contains(&a));
        assert_eq!((b.center(), b.size()), (Vector::ONE * 2.0, Vector::ONE * 2.0));
        assert_eq!(a.shrink(Vector::splat(0.25)).size(), Vector::splat(1.5));
        assert_eq!(a.shrink(Vector::splat(9.0)), ColliderAabb::new(Vector::ZERO, Vector::ZERO));
    }

    #[test]
    fn the_enlarged_box_moves_only_when_it_is_left() {
        let tight = ColliderAabb::new(Vector::ZERO, Vector::ONE);
        let mut fat = EnlargedAabb::default();
        assert!(fat.update(&tight, 0.5));
        assert_eq!(fat.get(), tight.grow(Vector::splat(0.5)));
        let moved = |x: Scalar| ColliderAabb::new(Vector::X * x, Vector::ONE);
        assert!(!fat.update(&moved(0.4), 0.5));
        assert!(fat.update(&moved(0.6), 0.5) && fat.min.x == moved(0.6).min.x - 0.5);
    }
}
