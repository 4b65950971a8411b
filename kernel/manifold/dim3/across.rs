//! Where an edge crosses a face that it nearly lies in.
//!
//! Two edges touch in one point. A thin rod on the edge of another would rock on that, from one of its own edges to the next:
//! the other end of the line across its face is hardly farther from the surface. So that end is a point, too.

use super::clip::clip_line;
use super::view::View;
use crate::math::Vector;
use crate::shape::Edge;
use crate::tuning::manifold::FACING;

/// The end of the line along which an edge passes over the face of `reference` beside `edge`, of the two ends the one
/// farther from that face: the point on the edge, and its distance from the face along `normal`. The ends of the edge are in
/// the frame of `reference`; `normal` is the unit normal of the contact, out of `reference`.
pub(super) fn far_end(
    reference: &View,
    edge: &Edge,
    ends: [Vector; 2],
    normal: Vector,
) -> Option<(Vector, f32)> {
    // A segment has no faces.
    let [left, right] = [edge.left, edge.right].map(|face| reference.faces.get(face as usize));
    let (left, right) = (left?, right?);
    let face = if left.normal.dot(normal) > right.normal.dot(normal) { left } else { right };
    let cosine = face.normal.dot(normal);
    if cosine < FACING {
        return None;
    }
    let along = ends[1] - ends[0];
    let outline = &reference.loops[face.first as usize..(face.first + face.count) as usize];
    let outline = outline.iter().map(|corner| reference.vertices[*corner as usize]);
    let [(low, _), (high, _)] = clip_line(normal, outline, ends, 0.0).filter(|[low, high]| low.0 < high.0)?;
    let end = |t: f32| {
        let point = ends[0] + along * t;
        (point, (face.normal.dot(point) - face.offset) / cosine)
    };
    let (first, last) = (end(low), end(high));
    Some(if first.1 > last.1 { first } else { last })
}

#[cfg(test)]
mod tests {
    use crate::manifold::{FeatureCache, LocalManifold, collide};
    use crate::math::{Pose, Rot, Vector};
    use crate::shape::{Cuboid, Hull, Shape};
    use std::sync::Arc;

    /// The distance of a point from the nearest face of a rod, of those along it; 0 on the surface.
    fn above(half: Vector, p: Vector) -> f32 {
        (p.x.abs() - half.x).max(p.y.abs() - half.y)
    }

    /// One rod along z on another along x, which it overlaps by a millimetre, inclined by 0.1 and rolled by 0.02: it lies on
    /// an edge of that with its width of 6 cm, not only with one of its own edges.
    #[test]
    fn issue_a_rod_across_an_edge_stood_on_one_of_its_own_edges() {
        let half = Vector { x: 0.03, y: 0.03, z: 0.5 };
        let corner = |i: u32| {
            let sign = |bit: u32| if i & bit == 0 { -1.0 } else { 1.0 };
            Vector { x: sign(1), y: sign(2), z: sign(4) }.scale(half)
        };
        let corners: Vec<_> = (0..8).map(corner).collect();
        let hull = Shape::Hull(Arc::new(Hull::convex_hull_of(&corners).expect("a box is solid")));
        let rolled = Rot::from_axis_angle(Vector::Z, 0.02);
        let inclined = Rot::from_axis_angle(Vector::X, 0.1);
        let across = Rot::from_axis_angle(Vector::Y, core::f32::consts::FRAC_PI_2);
        let pose = Pose::new(Vector { x: 0.0, y: 0.062, z: 0.0 }, across.mul(inclined).mul(rolled));
        for rod in [Shape::Cuboid(Cuboid { half }), hull] {
            let mut out = LocalManifold::default();
            collide(&rod, &rod, &pose, 0.02, &mut FeatureCache::NONE.clone(), &mut out);
            assert!(out.count > 1, "{:?}", out.points());
            for p in out.points() {
                let on_a = p.point - out.normal * (0.5 * p.separation);
                let on_b = pose.inverse_transform(p.point + out.normal * (0.5 * p.separation));
                let off = above(half, on_a).abs().max(above(half, on_b).abs());
                assert!(off < 1.0e-4, "{p:?} is {off} m off a surface");
            }
        }
    }
}
