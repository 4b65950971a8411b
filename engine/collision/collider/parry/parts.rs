//! The convex parts of a collider.

use super::{Collider, composite, dim};
use crate::parry::math::Pose;
use crate::physics_transform::{Position, Rotation};

impl Collider {
    /// The convex parts of the collider, at its scale, with their poses relative to it.
    ///
    /// The parts of a compound include the parts of nested compounds. The parts of meshes and height fields
    /// are their triangles (in 2D the segments of polylines and height fields), the parts of voxels are their
    /// boxes. A convex shape is its own only part.
    ///
    /// ```
    /// # use avian::{math::Vector, prelude::*};
    /// let line = Collider::polyline(vec![Vector::ZERO, Vector::X, Vector::ONE], None);
    /// let lengths: Vec<_> = line.parts().map(|(_, _, part)| part.shape().as_segment().unwrap().length()).collect();
    /// assert_eq!(lengths.len(), 2);
    /// assert_eq!(lengths[0], 1.0);
    /// ```
    pub fn parts(&self) -> impl Iterator<Item = (Position, Rotation, Self)> + use<> {
        let mut parts = Vec::new();
        composite::flatten(Pose::IDENTITY, self.shape_scaled(), &mut parts);
        parts.into_iter().map(|(pose, shape)| (Position(pose.translation), dim::rotation(pose), shape.into()))
    }
}
