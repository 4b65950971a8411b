//! Any two polyhedra, with radii: the separating axis, then the points.
//!
//! The axis of the last step is tested first (after Gregorius, "Robust Contact Creation for Physics Simulations", GDC 2015).
//! Faces are preferred to edges unless edges are clearly better, so that the choice of points is the same from step to step.

use super::across;
use super::clip::{self, FEW_CORNERS, MAX_CORNERS, Polygon, Reference, clip};
use super::gjk;
use super::sat::{self, EdgeAxis, FaceAxis, Known};
use super::view::{MatrixPose, View, extents};
use crate::manifold::{FeatureCache, LocalManifold};
use crate::math::{Pose, Vector, clamp, max};

/// The number of faces of a triangle, which no solid has.
const TRIANGLE_FACES: usize = 2;
/// [`FeatureCache::kind`](crate::manifold::FeatureCache::kind) of a face of A.
pub(super) const FACE_A: u8 = 1;
/// [`FeatureCache::kind`](crate::manifold::FeatureCache::kind) of a face of B.
pub(super) const FACE_B: u8 = 2;
/// [`FeatureCache::kind`](crate::manifold::FeatureCache::kind) of an edge of each.
pub(super) const EDGES: u8 = 3;
/// A cached axis is kept if its separation changed by less than this share of the smaller shape's extent since the full
/// search: 5 mm for a shape of 1 m. More keeps worse axes; less searches more often.
pub(super) const CACHE_TOLERANCE: f32 = 0.005;
/// An edge axis must beat the faces by this share of the smaller shape's extent, and the faces of B
/// those of A by a tenth of it.
pub(super) const PREFER_FACES: f32 = 0.002;
/// An axis counts as exact if the nearest point is farther than its separation by at most this share of the smaller shape's
/// extent.
pub(super) const EXACT: f32 = 1.0e-3;

/// Two polyhedra and their relative pose.
struct Pair<'a> {
    a: &'a View<'a>,
    b: &'a View<'a>,
    b_in_a: MatrixPose,
    a_in_b: MatrixPose,
    prediction: f32,
    radius: f32,
    smaller: f32,
    larger: f32,
}

/// A feature that separates the pair.
#[derive(Clone, Copy)]
enum Axis {
    FaceA(FaceAxis),
    FaceB(FaceAxis),
    Edges(EdgeAxis),
}

impl Axis {
    fn separation(&self) -> f32 {
        match self {
            Self::FaceA(face) | Self::FaceB(face) => face.separation,
            Self::Edges(edges) => edges.separation,
        }
    }
}

/// A reference face, and the incident polyhedron.
struct Clipping<'a> {
    reference: &'a View<'a>,
    incident: &'a View<'a>,
    /// Transforms the incident polyhedron into the frame of the other.
    frame: &'a MatrixPose,
    /// The face of the incident polyhedron, if it has faces.
    face: Option<usize>,
    /// Whether the reference face is of B.
    of_b: bool,
}

/// The contact of two polyhedra; see the module.
pub(super) fn collide(
    a: &View,
    b: &View,
    pose: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    let pair = Pair::new(a, b, pose, prediction);
    if a.faces.is_empty() && b.faces.is_empty() {
        return pair.build_faceless(out);
    }
    if pair.try_cached(cache, out) {
        return;
    }
    out.count = 0;
    let axis = pair.search();
    let separation = axis.separation();
    *cache = remember(axis);
    // Sizes that are NaN give no axis, or one with a NaN separation.
    if !(separation <= pair.limit()) || separation == f32::NEG_INFINITY {
        out.gap = max(separation - pair.radius, 0.0);
        return;
    }
    let exact = pair.build(axis, out);
    if separation > gjk::resolution(pair.larger, pair.smaller) {
        if !exact {
            pair.build_apart(separation, out);
        }
    } else if out.count == 0 {
        pair.push_deepest(axis, out);
    }
}

/// One point between the closest features of two separated polyhedra, where the axis understates the distance. Keeps present
/// points if the distance is no larger.
pub(super) fn collide_apart(
    a: &View,
    b: &View,
    pose: &Pose,
    separation: f32,
    prediction: f32,
    out: &mut LocalManifold,
) {
    Pair::new(a, b, pose, prediction).build_apart(separation, out);
}

/// The cache for the next step. Features with an index above a byte are not cached.
fn remember(axis: Axis) -> FeatureCache {
    let separation = axis.separation();
    let (kind, a, b) = match axis {
        Axis::FaceA(f) => (FACE_A, f.face, 0),
        Axis::FaceB(f) => (FACE_B, 0, f.face),
        Axis::Edges(e) => (EDGES, e.a, e.b),
    };
    match (u8::try_from(a), u8::try_from(b)) {
        (Ok(a), Ok(b)) => FeatureCache { kind, a, b, separation },
        _ => FeatureCache::NONE,
    }
}

