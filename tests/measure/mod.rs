//! Measurements of the narrow phase and of contact records, for both dimensions.

mod contacts;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
pub mod pairs;

pub use contacts::Contacts;
pub use pairs::{MIXED, PREDICTION, pairs};

use crate::kernel;
use kernel::math::Vector;
use kernel::shape::{Ball, Capsule, Cuboid, Shape};
use pairs::Dice;

/// Shapes of about a metre.
pub type Make = fn(&mut Dice) -> Shape;

/// A ball.
pub fn ball(dice: &mut Dice) -> Shape {
    Shape::Ball(Ball { radius: dice.between(0.3, 0.6) })
}

/// A box.
pub fn cuboid(dice: &mut Dice) -> Shape {
    let half = Vector::AXES.iter().fold(Vector::ZERO, |v, axis| v + *axis * dice.between(0.35, 0.65));
    Shape::Cuboid(Cuboid { half })
}

/// A capsule.
pub fn capsule(dice: &mut Dice) -> Shape {
    let end = dice.direction() * dice.between(0.2, 0.5);
    Shape::Capsule(Capsule { a: -end, b: end, radius: dice.between(0.1, 0.3) })
}

/// The measured pairs: names and shapes.
pub const KINDS: [(&str, Make, Make); 9] = [
    ("box, box", cuboid, cuboid),
    ("regular hulls", dim::regular, dim::regular),
    ("rough hulls", dim::rough, dim::rough),
    ("box, rough hull", cuboid, dim::rough),
    ("box, capsule", cuboid, capsule),
    ("box, ball", cuboid, ball),
    ("capsules", capsule, capsule),
    ("capsule, ball", capsule, ball),
    ("balls", ball, ball),
];
