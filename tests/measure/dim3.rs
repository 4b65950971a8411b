//! 3D parts of the measurements.

use super::pairs::Dice;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Hull, Shape};
use std::sync::Arc;

const TURN: f32 = core::f32::consts::TAU;

/// Any rotation.
pub fn rotation(dice: &mut Dice) -> Rot {
    Rot::from_axis_angle(dice.direction(), dice.between(0.0, TURN))
}

/// A rotation by at most an angle in radians.
pub fn small_turn(dice: &mut Dice, angle: f32) -> Rot {
    Rot::from_axis_angle(dice.direction(), dice.between(-angle, angle))
}

/// The normal of one of a shape's faces, or a random direction.
pub fn normal_of(shape: &Shape, dice: &mut Dice) -> Vector {
    match shape {
        Shape::Cuboid(_) => Vector::AXES[dice.pick(3)] * if dice.pick(2) == 0 { 1.0 } else { -1.0 },
        Shape::Hull(hull) => hull.faces()[dice.pick(hull.faces().len())].normal,
        Shape::Capsule(c) => (c.b - c.a).cross(dice.direction()) * 1.0,
        _ => dice.direction(),
    }
}

/// The rotation that maps the second direction to the opposite of the first, with a random rotation about it
/// if `twisted`.
pub fn facing([a, b]: [Vector; 2], twisted: bool, dice: &mut Dice) -> Rot {
    let (a, b) = (a * (1.0 / a.length()), b * (-1.0 / b.length()));
    // Half of a rotation is the mean of the unit quaternions of the identity and the full rotation.
    let w = 1.0 + a.dot(b);
    let axis = b.cross(a);
    let turn = if w > 1.0e-3 {
        Rot { x: axis.x, y: axis.y, z: axis.z, w }.normalized()
    } else {
        Rot::from_axis_angle(a.any_orthonormal(), 0.5 * TURN)
    };
    let angle = if twisted { dice.between(0.0, TURN) } else { 0.0 };
    Rot::from_axis_angle(a, angle).mul(turn)
}

/// A body with twenty triangles and twelve corners, about 0.57 m from its centre.
pub fn regular(_: &mut Dice) -> Shape {
    let g = 0.5 * (1.0 + 5.0f32.sqrt());
    let mut points = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        let at = |x: f32, y: f32, z: f32| Vector { x, y, z } * 0.3;
        points.extend([at(0.0, a, b), at(a, b, 0.0), at(b, 0.0, a)]);
    }
    Shape::Hull(Arc::new(Hull::convex_hull_of(&points).expect("an icosahedron")))
}

/// A hull with twelve corners on an ellipsoid.
pub fn rough(dice: &mut Dice) -> Shape {
    loop {
        let size = Vector { x: dice.between(0.4, 0.7), y: dice.between(0.4, 0.7), z: dice.between(0.4, 0.7) };
        let points: Vec<Vector> = (0..12).map(|_| dice.direction().scale(size)).collect();
        if let Ok(hull) = Hull::convex_hull_of(&points)
            && hull.vertices().len() == 12
        {
            return Shape::Hull(Arc::new(hull));
        }
    }
}
