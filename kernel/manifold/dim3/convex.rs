//! Any two polyhedra, with radii: the points along their separating axis.

use super::axis::{self, Axis, EDGES, EdgeAxis, FACE_A, FACE_B, FaceAxis, Known, Pair as _, Sizes};
use super::clip::{self, FEW_CORNERS, MAX_CORNERS, Polygon, Reference, clip_line};
use super::gjk;
use super::view::{MatrixPose, View};
use crate::manifold::{FeatureCache, LocalManifold, PairInput};
use crate::math::{Vector, clamp, max};
use crate::shape::Edge;
use crate::tuning::manifold::{FACING, MARGIN};

/// The number of faces of a triangle, which no solid has.
const TRIANGLE_FACES: usize = 2;

/// Two polyhedra and their relative pose.
pub(super) struct Pair<'a> {
    a: &'a View<'a>,
    b: &'a View<'a>,
    b_in_a: MatrixPose,
    a_in_b: MatrixPose,
    sizes: Sizes,
}

/// The contact of two polyhedra; see the module.
pub(super) fn collide(a: &View, b: &View, input: PairInput, out: &mut LocalManifold) {
    let pair = Pair::new(a, b, input);
    if a.faces.is_empty() && b.faces.is_empty() {
        return pair.build_faceless(out);
    }
    pair.collide(input.cache, out);
}

impl axis::Pair for Pair<'_> {
    fn sizes(&self) -> &Sizes {
        &self.sizes
    }

    fn cached(&self, cache: FeatureCache) -> Option<Axis> {
        let (i, j) = (cache.a as usize, cache.b as usize);
        match cache.kind {
            FACE_A if i < self.a.faces.len() => {
                Some(Axis::Face(axis::face_separation(self.a, i, self.b, &self.b_in_a)))
            }
            FACE_B if j < self.b.faces.len() => {
                let face = axis::face_separation(self.b, j, self.a, &self.a_in_b);
                Some(Axis::Face(FaceAxis { of_b: true, ..face }))
            }
            EDGES if i < self.a.edges.len() && j < self.b.edges.len() => {
                axis::edge_separation(self.a, i, self.b, j, &self.b_in_a).map(Axis::Edges)
            }
            _ => None,
        }
    }

    fn best_face(&self, of_b: bool) -> FaceAxis {
        let (this, other, frame) = self.ordered(of_b);
        FaceAxis { of_b, ..axis::best_face(this, other, frame, self.sizes.limit()) }
    }

    fn best_edges(&self, of_a: &FaceAxis, of_b: &FaceAxis, separation: f32) -> Option<EdgeAxis> {
        let of_b_in_a = self.b_in_a.point(self.b.vertices[of_a.lowest]);
        let of_a_in_b = self.a_in_b.point(self.a.vertices[of_b.lowest]);
        let known = Known { of_b_in_a, of_a_in_b, separation };
        axis::best_edges(self.a, self.b, &self.b_in_a, &known, self.sizes.limit())
    }

    fn build_face(&self, axis: &FaceAxis, out: &mut LocalManifold) -> bool {
        let (reference, incident, frame) = self.ordered(axis.of_b);
        let local = frame.direction_in(reference.faces[axis.face].normal);
        let face = clip::incident_face(incident, local, axis.lowest);
        if reference.corners_of(Some(axis.face)) + incident.corners_of(face) < FEW_CORNERS {
            self.clip_face::<FEW_CORNERS>(axis, face, out)
        } else {
            self.clip_face::<MAX_CORNERS>(axis, face, out)
        }
    }

    fn build_edges(&self, axis: &EdgeAxis, out: &mut LocalManifold) -> bool {
        let (edge_a, edge_b) = (&self.a.edges[axis.a], &self.b.edges[axis.b]);
        let ends_a = [edge_a.tail, edge_a.head].map(|i| self.a.vertices[i as usize]);
        let ends_b = [edge_b.tail, edge_b.head].map(|i| self.b_in_a.point(self.b.vertices[i as usize]));
        let (point_a, point_b, inside) = closest_of_lines(ends_a, ends_b);
        let normal = axis.normal;
        let between = (point_a + normal * self.a.radius + point_b - normal * self.b.radius) * 0.5;
        let feature = 2 << 30 | (axis.a as u32 & 0x7fff) << 15 | axis.b as u32 & 0x7fff;
        (out.count, out.normal) = (0, normal);
        if axis.separation - self.sizes.radius <= self.sizes.prediction {
            out.push(between, axis.separation - self.sizes.radius, feature);
            self.push_far_ends(axis, [ends_a, ends_b], out);
        }
        inside
    }

    fn build_apart(&self, axis: &Axis, out: &mut LocalManifold) {
        if let Some(closest) = gjk::closest(self.a, self.b, &self.b_in_a) {
            closest.fill_apart(self.radii(), axis.separation(), self.sizes.prediction, out);
        }
    }

    fn push_deepest(&self, axis: &FaceAxis, out: &mut LocalManifold) {
        let (_, incident, frame) = self.ordered(axis.of_b);
        let corner = frame.point(incident.vertices[axis.lowest]);
        self.reference(axis).push_deepest(corner, axis.separation, out);
    }
}

