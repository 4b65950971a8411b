//! Angular inertia in 3D: a symmetric tensor, or principal values with their axes. `dim2.rs` has the scalar
//! of 2D.

use bevy_ecs::prelude::*;
use bevy_heavy::AngularInertiaTensor;
use bevy_math::{Mat3, Quat, Vec3};
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use glam_matrix_extras::{MatConversionError, SymmetricMat3};

use super::super::{
    eigen::{from_principal_axes, principal_axes},
    tensor::{invert, quaternion_to_matrix, rotated, shifted},
};
use super::{AngularInertiaError, CenterOfMass, ComputedCenterOfMass};
use crate::math::{
    AdjustPrecision, AsF32, ComputeMassProperties, MassProperties, Quaternion, RecipOrZero, Scalar,
    SymmetricMatrix, SymmetricMatrix3, Vector,
};

/// The angular inertia of a body about its centre of mass, or of a part of the body on a descendant, in
/// kg·m². Given as principal values with their axes.
///
/// It replaces the inertia of the collider on the same entity. The body's total, [`ComputedAngularInertia`],
/// is the sum over the body and its descendants about the common centre of mass. With
/// [`NoAutoAngularInertia`](super::NoAutoAngularInertia) it is only the body's own inertia. Infinity is
/// allowed. Negative values and NaN count as 0, with a warning.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
#[doc(alias = "MomentOfInertia")]
pub struct AngularInertia {
    /// The inertia about each axis of the local frame, in kg·m².
    pub principal: Vec3,
    /// The frame of the principal axes, in the entity's frame.
    pub local_frame: Quat,
}

crate::type_path::type_path!(AngularInertia, "dynamics::rigid_body::mass_properties::components");

impl AngularInertia {
    /// No inertia.
    pub const ZERO: Self = Self { principal: Vec3::ZERO, local_frame: Quat::IDENTITY };

    /// An inertia whose principal axes are the entity's own. Negative values and NaN panic in debug builds.
    pub fn new(principal_angular_inertia: Vec3) -> Self {
        Self::new_with_local_frame(principal_angular_inertia, Quat::IDENTITY)
    }

    /// An inertia whose principal axes are the entity's own. Negative values and NaN are errors.
    pub fn try_new(principal_angular_inertia: Vec3) -> Result<Self, AngularInertiaError> {
        Self::try_new_with_local_frame(principal_angular_inertia, Quat::IDENTITY)
    }

    /// An inertia with its own principal axes. Negative values and NaN panic in debug builds.
    pub fn new_with_local_frame(principal_angular_inertia: Vec3, local_frame: Quat) -> Self {
        let inertia = Self { principal: principal_angular_inertia, local_frame };
        debug_assert!(inertia.is_valid(), "an inertia is not negative and not NaN, this is {inertia:?}");
        inertia
    }

    /// An inertia with its own principal axes. Negative values and NaN are errors.
    pub fn try_new_with_local_frame(
        principal_angular_inertia: Vec3,
        local_frame: Quat,
    ) -> Result<Self, AngularInertiaError> {
        check(principal_angular_inertia.to_array())
            .map(|()| Self { principal: principal_angular_inertia, local_frame })
    }

    /// An inertia from its tensor. The principal axes are computed. Negative values caused by rounding become
    /// zero.
    pub fn from_tensor(tensor: impl Into<AngularInertiaTensor>) -> Self {
        Self::from_symmetric_mat3(tensor.into().as_symmetric_mat3())
    }

    /// An inertia from its tensor. The principal axes are computed. Negative values caused by rounding become
    /// zero.
    pub fn from_symmetric_mat3(mat: SymmetricMat3) -> Self {
        let (principal, axes) = principal_axes(mat.as_symmetric_dmat3());
        Self {
            principal: principal.as_vec3().max(Vec3::ZERO),
            local_frame: bevy_math::DQuat::from_mat3(&axes).as_quat(),
        }
    }

    /// An inertia from its tensor, which must be exactly symmetric.
    pub fn try_from_mat3(mat: Mat3) -> Result<Self, MatConversionError> {
        SymmetricMat3::try_from_mat3(mat).map(Self::from_symmetric_mat3)
    }

