//! Golden hashes in 3D, and 3D parts of their scenes. `golden2.rs` has those of 2D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 16] = [
    ("pyramid", 0x333833886b7339c0, 0xf9ade9eee6dd1582),
    ("towers", 0x7f620009233a6fbc, 0x3a97fc5b3ba0b802),
    ("pairs", 0x091e871bada0579a, 0xa15b0b1af9aaa818),
    ("heap", 0x5fdaabae4d9c22cb, 0xa99513d20d082246),
    ("terrain", 0x8cbfd1c080c31f18, 0xd6f296a8d1ecb124),
    ("slopes", 0xd6e4f1ee41de6f8e, 0xb114a784484e31c1),
    ("composites", 0x64f33dd0154cf11e, 0x78254b3436bc7673),
    ("bounces", 0x747b83c12ce946dc, 0xa4a95cf905b53029),
    ("crowd", 0x877e6a1eab9e4fce, 0x348bb1cbd847b35b),
    ("sleepers", 0x8fb8ae44c64dfbcb, 0x7330668fa8341f0e),
    ("held", 0xec19575c47e85fc1, 0xd1e329f79e764512),
    ("dominance", 0x2c75a5132aa4dfb1, 0x8120847053575a23),
    ("spin", 0x612b5b8add5704c6, 0x7822855a93a648a6),
    ("mixer", 0xb14533ba421d2fdb, 0xbb79336006c5004e),
    ("changes", 0xd44b18e2374782b4, 0x9d42884b2727cb01),
    ("wall", 0xba1f75a1d636afcb, 0xa379885ebebe7825),
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
