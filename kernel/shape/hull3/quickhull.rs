//! The convex hull of points, for users of the kernel alone and for tests.
//!
//! Quickhull (Barber, Dobkin and Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996) in `f64`
//! relative to one of the points. Points are `f32`, so nine digits remain for the rounding of planes.

use super::wide::{Wide, widen};
use super::{Hull, size_of};
use crate::math::Vector;
use crate::shape::ShapeError;

/// Points closer to each other than this share of the size count as one point, and points this close to a
/// plane are in it.
const TOLERANCE: f64 = 1.0e-5;
/// A point in front of a face by less than this share of the tolerance is on the face. The share must be
/// small: a point beyond the edge of a thin solid may be far away, but hardly in front of either face.
const ON_FACE: f64 = 1.0e-4;

/// A triangle of the growing hull.
struct Facet {
    corners: [usize; 3],
    normal: Wide,
    offset: f64,
    /// The points in front of this facet that `assign` gave to it.
    outside: Vec<usize>,
    alive: bool,
}

impl Facet {
    fn new(points: &[Wide], corners: [usize; 3]) -> Self {
        let [a, b, c] = corners.map(|i| points[i]);
        let area = (b - a).cross(c - a);
        let length = area.length();
        let normal = if length > 0.0 { area * (1.0 / length) } else { Wide::ZERO };
        Self { corners, normal, offset: normal.dot(a), outside: Vec::new(), alive: true }
    }

    fn height(&self, p: Wide) -> f64 {
        self.normal.dot(p) - self.offset
    }
}

impl Hull {
    /// The convex hull of points, if it has a volume; see [`convex_hull_of`](Self::convex_hull_of).
    pub fn around(points: &[Vector]) -> Option<Self> {
        Self::convex_hull_of(points).ok()
    }

    /// The convex hull of some points, in metres. Meant for up to a few hundred points.
    ///
    /// # Errors
    ///
    /// `NotFinite` for a bad coordinate, `Degenerate` if the points lie in a plane to within 0.001 % of their
    /// extent, or span less volume than a cube of 0.1 % of their extent.
    pub fn convex_hull_of(points: &[Vector]) -> Result<Self, ShapeError> {
        if points.iter().any(|p| !p.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        let size = f64::from(size_of(points));
        if !(size > 0.0) {
            return Err(ShapeError::Degenerate);
        }
        let tolerance = TOLERANCE * size;
        let mut distinct: Vec<Vector> = Vec::new();
        for p in points {
            let near = |q: &Vector| (widen(*q) - widen(*p)).length() < tolerance;
            if !distinct.iter().any(near) {
                distinct.push(*p);
            }
        }
        let wide: Vec<Wide> = distinct.iter().map(|p| widen(*p) - widen(distinct[0])).collect();
        let triangles = quickhull(&wide, tolerance).ok_or(ShapeError::Degenerate)?;
        Self::from_triangles(distinct, &triangles)
    }
}

/// The index of the point with the largest measure, if the measure is above the tolerance.
fn farthest(points: &[Wide], tolerance: f64, measure: impl Fn(Wide) -> f64) -> Option<usize> {
    let mut best = None;
    let mut most = tolerance;
    for (i, p) in points.iter().enumerate() {
        let m = measure(*p);
        if m > most {
            (best, most) = (Some(i), m);
        }
    }
    best
}

/// Four points that span a tetrahedron. The last point is behind the face of the first three.
fn first_tetrahedron(points: &[Wide], tolerance: f64) -> Option<[usize; 4]> {
    let a = *points.first()?;
    let b = farthest(points, tolerance, |p| (p - a).length())?;
    let axis = points[b] - a;
    let axis = axis * (1.0 / axis.length());
    let c = farthest(points, tolerance, |p| (p - a).cross(axis).length())?;
    let normal = axis.cross(points[c] - a);
    let normal = normal * (1.0 / normal.length());
    let d = farthest(points, tolerance, |p| normal.dot(p - a).abs())?;
    Some(if normal.dot(points[d] - a) > 0.0 { [0, c, b, d] } else { [0, b, c, d] })
}

/// The sides of the living facets, by their start point: the end point of each side, and its facet.
struct Sides(Vec<Vec<(usize, usize)>>);

impl Sides {
    fn add(&mut self, facet: usize, corners: [usize; 3]) {
        for k in 0..3 {
            self.0[corners[k]].push((corners[(k + 1) % 3], facet));
        }
    }

