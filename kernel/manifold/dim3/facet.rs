//! The triangles of a surface: their borders, and their contacts with one convex shape, whose view is built
//! once for all triangles.
//!
//! Against polyhedra the axis is selected as in [`axis`]. Triangles add three properties: a single plane,
//! arcs of 180° on the Gauss map, and often a proof that the face is the best axis, which saves the search
//! for others. Everything is in the polyhedron's frame.

use super::axis::{self, Axis, EdgeAxis, FaceAxis, Pair as _, Sizes, face_under, open_edges, remaining};
use super::clip::{
    self, Candidates, Corner, FEW_CORNERS, LEAST_CORNERS, MAX_CANDIDATES, MAX_CORNERS, Polygon, Reference,
    keep,
};
use super::convex::closest_of_lines;
use super::curved;
use super::gjk::{self, Core};
use super::view::{Facing, MatrixPose, Small, View, four, with_view};
use crate::manifold::border::{Border, is_beside};
use crate::manifold::pairs::{collide_pair, drop_unusable, is_near};
use crate::manifold::{LocalManifold, LocalPoint, PairInput};
use crate::math::{F32x4, Lane, Num, Vector, max, min};
use crate::shape::{Shape, Triangle};
use crate::tuning::manifold::{MARGIN, PARALLEL, REACH};

/// The unit normal of a triangle, counter-clockwise from outside; `None` if it has no area.
pub(in crate::manifold) fn face_normal([a, b, c]: [Vector; 3]) -> Option<Vector> {
    Facing::of([b - a, c - b, a - c]).map(|facing| facing.normal)
}

/// Vectors across four triangles, of any length; 0 without area.
#[inline(always)]
pub(in crate::manifold) fn facing([a, b, c]: &[Vector<F32x4>; 3]) -> Vector<F32x4> {
    (*b - *a).cross(*c - *a)
}

/// The sides of a triangle with the given normal.
pub(in crate::manifold) fn borders(corners: [Vector; 3], normal: Vector) -> [Border; 3] {
    core::array::from_fn(|k| {
        let corner = corners[k];
        let side = corners[(k + 1) % 3] - corner;
        let along = side * (1.0 / max(side.length(), f32::MIN_POSITIVE));
        let outward = along.cross(normal);
        Border { corner, along, outward, depth: (corner - corners[(k + 2) % 3]).dot(outward) }
    })
}

/// A convex shape to collide with several facets in sequence.
pub(in crate::manifold) struct Convex<'a> {
    pub shape: &'a Shape,
    /// The polyhedral core; none for balls, whose contacts have closed forms.
    core: Option<&'a View<'a>>,
}

/// Calls `f` with a shape to collide with facets.
pub(in crate::manifold) fn with_convex<R>(shape: &Shape, f: impl FnOnce(&Convex) -> R) -> R {
    match shape {
        Shape::Ball(_) => f(&Convex::of(shape)),
        _ => with_view(shape, |core| f(&Convex { shape, core })),
    }
}

impl<'a> Convex<'a> {
    /// A shape to collide with few facets or none.
    pub fn of(shape: &'a Shape) -> Self {
        Self { shape, core: None }
    }

    /// Fills `out` with the contact of a single triangle; see [`collide_pair`].
    pub fn collide_facet(&self, corners: [Vector; 3], input: PairInput, out: &mut LocalManifold) {
        if let Some(core) = self.core
            && is_near(input.pose)
            && collide_polyhedron(corners, core, input, out)
        {
            out.radii = [0.0, core.radius];
            return drop_unusable(out);
        }
        let [a, b, c] = corners;
        let facet = Shape::Triangle(Triangle { a, b, c });
        collide_pair(&facet, self.shape, input, out);
    }

    /// Fills `out` with the contact of a triangle's face alone, where the shape is over it. `normal` is the
    /// face's, towards the shape.
    pub fn collide_face(
        &self,
        corners: [Vector; 3],
        normal: Vector,
        input: PairInput,
        out: &mut LocalManifold,
    ) {
        if let Some(core) = self.core {
            return collide_polyhedron_face(corners, normal, core, input, out);
        }
        (out.count, out.gap) = (0, 0.0);
        if let Shape::Curved(other) = self.shape {
            let small = Small::triangle(corners);
            return curved::collide_face(&small.view(), normal, other, input, out);
        }
        let PairInput { pose, prediction, .. } = input;
        let Some(lowest) = self.shape.support(pose.rotation.inverse_rotate(-normal)) else { return };
        let lowest = pose.transform(lowest);
        let separation = (lowest - corners[0]).dot(normal);
        if separation <= prediction
            && !face_normal(corners).is_some_and(|face| is_beside(&borders(corners, face), lowest))
        {
            out.normal = normal;
            out.push(lowest - normal * (0.5 * separation), separation, 0);
        } else {
            out.gap = max(separation, 0.0);
        }
    }
}

