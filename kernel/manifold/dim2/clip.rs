//! Clipping: from a reference edge and an incident edge to contact points.

use super::super::LocalManifold;
use super::points::{Limits, push_between};
use super::polygonal::Edge;
use crate::math::{Pose, Vector, max};
use crate::tuning::manifold::FLAT;

/// The shape of the reference edge; as a number, its index in arrays of both shapes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    A,
    B,
}

/// A reference edge with its unit normal and the incident edge, both in A's frame, and the limits for the
/// points.
pub(super) struct Facing {
    pub(super) side: Side,
    pub(super) normal: Vector,
    pub(super) reference: Edge,
    pub(super) incident: Edge,
    /// The radii of the reference and of the incident polygon.
    pub(super) limits: Limits,
}

impl Facing {
    /// A reference edge of `side` with its normal, in that side's frame. `facing` gives the edge of the other
    /// side that faces a normal in that other side's frame.
    #[inline]
    pub(super) fn new(
        side: Side,
        (reference, normal): (Edge, Vector),
        facing: impl FnOnce(Vector) -> Edge,
        pose: &Pose,
        limits: Limits,
    ) -> Self {
        if side == Side::A {
            let incident = facing(pose.rotation.inverse_rotate(normal)).moved(pose);
            return Self { side, normal, reference, incident, limits };
        }
        let normal = pose.rotation.rotate(normal);
        Self { side, normal, reference: reference.moved(pose), incident: facing(normal), limits }
    }

    /// Fills `out`. `is_separated` tells that the cores are separated along the reference normal; otherwise a
    /// corner is never taken for the closest feature.
    #[inline]
    pub(super) fn contact(&self, is_separated: bool, out: &mut LocalManifold) {
        // Lengths are measured from the start of the reference edge, which keeps them small.
        let tangent = self.normal.perp();
        let start = self.reference.ends[0];
        let length = (self.reference.ends[1] - start).dot(tangent);
        let offsets = self.incident.ends.map(|w| w - start);
        let along = offsets.map(|w| w.dot(tangent));
        let height = offsets.map(|w| w.dot(self.normal));
        let nothing = FLAT as f32 * (length + (along[1] - along[0]).abs());
        // The closest end is the lower end. For an edge wholly beside the reference it is the end nearer to
        // the corner, since level edges have no lower end.
        let beside = along[1] > length || along[0] < 0.0;
        let end = if beside {
            let corner = self.reference.ends[usize::from(along[1] > length)];
            let [p, q] = self.incident.ends.map(|w| (w - corner).length_squared());
            usize::from(q < p)
        } else {
            usize::from(height[1] < height[0])
        };

        let beyond = max(-along[end], along[end] - length);
        if is_separated && beyond > nothing {
            // Beyond an end of the reference edge either that end faces the incident edge, which is then
            // nearly parallel, or two corners are closest.
            let own_end = usize::from(along[end] > 0.0);
            let w = self.incident.ends[end];
            let toward = self.incident.ends[1 - end] - w;
            if beside || (self.reference.ends[own_end] - w).dot(toward) < -nothing * toward.length() {
                self.corners(own_end, end, out);
                return;
            }
        }
        self.edges(length, along, height, end, out);
    }

    /// One point between a corner of the reference edge and a corner of the incident edge.
    pub(super) fn corners(&self, own_end: usize, end: usize, out: &mut LocalManifold) {
        let (p, q) = (self.reference.ends[own_end], self.incident.ends[end]);
        let feature = self.feature(self.reference.indices[own_end], self.incident.indices[end]);
        let normal = push_between(p, q, self.normal, self.limits, feature, out);
        out.normal = self.outward(normal);
    }

