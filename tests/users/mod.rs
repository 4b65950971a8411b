//! Constraints and substep systems of the app.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

mod constraints;
mod lent;
mod xpbd;

pub use super::joints::{DT, G, MASS, Rig, at};

use avian::{math::Vector, prelude::*};
use bevy_ecs::prelude::*;

/// The sum of the momenta of rods, in kg·m/s.
fn momentum(rig: &Rig, rods: &[Entity]) -> Vector {
    rods.iter().map(|rod| rig.get::<LinearVelocity>(*rod).0 * MASS).sum()
}
