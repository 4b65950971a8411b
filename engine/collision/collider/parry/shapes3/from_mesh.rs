//! 3D parts of colliders from meshes. See `shapes2` for 2D.

use super::super::{Collider, FillMode, VhacdParameters};
use crate::math::{AdjustPrecision, Scalar, Vector};
use bevy_math::Vec3;

/// A position of a mesh.
pub(in super::super) fn point(position: [f32; 3]) -> Vector {
    Vec3::from_array(position).adjust_precision()
}

/// The boundary of a mesh: its triangles.
pub(in super::super) fn surface(
    vertices: Vec<Vector>,
    triangles: Vec<[u32; 3]>,
) -> (Vec<Vector>, Vec<[u32; 3]>) {
    (vertices, triangles)
}

/// Convex polyhedra in a surface.
pub(in super::super) fn decomposed(
    vertices: Vec<Vector>,
    surface: Vec<[u32; 3]>,
    parameters: &VhacdParameters,
) -> Collider {
    Collider::convex_decomposition_with_config(vertices, surface, parameters.clone())
}

/// The voxels of a surface.
pub(in super::super) fn voxelized(
    vertices: &[Vector],
    surface: &[[u32; 3]],
    voxel_size: Scalar,
    fill_mode: FillMode,
) -> Collider {
    Collider::voxelized_trimesh(vertices, surface, voxel_size, fill_mode)
}
