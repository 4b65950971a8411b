//! Properties of colliders in both dimensions.

use super::input::MIN_LENGTH;
use super::*;
use crate::collision::collider::SimpleCollider;
use crate::math::{ComputeMassProperties, DIM, Scalar};
use crate::parry::math::IVector;
use crate::physics_transform::{Position, Rotation};
use kernel::{manifold::LocalManifold, math::Pose};

/// Appends the manifolds of two colliders.
pub(super) fn collide(
    a: &Collider,
    b: &Collider,
    pose: &Pose,
    prediction: f32,
    out: &mut Vec<LocalManifold>,
) {
    foreign_manifolds(a, b, pose, prediction, out);
}

/// A direction for each i, spread around.
pub(super) fn direction(i: u32) -> Vector {
    let angle = |k: usize| Scalar::from((i as f32 * (0.7 + 0.37 * k as f32)) % 6.3 - 3.1);
    Vector::from_array(core::array::from_fn(angle)).normalize_or(Vector::X)
}

/// Whether two numbers agree to a relative 10⁻⁴.
pub(super) fn close(a: f32, b: f32) -> bool {
    (a - b).abs() <= 1.0e-4 * (1.0 + a.abs().max(b.abs()))
}

/// The half size of the collider's box at the origin.
pub(super) fn half_size(collider: &Collider) -> Vector {
    collider.aabb(Vector::ZERO, Rotation::default()).size() * 0.5
}

/// Asserts that box, mass and ray casts of a collider are finite.
#[track_caller]
pub(super) fn assert_usable(collider: &Collider) {
    let aabb = collider.aabb(Vector::ZERO, Rotation::default());
    assert!(aabb.min.is_finite() && aabb.max.is_finite() && aabb.min.cmple(aabb.max).all(), "{aabb:?}");
    let properties = collider.mass_properties(1.0);
    assert!(properties.mass.is_finite() && properties.mass >= 0.0, "{properties:?}");
    assert!(properties.center_of_mass.is_finite(), "{properties:?}");
    let hit =
        collider.cast_ray(Vector::ZERO, Rotation::default(), direction(3) * 9.0, -direction(3), 99.0, true);
    assert!(hit.is_none_or(|(t, n)| t.is_finite() && n.is_finite()));
    let (point, _) = collider.project_point(Vector::ZERO, Rotation::default(), Vector::ONE, true);
    assert!(point.is_finite());
}

/// Compares the support distances of the kernel's shape with parry's, in all directions.
#[track_caller]
pub(super) fn assert_native(collider: &Collider) {
    let shape = collider.shape_scaled();
    let native = collider.native();
    assert!(!matches!(native, kernel::shape::Shape::Foreign(_)), "{shape:?}");
    for i in 0..100 {
        let direction = direction(i);
        let Some(support) = native.support(crate::math::vector_to_kernel(direction)) else {
            return;
        };
        let ours = crate::math::vector_from_kernel(support).dot(direction) as f32;
        // The box of the shape, rotated so that the direction is an axis, gives the support distance.
        let theirs = far_along(shape, direction) as f32;
        assert!(close(ours, theirs), "{shape:?} along {direction}: {ours} {theirs}");
    }
}

/// Support distance of a shape in a direction, by parry's projection of a far point.
fn far_along(shape: &SharedShape, direction: Vector) -> Scalar {
    match shape.as_support_map() {
        Some(map) => map.local_support_point(direction).dot(direction),
        None => panic!("{shape:?} is not convex"),
    }
}

#[test]
fn hostile_sizes_give_usable_shapes() {
    for bad in
        [0.0, -1.0, Scalar::NAN, Scalar::INFINITY, Scalar::NEG_INFINITY, Scalar::MAX, Scalar::MIN_POSITIVE]
    {
        let point = Vector::splat(bad);
        assert_usable(&Collider::capsule(bad, 1.0));
        assert_usable(&Collider::capsule(1.0, bad));
        assert_usable(&Collider::capsule_endpoints(bad, point, Vector::ONE));
        assert_usable(&Collider::segment(point, point));
        assert_usable(&Collider::polyline(vec![point, Vector::ONE, Vector::X], None));
        assert_usable(&Collider::voxels(point, &[]));
        assert_usable(&Collider::voxels_from_points(Vector::ONE, &[point, Vector::ONE]));
        assert_usable(&Collider::trimesh(vec![point, Vector::X, Vector::Y], vec![[0, 1, 2]]));
        let half_space = Collider::half_space(point * bad.signum());
        assert!(half_space.contains_point(Vector::ZERO, Rotation::default(), Vector::NEG_ONE * 3.0));
        assert!(Collider::convex_hull(vec![point; 9]).is_none());
        let mut scaled = Collider::capsule(1.0, 1.0);
        scaled.set_scale(point, 10);
        assert_usable(&scaled);
    }
}

