//! Shapes of space for the tests of characters.

use avian::{math::*, prelude::*};

/// A box with sides of the given lengths, in metres.
pub fn block(size: Vector) -> Collider {
    Collider::cuboid(size.x, size.y, size.z)
}

/// Characters 1.8 m tall.
pub fn figures() -> Vec<(&'static str, Collider)> {
    vec![
        ("capsule", Collider::capsule(0.4, 1.0)),
        ("cylinder", Collider::cylinder(0.4, 1.8)),
        ("box", block(Vector::new(0.8, 1.8, 0.8))),
    ]
}

/// The figures when they crouch: 1 m tall.
pub fn crouched(name: &str) -> Collider {
    match name {
        "capsule" => Collider::capsule(0.4, 0.2),
        "cylinder" => Collider::cylinder(0.4, 1.0),
        _ => block(Vector::new(0.8, 1.0, 0.8)),
    }
}

/// A surface 8 m wide through some points from left to right, of triangles.
pub fn terrain(points: &[Vector]) -> Collider {
    let sides = |p: &Vector| [*p - Vector::Z * 4.0, *p + Vector::Z * 4.0];
    let quads = 0..points.len() as u32 - 1;
    let triangles = quads.flat_map(|i| [[2 * i, 2 * i + 1, 2 * i + 2], [2 * i + 1, 2 * i + 3, 2 * i + 2]]);
    Collider::trimesh(points.iter().flat_map(sides).collect(), triangles.collect())
}

/// A direction across the way of the course.
pub const ASIDE: Vector = Vector::Z;

/// The rotation by an angle in radians from x to y.
pub fn turned(angle: Scalar) -> Rotation {
    Rotation(Quaternion::from_rotation_z(angle))
}

/// A direction at an angle in radians from x to y.
pub fn toward(angle: f32) -> Vector {
    Vector::new(angle.cos(), angle.sin(), 0.0)
}

/// A carousel.
pub mod spin {
    use avian::{math::*, prelude::*};

    pub const IS_LEVEL: bool = true;
    pub const START: Vector = Vector::new(9.0, 0.0, 0.0);

    pub fn disc() -> Collider {
        Collider::cylinder(10.0, 1.0)
    }

    pub fn velocity(speed: Scalar) -> Vector {
        Vector::Y * speed
    }
}

/// A planet.
pub fn ball(radius: Scalar) -> Collider {
    Collider::sphere(radius)
}

/// Half of a tube around a capsule: beside it.
pub mod groove {
    use avian::{math::*, prelude::*};

    pub const IS_UPRIGHT: bool = true;
    pub const START: Vector = Vector::new(0.0, 0.91, 0.0);
    pub const INTO: [Vector; 3] = [Vector::X, Vector::new(0.6, 0.0, 0.8), Vector::new(0.096, 0.0, -0.995)];

    pub fn tube(radius: Scalar, segments: u32) -> Collider {
        let corner = |i: u32, y: Scalar| {
            let angle = PI * (i as Scalar / segments as Scalar - 0.5);
            Vector::new(angle.cos() * radius, y, angle.sin() * radius)
        };
        let corners = (0..=segments).flat_map(|i| [corner(i, 0.0), corner(i, 3.0)]);
        let quads = 0..segments;
        let triangles =
            quads.flat_map(|i| [[2 * i, 2 * i + 2, 2 * i + 1], [2 * i + 1, 2 * i + 2, 2 * i + 3]]);
        Collider::trimesh(corners.collect(), triangles.collect())
    }
}