/// Reduces `points` to a few points with the same support, and stores them in a manifold.
pub(in crate::manifold) fn few_points(points: &[LocalPoint], out: &mut LocalManifold) {
    let mut candidates = Candidates::<MAX_CANDIDATES>::new();
    points.iter().for_each(|p| candidates.push(*p));
    keep::<true>(candidates.as_slice(), out);
}

/// The cosine and sine of the angle beyond which [`REACH`] gives no bound: 2 atan(1 / REACH).
const STEEP: [f32; 2] = [(REACH * REACH - 1.0) / (REACH * REACH + 1.0), 2.0 * REACH / (REACH * REACH + 1.0)];

/// A triangle and the polyhedron, in the frame of the polyhedron.
struct Pair<'a> {
    /// The corners in the triangle's own frame, and here.
    given: [Vector; 3],
    corners: [Vector; 3],
    /// Unit directions of the sides, each from its corner to the next.
    along: [Vector; 3],
    /// The triangle's unit normal in its own frame, and here.
    face: Vector,
    normal: Vector,
    prism: Prism,
    view: &'a View<'a>,
    /// Transforms the polyhedron to the frame of the triangle.
    frame: MatrixPose,
    sizes: Sizes,
    /// The side of the face that the polyhedron is on; set by [`collide_polyhedron`], before any
    /// axis is searched.
    nearest: FaceAxis,
    /// The sides that may make an axis, as bits.
    open: u32,
}

/// The outward planes through the sides across the face, and the face's plane.
struct Prism {
    normals: Vector<F32x4>,
    offsets: F32x4,
}

/// The lane of the face's plane in a prism.
const FACE: usize = 3;
/// The lanes of the sides, as bits.
const SIDES: u32 = 0b111;

impl Prism {
    /// The heights of a point over all planes.
    #[inline(always)]
    fn heights(&self, point: Vector) -> F32x4 {
        self.normals.dot(Vector::splat(point)) - self.offsets
    }
}

/// 1 for the triangle's face, −1 for its back, which is face 1.
#[inline(always)]
fn sign_of(plane: &FaceAxis) -> f32 {
    if plane.face == 0 { 1.0 } else { -1.0 }
}

impl Core for [Vector; 3] {
    #[inline]
    fn farthest_point(&self, direction: Vector) -> (Vector, u32) {
        let heights = self.map(|corner| corner.dot(direction));
        let i = greatest(heights);
        (self[i], i as u32)
    }

    fn center(&self) -> Vector {
        (self[0] + self[1] + self[2]) * (1.0 / 3.0)
    }
}

/// The index of the largest number, the lowest index among equals.
#[inline(always)]
fn greatest(of: [f32; 3]) -> usize {
    let first = if of[1] > of[0] { 1 } else { 0 };
    if of[2] > of[first] { 2 } else { first }
}

/// Fills `out` with the contact of a triangle and a polyhedron, in the triangle's frame; see
/// [`convex::collide`](super::convex::collide). Returns `false` for a triangle without area.
fn collide_polyhedron(corners: [Vector; 3], view: &View, input: PairInput, out: &mut LocalManifold) -> bool {
    (out.count, out.gap) = (0, 0.0);
    let Some(mut pair) = Pair::new(corners, view, input) else { return false };
    pair.nearest = pair.nearest_plane();
    if pair.nearest.separation > pair.sizes.limit() {
        out.gap = max(pair.nearest.separation - view.radius, 0.0);
        return true;
    }
    pair.open = pair.open_sides(&pair.nearest);
    if pair.open == 0 {
        pair.build_plane(&pair.nearest, out);
    } else {
        pair.collide(input.cache, out);
    }
    true
}

/// Fills `out` with the contact of a triangle's face alone, whatever the best axis is. `normal` is the
/// face's, towards the polyhedron.
fn collide_polyhedron_face(
    corners: [Vector; 3],
    normal: Vector,
    view: &View,
    input: PairInput,
    out: &mut LocalManifold,
) {
    (out.count, out.gap) = (0, 0.0);
    let Some(pair) = Pair::new(corners, view, input) else { return };
    let plane = pair.plane(usize::from(pair.face.dot(normal) < 0.0));
    if plane.separation <= pair.sizes.limit() {
        pair.build_plane(&plane, out);
    } else {
        out.gap = plane.separation - view.radius;
    }
}

