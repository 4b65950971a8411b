//! Inertia in 3D, and frames. `dim2.rs` exports the same names.

use bevy_math::{DMat3, DQuat, DVec3, Quat, Vec3};
use bevy_transform::prelude::Transform;
use glam_matrix_extras::SymmetricDMat3;

use super::frame::{HUGE, Matrix64, PartFrame, Vector64, sanitize};
use crate::{
    collision::collider::collider_transform::ColliderTransform,
    dynamics::rigid_body::mass_properties::{
        components::{AngularInertia, ComputedAngularInertia},
        eigen::{from_principal_axes, principal_axes},
        tensor::{invert, quaternion_to_matrix, rotated, shifted},
    },
    math::{AdjustPrecision, MassProperties},
};

/// The ratio of the number that represents an infinite principal value to the largest finite one. With a
/// larger ratio, rounding loses the finite values when the frame is rotated.
const INFINITE_RATIO: f64 = 1e9;
/// An angular inertia tensor in kg·m².
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Inertia(pub(in super::super) SymmetricDMat3);

impl Inertia {
    /// No inertia.
    pub(in super::super) const ZERO: Self = Self(SymmetricDMat3::ZERO);

    pub(super) fn from_properties(properties: &MassProperties) -> Self {
        Self::from_principal(properties.principal_angular_inertia, properties.local_inertial_frame)
    }

    pub(in super::super) fn from_component(inertia: &AngularInertia) -> Self {
        Self::from_principal(inertia.principal, inertia.local_frame)
    }

    fn from_principal(principal: Vec3, frame: Quat) -> Self {
        let mut values = DVec3::from_array(principal.to_array().map(sanitize));
        let largest = values.to_array().into_iter().filter(|v| *v < f64::from(f32::MAX)).fold(0.0, f64::max);
        if largest > 0.0 {
            values = values.min(DVec3::splat(largest * INFINITE_RATIO));
        }
        if frame == Quat::IDENTITY {
            return Self(SymmetricDMat3::from_diagonal(values));
        }
        Self(from_principal_axes(values, quaternion_to_matrix(frame.as_dquat())))
    }

    pub(super) fn scaled(self, factor: f64) -> Self {
        Self(self.0 * factor.min(HUGE))
    }

    /// The inertia in rotated axes: R I Rᵀ.
    pub(in super::super) fn rotated(self, rotation: Matrix64) -> Self {
        Self(rotated(self.0, rotation))
    }

    /// The inertia about a point at an offset from the centre of mass: I + m (|d|² 1 − d dᵀ).
    pub(in super::super) fn shifted(self, mass: f64, d: Vector64) -> Self {
        Self(shifted(self.0, mass, d))
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }

    /// The inertia for the solver. Infinite about axes where it is zero or beyond the range of `f32`.
    pub(in super::super) fn computed(self) -> ComputedAngularInertia {
        ComputedAngularInertia::from_inverse_tensor(invert(self.0).adjust_precision())
    }
}

pub(super) fn widen_vector(v: Vec3) -> Vector64 {
    v.as_dvec3()
}

pub(super) fn narrow_vector(v: Vector64) -> Vec3 {
    v.as_vec3()
}

pub(super) fn mass_properties(mass: f32, center: Vec3, inertia: Inertia) -> MassProperties {
    let (principal, axes) = principal_axes(inertia.0);
    let frame = DQuat::from_mat3(&axes).as_quat();
    MassProperties::new_with_local_frame(mass, narrow_vector(principal.max(DVec3::ZERO)), frame, center)
}

impl PartFrame {
    /// The frame of a collider in its body's frame. The collider's mass properties already include its scale.
    pub(in super::super) fn of_collider(transform: &ColliderTransform) -> Self {
        let [x, y, z, w] = transform.rotation.0.to_array().map(|component| component as f64);
        Self {
            translation: DVec3::from_array(
                transform.translation.to_array().map(|component| component as f64),
            ),
            rotation: quaternion_to_matrix(DQuat::from_xyzw(x, y, z, w)),
            scale: DVec3::ONE,
        }
    }

    /// A frame with the scale of an entity's `transform`.
    pub(in super::super) fn scaled_by(transform: &Transform) -> Self {
        Self { translation: DVec3::ZERO, rotation: DMat3::IDENTITY, scale: transform.scale.as_dvec3() }
    }

    /// The frame of an entity in its parent's frame.
    pub(in super::super) fn of_entity(transform: &Transform) -> Self {
        Self {
            translation: transform.translation.as_dvec3(),
            rotation: quaternion_to_matrix(transform.rotation.as_dquat()),
            scale: transform.scale.as_dvec3(),
        }
    }
}
