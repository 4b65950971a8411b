//! Vectors in `f64`: shapes are checked and measured in full precision when they are made.

use crate::math::Vector;

/// A point or vector in `f64`.
pub(super) type Wide = Vector<f64>;

pub(super) fn widen(v: Vector) -> Wide {
    Wide { x: f64::from(v.x), y: f64::from(v.y), z: f64::from(v.z) }
}

pub(super) fn narrow(v: Wide) -> Vector {
    Vector { x: v.x as f32, y: v.y as f32, z: v.z as f32 }
}
