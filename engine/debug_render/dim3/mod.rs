//! The lines of 3D: boxes, axes, arrows. `dim2` exports the same names.

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

/// A point in the space of gizmos.
pub(in crate::debug_render) fn point(v: Vector) -> Vec3 {
    v.f32()
}

/// The frame of a pose.
pub(in crate::debug_render) fn frame(position: Vector, rotation: Rotation) -> Affine3A {
    Affine3A::from_rotation_translation(rotation.0.f32(), point(position))
}

/// The frame in which an entity is drawn, with the given rotation and without scale.
pub(in crate::debug_render) fn drawn_frame(transform: &GlobalTransform, rotation: Quat) -> Affine3A {
    Affine3A::from_rotation_translation(rotation, transform.translation())
}

/// The edges of a box as one line, four of them twice.
pub(in crate::debug_render) fn edges(min: Vec3, max: Vec3) -> [Vec3; 16] {
    let corner = |i: u8| {
        let side = |axis: u8, min, max| if i >> axis & 1 == 1 { max } else { min };
        Vec3::new(side(0, min.x, max.x), side(1, min.y, max.y), side(2, min.z, max.z))
    };
    [0, 1, 3, 2, 0, 4, 5, 1, 5, 7, 3, 7, 6, 2, 6, 4].map(corner)
}

/// The axes of a body, with their colors.
pub(in crate::debug_render) fn axes(lengths: Vector) -> [(Vec3, Color); 3] {
    let l = point(lengths);
    [
        (Vec3::X * l.x, css::RED.into()),
        (Vec3::Y * l.y, Color::srgb(0.0, 1.0, 0.0)),
        (Vec3::Z * l.z, css::BLUE.into()),
    ]
}

/// The directions in which the head of an arrow spreads.
pub(in crate::debug_render) fn spread(direction: Vec3) -> [Vec3; 4] {
    let (a, b) = direction.any_orthonormal_pair();
    [a, -a, b, -b]
}

/// The direction of a coordinate's axis in a frame.
pub(super) fn direction(coordinate: JointCoordinate) -> Vec3 {
    match coordinate {
        JointCoordinate::X | JointCoordinate::Twist => Vec3::X,
        JointCoordinate::Y | JointCoordinate::SwingY => Vec3::Y,
        JointCoordinate::Z | JointCoordinate::SwingZ => Vec3::Z,
    }
}
