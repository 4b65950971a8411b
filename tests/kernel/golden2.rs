//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 16] = [
    ("pyramid", 0x3c103b5b2094c2fc, 0x0b47782973db8f16),
    ("towers", 0x336a6131c7c43b87, 0x3c93bfeb35fb9f0a),
    ("pairs", 0x8020af26c5df7d2a, 0xbdf4ad209b1f312d),
    ("heap", 0x39ab4cd85e62fdd2, 0x339e4097b6a02070),
    ("terrain", 0xb531d627d4eb9462, 0xa8c0ee5ba5bb9379),
    ("slopes", 0x2634ea1c50fa92be, 0x095c526519d98af3),
    ("composites", 0xf48788b578becd02, 0x4a1fcf905e68cb5a),
    ("bounces", 0xd75f534bbc4412a5, 0xf298cd8f033afa58),
    ("crowd", 0x06aa04c71c5e58c5, 0xa779cde94dbf5d9b),
    ("sleepers", 0xfff52539fcb5eb53, 0xe993caf12ca6f42f),
    ("held", 0xe021d101c1db82d3, 0x05c9312fbe351b96),
    ("dominance", 0xa9a2af842d0a7838, 0xc6eca1ee3b34ccbb),
    ("spin", 0xf69fdec85be218f0, 0xb861938d7db9994c),
    ("mixer", 0x1711cb41bc0ce06a, 0x291a4da6c06b7e62),
    ("changes", 0x9ebdc3f15283bddf, 0x286b325fc2b0b18c),
    ("wall", 0x881f75099109fb51, 0x21c96c053f029baf),
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
