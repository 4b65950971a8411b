//! The separating axis of two polyhedra: the choice of the axis that the manifold is built from, common to
//! all polyhedral pairs ([`Pair`]), and the search over the faces and edges of hulls.
//!
//! Candidates are the normals of faces, and the cross products of edges that pass the Gauss map test. The
//! axis of the last step is tested first (after Gregorius, "Robust Contact Creation for Physics Simulations",
//! GDC 2015). Faces are preferred to edges unless edges are clearly better, so that the choice of points is
//! the same from step to step.
//!
//! One point rules out most axes. The height of any point of B over a face of A is an upper bound of the
//! face's separation. An outward axis n of an edge of A is a positive combination of the normals of the two
//! faces beside it. If a point of B is deeper than S < 0 under both planes, it is also deeper than S along
//! every axis n of this kind, since |n| is at most the sum of its parts. The point is the vertex of B that is
//! lowest over the best face, since shapes touch near there. Two hulls with 12 vertices have 40 faces and 900
//! pairs of edges: about nine faces and a tenth of the pairs remain.

use super::view::{MatrixPose, View};
use crate::manifold::{FeatureCache, LocalManifold};
use crate::math::{F32x4, Lane, Num, Vector, max, min};
use crate::shape::{EdgeBlock, largest};
use crate::tuning::manifold::{KEPT, MARGIN, PARALLEL};
use core::cell::Cell;

/// [`FeatureCache::kind`] of a face of A.
pub(super) const FACE_A: u8 = 1;
/// [`FeatureCache::kind`] of a face of B.
pub(super) const FACE_B: u8 = 2;
/// [`FeatureCache::kind`] of an edge of each.
pub(super) const EDGES: u8 = 3;

/// A face of one polyhedron with its separation.
#[derive(Clone, Copy)]
pub(super) struct FaceAxis {
    pub face: usize,
    /// Whether the face is B's.
    pub of_b: bool,
    /// The signed distance of the other polyhedron from the face's plane.
    pub separation: f32,
    /// The vertex of the other polyhedron at that distance.
    pub lowest: usize,
}

/// A pair of edges with its separation.
#[derive(Clone, Copy)]
pub(super) struct EdgeAxis {
    pub a: usize,
    pub b: usize,
    /// The unit normal from A to B, in the frame of the search.
    pub normal: Vector,
    pub separation: f32,
}

/// A feature that separates the pair.
#[derive(Clone, Copy)]
pub(super) enum Axis {
    Face(FaceAxis),
    Edges(EdgeAxis),
}

impl Axis {
    #[inline(always)]
    pub fn separation(&self) -> f32 {
        match self {
            Self::Face(face) => face.separation,
            Self::Edges(edges) => edges.separation,
        }
    }

    /// The cache for the next step. Features with an index above a byte are not cached.
    #[inline(always)]
    pub fn cache(&self) -> FeatureCache {
        let (kind, a, b) = match self {
            Self::Face(f) if f.of_b => (FACE_B, 0, f.face),
            Self::Face(f) => (FACE_A, f.face, 0),
            Self::Edges(e) => (EDGES, e.a, e.b),
        };
        match (u8::try_from(a), u8::try_from(b)) {
            (Ok(a), Ok(b)) => FeatureCache { kind, a, b, separation: self.separation() },
            _ => FeatureCache::NONE,
        }
    }
}

/// The lengths of a pair, in metres.
#[derive(Clone, Copy)]
pub(super) struct Sizes {
    pub prediction: f32,
    /// The sum of the radii around both cores.
    pub radius: f32,
    /// The smaller and the larger extent of both shapes.
    pub smaller: f32,
    pub larger: f32,
}

impl Sizes {
    /// Of a pair with these extents. `radius` is the sum of the radii around both cores.
    #[inline(always)]
    pub fn new(prediction: f32, radius: f32, [a, b]: [f32; 2]) -> Self {
        Self { prediction, radius, smaller: min(a, b), larger: max(a, b) }
    }

    /// Cores farther apart than this have no contact.
    #[inline(always)]
    pub fn limit(&self) -> f32 {
        self.prediction + self.radius
    }

    /// The distance below which the closest points have no direction. Below it, separating axes are used.
    #[inline(always)]
    pub fn resolution(&self) -> f32 {
        max(1.0e-3 * self.smaller, 1.0e-5 * self.larger)
    }
}

/// Two polyhedra with radii.
pub(super) trait Pair {
    fn sizes(&self) -> &Sizes;

