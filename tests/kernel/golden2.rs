//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 18] = [
    ("pyramid", 0xda3efbe9ccf35fb6, 0x78d52ddd2fa77598),
    ("towers", 0x56f256b25e187317, 0x2bc7a364da062c3c),
    ("pairs", 0xa560c9accd5e41a3, 0x70f7e53e192e320b),
    ("heap", 0xb37bec0de6ac0e8d, 0x7f097526a7af1a33),
    ("terrain", 0x4f6b0b854303bac2, 0x770f0bdb02ba23d0),
    ("slopes", 0x743ca98c5abddd20, 0xbbaac89c02ac76f5),
    ("composites", 0x808ce203b7923fbc, 0xdedf11a27d34cc2f),
    ("bounces", 0x8eb9224e06cc1647, 0x65b756a55857f3c2),
    ("crowd", 0x97772030754c313e, 0xc57013057ba7db7c),
    ("sleepers", 0x8123a61c2e1f4724, 0xf84338b02e8ee25c),
    ("held", 0x4f2f5900cbeae18b, 0x9211a8b47476462a),
    ("dominance", 0x963d5fedb83bb4fa, 0x389c9733172a67d4),
    ("spin", 0xed67456ef08ed709, 0x60c9a8481b96b919),
    ("mixer", 0xb8cd16da9d80a52e, 0x32b20e2b293cd4e7),
    ("changes", 0x8a029d2a9c035904, 0x01db8db2209ebbe6),
    ("wall", 0xa51aa86ad759539a, 0x87c0a9e51682ce12),
    ("joints", 0x70b6a73cc4ddb17f, 0xfda33ce1d0b05e52),
    ("landing", 0xbe4c9592a5fa192f, 0xc739ee8aaa2704f4),
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
