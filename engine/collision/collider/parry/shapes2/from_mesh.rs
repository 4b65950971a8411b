//! 2D parts of colliders from meshes. See `shapes3` for 3D.

use super::super::{Collider, FillMode, VhacdParameters};
use crate::math::{AdjustPrecision, Scalar, Vector};
use bevy_math::Vec2;
use std::collections::BTreeMap;

/// A position of a mesh, without its depth.
pub(in super::super) fn point([x, y, _]: [f32; 3]) -> Vector {
    Vec2::new(x, y).adjust_precision()
}

/// The boundary of triangles: the sides that belong to one triangle only. Vertices at the same place are
/// merged.
pub(in super::super) fn surface(
    vertices: Vec<Vector>,
    triangles: Vec<[u32; 3]>,
) -> (Vec<Vector>, Vec<[u32; 2]>) {
    let mut places = BTreeMap::new();
    // Adding zero turns -0 into 0.
    let place = |v: &Vector| v.to_array().map(|c| (c + 0.0).to_bits());
    let joined: Vec<u32> =
        vertices.iter().zip(0..).map(|(vertex, i)| *places.entry(place(vertex)).or_insert(i)).collect();
    let mut sides: BTreeMap<[u32; 2], (usize, [u32; 2])> = BTreeMap::new();
    for triangle in triangles {
        let [a, b, c] = triangle.map(|i| joined[i as usize]);
        for [from, to] in [[a, b], [b, c], [c, a]] {
            sides.entry([from.min(to), from.max(to)]).or_insert((0, [from, to])).0 += 1;
        }
    }
    let outer = sides.into_values().filter(|(count, [from, to])| *count == 1 && from != to);
    (vertices, outer.map(|(_, side)| side).collect())
}

/// Convex polygons in an outline.
pub(in super::super) fn decomposed(
    vertices: Vec<Vector>,
    outline: Vec<[u32; 2]>,
    parameters: &VhacdParameters,
) -> Collider {
    Collider::convex_decomposition_with_config(vertices, outline, parameters)
}

/// The voxels of an outline.
pub(in super::super) fn voxelized(
    vertices: &[Vector],
    outline: &[[u32; 2]],
    voxel_size: Scalar,
    fill_mode: FillMode,
) -> Collider {
    Collider::voxelized_polyline(vertices, outline, voxel_size, fill_mode)
}
