//! Operations on inertia tensors in `f64`.

use bevy_math::{DMat3, DQuat, DVec3};
use glam_matrix_extras::SymmetricDMat3;

use super::eigen::{from_principal_axes, principal_axes};

/// Principal values below this fraction of the largest count as zero: they are rounding errors.
const SINGULAR: f64 = 1e-13;

/// The inverse of a positive semidefinite tensor along principal axes where it is neither zero nor infinite.
/// Zero along the other axes.
pub(super) fn invert(tensor: SymmetricDMat3) -> SymmetricDMat3 {
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

/// The rotation matrix of a quaternion of any length. Zero gives the identity.
pub(super) fn quaternion_to_matrix(q: DQuat) -> DMat3 {
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

/// The tensor in rotated axes: R I Rᵀ.
pub(super) fn rotated(tensor: SymmetricDMat3, rotation: DMat3) -> SymmetricDMat3 {
    if rotation == DMat3::IDENTITY {
        return tensor;
    }
    SymmetricDMat3::from_mat3_unchecked(rotation * tensor.to_mat3() * rotation.transpose())
}

/// The tensor about a point at an offset from the centre of mass: I + m (|d|² 1 − d dᵀ).
pub(super) fn shifted(tensor: SymmetricDMat3, mass: f64, d: DVec3) -> SymmetricDMat3 {
    SymmetricDMat3::new(
        tensor.m00 + mass * (d.y * d.y + d.z * d.z),
        tensor.m01 - mass * d.x * d.y,
        tensor.m02 - mass * d.x * d.z,
        tensor.m11 + mass * (d.x * d.x + d.z * d.z),
        tensor.m12 - mass * d.y * d.z,
        tensor.m22 + mass * (d.x * d.x + d.y * d.y),
    )
}
