//! [`JointAxis`]: limits, springs and motors of one axis of a [`GenericJoint`](super::GenericJoint).

use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::solver::{Axis, Give, Spring};

use super::{
    kind::axis_motor,
    laws::law,
    motor::{AxisMotor, MotorModel},
};
use crate::math::{Scalar, to_f32};

/// The behaviour of a joint along or about one axis. Free by default.
///
/// ```
/// # use avian::prelude::*;
/// // Between -10 cm and 10 cm, with soft ends.
/// let axis = JointAxis::limited(-0.1, 0.1).with_soft_limits(8.0, 0.5);
/// assert!(!axis.is_locked() && JointAxis::LOCKED.is_locked());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub struct JointAxis {
    /// Minimum and maximum, in m or rad. `None` if the axis is free; two equal values if it is locked. Each
    /// limit may be infinite.
    pub limits: Option<[Scalar; 2]>,
    /// Softness of the limits, or of the lock.
    pub softness: JointSoftness,
    /// An additional spring. It has no effect if the axis is locked and rigid.
    pub spring: Option<AxisSpring>,
    /// The motor. Disabled by default. It has no effect if the axis is locked and rigid.
    pub motor: AxisMotor,
}

impl Default for JointAxis {
    fn default() -> Self {
        Self::FREE
    }
}

impl JointAxis {
    /// A free axis: no limits and no motor.
    pub const FREE: Self =
        Self { limits: None, softness: JointSoftness::Rigid, spring: None, motor: AxisMotor::DISABLED };

    /// An axis locked at 0.
    pub const LOCKED: Self = Self::limited(0.0, 0.0);

    /// An axis with a minimum and a maximum, in m or rad.
    pub const fn limited(min: Scalar, max: Scalar) -> Self {
        Self { limits: Some([min, max]), ..Self::FREE }
    }

    /// Whether the axis is locked at one value.
    pub fn is_locked(&self) -> bool {
        self.limits.is_some_and(|[min, max]| min == max)
    }

    /// Sets the compliance of the limits, in m/N or rad/(N·m). 0 is rigid.
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.softness = JointSoftness::Compliance(compliance);
        self
    }

    /// Adds a spring with rest position `rest`, in m or rad.
    pub const fn with_spring(mut self, rest: Scalar, model: MotorModel) -> Self {
        self.spring = Some(AxisSpring { rest, model });
        self
    }

    /// Makes the limits, or the lock, a spring with a frequency in Hz and a damping ratio. The spring behaves
    /// alike for all masses.
    pub const fn with_soft_limits(mut self, frequency: Scalar, damping_ratio: Scalar) -> Self {
        self.softness = JointSoftness::Spring { frequency, damping_ratio };
        self
    }

    /// Sets the motor.
    pub fn with_motor(mut self, motor: impl Into<AxisMotor>) -> Self {
        self.motor = motor.into();
        self
    }

    /// The axis in the kernel's type.
    pub(super) fn to_kernel(self) -> Axis {
        let limits = self.limits.map(|limits| limits.map(to_f32));
        let spring = self.spring.and_then(|AxisSpring { rest, model }| {
            Some(kernel::solver::AxisSpring { rest: to_f32(rest), law: law(model)? })
        });
        Axis { limits, give: self.softness.to_kernel(), spring, motor: axis_motor(&self.motor) }
    }
}

/// A spring along or about an axis of a joint.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub struct AxisSpring {
    /// The position at which the spring exerts no force, in m or rad.
    pub rest: Scalar,
    /// The spring's stiffness and damping.
    pub model: MotorModel,
}

/// The softness of a joint axis at its limits, or where it is locked.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub enum JointSoftness {
    /// As rigid as the substeps resolve.
    #[default]
    Rigid,
    /// A compliance in m/N or rad/(N·m), without damping. 0 is rigid.
    Compliance(Scalar),
    /// A damped oscillator that behaves alike for all masses.
    Spring {
        /// Frequency, in Hz. Positive.
        frequency: Scalar,
        /// Damping ratio. 0 is no damping, 1 is critical damping.
        damping_ratio: Scalar,
    },
}

impl JointSoftness {
    fn to_kernel(self) -> Give {
        match self {
            Self::Rigid | Self::Compliance(0.0) => Give::Rigid,
            Self::Compliance(compliance) => Give::Compliance(to_f32(compliance)),
            Self::Spring { frequency, damping_ratio } => {
                Give::Spring(Spring { frequency: to_f32(frequency), damping_ratio: to_f32(damping_ratio) })
            }
        }
    }
}
