//! Arcs, and convex polygons with a radius.

use bevy_math::Vec2;
use core::f32::consts::{PI, TAU};

/// The number of lines that a full circle is drawn with.
const CIRCLE: u32 = 32;
/// Half the length of the drawn boundary of a half-space, in metres.
pub(super) const FAR: f32 = 100.0;

/// The closed outline of a convex polygon with any number of corners, even one or two, grown by a radius.
pub(super) fn rounded(mut corners: Vec<Vec2>, radius: f32) -> Vec<Vec2> {
    corners.dedup();
    while corners.len() > 1 && corners.first() == corners.last() {
        corners.pop();
    }
    let count = corners.len();
    let area: f32 = (0..count).map(|i| corners[i].perp_dot(corners[(i + 1) % count])).sum();
    if area < 0.0 {
        corners.reverse();
    }
    if radius <= 0.0 {
        return corners;
    }
    if count == 1 {
        return arc(corners[0], radius, 0.0, TAU);
    }
    let mut out = Vec::new();
    for i in 0..count {
        let (last, here, next) = (corners[(i + count - 1) % count], corners[i], corners[(i + 1) % count]);
        let outward = |edge: Vec2| -edge.perp();
        let (from, to) = (outward(here - last), outward(next - here));
        let from = from.to_angle();
        let turn = (to.to_angle() - from).rem_euclid(TAU);
        // Collinear edges may turn back by rounding.
        let turn = if turn > 1.5 * PI { 0.0 } else { turn };
        out.extend(arc(here, radius, from, from + turn));
    }
    out
}

/// The points of an arc, its ends included.
pub(super) fn arc(center: Vec2, radius: f32, from: f32, to: f32) -> Vec<Vec2> {
    let lines = ((to - from).abs() / TAU * CIRCLE as f32).ceil().max(1.0) as u32;
    let angle = |i: u32| from + (to - from) * i as f32 / lines as f32;
    (0..=lines).map(|i| center + Vec2::from_angle(angle(i)) * radius).collect()
}
