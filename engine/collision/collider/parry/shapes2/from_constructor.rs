//! Colliders from constructors of 2D. See `shapes3` for 3D.

use super::super::{
    Collider, ColliderError, TrimeshFlags, VhacdParameters,
    mesh_type::Mesh,
    strict::{self, Made, elements, made, points, sizes},
};
use crate::{
    collision::collider::constructor::ColliderConstructor as C,
    math::Vector,
    physics_transform::{Position, Rotation},
};

/// The collider that a constructor describes. Constructors from meshes need `mesh`.
pub(in super::super) fn build(constructor: &C, mesh: Option<&Mesh>) -> Made {
    match constructor {
        C::Circle { radius } => Collider::try_circle(*radius),
        C::Ellipse { half_width, half_height } => Collider::try_ellipse(*half_width, *half_height),
        C::Rectangle { x_length, y_length } => Collider::try_rectangle(*x_length, *y_length),
        C::RoundRectangle { x_length, y_length, border_radius } => {
            Collider::try_round_rectangle(*x_length, *y_length, *border_radius)
        }
        C::RegularPolygon { circumradius, sides } => Collider::try_regular_polygon(*circumradius, *sides),
        C::ConvexPolyline { points } => Collider::try_convex_polyline(points.clone()),
        C::Capsule { radius, height } => Collider::try_capsule(*radius, *height),
        C::CapsuleEndpoints { radius, a, b } => Collider::try_capsule_endpoints(*radius, *a, *b),
        C::HalfSpace { outward_normal } => Collider::try_half_space(*outward_normal),
        C::Segment { a, b } => Collider::try_segment(*a, *b),
        C::Triangle { a, b, c } => Collider::try_triangle(*a, *b, *c),
        C::Polyline { vertices, indices } => strict::polyline(vertices, indices.as_deref()),
        C::Trimesh { vertices, indices } => strict::trimesh(vertices, indices, TrimeshFlags::empty()),
        C::TrimeshWithConfig { vertices, indices, flags } => strict::trimesh(vertices, indices, *flags),
        C::ConvexDecomposition { vertices, indices } => {
            decomposition(vertices, indices, &VhacdParameters::default())
        }
        C::ConvexDecompositionWithConfig { vertices, indices, params } => {
            decomposition(vertices, indices, params)
        }
        C::ConvexHull { points } => Collider::try_convex_hull(points.clone()),
        C::Voxels { voxel_size, grid_coordinates } => strict::voxels(*voxel_size, grid_coordinates),
        C::VoxelizedPolyline { vertices, indices, voxel_size, fill_mode } => {
            strict::voxel_size(vertices, *voxel_size)?;
            elements(vertices, indices)?;
            made(Collider::voxelized_polyline(vertices, indices, *voxel_size, *fill_mode))
        }
        C::Heightfield { heights, scale } => {
            if heights.len() < 2 {
                return Err(ColliderError::TooFewHeights);
            }
            sizes(&[scale.x])?;
            points(&[*scale])?;
            Ok(Collider::heightfield(heights.clone(), *scale))
        }
        #[cfg(feature = "collider-from-mesh")]
        C::TrimeshFromMesh
        | C::ConvexHullFromMesh
        | C::ConvexDecompositionFromMesh
        | C::VoxelizedTrimeshFromMesh { .. } => from_mesh(constructor, mesh),
        C::Compound(parts) => {
            let part = |(position, rotation, shape): &(Position, Rotation, C)| {
                Ok((*position, *rotation, build(shape, mesh)?))
            };
            Collider::try_compound(parts.iter().map(part).collect::<Made<Vec<_>>>()?)
        }
    }
}

fn decomposition(vertices: &[Vector], indices: &[[u32; 2]], params: &VhacdParameters) -> Made {
    elements(vertices, indices)?;
    made(Collider::convex_decomposition_with_config(vertices.to_vec(), indices.to_vec(), params))
}

#[cfg(feature = "collider-from-mesh")]
fn from_mesh(constructor: &C, mesh: Option<&Mesh>) -> Made {
    use super::super::from_mesh;

    let mesh = mesh.ok_or(ColliderError::NoMesh)?;
    match constructor {
        C::ConvexHullFromMesh => from_mesh::convex_hull(mesh),
        C::ConvexDecompositionFromMesh => from_mesh::convex_decomposition(mesh, &VhacdParameters::default()),
        C::VoxelizedTrimeshFromMesh { voxel_size, fill_mode } => {
            from_mesh::voxelized_trimesh(mesh, *voxel_size, *fill_mode)
        }
        _ => from_mesh::trimesh(mesh, from_mesh::OF_MESH),
    }
}
