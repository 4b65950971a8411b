//! [`SphericalMotor`]: turns a [`SphericalJoint`](super::SphericalJoint) to a rotation.

use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::{
    math::{Rot as KernelRot, atan2},
    solver::{
        JointDef, OrientationMotor,
        coordinate::{SWING_Y, SWING_Z, TWIST},
    },
};

use super::super::{
    kind::{angular_motor, orientation_motor},
    motor::{AngularMotor, MotorModel},
};
use crate::{
    math::{Quaternion, Scalar, Vector, vector_to_kernel},
    physics_transform::Rotation,
};

/// A motor that turns the second body of a [`SphericalJoint`](super::SphericalJoint) to a rotation and an
/// angular velocity. Beyond Avian.
///
/// Targets may change in every frame. A ragdoll follows an animated skeleton whose bone rotations are set as
/// targets, up to the maximum torque.
///
/// ```
/// # use avian3d::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # use bevy_math::{Quat, Vec3};
/// fn raise(mut shoulders: Query<&mut SphericalJoint>) {
///     for mut shoulder in &mut shoulders {
///         let model = MotorModel::SpringDamper { frequency: 4.0, damping_ratio: 1.0 };
///         let raised = Rotation::from(Quat::from_axis_angle(Vec3::Z, 1.2));
///         shoulder.motor = SphericalMotor::new(model).with_target_rotation(raised).with_max_torque(80.0);
///     }
/// }
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Default, PartialEq)]
pub struct SphericalMotor {
    /// Whether the motor acts.
    pub enabled: bool,
    /// The target rotation of the joint's second frame relative to the first.
    pub target_rotation: Quaternion,
    /// The target angular velocity of the second body relative to the first, along the axes of the joint's
    /// first frame, in rad/s.
    pub target_velocity: Vector,
    /// The axes that the motor drives, with stiffness, damping and maximum torque.
    pub drive: SphericalDrive,
}

crate::type_path::type_path!(SphericalMotor, "dynamics::joints::spherical");

/// The axes and strengths by which a [`SphericalMotor`] turns.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, PartialEq)]
pub enum SphericalDrive {
    /// One torque along the shortest arc (SLERP). The default.
    Slerp(AngularDrive),
    /// The twist about the twist axis and the swing about the two perpendicular axes, driven separately.
    TwistAndSwing {
        /// The drive of the twist.
        twist: AngularDrive,
        /// The drive of the swing.
        swing: AngularDrive,
    },
}

crate::type_path::type_path!(SphericalDrive, "dynamics::joints::spherical");

/// Strength of a motor about an axis.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Default, PartialEq)]
pub struct AngularDrive {
    /// Stiffness and damping.
    pub motor_model: MotorModel,
    /// Maximum torque, in N·m. [`Scalar::MAX`] for no maximum.
    pub max_torque: Scalar,
}

crate::type_path::type_path!(AngularDrive, "dynamics::joints::spherical");

impl Default for AngularDrive {
    fn default() -> Self {
        Self::new(MotorModel::DEFAULT)
    }
}

impl AngularDrive {
    /// A drive without a maximum torque.
    pub const fn new(motor_model: MotorModel) -> Self {
        Self { motor_model, max_torque: Scalar::MAX }
    }

    /// Sets the maximum torque, in N·m.
    pub const fn with_max_torque(mut self, max_torque: Scalar) -> Self {
        self.max_torque = max_torque;
        self
    }
}

impl Default for SphericalMotor {
    fn default() -> Self {
        Self::new(MotorModel::DEFAULT)
    }
}

impl SphericalMotor {
    /// An enabled motor along the shortest arc. Its target is equal frames at rest.
    pub const fn new(motor_model: MotorModel) -> Self {
        Self {
            enabled: true,
            target_rotation: Quaternion::IDENTITY,
            target_velocity: Vector::ZERO,
            drive: SphericalDrive::Slerp(AngularDrive::new(motor_model)),
        }
    }

    /// A disabled motor. Its target is equal frames at rest.
    pub const fn new_disabled(motor_model: MotorModel) -> Self {
        Self { enabled: false, ..Self::new(motor_model) }
    }

    /// Enables or disables the motor.
    pub const fn set_enabled(&mut self, enabled: bool) -> &mut Self {
        self.enabled = enabled;
        self
    }

    /// Sets the target rotation of the joint's second frame relative to the first.
    pub fn with_target_rotation(mut self, rotation: impl Into<Rotation>) -> Self {
        self.target_rotation = rotation.into().0;
        self
    }

