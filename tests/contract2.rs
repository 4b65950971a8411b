//! 2D parts of `contract.rs`. `contract3.rs` has those of 3D.
#![allow(clippy::op_ref, reason = "the operators of references are what is asked for")]

use avian::{
    collision::collider::{EllipseColliderShape, RegularPolygonColliderShape},
    dynamics::rigid_body::mass_properties::components::AngularInertiaError,
    math::{Matrix, Quaternion, Scalar, Vector, Vector3},
    prelude::*,
};
use bevy_math::{IVec2, Rot2, Vec2};

pub type MassProperties = MassProperties2d;
pub type Segment = bevy_math::primitives::Segment2d;

#[test]
fn shapes_of_the_plane_are_made_the_way_they_were() {
    type Points = Vec<Vector>;
    let _: [fn(Scalar) -> Collider; 1] = [Collider::circle];
    let _: [fn(Scalar, Scalar) -> Collider; 2] = [Collider::ellipse, Collider::rectangle];
    let _: fn(Scalar, Scalar, Scalar) -> Collider = Collider::round_rectangle;
    let _: fn(f32, u32) -> Collider = Collider::regular_polygon;
    let _: fn(Vector, Vector, Vector) -> Collider = Collider::triangle_unchecked;
    let _: fn(Points) -> Option<Collider> = Collider::convex_polyline;
    let _: fn(Points, Vec<[u32; 2]>, &VhacdParameters) -> Collider =
        Collider::convex_decomposition_with_config;
    let _: fn(&[Vector], &[[u32; 2]], Scalar, FillMode) -> Collider = Collider::voxelized_polyline;
    let _: fn(Vec<Scalar>, Vector) -> Collider = Collider::heightfield;
    let _: fn(Vector, &[IVec2]) -> Collider = Collider::voxels;
    let _ = (
        |e: &EllipseColliderShape| e.half_size,
        |p: &RegularPolygonColliderShape| p.sides,
        FillMode::FloodFill { detect_cavities: true, detect_self_intersections: false },
    );
}

#[test]
fn turning_in_the_plane_has_the_names_it_had() {
    use Rotation as R;
    let _: [fn(Scalar) -> R; 2] = [R::radians, R::degrees];
    let _: fn(Scalar, Scalar) -> R = R::from_sin_cos;
    let _: [fn(R) -> Scalar; 5] =
        [R::as_radians, R::as_degrees, R::length, R::length_squared, R::length_recip];
    let _: fn(R) -> (Scalar, Scalar) = R::sin_cos;
    let _: fn(R) -> Option<R> = R::try_normalize;
    let _: [fn(R) -> R; 2] = [R::normalize, R::inverse];
    let _: [fn(R) -> bool; 4] = [R::is_finite, R::is_nan, R::is_normalized, R::is_near_identity];
    let _: fn(&R, Scalar) -> R = R::add_angle_fast;
    let _: fn(Scalar, Scalar) -> Position = Position::from_xy;
    let _ = [
        R::PLACEHOLDER,
        R::IDENTITY,
        R::PI,
        R::FRAC_PI_2,
        R::FRAC_PI_3,
        R::FRAC_PI_4,
        R::FRAC_PI_6,
        R::FRAC_PI_8,
    ];
    #[expect(deprecated, reason = "former names stay")]
    let _: ([fn(Scalar) -> R; 2], fn(&R, Vector) -> Vector) = ([R::from_radians, R::from_degrees], R::rotate);
    let mut r = R::from(0.5 as Scalar);
    assert_eq!((R::from(Matrix::from(R::PI)), Rot2::from(R::from(Rot2::PI))), (R::PI, Rot2::PI));
    let (_, _) = (Scalar::from(r), Quaternion::from(r));
    let mut v = Vector3::Z;
    assert_eq!([r * v, &r * v, &mut r * v, r * &v, &r * &v, &mut r * &v, r * &mut v, &r * &mut v], [v; 8]);
    assert_eq!(&mut r * &mut v, v);
}

#[test]
fn mass_and_locks_of_the_plane_have_the_names_they_had() {
    use ComputedAngularInertia as I;
    let _: [fn(Scalar) -> I; 2] = [I::new, I::from_inverse];
    let _: [fn(Scalar) -> Result<I, AngularInertiaError>; 2] = [I::try_new, I::try_from_inverse];
    let _: [fn(I) -> Scalar; 2] = [I::value, I::inverse];
    let _: [fn(I) -> bool; 3] = [I::is_finite, I::is_infinite, I::is_nan];
    let _: [fn(&I, Scalar, Vector) -> Scalar; 2] = [I::shifted, I::shifted_inverse];
    let _: fn(&mut I) -> &mut Scalar = I::inverse_mut;
    let _: fn(&AngularInertia, f32, Vec2) -> f32 = AngularInertia::shifted;
    let _: fn(f32, f32) -> CenterOfMass = CenterOfMass::new;
    let _: fn(Scalar, Scalar) -> ComputedCenterOfMass = ComputedCenterOfMass::new;
    let (mut inertia, _): (I, Scalar) = (I::from(2.0 as Scalar), I::new(2.0) * 2.0 as Scalar);
    inertia.set(AngularInertia(3.0));
    assert_eq!((inertia.value(), AngularInertia::ZERO.0, AngularInertia::from(2.0).0), (3.0, 0.0, 2.0));
    assert_eq!(AngularVelocity::from(1.0 as Scalar).0, 1.0);
    let locks = LockedAxes::new().lock_rotation().unlock_rotation().lock_translation_x();
    assert_eq!((locks.to_bits(), LockedAxes::ROTATION_LOCKED.is_rotation_locked()), (0b100_000, true));
}
