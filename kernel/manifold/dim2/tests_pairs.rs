//! Shapes, oracles and tolerances of the tests of all pairs in the plane. `dim3` has the same for space.

use super::tests::oracle;
use crate::manifold::tests_pairs::Dice;
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Ball, Capsule, Cuboid, Curved, HalfSpace, Hull, Segment, Shape, Triangle};
use core::f32::consts::PI;
use std::sync::Arc;

/// The kinds of shapes.
pub(in super::super) const KINDS: [&str; 9] =
    ["ball", "capsule", "segment", "cuboid", "triangle", "hull", "rounded hull", "ellipse", "half-space"];

/// A random shape of a kind.
pub(in super::super) fn shape(kind: usize, dice: &mut Dice) -> Shape {
    let mut ends = || loop {
        let [a, b] = [0; 2].map(|_| dice.vector(1.0));
        if (b - a).length() > 0.1 {
            return [a, b];
        }
    };
    match KINDS[kind] {
        "ball" => Shape::Ball(Ball { radius: dice.size() }),
        "capsule" => {
            let [a, b] = ends();
            Shape::Capsule(Capsule { a, b, radius: 0.5 * dice.size() })
        }
        "segment" => {
            let [a, b] = ends();
            Shape::Segment(Segment { a, b })
        }
        "cuboid" => Shape::Cuboid(Cuboid { half: sides(dice) }),
        "triangle" => loop {
            let [a, b, c] = [0; 3].map(|_| dice.vector(1.0));
            if (b - a).perp_dot(c - a).abs() > 0.05 {
                return Shape::Triangle(Triangle { a, b, c });
            }
        },
        "hull" => hull(0.0, dice),
        "rounded hull" => {
            let radius = dice.between(0.02, 0.5);
            hull(radius, dice)
        }
        "ellipse" => Shape::Curved(Curved { half: sides(dice) }),
        _ => Shape::HalfSpace(HalfSpace { normal: dice.direction() }),
    }
}

fn sides(dice: &mut Dice) -> Vector {
    Vector::from_array([0; 2].map(|_| dice.size()))
}

fn hull(radius: f32, dice: &mut Dice) -> Shape {
    loop {
        let stretch = sides(dice);
        let point = |v: Vector| Vector { x: v.x * stretch.x, y: v.y * stretch.y };
        let points: Vec<Vector> = (0..3 + dice.below(12)).map(|_| point(dice.vector(1.0))).collect();
        if let Ok(hull) = Hull::convex_hull_of(&points, radius)
            && hull.unit_mass().mass > 0.02 * stretch.x * stretch.y
        {
            return Shape::Hull(Arc::new(hull));
        }
    }
}

/// A random rotation.
pub(in super::super) fn rotation(dice: &mut Dice) -> Rot {
    Rot::from_angle(dice.between(-PI, PI))
}

/// A turn by quarters.
pub(in super::super) fn square_rotation(dice: &mut Dice) -> Rot {
    Rot::from_angle(core::f32::consts::FRAC_PI_2 * dice.below(4) as f32)
}

/// The shape moved by a frame, if its points are its own.
pub(in super::super) fn in_frame(shape: &Shape, frame: &Pose) -> Option<Shape> {
    let go = |p: Vector| frame.transform(p);
    Some(match shape {
        Shape::Capsule(s) => Shape::Capsule(Capsule { a: go(s.a), b: go(s.b), radius: s.radius }),
        Shape::Segment(s) => Shape::Segment(Segment { a: go(s.a), b: go(s.b) }),
        Shape::Triangle(s) => Shape::Triangle(Triangle { a: go(s.a), b: go(s.b), c: go(s.c) }),
        Shape::Hull(s) => {
            let vertices: Vec<Vector> = s.vertices().iter().map(|p| go(*p)).collect();
            Shape::Hull(Arc::new(Hull::from_convex(&vertices, s.radius()).ok()?))
        }
        _ => return None,
    })
}

/// The signed distance by brute force, of all shapes except ellipses.
pub(in super::super) fn exact(a: &Shape, b: &Shape, pose: &Pose) -> Option<f64> {
    (!is_curved(a, b)).then(|| oracle(a, b, pose, [0.0; 2]))
}

/// A prediction distance that finds the contact, and not much more: edges are preferred by a
/// thousandth of it.
pub(in super::super) fn far(a: &Shape, b: &Shape, pose: &Pose) -> f32 {
    exact(a, b, pose).map_or(100.0, |distance| distance.max(0.0) as f32 + 0.02)
}

fn is_curved(a: &Shape, b: &Shape) -> bool {
    matches!((a, b), (Shape::Curved(_), _) | (_, Shape::Curved(_)))
}

/// How much deeper than the best axis the found axis may be: rounding for polygons. For ellipses that overlap
/// deeply, a nearly best axis is good enough.
pub(in super::super) fn allowed(a: &Shape, b: &Shape, best: f64) -> f64 {
    if is_curved(a, b) { 2.0e-3 + 0.05 * (-0.1 - best).max(0.0) } else { 5.0e-5 }
}

/// How much less deep than the axis the points may be, as a share of the depth.
pub(in super::super) const BESIDE: f64 = 0.0;

/// Tolerance of the points' positions along the axis.
pub(in super::super) fn inexact(a: &Shape, b: &Shape) -> f64 {
    if is_curved(a, b) { 1.0e-4 } else { 5.0e-5 }
}
