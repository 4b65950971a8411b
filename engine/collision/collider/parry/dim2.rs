//! 2D parts of the default collider: poses, boxes, the kernel's polygons. `dim3.rs` exports the same names.

#[cfg(test)]
#[path = "tests2d.rs"]
mod tests;

use super::native_composite::{surface, surface_of_facets, unmoved};
use super::shapes::ellipse::EllipseColliderShape;
use super::shapes::regular_polygon::RegularPolygonColliderShape;
use crate::math::{AdjustPrecision, Scalar, Vector, vector_from_kernel, vector_to_kernel};
use crate::parry::math::{Pose, Rot2};
use crate::parry::shape::{HeightField, SharedShape, TypedShape};
use crate::physics_transform::Rotation;
use kernel::shape::{Shape as NativeShape, Surface};

/// The default of [`VhacdParameters::concavity`](super::VhacdParameters::concavity).
pub(super) const VHACD_CONCAVITY: Scalar = 0.1;
/// The default of [`VhacdParameters::resolution`](super::VhacdParameters::resolution).
pub(super) const VHACD_RESOLUTION: u32 = 256;
/// Maximum number of corners of a native polygon: the kernel numbers them in a byte.
const MAX_CORNERS: usize = 255;

/// A pose in parry's type.
pub(super) fn pose(position: Vector, rotation: Rotation) -> Pose {
    Pose::from_parts(position, Rot2::from_cos_sin_unchecked(rotation.cos, rotation.sin))
}

/// A relative pose of the kernel in parry's type.
pub(super) fn pose_from_kernel(pose: &kernel::math::Pose) -> Pose {
    let rotation = Rot2::from_cos_sin_unchecked(
        pose.rotation.cos.adjust_precision(),
        pose.rotation.sin.adjust_precision(),
    );
    Pose::from_parts(vector_from_kernel(pose.position), rotation)
}

/// A relative pose in the kernel's type.
pub(super) fn pose_to_kernel(pose: &Pose) -> kernel::math::Pose {
    kernel::math::Pose {
        position: vector_to_kernel(pose.translation),
        rotation: Rotation { cos: pose.rotation.re, sin: pose.rotation.im }.to_kernel(),
    }
}

/// The rotation of a pose of parry.
pub(super) fn rotation(pose: Pose) -> Rotation {
    Rotation { cos: pose.rotation.re, sin: pose.rotation.im }
}

/// The shape of the default collider.
pub(super) fn default_shape() -> SharedShape {
    cuboid_shape(Vector::splat(0.25))
}

/// A rectangle by its half extents.
pub(super) fn cuboid_shape(half: Vector) -> SharedShape {
    SharedShape::cuboid(half.x, half.y)
}

/// The segments of a height field.
pub(super) fn height_field_elements(field: &HeightField) -> impl Iterator<Item = SharedShape> + '_ {
    field.segments().map(SharedShape::new)
}

/// The scale along the axes of a part rotated by `rotation`. Exact for quarter turns. Otherwise the lengths
/// of the scaled axes, since no shape can be sheared.
pub(super) fn scale_in_frame(scale: Vector, rotation: Rot2) -> Vector {
    if scale.x == scale.y {
        return scale;
    }
    let axis = |a: Vector| ((rotation * a) * scale).length();
    Vector::new(axis(Vector::X), axis(Vector::Y))
}

/// Whether a hull has an area.
pub(super) fn is_solid(shape: &SharedShape) -> bool {
    let mass = shape.mass_properties(1.0).mass();
    mass.is_finite() && mass > 0.0
}

/// The kernel's shape for shapes that only 2D has.
pub(super) fn native_of_dimension(shape: TypedShape<'_>) -> Option<NativeShape> {
    match shape {
        TypedShape::ConvexPolygon(polygon) => native_polygon(polygon.points(), 0.0),
        TypedShape::RoundConvexPolygon(round) => {
            native_polygon(round.inner_shape.points(), round.border_radius)
        }
        TypedShape::RoundTriangle(round) => {
            native_polygon(&round.inner_shape.vertices()[..], round.border_radius)
        }
        TypedShape::RoundCuboid(round) => {
            let h = round.inner_shape.half_extents;
            let corners = [-h, Vector::new(h.x, -h.y), h, Vector::new(-h.x, h.y)];
            native_polygon(&corners, round.border_radius)
        }
        TypedShape::Polyline(line) => {
            surface(line.vertices().iter().copied(), line.indices().iter().copied())
        }
        TypedShape::HeightField(field) => height_field(field),
        TypedShape::TriMesh(mesh) => unmoved(mesh.triangles().map(|t| {
            let [a, b, c] = [t.a, t.b, t.c].map(vector_to_kernel);
            NativeShape::Triangle(kernel::shape::Triangle { a, b, c })
        })),
        TypedShape::Custom(custom) => {
            if let Some(ellipse) = custom.as_shape::<EllipseColliderShape>() {
                let half = kernel::math::Vector::from_array(ellipse.half_size.to_array());
                return kernel::shape::Curved::ellipse(half).ok().map(NativeShape::Curved);
            }
            let polygon = custom.as_shape::<RegularPolygonColliderShape>()?;
            let corners: Vec<_> = polygon.corners().take(MAX_CORNERS + 1).collect();
            native_polygon(&corners, 0.0)
        }
        _ => None,
    }
}

/// A height field. If segments are removed, it becomes a surface of the remaining ones instead of one line.
fn height_field(field: &HeightField) -> Option<NativeShape> {
    let segments: Vec<[Vector; 2]> = field.segments().map(|s| [s.a, s.b]).collect();
    if segments.len() < field.num_cells() {
        return surface_of_facets(segments.into_iter());
    }
    let first = segments.first()?[0];
    let vertices = core::iter::once(first).chain(segments.iter().map(|ends| ends[1]));
    Surface::line(vertices.map(vector_to_kernel).collect()).ok().map(NativeShape::surface)
}

/// A polygon of the kernel with a radius; `None` if it has too many corners.
fn native_polygon(corners: &[Vector], radius: Scalar) -> Option<NativeShape> {
    if corners.len() > MAX_CORNERS {
        return None;
    }
    let corners: Vec<_> = corners.iter().map(|v| vector_to_kernel(*v)).collect();
    let hull = kernel::shape::Hull::from_convex(&corners, radius as f32).ok()?;
    Some(NativeShape::Hull(std::sync::Arc::new(hull)))
}
