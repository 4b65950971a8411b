//! Colliders from constructors of 3D. See `shapes2` for 2D.

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
        C::Sphere { radius } => Collider::try_sphere(*radius),
        C::Cuboid { x_length, y_length, z_length } => Collider::try_cuboid(*x_length, *y_length, *z_length),
        C::RoundCuboid { x_length, y_length, z_length, border_radius } => {
            Collider::try_round_cuboid(*x_length, *y_length, *z_length, *border_radius)
        }
        C::Cylinder { radius, height } => Collider::try_cylinder(*radius, *height),
        C::Cone { radius, height } => Collider::try_cone(*radius, *height),
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
        C::VoxelizedTrimesh { vertices, indices, voxel_size, fill_mode } => {
            strict::voxel_size(vertices, *voxel_size)?;
            elements(vertices, indices)?;
            made(Collider::voxelized_trimesh(vertices, indices, *voxel_size, *fill_mode))
        }
        C::Heightfield { heights, scale } => {
            if heights.len() < 2 || heights.iter().any(|line| line.len() < 2) {
                return Err(ColliderError::TooFewHeights);
            }
            sizes(&[scale.x, scale.z])?;
            points(&[*scale])?;
            Ok(Collider::heightfield(heights.clone(), *scale))
        }
        #[cfg(feature = "collider-from-mesh")]
        C::TrimeshFromMesh
        | C::TrimeshFromMeshWithConfig(_)
        | C::ConvexDecompositionFromMeshWithConfig(_)
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

fn decomposition(vertices: &[Vector], indices: &[[u32; 3]], params: &VhacdParameters) -> Made {
    elements(vertices, indices)?;
    made(Collider::convex_decomposition_with_config(vertices.to_vec(), indices.to_vec(), params.clone()))
}

#[cfg(feature = "collider-from-mesh")]
fn from_mesh(constructor: &C, mesh: Option<&Mesh>) -> Made {
    use super::super::from_mesh;

    let mesh = mesh.ok_or(ColliderError::NoMesh)?;
    match constructor {
        C::TrimeshFromMeshWithConfig(flags) => from_mesh::trimesh(mesh, *flags),
        C::ConvexDecompositionFromMeshWithConfig(params) => from_mesh::convex_decomposition(mesh, params),
        C::ConvexHullFromMesh => from_mesh::convex_hull(mesh),
        C::ConvexDecompositionFromMesh => from_mesh::convex_decomposition(mesh, &VhacdParameters::default()),
        C::VoxelizedTrimeshFromMesh { voxel_size, fill_mode } => {
            from_mesh::voxelized_trimesh(mesh, *voxel_size, *fill_mode)
        }
        _ => from_mesh::trimesh(mesh, from_mesh::OF_MESH),
    }
}