    /// Up to two points where the edges face each other, from positions along the reference edge and heights
    /// over it. If they do not face each other, `end` of the incident edge alone.
    #[inline]
    fn edges(&self, length: f32, along: [f32; 2], height: [f32; 2], end: usize, out: &mut LocalManifold) {
        out.normal = self.outward(self.normal);
        // The incident edge runs against the reference edge: its end 1 pairs with the start.
        let run = along[0] - along[1];
        let nothing = FLAT as f32 * (length + run.abs());
        // Ends within rounding above an end of the reference edge are not clipped: the incident edge
        // may be steep.
        let low = if along[1] < -nothing { 0.0 } else { along[1] };
        let high = if along[0] > length + nothing { length } else { along[0] };
        if high - low > nothing {
            let slope = (height[0] - height[1]) / run;
            let at = |t: f32| height[1] + (t - along[1]) * slope;
            // The order of points does not depend on the polygon of the reference.
            let (first, second) =
                if self.side == Side::A { ((0, low), (1, high)) } else { ((1, high), (0, low)) };
            self.push(first.0, first.1, at(first.1), out);
            self.push(second.0, second.1, at(second.1), out);
        } else {
            // An edge is upright or has no length, or the edges touch by rounding with the end that is level
            // with a corner.
            let end = match (run > nothing, along[0] <= nothing, along[1] >= length - nothing) {
                (true, true, false) => 0,
                (true, false, true) => 1,
                _ => end,
            };
            self.push(1 - end, along[end], height[end], out);
        }
    }

    /// Adds the point at position `t` of the reference edge, where the incident edge is `height` over it, if
    /// this is near enough. `end` is the nearer end of the reference edge.
    #[inline]
    fn push(&self, end: usize, t: f32, height: f32, out: &mut LocalManifold) {
        let separation = height - self.limits.radii[0] - self.limits.radii[1];
        if separation <= self.limits.prediction {
            let middle = 0.5 * (height + self.limits.radii[0] - self.limits.radii[1]);
            let point = self.reference.ends[0] + self.normal.perp() * t + self.normal * middle;
            let feature = self.feature(self.reference.indices[end], self.incident.indices[1 - end]);
            out.push(point, separation, feature);
        }
    }

    #[inline]
    fn outward(&self, normal: Vector) -> Vector {
        if self.side == Side::A { normal } else { -normal }
    }

    #[inline]
    fn feature(&self, reference: usize, incident: usize) -> u32 {
        if self.side == Side::A { pair(reference, incident) } else { pair(incident, reference) }
    }
}

/// The feature id of a vertex of A and a vertex of B. Indices beyond 16 bits wrap around.
#[inline]
pub(super) fn pair(a: usize, b: usize) -> u32 {
    u32::from(a as u16) << 16 | u32::from(b as u16)
}

#[cfg(test)]
mod tests {
    use super::super::super::{FeatureCache, LocalManifold, collide};
    use crate::math::{Pose, Rot, Vector};
    use crate::shape::{Cuboid, Shape};

    /// The point was at the far end of the side, away from the other box.
    #[test]
    fn boxes_whose_corners_are_level_meet_at_the_corners() {
        let box_of = |x: f32, y: f32| Shape::Cuboid(Cuboid { half: Vector { x, y } });
        let (tile, plank) = (box_of(0.025, 0.5), box_of(0.5, 0.04));
        for ulp in -4..=4 {
            let above = 0.5 * (f32::from(ulp as i8) * f32::EPSILON);
            for turn in [0.0f32, 1.0e-7, -1.0e-7] {
                let pose = Pose::new(Vector { x: -0.549, y: 0.54 + above }, Rot::from_angle(turn));
                let mut out = LocalManifold::default();
                collide(&tile, &plank, &pose, 0.1, &mut FeatureCache::NONE.clone(), &mut out);
                let off = out.points().iter().map(|p| (p.point.y - 0.5).abs()).fold(0.0, f32::max);
                assert!(
                    out.count == 1 && off < 1.0e-6,
                    "{above} m above, turned by {turn}: {off} m off: {out:?}"
                );
                let mut out = LocalManifold::default();
                collide(&plank, &tile, &pose.inverse(), 0.1, &mut FeatureCache::NONE.clone(), &mut out);
                let off = out.points().iter().map(|p| (p.point.y + 0.04).abs()).fold(0.0, f32::max);
                assert!(
                    out.count == 1 && off < 1.0e-6,
                    "{above} m above, turned by {turn}: {off} m off: {out:?}"
                );
            }
        }
    }
}