    /// An inertia from the lower triangle of its tensor.
    pub fn from_mat3_unchecked(mat: Mat3) -> Self {
        Self::from_symmetric_mat3(SymmetricMat3::from_mat3_unchecked(mat))
    }

    /// The inertia of a shape of `mass` kg about its centroid.
    pub fn from_shape<T: ComputeMassProperties>(shape: &T, mass: f32) -> Self {
        Self { principal: shape.principal_angular_inertia(mass), local_frame: shape.local_inertial_frame() }
    }

    /// The tensor in the entity's frame.
    pub fn tensor(self) -> AngularInertiaTensor {
        let axes = quaternion_to_matrix(self.local_frame.as_dquat());
        from_principal_axes(self.principal.as_dvec3(), axes).as_symmetric_mat3().into()
    }

    /// Whether no number is infinite or NaN.
    pub fn is_finite(self) -> bool {
        self.principal.is_finite() && self.local_frame.is_finite()
    }

    /// Whether a number is NaN.
    pub fn is_nan(self) -> bool {
        self.principal.is_nan() || self.local_frame.is_nan()
    }

    /// Whether the value is valid: no negative values, no NaN, and a unit rotation.
    pub(in super::super) fn is_valid(self) -> bool {
        check(self.principal.to_array()).is_ok() && self.local_frame.is_finite()
    }
}

impl TryFrom<Mat3> for AngularInertia {
    type Error = MatConversionError;
    fn try_from(mat: Mat3) -> Result<Self, Self::Error> {
        Self::try_from_mat3(mat)
    }
}

impl From<SymmetricMat3> for AngularInertia {
    fn from(mat: SymmetricMat3) -> Self {
        Self::from_symmetric_mat3(mat)
    }
}

impl From<AngularInertiaTensor> for AngularInertia {
    fn from(tensor: AngularInertiaTensor) -> Self {
        Self::from_tensor(tensor)
    }
}

impl From<AngularInertia> for AngularInertiaTensor {
    fn from(inertia: AngularInertia) -> Self {
        inertia.tensor()
    }
}

/// The total angular inertia of a body about its centre of mass, in its own frame, in kg·m². Stored as the
/// inverse of the tensor, so an infinite inertia about an axis is 0. An inertia of 0 also means infinite.
///
/// Computed from [`AngularInertia`] and the colliders. Static bodies have infinite inertia. Write it only
/// with [`NoAutoAngularInertia`](super::NoAutoAngularInertia).
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
#[doc(alias = "ComputedMomentOfInertia")]
pub struct ComputedAngularInertia {
    inverse: SymmetricMatrix,
}

crate::type_path::type_path!(
    ComputedAngularInertia,
    "dynamics::rigid_body::mass_properties::components::computed"
);

impl Default for ComputedAngularInertia {
    fn default() -> Self {
        Self::INFINITY
    }
}

impl ComputedAngularInertia {
    /// Infinite inertia: the body cannot be rotated.
    pub const INFINITY: Self = Self { inverse: SymmetricMatrix::ZERO };

    /// An inertia whose principal axes are the body's own, in kg·m²; 0 about an axis means infinite. Negative
    /// values and NaN panic in debug builds and give infinite inertia in release builds.
    pub fn new(principal_angular_inertia: Vector) -> Self {
        Self::new_with_local_frame(principal_angular_inertia, Quaternion::IDENTITY)
    }

    /// An inertia whose principal axes are the body's own, in kg·m²; 0 about an axis means infinite. Negative
    /// values and NaN are errors.
    pub fn try_new(principal_angular_inertia: Vector) -> Result<Self, AngularInertiaError> {
        Self::try_new_with_local_frame(principal_angular_inertia, Quaternion::IDENTITY)
    }

    /// An inertia with principal axes `orientation`, in kg·m²; 0 about an axis means infinite. Negative
    /// values and NaN panic in debug builds and give infinite inertia in release builds.
    pub fn new_with_local_frame(principal_angular_inertia: Vector, orientation: Quaternion) -> Self {
        let result = Self::try_new_with_local_frame(principal_angular_inertia, orientation);
        debug_assert!(
            result.is_ok(),
            "an inertia is not negative and not NaN, this is {principal_angular_inertia}"
        );
        result.unwrap_or(Self::INFINITY)
    }

