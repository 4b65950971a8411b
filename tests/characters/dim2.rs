//! Shapes of the plane for the tests of characters.

use avian::{math::*, prelude::*};

/// A box with sides of the given lengths, in metres.
pub fn block(size: Vector) -> Collider {
    Collider::rectangle(size.x, size.y)
}

/// Characters 1.8 m tall.
pub fn figures() -> Vec<(&'static str, Collider)> {
    vec![("capsule", Collider::capsule(0.4, 1.0)), ("box", block(Vector::new(0.8, 1.8)))]
}

/// The figures when they crouch: 1 m tall.
pub fn crouched(name: &str) -> Collider {
    if name == "capsule" { Collider::capsule(0.4, 0.2) } else { block(Vector::new(0.8, 1.0)) }
}

/// A surface through some points from left to right.
pub fn terrain(points: &[Vector]) -> Collider {
    Collider::polyline(points.to_vec(), None)
}

/// A direction across the way of the course.
pub const ASIDE: Vector = Vector::ZERO;

/// The rotation by an angle in radians from x to y.
pub fn turned(angle: Scalar) -> Rotation {
    Rotation::radians(angle)
}

/// A direction at an angle in radians from x to y.
pub fn toward(angle: f32) -> Vector {
    Vector::new(angle.cos(), angle.sin())
}

/// A wheel: in the plane nothing turns about `up`.
pub mod spin {
    use avian::{math::*, prelude::*};

    pub const IS_LEVEL: bool = false;
    pub const START: Vector = Vector::ZERO;

    pub fn disc() -> Collider {
        Collider::rectangle(20.0, 1.0)
    }

    pub fn velocity(speed: Scalar) -> Scalar {
        speed
    }
}

/// A planet.
pub fn ball(radius: Scalar) -> Collider {
    Collider::circle(radius)
}

/// Half of a tube around a capsule: below it.
pub mod groove {
    use avian::{math::*, prelude::*};

    pub const IS_UPRIGHT: bool = false;
    pub const START: Vector = Vector::new(0.0, 0.5);
    pub const INTO: [Vector; 2] = [Vector::X, Vector::NEG_X];

    pub fn tube(radius: Scalar, segments: u32) -> Collider {
        let corner = |i: u32| {
            let angle = PI * (1.0 + i as Scalar / segments as Scalar);
            Vector::new(angle.cos(), angle.sin()) * radius
        };
        // Higher than a step.
        let [left, right] = [-radius, radius].map(|x| Vector::new(x, 1.0));
        let corners = core::iter::once(left).chain((0..=segments).map(corner)).chain([right]);
        Collider::polyline(corners.collect(), None)
    }
}
