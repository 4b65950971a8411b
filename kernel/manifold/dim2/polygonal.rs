//! Bounded shapes as convex polygons with a radius, and contacts of their features: of two corners, and of
//! two edges that face each other, one clipped by the other.

use super::super::LocalManifold;
use crate::math::{Pose, Vector, max};
use crate::shape::{Shape, direction, oriented};
use crate::tuning::manifold::FLAT;

/// A convex polygon with a radius: one vertex for a ball, two for a segment, otherwise counter-clockwise.
///
/// `normals[i]` is the outward unit normal of the edge from vertex `i` to the next. A segment has two
/// edges, there and back. A single vertex has no normals.
pub(super) struct Polygonal<'a> {
    pub(super) vertices: &'a [Vector],
    pub(super) normals: &'a [Vector],
    pub(super) radius: f32,
}

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

/// A buffer for the vertices and normals of shapes that do not store them.
pub(super) struct Buffer {
    vertices: [Vector; 4],
    normals: [Vector; 4],
}

impl Buffer {
    pub(super) const EMPTY: Self = Self { vertices: [Vector::ZERO; 4], normals: [Vector::ZERO; 4] };
}

impl Polygonal<'_> {
    #[inline]
    pub(super) fn len(&self) -> usize {
        self.vertices.len()
    }

    /// The index after `i`, around the outline.
    #[inline]
    pub(super) fn next(&self, i: usize) -> usize {
        if i + 1 < self.len() { i + 1 } else { 0 }
    }

    /// The index before `i`, around the outline.
    #[inline]
    pub(super) fn previous(&self, i: usize) -> usize {
        if i == 0 { self.len() - 1 } else { i - 1 }
    }

    /// The edge `i`.
    #[inline]
    pub(super) fn edge(&self, i: usize) -> Edge {
        let j = self.next(i);
        Edge { ends: [self.vertices[i], self.vertices[j]], indices: [i, j] }
    }

    /// The vertex least far along `normal`, and its distance.
    #[inline]
    pub(super) fn lowest(&self, normal: Vector) -> (usize, f32) {
        let mut best = (0, f32::INFINITY);
        for (i, v) in self.vertices.iter().enumerate() {
            let h = v.dot(normal);
            if h < best.1 {
                best = (i, h);
            }
        }
        best
    }

    /// The edge at a vertex whose normal is more opposite to `normal`.
    #[inline]
    pub(super) fn edge_facing(&self, normal: Vector, vertex: usize) -> usize {
        let before = self.previous(vertex);
        if self.normals[before].dot(normal) < self.normals[vertex].dot(normal) { before } else { vertex }
    }
}

/// The polygon of a shape; `None` for ellipses, half-spaces and foreign shapes.
#[inline]
pub(super) fn view<'a>(shape: &'a Shape, room: &'a mut Buffer) -> Option<Polygonal<'a>> {
    Some(match shape {
        Shape::Ball(s) => {
            room.vertices[0] = Vector::ZERO;
            Polygonal { vertices: &room.vertices[..1], normals: &[], radius: s.radius }
        }
        Shape::Capsule(s) => segment(s.a, s.b, s.radius, room),
        Shape::Segment(s) => segment(s.a, s.b, 0.0, room),
        Shape::Cuboid(s) => {
            room.vertices = corners(s.half);
            room.normals = NORMALS;
            Polygonal { vertices: &room.vertices, normals: &room.normals, radius: 0.0 }
        }
        Shape::Triangle(s) => match oriented(s) {
            Ok((corners, normals)) => {
                room.vertices[..3].copy_from_slice(&corners);
                room.normals[..3].copy_from_slice(&normals);
                Polygonal { vertices: &room.vertices[..3], normals: &room.normals[..3], radius: 0.0 }
            }
            Err(side) => segment(side.a, side.b, 0.0, room),
        },
        Shape::Hull(s) => Polygonal { vertices: s.vertices(), normals: s.normals(), radius: s.radius() },
        Shape::Composite(_) | Shape::Curved(_) | Shape::HalfSpace(_) | Shape::Foreign(_) => return None,
    })
}

fn segment(a: Vector, b: Vector, radius: f32, room: &mut Buffer) -> Polygonal<'_> {
    room.vertices[0] = a;
    room.vertices[1] = b;
    match direction(b - a) {
        Some((axis, _)) => {
            room.normals[0] = -axis.perp();
            room.normals[1] = axis.perp();
            Polygonal { vertices: &room.vertices[..2], normals: &room.normals[..2], radius }
        }
        None => Polygonal { vertices: &room.vertices[..1], normals: &[], radius },
    }
}

/// The outward normals of a cuboid's edges, in the order of its [`corners`].
pub(super) const NORMALS: [Vector; 4] = [
    Vector::from_array([0.0, -1.0]),
    Vector::from_array([1.0, 0.0]),
    Vector::from_array([0.0, 1.0]),
    Vector::from_array([-1.0, 0.0]),
];

/// A cuboid's corners, counter-clockwise from the lower left.
#[inline]
pub(super) fn corners(half: Vector) -> [Vector; 4] {
    let Vector { x, y } = half;
    [[-x, -y], [x, -y], [x, y], [-x, y]].map(Vector::from_array)
}

/// The radii of the two shapes, and the prediction distance.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limits {
    pub(super) radii: [f32; 2],
    pub(super) prediction: f32,
}

/// Adds the contact point of two points `p`, `q` with a radius each, if they are near enough, and sets the
/// normal from `p` to `q`, or `otherwise` if they coincide.
#[inline]
pub(super) fn push_between(
    p: Vector,
    q: Vector,
    otherwise: Vector,
    limits: Limits,
    feature: u32,
    out: &mut LocalManifold,
) -> Vector {
    let (normal, distance) = direction(q - p).unwrap_or((otherwise, 0.0));
    let separation = distance - limits.radii[0] - limits.radii[1];
    if separation <= limits.prediction {
        out.push(p + normal * (0.5 * (distance + limits.radii[0] - limits.radii[1])), separation, feature);
    } else {
        out.gap = separation;
    }
    normal
}

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
    use crate::manifold::{FeatureCache, LocalManifold, collide};
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
