//! Distances of convex shapes by brute force in `f64`, for tests.

use crate::math::{Pose, Vector};
use crate::shape::Shape;

type Wide = Vector<f64>;

fn widen(v: Vector) -> Wide {
    Wide { x: f64::from(v.x), y: f64::from(v.y), z: f64::from(v.z) }
}

/// A shape by its corners, edges and faces, and a radius.
pub(super) struct Solid {
    points: Vec<Wide>,
    edges: Vec<[usize; 2]>,
    triangles: Vec<[usize; 3]>,
    radius: f64,
}

impl Solid {
    /// Not for half-spaces and foreign shapes.
    pub fn new(shape: &Shape) -> Self {
        let flat = |points: &[Vector], radius: f32| {
            let n = points.len();
            let points = points.iter().map(|p| widen(*p)).collect();
            let edges = (0..n).flat_map(|i| (0..i).map(move |j| [j, i])).collect();
            let triangles = if n == 3 { vec![[0, 1, 2]] } else { vec![] };
            Self { points, edges, triangles, radius: f64::from(radius) }
        };
        match shape {
            Shape::Ball(s) => flat(&[Vector::ZERO], s.radius),
            Shape::Capsule(s) => flat(&[s.a, s.b], s.radius),
            Shape::Segment(s) => flat(&[s.a, s.b], 0.0),
            Shape::Triangle(s) => flat(&[s.a, s.b, s.c], 0.0),
            Shape::Cuboid(s) => Self::of_cuboid(s.half),
            Shape::Hull(h) => Self {
                points: h.vertices().iter().map(|p| widen(*p)).collect(),
                edges: h.edges().iter().map(|e| [e.tail as usize, e.head as usize]).collect(),
                triangles: h.faces().iter().flat_map(|f| fan(h.outline(f))).collect(),
                radius: f64::from(h.radius()),
            },
            Shape::Composite(_) | Shape::Curved(_) | Shape::HalfSpace(_) | Shape::Foreign(_) => {
                unreachable!("polyhedra with radii only")
            }
        }
    }

    fn of_cuboid(half: Vector) -> Self {
        let side = |i: usize, bit: usize| if i & bit == 0 { -1.0 } else { 1.0 };
        let corner = |i: usize| widen(Vector { x: side(i, 1), y: side(i, 2), z: side(i, 4) }.scale(half));
        let mut edges = Vec::new();
        let mut triangles = Vec::new();
        for i in 0..8usize {
            for bit in [1, 2, 4] {
                if i & bit == 0 {
                    edges.push([i, i | bit]);
                }
            }
        }
        for (u, v, w) in [(1, 2, 4), (2, 4, 1), (4, 1, 2)] {
            for base in [0, w] {
                triangles.push([base, base | u, base | v]);
                triangles.push([base | u | v, base | u, base | v]);
            }
        }
        Self { points: (0..8).map(corner).collect(), edges, triangles, radius: 0.0 }
    }

    /// Moved by a pose, in `f64`.
    pub fn at(mut self, pose: &Pose) -> Self {
        let q = pose.rotation;
        let u = Wide { x: f64::from(q.x), y: f64::from(q.y), z: f64::from(q.z) };
        for p in &mut self.points {
            let t = u.cross(*p) * 2.0;
            *p = *p + t * f64::from(q.w) + u.cross(t) + widen(pose.position);
        }
        self
    }

    /// The separation of `other` along a unit direction, radii included.
    pub fn separation_along(&self, other: &Self, normal: Vector) -> f64 {
        self.gap(other, widen(normal)) - self.radius - other.radius
    }

    fn gap(&self, other: &Self, n: Wide) -> f64 {
        let most = self.points.iter().map(|p| n.dot(*p)).fold(f64::NEG_INFINITY, f64::max);
        let least = other.points.iter().map(|p| n.dot(*p)).fold(f64::INFINITY, f64::min);
        least - most
    }

