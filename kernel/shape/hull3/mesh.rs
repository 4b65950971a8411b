//! Makes a hull from a closed convex mesh: vertices are welded, coplanar faces merged, and the result
//! checked.
//!
//! All checks are relative to the largest extent of the mesh.

use super::half_edges::{HalfEdge, HalfEdges};
use super::wide::{Wide, narrow, widen};
use super::{Hull, mass, size_of};
use crate::math::Vector;
use crate::shape::ShapeError;
use crate::shape::adjacency::welded;

/// The tolerances, as shares of the size, within which a vertex is in a face's plane or on an edge. Larger
/// values remove small bevels, smaller values leave the slivers of hull builders. In thin solids a large
/// tolerance joins faces that are not one polygon; then the next one is tried.
const FLATNESS: [f64; 4] = [1.0e-4, 1.0e-5, 1.0e-6, 0.0];
/// A vertex may lie in front of a face by this share of the size. More accepts meshes that are not convex.
const CONVEXITY: f64 = 1.0e-3;
/// Faces are merged only if the cosine between their normals is above this.
const SAME_DIRECTION: f64 = 0.99;
/// Meshes with less volume than this share of the size's cube are flat.
const FLAT_VOLUME: f64 = 1.0e-9;

impl Hull {
    /// A hull from vertices (in metres) and faces, each a loop of at least three vertex indices,
    /// counter-clockwise from outside. Neighbours in a plane to within 0.01 % of the size are merged into
    /// polygons; if the merged polygons do not form the whole solid, a smaller tolerance is used.
    ///
    /// # Errors
    ///
    /// `NotFinite` for a bad coordinate; `Degenerate` if the faces do not close a surface of the topology of
    /// a ball (Euler: V − E + F = 2), an index is out of range, or there is no volume; `NotConvex` if a
    /// vertex lies in front of a face by more than 0.1 % of the size, or the faces are clockwise.
    pub fn from_mesh(vertices: Vec<Vector>, faces: Vec<Vec<u32>>) -> Result<Self, ShapeError> {
        let (vertices, faces) = weld(vertices, faces)?;
        let (vertices, faces) = drop_unused(&vertices, faces);
        let size = f64::from(size_of(&vertices));
        // Squares and cubes of extents must be finite and not vanish.
        if faces.len() < 4 || !(size > 1.0e-12 && size < 1.0e12) {
            return Err(ShapeError::Degenerate);
        }
        let half_edges = HalfEdges::of(vertices.len(), &faces).ok_or(ShapeError::Degenerate)?;
        let volume = mass::signed_volume(&vertices, &faces);
        if !(volume.abs() > FLAT_VOLUME * size * size * size) {
            return Err(ShapeError::Degenerate);
        }
        if volume < 0.0 {
            return Err(ShapeError::NotConvex);
        }
        let mut refusal = ShapeError::Degenerate;
        for flatness in FLATNESS {
            match Self::merged(&vertices, &faces, &half_edges, size, flatness * size) {
                Ok(hull) => return Ok(hull),
                Err(ShapeError::NotConvex) => refusal = ShapeError::NotConvex,
                Err(_) => {}
            }
        }
        Err(refusal)
    }

    /// The hull with coplanar faces merged within `tolerance` metres.
    fn merged(
        vertices: &[Vector],
        faces: &[Vec<u32>],
        half_edges: &HalfEdges,
        size: f64,
        tolerance: f64,
    ) -> Result<Self, ShapeError> {
        let groups = merge_coplanar(vertices, faces, half_edges, tolerance);
        let outlines = outlines(vertices, &groups, half_edges, tolerance)?;
        let planes = checked_planes(vertices, &outlines, size)?;
        let (vertices, outlines) = drop_unused(vertices, outlines);
        let half_edges = HalfEdges::of(vertices.len(), &outlines).ok_or(ShapeError::Degenerate)?;
        if vertices.len() * 2 + outlines.len() * 2 != half_edges.all.len() + 4 {
            return Err(ShapeError::Degenerate);
        }
        Ok(Self::assemble(vertices, &planes, &outlines, &half_edges))
    }

