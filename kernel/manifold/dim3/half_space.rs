//! A half-space against the vertices of any shape.

use super::reduce::{Candidates, MAX_CANDIDATES, keep};
use crate::manifold::{LocalManifold, LocalPoint, PairInput};
use crate::math::{Vector, min};
use crate::shape::Shape;

/// The contact of the half-space with the given unit normal, in its own frame, with a shape.
pub(super) fn collide(normal: Vector, b: &Shape, input: PairInput, out: &mut LocalManifold) {
    match b {
        Shape::Ball(s) => vertices(normal, [Vector::ZERO], s.radius, input, out),
        Shape::Capsule(s) => vertices(normal, [s.a, s.b], s.radius, input, out),
        Shape::Segment(s) => vertices(normal, [s.a, s.b], 0.0, input, out),
        Shape::Triangle(s) => vertices(normal, [s.a, s.b, s.c], 0.0, input, out),
        Shape::Cuboid(s) => {
            let side = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
            let corner = |i: usize| Vector { x: side(i & 1), y: side(i & 2), z: side(i & 4) }.scale(s.half);
            vertices(normal, (0..8).map(corner), 0.0, input, out);
        }
        Shape::Hull(s) => vertices(normal, s.vertices().iter().copied(), s.radius(), input, out),
        Shape::Composite(_) | Shape::Curved(_) | Shape::HalfSpace(_) | Shape::Foreign(_) => {}
    }
}

fn vertices(
    normal: Vector,
    points: impl IntoIterator<Item = Vector>,
    radius: f32,
    PairInput { pose, prediction, .. }: PairInput,
    out: &mut LocalManifold,
) {
    // Heights are computed in the frame of B: one product per vertex, and only near vertices are transformed.
    let (local, base) = (pose.rotation.inverse_rotate(normal), normal.dot(pose.position) - radius);
    let mut candidates = Candidates::<MAX_CANDIDATES>::new();
    out.gap = f32::INFINITY;
    for (i, p) in points.into_iter().enumerate() {
        let separation = local.dot(p) + base;
        out.gap = min(out.gap, separation);
        if separation <= prediction {
            let point = pose.transform(p) - normal * (radius + 0.5 * separation);
            candidates.push(LocalPoint::new(point, separation, i as u32));
        }
    }
    out.normal = normal;
    keep::<false>(candidates.as_slice(), out);
}