    fn normals(&self) -> impl Iterator<Item = Wide> + '_ {
        self.triangles.iter().map(|t| {
            let [a, b, c] = t.map(|i| self.points[i]);
            (b - a).cross(c - a)
        })
    }

    fn directions(&self) -> impl Iterator<Item = Wide> + '_ {
        self.edges.iter().map(|e| self.points[e[1]] - self.points[e[0]])
    }

    /// The distance; if the cores overlap, minus the least translation that separates the shapes.
    pub fn signed_distance(&self, other: &Self) -> f64 {
        let mut axes: Vec<Wide> = self.normals().chain(other.normals()).collect();
        for d in self.directions() {
            axes.extend(other.directions().map(|e| d.cross(e)));
        }
        let mut overlap = f64::NEG_INFINITY;
        for axis in axes {
            let length = axis.length();
            if length > 1e-9 * (1.0 + self.size() * other.size()) * 1e-3 && length > 0.0 {
                for n in [axis * (1.0 / length), axis * (-1.0 / length)] {
                    overlap = overlap.max(self.gap(other, n));
                }
            }
        }
        let apart = self.features_apart(other).min(other.features_apart(self));
        let core = if overlap > 0.0 || overlap == f64::NEG_INFINITY { apart } else { overlap };
        // Cores that touch without volume between them: the distance is 0 to rounding.
        core - self.radius - other.radius
    }

    fn size(&self) -> f64 {
        self.points.iter().map(|p| p.length()).fold(0.0, f64::max)
    }

    /// The least distance of a point or edge of this from a triangle, edge or point of the other.
    fn features_apart(&self, other: &Self) -> f64 {
        let mut least = f64::INFINITY;
        for p in &self.points {
            for q in &other.points {
                least = least.min((*p - *q).length());
            }
            for e in &other.edges {
                least = least.min(segments([*p, *p], e.map(|i| other.points[i])));
            }
            for t in &other.triangles {
                least = least.min(over_triangle(*p, t.map(|i| other.points[i])));
            }
        }
        for d in &self.edges {
            for e in &other.edges {
                least = least.min(segments(d.map(|i| self.points[i]), e.map(|i| other.points[i])));
            }
        }
        least
    }
}

fn fan(outline: &[u32]) -> Vec<[usize; 3]> {
    (2..outline.len()).map(|k| [outline[0], outline[k - 1], outline[k]].map(|i| i as usize)).collect()
}

/// The height of a point over a triangle if its foot is inside, otherwise infinity.
fn over_triangle(p: Wide, [a, b, c]: [Wide; 3]) -> f64 {
    let n = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)].iter().all(|(s, t)| n.dot((*t - *s).cross(p - *s)) >= 0.0);
    if inside && n.length() > 0.0 { (n.dot(p - a) / n.length()).abs() } else { f64::INFINITY }
}

/// The distance of two segments: inside both, or at an end of one.
fn segments([a, b]: [Wide; 2], [c, d]: [Wide; 2]) -> f64 {
    let to_segment = |p: Wide, s: Wide, t: Wide| {
        let u = t - s;
        let square = u.length_squared();
        let k = if square > 0.0 { ((p - s).dot(u) / square).clamp(0.0, 1.0) } else { 0.0 };
        (p - s - u * k).length()
    };
    let ends = to_segment(a, c, d).min(to_segment(b, c, d)).min(to_segment(c, a, b)).min(to_segment(d, a, b));
    let (u, v, w) = (b - a, d - c, c - a);
    let (uu, vv, uv) = (u.length_squared(), v.length_squared(), u.dot(v));
    let determinant = uu * vv - uv * uv;
    if determinant > 1e-12 * uu * vv {
        let s = (u.dot(w) * vv - v.dot(w) * uv) / determinant;
        let t = (u.dot(w) * uv - v.dot(w) * uu) / determinant;
        if (0.0..=1.0).contains(&s) && (0.0..=1.0).contains(&t) {
            return ends.min((a + u * s - c - v * t).length());
        }
    }
    ends
}