    /// The cached axis with its present separation; `None` for pairs that keep no cache.
    #[inline(always)]
    fn cached(&self, _: FeatureCache) -> Option<Axis> {
        None
    }

    /// The face of A, or of B, with the largest separation.
    fn best_face(&self, of_b: bool) -> FaceAxis;

    /// The pair of edges with the largest separation, if it is larger than `known`. The best faces of A and B
    /// locate the near features.
    fn best_edges(&self, of_a: &FaceAxis, of_b: &FaceAxis, known: f32) -> Option<EdgeAxis>;

    /// Fills the manifold from an axis. Returns whether its nearest point is as near as the separation along
    /// the axis, which is then the true distance.
    #[inline(always)]
    fn build(&self, axis: &Axis, out: &mut LocalManifold) -> bool {
        match axis {
            Axis::Face(face) => self.build_face(face, out),
            Axis::Edges(edges) => self.build_edges(edges, out),
        }
    }

    /// See [`build`](Self::build).
    fn build_face(&self, axis: &FaceAxis, out: &mut LocalManifold) -> bool;

    /// See [`build`](Self::build).
    fn build_edges(&self, axis: &EdgeAxis, out: &mut LocalManifold) -> bool;

    /// Fills the manifold with one point between the closest features, where the axis understates the
    /// distance. Keeps present points if the distance is no larger.
    fn build_apart(&self, axis: &Axis, out: &mut LocalManifold);

    /// Adds the deepest vertex under a face alone, where the shapes overlap beside the face. Only for the
    /// best of all axes: an earlier step's face may have no vertex under it any more.
    fn push_deepest(&self, axis: &FaceAxis, out: &mut LocalManifold);

    /// Fills the manifold from the cached axis if it still decides the contact, otherwise from the best axis.
    #[inline(always)]
    fn collide(&self, cache: &Cell<FeatureCache>, out: &mut LocalManifold) {
        let known = cache.get();
        if self.cached(known).is_some_and(|axis| self.try_known(&axis, known.separation, out)) {
            return;
        }
        let axis = self.search();
        cache.set(axis.cache());
        self.decide(&axis, out);
    }

    /// Whether an axis that separated by `before` metres when it was found still decides the contact.
    #[inline(always)]
    fn try_known(&self, axis: &Axis, before: f32, out: &mut LocalManifold) -> bool {
        let (sizes, separation) = (self.sizes(), axis.separation());
        if separation > sizes.limit() {
            out.gap = separation - sizes.radius;
            return true;
        }
        if !((separation - before).abs() < KEPT * sizes.smaller) {
            return false;
        }
        let is_exact = self.build(axis, out);
        is_exact || (out.count > 0 && separation <= sizes.resolution())
    }

    /// The axis of least penetration or maximum separation; stops at the first beyond the limit.
    #[inline(always)]
    fn search(&self) -> Axis {
        let (sizes, of_a) = (self.sizes(), self.best_face(false));
        if of_a.separation > sizes.limit() {
            return Axis::Face(of_a);
        }
        let of_b = self.best_face(true);
        if of_b.separation > sizes.limit() {
            return Axis::Face(of_b);
        }
        let preference = 2.0 * MARGIN * sizes.smaller;
        let is_of_b = of_b.separation > of_a.separation + 0.1 * preference;
        let face = if is_of_b { of_b } else { of_a };
        self.best_edges(&of_a, &of_b, face.separation + preference).map_or(Axis::Face(face), Axis::Edges)
    }

    /// Fills the manifold from the best of all axes.
    #[inline(always)]
    fn decide(&self, axis: &Axis, out: &mut LocalManifold) {
        let (sizes, separation) = (self.sizes(), axis.separation());
        out.count = 0;
        // NaN sizes give no axis, or an axis with a NaN separation.
        if !(separation <= sizes.limit()) || separation == f32::NEG_INFINITY {
            out.gap = max(separation - sizes.radius, 0.0);
            return;
        }
        let is_exact = self.build(axis, out);
        if separation > sizes.resolution() {
            if !is_exact {
                self.build_apart(axis, out);
            }
        } else if let (Axis::Face(face), 0) = (axis, out.count) {
            self.push_deepest(face, out);
        }
    }
}

/// The number of blocks of A's edges that are tested beforehand. Blocks beyond this number are all searched.
const LISTED: usize = 64;

/// The signed distance of `other` from a face of `this`, where `frame` transforms `other` into its frame.
/// `this` counts as A.
#[inline(always)]
pub(super) fn face_separation(this: &View, face: usize, other: &View, frame: &MatrixPose) -> FaceAxis {
    let f = &this.faces[face];
    let (lowest, depth) = other.farthest(-frame.direction_in(f.normal));
    FaceAxis { face, of_b: false, separation: (f.normal.dot(frame.position) - f.offset) - depth, lowest }
}

