//! The part of an incident face that lies over a reference face (Sutherland and Hodgman, "Reentrant
//! Polygon Clipping", 1974), with a feature id for each corner.

use super::view::{MatrixPose, View};
use crate::math::Vector;

/// The most corners of a clipped polygon. A cut adds at most one per side.
pub(super) const MAX_CORNERS: usize = 64;
/// The most corners of nearly all polygons; smaller buffers take less time to clear.
pub(super) const FEW_CORNERS: usize = 16;
/// Incident faces with more vertices are thinned to every second, fourth, … vertex.
const MAX_INCIDENT: usize = 32;
/// Side planes are this share of the smaller shape's extent outside of the face, so that two equal faces on each other keep
/// their own corners in spite of rounding.
const MARGIN: f32 = 1.0e-3;
/// Tags an edge that lies on a side of the reference face.
const ON_SIDE: u32 = 0x200;

/// A corner of the clipped polygon, in the frame of the reference polyhedron.
#[derive(Clone, Copy, Default)]
pub(super) struct Corner {
    pub point: Vector,
    /// Ten bits for the edge, ten for the side that cut it (plus 1), or for the vertex and 0.
    pub name: u32,
    /// The edge from here to the next corner.
    edge: u32,
}

/// A clipped polygon of at most `N` corners on the stack.
pub(super) struct Polygon<const N: usize> {
    corners: [Corner; N],
    count: usize,
    /// Receives corners beyond the capacity.
    beyond: Corner,
}

impl<const N: usize> Polygon<N> {
    pub fn new() -> Self {
        Self { corners: [Corner::default(); N], count: 0, beyond: Corner::default() }
    }

    pub fn corners(&self) -> &[Corner] {
        &self.corners[..self.count]
    }

    /// Writes a corner and counts it if `wanted`, without a branch. Corners beyond `N` are dropped.
    #[inline(always)]
    fn push_if(&mut self, wanted: bool, corner: Corner) {
        let has_room = self.count < N;
        *self.corners.get_mut(self.count).unwrap_or(&mut self.beyond) = corner;
        self.count += usize::from(wanted & has_room);
    }
}

/// The most corners when a face of `reference` clips one of `incident`.
pub(super) fn most_corners(
    reference: &View,
    face: usize,
    incident: &View,
    incident_face: Option<usize>,
) -> usize {
    let of_incident = match incident_face {
        Some(face) => incident.faces[face].count as usize,
        None => incident.vertices.len(),
    };
    of_incident + reference.faces[face].count as usize
}

/// The face of `incident` most opposite to a direction in its own frame, among the faces around the vertex `deepest` along it;
/// none if it has no faces. A face elsewhere may be more opposite: the base of a cone that stands on its tip.
pub(super) fn incident_face(incident: &View, normal: Vector, deepest: usize) -> Option<usize> {
    if incident.faces.is_empty() {
        return None;
    }
    let (mut face, mut least) = (0, f32::INFINITY);
    for &beside in incident.fan(deepest) {
        let cos = incident.faces[beside as usize].normal.dot(normal);
        let better = cos < least;
        face = if better { beside } else { face };
        least = if better { cos } else { least };
    }
    Some(face as usize)
}

/// A face of `incident`, or its edge or vertex if it has no faces.
pub(super) fn incident_polygon<const N: usize>(
    incident: &View,
    face: Option<usize>,
    frame: &MatrixPose,
    polygon: &mut Polygon<N>,
) {
    let Some(face) = face else {
        for (i, v) in incident.vertices.iter().enumerate() {
            polygon.push_if(true, Corner { point: frame.point(*v), name: (i as u32) << 10, edge: 0 });
        }
        return;
    };
    let outline = incident.outline(face);
    let stride = outline.len().div_ceil(MAX_INCIDENT).next_power_of_two();
    for i in outline.iter().step_by(stride) {
        let number = i & 0x1ff;
        let point = frame.point(incident.vertices[*i as usize]);
        polygon.push_if(true, Corner { point, name: number << 10, edge: number });
    }
}

/// Cuts a polygon by the side planes of a face of `reference`; `extent` is that of the smaller shape. Alternates between two
/// buffers and returns the one with the result.
pub(super) fn clip<'a, const N: usize>(
    reference: &View,
    face: usize,
    [mut polygon, mut spare]: [&'a mut Polygon<N>; 2],
    extent: f32,
) -> &'a Polygon<N> {
    let normal = reference.faces[face].normal;
    let outline = reference.outline(face);
    let mut tail = reference.vertices[outline[outline.len() - 1] as usize];
    let mut heights = [0.0; N];
    for (side, i) in outline.iter().enumerate() {
        let head = reference.vertices[*i as usize];
        let outward = (head - tail).cross(normal);
        let margin = MARGIN * extent * outward.length();
        let offset = outward.dot(tail) + margin;
        // Copied only when a side cuts: most corners of a resting body are inside of all sides.
        let mut any_outside = false;
        for (height, corner) in heights.iter_mut().zip(polygon.corners()) {
            *height = outward.dot(corner.point) - offset;
            any_outside |= !(*height <= 0.0);
        }
        if any_outside {
            cut(polygon, &heights, side as u32, spare);
            core::mem::swap(&mut polygon, &mut spare);
            if polygon.count == 0 {
                break;
            }
        }
        tail = head;
    }
    polygon
}

/// The part of a convex polygon behind a plane, given the heights of its corners over it.
fn cut<const N: usize>(polygon: &Polygon<N>, heights: &[f32; N], side: u32, out: &mut Polygon<N>) {
    out.count = 0;
    let corners = polygon.corners();
    // The outline of a segment is walked in one direction only.
    let walk = if corners.len() == 2 { 1 } else { corners.len() };
    let side_name = (side + 1) & 0x3ff;
    for k in 0..corners.len() {
        let after = if k + 1 < corners.len() { k + 1 } else { 0 };
        let (c, d) = (&corners[k], &corners[after]);
        let (this, next) = (heights[k], heights[after]);
        let inside = this <= 0.0;
        out.push_if(inside, *c);
        let t = this / (this - next);
        let point = c.point + (d.point - c.point) * t;
        // Where the polygon leaves, its next edge runs along the side.
        let edge = if inside { ON_SIDE | side & 0x1ff } else { c.edge };
        let crosses = k < walk && inside != (next <= 0.0);
        out.push_if(crosses, Corner { point, name: c.edge << 10 | side_name, edge });
    }
}
