//! 3D parts of `scale.rs`. `scale2.rs` has those of 2D.

use avian::{
    math::{Quaternion, Scalar, Vector},
    parry::shape::{Cone, Cylinder, HeightFieldCellStatus, RoundShape, SharedShape},
    prelude::*,
};
use bevy_math::{EulerRot, IVec3, Quat};

fn v(x: Scalar, y: Scalar, z: Scalar) -> Vector {
    Vector::new(x, y, z)
}

/// A box with the given sides.
pub fn cuboid(sides: Vector) -> Collider {
    Collider::cuboid(sides.x, sides.y, sides.z)
}

/// A turn by three angles.
pub fn turn([a, b, c]: [f32; 3]) -> Quat {
    Quat::from_euler(EulerRot::ZYX, a, b, c)
}

/// A tetrahedron without symmetries.
pub fn lopsided() -> Collider {
    let corners = vec![v(-0.4, -0.3, -0.2), v(0.9, -0.1, 0.0), v(0.2, 0.7, -0.1), v(0.1, 0.2, 1.1)];
    Collider::convex_hull(corners).expect("a hull")
}

/// One collider of each kind, none of them symmetric where it can be without, and whether an uneven
/// scale is exact.
pub fn shapes() -> Vec<(&'static str, Collider, bool)> {
    let [a, b, c, d] = [v(-0.4, -0.3, -0.2), v(0.9, -0.1, 0.0), v(0.2, 0.7, -0.1), v(0.1, 0.2, 1.1)];
    let part = |i: u32, factor: u32| (i * factor % 23) as Scalar / 11.0 - 0.8;
    let hull: Vec<Vector> = (0..24).map(|i| v(part(i, 5), part(i, 7), part(i, 11))).collect();
    let row = |z: Scalar| (0..3).map(|x| 0.3 * (x as Scalar) * z - 0.2 * z * z).collect::<Vec<_>>();
    let mut heights = Collider::heightfield(vec![row(0.0), row(1.3), row(-0.6), row(2.0)], v(4.0, 1.0, 3.0));
    let mut field = heights.shape().as_heightfield().expect("a height field").clone();
    field.set_cell_status(0, 1, HeightFieldCellStatus::ZIGZAG_SUBDIVISION);
    field.set_cell_status(1, 0, HeightFieldCellStatus::LEFT_TRIANGLE_REMOVED);
    heights.set_shape(SharedShape::new(field));
    let at = |x, y, z, turn: Quaternion, collider| (v(x, y, z), Rotation(turn), collider);
    let quarter = Quaternion::from_rotation_x(core::f32::consts::FRAC_PI_2 as Scalar);
    let any = Quaternion::from_euler(bevy_math::EulerRot::XYZ, 0.4, -0.9, 1.3);
    let round = |shape| RoundShape { inner_shape: shape, border_radius: 0.2 };
    vec![
        ("sphere", Collider::sphere(0.7), false),
        ("capsule", Collider::capsule_endpoints(0.3, v(-0.5, 0.2, 0.0), v(0.6, 0.9, 0.3)), false),
        ("cuboid", Collider::cuboid(1.0, 2.0, 0.5), true),
        ("round cuboid", Collider::round_cuboid(1.0, 2.0, 0.5, 0.2), false),
        ("triangle", Collider::triangle(a, b, c), true),
        ("cylinder", Collider::cylinder(0.5, 2.0), false),
        ("round cylinder", SharedShape::new(round(Cylinder::new(1.0, 0.5))).into(), false),
        ("cone", Collider::cone(0.5, 2.0), false),
        (
            "round cone",
            SharedShape::new(RoundShape { inner_shape: Cone::new(1.0, 0.5), border_radius: 0.2 }).into(),
            false,
        ),
        ("tetrahedron", lopsided(), true),
        ("hull", Collider::convex_hull(hull.clone()).expect("a hull"), true),
        ("round hull", SharedShape::round_convex_hull(&hull, 0.2).expect("a hull").into(), false),
        ("half-space", Collider::half_space(v(0.3, 0.8, -0.4)), true),
        ("segment", Collider::segment(a, d), true),
        ("polyline", Collider::polyline(vec![a, b, c, d], None), true),
        ("mesh", Collider::trimesh(vec![a, b, c, d], vec![[0, 2, 1], [0, 1, 3], [1, 2, 3]]), true),
        (
            "closed mesh",
            Collider::trimesh_with_config(
                vec![a, b, c, d],
                vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
                TrimeshFlags::ORIENTED,
            ),
            true,
        ),
        ("height field", heights, true),
        (
            "voxels",
            Collider::voxels(
                v(0.5, 0.3, 0.4),
                &[IVec3::new(0, 0, 0), IVec3::new(1, 0, 2), IVec3::new(-3, 2, 1)],
            ),
            true,
        ),
        (
            "compound",
            Collider::compound(vec![
                at(1.0, 0.2, 0.3, Quaternion::IDENTITY, cuboid(v(0.5, 0.9, 0.3))),
                at(-0.6, 0.5, 0.1, quarter, lopsided()),
            ]),
            true,
        ),
        (
            "turned compound",
            Collider::compound(vec![
                at(1.0, 0.2, 0.3, any, Collider::cone(0.3, 0.9)),
                at(-0.6, 0.5, 0.1, any.inverse(), lopsided()),
            ]),
            false,
        ),
    ]
}