/// The face of `this` with the largest separation, where `frame` transforms `other` into the frame of `this`.
/// Stops at the first face above `limit`. `this` counts as A.
pub(super) fn best_face(this: &View, other: &View, frame: &MatrixPose, limit: f32) -> FaceAxis {
    if this.faces.is_empty() {
        return FaceAxis { face: 0, of_b: false, separation: f32::NEG_INFINITY, lowest: 0 };
    }
    let (first, _) = face_under(this, [frame.point(other.center)]);
    let mut best = face_separation(this, first, other, frame);
    let mut point = frame.point(other.vertices[best.lowest]);
    for (i, block) in this.face_blocks.iter().enumerate() {
        if best.separation > limit {
            break;
        }
        let heights = block.normal.dot(Vector::splat(point)) - block.offset;
        let mut left = F32x4::bits(F32x4::splat(best.separation).lt(heights));
        while left != 0 {
            let face = 4 * i + left.trailing_zeros() as usize;
            left &= left - 1;
            if face != best.face && face < this.faces.len() {
                let found = face_separation(this, face, other, frame);
                if found.separation > best.separation {
                    best = found;
                    point = frame.point(other.vertices[best.lowest]);
                }
            }
        }
    }
    best
}

/// The face with the largest height of the lowest of some points over it, and this height.
#[inline(always)]
pub(super) fn face_under<const N: usize>(view: &View, points: [Vector; N]) -> (usize, f32) {
    let points = points.map(Vector::<F32x4>::splat);
    let mut best = F32x4::splat(f32::NEG_INFINITY);
    let (mut at, mut number) = (F32x4::ZERO, F32x4::ZERO);
    for block in view.face_blocks {
        let mut height = block.normal.dot(points[0]);
        for point in &points[1..] {
            height = height.min(block.normal.dot(*point));
        }
        let height = height - block.offset;
        let better = best.lt(height);
        best = F32x4::select(better, height, best);
        at = F32x4::select(better, number, at);
        number += F32x4::ONE;
    }
    let (face, height) = largest(best, at);
    (face.min(view.faces.len() - 1), height)
}

/// Which of four edges, as bits, may have an axis along which `point` of the other polyhedron is not deeper
/// than `depth` ≤ 0. See the module.
#[inline(always)]
pub(super) fn open_edges(block: &EdgeBlock, point: Vector, depth: f32) -> u32 {
    let (arm, depth) = (Vector::<F32x4>::splat(point) - block.tail, F32x4::splat(depth));
    let (left, right) = (block.left.dot(arm).lt(depth), block.right.dot(arm).lt(depth));
    !F32x4::bits(F32x4::and(left, right)) & 0xf
}

/// Edges of B in A's frame against four edges of A at a time.
///
/// The axis e_A × e_B is a face normal of the Minkowski difference A − B only if the arcs of the two edges on
/// the Gauss map, with B's arc point-reflected, cross (Gregorius, "The Separating Axis Test between Convex
/// Polyhedra", GDC 2013). An arc goes from the left normal l to the right normal r by a turn about the edge's
/// direction; it meets the great circle of the other edge e where l·e and r·e differ in sign, at sign(l·e)
/// e_A × e_B for A's arc, and at the corresponding sign for B's. Both must be the same point, and that point
/// is the outward axis. Using the directions of the edges instead of products of normals keeps this right for
/// arcs up to 180°, as a flat triangle has.
struct EdgeTest {
    direction: Vector<F32x4>,
    left: Vector<F32x4>,
    right: Vector<F32x4>,
    tail: Vector<F32x4>,
}

impl EdgeTest {
    /// One edge of four, in A's frame.
    #[inline(always)]
    fn new(of_b: &EdgeBlock, lane: usize, frame: &MatrixPose) -> Self {
        Self {
            direction: Vector::splat(frame.direction(of_b.direction.get(lane))),
            left: Vector::splat(frame.direction(of_b.left.get(lane))),
            right: Vector::splat(frame.direction(of_b.right.get(lane))),
            tail: Vector::splat(frame.point(of_b.tail.get(lane))),
        }
    }