impl<'a> Pair<'a> {
    pub fn new(a: &'a View<'a>, b: &'a View<'a>, input: PairInput) -> Self {
        let b_in_a = MatrixPose::new(input.pose);
        let sizes = Sizes::new(input.prediction, a.radius + b.radius, [a.extent, b.extent]);
        Self { a, b, b_in_a, a_in_b: b_in_a.inverse(), sizes }
    }

    /// The polyhedron of the reference face (B if `of_b`), the incident polyhedron, and the pose of the
    /// incident in the reference frame.
    #[inline(always)]
    fn ordered(&self, of_b: bool) -> (&View<'a>, &View<'a>, &MatrixPose) {
        if of_b { (self.b, self.a, &self.a_in_b) } else { (self.a, self.b, &self.b_in_a) }
    }

    /// `face` is the incident face, if the incident polyhedron has faces.
    #[inline(never)]
    fn clip_face<const N: usize>(
        &self,
        axis: &FaceAxis,
        face: Option<usize>,
        out: &mut LocalManifold,
    ) -> bool {
        let (view, incident, frame) = self.ordered(axis.of_b);
        let mut polygon = Polygon::<N>::new();
        clip::incident_polygon(incident, face, |v| (frame.point(v), ()), &mut polygon);
        let reference = self.reference(axis);
        out.normal = if axis.of_b { -self.b_in_a.direction(reference.normal) } else { reference.normal };
        reference.fill_clipped(view, axis, &mut polygon, self.sizes.smaller, out)
    }

    /// The face of an axis.
    #[inline(always)]
    fn reference(&self, axis: &FaceAxis) -> Reference<'_> {
        let (view, incident, _) = self.ordered(axis.of_b);
        let reference =
            Reference::of_face(view, axis.face, axis.of_b, incident.radius, self.sizes.prediction);
        Reference { to_a: axis.of_b.then_some(&self.b_in_a), ..reference }
    }

    /// Adds the other ends of the lines along which the edges pass over each other's faces, where these ends
    /// are near.
    fn push_far_ends(&self, axis: &EdgeAxis, [ends_a, ends_b]: [[Vector; 2]; 2], out: &mut LocalManifold) {
        // The edges of a triangle may be inner edges of a surface, which tests each facet's points.
        if self.a.faces.len() == TRIANGLE_FACES || self.b.faces.len() == TRIANGLE_FACES {
            return;
        }
        let normal = axis.normal;
        let mut push = |on_a: Vector, on_b: Vector, gap: f32, feature: u32| {
            if gap > axis.separation && gap - self.sizes.radius <= self.sizes.prediction {
                let point = (on_a + normal * self.a.radius + on_b - normal * self.b.radius) * 0.5;
                out.push(point, gap - self.sizes.radius, 7 << 29 | feature);
            }
        };
        if let Some((on_b, gap)) = far_end(self.a, &self.a.edges[axis.a], ends_b, normal) {
            push(on_b - normal * gap, on_b, gap, axis.b as u32 & 0x7fff);
        }
        let ends_a = ends_a.map(|end| self.a_in_b.point(end));
        let out_of_b = self.b_in_a.direction_in(-normal);
        if let Some((on_a, gap)) = far_end(self.b, &self.b.edges[axis.b], ends_a, out_of_b) {
            let on_a = self.b_in_a.point(on_a);
            push(on_a, on_a + normal * gap, gap, 1 << 28 | axis.a as u32 & 0x7fff);
        }
    }

    /// Two cores without faces: a triangle without area is a segment or a point.
    fn build_faceless(&self, out: &mut LocalManifold) {
        out.count = 0;
        match gjk::closest(self.a, self.b, &self.b_in_a) {
            Some(closest) => closest.fill_apart(self.radii(), f32::NEG_INFINITY, self.sizes.prediction, out),
            None => {
                out.normal = Vector::Y;
                out.push(self.a.center, -self.sizes.radius, 3 << 30);
            }
        }
    }

    fn radii(&self) -> [f32; 2] {
        [self.a.radius, self.b.radius]
    }
}

