//! Ellipses against all other shapes: one point, since two would come and go on a curve.
//!
//! Along the best axis the support points of both shapes are opposite each other. So the direction of their
//! lateral shift tells the direction in which the axis must turn, and bisection finds it. Edges of polygons
//! are separate axes.

use super::super::{LocalManifold, PairInput};
use super::polygonal::Polygonal;
use crate::math::{Rot, Vector, max};
use crate::shape::{Curved, direction};
use crate::tuning::contact::DEEP;
use crate::tuning::manifold::ALIKE;
use crate::tuning::sweeps::ROUNDS;

/// A round shape, given by its support function.
pub(super) trait Rounded {
    /// The point of the core that is farthest along a unit direction.
    fn farthest(&self, direction: Vector) -> Vector;
    /// The radius around the core.
    fn radius(&self) -> f32;
    /// The radius of curvature of the surface with a normal.
    fn curvature(&self, normal: Vector) -> f32;
    /// Half sizes of the ellipse that the shape is or resembles. The normals of this ellipse are tried.
    fn half(&self) -> Vector {
        Vector::ONE
    }
}

impl Rounded for Curved {
    fn half(&self) -> Vector {
        self.half
    }

    fn farthest(&self, direction: Vector) -> Vector {
        self.support(direction)
    }

    fn radius(&self) -> f32 {
        0.0
    }

    fn curvature(&self, normal: Vector) -> f32 {
        self.curvature_radius(normal)
    }
}

/// The pair of a shape A and an ellipse B.
struct Pair<'a> {
    b: &'a Curved,
    input: PairInput<'a>,
}

impl Pair<'_> {
    /// The farthest point of B against a direction.
    fn lowest(&self, normal: Vector) -> Vector {
        self.input.pose.transform(self.b.support(self.input.pose.rotation.inverse_rotate(-normal)))
    }

    /// Fills `out` from a unit normal, the points on A's core and on B, and A's radii: around its core, and
    /// of curvature.
    fn push(&self, normal: Vector, [on_a, on_b]: [Vector; 2], radii: [f32; 2], out: &mut LocalManifold) {
        let [radius, curvature] = radii;
        let separation = normal.dot(on_b - on_a) - radius;
        out.normal = normal;
        if separation <= self.input.prediction {
            out.radii = [curvature, self.b.curvature_radius(self.input.pose.rotation.inverse_rotate(normal))];
            out.push((on_a + on_b + normal * radius) * 0.5, separation, 0);
        } else {
            out.gap = max(separation, 0.0);
        }
    }

    /// The normal of the largest separation from a core: the best of several directions, improved.
    fn best_normal(&self, a: &impl Rounded) -> Vector {
        let of_a = self.best_in_fan(a, |around| normal_of(a.half(), around));
        let rotation = self.input.pose.rotation;
        let of_b = self.best_in_fan(a, |around| rotation.rotate(normal_of(self.b.half, around)));
        if of_b.0 > of_a.0 { of_b.1 } else { of_a.1 }
    }

    /// The largest separation from a core near the best of the normals that `fan` computes from directions
    /// around an ellipse, and its normal. The normals of a flat ellipse are close together.
    fn best_in_fan(&self, a: &impl Rounded, fan: impl Fn(Vector) -> Vector) -> (f32, Vector) {
        // A sixteenth of a turn.
        let (directions, step) = (16, Rot { cos: 0.923_879_5, sin: 0.382_683_43 });
        let (mut most, mut best, mut around) = (f32::NEG_INFINITY, Vector::Y, Vector::Y);
        for _ in 0..directions {
            let normal = fan(around);
            let separation = self.separation(normal, a.farthest(normal));
            if separation > most {
                (most, best) = (separation, around);
            }
            around = step.rotate(around);
        }
        let [low, high] = [step.inverse_rotate(best), step.rotate(best)].map(&fan);
        let normal = self.bisect(low, high, |n| a.farthest(n));
        (self.separation(normal, a.farthest(normal)), normal)
    }

    /// The separation along a normal from a point of A.
    fn separation(&self, normal: Vector, point: Vector) -> f32 {
        normal.dot(self.lowest(normal) - point)
    }

    /// The normal between `low` and `high` at which the support points are opposite each other. `point` gives
    /// A's.
    fn bisect(&self, mut low: Vector, mut high: Vector, point: impl Fn(Vector) -> Vector) -> Vector {
        for _ in 0..ROUNDS {
            let Some((middle, _)) = direction(low + high) else { break };
            let shift = (self.lowest(middle) - point(middle)).dot(middle.perp());
            if shift > 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        direction(low + high).map_or(low, |(normal, _)| normal)
    }
}

