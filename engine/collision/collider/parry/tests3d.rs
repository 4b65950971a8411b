//! Closed forms of 3D shapes, primitives, and contacts of shapes that only parry has.

use super::super::tests::{assert_native, assert_usable, close, collide, half_size};
use super::super::*;
use crate::math::{AdjustPrecision, PI, Scalar};
use crate::physics_transform::{Position, Rotation};
use bevy_heavy::ComputeMassProperties3d;
use bevy_math::primitives::*;
use bevy_math::{Dir3, Vec2, Vec3};
use kernel::math::{MAX_POINTS, Pose, Rot};

/// Volume, moments of inertia per mass about the axes, and half size of the box.
#[track_caller]
fn assert_form(collider: &Collider, volume: Scalar, inertia: [Scalar; 3], half: [Scalar; 3]) {
    let p = collider.mass_properties(2.0);
    assert!(close(p.mass, 2.0 * volume as f32), "mass {} of {collider:?}, not {}", p.mass, 2.0 * volume);
    assert!(close(collider.mass(2.0), p.mass));
    let tensor = p.unit_angular_inertia_tensor().to_mat3();
    for i in 0..3 {
        assert!(close(tensor.col(i)[i], inertia[i] as f32), "{tensor} of {collider:?}, not {inertia:?}");
        assert!(tensor.col(i)[(i + 1) % 3].abs() < 1.0e-3 * tensor.col(i)[i].abs().max(1.0), "{tensor}");
    }
    assert!((half_size(collider) - Vector::from_array(half)).length() < 1.0e-4, "{:?}", half_size(collider));
}

#[test]
fn constructors_have_the_closed_forms() {
    assert_form(&Collider::sphere(2.0), 32.0 / 3.0 * PI, [1.6; 3], [2.0; 3]);
    let cuboid = [(16.0 + 36.0) / 12.0, (4.0 + 36.0) / 12.0, (4.0 + 16.0) / 12.0];
    assert_form(&Collider::cuboid(2.0, 4.0, 6.0), 48.0, cuboid, [1.0, 2.0, 3.0]);
    // Radius 2, height 6: (3 r² + h²) / 12 across, r² / 2 along.
    assert_form(&Collider::cylinder(2.0, 6.0), 24.0 * PI, [4.0, 2.0, 4.0], [2.0, 3.0, 2.0]);
    // Radius 2, height 6: 3/20 r² + 3/80 h² across, 3/10 r² along, the centre a quarter up.
    assert_form(&Collider::cone(2.0, 6.0), 8.0 * PI, [1.95, 1.2, 1.95], [2.0, 3.0, 2.0]);
    assert!(close(Collider::cone(2.0, 6.0).center_of_mass().y, -1.5));
    let (r, h) = (0.5, 2.0);
    let (body, caps) = (PI * r * r * h, 4.0 / 3.0 * PI * r * r * r);
    let across = body * (3.0 * r * r + h * h) / 12.0 + caps * (0.4 * r * r + h * h / 4.0 + 3.0 * h * r / 8.0);
    let along = body * r * r / 2.0 + caps * 0.4 * r * r;
    let inertia = [across, along, across].map(|i| i / (body + caps));
    assert_form(&Collider::capsule(r, h), body + caps, inertia, [0.5, 1.5, 0.5]);
    let (a, b) = (Vector::NEG_Y * 0.5 * h, Vector::Y * 0.5 * h);
    assert_form(&Collider::capsule_endpoints(r, a, b), body + caps, inertia, [0.5, 1.5, 0.5]);
    let corner =
        |i: u32| Vector::new((i & 1) as Scalar, (i >> 1 & 1) as Scalar * 2.0, (i >> 2) as Scalar * 3.0);
    let hull = Collider::convex_hull((0..8).map(corner).collect()).expect("a box");
    assert_form(&hull, 6.0, [13.0 / 12.0, 10.0 / 12.0, 5.0 / 12.0], [0.5, 1.0, 1.5]);
    assert!(
        (half_size(&Collider::round_cuboid(2.0, 4.0, 6.0, 0.5)) - Vector::new(1.5, 2.5, 3.5)).length()
            < 1.0e-5
    );
    assert!(
        (half_size(&Collider::triangle(Vector::ZERO, Vector::X, Vector::Z)) * 2.0
            - Vector::new(1.0, 0.0, 1.0))
        .length()
            < 1.0e-5
    );
    let voxels = Collider::voxels(Vector::new(1.0, 2.0, 3.0), &[[0, 0, 0].into(), [1, 0, 0].into()]);
    assert!(close(voxels.mass(1.0), 12.0), "{}", voxels.mass(1.0));
    assert!(voxels.contains_point(Vector::ZERO, Rotation::default(), Vector::new(1.9, 1.9, 2.9)));
    assert!(!voxels.contains_point(Vector::ZERO, Rotation::default(), Vector::new(1.9, 1.9, 3.1)));
}

