//! Golden hashes in the plane, and what their scenes must know of it. `golden3.rs` is the twin.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// Of each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 15] = [
    ("pyramid", 0x1169be6722c4fd76, 0xa5fc51df0a18d02f),
    ("towers", 0x336a6131c7c43b87, 0x3c93bfeb35fb9f0a),
    ("pairs", 0x50984bc6ae6a1856, 0xa6452a0ca7208f69),
    ("heap", 0x51f2c403a892a711, 0xb2c765b7d0cde589),
    ("terrain", 0x7b14ddd257803b65, 0x3b390ac31ce7fabc),
    ("slopes", 0xb9f33cfbd4219d80, 0xafd226f664818146),
    ("bounces", 0xcc3b67d2ecd7557f, 0x1518841a99b571ad),
    ("crowd", 0x0877983359f54e65, 0x6a81e7cd17a6756e),
    ("sleepers", 0x14da73a77021b0b9, 0x2b4e02af8ae77a48),
    ("held", 0x3abcbaed2ef8692a, 0xcb517bada9b91eda),
    ("dominance", 0x7325665178fa4e68, 0x43815c1a224e6220),
    ("spin", 0xa4f9fa0342a6d6b9, 0xcb52f73e72152ea3),
    ("mixer", 0xfe0fa13575f48507, 0x4a72805d52ca9045),
    ("changes", 0x9756d4b44c4fcef5, 0xe0ff3fb2f315cf3d),
    ("wall", 0x963e42667bf00eb8, 0x487f668b590a9079),
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

/// A rotation unlike that of any axis.
pub fn tilted(angle: f32) -> Rot {
    Rot::from_angle(angle)
}

/// An angular velocity of which the plane has the last part.
pub fn spun(_x: f32, _y: f32, z: f32) -> Angular {
    Angular { z }
}

/// The numbers of a place in the world.
pub fn coordinates(p: WorldVector) -> Vec<Scalar> {
    vec![p.x, p.y]
}

/// The numbers of a rotation and an angular velocity.
pub fn numbers(rotation: Rot, angular: Angular) -> Vec<f32> {
    vec![rotation.cos, rotation.sin, angular.z]
}
