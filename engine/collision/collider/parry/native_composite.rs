//! The kernel's composite shapes, of parry's meshes, lines, height fields, voxels and compounds.

use crate::math::{Scalar, Vector, vector_to_kernel};
use crate::parry::math::IVector;
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

/// Parts without turns, all in one frame.
pub(super) fn unmoved(parts: impl Iterator<Item = Shape>) -> Option<Shape> {
    Shape::compound(parts.map(|part| (Pose::IDENTITY, part)).collect()).ok()
}

/// Voxels as few boxes: a floor of voxels is one.
pub(super) fn voxels(voxels: &Voxels) -> Option<Shape> {
    let full = voxels.voxels().filter(|voxel| !voxel.state.is_empty());
    let size = voxels.voxel_size();
    let solids = joined(full.map(|voxel| voxel.grid_coords).collect()).into_iter().map(|[low, high]| {
        let (low, high) = (voxels.voxel_center(low), voxels.voxel_center(high));
        let [half, position] = [high - low + size, low + high].map(|v| vector_to_kernel(v * (0.5 as Scalar)));
        (Pose { position, ..Pose::IDENTITY }, Shape::Cuboid(Cuboid { half }))
    });
    Shape::compound(solids.collect()).ok()
}

/// The cells as boxes of cells, each by its lowest and highest: joined along one axis after the other.
fn joined(cells: Vec<IVector>) -> Vec<[IVector; 2]> {
    let mut boxes: Vec<_> = cells.into_iter().map(|cell| [cell, cell]).collect();
    for axis in 0..DIM {
        // Boxes that may be joined follow each other: those alike across the axis, in order along it.
        let across = |b: &[IVector; 2]| {
            let mut ends = b.map(|end| end.to_array());
            ends.iter_mut().for_each(|end| end[axis] = 0);
            ends
        };
        boxes.sort_unstable_by_key(|b| (across(b), b[0][axis]));
        boxes.dedup_by(|next, last| {
            let is_next =
                across(next) == across(last) && i64::from(next[0][axis]) <= i64::from(last[1][axis]) + 1;
            if is_next {
                last[1][axis] = last[1][axis].max(next[1][axis]);
            }
            is_next
        });
    }
    boxes
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[allow(clippy::useless_conversion, reason = "coordinates are i32 or i64")]
    fn cell(c: [i32; 3]) -> IVector {
        IVector::from_array(core::array::from_fn(|i| c[i].into()))
    }

    proptest! {
        #[test]
        fn joined_boxes_cover_all_cells_once(cells in prop::collection::vec([0..4i32, 0..4, 0..4], 0..40)) {
            let cells: std::collections::BTreeSet<_> = cells.into_iter().map(|c| cell(c).to_array()).collect();
            let boxes = joined(cells.iter().map(|c| IVector::from_array(*c)).collect());
            let mut count = 0;
            for [low, high] in &boxes {
                count += (0..DIM).fold(1, |count, i| count * (high[i] - low[i] + 1));
            }
            prop_assert_eq!(count as usize, cells.len());
            for c in &cells {
                let inside = |b: &&[IVector; 2]| (0..DIM).all(|i| b[0][i] <= c[i] && c[i] <= b[1][i]);
                prop_assert_eq!(boxes.iter().filter(inside).count(), 1);
            }
        }
    }

    #[test]
    fn a_floor_of_cells_is_one_box() {
        let cells = (0..9).map(|i| cell([i % 3, i / 3, 0])).collect();
        assert_eq!(joined(cells).len(), 1);
    }
}
