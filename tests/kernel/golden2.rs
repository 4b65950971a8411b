//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 16] = [
    ("pyramid", 0x3e759d240f18a04d, 0x5dc22ffb4a22d159),
    ("towers", 0x336a6131c7c43b87, 0x3c93bfeb35fb9f0a),
    ("pairs", 0xcbdcc27340e9c232, 0xcd79de4482c1cafe),
    ("heap", 0xe870297355e5c5e2, 0x070bcc1b02b7f062),
    ("terrain", 0xaa916521f21434cd, 0x9df68ca2c64abe06),
    ("slopes", 0x91d4e892977478c8, 0x49bb2e51e924c161),
    ("composites", 0xd2c7d5b6c1c2a59e, 0x0916d9a08dcc2317),
    ("bounces", 0x4dc01ed152587853, 0xd1f87301bd2499e3),
    ("crowd", 0xfe081d6933445d8d, 0xee020b000406ccc6),
    ("sleepers", 0xa5e7442ed1b1a9ad, 0x533b356073f70c23),
    ("held", 0xca5b2fccb7750088, 0x6e4e49fd733e99da),
    ("dominance", 0xe9347ad63c572c20, 0x7acc7e76f934c542),
    ("spin", 0x2582868313faa98a, 0x722dbf796588edb6),
    ("mixer", 0xe1d6ffe697ba75f1, 0xfa6a65aa155288af),
    ("changes", 0x214b490d76b112da, 0x3d9aef4b222b40f9),
    ("wall", 0x0ea15e411f136317, 0xb211a24eea482915),
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
