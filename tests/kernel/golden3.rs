//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 16] = [
    ("pyramid", 0x0cd977a423a70691, 0x2fd11e3273ade0c7),
    ("towers", 0x77227f15c0f2b7a4, 0x1fb527836b9446be),
    ("pairs", 0x5359d399a8a1eee2, 0x504e4ec8532ed717),
    ("heap", 0xd89d2552e4a63228, 0xe963815491902dc6),
    ("terrain", 0x93926bd9f72c2b73, 0xd160b15745ef2dc3),
    ("slopes", 0x9f219452b5f952bc, 0x893810da8f7d8547),
    ("composites", 0x4a77d12fa287a36b, 0x8fc0bc595d4ab5f4),
    ("bounces", 0x240bf38c07beba89, 0x8e13c03c18d42411),
    ("crowd", 0x18552c6233050780, 0xbd6e4b0a69117277),
    ("sleepers", 0x134471faca94c0a7, 0x0f4342d68ab5ff95),
    ("held", 0xba4fb77758a95510, 0xa0e5f06c93a895b5),
    ("dominance", 0xee57c9df26653388, 0xf18444edace0be3f),
    ("spin", 0x3734291bd4e9a78b, 0x727a89af482f7b2d),
    ("mixer", 0xa434b15a58dda560, 0xb5d25adfb1d01fcb),
    ("changes", 0x7f132a1611a498ca, 0x8c0041eafb76a6ad),
    ("wall", 0x1028373799604f93, 0x71ef62c95bd824d2),
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