    /// A hull from a triangle mesh, as made by builders of convex hulls; see [`from_mesh`](Self::from_mesh).
    ///
    /// # Errors
    ///
    /// As [`from_mesh`](Self::from_mesh).
    pub fn from_triangles(vertices: Vec<Vector>, triangles: &[[u32; 3]]) -> Result<Self, ShapeError> {
        Self::from_mesh(vertices, triangles.iter().map(|t| t.to_vec()).collect())
    }
}

/// Joins vertices at the same position and drops faces that collapse.
fn weld(vertices: Vec<Vector>, mut faces: Vec<Vec<u32>>) -> Result<(Vec<Vector>, Vec<Vec<u32>>), ShapeError> {
    if vertices.iter().any(|v| !v.is_finite()) {
        return Err(ShapeError::NotFinite);
    }
    if faces.iter().flatten().any(|i| *i as usize >= vertices.len()) {
        return Err(ShapeError::Degenerate);
    }
    let first_of = welded(&vertices);
    for face in &mut faces {
        for i in face.iter_mut() {
            *i = first_of[*i as usize];
        }
        face.dedup();
        while face.len() > 1 && face.first() == face.last() {
            face.pop();
        }
    }
    faces.retain(|f| f.len() >= 3);
    Ok((vertices, faces))
}

/// Twice the area vector of a polygon (Newell's method): its normal, not of unit length.
fn area_vector(vertices: &[Vector], outline: &[u32]) -> Wide {
    let at = |k: usize| widen(vertices[outline[k % outline.len()] as usize]);
    (1..outline.len() - 1).fold(Wide::ZERO, |sum, k| sum + (at(k) - at(0)).cross(at(k + 1) - at(0)))
}

/// The group of coplanar neighbours of each face.
///
/// Groups grow from the largest face, and faces are compared with that face alone: comparing neighbours with
/// each other would join all faces of a finely tessellated ball.
fn merge_coplanar(
    vertices: &[Vector],
    faces: &[Vec<u32>],
    half_edges: &HalfEdges,
    tolerance: f64,
) -> Vec<u32> {
    let areas: Vec<Wide> = faces.iter().map(|f| area_vector(vertices, f)).collect();
    let lengths: Vec<f64> = areas.iter().map(|area| area.length()).collect();
    let mut order: Vec<usize> = (0..faces.len()).collect();
    order.sort_unstable_by(|a, b| lengths[*b].total_cmp(&lengths[*a]).then(a.cmp(b)));
    let mut group = vec![u32::MAX; faces.len()];
    let mut queue = Vec::new();
    for seed in order {
        if group[seed] != u32::MAX {
            continue;
        }
        let length = lengths[seed];
        let normal = if length > 0.0 { areas[seed] * (1.0 / length) } else { Wide::ZERO };
        let base = widen(vertices[faces[seed][0] as usize]);
        let joins = |face: usize| {
            let area = lengths[face];
            let at = |k: usize| widen(vertices[faces[face][k % faces[face].len()] as usize]);
            let longest = (0..faces[face].len()).map(|k| (at(k + 1) - at(k)).length()).fold(0.0, f64::max);
            let sliver = area < tolerance * longest;
            let flat =
                faces[face].iter().all(|v| normal.dot(widen(vertices[*v as usize]) - base).abs() < tolerance);
            // A sliver joins a face that it is coplanar with, but not the other side of a thin solid.
            let least = if sliver { 0.0 } else { SAME_DIRECTION * area };
            flat && normal.dot(areas[face]) > least
        };
        group[seed] = seed as u32;
        queue.push(seed);
        while let Some(face) = queue.pop() {
            for k in 0..faces[face].len() {
                let (tail, head) = (faces[face][k], faces[face][(k + 1) % faces[face].len()]);
                let Some(edge) = half_edges.at(tail, head) else { continue };
                let other = edge.across as usize;
                if group[other] == u32::MAX && joins(other) {
                    group[other] = seed as u32;
                    queue.push(other);
                }
            }
        }
    }
    group
}

