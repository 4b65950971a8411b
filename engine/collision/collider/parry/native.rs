//! Converts parry's shapes for the kernel: to a native shape if the kernel supports it, otherwise to a box
//! whose contacts parry computes.

use super::super::custom::{round_down, round_up};
use super::{dim, native_composite};
use crate::math::{Scalar, Vector, vector_to_kernel};
use crate::parry::shape::{Compound, SharedShape, TypedShape};
use kernel::shape::{Aabb, Ball, Capsule, Cuboid, Foreign, HalfSpace, Segment, Shape, Triangle};

/// The kernel's shape for a shape of parry, in `f32`.
///
/// Balls, capsules, cuboids, triangles, segments, half-spaces, ellipses, cylinders and cones become
/// themselves. Convex polygons and polyhedra with or without a radius, regular polygons, round rectangles and
/// boxes become hulls, if the kernel has room for their features. Meshes, lines, height fields, voxels and
/// compounds of native shapes become composites. All other shapes, and shapes with coordinates that are not
/// finite, are foreign.
pub(crate) fn native_shape(shape: &SharedShape) -> Shape {
    native(shape.as_typed_shape()).unwrap_or_else(|| Shape::Foreign(foreign(shape)))
}

fn native(shape: TypedShape<'_>) -> Option<Shape> {
    let native = match shape {
        TypedShape::Ball(ball) => Shape::Ball(Ball { radius: size(ball.radius)? }),
        TypedShape::Capsule(capsule) => Shape::Capsule(Capsule {
            a: point(capsule.segment.a)?,
            b: point(capsule.segment.b)?,
            radius: size(capsule.radius)?,
        }),
        TypedShape::Cuboid(cuboid) => {
            let half = cuboid.half_extents;
            size(half.min_element())?;
            Shape::Cuboid(Cuboid { half: point(half)? })
        }
        TypedShape::Triangle(t) => {
            Shape::Triangle(Triangle { a: point(t.a)?, b: point(t.b)?, c: point(t.c)? })
        }
        TypedShape::Segment(s) => Shape::Segment(Segment { a: point(s.a)?, b: point(s.b)? }),
        TypedShape::HalfSpace(half_space) => {
            Shape::HalfSpace(HalfSpace { normal: point(half_space.normal)? })
        }
        TypedShape::Compound(parts) => compound(parts)?,
        TypedShape::Voxels(voxels) => native_composite::voxels(voxels)?,
        other => dim::native_of_dimension(other)?,
    };
    Some(native)
}

/// A compound, if all its parts are native and convex.
fn compound(compound: &Compound) -> Option<Shape> {
    let parts = compound
        .shapes()
        .iter()
        .map(|(pose, part)| Some((dim::pose_to_kernel(pose), native(part.as_typed_shape())?)));
    Shape::compound(parts.collect::<Option<_>>()?).ok()
}

/// A finite length that is not negative.
fn size(value: Scalar) -> Option<f32> {
    let value = value as f32;
    (value.is_finite() && value >= 0.0).then_some(value)
}

/// A finite point.
fn point(value: Vector) -> Option<kernel::math::Vector> {
    let value = vector_to_kernel(value);
    value.is_finite().then_some(value)
}

/// The box of a shape in its own frame, rounded outward.
fn foreign(shape: &SharedShape) -> Foreign {
    let aabb = shape.compute_local_aabb();
    let outward = |corner: Vector, rounded: fn(Scalar) -> f32| {
        kernel::math::Vector::from_array(corner.to_array().map(rounded))
    };
    let aabb = Aabb { min: outward(aabb.mins, round_down), max: outward(aabb.maxs, round_up) };
    // A custom shape may have an invalid box. The shape then touches nothing.
    Foreign { aabb: if aabb.is_valid() { aabb } else { Aabb::around([kernel::math::Vector::ZERO]) } }
}