#[test]
fn heightfields_run_along_x_then_z() {
    // Three lines along X, two places along Z each. The far X is high.
    let field = Collider::heightfield(
        vec![vec![0.0, 0.0], vec![0.0, 0.0], vec![1.0, 1.0]],
        Vector::new(4.0, 2.0, 6.0),
    );
    assert!((half_size(&field) - Vector::new(2.0, 1.0, 3.0)).length() < 1.0e-5);
    let height = |x: Scalar, z: Scalar| {
        let from = Vector::new(x, 10.0, z);
        let hit = field.cast_ray(Vector::ZERO, Rotation::default(), from, Vector::NEG_Y, 20.0, true);
        10.0 - hit.expect("over the field").0
    };
    for z in [-2.0, 0.3, 2.0] {
        assert!(
            height(-1.0, z).abs() < 1.0e-4 && (height(1.0, z) - 1.0).abs() < 1.0e-4,
            "{}",
            height(1.0, z)
        );
    }
}

#[test]
fn every_primitive_converts() {
    let volume = |c: Collider, volume: f32, half: [f32; 3]| {
        assert!(close(c.mass(1.0), volume), "{c:?} has {} not {volume}", c.mass(1.0));
        let size = half_size(&c).to_array().map(|v| v as f32);
        assert!((0..3).all(|i| close(size[i], half[i])), "{c:?} {size:?}");
    };
    let pi = core::f32::consts::PI;
    volume(Sphere::new(1.0).into(), 4.0 / 3.0 * pi, [1.0; 3]);
    volume(Cuboid::new(2.0, 4.0, 6.0).into(), 48.0, [1.0, 2.0, 3.0]);
    volume(Cylinder::new(1.0, 4.0).into(), 4.0 * pi, [1.0, 2.0, 1.0]);
    volume(Capsule3d::new(1.0, 2.0).into(), 2.0 * pi + 4.0 / 3.0 * pi, [1.0, 2.0, 1.0]);
    volume(Cone::new(1.0, 3.0).into(), pi, [1.0, 1.5, 1.0]);
    volume(Segment3d::new(Vec3::ZERO, Vec3::new(2.0, 4.0, 6.0)).into(), 0.0, [1.0, 2.0, 3.0]);
    volume(Line3d { direction: Dir3::X }.into(), 0.0, [10_000.0, 0.0, 0.0]);
    volume(Polyline3d::new([Vec3::ZERO, Vec3::X, Vec3::ONE]).into(), 0.0, [0.5; 3]);
    volume(Plane3d::new(Vec3::Y, Vec2::new(1.0, 2.0)).into(), 0.0, [1.0, 0.0, 2.0]);
    volume(Triangle3d::new(Vec3::ZERO, Vec3::X, Vec3::Z).into(), 0.0, [0.5, 0.0, 0.5]);
    volume(Tetrahedron::new(Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::Z).into(), 1.0 / 6.0, [0.5; 3]);
    let frustum = Collider::from(ConicalFrustum { radius_top: 1.0, radius_bottom: 2.0, height: 3.0 });
    let exact = pi * (1.0 + 2.0 + 4.0);
    assert!(frustum.mass(1.0) < exact && frustum.mass(1.0) > 0.99 * exact);
    assert!((half_size(&frustum) - Vector::new(2.0, 1.5, 2.0)).length() < 1.0e-4);
    let plane = Collider::from(InfinitePlane3d::new(Vec3::Z));
    assert!(plane.contains_point(Vector::ZERO, Rotation::default(), Vector::NEG_Z * 7.0));
    assert!(!plane.contains_point(Vector::ZERO, Rotation::default(), Vector::Z * 0.1));
}

