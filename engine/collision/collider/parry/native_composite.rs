//! Converts parry's meshes, lines, height fields, voxels and compounds to the kernel's composite shapes.

use super::cells::joined;
use crate::math::{Scalar, Vector, vector_to_kernel};
use crate::parry::shape::Voxels;
use kernel::math::{DIM, Pose};
use kernel::shape::{Cuboid, Shape, Surface};

/// A surface with the given corners and facets, if all are usable.
pub(super) fn surface(
    vertices: impl Iterator<Item = Vector>,
    facets: impl Iterator<Item = [u32; DIM]>,
) -> Option<Shape> {
    Surface::new(vertices.map(vector_to_kernel).collect(), facets.collect()).ok().map(Shape::surface)
}

/// A surface of facets that are given by their corners.
pub(super) fn surface_of_facets(facets: impl Iterator<Item = [Vector; DIM]>) -> Option<Shape> {
    let corners: Vec<Vector> = facets.flatten().collect();
    let count = (corners.len() / DIM) as u32;
    let facets = (0..count).map(|i| core::array::from_fn(|k| DIM as u32 * i + k as u32));
    surface(corners.into_iter(), facets)
}

/// A compound of parts in one frame, without rotation.
pub(super) fn unmoved(parts: impl Iterator<Item = Shape>) -> Option<Shape> {
    Shape::compound(parts.map(|part| (Pose::IDENTITY, part)).collect()).ok()
}

/// Voxels merged into few boxes: a floor of voxels becomes one box.
pub(super) fn voxels(voxels: &Voxels) -> Option<Shape> {
    let full = voxels.voxels().filter(|voxel| !voxel.state.is_empty());
    let size = voxels.voxel_size();
    let solids =
        joined(&full.map(|voxel| voxel.grid_coords).collect::<Vec<_>>()).into_iter().map(|[low, high]| {
            let (low, high) = (voxels.voxel_center(low), voxels.voxel_center(high));
            let [half, position] =
                [high - low + size, low + high].map(|v| vector_to_kernel(v * (0.5 as Scalar)));
            (Pose { position, ..Pose::IDENTITY }, Shape::Cuboid(Cuboid { half }))
        });
    Shape::compound(solids.collect()).ok()
}
