//! The view of every bounded shape as a convex polygon with a radius.

use crate::math::{Pose, Vector};
use crate::shape::{Shape, direction, oriented};

/// A convex polygon with a radius: one vertex for a ball, two for a segment, otherwise counter-clockwise.
///
/// `normals[i]` is the outward unit normal of the edge from vertex `i` to the next. A segment has two
/// edges, there and back. A single vertex has no normals.
pub(super) struct Polygonal<'a> {
    pub(super) vertices: &'a [Vector],
    pub(super) normals: &'a [Vector],
    pub(super) radius: f32,
}

/// An edge of a polygon, counter-clockwise, with the indices of its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [Vector; 2],
    pub(super) indices: [usize; 2],
}

impl Edge {
    /// The edge in the outer frame of `pose`.
    #[inline]
    pub(super) fn moved(&self, pose: &Pose) -> Self {
        Self { ends: self.ends.map(|v| pose.transform(v)), indices: self.indices }
    }
}

/// A buffer for the vertices and normals of shapes that do not store them.
pub(super) struct Buffer {
    vertices: [Vector; 4],
    normals: [Vector; 4],
}

impl Buffer {
    pub(super) const EMPTY: Self = Self { vertices: [Vector::ZERO; 4], normals: [Vector::ZERO; 4] };
}

impl Polygonal<'_> {
    #[inline]
    pub(super) fn len(&self) -> usize {
        self.vertices.len()
    }

    /// The index after `i`, around the outline.
    #[inline]
    pub(super) fn next(&self, i: usize) -> usize {
        if i + 1 < self.len() { i + 1 } else { 0 }
    }

    /// The index before `i`, around the outline.
    #[inline]
    pub(super) fn previous(&self, i: usize) -> usize {
        if i == 0 { self.len() - 1 } else { i - 1 }
    }

    /// The edge `i`.
    #[inline]
    pub(super) fn edge(&self, i: usize) -> Edge {
        let j = self.next(i);
        Edge { ends: [self.vertices[i], self.vertices[j]], indices: [i, j] }
    }

    /// The vertex least far along `normal`, and its distance.
    #[inline]
    pub(super) fn lowest(&self, normal: Vector) -> (usize, f32) {
        let mut best = (0, f32::INFINITY);
        for (i, v) in self.vertices.iter().enumerate() {
            let h = v.dot(normal);
            if h < best.1 {
                best = (i, h);
            }
        }
        best
    }

    /// The edge at a vertex whose normal is more opposite to `normal`.
    #[inline]
    pub(super) fn edge_facing(&self, normal: Vector, vertex: usize) -> usize {
        let before = self.previous(vertex);
        if self.normals[before].dot(normal) < self.normals[vertex].dot(normal) { before } else { vertex }
    }
}

/// The polygon of a shape; `None` for ellipses, half-spaces and foreign shapes.
#[inline]
pub(super) fn view<'a>(shape: &'a Shape, room: &'a mut Buffer) -> Option<Polygonal<'a>> {
    Some(match shape {
        Shape::Ball(s) => {
            room.vertices[0] = Vector::ZERO;
            Polygonal { vertices: &room.vertices[..1], normals: &[], radius: s.radius }
        }
        Shape::Capsule(s) => segment(s.a, s.b, s.radius, room),
        Shape::Segment(s) => segment(s.a, s.b, 0.0, room),
        Shape::Cuboid(s) => {
            room.vertices = corners(s.half);
            room.normals = NORMALS;
            Polygonal { vertices: &room.vertices, normals: &room.normals, radius: 0.0 }
        }
        Shape::Triangle(s) => match oriented(s) {
            Ok((corners, normals)) => {
                room.vertices[..3].copy_from_slice(&corners);
                room.normals[..3].copy_from_slice(&normals);
                Polygonal { vertices: &room.vertices[..3], normals: &room.normals[..3], radius: 0.0 }
            }
            Err(side) => segment(side.a, side.b, 0.0, room),
        },
        Shape::Hull(s) => Polygonal { vertices: s.vertices(), normals: s.normals(), radius: s.radius() },
        Shape::Composite(_) | Shape::Curved(_) | Shape::HalfSpace(_) | Shape::Foreign(_) => return None,
    })
}

fn segment(a: Vector, b: Vector, radius: f32, room: &mut Buffer) -> Polygonal<'_> {
    room.vertices[0] = a;
    room.vertices[1] = b;
    match direction(b - a) {
        Some((axis, _)) => {
            room.normals[0] = -axis.perp();
            room.normals[1] = axis.perp();
            Polygonal { vertices: &room.vertices[..2], normals: &room.normals[..2], radius }
        }
        None => Polygonal { vertices: &room.vertices[..1], normals: &[], radius },
    }
}

/// The outward normals of a cuboid's edges, in the order of its [`corners`].
pub(super) const NORMALS: [Vector; 4] = [
    Vector::from_array([0.0, -1.0]),
    Vector::from_array([1.0, 0.0]),
    Vector::from_array([0.0, 1.0]),
    Vector::from_array([-1.0, 0.0]),
];

/// A cuboid's corners, counter-clockwise from the lower left.
#[inline]
pub(super) fn corners(half: Vector) -> [Vector; 4] {
    let Vector { x, y } = half;
    [[-x, -y], [x, -y], [x, y], [-x, y]].map(Vector::from_array)
}
