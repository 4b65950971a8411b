//! The algebra of all other modules, in both dimensions and for any lane.
//!
//! Each concept is a small type with the *same operations* in 2D and 3D, so solver rows are written once. `N`
//! is `f32`, a wide lane, or (for world positions only) `f64`.
//!
//! Rotations: [`Rot`] is the only rotation type (a unit complex number in 2D, a unit quaternion in 3D).
//! [`Pose`] is a rotation and a translation between frames, [`WorldPose`] a pose with a position in
//! [`Scalar`] precision. Quantities about an axis are [`Angular`].

/// Implements `+`, `-`, unary `-`, `* N`, `+=` and `-=` field by field.
macro_rules! componentwise {
    ($($type:ident { $($field:ident),+ })+) => {$(
        impl<N: Lane> $type<N> {
            /// `a` where the mask is set, else `b`.
            #[inline(always)]
            pub fn select(mask: N::Mask, a: Self, b: Self) -> Self {
                Self { $($field: N::select(mask, a.$field, b.$field)),+ }
            }
        }
        impl<N: Num> core::ops::Add for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn add(self, other: Self) -> Self {
                Self { $($field: self.$field + other.$field),+ }
            }
        }
        impl<N: Num> core::ops::Sub for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn sub(self, other: Self) -> Self {
                Self { $($field: self.$field - other.$field),+ }
            }
        }
        impl<N: Num> core::ops::Neg for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn neg(self) -> Self {
                Self { $($field: -self.$field),+ }
            }
        }
        impl<N: Num> core::ops::Mul<N> for $type<N> {
            type Output = Self;
            #[inline(always)]
            fn mul(self, factor: N) -> Self {
                Self { $($field: self.$field * factor),+ }
            }
        }
        impl<N: Num> core::ops::AddAssign for $type<N> {
            #[inline(always)]
            fn add_assign(&mut self, other: Self) {
                *self = *self + other;
            }
        }
        impl<N: Num> core::ops::SubAssign for $type<N> {
            #[inline(always)]
            fn sub_assign(&mut self, other: Self) {
                *self = *self - other;
            }
        }
    )+};
}

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod double;
mod entry;
mod lane;
#[cfg(target_arch = "x86_64")]
mod lane_avx;
#[cfg(not(target_arch = "x86_64"))]
mod lane_portable;
mod lane_shared;
#[cfg(target_arch = "x86_64")]
mod lane_sse;
#[cfg(feature = "3d")]
mod needle3;
mod num;
mod pose;
#[cfg_attr(feature = "2d", path = "tangent2.rs")]
#[cfg_attr(feature = "3d", path = "tangent3.rs")]
mod tangent;
mod trig;

pub use dim::*;
pub use double::Double;
pub(crate) use entry::{Entry, Job};
pub(crate) use lane::inverse_of_positive;
pub use lane::{Avx2, Ids, Lane, Quad, Width, clamp, max, min};
#[cfg(target_arch = "x86_64")]
pub(crate) use lane_avx::F32x8;
#[cfg(not(target_arch = "x86_64"))]
pub use lane_portable::F32x4;
pub(crate) use lane_shared::Shared;
#[cfg(target_arch = "x86_64")]
pub use lane_sse::F32x4;
#[cfg(feature = "3d")]
pub(crate) use needle3::MAX_RATIO;
pub use num::Num;
pub use pose::{Pose, WorldPose, WorldVector};
pub(crate) use pose::{wide_position, world_position};
pub use tangent::{NormalMoment, Tangent, TangentFrame, TangentMass};
pub use trig::{atan2, atan2_lanes, cos, sin, sin_cos};

/// A rotation counts as of unit length if its squared length differs from 1 by at most this. A product of a
/// few rotations differs by a tenth of it; the integrator renormalises rotations of moving bodies.
const UNIT_TOLERANCE: f64 = 1.0e-5;

/// The precision of world positions: `f64` with the feature `f64`, otherwise `f32`. All other quantities are
/// `f32`.
#[cfg(feature = "f64")]
pub type Scalar = f64;
/// The precision of world positions: `f64` with the feature `f64`, otherwise `f32`. All other quantities are
/// `f32`.
#[cfg(not(feature = "f64"))]
pub type Scalar = f32;