    /// The separations along the four axes, −∞ for pairs that are no axis, and the signs of the products.
    #[inline(always)]
    fn run(&self, block: &EdgeBlock) -> Option<(F32x4, F32x4)> {
        let (a_left, a_right) = (block.left.dot(self.direction), block.right.dot(self.direction));
        let (b_left, b_right) = (self.left.dot(block.direction), self.right.dot(block.direction));
        let (a_turn, b_turn) = (a_left - a_right, b_left - b_right);
        let crosses = F32x4::and(
            F32x4::and((a_left * a_right).le(F32x4::ZERO), (b_left * b_right).le(F32x4::ZERO)),
            F32x4::ZERO.lt(a_turn * b_turn),
        );
        if !F32x4::any(crosses) {
            return None;
        }
        let axis = block.direction.cross(self.direction);
        let square = axis.length_squared();
        let usable = F32x4::and(crosses, F32x4::splat(PARALLEL * PARALLEL).lt(square));
        let sign = F32x4::select(F32x4::ZERO.lt(a_turn), F32x4::ONE, -F32x4::ONE);
        let separation = axis.dot(self.tail - block.tail) * sign / square.sqrt();
        Some((F32x4::select(usable, separation, F32x4::splat(f32::NEG_INFINITY)), sign))
    }
}

/// The input of the search over edges: a point of each polyhedron in the frame of the other, and the
/// separation that edges have to exceed.
pub(super) struct Known {
    pub of_b_in_a: Vector,
    pub of_a_in_b: Vector,
    pub separation: f32,
}

/// The pair of edges with the largest separation, if it is larger than the `known` separation. `frame`
/// transforms B into A's frame. Stops at the first pair above `limit`.
pub(super) fn best_edges(
    a: &View,
    b: &View,
    frame: &MatrixPose,
    known: &Known,
    limit: f32,
) -> Option<EdgeAxis> {
    let depth = min(known.separation, 0.0);
    let mut listed = [0u16; LISTED];
    let mut count = 0;
    for (i, block) in a.edge_blocks.iter().take(LISTED).enumerate() {
        listed[count] = i as u16;
        count += usize::from(open_edges(block, known.of_b_in_a, depth) != 0);
    }
    let listed = &listed[..count];
    if listed.is_empty() && a.edge_blocks.len() <= LISTED {
        return None;
    }
    let mut best = known.separation;
    let mut found = None;
    'search: for (j, of_b) in b.edge_blocks.iter().enumerate() {
        let mut left = open_edges(of_b, known.of_a_in_b, depth) & (0xf >> (4 - remaining(b, j)));
        while left != 0 {
            let lane = left.trailing_zeros() as usize;
            left &= left - 1;
            let test = EdgeTest::new(of_b, lane, frame);
            let blocks = listed.iter().map(|i| usize::from(*i)).chain(LISTED..a.edge_blocks.len());
            for i in blocks {
                let Some((separations, sign)) = test.run(&a.edge_blocks[i]) else { continue };
                if !F32x4::any(F32x4::splat(best).lt(separations)) {
                    continue;
                }
                for k in 0..remaining(a, i) {
                    if separations.get(k) > best {
                        best = separations.get(k);
                        found = Some((4 * i + k, 4 * j + lane, sign.get(k)));
                    }
                }
                if best > limit {
                    break 'search;
                }
            }
        }
    }
    let (i, j, sign) = found?;
    let axis = a.edge_blocks[i / 4].direction.get(i % 4).cross(frame.direction(edge_direction(b, j))) * sign;
    Some(EdgeAxis { a: i, b: j, normal: axis * (1.0 / axis.length()), separation: best })
}

/// The present separation of a pair of edges; `None` if the pair is no longer an axis of the Minkowski
/// difference.
pub(super) fn edge_separation(
    a: &View,
    i: usize,
    b: &View,
    j: usize,
    frame: &MatrixPose,
) -> Option<EdgeAxis> {
    let test = EdgeTest::new(&b.edge_blocks[j / 4], j % 4, frame);
    let (separations, sign) = test.run(&a.edge_blocks[i / 4])?;
    let separation = separations.get(i % 4);
    if separation == f32::NEG_INFINITY {
        return None;
    }
    let axis = a.edge_blocks[i / 4].direction.get(i % 4).cross(test.direction.get(0)) * sign.get(i % 4);
    Some(EdgeAxis { a: i, b: j, normal: axis * (1.0 / axis.length()), separation })
}

fn edge_direction(view: &View, edge: usize) -> Vector {
    view.edge_blocks[edge / 4].direction.get(edge % 4)
}

/// The number of lanes of an edge block that are not padding.
pub(super) fn remaining(view: &View, block: usize) -> usize {
    (view.edges.len() - 4 * block).min(4)
}