/// The normal of an ellipse at the point that a circle with a normal is stretched to.
fn normal_of(half: Vector, around: Vector) -> Vector {
    let least = ALIKE * half.max_element();
    let (x, y) = (max(half.y, least) * around.x, max(half.x, least) * around.y);
    direction(Vector { x, y }).map_or(around, |(normal, _)| normal)
}

impl Rounded for Polygonal<'_> {
    fn farthest(&self, direction: Vector) -> Vector {
        let higher = |p: Vector, q: &Vector| if q.dot(direction) > p.dot(direction) { *q } else { p };
        self.vertices.iter().fold(self.vertices[0], higher)
    }

    fn radius(&self) -> f32 {
        self.radius
    }

    fn curvature(&self, _: Vector) -> f32 {
        self.radius
    }
}

/// A ball or ellipse A and an ellipse B.
pub(super) fn collide_round(a: &impl Rounded, b: &Curved, input: PairInput, out: &mut LocalManifold) {
    let pair = Pair { b, input };
    let normal = pair.best_normal(a);
    let points = [a.farthest(normal), pair.lowest(normal)];
    pair.push(normal, points, [a.radius(), a.curvature(normal)], out);
}

/// A ball or polygon A and an ellipse B.
pub(super) fn collide(a: &Polygonal, b: &Curved, input: PairInput, out: &mut LocalManifold) {
    if a.len() == 1 {
        return collide_round(a, b, input, out);
    }
    let pair = Pair { b, input };
    let (mut most, mut edge) = (f32::NEG_INFINITY, 0);
    for (i, (v, n)) in a.vertices.iter().zip(a.normals).enumerate() {
        let separation = pair.separation(*n, *v);
        if separation > most {
            (most, edge) = (separation, i);
        }
    }
    let (start, end, n) = (a.vertices[edge], a.vertices[a.next(edge)], a.normals[edge]);
    let lowest = pair.lowest(n);
    let axis = n.perp();
    let radii = [a.radius; 2];
    let (before, after) = ((lowest - start).dot(axis) < 0.0, (lowest - end).dot(axis) > 0.0);
    let (mut normal, mut points) = (n, [lowest - n * most, lowest]);
    if before || after {
        // The normals of a corner lie between its edges' normals, counter-clockwise.
        let (corner, outward) = if before { (start, -axis) } else { (end, axis) };
        let (mut low, mut high) =
            if before { (a.normals[a.previous(edge)], n) } else { (n, a.normals[a.next(edge)]) };
        if a.len() == 2 {
            // The normals of a segment's end span half a turn.
            let shift = (pair.lowest(outward) - corner).dot(outward.perp());
            (low, high) = if shift > 0.0 { (outward, high) } else { (low, outward) };
        }
        normal = pair.bisect(low, high, |_| corner);
        points = [corner, pair.lowest(normal)];
    }
    // For deep overlap another corner or side may be the best.
    let separation = normal.dot(points[1] - points[0]);
    if separation < -DEEP * b.half.max_element() {
        let other = pair.best_normal(a);
        let found = [a.farthest(other), pair.lowest(other)];
        if other.dot(found[1] - found[0]) > separation + 1.0e-3 * b.half.max_element() {
            (normal, points) = (other, found);
        }
    }
    pair.push(normal, points, radii, out);
}

/// A half-space A, of the given normal, and an ellipse B.
pub(super) fn half_space(normal: Vector, b: &Curved, input: PairInput, out: &mut LocalManifold) {
    let pair = Pair { b, input };
    let lowest = pair.lowest(normal);
    pair.push(normal, [lowest - normal * normal.dot(lowest), lowest], [0.0; 2], out);
    if out.count == 0 {
        out.gap = normal.dot(lowest);
    }
}
