//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 16] = [
    ("pyramid", 0x9ccf0c6cf6b6695c, 0xb14486e81d4f0dd2),
    ("towers", 0x336a6131c7c43b87, 0x3c93bfeb35fb9f0a),
    ("pairs", 0x320c38e9218a3afb, 0x2f83ed02d898e5af),
    ("heap", 0x2a382de8f2bbcc97, 0x9e4422916765b40c),
    ("terrain", 0x0bee4e077fb43edb, 0xf066f716014a28d4),
    ("slopes", 0xceeb2be8c61d33f7, 0x5f4ef7d1e443626b),
    ("composites", 0xadd4f489d519b19c, 0xa179e09f788010a1),
    ("bounces", 0xd0dbe2e7f5f7931d, 0x8b1db60addc1ccac),
    ("crowd", 0xa88d5f2fd813ac67, 0x9e65f98f76064420),
    ("sleepers", 0x11a7e509f33879ac, 0xc01ea51500453fee),
    ("held", 0xbc8a9eae06568e06, 0xf649a8c657994e99),
    ("dominance", 0x56225d2567b8f88f, 0x9d9ff9b8d85cb37f),
    ("spin", 0xfaa645cd4c170a08, 0x052e1ea342330b42),
    ("mixer", 0x5d7a160f7dbe1b40, 0x444109a21c47092c),
    ("changes", 0x45839dd1a3934850, 0x4076f188183ccc43),
    ("wall", 0x72fb2a3e454d9b6b, 0xd0d51cef5bfc2226),
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
