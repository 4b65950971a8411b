//! Golden hashes in space, and what their scenes must know of it. `golden2.rs` is the twin.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// Of each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 15] = [
    ("pyramid", 0x50ba4e573fc131ae, 0x28da225a0e1b1bfd),
    ("towers", 0x3a9ff86f9ee73c38, 0xe867d70b3fec41d6),
    ("pairs", 0x6fcc085a2548ac79, 0x8dde9dc3510b7a9d),
    ("heap", 0xc31beea11bed0ccc, 0x98f85926156d4de8),
    ("terrain", 0x773a436487e961e7, 0xfff447b604932685),
    ("slopes", 0xb2b7e1a2a9c2c8e7, 0xb33344901f916a39),
    ("bounces", 0x12771e180e55180b, 0x8e931a8bfd1adcc0),
    ("crowd", 0x759e70a52046e7b7, 0x5b9b20e7dcd798dd),
    ("sleepers", 0x4af136ad24ebf72d, 0xefc862f8254dc6e6),
    ("held", 0xdb6ba6d18773966f, 0x6f5f56a7f315cdb3),
    ("dominance", 0x3c1ecc1c2896b55b, 0x41eee5015924c929),
    ("spin", 0x9f770b1b6b01d17c, 0x8921691fadc56c20),
    ("mixer", 0xfc6fefd43a8bbc07, 0xe527530990172e06),
    ("changes", 0x01c6cb4e272ed17f, 0x7f08e7ae83c9d2dd),
    ("wall", 0x4158449ef80a4a27, 0x45666fdbd4d3d554),
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

/// A rotation unlike that of any axis.
pub fn tilted(angle: f32) -> Rot {
    Rot::from_axis_angle(Vector { x: 2.0 / 3.0, y: 1.0 / 3.0, z: 2.0 / 3.0 }, angle)
}

/// An angular velocity.
pub fn spun(x: f32, y: f32, z: f32) -> Angular {
    Vector { x, y, z }
}

/// The numbers of a place in the world.
pub fn coordinates(p: WorldVector) -> Vec<Scalar> {
    vec![p.x, p.y, p.z]
}

/// The numbers of a rotation and an angular velocity.
pub fn numbers(rotation: Rot, angular: Angular) -> Vec<f32> {
    vec![rotation.x, rotation.y, rotation.z, rotation.w, angular.x, angular.y, angular.z]
}