#[test]
fn hostile_input_gives_usable_shapes() {
    for bad in [0.0, -1.0, Scalar::NAN, Scalar::INFINITY, Scalar::MAX] {
        let point = Vector::splat(bad);
        assert_usable(&Collider::sphere(bad));
        assert_usable(&Collider::cuboid(1.0, bad, 1.0));
        assert_usable(&Collider::round_cuboid(bad, bad, bad, bad));
        assert_usable(&Collider::cylinder(bad, 1.0));
        assert_usable(&Collider::cone(1.0, bad));
        assert_usable(&Collider::triangle(point, point, point));
        assert_usable(&Collider::triangle(Vector::ZERO, point, Vector::X));
        assert_usable(&Collider::heightfield(vec![vec![bad, 1.0], vec![0.0, 1.0, 2.0]], point));
        assert_usable(&Collider::heightfield(vec![vec![bad]], Vector::ONE));
        let corners = vec![point, Vector::X, Vector::Y, Vector::Z];
        let faces = [[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]];
        assert_usable(&Collider::convex_decomposition(corners.clone(), faces.to_vec()));
        assert_usable(&Collider::voxelized_trimesh(&corners, &faces, 0.5, FillMode::SurfaceOnly));
        assert_usable(&ConicalFrustum { radius_top: bad as f32, radius_bottom: 1.0, height: 1.0 }.into());
        assert_usable(&Tetrahedron::new(Vec3::splat(bad as f32), Vec3::X, Vec3::Y, Vec3::X + Vec3::Y).into());
    }
    assert!(
        Collider::convex_hull((0..9).map(|i| Vector::new(i as Scalar, (i * i) as Scalar, 0.0)).collect())
            .is_none(),
        "flat"
    );
    assert_usable(&Collider::convex_decomposition(vec![], vec![]));
    assert_usable(&Collider::heightfield(vec![], Vector::ONE));
}

