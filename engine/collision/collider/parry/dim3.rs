//! 3D parts of the default collider: poses, boxes, the kernel's polyhedra. `dim2.rs` exports the same names.

#[cfg(test)]
#[path = "tests3d.rs"]
mod tests;

use super::native_composite::{surface, surface_of_facets, unmoved};
use crate::math::{AdjustPrecision, Scalar, Vector, vector_from_kernel, vector_to_kernel};
use crate::parry::math::{Pose, Rotation as ParryRotation};
use crate::parry::shape::{ConvexPolyhedron, HeightField, HeightFieldCellStatus, SharedShape, TypedShape};
use crate::physics_transform::Rotation;
use bevy_math::Quat;
use kernel::shape::{Curved, Hull, Shape as NativeShape, ShapeError, Surface};

/// The default of [`VhacdParameters::concavity`](super::VhacdParameters::concavity).
pub(super) const VHACD_CONCAVITY: Scalar = 0.01;
/// The default of [`VhacdParameters::resolution`](super::VhacdParameters::resolution).
pub(super) const VHACD_RESOLUTION: u32 = 64;
/// A pose in parry's type.
pub(super) fn pose(position: Vector, rotation: Rotation) -> Pose {
    Pose::from_parts(position, rotation.0)
}

/// A relative pose of the kernel in parry's type.
pub(super) fn pose_from_kernel(pose: &kernel::math::Pose) -> Pose {
    let r = pose.rotation;
    let rotation = Quat::from_xyzw(r.x, r.y, r.z, r.w).adjust_precision();
    Pose::from_parts(vector_from_kernel(pose.position), rotation)
}

/// A relative pose in the kernel's type.
pub(super) fn pose_to_kernel(pose: &Pose) -> kernel::math::Pose {
    kernel::math::Pose {
        position: vector_to_kernel(pose.translation),
        rotation: Rotation(pose.rotation).to_kernel(),
    }
}

/// The rotation of a pose of parry.
pub(super) fn rotation(pose: Pose) -> Rotation {
    Rotation(pose.rotation)
}

/// The shape of the default collider.
pub(super) fn default_shape() -> SharedShape {
    cuboid_shape(Vector::splat(0.25))
}

/// A box by its half extents.
pub(super) fn cuboid_shape(half: Vector) -> SharedShape {
    SharedShape::cuboid(half.x, half.y, half.z)
}

/// The triangles of a height field.
pub(super) fn height_field_elements(field: &HeightField) -> impl Iterator<Item = SharedShape> + '_ {
    field.triangles().map(SharedShape::new)
}

/// The scale along the axes of a part rotated by `rotation`. Exact for quarter turns. Otherwise the lengths
/// of the scaled axes, since no shape can be sheared.
pub(super) fn scale_in_frame(scale: Vector, rotation: ParryRotation) -> Vector {
    if scale.x == scale.y && scale.y == scale.z {
        return scale;
    }
    let axis = |a: Vector| ((rotation * a) * scale).length();
    Vector::new(axis(Vector::X), axis(Vector::Y), axis(Vector::Z))
}

/// Whether a hull has a volume.
pub(super) fn is_solid(shape: &SharedShape) -> bool {
    let mass = shape.mass_properties(1.0).mass();
    mass.is_finite() && mass > 0.0
}

/// The kernel's shape for shapes that only 3D has.
pub(super) fn native_of_dimension(shape: TypedShape<'_>) -> Option<NativeShape> {
    match shape {
        TypedShape::ConvexPolyhedron(polyhedron) => native_hull(hull_of(polyhedron)?, 0.0),
        TypedShape::RoundConvexPolyhedron(round) => {
            native_hull(hull_of(&round.inner_shape)?, round.border_radius)
        }
        TypedShape::RoundCuboid(round) => {
            let hull = Hull::cuboid(vector_to_kernel(round.inner_shape.half_extents)).ok()?;
            native_hull(hull, round.border_radius)
        }
        TypedShape::TriMesh(mesh) => surface(mesh.vertices().iter().copied(), mesh.indices().iter().copied()),
        TypedShape::HeightField(field) => height_field(field),
        TypedShape::Polyline(line) => unmoved(line.segments().map(|s| {
            let [a, b] = [s.a, s.b].map(vector_to_kernel);
            NativeShape::Segment(kernel::shape::Segment { a, b })
        })),
        TypedShape::Cylinder(s) => native_curved(Curved::cylinder(s.radius as f32, s.half_height as f32)),
        TypedShape::Cone(s) => native_curved(Curved::cone(s.radius as f32, s.half_height as f32)),
        _ => None,
    }
}

/// A height field. If triangles are removed, it becomes a surface of the remaining ones instead of a grid.
fn height_field(field: &HeightField) -> Option<NativeShape> {
    if field.cells_statuses().data().iter().any(|cell| cell.intersects(HeightFieldCellStatus::CELL_REMOVED)) {
        return surface_of_facets(field.triangles().map(|t| [t.a, t.b, t.c]));
    }
    let (rows, columns) = (field.nrows(), field.ncols());
    let vertex = |i: usize, j: usize| {
        let y = field.heights()[(i, j)] * field.scale().y;
        vector_to_kernel(Vector::new(field.x_at(j), y, field.z_at(i)))
    };
    let vertices = (0..=columns).flat_map(|j| (0..=rows).map(move |i| vertex(i, j))).collect();
    let is_turned =
        |i: usize, j: usize| field.cell_status(i, j).contains(HeightFieldCellStatus::ZIGZAG_SUBDIVISION);
    Surface::grid(vertices, rows + 1, is_turned).ok().map(NativeShape::surface)
}

fn native_curved(shape: Result<Curved, ShapeError>) -> Option<NativeShape> {
    shape.ok().map(NativeShape::Curved)
}

/// The kernel's polyhedron, if the kernel accepts it. Parry's hulls of scattered points have slightly concave
/// edges where faces are nearly coplanar; the kernel then computes the hull of their corners.
fn hull_of(polyhedron: &ConvexPolyhedron) -> Option<Hull> {
    let vertices: Vec<_> = polyhedron.points().iter().map(|v| vector_to_kernel(*v)).collect();
    let faces: Vec<Vec<u32>> = polyhedron
        .faces()
        .iter()
        .map(|face| {
            let first = face.first_vertex_or_edge as usize;
            let range = first..first + face.num_vertices_or_edges as usize;
            polyhedron.vertices_adj_to_face()[range].to_vec()
        })
        .collect();
    Hull::from_mesh(vertices.clone(), faces).or_else(|_| Hull::convex_hull_of(&vertices)).ok()
}

/// A polyhedron of the kernel with a radius.
fn native_hull(hull: Hull, radius: Scalar) -> Option<NativeShape> {
    Some(NativeShape::Hull(std::sync::Arc::new(hull.rounded(radius as f32).ok()?)))
}