impl<'a> Pair<'a> {
    fn new(a: &'a View<'a>, b: &'a View<'a>, pose: &Pose, prediction: f32) -> Self {
        let b_in_a = MatrixPose::new(pose);
        let (larger, smaller) = extents(a, b);
        let radius = a.radius + b.radius;
        Self { a, b, b_in_a, a_in_b: b_in_a.inverse(), prediction, radius, smaller, larger }
    }

    /// Cores farther apart than this have no contact.
    fn limit(&self) -> f32 {
        self.prediction + self.radius
    }

    /// Whether the cached axis decides the contact.
    fn try_cached(&self, cache: &FeatureCache, out: &mut LocalManifold) -> bool {
        let (i, j) = (cache.a as usize, cache.b as usize);
        let axis = match cache.kind {
            FACE_A if i < self.a.faces.len() => {
                Axis::FaceA(sat::face_separation(self.a, i, self.b, &self.b_in_a))
            }
            FACE_B if j < self.b.faces.len() => {
                Axis::FaceB(sat::face_separation(self.b, j, self.a, &self.a_in_b))
            }
            EDGES if i < self.a.edges.len() && j < self.b.edges.len() => {
                let Some(edges) = sat::edge_separation(self.a, i, self.b, j, &self.b_in_a) else {
                    return false;
                };
                Axis::Edges(edges)
            }
            _ => return false,
        };
        let separation = axis.separation();
        if separation > self.limit() {
            out.gap = separation - self.radius;
            return true;
        }
        if !((separation - cache.separation).abs() < CACHE_TOLERANCE * self.smaller) {
            return false;
        }
        let exact = self.build(axis, out);
        exact || (out.count > 0 && separation <= gjk::resolution(self.larger, self.smaller))
    }

    /// The axis of least penetration or largest separation, or the first beyond the limit.
    fn search(&self) -> Axis {
        let of_a = sat::best_face(self.a, self.b, &self.b_in_a, self.limit());
        if of_a.separation > self.limit() {
            return Axis::FaceA(of_a);
        }
        let of_b = sat::best_face(self.b, self.a, &self.a_in_b, self.limit());
        if of_b.separation > self.limit() {
            return Axis::FaceB(of_b);
        }
        let preference = PREFER_FACES * self.smaller;
        let face = if of_b.separation > of_a.separation + 0.1 * preference {
            Axis::FaceB(of_b)
        } else {
            Axis::FaceA(of_a)
        };
        let known = Known {
            of_b_in_a: self.b_in_a.point(self.b.vertices[of_a.lowest]),
            of_a_in_b: self.a_in_b.point(self.a.vertices[of_b.lowest]),
            separation: face.separation() + preference,
        };
        sat::best_edges(self.a, self.b, &self.b_in_a, &known, self.limit()).map_or(face, Axis::Edges)
    }

    /// Fills the manifold from an axis. Returns whether its nearest point is as near as the separation along the axis, which is
    /// then the true distance.
    fn build(&self, axis: Axis, out: &mut LocalManifold) -> bool {
        match axis {
            Axis::FaceA(face) => self.build_face(&face, false, out),
            Axis::FaceB(face) => self.build_face(&face, true, out),
            Axis::Edges(edges) => self.build_edges(&edges, out),
        }
    }

    fn build_face(&self, axis: &FaceAxis, of_b: bool, out: &mut LocalManifold) -> bool {
        let (reference, incident, frame) =
            if of_b { (self.b, self.a, &self.a_in_b) } else { (self.a, self.b, &self.b_in_a) };
        let local = frame.direction_in(reference.faces[axis.face].normal);
        let clipping = Clipping {
            reference,
            incident,
            frame,
            face: clip::incident_face(incident, local, axis.lowest),
            of_b,
        };
        if clip::most_corners(reference, axis.face, incident, clipping.face) < FEW_CORNERS {
            self.clip_face::<FEW_CORNERS>(axis, &clipping, out)
        } else {
            self.clip_face::<MAX_CORNERS>(axis, &clipping, out)
        }
    }

