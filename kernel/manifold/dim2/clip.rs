//! From a reference edge and an incident edge to contact points.

use super::super::LocalManifold;
use super::points::{Limits, push_between};
use crate::math::{Pose, Vector, max};

/// An edge of a polygon, counter-clockwise, with the indices of its ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct Edge {
    pub(super) ends: [Vector; 2],
    pub(super) indices: [usize; 2],
}

impl Edge {
    /// The edge in the outer frame of `pose`.
    #[inline]
    pub(super) fn moved(&self, pose: &Pose) -> Self {
        Self { ends: self.ends.map(|v| pose.transform(v)), indices: self.indices }
    }
}

/// Which shape the reference edge belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Side {
    A,
    B,
}

/// A reference edge with its unit normal and the edge of the other polygon that faces it, both in A's
/// frame, and what of the polygons' surroundings the points depend on.
pub(super) struct Facing {
    pub(super) side: Side,
    pub(super) normal: Vector,
    pub(super) reference: Edge,
    pub(super) incident: Edge,
    /// The radii of the reference and of the incident polygon.
    pub(super) limits: Limits,
}

/// Offsets along an edge below this part of the edges' lengths count as none.
const ALIGNED: f32 = 1.0e-6;

impl Facing {
    /// Fills `out` for polygons whose cores are `apart` along the reference normal, or not known to be
    /// (then a corner is never taken for the nearest feature).
    #[inline]
    pub(super) fn contact(&self, apart: bool, out: &mut LocalManifold) {
        // All lengths from the start of the reference edge, which keeps them short.
        let tangent = self.normal.perp();
        let start = self.reference.ends[0];
        let length = (self.reference.ends[1] - start).dot(tangent);
        let offsets = self.incident.ends.map(|w| w - start);
        let along = offsets.map(|w| w.dot(tangent));
        let height = offsets.map(|w| w.dot(self.normal));
        let nothing = ALIGNED * (length + (along[1] - along[0]).abs());
        // The end to look at is the lower one. Of an edge that lies wholly beside the reference it is the
        // one nearer to the corner: level edges have no lower end.
        let beside = along[1] > length || along[0] < 0.0;
        let end = if beside {
            let corner = self.reference.ends[usize::from(along[1] > length)];
            let [p, q] = self.incident.ends.map(|w| (w - corner).length_squared());
            usize::from(q < p)
        } else {
            usize::from(height[1] < height[0])
        };

        let beyond = max(-along[end], along[end] - length);
        if apart && beyond > nothing {
            // Beyond an end of the reference edge: either that end faces the inside of the incident edge, which
            // passes over it and is nearly parallel, or two corners are nearest.
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

    /// One point between a corner of the reference edge and one of the incident edge.
    fn corners(&self, own_end: usize, end: usize, out: &mut LocalManifold) {
        let (p, q) = (self.reference.ends[own_end], self.incident.ends[end]);
        let feature = self.feature(self.reference.indices[own_end], self.incident.indices[end]);
        let normal = push_between(p, q, self.normal, self.limits, feature, out);
        out.normal = self.outward(normal);
    }

    /// Up to two points where the edges face each other, from positions along the reference edge and
    /// heights over it; `end` of the incident edge alone if they do not face each other.
    #[inline]
    fn edges(&self, length: f32, along: [f32; 2], height: [f32; 2], end: usize, out: &mut LocalManifold) {
        out.normal = self.outward(self.normal);
        // The incident edge runs against the reference edge: its end 1 pairs with the start.
        let run = along[0] - along[1];
        let nothing = ALIGNED * (length + run.abs());
        // Ends as good as above an end of the reference edge are not clipped: the incident edge may be steep.
        let low = if along[1] < -nothing { 0.0 } else { along[1] };
        let high = if along[0] > length + nothing { length } else { along[0] };
        if high - low > nothing {
            let slope = (height[0] - height[1]) / run;
            let at = |t: f32| height[1] + (t - along[1]) * slope;
            // The same order of points whichever polygon gave the reference.
            let (first, second) =
                if self.side == Side::A { ((0, low), (1, high)) } else { ((1, high), (0, low)) };
            self.push(first.0, first.1, at(first.1), out);
            self.push(second.0, second.1, at(second.1), out);
        } else {
            // One of them is upright or has no length, or rounding let them touch.
            self.push(1 - end, along[end], height[end], out);
        }
    }

    /// Adds the point over position `t` of the reference edge where the incident edge is `height` over
    /// it, if it is near enough. `end` names the end of the reference edge it is nearer to.
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
