//! The closest points of two separated polyhedra (Gilbert, Johnson and Keerthi, "A Fast Procedure
//! for Computing the Distance Between Complex Objects in Three-Dimensional Space", 1988).
//!
//! Used where separating axes understate the distance: between two vertices, or a vertex and an edge. The simplex is solved in
//! `f64`, since tetrahedra may be thin.

use super::view::{MatrixPose, View};
use crate::distance::nearest_weights;
use crate::manifold::LocalManifold;
use crate::math::{Vector, max};
use crate::shape::Curved;

/// The most iterations. No tested hull needs as many; it only ends the loop.
const MAX_ITERATIONS: usize = 48;
/// The loop stops at this relative gap between the upper and the lower bound of the squared distance.
const GAP: f64 = 1.0e-6;

type Wide = Vector<f64>;

/// A convex core by its farthest points.
pub(super) trait Core {
    /// The point farthest along a direction of any length, and the number of its feature.
    fn farthest_point(&self, direction: Vector) -> (Vector, u32);
    /// A point inside.
    fn center(&self) -> Vector;
}

impl Core for View<'_> {
    #[inline]
    fn farthest_point(&self, direction: Vector) -> (Vector, u32) {
        let i = self.support(direction);
        (self.vertices[i], i as u32)
    }

    fn center(&self) -> Vector {
        self.center
    }
}

impl Core for Curved {
    #[inline]
    fn farthest_point(&self, direction: Vector) -> (Vector, u32) {
        let (point, end) = self.farthest(direction);
        (point, end as u32)
    }

    fn center(&self) -> Vector {
        Vector::ZERO
    }
}

/// The closest points of two cores.
#[derive(Clone, Copy)]
pub(super) struct Closest {
    /// On A, in A's frame.
    pub a: Vector,
    /// On B, in A's frame.
    pub b: Vector,
    /// The unit normal from A to B.
    pub normal: Vector,
    pub distance: f32,
    /// The vertices that the points lie between.
    pub feature: u32,
}

impl Closest {
    /// Fills `out` with one point between the closest points, where a contact has no point or separates by less than they do.
    /// `radii` are those around the cores.
    pub fn fill_apart(&self, radii: [f32; 2], separation: f32, prediction: f32, out: &mut LocalManifold) {
        if !(self.distance > separation) && out.count > 0 {
            return;
        }
        let [of_a, of_b] = radii;
        (out.count, out.normal) = (0, self.normal);
        let distance = self.distance - of_a - of_b;
        if distance <= prediction {
            let point = (self.a + self.normal * of_a + self.b - self.normal * of_b) * 0.5;
            out.push(point, distance, 3 << 30 | self.feature);
        }
    }
}

/// A vertex of the Minkowski difference A − B.
#[derive(Clone, Copy, Default)]
struct Vertex {
    a: Wide,
    b: Wide,
    w: Wide,
    ids: (u32, u32),
    weight: f64,
}

/// The closest points, or `None` if the cores touch or overlap.
pub(super) fn closest<A: Core, B: Core>(a: &A, b: &B, frame: &MatrixPose) -> Option<Closest> {
    closest_along(a, b, frame, frame.point(b.center()) - a.center())
}

/// The same, beginning with the vertices along a direction from A to B. The nearer it is to that between the closest points,
/// the fewer iterations are needed.
pub(super) fn closest_along<A: Core, B: Core>(
    a: &A,
    b: &B,
    frame: &MatrixPose,
    start: Vector,
) -> Option<Closest> {
    closest_within(a, b, frame, start, f32::INFINITY)
}

/// The same up to a limit: of cores that are farther apart the distance may be any between the limit and the true one, and
/// the points are not the closest.
pub(super) fn closest_within<A: Core, B: Core>(
    a: &A,
    b: &B,
    frame: &MatrixPose,
    start: Vector,
    limit: f32,
) -> Option<Closest> {
    let limit = f64::from(limit);
    let vertex = |direction: Vector| {
        let (p, i) = a.farthest_point(direction);
        let (q, j) = b.farthest_point(-frame.direction_in(direction));
        let (p, q) = (p.widen(), frame.point(q).widen());
        Vertex { a: p, b: q, w: p - q, ids: (i, j), weight: 1.0 }
    };
    let mut simplex = [Vertex::default(); 4];
    simplex[0] = vertex(start);
    let mut count = 1;
    let mut nearest = simplex[0].w;
    let mut scale = nearest.length_squared();
    for _ in 0..MAX_ITERATIONS {
        let square = nearest.length_squared();
        // Distances below the rounding of the vertices count as touching.
        if !(square > 1.0e-13 * scale) {
            return None;
        }
        let new = vertex((nearest * (-1.0 / square.sqrt())).narrow());
        scale = if new.w.length_squared() > scale { new.w.length_squared() } else { scale };
        let bound = nearest.dot(new.w) / square.sqrt();
        if bound > limit {
            return Some(Closest { distance: bound as f32, ..witness(&simplex[..count], nearest) });
        }
        let known = simplex[..count].iter().any(|v| v.ids == new.ids && v.w == new.w);
        if known || square - nearest.dot(new.w) <= GAP * square {
            break;
        }
        let mut next = simplex;
        next[count] = new;
        let (next_count, point) = solve(&mut next, count + 1)?;
        if !(point.length_squared() < square) {
            break;
        }
        (simplex, count, nearest) = (next, next_count, point);
    }
    Some(witness(&simplex[..count], nearest))
}

fn witness(simplex: &[Vertex], nearest: Wide) -> Closest {
    let sum = |f: fn(&Vertex) -> Wide| simplex.iter().fold(Wide::ZERO, |s, v| s + f(v) * v.weight);
    let distance = nearest.length();
    // Ids of both features, independent of the order of vertices. They are only compared from step to step.
    let mask = |f: fn(&Vertex) -> u32| {
        let mut bits = 0u32;
        for v in simplex {
            bits |= 1 << (f(v) % 15);
        }
        bits
    };
    Closest {
        a: sum(|v| v.a).narrow(),
        b: sum(|v| v.b).narrow(),
        normal: (nearest * (-1.0 / distance)).narrow(),
        distance: distance as f32,
        feature: mask(|v| v.ids.0) << 15 | mask(|v| v.ids.1),
    }
}

/// Reduces the simplex to its face nearest to the origin and returns the face's size and closest point. `None` if the origin
/// is inside.
fn solve(simplex: &mut [Vertex; 4], count: usize) -> Option<(usize, Wide)> {
    let corners = simplex.map(|v| v.w);
    let weights = nearest_weights(&corners[..count])?;
    let mut kept = 0;
    let mut point = Wide::ZERO;
    for (i, weight) in weights.into_iter().enumerate().take(count) {
        if weight > 0.0 {
            simplex[kept] = Vertex { weight, ..simplex[i] };
            point += simplex[kept].w * weight;
            kept += 1;
        }
    }
    Some((kept, point))
}

/// The distance below which closest points of shapes of these extents have no direction. Separating axes are used there.
pub(super) fn resolution(larger: f32, smaller: f32) -> f32 {
    max(1.0e-3 * smaller, 1.0e-5 * larger)
}
