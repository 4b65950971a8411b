//! The closest points of two separated cores, by the search of [`distance`](crate::distance).
//!
//! Used where separating axes understate the distance: between two vertices, or a vertex and an edge.

use super::view::{MatrixPose, View};
use crate::distance::gjk::{Accuracy, Difference, Search, Vertex};
use crate::manifold::LocalManifold;
use crate::math::{Vector, max};
use crate::shape::Curved;

/// A convex core, given by its support function.
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
    /// Fills `out` with one point between the closest points, where a contact has no point or separates by
    /// less than they do. `radii` are the radii around the cores.
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

/// The Minkowski difference of two cores.
struct Pair<'a, A, B> {
    a: &'a A,
    b: &'a B,
    frame: &'a MatrixPose,
}

impl<A: Core, B: Core> Difference for Pair<'_, A, B> {
    // Vertices are rounded to `f32`.
    const TOUCHING: f64 = 3.2e-7;
    const RELATIVE: f64 = 1.0e-6;

    #[inline(always)]
    fn vertex(&self, direction: Vector<f64>) -> Vertex {
        let direction = direction.narrow();
        let (a, i) = self.a.farthest_point(direction);
        let (b, j) = self.b.farthest_point(-self.frame.direction_in(direction));
        Vertex::new(a.widen(), self.frame.point(b).widen(), [i, j])
    }
}

/// The closest points, or `None` if the cores touch or overlap.
pub(super) fn closest<A: Core, B: Core>(a: &A, b: &B, frame: &MatrixPose) -> Option<Closest> {
    closest_within(a, b, frame, frame.point(b.center()) - a.center(), f32::INFINITY)
}

/// As [`closest`], up to a limit. The search starts with the vertices along a direction from A to B: the
/// nearer this is to the final normal, the fewer iterations are needed. For cores beyond the limit, the
/// distance is between the limit and the true distance, and the points are not the closest.
pub(super) fn closest_within<A: Core, B: Core>(
    a: &A,
    b: &B,
    frame: &MatrixPose,
    start: Vector,
    limit: f32,
) -> Option<Closest> {
    let mut search = Search::new(Pair { a, b, frame }, start.widen());
    let limit = f64::from(limit);
    let found =
        search.closest(Accuracy { tolerance: 0.0, beyond: limit }).filter(|found| found.distance > 0.0)?;
    // Numbers of both features, independent of the order of vertices. They are only compared from
    // step to step.
    let mask = |side: usize| {
        search.simplex().iter().fold(0u32, |bits, vertex| bits | 1 << (vertex.features[side] % 15))
    };
    Some(Closest {
        a: found.a.narrow(),
        b: found.b.narrow(),
        normal: found.normal.narrow(),
        distance: if found.gap > limit { found.gap } else { found.distance } as f32,
        feature: mask(0) << 15 | mask(1),
    })
}

/// The distance below which the closest points of shapes with these extents have no direction. Below it,
/// separating axes are used.
pub(super) fn resolution(larger: f32, smaller: f32) -> f32 {
    max(1.0e-3 * smaller, 1.0e-5 * larger)
}
