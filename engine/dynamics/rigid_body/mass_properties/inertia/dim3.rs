//! Inertia in space, and frames. `dim2.rs` is the twin.

use bevy_math::{DMat3, DQuat, DVec3, Quat, Vec3};
use bevy_transform::prelude::Transform;
use glam_matrix_extras::SymmetricDMat3;

use super::{Frame, HUGE, narrow_vector as narrow, sanitize};
use crate::{
    collision::collider::collider_transform::ColliderTransform,
    dynamics::rigid_body::mass_properties::{
        components::{AngularInertia, ComputedAngularInertia},
        eigen::{from_principal_axes, principal_axes},
    },
    math::{AdjustPrecision, MassProperties},
};

/// A vector in `f64`.
pub(in super::super) type Vector64 = DVec3;
/// A matrix in `f64`.
pub(in super::super) type Matrix64 = DMat3;

/// How much larger than the largest finite principal value an infinite one counts: as far as `f64` goes
/// without losing the others when the frame is turned.
const INFINITE_RATIO: f64 = 1e9;
/// Principal values below this share of the largest are rounding errors of a zero.
const SINGULAR: f64 = 1e-13;

/// An angular inertia tensor in kg·m².
#[derive(Clone, Copy, Debug)]
pub(in super::super) struct Inertia(pub(in super::super) SymmetricDMat3);

impl Inertia {
    /// None.
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

    /// In other axes: R I Rᵀ.
    pub(in super::super) fn rotated(self, rotation: Matrix64) -> Self {
        if rotation == DMat3::IDENTITY {
            return self;
        }
        let product = rotation * self.0.to_mat3() * rotation.transpose();
        Self(SymmetricDMat3::from_mat3_unchecked(product))
    }

    /// About a point off the centre of mass: I + m (|d|² 1 − d dᵀ).
    pub(in super::super) fn shifted(self, mass: f64, d: Vector64) -> Self {
        let m = self.0;
        Self(SymmetricDMat3::new(
            m.m00 + mass * (d.y * d.y + d.z * d.z),
            m.m01 - mass * d.x * d.y,
            m.m02 - mass * d.x * d.z,
            m.m11 + mass * (d.x * d.x + d.z * d.z),
            m.m12 - mass * d.y * d.z,
            m.m22 + mass * (d.x * d.x + d.y * d.y),
        ))
    }

    pub(super) fn plus(self, other: Self) -> Self {
        Self(self.0 + other.0)
    }

    /// For the solver; infinite about the axes where it is none, or what `f32` cannot hold.
    pub(in super::super) fn computed(self) -> ComputedAngularInertia {
        ComputedAngularInertia::from_inverse_tensor(invert(self.0).adjust_precision())
    }
}

/// The inverse of a positive semidefinite tensor within the axes where it is neither zero nor infinite; zero on
/// the others.
pub(in super::super) fn invert(tensor: SymmetricDMat3) -> SymmetricDMat3 {
    if !tensor.is_finite() {
        return SymmetricDMat3::ZERO;
    }
    let (values, axes) = principal_axes(tensor);
    let smallest = values.max_element() * SINGULAR;
    let inverse = values
        .to_array()
        .map(|value| if value > smallest && value < f64::from(f32::MAX) { 1.0 / value } else { 0.0 });
    if axes == DMat3::IDENTITY {
        return SymmetricDMat3::from_diagonal(DVec3::from_array(inverse));
    }
    from_principal_axes(DVec3::from_array(inverse), axes)
}

/// The rotation matrix of a quaternion of any length but zero, which gives the identity.
pub(in super::super) fn quaternion_to_matrix(q: DQuat) -> DMat3 {
    let square = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
    if !(square > 0.0 && square.is_finite()) {
        return DMat3::IDENTITY;
    }
    let k = 2.0 / square;
    let (xx, yy, zz) = (q.x * q.x * k, q.y * q.y * k, q.z * q.z * k);
    let (xy, xz, yz) = (q.x * q.y * k, q.x * q.z * k, q.y * q.z * k);
    let (wx, wy, wz) = (q.w * q.x * k, q.w * q.y * k, q.w * q.z * k);
    DMat3::from_cols(
        DVec3::new(1.0 - yy - zz, xy + wz, xz - wy),
        DVec3::new(xy - wz, 1.0 - xx - zz, yz + wx),
        DVec3::new(xz + wy, yz - wx, 1.0 - xx - yy),
    )
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
    MassProperties::new_with_local_frame(mass, narrow(principal.max(DVec3::ZERO)), frame, center)
}

impl Frame {
    /// Where a collider lies in its body. Its scale is in its mass properties already.
    #[allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]
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

    /// A frame whose lengths are scaled as an entity's `transform` says.
    pub(in super::super) fn scaled_by(transform: &Transform) -> Self {
        Self { translation: DVec3::ZERO, rotation: DMat3::IDENTITY, scale: transform.scale.as_dvec3() }
    }

    /// Where an entity lies in its parent.
    pub(in super::super) fn of_entity(transform: &Transform) -> Self {
        Self {
            translation: transform.translation.as_dvec3(),
            rotation: quaternion_to_matrix(transform.rotation.as_dquat()),
            scale: transform.scale.as_dvec3(),
        }
    }
}