    /// An inertia with principal axes `orientation`, in kg·m²; 0 about an axis means infinite. Negative
    /// values and NaN are errors.
    pub fn try_new_with_local_frame(
        principal_angular_inertia: Vector,
        orientation: Quaternion,
    ) -> Result<Self, AngularInertiaError> {
        check(principal_angular_inertia.to_array())?;
        let inverse = SymmetricMatrix::from_diagonal(principal_angular_inertia.recip_or_zero());
        Ok(Self { inverse }.rotated(orientation))
    }

    /// An inertia from its tensor in the body's frame, in kg·m². The body cannot be rotated about axes with
    /// zero inertia.
    pub fn from_tensor(tensor: SymmetricMatrix) -> Self {
        Self { inverse: invert(widen(tensor)).adjust_precision() }
    }

    /// An inertia from the inverse of its tensor, in 1/(kg·m²).
    pub fn from_inverse_tensor(inverse_tensor: SymmetricMatrix) -> Self {
        Self { inverse: inverse_tensor }
    }

    /// The tensor in the body's frame, in kg·m². It is 0 about axes with infinite inertia.
    pub fn value(self) -> SymmetricMatrix {
        invert(widen(self.inverse)).adjust_precision()
    }

    /// The inverse of the tensor, in 1/(kg·m²).
    pub fn inverse(self) -> SymmetricMatrix {
        self.inverse
    }

    /// The tensor in the body's frame, in kg·m². It is 0 about axes with infinite inertia.
    pub fn tensor(self) -> SymmetricMatrix {
        self.value()
    }

    /// The inverse of the tensor, in 1/(kg·m²).
    pub fn inverse_tensor(self) -> SymmetricMatrix {
        self.inverse
    }

    /// The inverse of the tensor, to be written. It must stay positive semidefinite.
    pub fn inverse_tensor_mut(&mut self) -> &mut SymmetricMatrix {
        &mut self.inverse
    }

    /// Replaces the inertia.
    pub fn set(&mut self, angular_inertia: impl Into<ComputedAngularInertia>) {
        *self = angular_inertia.into();
    }

    /// The principal values in kg·m², and the frame of their axes relative to the body.
    pub fn principal_angular_inertia_with_local_frame(&self) -> (Vector, Quaternion) {
        let (inverse, axes) = principal_axes(widen(self.inverse));
        let principal = inverse.recip_or_zero().max(bevy_math::DVec3::ZERO);
        (principal.adjust_precision(), bevy_math::DQuat::from_mat3(&axes).adjust_precision())
    }

    /// The inertia in a frame in which the body is rotated by `rotation`: R I Rᵀ.
    #[must_use]
    pub fn rotated(self, rotation: Quaternion) -> Self {
        let q = rotation.to_array();
        // The identity leaves the bits unchanged.
        if q[0] == 0.0 && q[1] == 0.0 && q[2] == 0.0 {
            return self;
        }
        let [x, y, z, w] = q.map(AdjustDouble::double);
        let rotation = quaternion_to_matrix(bevy_math::DQuat::from_xyzw(x, y, z, w));
        Self { inverse: rotated(widen(self.inverse), rotation).adjust_precision() }
    }

    /// The tensor of a body of `mass` kg about a point at `offset` metres from its centre of mass, by the
    /// parallel axis theorem: I + m (|d|² 1 − d dᵀ). An infinite inertia counts as 0.
    pub fn shifted_tensor(&self, mass: Scalar, offset: Vector) -> SymmetricMatrix3 {
        self.shifted(mass, offset).adjust_precision()
    }

    /// The inverse of [`shifted_tensor`](Self::shifted_tensor).
    pub fn shifted_inverse_tensor(&self, mass: Scalar, offset: Vector) -> SymmetricMatrix3 {
        invert(self.shifted(mass, offset)).adjust_precision()
    }

    /// Whether the inertia is neither infinite nor NaN. It may still be infinite about some axes.
    pub fn is_finite(self) -> bool {
        !self.is_infinite() && !self.is_nan()
    }

    /// Whether the body cannot be rotated about any axis.
    pub fn is_infinite(self) -> bool {
        self == Self::INFINITY
    }

    /// Whether a number is NaN.
    pub fn is_nan(self) -> bool {
        self.inverse.is_nan()
    }