impl axis::Pair for Pair<'_> {
    #[inline(always)]
    fn sizes(&self) -> &Sizes {
        &self.sizes
    }

    #[inline(always)]
    fn best_face(&self, of_b: bool) -> FaceAxis {
        if of_b {
            return self.best_face_of_view();
        }
        let nearest = self.nearest;
        if !(nearest.separation < 0.0) {
            return nearest;
        }
        let back = self.plane(1 - nearest.face);
        if back.separation > nearest.separation { back } else { nearest }
    }

    /// See [`axis::best_edges`]; the arc of a side goes from the face's normal to its reverse.
    fn best_edges(&self, _: &FaceAxis, of_b: &FaceAxis, known: f32) -> Option<EdgeAxis> {
        let (corner, depth) = (self.corners[of_b.lowest], min(known, 0.0));
        let mut best = known;
        let mut found = None;
        let normal = Vector::<F32x4>::splat(self.normal);
        for (j, block) in self.view.edge_blocks.iter().enumerate() {
            if open_edges(block, corner, depth) == 0 {
                continue;
            }
            let turn = normal.dot(block.direction);
            for side in (0..FACE).filter(|side| self.open >> side & 1 != 0) {
                let along = Vector::<F32x4>::splat(self.along[side]);
                let (left, right) = (block.left.dot(along), block.right.dot(along));
                let crosses =
                    F32x4::and((left * right).le(F32x4::ZERO), F32x4::ZERO.lt(turn * (left - right)));
                if !F32x4::any(crosses) {
                    continue;
                }
                let axis = along.cross(block.direction);
                let square = axis.length_squared();
                let usable = F32x4::and(crosses, F32x4::splat(PARALLEL * PARALLEL).lt(square));
                let height = axis.dot(block.tail - Vector::splat(self.corners[side])) / square.sqrt();
                let separation = F32x4::select(F32x4::ZERO.lt(turn), height, -height);
                let better = F32x4::and(usable, F32x4::splat(best).lt(separation));
                let mut left = F32x4::bits(better) & (0xf >> (4 - remaining(self.view, j)));
                while left != 0 {
                    let lane = left.trailing_zeros() as usize;
                    left &= left - 1;
                    if separation.get(lane) > best {
                        best = separation.get(lane);
                        found = Some((side, 4 * j + lane, turn.get(lane) > 0.0));
                    }
                }
            }
        }
        let (side, edge, is_forward) = found?;
        let axis = self.along[side].cross(self.view.edge_blocks[edge / 4].direction.get(edge % 4));
        let sign = if is_forward { 1.0 } else { -1.0 };
        Some(EdgeAxis { a: side, b: edge, normal: axis * (sign / axis.length()), separation: best })
    }

    fn build_face(&self, face: &FaceAxis, out: &mut LocalManifold) -> bool {
        if !face.of_b {
            self.build_plane(face, out)
        } else if self.view.corners_of(Some(face.face)) + 3 < FEW_CORNERS {
            self.clip_triangle::<FEW_CORNERS>(face, out)
        } else {
            self.clip_triangle::<MAX_CORNERS>(face, out)
        }
    }

    fn build_edges(&self, axis: &EdgeAxis, out: &mut LocalManifold) -> bool {
        let (view, &EdgeAxis { a: side, b: edge, normal, separation }) = (self.view, axis);
        let ends = [self.corners[side], self.corners[(side + 1) % 3]];
        let ends_of = [view.edges[edge].tail, view.edges[edge].head].map(|i| view.vertices[i as usize]);
        let (point, point_of, is_inside) = closest_of_lines(ends, ends_of);
        let separation = separation - view.radius;
        (out.count, out.normal) = (0, self.frame.direction(normal));
        if separation <= self.sizes.prediction {
            let between = (point + point_of - normal * view.radius) * 0.5;
            let feature = 2 << 30 | (side as u32) << 15 | edge as u32 & 0x7fff;
            out.push(self.frame.point(between), separation, feature);
        }
        is_inside
    }

    fn build_apart(&self, axis: &Axis, out: &mut LocalManifold) {
        let start = match axis {
            Axis::Face(plane) if !plane.of_b => self.face * sign_of(plane),
            Axis::Face(face) => -self.frame.direction(self.view.faces[face.face].normal),
            Axis::Edges(edges) => self.frame.direction(edges.normal),
        };
        let limit = self.sizes.limit();
        let Some(closest) = gjk::closest_within(&self.given, self.view, &self.frame, start, limit) else {
            return;
        };
        closest.fill_apart([0.0, self.view.radius], axis.separation(), self.sizes.prediction, out);
        if out.count == 0 {
            out.gap = max(closest.distance - self.view.radius, 0.0);
        }
    }

    fn push_deepest(&self, axis: &FaceAxis, out: &mut LocalManifold) {
        let (reference, lowest) = if axis.of_b {
            (self.reference_of(axis.face), self.corners[axis.lowest])
        } else {
            (self.reference(axis), self.view.vertices[axis.lowest])
        };
        reference.push_deepest(lowest, axis.separation, out);
    }
}

