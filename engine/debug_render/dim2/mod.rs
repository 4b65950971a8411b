//! The lines of 2D: boxes, axes, arrows. `dim3` exports the same names.

pub(super) mod joints;
#[cfg(feature = "default-collider")]
pub(super) mod outline;
#[cfg(all(test, feature = "default-collider"))]
pub(super) mod shapes;

use bevy_color::{Color, palettes::css};
use bevy_math::{Affine3A, Quat, Vec3};
use bevy_transform::components::GlobalTransform;

use crate::{
    dynamics::joints::JointCoordinate,
    math::{AsF32, Vector},
    physics_transform::Rotation,
};

/// A point in the plane of gizmos.
pub(in crate::debug_render) fn point(v: Vector) -> Vec3 {
    v.f32().extend(0.0)
}

/// The frame of a pose.
pub(in crate::debug_render) fn frame(position: Vector, rotation: Rotation) -> Affine3A {
    Affine3A::from_rotation_translation(Quat::from_rotation_z(rotation.as_radians() as f32), point(position))
}

/// The frame in which an entity is drawn, with the given rotation and without scale. It is at z = 0, so that
/// lines are drawn over all meshes.
pub(in crate::debug_render) fn drawn_frame(transform: &GlobalTransform, rotation: Quat) -> Affine3A {
    Affine3A::from_rotation_translation(rotation, transform.translation().with_z(0.0))
}

/// The edges of a box as one line.
pub(in crate::debug_render) fn edges(min: Vec3, max: Vec3) -> [Vec3; 5] {
    let corner = |x, y| Vec3::new(x, y, 0.0);
    [
        corner(min.x, min.y),
        corner(max.x, min.y),
        corner(max.x, max.y),
        corner(min.x, max.y),
        corner(min.x, min.y),
    ]
}

/// The axes of a body, with their colors.
pub(in crate::debug_render) fn axes(lengths: Vector) -> [(Vec3, Color); 2] {
    let l = point(lengths);
    [(Vec3::X * l.x, css::RED.into()), (Vec3::Y * l.y, Color::srgb(0.0, 1.0, 0.0))]
}

/// The directions in which the head of an arrow spreads.
pub(in crate::debug_render) fn spread(direction: Vec3) -> [Vec3; 2] {
    let side = Vec3::new(-direction.y, direction.x, 0.0);
    [side, -side]
}

/// The direction of a coordinate's axis in a frame.
pub(super) fn direction(coordinate: JointCoordinate) -> Vec3 {
    match coordinate {
        JointCoordinate::X => Vec3::X,
        JointCoordinate::Y => Vec3::Y,
        JointCoordinate::Angle => Vec3::Z,
    }
}