    fn shifted(&self, mass: Scalar, offset: Vector) -> glam_matrix_extras::SymmetricDMat3 {
        let offset = bevy_math::DVec3::from_array(offset.to_array().map(AdjustDouble::double));
        shifted(invert(widen(self.inverse)), mass.double(), offset)
    }
}

/// Converts either precision to `f64`.
trait AdjustDouble {
    fn double(self) -> f64;
}

impl AdjustDouble for f32 {
    fn double(self) -> f64 {
        f64::from(self)
    }
}

impl AdjustDouble for f64 {
    fn double(self) -> f64 {
        self
    }
}

fn widen(m: SymmetricMatrix) -> glam_matrix_extras::SymmetricDMat3 {
    glam_matrix_extras::SymmetricDMat3::new(
        m.m00.double(),
        m.m01.double(),
        m.m02.double(),
        m.m11.double(),
        m.m12.double(),
        m.m22.double(),
    )
}

fn check<S: Copy + PartialOrd + Default>(values: [S; 3]) -> Result<(), AngularInertiaError> {
    let zero = S::default();
    if values.iter().any(|v| v.partial_cmp(&zero).is_none()) {
        Err(AngularInertiaError::NaN)
    } else if values.iter().any(|v| *v < zero) {
        Err(AngularInertiaError::Negative)
    } else {
        Ok(())
    }
}

impl From<SymmetricMatrix> for ComputedAngularInertia {
    fn from(tensor: SymmetricMatrix) -> Self {
        Self::from_tensor(tensor)
    }
}

impl From<AngularInertia> for ComputedAngularInertia {
    fn from(inertia: AngularInertia) -> Self {
        Self::new_with_local_frame(
            inertia.principal.adjust_precision(),
            inertia.local_frame.adjust_precision(),
        )
    }
}

impl From<ComputedAngularInertia> for AngularInertia {
    fn from(inertia: ComputedAngularInertia) -> Self {
        let (principal, frame) = inertia.principal_angular_inertia_with_local_frame();
        Self { principal: principal.f32(), local_frame: frame.f32() }
    }
}

impl From<&MassProperties> for AngularInertia {
    fn from(properties: &MassProperties) -> Self {
        Self { principal: properties.principal_angular_inertia, local_frame: properties.local_inertial_frame }
    }
}

impl core::ops::Mul<Vector> for ComputedAngularInertia {
    type Output = Vector;
    fn mul(self, factor: Vector) -> Vector {
        self.tensor() * factor
    }
}

impl CenterOfMass {
    /// Makes a centre of mass from its coordinates in metres.
    pub const fn new(x: f32, y: f32, z: f32) -> Self {
        Self(Vec3::new(x, y, z))
    }
}

