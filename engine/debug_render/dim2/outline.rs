//! Outlines of shapes that differ between dimensions, and of shapes that only 2D has.

use bevy_math::{Affine3A, Vec2, Vec3};

use crate::{
    collision::collider::{EllipseColliderShape, RegularPolygonColliderShape},
    debug_render::{
        curves::{FAR, arc, rounded},
        dim::{frame, point},
        lines::Strips,
    },
    math::{AsF32, Scalar, Vector},
    parry::{
        math::Pose,
        shape::{Cuboid, Shape, Triangle, TypedShape},
    },
    physics_transform::Rotation,
};

/// The place of a part.
pub(in crate::debug_render) fn place(pose: &Pose) -> Affine3A {
    frame(pose.translation, Rotation { cos: pose.rotation.re, sin: pose.rotation.im })
}

/// Adds the outline of a shape. Returns whether the shape is known.
pub(in crate::debug_render) fn add_of_dimension(shape: &TypedShape<'_>, lines: &mut Strips) -> bool {
    match shape {
        TypedShape::Ball(s) => polygon(&[Vector::ZERO], s.radius, lines),
        TypedShape::Capsule(s) => polygon(&[s.segment.a, s.segment.b], s.radius, lines),
        TypedShape::Cuboid(s) => polygon(&corners(s), 0.0, lines),
        TypedShape::RoundCuboid(s) => polygon(&corners(&s.inner_shape), s.border_radius, lines),
        TypedShape::Triangle(s) => polygon(&triangle(s), 0.0, lines),
        TypedShape::RoundTriangle(s) => polygon(&triangle(&s.inner_shape), s.border_radius, lines),
        TypedShape::ConvexPolygon(s) => polygon(s.points(), 0.0, lines),
        TypedShape::RoundConvexPolygon(s) => polygon(s.inner_shape.points(), s.border_radius, lines),
        TypedShape::HeightField(s) => s.segments().for_each(|s| lines.push([s.a, s.b].map(point))),
        TypedShape::HalfSpace(s) => {
            let (normal, along) = (point(s.normal), point(s.normal.perp()) * FAR);
            lines.push([-along, along]);
            lines.push([Vec3::ZERO, normal]);
        }
        TypedShape::Custom(s) => return custom(*s, lines),
        _ => return false,
    }
    true
}

fn polygon(corners: &[Vector], radius: Scalar, lines: &mut Strips) {
    let outline = rounded(corners.iter().map(Vector::f32).collect(), radius as f32);
    lines.push_closed(outline.into_iter().map(|p| p.extend(0.0)));
}

fn corners(cuboid: &Cuboid) -> [Vector; 4] {
    let Vector { x, y } = cuboid.half_extents;
    [Vector::new(-x, -y), Vector::new(x, -y), Vector::new(x, y), Vector::new(-x, y)]
}

fn triangle(triangle: &Triangle) -> [Vector; 3] {
    [triangle.a, triangle.b, triangle.c]
}

fn custom(shape: &dyn Shape, lines: &mut Strips) -> bool {
    if let Some(ellipse) = shape.as_shape::<EllipseColliderShape>() {
        let circle = arc(Vec2::ZERO, 1.0, 0.0, core::f32::consts::TAU);
        lines.push_closed(circle.into_iter().map(|p| (p * ellipse.half_size).extend(0.0)));
        return true;
    }
    let Some(regular) = shape.as_shape::<RegularPolygonColliderShape>() else { return false };
    lines.push_closed(regular.vertices(0.0).into_iter().map(|p| p.extend(0.0)));
    true
}
