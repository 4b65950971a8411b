//! Queries of two colliders by parry, if the kernel does not support both shapes.

use super::{Collider, dim};
use crate::math::{Scalar, Vector};
use crate::parry::query::{ShapeCastOptions, cast_shapes, intersection_test};
use crate::physics_transform::{Position, Rotation};

/// A collider and its pose.
type Placed<'a> = (&'a Collider, (Position, Rotation));

/// Settings of a shape cast.
pub(crate) struct ForeignCast {
    /// Unit vector in the world.
    pub(crate) direction: Vector,
    /// In metres.
    pub(crate) max_distance: Scalar,
    /// The distance at which shapes meet, in metres.
    pub(crate) target_distance: Scalar,
    /// Whether to compute points and normals of shapes that overlap at the start.
    pub(crate) compute_contact: bool,
    /// Whether to ignore shapes that overlap at the start.
    pub(crate) ignore_penetration: bool,
}

/// The hit of a cast shape. Points and normals are on the collider, then on the shape, in the world.
pub(crate) struct ForeignHit {
    pub(crate) distance: Scalar,
    pub(crate) points: [Vector; 2],
    pub(crate) normals: [Vector; 2],
}

/// The first hit of the moving shape `b` on collider `a`.
pub(crate) fn cast_foreign(a: Placed, b: Placed, cast: &ForeignCast) -> Option<ForeignHit> {
    let [pose_a, pose_b] = [a.1, b.1].map(|(position, rotation)| dim::pose(position.0, rotation));
    if !(pose_a.is_finite() && pose_b.is_finite()) {
        return None;
    }
    let options = ShapeCastOptions {
        max_time_of_impact: cast.max_distance,
        target_distance: cast.target_distance,
        stop_at_penetration: !cast.ignore_penetration,
        compute_impact_geometry_on_penetration: cast.compute_contact,
    };
    let (shape_a, shape_b) = (&**a.0.shape_scaled(), &**b.0.shape_scaled());
    let hit = cast_shapes(&pose_a, Vector::ZERO, shape_a, &pose_b, cast.direction, shape_b, options);
    let hit = hit.ok().flatten()?;
    let distance = hit.time_of_impact;
    let shift = cast.direction * distance;
    let found = ForeignHit {
        distance,
        points: [pose_a * hit.witness1, pose_b * hit.witness2 + shift],
        normals: [pose_a.rotation * hit.normal1, pose_b.rotation * hit.normal2],
    };
    let finite = found.points.iter().chain(&found.normals).all(|v| v.is_finite());
    (finite && distance >= 0.0 && distance <= cast.max_distance).then_some(found)
}

/// Whether two colliders touch or overlap.
pub(crate) fn overlaps_foreign(a: Placed, b: Placed) -> bool {
    let [pose_a, pose_b] = [a.1, b.1].map(|(position, rotation)| dim::pose(position.0, rotation));
    pose_a.is_finite()
        && pose_b.is_finite()
        && intersection_test(&pose_a, &**a.0.shape_scaled(), &pose_b, &**b.0.shape_scaled()) == Ok(true)
}
