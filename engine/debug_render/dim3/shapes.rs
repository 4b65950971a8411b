//! The shapes of 3D whose outlines are tested.

use crate::{
    collision::collider::Collider,
    math::{Scalar, Vector},
    parry::shape::{RoundCone, RoundCylinder, SharedShape},
};

fn v(x: Scalar, y: Scalar, z: Scalar) -> Vector {
    Vector::new(x, y, z)
}

/// The part of a radius by which the outline of a tilted capsule may end inside its box: three circles at
/// right angles reach at least √(2/3) of the radius in every direction.
const THREE_CIRCLES: f32 = 0.1836;

/// The same part for a rounded edge or corner between lines at √½ of the radius from its middle.
const ROUNDED_EDGE: f32 = 0.2929;

/// Names, colliders, and how far inside their boxes the outlines may end, in metres.
pub(in crate::debug_render) fn shapes() -> Vec<(&'static str, Collider, f32)> {
    let part = |i: u32, factor: u32| (i * factor % 23) as Scalar / 11.0 - 1.0;
    let hull: Vec<Vector> = (0..24).map(|i| v(part(i, 5), part(i, 7), part(i, 11))).collect();
    let [a, b, c] = [v(0.0, 0.0, 0.0), v(1.0, 0.1, 0.0), v(0.3, 0.9, 0.4)];
    vec![
        ("sphere", Collider::sphere(0.7), 0.0),
        (
            "capsule",
            Collider::capsule_endpoints(0.3, v(-0.5, 0.2, 0.0), v(0.6, 0.9, 0.3)),
            THREE_CIRCLES * 0.3,
        ),
        ("cuboid", Collider::cuboid(1.0, 2.0, 0.5), 0.0),
        ("round cuboid", Collider::round_cuboid(1.0, 2.0, 0.5, 0.2), 0.0),
        ("triangle", Collider::triangle(a, b, c), 0.0),
        ("round triangle", SharedShape::round_triangle(a, b, c, 0.2).into(), ROUNDED_EDGE * 0.2),
        ("cylinder", Collider::cylinder(0.5, 2.0), 0.0),
        (
            "round cylinder",
            SharedShape::new(RoundCylinder {
                inner_shape: crate::parry::shape::Cylinder::new(1.0, 0.5),
                border_radius: 0.2,
            })
            .into(),
            0.0,
        ),
        ("cone", Collider::cone(0.5, 2.0), 0.0),
        (
            "round cone",
            SharedShape::new(RoundCone {
                inner_shape: crate::parry::shape::Cone::new(1.0, 0.5),
                border_radius: 0.2,
            })
            .into(),
            0.0,
        ),
        ("hull", Collider::convex_hull(hull.clone()).expect("a hull"), 0.0),
        (
            "round hull",
            SharedShape::round_convex_hull(&hull, 0.2).expect("a hull").into(),
            ROUNDED_EDGE * 0.2,
        ),
        ("segment", Collider::segment(a, b), 0.0),
        ("mesh", Collider::trimesh(vec![a, b, c, v(0.0, 1.0, 1.0)], vec![[0, 1, 2], [0, 2, 3]]), 0.0),
        (
            "height field",
            Collider::heightfield(vec![vec![0.0, 0.5, 0.2], vec![0.3, 0.1, 0.4]], v(4.0, 1.0, 3.0)),
            0.0,
        ),
    ]
}

/// The shape that a rounded collider is built on, and its radius. Parry is 5 mm off for points around rounded
/// cylinders and cones, and exact for sharp ones.
pub(in crate::debug_render) fn core_of(collider: &Collider) -> (Collider, Scalar) {
    let shape = collider.shape_scaled();
    if let Some(round) = shape.as_round_cylinder() {
        (SharedShape::new(round.inner_shape).into(), round.border_radius)
    } else if let Some(round) = shape.as_round_cone() {
        (SharedShape::new(round.inner_shape).into(), round.border_radius)
    } else {
        (collider.clone(), 0.0)
    }
}
