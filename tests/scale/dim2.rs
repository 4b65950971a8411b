//! 2D parts of `scale.rs`. `scale3.rs` has those of 3D.

use avian::{
    math::{Scalar, Vector},
    parry::shape::{RoundShape, SharedShape, Triangle},
    prelude::*,
};
use bevy_math::{IVec2, Quat};

fn v(x: Scalar, y: Scalar) -> Vector {
    Vector::new(x, y)
}

/// A rectangle with the given sides.
pub fn cuboid(sides: Vector) -> Collider {
    Collider::rectangle(sides.x, sides.y)
}

/// A turn by three angles, of which 2D has one.
pub fn turn([about_z, ..]: [f32; 3]) -> Quat {
    Quat::from_rotation_z(about_z)
}

/// A triangle without symmetries.
pub fn lopsided() -> Collider {
    Collider::triangle(v(-0.4, -0.3), v(0.9, -0.1), v(0.2, 0.7))
}

/// One collider of each kind, none of them symmetric where it can be without, and whether an uneven
/// scale is exact.
pub fn shapes() -> Vec<(&'static str, Collider, bool)> {
    let [a, b, c] = [v(-0.4, -0.3), v(0.9, -0.1), v(0.2, 0.7)];
    let hull = vec![v(-0.2, -0.4), v(1.3, 0.2), v(1.1, 0.9), v(0.1, 1.2), v(-0.5, 0.3)];
    let mut heights: Collider = Collider::heightfield(vec![0.1, 0.6, -0.3, 0.2, 0.8], v(4.0, 1.0));
    let mut field = heights.shape().as_heightfield().expect("a height field").clone();
    field.set_segment_removed(1, true);
    heights.set_shape(SharedShape::new(field));
    let part = |x, y, angle: Scalar, collider| (v(x, y), Rotation::radians(angle), collider);
    vec![
        ("circle", Collider::circle(0.7), false),
        ("ellipse", Collider::ellipse(1.0, 0.4), true),
        ("capsule", Collider::capsule_endpoints(0.3, v(-0.5, 0.2), v(0.6, 0.9)), false),
        ("rectangle", Collider::rectangle(1.0, 2.0), true),
        ("round rectangle", Collider::round_rectangle(1.0, 2.0, 0.2), false),
        ("triangle", lopsided(), true),
        (
            "round triangle",
            SharedShape::new(RoundShape { inner_shape: Triangle::new(a, b, c), border_radius: 0.2 }).into(),
            false,
        ),
        ("pentagon", Collider::regular_polygon(0.8, 5), true),
        ("hexagon", Collider::regular_polygon(0.8, 6), true),
        ("hull", Collider::convex_hull(hull.clone()).expect("a hull"), true),
        ("round hull", SharedShape::round_convex_hull(&hull, 0.2).expect("a hull").into(), false),
        ("half-space", Collider::half_space(v(0.3, 0.8)), true),
        ("segment", Collider::segment(v(-1.0, 0.1), v(1.0, 0.4)), true),
        ("polyline", Collider::polyline(vec![v(-1.0, 0.0), v(0.2, 0.4), v(1.0, -0.3)], None), true),
        ("mesh", Collider::trimesh(vec![a, b, c, v(-0.8, 0.9)], vec![[0, 1, 2], [0, 2, 3]]), true),
        ("height field", heights, true),
        (
            "voxels",
            Collider::voxels(v(0.5, 0.3), &[IVec2::new(0, 0), IVec2::new(1, 0), IVec2::new(-3, 2)]),
            true,
        ),
        (
            "compound",
            Collider::compound(vec![
                part(1.0, 0.2, 0.0, cuboid(v(0.5, 0.9))),
                part(-0.6, 0.5, core::f32::consts::FRAC_PI_2 as Scalar, lopsided()),
            ]),
            true,
        ),
        (
            "turned compound",
            Collider::compound(vec![
                part(1.0, 0.2, 0.7, Collider::ellipse(0.9, 0.2)),
                part(-0.6, 0.5, -1.1, lopsided()),
            ]),
            false,
        ),
    ]
}
