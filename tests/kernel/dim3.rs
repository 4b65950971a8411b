//! What a test must know of space.

use super::extreme::Dice;
use crate::kernel::math::{Angular, InvInertia, Rot, Vector};
use crate::kernel::shape::{Cuboid, Hull, MassProperties, Shape};
use std::sync::Arc;

/// The inverse inertia of a body.
pub fn inverse_inertia(mass: &MassProperties) -> InvInertia {
    mass.inertia.inverse()
}

/// The rotation by an angle in the plane of x and y.
pub fn turned(angle: f32) -> Rot {
    Rot::from_axis_angle(Vector::Z, angle)
}

/// The part of an angular velocity in the plane of x and y.
pub fn spin_of(w: Angular) -> f32 {
    w.z
}

/// An angular velocity in the plane of x and y.
pub fn spin(z: f32) -> Angular {
    Vector { x: 0.0, y: 0.0, z }
}

/// A box of the given size.
pub fn sized(x: f32, y: f32, depth: f32) -> Vector {
    Vector { x, y, z: depth }
}

/// The moment of inertia of a solid ball over m r².
pub const BALL_INERTIA: f32 = 0.4;

/// The kinetic energy of turning.
pub fn spin_energy(inverse: InvInertia, rotation: Rot, w: Angular) -> f64 {
    let local = rotation.inverse_rotate(w);
    0.5 * f64::from(local.dot(inverse.inverse().apply(local)))
}

/// A closed box of 4 by 4 by 4 metres on y = 0: half its width, its walls by size and place, and the middles
/// of its cells of a metre.
pub fn container() -> (f32, Vec<(Vector, Vector)>, Vec<Vector>) {
    let walls = [Vector::X, Vector::Y, Vector::Z].into_iter().flat_map(|axis| {
        let size = Vector::ONE * 12.0 - axis * 8.0;
        [-4.0, 4.0].map(|side| (size, Vector::Y * 2.0 + axis * side))
    });
    let cell = |i: i32| (i % 4) as f32 + 0.5;
    let cells = (0..64).map(|i| Vector { x: cell(i) - 2.0, y: cell(i / 16), z: cell(i / 4) - 2.0 });
    (2.0, walls.collect(), cells.collect())
}

/// A position's part across the plane of x and y.
pub fn across(p: Vector) -> f32 {
    p.z
}

/// A rotation from dice.
pub fn any_rotation(dice: &mut Dice) -> Rot {
    Rot { x: dice.signed(), y: dice.signed(), z: dice.signed(), w: dice.signed() + 1.5 }.normalized()
}

/// An angular velocity from dice, of any length.
pub fn any_spin(dice: &mut Dice) -> Angular {
    Vector { x: dice.signed(), y: dice.signed(), z: dice.signed() }
}

/// A hull of the given half extents: an octahedron.
pub fn hull_of(half: Vector) -> Shape {
    let points: Vec<_> = Vector::AXES.into_iter().flat_map(|a| [a.scale(half), a.scale(-half)]).collect();
    Hull::convex_hull_of(&points).map_or(Shape::Cuboid(Cuboid { half }), |hull| Shape::Hull(Arc::new(hull)))
}

/// Unit axes about which a level plate can be tilted.
pub fn tilts() -> Vec<Angular> {
    let skew = Vector { x: 2.0, y: 1.0, z: 2.0 } * (1.0 / 3.0);
    vec![Vector::X, Vector::Z, skew]
}

/// The axis upright on a level plate.
pub fn upright() -> Option<Angular> {
    Some(Vector::Y)
}