impl<'a> Pair<'a> {
    /// `None` for a triangle without area.
    #[inline(always)]
    fn new(corners: [Vector; 3], view: &'a View<'a>, input: PairInput) -> Option<Self> {
        let given = corners;
        let [a, b, c] = corners;
        let sides = [b - a, c - b, a - c];
        let Facing { normal: face, scale } = Facing::of(sides)?;
        let frame = MatrixPose::new(input.pose);
        // Corners are taken relative to the polyhedron first, so that rounding is small for near triangles.
        let [a, b, c] = corners.map(|corner| corner - frame.position);
        let placed = frame.direction_in(four([a, b, c, c]));
        let turned = frame.direction_in(four([sides[0], sides[1], sides[2], face]));
        let sides = Vector { x: turned.x, y: turned.y, z: turned.z } * F32x4::splat(scale);
        let along = sides * (F32x4::ONE / sides.length().max(F32x4::splat(f32::MIN_POSITIVE)));
        let normal = turned.get(3);
        let wide = Vector::<F32x4>::splat(normal);
        let is_face = F32x4::ZERO.lt(F32x4::new([0.0, 0.0, 0.0, 1.0]));
        let normals = Vector::select(is_face, wide, along.cross(wide));
        let prism = Prism { normals, offsets: normals.dot(placed) };
        let center = placed.get(0) + placed.get(1) + placed.get(2);
        let arm = placed - Vector::splat(center * (1.0 / 3.0));
        let arms = arm.length_squared();
        let extent = max(max(arms.get(0), arms.get(1)), arms.get(2)).sqrt();
        Some(Self {
            given,
            corners: [placed.get(0), placed.get(1), placed.get(2)],
            along: [along.get(0), along.get(1), along.get(2)],
            face,
            normal,
            prism,
            view,
            frame,
            sizes: Sizes::new(input.prediction, view.radius, [extent, view.extent]),
            nearest: FaceAxis { face: 0, of_b: false, separation: f32::NEG_INFINITY, lowest: 0 },
            open: SIDES,
        })
    }

    /// The face, or its back.
    #[inline(always)]
    fn plane(&self, face: usize) -> FaceAxis {
        let sign = if face == 0 { 1.0 } else { -1.0 };
        let (lowest, depth) = self.view.farthest(self.normal * -sign);
        let separation = -depth - sign * self.normal.dot(self.corners[0]);
        FaceAxis { face, of_b: false, separation, lowest }
    }

    /// The side of the face that the polyhedron's centre is on.
    #[inline(always)]
    fn nearest_plane(&self) -> FaceAxis {
        let height = self.normal.dot(self.view.center - self.corners[0]);
        self.plane(usize::from(height < 0.0))
    }

    /// The polyhedron's face with the largest separation.
    fn best_face_of_view(&self) -> FaceAxis {
        if self.view.faces.is_empty() {
            return FaceAxis { face: 0, of_b: true, separation: f32::NEG_INFINITY, lowest: 0 };
        }
        let (face, separation) = face_under(self.view, self.corners);
        let normal = self.view.faces[face].normal;
        let lowest = greatest(self.corners.map(|corner| -corner.dot(normal)));
        FaceAxis { face, of_b: true, separation, lowest }
    }

    /// The sides, as bits, that may have an axis which separates more than the plane. Without any, the plane
    /// is the best axis: the lowest vertex v is over the triangle.
    ///
    /// Let s be the separation along the plane's normal n, and ρ how far v is inside of a side, whose outward
    /// normal is u. An axis m = n cos θ + u sin θ of the side separates by at most s cos θ − ρ sin θ, since v
    /// is no farther. This is at most s if s ≥ 0, and if s < 0 for tan(θ/2) ≤ ρ/|s|. The remaining axes lie
    /// around −n, where the polyhedron's centre is deeper. If this holds for all sides, it holds for any
    /// axis: the triangle reaches at least the least ρ around v's foot.
    #[inline(always)]
    fn open_sides(&self, plane: &FaceAxis) -> u32 {
        let vertex = self.view.vertices[plane.lowest];
        let depth = max(-plane.separation, 0.0);
        let reach = -self.prism.heights(vertex);
        let open = !F32x4::bits(F32x4::splat(REACH * depth).le(reach)) & SIDES;
        if depth == 0.0 {
            return open;
        }
        let arm = self.view.center - vertex;
        let rise = arm.dot(self.normal) * sign_of(plane);
        let aside = max(arm.length_squared() - rise * rise, 0.0).sqrt();
        let [cos, sin] = STEEP;
        if cos * (rise - depth) - sin * aside >= depth { open } else { SIDES }
    }