/// The boundary loop of each group. Vertices that only two groups share are dropped, and must lie on a
/// straight edge within `tolerance` metres.
fn outlines(
    vertices: &[Vector],
    group: &[u32],
    half_edges: &HalfEdges,
    tolerance: f64,
) -> Result<Vec<Vec<u32>>, ShapeError> {
    let is_border = |edge: &&HalfEdge| group[edge.face as usize] != group[edge.across as usize];
    let in_group = |edge: &HalfEdge| (group[edge.face as usize], edge.tail, edge.head);
    let mut border: Vec<_> = half_edges.all.iter().filter(is_border).map(in_group).collect();
    border.sort_unstable();
    let mut degree = vec![0u32; vertices.len()];
    for b in &border {
        degree[b.1 as usize] += 1;
    }
    if border.is_empty() {
        return Err(ShapeError::Degenerate);
    }
    let mut result = Vec::with_capacity(group.len());
    for of_group in border.chunk_by(|a, b| a.0 == b.0) {
        let mut outline = Vec::with_capacity(of_group.len());
        let corner = of_group.iter().position(|b| degree[b.1 as usize] > 2).ok_or(ShapeError::Degenerate)?;
        let start = of_group[corner].1;
        let mut skipped = Vec::new();
        let mut at = start;
        for _ in 0..of_group.len() {
            let next = of_group.binary_search_by_key(&at, |b| b.1).map_err(|_| ShapeError::Degenerate)?;
            if degree[at as usize] > 2 {
                outline.push(at);
            } else {
                skipped.push(at);
            }
            at = of_group[next].2;
            if degree[at as usize] > 2 {
                let (a, b) = (outline[outline.len() - 1], at);
                if !skipped.drain(..).all(|v| off_edge(vertices, v, a, b) < tolerance) {
                    return Err(ShapeError::Degenerate);
                }
            }
        }
        // A second loop, or a vertex that is passed twice: the group is not a disc.
        let pinched = of_group.windows(2).any(|w| w[0].1 == w[1].1);
        if at != start || pinched || outline.len() < 3 {
            return Err(ShapeError::Degenerate);
        }
        result.push(outline);
    }
    Ok(result)
}

/// The distance of a vertex from the segment between two others.
fn off_edge(vertices: &[Vector], v: u32, a: u32, b: u32) -> f64 {
    let [v, a, b] = [v, a, b].map(|i| widen(vertices[i as usize]));
    let edge = b - a;
    let along = ((v - a).dot(edge) / edge.dot(edge)).clamp(0.0, 1.0);
    (v - a - edge * along).length()
}

/// Renumbers the remaining vertices.
fn drop_unused(vertices: &[Vector], mut outlines: Vec<Vec<u32>>) -> (Vec<Vector>, Vec<Vec<u32>>) {
    let mut number = vec![u32::MAX; vertices.len()];
    for i in outlines.iter().flatten() {
        number[*i as usize] = 0;
    }
    let mut kept = Vec::new();
    for (n, v) in number.iter_mut().zip(vertices) {
        if *n == 0 {
            *n = kept.len() as u32;
            kept.push(*v);
        }
    }
    for i in outlines.iter_mut().flatten() {
        *i = number[*i as usize];
    }
    (kept, outlines)
}

/// The planes of the faces, if no vertex, dropped vertices included, lies in front of a face.
fn checked_planes(
    vertices: &[Vector],
    outlines: &[Vec<u32>],
    size: f64,
) -> Result<Vec<(Vector, f32)>, ShapeError> {
    let mut planes = Vec::with_capacity(outlines.len());
    for outline in outlines {
        let area = area_vector(vertices, outline);
        let length = area.length();
        if !(length > 0.0) {
            return Err(ShapeError::Degenerate);
        }
        let normal = area * (1.0 / length);
        let height = |i: &u32| normal.dot(widen(vertices[*i as usize]));
        let offset = outline.iter().map(height).sum::<f64>() / outline.len() as f64;
        if vertices.iter().any(|v| normal.dot(widen(*v)) > offset + CONVEXITY * size) {
            return Err(ShapeError::NotConvex);
        }
        planes.push((narrow(normal), offset as f32));
    }
    Ok(planes)
}
