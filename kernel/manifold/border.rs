//! Which borders of a facet a contact is on, and how the surface continues behind them.

use super::LocalManifold;
use crate::math::Vector;
use crate::tuning::manifold::{MARGIN, ON_BORDER, SIDEWAYS};

/// One side of a triangle, or one end of a segment.
pub(super) struct Border {
    /// The corner where the border begins.
    pub corner: Vector,
    /// Its unit direction; 0 for a point.
    pub along: Vector,
    /// The unit direction out of the facet, in its plane.
    pub outward: Vector,
    /// The extent of the facet from this border, in metres.
    pub depth: f32,
}

/// Whether a point is outside of a facet.
pub(super) fn is_beside(borders: &[Border], point: Vector) -> bool {
    borders.iter().any(|b| (point - b.corner).dot(b.outward) > MARGIN * b.depth)
}

impl Border {
    /// Whether all points of a manifold are on this border, except points that rise above the deepest point.
    pub(super) fn is_met_by(&self, local: &LocalManifold) -> bool {
        let deepest = local.points().iter().min_by(|p, q| p.separation.total_cmp(&q.separation));
        let Some(deepest) = deepest else { return true };
        local.points().iter().all(|p| {
            let on_facet = p.point - local.normal * (0.5 * p.separation);
            let is_above = p.separation - deepest.separation > SIDEWAYS * (p.point - deepest.point).length();
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