    fn remove(&mut self, facet: usize, corners: [usize; 3]) {
        corners.into_iter().for_each(|tail| self.0[tail].retain(|side| side.1 != facet));
    }

    /// The facet across a side.
    fn across(&self, tail: usize, head: usize) -> Option<usize> {
        self.0[head].iter().find(|side| side.0 == tail).map(|side| side.1)
    }
}

fn quickhull(points: &[Wide], tolerance: f64) -> Option<Vec<[u32; 3]>> {
    let [a, b, c, d] = first_tetrahedron(points, tolerance)?;
    let mut facets: Vec<Facet> =
        [[a, b, c], [a, d, b], [b, d, c], [c, d, a]].map(|t| Facet::new(points, t)).into();
    let mut sides = Sides(vec![Vec::new(); points.len()]);
    facets.iter().enumerate().for_each(|(f, facet)| sides.add(f, facet.corners));
    let tolerance = tolerance * ON_FACE;
    assign(points, &mut facets, 0, (0..points.len()).collect(), tolerance);
    // Every round removes at least the point it adds.
    for _ in 0..points.len() {
        let Some(facet) = facets.iter().position(|f| f.alive && !f.outside.is_empty()) else { break };
        let height = |i: &usize| facets[facet].height(points[*i]);
        let apex = *facets[facet].outside.iter().max_by(|x, y| height(x).total_cmp(&height(y)))?;
        let (visible, horizon) = visible_from(&facets, &sides, facet, points[apex], tolerance)?;
        let mut orphans = Vec::new();
        for f in visible {
            facets[f].alive = false;
            sides.remove(f, facets[f].corners);
            orphans.append(&mut facets[f].outside);
        }
        orphans.retain(|p| *p != apex);
        orphans.sort_unstable();
        let from = facets.len();
        for (tail, head) in horizon {
            sides.add(facets.len(), [tail, head, apex]);
            facets.push(Facet::new(points, [tail, head, apex]));
        }
        assign(points, &mut facets, from, orphans, tolerance);
    }
    Some(facets.iter().filter(|f| f.alive).map(|f| f.corners.map(|i| i as u32)).collect())
}

/// Assigns each point to the facet, from index `from` on, that it is farthest in front of.
fn assign(points: &[Wide], facets: &mut [Facet], from: usize, candidates: Vec<usize>, tolerance: f64) {
    for p in candidates {
        let mut best = None;
        let mut most = tolerance;
        for (f, facet) in facets.iter().enumerate().skip(from) {
            let height = facet.height(points[p]);
            if height > most && !facet.corners.contains(&p) {
                (best, most) = (Some(f), height);
            }
        }
        if let Some(f) = best {
            facets[f].outside.push(p);
        }
    }
}

/// The facets that a point sees and that are connected to the given facet, and the half edges around them.
fn visible_from(
    facets: &[Facet],
    sides: &Sides,
    start: usize,
    eye: Wide,
    tolerance: f64,
) -> Option<(Vec<usize>, Vec<(usize, usize)>)> {
    let mut visible = vec![start];
    let mut horizon = Vec::new();
    let mut at = 0;
    while at < visible.len() {
        let corners = facets[visible[at]].corners;
        at += 1;
        for k in 0..3 {
            let (tail, head) = (corners[k], corners[(k + 1) % 3]);
            let other = sides.across(tail, head)?;
            if visible.contains(&other) {
                continue;
            }
            // A facet without area is replaced together with its neighbours.
            let flat = facets[other].normal == Wide::ZERO;
            if flat || facets[other].height(eye) > tolerance * 1.0e-3 {
                visible.push(other);
            }
        }
    }
    for f in &visible {
        let corners = facets[*f].corners;
        for k in 0..3 {
            let (tail, head) = (corners[k], corners[(k + 1) % 3]);
            if !visible.contains(&sides.across(tail, head)?) {
                horizon.push((tail, head));
            }
        }
    }
    Some((visible, horizon))
}
