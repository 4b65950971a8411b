//! The part of an incident face that lies over a reference face (Sutherland and Hodgman, "Reentrant
//! Polygon Clipping", 1974), with a name for each corner that lasts from step to step.

use super::view::{Frame, View};
use crate::math::Vector;

/// The most corners a clipped polygon has. Cutting adds at most one per side.
pub(super) const MAX_CORNERS: usize = 64;
/// Incident faces with more vertices are thinned to every second, fourth, … vertex.
const MAX_INCIDENT: usize = 32;
/// Side planes stand this share of the smaller shape's extent outside of the face: two equal faces on
/// each other then keep their own corners in spite of rounding.
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

/// A clipped polygon on the stack.
pub(super) struct Polygon {
    corners: [Corner; MAX_CORNERS],
    count: usize,
}

impl Polygon {
    fn new() -> Self {
        Self { corners: [Corner::default(); MAX_CORNERS], count: 0 }
    }

    pub fn corners(&self) -> &[Corner] {
        &self.corners[..self.count]
    }

    fn push(&mut self, corner: Corner) {
        if self.count < MAX_CORNERS {
            self.corners[self.count] = corner;
            self.count += 1;
        }
    }
}

/// The face (or edge, or vertex, of what has no faces) of `incident` that looks most against a
/// direction, both in its own frame, among the faces around the vertex `deepest` along it. A face
/// elsewhere may look more against it: the base of a cone that stands on its tip.
pub(super) fn incident_polygon(incident: &View, normal: Vector, deepest: usize, frame: &Frame) -> Polygon {
    let mut polygon = Polygon::new();
    if incident.faces.is_empty() {
        for (i, v) in incident.vertices.iter().enumerate() {
            polygon.push(Corner { point: frame.point(*v), name: (i as u32) << 10, edge: 0 });
        }
        return polygon;
    }
    let (mut face, mut least) = (0, f32::INFINITY);
    for edge in incident.edges {
        if edge.tail as usize == deepest || edge.head as usize == deepest {
            for side in [edge.left as usize, edge.right as usize] {
                let cos = incident.faces[side].normal.dot(normal);
                if cos < least {
                    (face, least) = (side, cos);
                }
            }
        }
    }
    let outline = incident.outline(face);
    let stride = outline.len().div_ceil(MAX_INCIDENT).next_power_of_two();
    for i in outline.iter().step_by(stride) {
        let number = i & 0x1ff;
        let point = frame.point(incident.vertices[*i as usize]);
        polygon.push(Corner { point, name: number << 10, edge: number });
    }
    polygon
}

/// Cuts a polygon by the side planes of a face of `reference`; `extent` is that of the smaller shape.
pub(super) fn clip(reference: &View, face: usize, polygon: &mut Polygon, extent: f32) {
    let normal = reference.faces[face].normal;
    let outline = reference.outline(face);
    let mut tail = reference.vertices[outline[outline.len() - 1] as usize];
    // Copied only when a side really cuts: most corners of a resting body are inside of all.
    let mut spare = None;
    for (side, i) in outline.iter().enumerate() {
        let head = reference.vertices[*i as usize];
        let outward = (head - tail).cross(normal);
        let margin = MARGIN * extent * outward.length();
        let plane = (outward, outward.dot(tail) + margin);
        if polygon.corners().iter().any(|c| !(outward.dot(c.point) <= plane.1)) {
            let spare = spare.get_or_insert_with(Polygon::new);
            cut(polygon, plane, side as u32, spare);
            core::mem::swap(polygon, spare);
        }
        if polygon.count == 0 {
            break;
        }
        tail = head;
    }
}

/// The part of a convex polygon behind a plane.
fn cut(polygon: &Polygon, (outward, offset): (Vector, f32), side: u32, out: &mut Polygon) {
    out.count = 0;
    let corners = polygon.corners();
    // A segment is an outline that is walked once, not there and back.
    let walk = if corners.len() == 2 { 1 } else { corners.len() };
    let height = |c: &Corner| outward.dot(c.point) - offset;
    let mut this = height(&corners[0]);
    let side_name = (side + 1) & 0x3ff;
    for k in 0..corners.len() {
        let (c, d) = (&corners[k], &corners[if k + 1 < corners.len() { k + 1 } else { 0 }]);
        let next = height(d);
        if this <= 0.0 {
            out.push(*c);
        }
        if k < walk && (this <= 0.0) != (next <= 0.0) {
            let t = this / (this - next);
            let point = c.point + (d.point - c.point) * t;
            // Where the polygon leaves, its next edge runs along the side.
            let edge = if this <= 0.0 { ON_SIDE | side & 0x1ff } else { c.edge };
            out.push(Corner { point, name: c.edge << 10 | side_name, edge });
        }
        this = next;
    }
}