#[test]
fn native_shapes_of_space() {
    assert_native(&Collider::cuboid(1.0, 2.0, 3.0));
    assert_native(&Collider::triangle(Vector::ZERO, Vector::X, Vector::Y));
    assert_native(&Tetrahedron::default().into());
    assert_native(&Collider::round_cuboid(1.0, 0.5, 2.0, 0.1));
    let corners = vec![Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    let inner = SharedShape::round_convex_hull(&corners, 0.2).expect("it is solid");
    assert_native(&Collider::from(inner));
    assert_native(&Collider::cylinder(1.0, 2.0));
    assert_native(&Collider::cone(1.0, 3.0));
    let foreign = Collider::from(SharedShape::round_cylinder(1.0, 1.0, 0.1));
    assert!(matches!(foreign.native(), kernel::shape::Shape::Foreign(_)));
}

/// Parry's hulls of scattered points are not quite convex.
#[test]
fn hulls_of_scattered_points_are_native() {
    for cloud in 0..200 {
        let part = |i: usize, k: usize| (i as Scalar * (1.3 + k as Scalar) + 0.7 * cloud as Scalar).sin();
        let points = (1..=5 + cloud % 40).map(|i| Vector::new(part(i, 0), part(i, 1), part(i, 2)));
        assert_native(&Collider::convex_hull(points.collect()).expect("a hull"));
    }
}

/// A pose above the origin.
fn at(x: f32, y: f32, z: f32) -> Pose {
    Pose::new(kernel::math::Vector { x, y, z }, Rot::IDENTITY)
}

#[test]
fn a_cylinder_stands_on_a_cuboid() {
    let (ground, cylinder) = (Collider::cuboid(10.0, 2.0, 10.0), Collider::cylinder(0.5, 2.0));
    for gap in [0.01f32, 0.0, -0.02] {
        let mut out = vec![];
        collide(&ground, &cylinder, &at(1.0, 2.0 + gap, -1.0), 0.05, &mut out);
        assert_eq!(out.len(), 1);
        let manifold = out[0];
        assert!((manifold.normal - kernel::math::Vector::Y).length() < 1.0e-3, "{manifold:?}");
        assert!(manifold.count >= 3 && manifold.count <= MAX_POINTS, "{manifold:?}");
        for p in manifold.points() {
            assert!((p.separation - gap).abs() < 1.0e-3, "{p:?}");
            assert!((p.point.y - 1.0 - 0.5 * gap).abs() < 1.0e-3, "midway: {p:?}");
            assert!((p.point.x - 1.0).hypot(p.point.z + 1.0) < 0.501, "under the cylinder: {p:?}");
        }
        // The points surround the axis.
        let sum = manifold.points().iter().fold(kernel::math::Vector::ZERO, |s, p| s + p.point);
        let mean = sum * (1.0 / manifold.count as f32);
        assert!((mean.x - 1.0).hypot(mean.z + 1.0) < 0.25, "{manifold:?}");
        let mut back = vec![];
        collide(&cylinder, &ground, &at(1.0, 2.0 + gap, -1.0).inverse(), 0.05, &mut back);
        assert!((back[0].normal + kernel::math::Vector::Y).length() < 1.0e-3);
    }
    let mut out = vec![];
    collide(&ground, &cylinder, &at(1.0, 2.2, -1.0), 0.05, &mut out);
    assert!(out.is_empty());
}

#[test]
fn a_cuboid_on_a_mesh_has_a_manifold_per_triangle() {
    let corners = [(-4.0, -4.0), (4.0, -4.0), (4.0, 4.0), (-4.0, 4.0)];
    let corners = corners.map(|(x, z)| Vec3::new(x, 0.0, z).adjust_precision()).to_vec();
    let mesh = Collider::trimesh(corners, vec![[0, 2, 1], [0, 3, 2]]);
    let cuboid = Collider::cuboid(2.0, 2.0, 2.0);
    let mut out = vec![];
    collide(&mesh, &cuboid, &at(0.1, 0.99, 0.0), 0.02, &mut out);
    assert_eq!(out.len(), 2, "{out:?}");
    for manifold in &out {
        assert!((manifold.normal - kernel::math::Vector::Y).length() < 1.0e-3, "{manifold:?}");
        assert!(manifold.points().iter().all(|p| (p.separation + 0.01).abs() < 1.0e-3), "{manifold:?}");
    }
    let features: Vec<_> = out.iter().flat_map(|m| m.points()).map(|p| p.feature).collect();
    assert!(features.iter().enumerate().all(|(i, f)| !features[..i].contains(f)), "{out:?}");
    let mut compound = vec![];
    let parts = vec![(Position(Vector::Y), Rotation::default(), cuboid)];
    collide(&mesh, &Collider::compound(parts), &at(0.1, -0.01, 0.0), 0.02, &mut compound);
    assert_eq!(compound.len(), 2);
    for (a, b) in out.iter().zip(&compound) {
        assert!((a.normal - b.normal).length() < 1.0e-3 && a.count == b.count);
    }
    for bad in [at(f32::NAN, 0.0, 0.0), at(f32::INFINITY, 0.0, 0.0)] {
        out.clear();
        collide(&mesh, &Collider::sphere(1.0), &bad, 0.02, &mut out);
        assert!(out.is_empty());
    }
}

#[test]
fn constructors_of_space_return_errors() {
    use super::super::tests_strict::{BAD, fails};
    use ColliderError as Error;
    let corners = [Vector::ZERO, Vector::X, Vector::Y, Vector::Z];
    let (faces, mode) = ([[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]], FillMode::SurfaceOnly);
    let heights = || vec![vec![0.0, -1.0], vec![1.0, 2.0]];
    for bad in BAD {
        fails(Collider::try_sphere(bad), Error::InvalidSize);
        fails(Collider::try_cuboid(1.0, bad, 1.0), Error::InvalidSize);
        fails(Collider::try_round_cuboid(1.0, 1.0, bad, 0.1), Error::InvalidSize);
        fails(Collider::try_cylinder(bad, 1.0), Error::InvalidSize);
        fails(Collider::try_cone(1.0, bad), Error::InvalidSize);
        fails(Collider::try_voxelized_trimesh(&corners, &faces, bad, mode), Error::InvalidSize);
        fails(Collider::try_heightfield(heights(), Vector::new(1.0, 1.0, bad)), Error::InvalidSize);
        if !(0.0..1.0).contains(&bad) {
            fails(Collider::try_round_cuboid(1.0, 1.0, 1.0, bad), Error::NegativeSize);
        }
    }
    fails(Collider::try_voxelized_trimesh(&corners, &faces, 2.0e-5, mode), Error::TooManyVoxels);
    fails(Collider::try_voxelized_trimesh(&corners, &[[0, 1, 4]], 0.1, mode), Error::InvalidElement(0));
    fails(Collider::try_voxelized_trimesh(&corners, &[], 0.1, mode), Error::NoElements);
    fails(Collider::try_heightfield(vec![], Vector::ONE), Error::TooFewHeights);
    fails(Collider::try_heightfield(vec![vec![0.0; 2], vec![0.0; 3]], Vector::ONE), Error::UnevenHeights);
    fails(Collider::try_heightfield(vec![vec![Scalar::NAN; 2]; 2], Vector::ONE), Error::InvalidPoint);
    assert!(Collider::try_heightfield(heights(), Vector::ONE).is_ok());
    assert!(Collider::try_voxelized_trimesh(&corners, &faces, 0.1, mode).is_ok());
}

/// An open floor with a low step has a volume of about zero, by which its centre of mass is divided.
#[test]
fn open_meshes_have_their_centre_of_mass_in_their_box() {
    for (cells, height) in [(4, 0.0), (4, 0.001), (13, 0.001), (16, 0.005), (48, 0.005), (48, 1.0)] {
        let corner = |i: u32, j: u32| {
            let x = 24.0 * i as Scalar / cells as Scalar - 12.0;
            Vector::new(x, if x < 0.0 { 0.0 } else { height }, 8.0 * j as Scalar / cells as Scalar)
        };
        let side = 0..=cells;
        let vertices = side.clone().flat_map(|i| side.clone().map(move |j| corner(i, j))).collect();
        let squares = (0..cells).flat_map(|i| (0..cells).map(move |j| i * (cells + 1) + j));
        let indices =
            squares.flat_map(|p| [[p, p + 1, p + cells + 2], [p, p + cells + 2, p + cells + 1]]).collect();
        let mesh = Collider::trimesh(vertices, indices);
        let center = mesh.center_of_mass();
        let is_in_box = center.x.abs() <= 12.1 && center.y.abs() <= 1.1 && (center.z - 4.0).abs() <= 4.1;
        let p = mesh.mass_properties(1.0);
        let is_finite = p.mass >= 0.0 && p.mass.is_finite() && p.principal_angular_inertia.is_finite();
        assert!(is_in_box && is_finite, "{cells} by {cells} cells, {height} m: {center}, {p:?}");
    }
}
