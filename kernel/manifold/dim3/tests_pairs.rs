//! Shapes, oracles and tolerances of the tests of all pairs in space. `dim2` has the same for the plane.

use super::oracle::Solid;
use crate::manifold::tests_pairs::Dice;
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Ball, Capsule, Cuboid, Curved, HalfSpace, Hull, Segment, Shape, Triangle};
use core::f32::consts::PI;
use std::sync::Arc;

/// The kinds of shapes.
pub(in super::super) const KINDS: [&str; 11] = [
    "ball",
    "capsule",
    "segment",
    "cuboid",
    "triangle",
    "hull",
    "rounded hull",
    "cylinder",
    "cone",
    "frustum",
    "half-space",
];

/// A random shape of a kind.
pub(in super::super) fn shape(kind: usize, dice: &mut Dice) -> Shape {
    match KINDS[kind] {
        "ball" => Shape::Ball(Ball { radius: dice.size() }),
        "capsule" => {
            Shape::Capsule(Capsule { a: dice.vector(1.0), b: dice.vector(1.0), radius: 0.5 * dice.size() })
        }
        "segment" => Shape::Segment(Segment { a: dice.vector(1.0), b: dice.vector(1.0) }),
        "cuboid" => Shape::Cuboid(Cuboid { half: sides(dice) }),
        "triangle" => loop {
            let [a, b, c] = [0; 3].map(|_| dice.vector(1.0));
            if (b - a).cross(c - a).length() > 0.05 {
                return Shape::Triangle(Triangle { a, b, c });
            }
        },
        "hull" => Shape::Hull(Arc::new(hull(dice))),
        "rounded hull" => loop {
            let radius = dice.between(0.02, 0.5);
            if let Ok(rounded) = hull(dice).rounded(radius) {
                return Shape::Hull(Arc::new(rounded));
            }
        },
        "half-space" => Shape::HalfSpace(HalfSpace { normal: dice.direction() }),
        "cylinder" => frustum(Curved::cylinder(dice.size(), dice.size())),
        "cone" => frustum(Curved::cone(dice.size(), dice.size())),
        _ if dice.below(8) == 0 => frustum(Curved::frustum(dice.size(), dice.size(), 0.0)),
        _ => frustum(Curved::frustum(dice.size(), dice.size(), dice.size())),
    }
}

fn frustum(made: Result<Curved, crate::shape::ShapeError>) -> Shape {
    Shape::Curved(made.expect("the sizes are good"))
}

fn sides(dice: &mut Dice) -> Vector {
    Vector::from_array([0; 3].map(|_| dice.size()))
}

/// The hull of random points, or a box.
fn hull(dice: &mut Dice) -> Hull {
    if dice.below(4) == 0 {
        return Hull::cuboid(sides(dice)).expect("the sides are positive");
    }
    loop {
        let stretch = sides(dice);
        let points: Vec<Vector> = (0..6 + dice.below(15)).map(|_| dice.vector(1.0).scale(stretch)).collect();
        if let Ok(hull) = Hull::convex_hull_of(&points) {
            return hull;
        }
    }
}

/// A random rotation.
pub(in super::super) fn rotation(dice: &mut Dice) -> Rot {
    Rot::from_axis_angle(dice.direction(), dice.between(-PI, PI))
}

/// A turn by quarters about one axis.
pub(in super::super) fn square_rotation(dice: &mut Dice) -> Rot {
    let axis = [Vector::X, Vector::Y, Vector::Z][dice.below(3)];
    Rot::from_axis_angle(axis, core::f32::consts::FRAC_PI_2 * dice.below(4) as f32)
}

/// The shape moved by a frame, if its points are its own.
pub(in super::super) fn in_frame(shape: &Shape, frame: &Pose) -> Option<Shape> {
    let go = |p: Vector| frame.transform(p);
    Some(match shape {
        Shape::Capsule(s) => Shape::Capsule(Capsule { a: go(s.a), b: go(s.b), radius: s.radius }),
        Shape::Segment(s) => Shape::Segment(Segment { a: go(s.a), b: go(s.b) }),
        Shape::Triangle(s) => Shape::Triangle(Triangle { a: go(s.a), b: go(s.b), c: go(s.c) }),
        Shape::Hull(s) => {
            let points = s.vertices().iter().map(|p| go(*p)).collect();
            let faces = s.faces().iter().map(|face| s.outline(face).to_vec()).collect();
            let moved = Hull::from_mesh(points, faces).and_then(|hull| hull.rounded(s.radius())).ok()?;
            Shape::Hull(Arc::new(moved))
        }
        _ => return None,
    })
}

/// The signed distance by brute force, of shapes with polyhedral cores.
pub(in super::super) fn exact(a: &Shape, b: &Shape, pose: &Pose) -> Option<f64> {
    let has_curves = |shape: &Shape| matches!(shape, Shape::Curved(_) | Shape::HalfSpace(_));
    if has_curves(a) || has_curves(b) {
        return None;
    }
    Some(Solid::new(a).signed_distance(&Solid::new(b).at(pose)))
}

/// A prediction distance that finds the contact.
pub(in super::super) fn far(_: &Shape, _: &Shape, _: &Pose) -> f32 {
    100.0
}

fn smaller(a: &Shape, b: &Shape) -> f64 {
    let extent = |shape: &Shape| match shape {
        Shape::HalfSpace(_) => f32::INFINITY,
        _ => shape.extent(Vector::ZERO),
    };
    f64::from(extent(a).min(extent(b)))
}

fn is_curved(a: &Shape, b: &Shape) -> bool {
    matches!((a, b), (Shape::Curved(_), _) | (_, Shape::Curved(_)))
}

fn is_line(shape: &Shape) -> bool {
    matches!(shape, Shape::Capsule(_) | Shape::Segment(_))
}

/// How much deeper than the best axis the found axis may be. Faces are preferred by 0.2 % of the extent, and
/// count as exact to 0.1 %. With frusta the search is accurate to 0.5 %, and it ends at 1 % of the depth.
/// Capsules that are nearly parallel touch along a line while its ends sway by less than a tenth of the
/// radii, so half of that to either side.
pub(in super::super) fn allowed(a: &Shape, b: &Shape, best: f64) -> f64 {
    if is_curved(a, b) {
        return 0.005 * smaller(a, b).min(4.0) + 0.01 * (-best).max(0.0) + 1.0e-4;
    }
    let sway = if is_line(a) && is_line(b) { 0.05 * f64::from(a.radius() + b.radius()) } else { 0.0 };
    POLYHEDRA + sway
}

/// The tolerance of polyhedra of a metre, as in the tests of single pairs.
const POLYHEDRA: f64 = 0.006;

/// How much less deep than the axis the points may be, as a share of the depth. A face may be preferred to
/// slightly better edges, and its deepest corner is then beside the face.
pub(in super::super) const BESIDE: f64 = 0.04;

/// Tolerance of the points' positions along the axis.
pub(in super::super) fn inexact(a: &Shape, b: &Shape) -> f64 {
    if is_curved(a, b) { 0.003 * smaller(a, b).min(4.0) + 1.0e-4 } else { POLYHEDRA }
}
