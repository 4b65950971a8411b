//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 16] = [
    ("pyramid", 0x6b1d593d1d833b90, 0x2506e634dab0dedc),
    ("towers", 0x3a9ff86f9ee73c38, 0xe867d70b3fec41d6),
    ("pairs", 0x69c4df11a20db163, 0x737c479f4e038b11),
    ("heap", 0x512f2c540bca542a, 0xace1a9d0f29f929d),
    ("terrain", 0x13ef532cc8baa6b9, 0x349e4b1a0838479e),
    ("slopes", 0x40a2750f383df72a, 0xcdb342ffdc46f176),
    ("composites", 0x5f79012dad946932, 0xdf0df2c7a9a77705),
    ("bounces", 0x1e71a420104696f1, 0x0c6f5e322d671856),
    ("crowd", 0xd38267a58f1adb4c, 0xdc60372e508fd4fb),
    ("sleepers", 0xf4473220c9a00337, 0xae8df2df26dd9ae0),
    ("held", 0xfe726f44f01a4a34, 0x9ce698203bb8b81d),
    ("dominance", 0xf505b7918c3abc39, 0xbb036623efa451b8),
    ("spin", 0x5d402681a654cae0, 0x39112990f39205a8),
    ("mixer", 0xf9da5c12cfe327ac, 0x6291b51c59a6fa9f),
    ("changes", 0xfe2a30840f061f39, 0x8624181d025ae9e6),
    ("wall", 0xb5daf7da214e4a92, 0xdf7dd8146ba8abac),
];

/// Every native shape with bounds, each about a metre across.
pub fn shapes() -> Vec<Shape> {
    let v = |x, y, z| Vector { x, y, z };
    let hull = |points: &[Vector]| {
        Shape::Hull(Arc::new(Hull::convex_hull_of(points).expect("the points span a polyhedron")))
    };
    let rock = [
        v(-0.5, -0.3, -0.2),
        v(0.1, -0.5, 0.3),
        v(0.55, -0.1, -0.4),
        v(0.4, 0.4, 0.2),
        v(-0.2, 0.55, -0.1),
        v(-0.3, 0.0, 0.5),
        v(0.0, 0.2, -0.55),
    ];
    vec![
        Shape::Ball(Ball { radius: 0.45 }),
        Shape::Capsule(Capsule { a: v(-0.3, -0.05, 0.1), b: v(0.3, 0.05, -0.1), radius: 0.25 }),
        Shape::Cuboid(Cuboid { half: v(0.45, 0.35, 0.4) }),
        hull(&rock),
        hull(&[v(-0.4, -0.3, -0.3), v(0.4, -0.3, -0.3), v(0.0, -0.3, 0.5), v(0.0, 0.5, 0.0)]),
        Shape::Triangle(Triangle { a: v(-0.5, -0.1, -0.4), b: v(0.5, 0.0, -0.4), c: v(0.1, 0.1, 0.5) }),
        Shape::Segment(Segment { a: v(-0.5, 0.0, 0.1), b: v(0.5, 0.1, -0.1) }),
    ]
}

/// The half-spaces of a trough, six metres wide and four deep, open above.
pub fn trough() -> Vec<(Shape, Vector)> {
    let plane = |x, y, z| Shape::HalfSpace(HalfSpace { normal: Vector { x, y, z } });
    vec![
        (plane(0.6, 0.8, 0.0), Vector::X * -3.0),
        (plane(-1.0, 0.0, 0.0), Vector::X * 3.0),
        (plane(0.0, 0.8, 0.6), Vector::Z * -2.0),
        (plane(0.0, 0.0, -1.0), Vector::Z * 2.0),
        (plane(0.0, 1.0, 0.0), Vector::ZERO),
    ]
}

/// Ground of triangles and, along its middle, segments, eight metres each way.
pub fn terrain() -> Vec<Shape> {
    let height = |i: i32, k: i32| ((i * i + 2 * k * k) % 5) as f32 * 0.15;
    let corner = |i: i32, k: i32| Vector { x: i as f32, y: height(i, k), z: k as f32 };
    let mut parts = Vec::new();
    for i in -8..8 {
        for k in -2..2 {
            let [a, b, c, d] = [corner(i, k), corner(i + 1, k), corner(i + 1, k + 1), corner(i, k + 1)];
            parts.push(Shape::Triangle(Triangle { a, b: c, c: b }));
            parts.push(Shape::Triangle(Triangle { a, b: d, c }));
        }
        parts.push(Shape::Segment(Segment {
            a: corner(i, 0) + Vector::Y * 0.3,
            b: corner(i + 1, 0) + Vector::Y * 0.3,
        }));
    }
    parts
}

/// A rotation about no special axis.
pub fn tilted(angle: f32) -> Rot {
    Rot::from_axis_angle(Vector { x: 2.0 / 3.0, y: 1.0 / 3.0, z: 2.0 / 3.0 }, angle)
}

/// An angular velocity.
pub fn spun(x: f32, y: f32, z: f32) -> Angular {
    Vector { x, y, z }
}

/// The coordinates of a position.
pub fn coordinates(p: WorldVector) -> Vec<Scalar> {
    vec![p.x, p.y, p.z]
}

/// The components of a rotation and an angular velocity.
pub fn numbers(rotation: Rot, angular: Angular) -> Vec<f32> {
    vec![rotation.x, rotation.y, rotation.z, rotation.w, angular.x, angular.y, angular.z]
}
