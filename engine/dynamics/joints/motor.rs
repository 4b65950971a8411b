//! Motors of joints.

use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::math::Scalar;

/// The strength with which a motor drives towards its target position and velocity.
///
/// The force is k (target position − position) + c (target velocity − velocity), up to the motor's maximum.
/// It is integrated implicitly, so large coefficients do not make it unstable.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub enum MotorModel {
    /// k and c of a damped oscillator that behaves alike for all masses: k = m (2π f)², c = 2 m ζ 2π f.
    SpringDamper {
        /// f, in Hz.
        frequency: Scalar,
        /// ζ: 0 for no damping, 1 for critical damping.
        damping_ratio: Scalar,
    },
    /// k and c are given: heavy bodies are slower.
    ForceBased {
        /// k, in N/m or N·m/rad.
        stiffness: Scalar,
        /// c, in N·s/m or N·m·s/rad.
        damping: Scalar,
    },
    /// k and c are given per mass, or per moment of inertia: bodies of all masses move alike.
    AccelerationBased {
        /// k per mass, in 1/s².
        stiffness: Scalar,
        /// c per mass, in 1/s.
        damping: Scalar,
    },
}

impl Default for MotorModel {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl MotorModel {
    /// A critically damped spring of 5 Hz.
    pub const DEFAULT: Self = Self::SpringDamper { frequency: 5.0, damping_ratio: 1.0 };
}

/// Defines a motor with a maximum torque or force.
macro_rules! motor {
    (
        $(#[$doc:meta])*
        $motor:ident, $max:ident, $with_max:ident, velocity in $velocity:literal, position in $position:literal,
        $effort:literal
    ) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Reflect)]
        #[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
        #[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
        #[reflect(Debug, Default, PartialEq)]
        pub struct $motor {
            /// Whether the motor acts.
            pub enabled: bool,
            #[doc = concat!("The wanted velocity of the second body relative to the first, in ", $velocity, ".")]
            pub target_velocity: Scalar,
            #[doc = concat!("The wanted position of the second body relative to the first, in ", $position, ".")]
            pub target_position: Scalar,
            #[doc = concat!("The greatest ", $effort, ". [`Scalar::MAX`] by default, for no maximum.")]
            pub $max: Scalar,
            /// The motor's stiffness and damping.
            pub motor_model: MotorModel,
        }

        impl Default for $motor {
            fn default() -> Self {
                Self::new(MotorModel::DEFAULT)
            }
        }

        impl $motor {
            /// An enabled motor, with targets of 0.
            pub const fn new(motor_model: MotorModel) -> Self {
                Self {
                    enabled: true,
                    target_velocity: 0.0,
                    target_position: 0.0,
                    $max: Scalar::MAX,
                    motor_model,
                }
            }

            /// A disabled motor, with targets of 0.
            pub const fn new_disabled(motor_model: MotorModel) -> Self {
                Self { enabled: false, ..Self::new(motor_model) }
            }

            /// Enables or disables the motor.
            pub const fn set_enabled(&mut self, enabled: bool) -> &mut Self {
                self.enabled = enabled;
                self
            }

            #[doc = concat!("Sets the wanted velocity, in ", $velocity, ".")]
            pub const fn with_target_velocity(mut self, velocity: Scalar) -> Self {
                self.target_velocity = velocity;
                self
            }

            #[doc = concat!("Sets the wanted position, in ", $position, ".")]
            pub const fn with_target_position(mut self, target_position: Scalar) -> Self {
                self.target_position = target_position;
                self
            }

            #[doc = concat!("Sets the greatest ", $effort, ".")]
            pub const fn $with_max(mut self, max: Scalar) -> Self {
                self.$max = max;
                self
            }

            /// Sets the motor's stiffness and damping.
            pub const fn with_motor_model(mut self, motor_model: MotorModel) -> Self {
                self.motor_model = motor_model;
                self
            }
        }
    };
}

motor! {
    /// A motor that turns the second body of a joint relative to the first.
    ///
    /// ```
    /// # use avian::prelude::*;
    /// # use bevy_ecs::prelude::*;
    /// fn spin(mut wheels: Query<&mut RevoluteJoint>) {
    ///     for mut wheel in &mut wheels {
    ///         // Towards 10 rad/s, wherever it is, with 50 N·m at most.
    ///         let model = MotorModel::AccelerationBased { stiffness: 0.0, damping: 20.0 };
    ///         wheel.motor = AngularMotor::new(model).with_target_velocity(10.0).with_max_torque(50.0);
    ///     }
    /// }
    /// ```
    AngularMotor, max_torque, with_max_torque, velocity in "rad/s", position in "radians", "torque, in N·m"
}

motor! {
    /// A motor that moves the second body of a joint along an axis of the first.
    ///
    /// ```
    /// # use avian::prelude::*;
    /// # use bevy_ecs::prelude::*;
    /// fn lift(mut lifts: Query<&mut PrismaticJoint>) {
    ///     for mut lift in &mut lifts {
    ///         // To 3 m, as a critically damped spring of 1 Hz.
    ///         let model = MotorModel::SpringDamper { frequency: 1.0, damping_ratio: 1.0 };
    ///         lift.motor = LinearMotor::new(model).with_target_position(3.0);
    ///     }
    /// }
    /// ```
    LinearMotor, max_force, with_max_force, velocity in "m/s", position in "metres", "force, in N"
}

motor! {
    /// A motor along or about an axis of a [`GenericJoint`](super::GenericJoint): a [`LinearMotor`] or an
    /// [`AngularMotor`].
    AxisMotor, max_effort, with_max_effort, velocity in "m/s or rad/s", position in "metres or radians",
    "force in N, or torque in N·m"
}

impl AxisMotor {
    /// A disabled motor.
    pub const DISABLED: Self = Self::new_disabled(MotorModel::DEFAULT);
}

/// Implements the conversion of a motor to an [`AxisMotor`].
macro_rules! to_axis_motor {
    ($($motor:ident: $max:ident),+) => {$(
        impl From<$motor> for AxisMotor {
            fn from(motor: $motor) -> Self {
                let $motor { enabled, target_velocity, target_position, $max: max_effort, motor_model } = motor;
                Self { enabled, target_velocity, target_position, max_effort, motor_model }
            }
        }
    )+};
}

to_axis_motor!(LinearMotor: max_force, AngularMotor: max_torque);
