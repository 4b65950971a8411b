//! Methods of contact manifolds in both dimensions.

use super::{dim::ContactManifold, point::ContactPoint};
use crate::math::Scalar;

impl ContactManifold {
    /// The sum of the normal impulses of all points, N·s.
    pub fn total_normal_impulse(&self) -> Scalar {
        self.points.iter().fold(0.0, |sum, point| sum + point.normal_impulse)
    }

    /// The largest normal impulse of a point, N·s.
    pub fn max_normal_impulse(&self) -> Scalar {
        self.points.iter().fold(0.0, |max, point| max.max(point.normal_impulse))
    }

    /// Copies the warm start impulses of matching points in `previous_contacts`. Points match if their
    /// features are known and equal, or if both anchors are nearer than `distance_threshold`.
    pub fn match_contacts(&mut self, previous_contacts: &[ContactPoint], distance_threshold: Scalar) {
        let near = distance_threshold * distance_threshold;
        for point in &mut self.points {
            let old = previous_contacts.iter().find(|old| {
                let are_known = !point.feature_id1.is_unknown();
                let same = [point.feature_id1, point.feature_id2] == [old.feature_id1, old.feature_id2];
                are_known && same
                    || point.anchor1.distance_squared(old.anchor1) < near
                        && point.anchor2.distance_squared(old.anchor2) < near
            });
            if let Some(old) = old {
                point.warm_start_normal_impulse = old.warm_start_normal_impulse;
                point.warm_start_tangent_impulse = old.warm_start_tangent_impulse;
            }
        }
    }

    /// The point with the deepest overlap.
    pub fn find_deepest_contact(&self) -> Option<&ContactPoint> {
        self.points.iter().max_by(|a, b| a.penetration.total_cmp(&b.penetration))
    }
}