/// The closest points of two lines that are not parallel, clamped to the segments given by their ends, and
/// whether they were inside of the segments.
pub(super) fn closest_of_lines(a: [Vector; 2], b: [Vector; 2]) -> (Vector, Vector, bool) {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], b[0] - a[0]);
    let (uu, vv, uv) = (u.length_squared(), v.length_squared(), u.dot(v));
    let (uw, vw) = (u.dot(w), v.dot(w));
    let determinant = uu * vv - uv * uv;
    if !(determinant > 0.0) {
        return (a[0] + u * 0.5, b[0] + v * 0.5, false);
    }
    let s = (uw * vv - vw * uv) / determinant;
    let t = (uw * uv - vw * uu) / determinant;
    let inside = max(max(-s, s - 1.0), max(-t, t - 1.0)) < MARGIN;
    (a[0] + u * clamp(s, 0.0, 1.0), b[0] + v * clamp(t, 0.0, 1.0), inside)
}

/// An edge passes over the face of `reference` beside `edge` along a line. Returns the end of this line that
/// is farther from the face: the point on the edge, and its distance from the face along `normal`. The ends
/// of the edge are in the frame of `reference`; `normal` is the unit normal of the contact, out of
/// `reference`.
///
/// Two edges touch in one point. A thin rod on the edge of another rod would rock on this point, from one of
/// its own edges to the next: the other end of the line across its face is hardly farther from the surface.
/// So this end is a contact point too.
fn far_end(reference: &View, edge: &Edge, ends: [Vector; 2], normal: Vector) -> Option<(Vector, f32)> {
    // A segment has no faces.
    let [left, right] = [edge.left, edge.right].map(|face| reference.faces.get(face as usize));
    let (left, right) = (left?, right?);
    let face = if left.normal.dot(normal) > right.normal.dot(normal) { left } else { right };
    let cosine = face.normal.dot(normal);
    if cosine < FACING {
        return None;
    }
    let along = ends[1] - ends[0];
    let outline = &reference.loops[face.first as usize..(face.first + face.count) as usize];
    let outline = outline.iter().map(|corner| reference.vertices[*corner as usize]);
    let [(low, _), (high, _)] = clip_line(normal, outline, ends, 0.0).filter(|[low, high]| low.0 < high.0)?;
    let end = |t: f32| {
        let point = ends[0] + along * t;
        (point, (face.normal.dot(point) - face.offset) / cosine)
    };
    let (first, last) = (end(low), end(high));
    Some(if first.1 > last.1 { first } else { last })
}

#[cfg(test)]
mod tests {
    use crate::manifold::{FeatureCache, LocalManifold, collide};
    use crate::math::{Pose, Rot, Vector};
    use crate::shape::{Cuboid, Hull, Shape};
    use std::sync::Arc;

    /// The distance of a point from the nearest long face of a rod; 0 on the surface.
    fn above(half: Vector, p: Vector) -> f32 {
        (p.x.abs() - half.x).max(p.y.abs() - half.y)
    }

    /// A rod along z on a rod along x, with a millimetre of overlap, inclined by 0.1 and rolled by 0.02. It
    /// lies on an edge of the other rod with its width of 6 cm, not only with one of its own edges.
    #[test]
    fn issue_a_rod_across_an_edge_stood_on_one_of_its_own_edges() {
        let half = Vector { x: 0.03, y: 0.03, z: 0.5 };
        let corner = |i: u32| {
            let sign = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
            Vector { x: sign(1), y: sign(2), z: sign(4) }.scale(half)
        };
        let corners: Vec<_> = (0..8).map(corner).collect();
        let hull = Shape::Hull(Arc::new(Hull::convex_hull_of(&corners).expect("a box is solid")));
        let rolled = Rot::from_axis_angle(Vector::Z, 0.02);
        let inclined = Rot::from_axis_angle(Vector::X, 0.1);
        let across = Rot::from_axis_angle(Vector::Y, core::f32::consts::FRAC_PI_2);
        let pose = Pose::new(Vector { x: 0.0, y: 0.062, z: 0.0 }, across.mul(inclined).mul(rolled));
        for rod in [Shape::Cuboid(Cuboid { half }), hull] {
            let mut out = LocalManifold::default();
            collide(&rod, &rod, &pose, 0.02, &mut FeatureCache::NONE.clone(), &mut out);
            assert!(out.count > 1, "{:?}", out.points());
            for p in out.points() {
                let on_a = p.point - out.normal * (0.5 * p.separation);
                let on_b = pose.inverse_transform(p.point + out.normal * (0.5 * p.separation));
                let off = above(half, on_a).abs().max(above(half, on_b).abs());
                assert!(off < 1.0e-4, "{p:?} is {off} m off a surface");
            }
        }
    }
}
