//! 2D parts of the measurements.

use super::pairs::Dice;
use crate::kernel;
use kernel::math::{Rot, Vector, atan2};
use kernel::shape::{Hull, Shape};
use std::sync::Arc;

const TURN: f32 = core::f32::consts::TAU;

/// Any rotation.
pub fn rotation(dice: &mut Dice) -> Rot {
    Rot::from_angle(dice.between(0.0, TURN))
}

/// A rotation by at most an angle in radians.
pub fn small_turn(dice: &mut Dice, angle: f32) -> Rot {
    Rot::from_angle(dice.between(-angle, angle))
}

/// The normal of one of a shape's edges, or a random direction.
pub fn normal_of(shape: &Shape, dice: &mut Dice) -> Vector {
    match shape {
        Shape::Cuboid(_) => Vector::AXES[dice.pick(2)] * if dice.pick(2) == 0 { 1.0 } else { -1.0 },
        Shape::Hull(hull) => hull.normals()[dice.pick(hull.normals().len())],
        Shape::Capsule(c) => (c.b - c.a).perp() * (1.0 / (c.b - c.a).length()),
        _ => dice.direction(),
    }
}

/// The rotation that maps the second direction to the opposite of the first. In 2D there is only one.
pub fn facing([a, b]: [Vector; 2], _twisted: bool, _dice: &mut Dice) -> Rot {
    let b = -b;
    Rot::from_angle(atan2(f64::from(b.perp_dot(a)), f64::from(b.dot(a))) as f32)
}

/// A regular polygon with eight corners.
pub fn regular(_: &mut Dice) -> Shape {
    let corner = |i: usize| Rot::from_angle(i as f32 * TURN / 8.0).rotate(Vector::X * 0.55);
    let corners: Vec<Vector> = (0..8).map(corner).collect();
    Shape::Hull(Arc::new(Hull::from_convex(&corners, 0.0).expect("an octagon")))
}

/// A polygon with six corners on an ellipse.
pub fn rough(dice: &mut Dice) -> Shape {
    loop {
        let size = Vector { x: dice.between(0.4, 0.7), y: dice.between(0.4, 0.7) };
        let points: Vec<Vector> = (0..6).map(|_| dice.direction().scale(size)).collect();
        if let Ok(hull) = Hull::convex_hull_of(&points, 0.0)
            && hull.vertices().len() == 6
        {
            return Shape::Hull(Arc::new(hull));
        }
    }
}
