//! Closest points and depths of two cores that are given by their support functions.
//!
//! Separated cores: the closest points, by the search of [`distance`](crate::distance). Used where separating
//! axes understate the distance: between two vertices, or a vertex and an edge.
//!
//! Overlapping cores: the axis along which they are least deep, by an expanding polytope (van den Bergen,
//! "Proximity Queries and Penetration Depth Computation on 3D Game Objects", 2001). A polytope within the
//! Minkowski difference A − B grows toward the surface where its own surface is nearest to the origin. The
//! distance of this face is a lower bound of the depth, and the difference's support along the face's normal
//! is an upper bound. Both converge to the global minimum of the depth, however many local minima there are.

use super::view::{MatrixPose, View};
use crate::distance::gjk::{Accuracy, Difference, Search, Vertex};
use crate::manifold::LocalManifold;
use crate::math::Vector;
use crate::shape::Curved;
use crate::tuning::manifold::{FLAT, SAME};

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

type Wide = Vector<f64>;

/// Maximum number of corners, at which the search also ends. Only shapes with about the same depth along very
/// many directions reach it.
const MAX_CORNERS: usize = 96;
/// A closed surface of triangles has two triangles for each corner, less four.
const MAX_FACES: usize = 2 * MAX_CORNERS - 4;
/// A triangle of the polytope, counter-clockwise from outside.
#[derive(Clone, Copy)]
struct Face {
    corners: [u8; 3],
    normal: Wide,
    /// The distance of its plane from the origin; infinite if it has no area.
    offset: f64,
}

/// A convex polytope of triangles.
struct Polytope {
    corners: [Wide; MAX_CORNERS],
    corner_count: usize,
    faces: [Face; MAX_FACES],
    face_count: usize,
    size: f64,
}

/// The normal from A to B along which the cores are least deep, to within [`SAME`]. `None` if their
/// difference is flat. Not inlined, since its stack frame is large.
#[inline(never)]
pub(super) fn shallowest<A: Core, B: Core>(a: &A, b: &B, frame: &MatrixPose) -> Option<Vector> {
    let support = |normal: Wide| {
        let n = normal.narrow();
        let far_b = b.farthest_point(-frame.direction_in(n)).0;
        a.farthest_point(n).0.widen() - frame.point(far_b).widen()
    };
    let mut polytope = Polytope::start(&support)?;
    let (mut depth, mut normal) = (f64::INFINITY, Wide::ZERO);
    loop {
        let face = polytope.nearest();
        let corner = support(face.normal);
        let height = corner.dot(face.normal);
        if height < depth {
            (depth, normal) = (height, face.normal);
        }
        if !(depth - face.offset > f64::from(SAME) * depth) || !polytope.add(corner) {
            return (depth < f64::INFINITY).then(|| normal.narrow());
        }
    }
}

impl Polytope {
    /// A tetrahedron of points far apart.
    fn start(support: &impl Fn(Wide) -> Wide) -> Option<Self> {
        // The end of the extent along a direction that is farther from a given point.
        let farther = |direction: Wide, from: Wide| {
            let ends = [support(direction), support(-direction)];
            let [over, under] = ends.map(|p| (p - from).dot(direction).abs());
            if over >= under { (ends[0], over) } else { (ends[1], under) }
        };
        let x = Vector::X.widen();
        let (first, second) = (support(x), support(-x));
        let along = second - first;
        let size = along.length();
        if !(size > 0.0 && size.is_finite()) {
            return None;
        }
        let across = (along * (1.0 / size)).narrow().any_orthonormal().widen();
        let (third, width) = farther(across, first);
        let normal = along.cross(third - first);
        let (fourth, height) = farther(normal * (1.0 / normal.length()), first);
        if !(width > FLAT * size && height > FLAT * size) {
            return None;
        }
        let none = Face { corners: [0; 3], normal, offset: f64::INFINITY };
        let mut tetrahedron = Self {
            corners: [first; MAX_CORNERS],
            corner_count: 4,
            faces: [none; MAX_FACES],
            face_count: 0,
            size,
        };
        tetrahedron.corners[..4].copy_from_slice(&[first, second, third, fourth]);
        // Counter-clockwise, if the fourth corner is under the first face.
        let is_under = (fourth - first).dot(normal) < 0.0;
        for [i, j, k] in [[0, 1, 2], [1, 0, 3], [2, 1, 3], [0, 2, 3]] {
            tetrahedron.add_face(if is_under { [i, j, k] } else { [j, i, k] });
        }
        Some(tetrahedron)
    }

    fn add_face(&mut self, corners: [u8; 3]) {
        let [p, q, r] = corners.map(|i| self.corners[usize::from(i)]);
        let normal = (q - p).cross(r - p);
        let length = normal.length();
        // A face without area stays as it is: it is never the nearest, and never seen from a new corner.
        let mut face = Face { corners, normal, offset: f64::INFINITY };
        if length > 0.0 {
            face.normal = normal * (1.0 / length);
            face.offset = face.normal.dot(p);
        }
        self.faces[self.face_count] = face;
        self.face_count += 1;
    }

    /// The face nearest to the origin; if the origin is outside of some faces, the farthest of these.
    fn nearest(&self) -> Face {
        let mut nearest = 0;
        for (i, face) in self.faces[..self.face_count].iter().enumerate() {
            if face.offset < self.faces[nearest].offset {
                nearest = i;
            }
        }
        self.faces[nearest]
    }

    /// Adds a corner: a fan from the corner to the outline of the faces that it sees replaces these faces.
    /// Returns whether there was room, and a face to replace.
    fn add(&mut self, corner: Wide) -> bool {
        let margin = FLAT * self.size;
        // A replaced face adds at most three sides.
        let mut outline = [[0; 2]; 3 * MAX_FACES];
        let (mut sides, mut kept) = (0, 0);
        let mut put = |side: [u8; 2]| {
            // A side inside of the outline comes once in each direction.
            match outline[..sides].iter().position(|s| *s == [side[1], side[0]]) {
                Some(i) => {
                    outline[i] = outline[sides - 1];
                    sides -= 1;
                }
                None => {
                    outline[sides] = side;
                    sides += 1;
                }
            }
        };
        for i in 0..self.face_count {
            let face = self.faces[i];
            if face.normal.dot(corner) - face.offset > margin {
                let [i, j, k] = face.corners;
                [[i, j], [j, k], [k, i]].into_iter().for_each(&mut put);
            } else {
                self.faces[kept] = face;
                kept += 1;
            }
        }
        if kept == self.face_count || self.corner_count == MAX_CORNERS || kept + sides > MAX_FACES {
            return false;
        }
        let apex = self.corner_count as u8;
        self.corners[self.corner_count] = corner;
        self.corner_count += 1;
        self.face_count = kept;
        for side in &outline[..sides] {
            self.add_face([side[0], side[1], apex]);
        }
        true
    }
}