    /// Sets the target angular velocity, along the axes of the joint's first frame, in rad/s.
    pub const fn with_target_velocity(mut self, velocity: Vector) -> Self {
        self.target_velocity = velocity;
        self
    }

    /// Sets the maximum torque, in N·m: the total torque along the shortest arc, or the torque about each
    /// axis if twist and swing are separate.
    pub const fn with_max_torque(mut self, max_torque: Scalar) -> Self {
        match &mut self.drive {
            SphericalDrive::Slerp(drive) => drive.max_torque = max_torque,
            SphericalDrive::TwistAndSwing { twist, swing } => {
                twist.max_torque = max_torque;
                swing.max_torque = max_torque;
            }
        }
        self
    }

    /// Drives twist and swing separately.
    pub const fn with_twist_and_swing(mut self, twist: AngularDrive, swing: AngularDrive) -> Self {
        self.drive = SphericalDrive::TwistAndSwing { twist, swing };
        self
    }

    /// Sets the motors of a joint whose frames were rotated by `turn`, which makes their x axis the twist
    /// axis.
    pub(super) fn set_motors(&self, def: &mut JointDef, turn: KernelRot) {
        if !self.enabled {
            return;
        }
        let target = Rotation(self.target_rotation).to_kernel().admitted();
        let target_rotation = turn.inverse().mul(target).mul(turn);
        let target_velocity = turn.inverse_rotate(vector_to_kernel(self.target_velocity));
        let (twisting, swinging) = match self.drive {
            SphericalDrive::Slerp(drive) => {
                let motor = orientation_motor(drive.motor_model, drive.max_torque);
                def.orientation =
                    motor.map(|motor| OrientationMotor { target_rotation, target_velocity, ..motor });
                return;
            }
            SphericalDrive::TwistAndSwing { twist, swing } => (twist, swing),
        };
        let [twist, y, z] = twist_and_swing(target_rotation);
        for (coordinate, drive, position, velocity) in [
            (TWIST, twisting, twist, target_velocity.x),
            (SWING_Y, swinging, y, target_velocity.y),
            (SWING_Z, swinging, z, target_velocity.z),
        ] {
            let motor = AngularMotor::new(drive.motor_model)
                .with_max_torque(drive.max_torque)
                .with_target_position(Scalar::from(position))
                .with_target_velocity(Scalar::from(velocity));
            def.axes[coordinate].motor = angular_motor(&motor);
        }
    }
}

/// The twist angle of a rotation about x, and the y and z components of the swing's rotation vector, in rad.
///
/// With q = swing · twist, twist is the component of q about x, with half angle atan2(qx, qw), and swing is q
/// times the inverse of twist.
fn twist_and_swing(q: KernelRot) -> [f32; 3] {
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    let [x, y, z, w] = [q.x, q.y, q.z, q.w].map(|part| f64::from(part * sign));
    let n = (x * x + w * w).sqrt();
    let (sin, cos) = if n > 0.0 { (x / n, w / n) } else { (0.0, 1.0) };
    let (sy, sz) = (cos * y - sin * z, cos * z + sin * y);
    let s = (sy * sy + sz * sz).sqrt();
    let factor = if s > 0.0 { 2.0 * atan2(s, n) / s } else { 2.0 };
    [2.0 * atan2(x, w), sy * factor, sz * factor].map(|angle| angle as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use kernel::math::Vector as KernelVector;

    #[test]
    fn a_rotation_is_a_twist_and_then_a_swing() {
        for (twist, y, z) in
            [(0.0, 0.0, 0.0), (1.2, 0.0, 0.0), (0.0, 0.7, 0.0), (-2.0, 0.5, -1.1), (3.0, -1.0, 2.0)]
        {
            let turn = |v: Vector| {
                let q = Quaternion::from_scaled_axis(v);
                Rotation(q).to_kernel()
            };
            let swing = turn(Vector::new(0.0, y, z));
            let q = swing.mul(turn(Vector::X * twist));
            let found = twist_and_swing(q);
            let apart = |i: usize, wanted: Scalar| (Scalar::from(found[i]) - wanted).abs();
            assert!(apart(0, twist) < 1e-5 && apart(1, y) < 1e-5 && apart(2, z) < 1e-5, "{found:?}");
            let x = swing.rotate(KernelVector::X);
            assert!((q.rotate(KernelVector::X) - x).length() < 1e-5, "twist leaves the axis");
        }
    }
}
