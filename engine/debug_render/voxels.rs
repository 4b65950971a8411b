//! Outlines of voxels: the edges at which their surface bends.

use std::collections::BTreeSet;

use crate::{
    debug_render::{dim::point, lines::Strips},
    math::Scalar,
    parry::{math::IVector, shape::Voxels},
};
use kernel::math::DIM;

/// A point of the grid, or a cell by its lowest corner.
type Cell = [i64; DIM];

/// Adds the edges at which the surface of the voxels bends: flat walls and interior edges are left out.
pub(super) fn add_voxels(voxels: &Voxels, lines: &mut Strips) {
    let full = voxels.voxels().filter(|voxel| !voxel.state.is_empty());
    let cells: BTreeSet<Cell> = full.map(|voxel| cell(voxel.grid_coords)).collect();
    let Some(first) = cells.first().copied() else { return };
    let size = voxels.voxel_size();
    let origin = voxels.voxel_center(IVector::from_array(first.map(|c| c as _))) - size * (0.5 as Scalar);
    let place = |corner: Cell| {
        let steps = core::array::from_fn(|i| (corner[i] - first[i]) as Scalar);
        point(origin + size * crate::math::Vector::from_array(steps))
    };
    for ends in edges(&cells) {
        lines.push(ends.map(place));
    }
}

fn cell(coords: IVector) -> Cell {
    coords.to_array().map(i64::from)
}

/// The edges of the grid at which the surface of cells bends, joined to lines along their axis.
fn edges(cells: &BTreeSet<Cell>) -> Vec<[Cell; 2]> {
    let mut found: [BTreeSet<Cell>; DIM] = Default::default();
    for cell in cells {
        for axis in 0..DIM {
            for at in around(*cell, axis, 1) {
                if bends(cells, at, axis) {
                    found[axis].insert(at);
                }
            }
        }
    }
    let mut joined = Vec::new();
    for (axis, starts) in found.iter().enumerate() {
        for start in starts {
            let mut before = *start;
            before[axis] -= 1;
            if starts.contains(&before) {
                continue;
            }
            let mut end = *start;
            while starts.contains(&end) {
                end[axis] += 1;
            }
            joined.push([*start, end]);
        }
    }
    joined
}

/// The cells or points around a given one, which differ by nothing or by `step` along the axes besides
/// `axis`.
fn around(cell: Cell, axis: usize, step: i64) -> Vec<Cell> {
    let mut out = vec![cell];
    for other in (0..DIM).filter(|other| *other != axis) {
        let shifted: Vec<Cell> = out
            .iter()
            .map(|c| {
                let mut c = *c;
                c[other] += step;
                c
            })
            .collect();
        out.extend(shifted);
    }
    out
}

/// Whether the surface bends at the edge that starts at a point of the grid. In 2D: whether the edge is part
/// of the surface.
fn bends(cells: &BTreeSet<Cell>, at: Cell, axis: usize) -> bool {
    let full: Vec<bool> = around(at, axis, -1).iter().map(|cell| cells.contains(cell)).collect();
    match full[..] {
        [a, b] => a != b,
        // A flat wall has two neighbours on the same side.
        [a, b, c, _] => match full.iter().filter(|full| **full).count() {
            0 | 4 => false,
            2 => a != b && a != c,
            _ => true,
        },
        _ => false,
    }
}
