//! Selects the separating axis of two polyhedra and builds the manifold from it: the algorithm common to all
//! polyhedral pairs.
//!
//! The axis of the last step is tested first (after Gregorius, "Robust Contact Creation for Physics
//! Simulations", GDC 2015). Faces are preferred to edges unless edges are clearly better, so that the choice
//! of points is the same from step to step.

use super::gjk;
use crate::manifold::{FeatureCache, LocalManifold};
use crate::math::{Vector, max};
use crate::tuning::manifold::{KEPT, MARGIN};
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
    /// Cores farther apart than this have no contact.
    #[inline(always)]
    pub fn limit(&self) -> f32 {
        self.prediction + self.radius
    }

    /// See [`gjk::resolution`].
    #[inline(always)]
    fn resolution(&self) -> f32 {
        gjk::resolution(self.larger, self.smaller)
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
