//! The shapes of 2D whose outlines are tested.

use crate::{
    collision::collider::Collider,
    math::{Scalar, Vector},
};

fn v(x: Scalar, y: Scalar) -> Vector {
    Vector::new(x, y)
}

/// Names, colliders, and how far inside their boxes the outlines may end, in metres.
pub(in crate::debug_render) fn shapes() -> Vec<(&'static str, Collider, f32)> {
    let hull = vec![v(0.0, 0.0), v(2.0, 0.2), v(2.5, 1.0), v(1.0, 2.0), v(-0.5, 1.0)];
    vec![
        ("circle", Collider::circle(0.7), 0.0),
        ("capsule", Collider::capsule_endpoints(0.3, v(-0.5, 0.2), v(0.6, 0.9)), 0.0),
        ("rectangle", Collider::rectangle(1.0, 2.0), 0.0),
        ("round rectangle", Collider::round_rectangle(1.0, 2.0, 0.2), 0.0),
        ("triangle", Collider::triangle(v(0.0, 0.0), v(1.0, 0.1), v(0.3, 0.9)), 0.0),
        ("ellipse", Collider::ellipse(1.0, 0.4), 0.0),
        ("regular polygon", Collider::regular_polygon(0.8, 5), 0.0),
        ("hull", Collider::convex_hull(hull).expect("a hull"), 0.0),
        ("segment", Collider::segment(v(-1.0, 0.0), v(1.0, 0.4)), 0.0),
        ("polyline", Collider::polyline(vec![v(-1.0, 0.0), v(0.0, 0.4), v(1.0, 0.0)], None), 0.0),
        ("height field", Collider::heightfield(vec![0.0, 0.5, 0.2, 0.3], v(4.0, 1.0)), 0.0),
    ]
}

/// The shape that a rounded collider is built on, and its radius, where it must be known.
pub(in crate::debug_render) fn core_of(collider: &Collider) -> (Collider, Scalar) {
    (collider.clone(), 0.0)
}
