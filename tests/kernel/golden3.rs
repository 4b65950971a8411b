//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 16] = [
    ("pyramid", 0x0cd977a423a70691, 0x2fd11e3273ade0c7),
    ("towers", 0x77227f15c0f2b7a4, 0x1fb527836b9446be),
    ("pairs", 0x937e39b72f397cc3, 0x1621b40b84262850),
    ("heap", 0xfd18d7f8f9ddaf03, 0x19946d927716be10),
    ("terrain", 0xd83b68c0c913d89f, 0x512378020ca302b4),
    ("slopes", 0xd9260d6d0d79040d, 0xd75e520f983bbf5b),
    ("composites", 0x9af7998ea3c931b4, 0x8c68583eaf7b5b48),
    ("bounces", 0xc5aef0f99bfb08ba, 0x71d6f3024c14060c),
    ("crowd", 0xa0f5ccdd25c877b6, 0x8a57453f92e50847),
    ("sleepers", 0x134471faca94c0a7, 0x0f4342d68ab5ff95),
    ("held", 0x85db4ef8f0b28b66, 0xabd79cb794b9f46e),
    ("dominance", 0xd527df7eec75f931, 0x7c948e2e11080947),
    ("spin", 0xb9abd16315da0dc0, 0xd726cf4ed2b39606),
    ("mixer", 0x625b2a265cf44340, 0xc7612565d9aaa821),
    ("changes", 0x82f54361c26200f8, 0xc160073f8090743d),
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