#[test]
fn hostile_indices_are_left_out_or_reported() {
    let vertices = vec![Vector::ZERO, Vector::X, Vector::Y, Vector::NAN];
    for bad in [[0, 1, 9], [0, 1, 1], [0, 1, 3], [u32::MAX; 3]] {
        let error = Collider::try_trimesh(vertices.clone(), vec![[0, 1, 2], bad]);
        assert!(matches!(error, Err(TrimeshBuilderError::TopologyError(_))));
        assert_usable(&Collider::trimesh(vertices.clone(), vec![[0, 1, 2], bad]));
        let alone = Collider::trimesh(vertices.clone(), vec![bad]);
        assert!(half_size(&alone).max_element() < 2.0 * MIN_LENGTH, "nothing is left");
    }
    assert!(Collider::try_trimesh(vertices.clone(), vec![]).is_err());
    assert_usable(&Collider::polyline(vertices.clone(), Some(vec![[0, 1], [1, 3], [7, 8]])));
    assert_usable(&Collider::polyline(vec![], None));
    let all = TrimeshFlags::all();
    assert_usable(&Collider::trimesh_with_config(vertices, vec![[0, 1, 2], [2, 1, 0]], all));
    assert!(Collider::voxelized_convex_decomposition(&[], &[]).is_empty());
}

#[test]
fn compounds_are_flat() {
    let at = |x: Scalar| Position(Vector::X * x);
    let inner = Collider::compound(vec![(at(1.0), Rotation::default(), Collider::capsule(0.5, 1.0))]);
    let mesh = Collider::trimesh(vec![Vector::ZERO, Vector::X, Vector::Y], vec![[0, 1, 2]]);
    let voxels = Collider::voxels_from_points(Vector::ONE, &[Vector::splat(0.5)]);
    let outer = Collider::compound(vec![
        (at(10.0), Rotation::default(), inner),
        (at(0.0), Rotation::default(), mesh),
        (at(-2.0), Rotation::default(), voxels),
    ]);
    let compound = outer.shape().as_compound().expect("a compound");
    assert_eq!(compound.shapes().len(), 3);
    let aabb = outer.aabb(Vector::ZERO, Rotation::default());
    assert!((aabb.max.x - 11.5).abs() < 1.0e-5 && (aabb.min.x + 2.0).abs() < 1.0e-5, "{aabb:?}");
    let empty: Vec<(Position, Rotation, Collider)> = vec![];
    assert_usable(&Collider::compound(empty));
}

#[test]
fn the_default_is_half_a_metre_wide() {
    assert!((half_size(&Collider::default()) - 0.25).length() < 1.0e-6);
}

#[test]
fn scaling_scales_boxes_and_keeps_the_shape() {
    let mut collider = Collider::default();
    let scale = Vector::from_array(core::array::from_fn(|i| 2.0 + i as Scalar));
    collider.set_scale(scale, 10);
    assert_eq!(collider.scale(), scale);
    assert!((half_size(&collider) - scale * 0.25).length() < 1.0e-6);
    assert!(close(collider.mass(1.0), (0.5f32).powi(DIM as i32) * [2.0, 6.0, 24.0][DIM - 1]));
    collider.set_shape(Collider::capsule(0.5, 1.0).shape().clone());
    assert!((half_size(&collider).y - 3.0).abs() < 0.1);
    collider.set_scale(Vector::ONE, 10);
    assert!((half_size(&collider).y - 1.0).abs() < 1.0e-6);
    *collider.shape_mut() = SharedShape::ball(2.0);
    assert!((half_size(&collider) - 2.0).length() < 1.0e-6, "a changed shape is scaled anew");
    collider.set_scale(Vector::splat(-1.0), 10);
    assert!((half_size(&collider) - 2.0).length() < 1.0e-6);
}