    #[inline(never)]
    fn clip_face<const N: usize>(
        &self,
        axis: &FaceAxis,
        clipping: &Clipping,
        out: &mut LocalManifold,
    ) -> bool {
        let &Clipping { reference, incident, frame, face, of_b } = clipping;
        let normal = reference.faces[axis.face].normal;
        let (mut polygon, mut spare) = (Polygon::<N>::new(), Polygon::<N>::new());
        clip::incident_polygon(incident, face, |v| (frame.point(v), ()), &mut polygon);
        let outline = reference.outline(axis.face).iter().map(|i| reference.vertices[*i as usize]);
        let polygon = clip(normal, outline, [&mut polygon, &mut spare], self.smaller);
        out.normal = if of_b { -self.b_in_a.direction(normal) } else { normal };
        let reference = self.reference(axis, of_b);
        let least = reference.fill(polygon, |corner| reference.height(corner.point), out);
        least <= axis.separation + EXACT * self.smaller
    }

    /// The face of an axis.
    #[inline(always)]
    fn reference(&self, axis: &FaceAxis, of_b: bool) -> Reference<'_> {
        let (reference, incident) = if of_b { (self.b, self.a) } else { (self.a, self.b) };
        let plane = &reference.faces[axis.face];
        Reference {
            normal: plane.normal,
            offset: plane.offset,
            radii: [reference.radius, incident.radius],
            prediction: self.prediction,
            to_a: of_b.then_some(&self.b_in_a),
            feature: Reference::feature_of(of_b, axis.face),
        }
    }

    /// Adds the deepest vertex under a face alone, where the shapes overlap beside the face. Only for the best of all
    /// axes: under the cached face of an earlier step there may be nothing left.
    fn push_deepest(&self, axis: Axis, out: &mut LocalManifold) {
        let (axis, of_b) = match axis {
            Axis::FaceA(face) => (face, false),
            Axis::FaceB(face) => (face, true),
            Axis::Edges(_) => return,
        };
        let (incident, frame) = if of_b { (self.a, &self.a_in_b) } else { (self.b, &self.b_in_a) };
        let corner = frame.point(incident.vertices[axis.lowest]);
        self.reference(&axis, of_b).push_deepest(corner, axis.separation, out);
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
        if axis.separation - self.radius <= self.prediction {
            out.push(between, axis.separation - self.radius, feature);
            self.push_far_ends(axis, [ends_a, ends_b], out);
        }
        inside
    }

    /// Adds the other ends of the lines along which the edges pass over each other's faces, where these are near.
    fn push_far_ends(&self, axis: &EdgeAxis, [ends_a, ends_b]: [[Vector; 2]; 2], out: &mut LocalManifold) {
        // The edges of a triangle may be inside a surface, which looks at each facet's points.
        if self.a.faces.len() == TRIANGLE_FACES || self.b.faces.len() == TRIANGLE_FACES {
            return;
        }
        let normal = axis.normal;
        let mut push = |on_a: Vector, on_b: Vector, gap: f32, feature: u32| {
            if gap > axis.separation && gap - self.radius <= self.prediction {
                let point = (on_a + normal * self.a.radius + on_b - normal * self.b.radius) * 0.5;
                out.push(point, gap - self.radius, 7 << 29 | feature);
            }
        };
        if let Some((on_b, gap)) = across::far_end(self.a, &self.a.edges[axis.a], ends_b, normal) {
            push(on_b - normal * gap, on_b, gap, axis.b as u32 & 0x7fff);
        }
        let ends_a = ends_a.map(|end| self.a_in_b.point(end));
        let out_of_b = self.b_in_a.direction_in(-normal);
        if let Some((on_a, gap)) = across::far_end(self.b, &self.b.edges[axis.b], ends_a, out_of_b) {
            let on_a = self.b_in_a.point(on_a);
            push(on_a, on_a + normal * gap, gap, 1 << 28 | axis.a as u32 & 0x7fff);
        }
    }

    /// Two cores without faces: a triangle without area is a segment or a point.
    fn build_faceless(&self, out: &mut LocalManifold) {
        out.count = 0;
        match gjk::closest(self.a, self.b, &self.b_in_a) {
            Some(closest) => closest.fill_apart(self.radii(), f32::NEG_INFINITY, self.prediction, out),
            None => {
                out.normal = Vector::Y;
                out.push(self.a.center, -self.radius, 3 << 30);
            }
        }
    }

    /// See [`collide_apart`].
    fn build_apart(&self, separation: f32, out: &mut LocalManifold) {
        if let Some(closest) = gjk::closest(self.a, self.b, &self.b_in_a) {
            closest.fill_apart(self.radii(), separation, self.prediction, out);
        }
    }

    fn radii(&self) -> [f32; 2] {
        [self.a.radius, self.b.radius]
    }
}

/// The closest points of two lines that are not parallel, clamped to the segments given by their ends, and whether they were
/// inside of these.
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
    let inside = max(max(-s, s - 1.0), max(-t, t - 1.0)) < EXACT;
    (a[0] + u * clamp(s, 0.0, 1.0), b[0] + v * clamp(t, 0.0, 1.0), inside)
}
