//! 2D parts of the testbed.

use avian2d::math::{Scalar, Vector};
use avian2d::parry::math::{Pose, Rotation as PoseRotation};
use avian2d::parry::shape::{Shape, TypedShape};
use avian2d::prelude::*;
use bevy_math::{Vec2, Vec3};
use bevy_transform::components::GlobalTransform;

use crate::draw::Form;
use crate::draw::form::Outline;

/// Number of dimensions.
pub const DIMENSION: u32 = 2;
/// Keeps of a point what lies in the plane.
pub const PLANE: Vec3 = Vec3::new(1.0, 1.0, 0.0);
/// How far a half-space is drawn, in metres.
const HORIZON: f32 = 500.0;

/// A point of the plane in space.
pub fn lifted(point: Vector) -> Vec3 {
    point.extend(0.0)
}

/// Parry's pose of an entity.
pub fn pose(transform: &GlobalTransform) -> Pose {
    let (_, rotation, translation) = transform.to_scale_rotation_translation();
    // A turn by φ about z is the quaternion (0, 0, sin φ/2, cos φ/2).
    let (z, w) = (rotation.z, rotation.w);
    let rotation = PoseRotation::from_cos_sin_unchecked(w * w - z * z, 2.0 * w * z);
    Pose::from_parts(translation.truncate(), rotation)
}

/// Energy of turning, ½ I ω², in joules.
pub fn spin_energy(inertia: ComputedAngularInertia, spin: AngularVelocity, _rotation: Rotation) -> Scalar {
    if inertia.is_finite() { 0.5 * inertia.value() * spin.0 * spin.0 } else { 0.0 }
}

/// The geometry of a shape.
pub fn form(shape: &dyn Shape) -> Form {
    let mut outlines = Vec::new();
    add(shape, &Pose::IDENTITY, &mut outlines);
    Form::Flat(outlines)
}

fn add(shape: &dyn Shape, pose: &Pose, outlines: &mut Vec<Outline>) {
    let mut push = |mut outline: Outline| {
        for point in &mut outline.points {
            *point = pose.transform_point(*point);
        }
        outline.spoke = outline.spoke.map(|point| pose.transform_point(point));
        outlines.push(outline);
    };
    match shape.as_typed_shape() {
        TypedShape::Ball(ball) => push(Outline::circle(ball.radius)),
        TypedShape::Cuboid(cuboid) => push(Outline::polygon(cuboid.to_polyline())),
        TypedShape::Triangle(triangle) => push(Outline::polygon(vec![triangle.a, triangle.b, triangle.c])),
        TypedShape::ConvexPolygon(polygon) => push(Outline::polygon(polygon.points().to_vec())),
        TypedShape::Segment(segment) => push(Outline::line(vec![segment.a, segment.b])),
        TypedShape::HalfSpace(half_space) => {
            let (normal, along) = (half_space.normal * HORIZON, half_space.normal.perp() * HORIZON);
            push(Outline::polygon(vec![along, along - normal, -along - normal, -along]));
        }
        TypedShape::Polyline(line) => {
            line.segments().for_each(|s| push(Outline::line(vec![s.a, s.b])));
        }
        TypedShape::TriMesh(mesh) => {
            mesh.triangles().for_each(|t| push(Outline::polygon(vec![t.a, t.b, t.c])));
        }
        TypedShape::HeightField(field) => {
            field.segments().for_each(|s| push(Outline::line(vec![s.a, s.b])));
        }
        TypedShape::Voxels(voxels) => {
            let (points, segments) = voxels.to_polyline();
            for [a, b] in segments {
                push(Outline::line(vec![points[a as usize], points[b as usize]]));
            }
        }
        TypedShape::Compound(compound) => {
            for (place, part) in compound.shapes() {
                add(&**part, &(*pose * *place), outlines);
            }
        }
        TypedShape::RoundCuboid(round) => {
            push(rounded(round.border_radius, |d| support(&round.inner_shape, d)));
        }
        TypedShape::RoundTriangle(round) => {
            push(rounded(round.border_radius, |d| support(&round.inner_shape, d)));
        }
        TypedShape::RoundConvexPolygon(round) => {
            push(rounded(round.border_radius, |d| support(&round.inner_shape, d)));
        }
        TypedShape::Capsule(_) | TypedShape::Custom(_) => {
            if shape.as_support_map().is_some() {
                push(Outline::from_support(|d| support(shape, d)));
            }
        }
    }
}

fn support(shape: &dyn Shape, direction: Vec2) -> Vec2 {
    shape.as_support_map().map_or(Vec2::ZERO, |map| map.local_support_point(direction))
}

fn rounded(radius: f32, inner: impl Fn(Vec2) -> Vec2) -> Outline {
    Outline::from_support(|direction| inner(direction) + radius * direction)
}