    /// The face as the reference of a contact.
    #[inline(always)]
    fn reference(&self, plane: &FaceAxis) -> Reference<'_> {
        let normal = self.normal * sign_of(plane);
        Reference {
            normal,
            offset: normal.dot(self.corners[0]),
            radii: [0.0, self.view.radius],
            prediction: self.sizes.prediction,
            to_a: Some(&self.frame),
            feature: Reference::feature_of(false, plane.face),
        }
    }

    /// A face of the polyhedron as the reference of a contact.
    #[inline(always)]
    fn reference_of(&self, face: usize) -> Reference<'_> {
        let reference = Reference::of_face(self.view, face, true, 0.0, self.sizes.prediction);
        Reference { to_a: Some(&self.frame), ..reference }
    }

    fn build_plane(&self, plane: &FaceAxis, out: &mut LocalManifold) -> bool {
        let view = self.view;
        let incident = clip::incident_face(view, self.normal * sign_of(plane), plane.lowest);
        let most = 3 + view.corners_of(incident);
        if most < LEAST_CORNERS {
            self.clip_face::<LEAST_CORNERS>(plane, incident, out)
        } else if most < FEW_CORNERS {
            self.clip_face::<FEW_CORNERS>(plane, incident, out)
        } else {
            self.clip_face::<MAX_CORNERS>(plane, incident, out)
        }
    }

    /// The polyhedron's face over the triangle.
    #[inline(never)]
    fn clip_face<const N: usize>(
        &self,
        plane: &FaceAxis,
        incident: Option<usize>,
        out: &mut LocalManifold,
    ) -> bool {
        let mut first = Polygon::<N, F32x4>::new();
        let margin = MARGIN * self.sizes.smaller;
        let margins = F32x4::new([margin, margin, margin, 0.0]);
        let place = |v| (v, self.prism.heights(v) - margins);
        clip::incident_polygon(self.view, incident, place, &mut first);
        let start = (F32x4::ZERO, F32x4::splat(f32::INFINITY));
        let (highest, lowest) = first
            .corners()
            .iter()
            .fold(start, |(high, low), corner| (high.max(corner.heights), low.min(corner.heights)));
        let outside = F32x4::bits(F32x4::ZERO.lt(highest));
        if F32x4::bits(F32x4::ZERO.lt(lowest)) & SIDES != 0 {
            // The whole polygon is beyond one side.
            (out.count, out.normal) = (0, self.face * sign_of(plane));
            return false;
        }
        let least = if outside & SIDES == 0 {
            self.fill(&first, plane, out)
        } else {
            let mut second = Polygon::<N, F32x4>::new();
            let (mut polygon, mut spare) = (&mut first, &mut second);
            for side in (0..FACE).filter(|side| outside >> side & 1 != 0) {
                clip::cut(polygon, |_, corner| corner.heights.get(side), side as u32, spare);
                core::mem::swap(&mut polygon, &mut spare);
            }
            self.fill(polygon, plane, out)
        };
        least <= plane.separation + MARGIN * self.sizes.smaller
    }

    /// Fills the manifold with the corners of a clipped polygon. Returns their least height over the face.
    fn fill<const N: usize>(
        &self,
        polygon: &Polygon<N, F32x4>,
        plane: &FaceAxis,
        out: &mut LocalManifold,
    ) -> f32 {
        out.normal = self.face * sign_of(plane);
        let height = |corner: &Corner<F32x4>| corner.heights.get(FACE) * sign_of(plane);
        self.reference(plane).fill(polygon, height, out)
    }

    /// The triangle over a face of the polyhedron.
    #[inline(never)]
    fn clip_triangle<const N: usize>(&self, axis: &FaceAxis, out: &mut LocalManifold) -> bool {
        let mut polygon = Polygon::<N>::new();
        (0..3).for_each(|i| polygon.push(i, self.corners[i as usize], ()));
        let reference = self.reference_of(axis.face);
        out.normal = -self.frame.direction(reference.normal);
        reference.fill_clipped(self.view, axis, &mut polygon, self.sizes.smaller, out)
    }
}
