//! Golden hashes in the plane, and what their scenes must know of it. `golden3.rs` is the twin.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// Of each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 15] = [
    ("pyramid", 0x1169be6722c4fd76, 0xa5fc51df0a18d02f),
    ("towers", 0x336a6131c7c43b87, 0x3c93bfeb35fb9f0a),
    ("pairs", 0x7c367bf45a3fb2f3, 0xfc83740614445600),
    ("heap", 0x4980e524dfc30dcb, 0x3e8be53802ce7f40),
    ("terrain", 0x068bff9d114260ec, 0x9f2aed0593448629),
    ("slopes", 0x0d5c5cbf442d934e, 0x3c808d3393373d25),
    ("bounces", 0x9ef119889b9b880b, 0x78bc4eb8e97f310d),
    ("crowd", 0x0877983359f54e65, 0x6a81e7cd17a6756e),
    ("sleepers", 0x14da73a77021b0b9, 0x2b4e02af8ae77a48),
    ("held", 0x842b4067905f84a9, 0x4df59a91aede3929),
    ("dominance", 0x4d2c789e772c50e6, 0x9ff1678a1601ffa9),
    ("spin", 0x54f082a1e38ab179, 0x3243e204ed7ff7d7),
    ("mixer", 0xa1908f69e5053960, 0x4fe3196afc08144e),
    ("changes", 0xb0f4e1cdb556ec4d, 0xc9c8a91fe280f59f),
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
