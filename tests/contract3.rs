//! 3D parts of `contract.rs`. `contract2.rs` has those of 2D.
#![allow(clippy::op_ref, reason = "the operators of references are what is asked for")]

use avian::{
    collision::collider::trimesh_builder::{Trimesh, TrimeshBuilder, TrimeshBuilderError},
    dynamics::rigid_body::mass_properties::components::AngularInertiaError,
    math::{
        Matrix3, Quaternion, Scalar, SymmetricMatrix, SymmetricMatrix3, Vector, Vector3, orthonormal_basis,
        orthonormal_basis_from_vec, skew_symmetric_mat3,
    },
    prelude::*,
};
use bevy_math::{IVec3, Mat3, Quat, Vec3};

pub type MassProperties = MassProperties3d;
pub type Segment = bevy_math::primitives::Segment3d;

#[test]
fn shapes_of_space_are_made_the_way_they_were() {
    let _: fn(Scalar) -> Collider = Collider::sphere;
    let _: fn(Scalar, Scalar, Scalar) -> Collider = Collider::cuboid;
    let _: fn(Scalar, Scalar, Scalar, Scalar) -> Collider = Collider::round_cuboid;
    let _: [fn(Scalar, Scalar) -> Collider; 2] = [Collider::cylinder, Collider::cone];
    let _: fn(Vec<Vector>, Vec<[u32; 3]>, VhacdParameters) -> Collider =
        Collider::convex_decomposition_with_config;
    let _: fn(&[Vector], &[[u32; 3]], Scalar, FillMode) -> Collider = Collider::voxelized_trimesh;
    let _: fn(Vec<Vec<Scalar>>, Vector) -> Collider = Collider::heightfield;
    let _: fn(Vector, &[IVec3]) -> Collider = Collider::voxels;
    let _ = FillMode::FloodFill { detect_cavities: true };
    let _: fn(&Collider) -> TrimeshBuilder = Collider::trimesh_builder;
    let _: fn(&TrimeshBuilder) -> Result<Trimesh, TrimeshBuilderError> = TrimeshBuilder::build;
    let _: fn(&mut TrimeshBuilder, u32) -> &mut TrimeshBuilder = TrimeshBuilder::fallback_subdivisions;
    let _: fn(&mut TrimeshBuilder, Vector) -> &mut TrimeshBuilder = TrimeshBuilder::translated;
    let _: fn(Trimesh) -> bevy_mesh::Mesh = Into::into;
}

#[test]
fn turning_in_space_has_the_names_it_had() {
    use Rotation as R;
    let _: fn(&R) -> R = R::inverse;
    let _: fn(Scalar, Scalar, Scalar) -> Position = Position::from_xyz;
    let _ = (R::PLACEHOLDER, orthonormal_basis_from_vec(Vector::X), orthonormal_basis(Vector::AXES));
    let _: fn(Vector3) -> Matrix3 = skew_symmetric_mat3;
    let (mut r, mut q) = (R::IDENTITY, Quaternion::IDENTITY);
    let _: [Quaternion; 3] = [r * q, &r * q, &mut r * q];
    let _: [R; 3] = [q * r, &q * r, &mut q * r];
    assert_eq!((r.x, *r), (0.0, q));
}

#[test]
fn mass_and_locks_of_space_have_the_names_they_had() {
    use ComputedAngularInertia as I;
    let _: fn(Vector) -> I = I::new;
    let _: fn(Vector) -> Result<I, AngularInertiaError> = I::try_new;
    let _: fn(Vector, Quaternion) -> I = I::new_with_local_frame;
    let _: fn(Vector, Quaternion) -> Result<I, AngularInertiaError> = I::try_new_with_local_frame;
    let _: [fn(SymmetricMatrix) -> I; 2] = [I::from_tensor, I::from_inverse_tensor];
    let _: [fn(I) -> SymmetricMatrix; 4] = [I::value, I::inverse, I::tensor, I::inverse_tensor];
    let _: fn(&mut I) -> &mut SymmetricMatrix = I::inverse_tensor_mut;
    let _: fn(&I) -> (Vector, Quaternion) = I::principal_angular_inertia_with_local_frame;
    let _: fn(I, Quaternion) -> I = I::rotated;
    let _: [fn(&I, Scalar, Vector) -> SymmetricMatrix3; 2] = [I::shifted_tensor, I::shifted_inverse_tensor];
    let _: [fn(I) -> bool; 3] = [I::is_finite, I::is_infinite, I::is_nan];
    let _: fn(Vec3) -> AngularInertia = AngularInertia::new;
    let _: fn(Vec3) -> Result<AngularInertia, AngularInertiaError> = AngularInertia::try_new;
    let _: fn(Vec3, Quat) -> AngularInertia = AngularInertia::new_with_local_frame;
    let _: fn(Vec3, Quat) -> Result<AngularInertia, AngularInertiaError> =
        AngularInertia::try_new_with_local_frame;
    let _: fn(Mat3) -> AngularInertia = AngularInertia::from_mat3_unchecked;
    let _: fn(AngularInertia) -> AngularInertiaTensor = AngularInertia::tensor;
    let _: [fn(AngularInertia) -> bool; 2] = [AngularInertia::is_finite, AngularInertia::is_nan];
    let _: fn(f32, f32, f32) -> CenterOfMass = CenterOfMass::new;
    let _: fn(Scalar, Scalar, Scalar) -> ComputedCenterOfMass = ComputedCenterOfMass::new;
    let tensor = AngularInertiaTensor::from(AngularInertia::new(Vec3::ONE));
    let _ = (AngularInertia::from(tensor), AngularInertia::from_tensor(tensor));
    assert!(
        AngularInertia::try_from(Mat3::IDENTITY).is_ok()
            && AngularInertia::try_from_mat3(Mat3::IDENTITY).is_ok()
    );
    assert_eq!(AngularInertia::ZERO, AngularInertia { principal: Vec3::ZERO, local_frame: Quat::IDENTITY });
    assert_eq!(I::from(SymmetricMatrix::IDENTITY), I::new(Vector::ONE));
    assert_eq!(AngularVelocity::from(Vector::X).x, 1.0);
    let locks = LockedAxes::new().lock_translation_z().lock_rotation_x().lock_rotation_y().lock_rotation_z();
    assert_eq!(locks.unlock_rotation_x().to_bits(), 0b001_011);
    let locks = locks.unlock_rotation_y().unlock_rotation_z().unlock_translation_z();
    assert!(locks.is_rotation_x_locked() && !locks.is_rotation_y_locked() && !locks.is_rotation_z_locked());
    assert!(!locks.is_translation_z_locked());
}
