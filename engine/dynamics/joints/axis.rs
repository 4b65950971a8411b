//! [`JointAxis`]: what a [`GenericJoint`](super::GenericJoint) does along or about one axis.

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

/// What a joint does along or about one axis: free by default.
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
    /// The least and the greatest value, in m or rad: none if the axis is free, one value twice if it is
    /// locked there. An end may be infinite.
    pub limits: Option<[Scalar; 2]>,
    /// How far the axis gives way at its limits, or where it is locked.
    pub softness: JointSoftness,
    /// A spring besides. It has no effect where the axis is locked and rigid.
    pub spring: Option<AxisSpring>,
    /// The motor. Disabled by default. It has no effect where the axis is locked and rigid.
    pub motor: AxisMotor,
}

impl Default for JointAxis {
    fn default() -> Self {
        Self::FREE
    }
}

impl JointAxis {
    /// Without limits and motor.
    pub const FREE: Self =
        Self { limits: None, softness: JointSoftness::Rigid, spring: None, motor: AxisMotor::DISABLED };

    /// Held at 0.
    pub const LOCKED: Self = Self::limited(0.0, 0.0);

    /// Between two values, in m or rad.
    pub const fn limited(min: Scalar, max: Scalar) -> Self {
        Self { limits: Some([min, max]), ..Self::FREE }
    }

    /// Whether it is held at one value.
    pub fn is_locked(&self) -> bool {
        self.limits.is_some_and(|[min, max]| min == max)
    }

    /// Sets how far the limits give way, in m/N or rad/(N·m). 0 is rigid.
    pub const fn with_compliance(mut self, compliance: Scalar) -> Self {
        self.softness = JointSoftness::Compliance(compliance);
        self
    }

    /// Adds a spring that bears nothing at `rest`, in m or rad.
    pub const fn with_spring(mut self, rest: Scalar, model: MotorModel) -> Self {
        self.spring = Some(AxisSpring { rest, model });
        self
    }

    /// Makes the limits, or where it is locked, a spring with a frequency in Hz and a damping ratio,
    /// whatever the masses.
    pub const fn with_soft_limits(mut self, frequency: Scalar, damping_ratio: Scalar) -> Self {
        self.softness = JointSoftness::Spring { frequency, damping_ratio };
        self
    }

    /// Sets the motor.
    pub fn with_motor(mut self, motor: impl Into<AxisMotor>) -> Self {
        self.motor = motor.into();
        self
    }

    /// The kernel's axis.
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
    /// Where it bears nothing, in m or rad.
    pub rest: Scalar,
    /// Its stiffness and damping.
    pub model: MotorModel,
}

/// How far an axis of a joint gives way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub enum JointSoftness {
    /// As little as the substeps resolve.
    #[default]
    Rigid,
    /// By this many metres per newton, or radians per newton metre, without damping. 0 is rigid.
    Compliance(Scalar),
    /// As a damped oscillator, whatever the masses.
    Spring {
        /// In Hz. Positive.
        frequency: Scalar,
        /// 0 for no damping, 1 for critical damping.
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
