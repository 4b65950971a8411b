//! Rotations and hulls in 3D.

use avian::{
    math::{Quaternion, Scalar, Vector},
    prelude::{Collider, Rotation},
};

/// A rotation by an angle, about an axis that is none of a shape's.
pub fn turned(angle: f64) -> Rotation {
    Rotation(Quaternion::from_axis_angle(Vector::new(1.0, 2.0, 3.0).normalize(), angle as Scalar))
}

/// The corners of a hull.
pub fn corners_of(hull: &Collider) -> Vec<Vector> {
    hull.shape_scaled().as_convex_polyhedron().expect("a hull").points().to_vec()
}
