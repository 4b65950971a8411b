//! Rotations and hulls in 2D.

use avian::{
    math::{Scalar, Vector},
    prelude::{Collider, Rotation},
};

/// A rotation by an angle.
pub fn turned(angle: f64) -> Rotation {
    Rotation::radians(angle as Scalar)
}

/// The corners of a hull, of which parry leaves out those that lie nearly on a line.
pub fn corners_of(hull: &Collider) -> Vec<Vector> {
    hull.shape_scaled().as_convex_polygon().expect("a hull").points().to_vec()
}
