//! The contact of two convex shapes: the code common to all pairs. The function of each pair is in `dim2` and
//! `dim3`.

use super::{FeatureCache, LocalManifold, PairInput, dim};
use crate::math::{Pose, Vector};
use crate::shape::Shape;
use core::cell::Cell;

/// Centres farther apart than this, in metres, have no contact: their squares would overflow.
pub(super) const FARTHEST: f32 = 1.0e15;

/// The contact of two shapes, in A's frame. `pose_b_in_a` is B's pose in A's frame.
///
/// `out` gets the points no farther apart than `prediction` metres. It has none if a pose or size is not
/// finite, and for two half-spaces, [composites](crate::shape::Composite) and foreign shapes. The normal of
/// overlapping shapes is the direction of least penetration, or the normal of a face with slightly more.
/// Segments and triangles are two-sided.
///
/// `cache` is the cache of the same pair in the same order from the previous step, or [`FeatureCache::NONE`].
/// The cached axis is tested first, and kept while it is as good as any other, so that resting contacts do
/// not flip.
pub fn collide(
    a: &Shape,
    b: &Shape,
    pose_b_in_a: &Pose,
    prediction: f32,
    cache: &mut FeatureCache,
    out: &mut LocalManifold,
) {
    let cache = Cell::from_mut(cache);
    collide_pair(a, b, PairInput { pose: pose_b_in_a, prediction, cache }, out);
}

/// See [`collide`].
pub(super) fn collide_pair(a: &Shape, b: &Shape, input: PairInput, out: &mut LocalManifold) {
    (out.count, out.gap) = (0, 0.0);
    if !is_near(input.pose) {
        return;
    }
    if let (Shape::Cuboid(a), Shape::Cuboid(b)) = (a, b) {
        dim::collide_cuboids(a, b, input, out);
    } else if dim::rank(a) > dim::rank(b) {
        let inverse = input.pose.inverse();
        dim::dispatch(b, a, PairInput { pose: &inverse, ..input }, out);
        *out = out.flipped(&inverse);
        out.points.iter_mut().for_each(|p| p.feature = dim::swapped_feature(p.feature));
    } else {
        dim::dispatch(a, b, input, out);
    }
    if !matches!((a, b), (Shape::Curved(_), _) | (_, Shape::Curved(_))) {
        out.radii = [a.radius(), b.radius()];
    }
    drop_unusable(out);
}

/// Whether squares of distances between two shapes do not overflow.
pub(super) fn is_near(pose: &Pose) -> bool {
    pose.position.abs().max_element() < FARTHEST && pose.rotation.is_finite()
}

/// Drops a contact whose numbers overflowed, as with extreme ratios of sizes.
#[inline]
pub(super) fn drop_unusable(out: &mut LocalManifold) {
    if out.count == 0 {
        return;
    }
    // `x * 0.0` is 0 unless x is infinite or NaN.
    let zero = out.points().iter().fold(0.0, |sum, p| sum + p.point.dot(Vector::ZERO) + p.separation * 0.0);
    if !((out.normal.length_squared() - 1.0).abs() < 1.0e-3 && zero == 0.0) {
        out.count = 0;
    }
}