impl ComputedCenterOfMass {
    /// Makes a centre of mass from its coordinates in metres.
    pub const fn new(x: Scalar, y: Scalar, z: Scalar) -> Self {
        Self(Vector::new(x, y, z))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A quarter turn about z, which swaps x and y.
    fn quarter() -> Quaternion {
        let half = core::f64::consts::FRAC_1_SQRT_2;
        bevy_math::DQuat::from_xyzw(0.0, 0.0, half, half).adjust_precision()
    }

    fn close(a: SymmetricMatrix, b: SymmetricMatrix) -> bool {
        (a - b).to_mat3().abs_diff_eq(crate::math::Matrix::ZERO, 1e-5)
    }

    #[test]
    fn an_inertia_keeps_its_value_and_inverse() {
        let inertia = ComputedAngularInertia::new(Vector::new(1.0, 2.0, 4.0));
        assert_eq!(inertia.value(), SymmetricMatrix::from_diagonal(Vector::new(1.0, 2.0, 4.0)));
        assert_eq!(inertia.inverse(), SymmetricMatrix::from_diagonal(Vector::new(1.0, 0.5, 0.25)));
        assert_eq!((inertia.tensor(), inertia.inverse_tensor()), (inertia.value(), inertia.inverse()));
        assert!(inertia.is_finite() && !inertia.is_infinite() && !inertia.is_nan());
        assert_eq!(ComputedAngularInertia::from_tensor(inertia.value()), inertia);
        assert_eq!(ComputedAngularInertia::from_inverse_tensor(inertia.inverse()), inertia);
        assert_eq!(AngularInertia::from(inertia), AngularInertia::new(Vec3::new(1.0, 2.0, 4.0)));
        assert_eq!(inertia * Vector::ONE, Vector::new(1.0, 2.0, 4.0));
        let mut other = ComputedAngularInertia::default();
        other.set(AngularInertia::new(Vec3::new(1.0, 2.0, 4.0)));
        assert_eq!(other, inertia);
    }

    #[test]
    fn a_frame_turns_the_tensor() {
        let turned = SymmetricMatrix::from_diagonal(Vector::new(2.0, 1.0, 4.0));
        let inertia = ComputedAngularInertia::new_with_local_frame(Vector::new(1.0, 2.0, 4.0), quarter());
        assert!(close(inertia.value(), turned));
        assert!(close(
            ComputedAngularInertia::new(Vector::new(1.0, 2.0, 4.0)).rotated(quarter()).value(),
            turned
        ));
        let user = AngularInertia::new_with_local_frame(Vec3::new(1.0, 2.0, 4.0), quarter().f32());
        assert!(close(user.tensor().as_symmetric_mat3().adjust_precision(), turned));
        let tilted = SymmetricMat3::new(3.0, 0.5, -0.25, 2.0, 0.125, 4.0);
        let back = AngularInertia::from_tensor(tilted).tensor().as_symmetric_mat3();
        assert!(close(back.adjust_precision(), tilted.adjust_precision()));
        let computed = ComputedAngularInertia::from(AngularInertia::from(tilted));
        assert!(close(computed.value(), tilted.adjust_precision()));
        let (principal, frame) = computed.principal_angular_inertia_with_local_frame();
        assert!(close(
            ComputedAngularInertia::new_with_local_frame(principal, frame).value(),
            computed.value()
        ));
    }

    #[test]
    fn zero_and_infinity_are_infinite_about_their_axis_alone() {
        let inertia = ComputedAngularInertia::new(Vector::new(0.0, Scalar::INFINITY, 2.0));
        assert_eq!(inertia.inverse(), SymmetricMatrix::from_diagonal(Vector::new(0.0, 0.0, 0.5)));
        assert!(inertia.is_finite() && !inertia.is_infinite());
        assert_eq!(inertia.value(), SymmetricMatrix::from_diagonal(Vector::new(0.0, 0.0, 2.0)));
        // Weights on a pole: no inertia about the pole, much across it.
        let pole =
            ComputedAngularInertia::from_tensor(SymmetricMatrix::from_diagonal(Vector::new(0.0, 8.0, 8.0)));
        assert_eq!(pole.inverse(), SymmetricMatrix::from_diagonal(Vector::new(0.0, 0.125, 0.125)));
        assert!(ComputedAngularInertia::INFINITY.is_infinite());
        assert_eq!(ComputedAngularInertia::INFINITY.value(), SymmetricMatrix::ZERO);
    }

    #[test]
    fn what_is_no_inertia_is_an_error() {
        let negative = Vector::new(1.0, -1.0, 1.0);
        let nan = Vector::new(1.0, 1.0, Scalar::NAN);
        assert_eq!(ComputedAngularInertia::try_new(negative), Err(AngularInertiaError::Negative));
        assert_eq!(ComputedAngularInertia::try_new(nan), Err(AngularInertiaError::NaN));
        assert_eq!(AngularInertia::try_new(negative.f32()), Err(AngularInertiaError::Negative));
        assert_eq!(AngularInertia::try_new(nan.f32()), Err(AngularInertiaError::NaN));
        let asymmetric = Mat3::from_cols_array(&[1.0, 0.5, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        assert_eq!(AngularInertia::try_from_mat3(asymmetric), Err(MatConversionError::Asymmetric));
    }

    #[test]
    fn shifting_follows_the_parallel_axis_theorem() {
        let inertia = ComputedAngularInertia::new(Vector::ONE);
        let shifted = inertia.shifted_tensor(2.0, Vector::new(0.0, 3.0, 0.0));
        assert_eq!(shifted, SymmetricMatrix::from_diagonal(Vector::new(19.0, 1.0, 19.0)));
        let inverse = inertia.shifted_inverse_tensor(2.0, Vector::new(0.0, 0.5, 0.0));
        assert!(close(inverse, SymmetricMatrix::from_diagonal(Vector::new(2.0 / 3.0, 1.0, 2.0 / 3.0))));
    }
}
