//! Which borders of a facet a contact is on, and where the surface goes on behind them.

use super::LocalManifold;
use super::dim::Border;
use crate::math::Vector;

/// Contacts up to this share of a facet's size inside of a border are on the border.
const ON_BORDER: f32 = 0.02;

/// A facet rises from its deepest point if the separation grows by more than this share of the distance. Points up there do
/// not tell which border is met.
const RISING: f32 = 0.05;

impl Border {
    /// Whether all points of a manifold are on the facet's border, but for those where it rises.
    pub(super) fn is_met_by(&self, local: &LocalManifold) -> bool {
        let deepest = local.points().iter().min_by(|p, q| p.separation.total_cmp(&q.separation));
        let Some(deepest) = deepest else { return true };
        local.points().iter().all(|p| {
            let on_facet = p.point - local.normal * (0.5 * p.separation);
            let is_above = p.separation - deepest.separation > RISING * (p.point - deepest.point).length();
            is_above || (self.corner - on_facet).dot(self.outward) <= ON_BORDER * self.depth
        })
    }

    /// The direction from the border into the neighbour's plane, across the border.
    pub(super) fn toward_neighbor<const N: usize>(&self, corners: [Vector; N]) -> Vector {
        let across = corners.map(|corner| {
            let to = corner - self.corner;
            to - self.along * to.dot(self.along)
        });
        let farthest = across
            .into_iter()
            .fold(Vector::ZERO, |f, v| if v.length_squared() > f.length_squared() { v } else { f });
        let length = farthest.length();
        if length > 0.0 { farthest * (1.0 / length) } else { self.outward }
    }
}
