//! Golden hashes in 2D, and 2D parts of their scenes. `golden3.rs` has those of 3D.

use crate::kernel::math::{Angular, Rot, Scalar, Vector, WorldVector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Hull, Segment, Shape, Triangle};
use std::sync::Arc;

/// For each scene the hash with world positions in `f32`, and in `f64`.
pub const GOLDEN: [(&str, u64, u64); 16] = [
    ("pyramid", 0x0fad8404d4e91331, 0xd7f42508165a3d9b),
    ("towers", 0x336a6131c7c43b87, 0x3c93bfeb35fb9f0a),
    ("pairs", 0x3609f511912a0d03, 0xbb50d3f6efeb44ca),
    ("heap", 0x6c6f0e0da057b750, 0xb6fffb65ccce9b55),
    ("terrain", 0x20f314b3180f0274, 0x9bff438a55528902),
    ("slopes", 0x913ceca04e19105b, 0xd0d163b9bd7f7c36),
    ("composites", 0x3538b9786c50845a, 0x43bf50d958679390),
    ("bounces", 0xba84722fc8b6360c, 0x1caf61fe47d4665b),
    ("crowd", 0x202a27a7702a5e02, 0x9c660f4ce34a9e9e),
    ("sleepers", 0x6a07ca5ed8e38c07, 0x86df4a07c29794f0),
    ("held", 0x6fa31700c1db7223, 0x7b1c8a1d43a52126),
    ("dominance", 0x7705da4057a98d62, 0x483e7d2c103d9eba),
    ("spin", 0x02616d48ea9ccbec, 0x91a8362e6aa5834c),
    ("mixer", 0x7cc15ea38052cc48, 0xee4c7d0aae363f58),
    ("changes", 0x83c52de642228cbe, 0xd8a731913c6d8c67),
    ("wall", 0x33a612e484424ff5, 0x1a5f4ae8646a8a38),
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
