//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 16] = [
    ("pyramid", 0x195de7492de7fd13, 0x834c47e39ba1c7e6),
    ("towers", 0x336a6131c7c43b87, 0x3c93bfeb35fb9f0a),
    ("pairs", 0x615c77170e9320bf, 0xada0c19d52709956),
    ("heap", 0xb2364e7ccca08cf5, 0x9e5c8ec78580397a),
    ("terrain", 0xaefe31cd0aada3c8, 0x180021e2464b67e2),
    ("slopes", 0x1decc29b3e0789df, 0xc8a6d90e793689c4),
    ("composites", 0x70a6d9c071804ede, 0x2cdb7dfc8bcc9577),
    ("bounces", 0x95d4ef4b3dd0b945, 0xcf45bbc0923c201e),
    ("crowd", 0xc04a44a095c0f33e, 0x3d4b837b34a60450),
    ("sleepers", 0x1604e5e7a9d43c8c, 0xbd10e01e91a7c763),
    ("held", 0x73e64c29080601de, 0x956afaa021748637),
    ("dominance", 0x9afc6e17f0043895, 0x4b9e89205c7fbb3f),
    ("spin", 0x027235851f29c8ff, 0xda1659457655d698),
    ("mixer", 0x835adb433c704d0d, 0x18b4d4dd6d5ed11d),
    ("changes", 0x88aa6c2ca4dc5ffd, 0xc1ad2eb975ae401d),
    ("wall", 0x2889c0ad899b79ab, 0xd46a8162f2b68e1b),
];

/// Every native shape with bounds, each about a metre across.
pub fn shapes() -> Vec<Shape> {
    let v = |x, y| Vector { x, y };
    let hull = |points: &[Vector], radius| {
        Shape::Hull(Arc::new(Hull::convex_hull_of(points, radius).expect("the points span a polygon")))
    };
    vec![
        Shape::Ball(Ball { radius: 0.45 }),
        Shape::Capsule(Capsule { a: v(-0.3, -0.05), b: v(0.3, 0.05), radius: 0.25 }),
        Shape::Cuboid(Cuboid { half: v(0.45, 0.35) }),
        hull(&[v(-0.5, -0.3), v(0.1, -0.5), v(0.55, -0.1), v(0.4, 0.4), v(-0.2, 0.55)], 0.0),
        hull(&[v(-0.3, -0.3), v(0.4, -0.2), v(0.1, 0.4)], 0.1),
        Shape::Triangle(Triangle { a: v(-0.5, -0.4), b: v(0.5, -0.4), c: v(0.1, 0.5) }),
        Shape::Segment(Segment { a: v(-0.5, 0.0), b: v(0.5, 0.1) }),
    ]
}

/// The half-spaces of a trough, six metres wide and open above.
pub fn trough() -> Vec<(Shape, Vector)> {
    let plane = |normal| Shape::HalfSpace(HalfSpace { normal });
    vec![
        (plane(Vector { x: 0.6, y: 0.8 }), Vector::X * -3.0),
        (plane(Vector { x: -1.0, y: 0.0 }), Vector::X * 3.0),
        (plane(Vector::Y), Vector::ZERO),
    ]
}

/// Ground of triangles and segments without thickness, eight metres each way.
pub fn terrain() -> Vec<Shape> {
    let height = |i: i32| (i * i % 5) as f32 * 0.15;
    let corner = |i: i32| Vector { x: i as f32, y: height(i) };
    let part = |i: i32| {
        let (a, b) = (corner(i), corner(i + 1));
        if i % 2 == 0 {
            Shape::Segment(Segment { a, b })
        } else {
            Shape::Triangle(Triangle { a, b, c: (a + b) * 0.5 - Vector::Y })
        }
    };
    (-8..8).map(part).collect()
}

/// A rotation by no special angle.
pub fn tilted(angle: f32) -> Rot {
    Rot::from_angle(angle)
}

/// An angular velocity; 2D uses the last component.
pub fn spun(_x: f32, _y: f32, z: f32) -> Angular {
    Angular { z }
}

/// The coordinates of a position.
pub fn coordinates(p: WorldVector) -> Vec<Scalar> {
    vec![p.x, p.y]
}

/// The components of a rotation and an angular velocity.
pub fn numbers(rotation: Rot, angular: Angular) -> Vec<f32> {
    vec![rotation.cos, rotation.sin, angular.z]
}