#[test]
fn points_and_rays_meet_a_capsule() {
    let capsule = Collider::capsule(0.5, 2.0);
    let at = |p: Vector| (Position(p), Rotation::default());
    let (position, rotation) = at(Vector::X * 5.0);
    assert!(capsule.contains_point(position, rotation, Vector::X * 5.4 + Vector::Y));
    assert!(!capsule.contains_point(position, rotation, Vector::X * 5.6));
    assert!((capsule.distance_to_point(position, rotation, Vector::X * 7.0, true) - 1.5).abs() < 1.0e-5);
    assert!((capsule.distance_to_point(position, rotation, Vector::X * 5.2, false) + 0.3).abs() < 1.0e-5);
    let (point, inside) = capsule.project_point(position, rotation, Vector::ZERO, true);
    assert!((point - Vector::X * 4.5).length() < 1.0e-5 && !inside);
    let hit = capsule.cast_ray(position, rotation, Vector::ZERO, Vector::X, 10.0, true).expect("a hit");
    assert!((hit.0 - 4.5).abs() < 1.0e-4 && (hit.1 - Vector::NEG_X).length() < 1.0e-3);
    assert!(capsule.intersects_ray(position, rotation, Vector::ZERO, Vector::X, 4.6));
    assert!(!capsule.intersects_ray(position, rotation, Vector::ZERO, Vector::X, 4.4));
    for bad in [Vector::ZERO, Vector::NAN] {
        assert!(capsule.cast_ray(position, rotation, Vector::ZERO, bad, 10.0, true).is_none());
    }
    assert!(!capsule.contains_point(position, rotation, Vector::NAN));
    assert!(!capsule.contains_point(Position(Vector::NAN), rotation, Vector::ONE));
}

#[test]
fn native_shapes_reach_as_far_as_parrys() {
    assert_native(&Collider::capsule(0.4, 2.0));
    assert_native(&Collider::capsule_endpoints(0.3, Vector::ONE, Vector::X * -2.0));
    assert_native(&Collider::segment(Vector::ONE, Vector::X * -2.0));
    assert_native(&Collider::default());
    assert_native(&Collider::from(SharedShape::ball(2.5)));
    let cloud = (0..12).map(|i| direction(i) * (1.0 + 0.05 * i as Scalar)).collect();
    assert_native(&Collider::convex_hull(cloud).expect("a hull"));
}

#[test]
fn native_composites() {
    let part = |x| (Position::new(Vector::X * x), Rotation::default(), Collider::default());
    assert_native(&Collider::compound(vec![part(0.0), part(3.0)]));
    assert_native(&Collider::polyline(vec![Vector::ZERO, Vector::X, Vector::ONE], None));
    assert_native(&Collider::voxels(Vector::ONE, &[IVector::ZERO, IVector::ONE]));
    let cut = Collider::compound(vec![part(0.0)]).native().local_aabb(kernel::math::Rot::IDENTITY);
    assert_eq!(cut, Collider::default().native().local_aabb(kernel::math::Rot::IDENTITY));
}

#[test]
fn a_mesh_is_native_and_has_its_box() {
    let mesh = Collider::trimesh(vec![Vector::ZERO, Vector::X * 3.0, Vector::Y], vec![[0, 1, 2]]);
    assert_native(&mesh);
    let aabb = mesh.native().local_aabb(kernel::math::Rot::IDENTITY);
    assert_eq!(aabb.max, crate::math::vector_to_kernel(Vector::X * 3.0 + Vector::Y));
}

#[test]
fn a_swept_box_contains_both_ends() {
    let collider = Collider::capsule(0.5, 2.0);
    let r = Rotation::default();
    let swept = collider.swept_aabb(Vector::ZERO, r, Vector::X * 9.0, r);
    assert!(
        swept.contains(&collider.aabb(Vector::ZERO, r)) && swept.contains(&collider.aabb(Vector::X * 9.0, r))
    );
}
