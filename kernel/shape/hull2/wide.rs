//! Vectors in `f64`: shapes are checked and measured in full precision when they are made.

use crate::math::Vector;

/// A point or vector in `f64`.
pub(in crate::shape) type Point = [f64; 2];

pub(in crate::shape) fn wide(v: Vector) -> Point {
    [f64::from(v.x), f64::from(v.y)]
}

pub(in crate::shape) fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(in crate::shape) fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

pub(in crate::shape) fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

pub(in crate::shape) fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}
