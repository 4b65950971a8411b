//! The joints of a ragdoll in 3D. `dim2` exports the same names.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_math::Vec3;
use kernel::math::atan2;

use super::bone::{Bone, Ragdoll};
use crate::{
    collision::collider::Collider,
    dynamics::{
        joints::{AngularMotor, RevoluteJoint, SphericalJoint, SphericalMotor},
        rigid_body::mass_properties::bevy_heavy::ComputeMassProperties3d,
    },
    math::{AsF32, Quaternion, Scalar, Vector},
    physics_transform::Rotation,
};

/// The place of a joint.
pub(super) struct Place {
    pub(super) bodies: [Entity; 2],
    pub(super) anchors: [Vector; 2],
}

/// A point of the plan.
pub(super) fn vector([x, y]: [Scalar; 2], height: Scalar) -> Vector {
    Vector::new(x, y, 0.0) * height
}

/// A point of the plan.
pub(super) fn point(point: [Scalar; 2], height: Scalar) -> Vec3 {
    vector(point, height).f32()
}

/// The volume of a collider, in m³.
pub(super) fn volume(collider: &Collider) -> f32 {
    collider.mass(1.0)
}

/// The freedom of a bone's joint.
enum Freedom {
    /// A ball: the direction in which the parent sees the middle of all swings, the greatest swing and the
    /// greatest twist.
    Ball { toward: Vector, swing: Scalar, twist: Scalar },
    /// A hinge about the x axis: the least and the greatest angle.
    Hinge([Scalar; 2]),
}

/// The joint limits of a human. Arms and legs turn to the front, which is at negative z.
fn freedom(bone: Bone) -> Freedom {
    let side = bone.side();
    let ball = |toward, swing, twist| Freedom::Ball { toward, swing, twist };
    match bone {
        Bone::Pelvis | Bone::Chest => ball(Vector::Y, 0.6, 0.6),
        Bone::Head => ball(Vector::Y, 0.8, 1.0),
        Bone::LeftUpperArm | Bone::RightUpperArm => ball(Vector::new(-0.7 * side, 0.7, 0.5), 1.5, 1.0),
        Bone::LeftThigh | Bone::RightThigh => ball(Vector::new(-0.25 * side, 0.7, 0.6), 1.0, 0.5),
        Bone::LeftForearm | Bone::RightForearm => Freedom::Hinge([0.0, 2.5]),
        Bone::LeftShin | Bone::RightShin => Freedom::Hinge([-2.5, 0.0]),
    }
}

/// Spawns the joint of a bone.
pub(super) fn spawn_joint(
    commands: &mut Commands,
    bone: Bone,
    place: Place,
    drive: Option<AngularMotor>,
) -> Entity {
    let Place { bodies: [parent, child], anchors: [anchor1, anchor2] } = place;
    match freedom(bone) {
        Freedom::Ball { toward, swing, twist } => {
            // The twist axis is y, upwards on both bodies.
            let basis = Quaternion::from_rotation_arc(Vector::Y, toward.normalize());
            let mut joint = SphericalJoint::new(parent, child)
                .with_local_anchor1(anchor1)
                .with_local_anchor2(anchor2)
                .with_local_basis1(basis)
                .with_swing_limits(0.0, swing)
                .with_twist_limits(-twist, twist);
            if let Some(drive) = drive {
                joint.motor = SphericalMotor::new(drive.motor_model)
                    .with_max_torque(drive.max_torque)
                    .with_target_rotation(Rotation(basis.inverse()));
                joint.motor.set_enabled(drive.enabled);
            }
            commands.spawn(joint).id()
        }
        Freedom::Hinge([min, max]) => {
            let mut joint = RevoluteJoint::new(parent, child)
                .with_local_anchor1(anchor1)
                .with_local_anchor2(anchor2)
                .with_hinge_axis(Vector::X)
                .with_angle_limits(min, max);
            if let Some(drive) = drive {
                joint.motor = drive.with_target_position(0.0).with_target_velocity(0.0);
            }
            commands.spawn(joint).id()
        }
    }
}

/// The joints of all ragdolls, for setting the pose to which they are driven.
///
/// ```
/// # use avian3d::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # use bevy_math::Quat;
/// fn wave(ragdolls: Query<&Ragdoll>, mut joints: RagdollJoints) {
///     for ragdoll in &ragdolls {
///         joints.set_target(ragdoll, Bone::RightUpperArm, Quat::from_rotation_z(1.5));
///         joints.set_target(ragdoll, Bone::RightForearm, Quat::from_rotation_x(1.0));
///     }
/// }
/// ```
#[derive(SystemParam)]
pub struct RagdollJoints<'w, 's> {
    balls: Query<'w, 's, &'static mut SphericalJoint>,
    hinges: Query<'w, 's, &'static mut RevoluteJoint>,
}

impl RagdollJoints<'_, '_> {
    /// Sets the wanted rotation of a bone relative to its parent. The identity is the rotation at spawning.
    /// Elbows and knees take only the turn about the x axis.
    pub fn set_target(&mut self, ragdoll: &Ragdoll, bone: Bone, rotation: impl Into<Rotation>) {
        let (Some(joint), Rotation(rotation)) = (ragdoll.joint(bone), rotation.into()) else { return };
        if let Ok(mut ball) = self.balls.get_mut(joint)
            && let (Some(basis1), Some(basis2)) = (ball.local_basis1(), ball.local_basis2())
        {
            let target = basis1.inverse() * rotation * basis2;
            if ball.motor.target_rotation != target {
                ball.motor.target_rotation = target;
            }
        }
        if let Ok(mut hinge) = self.hinges.get_mut(joint) {
            let target = 2.0 * atan2(rotation.x.into(), rotation.w.into()) as Scalar;
            if hinge.motor.target_position != target {
                hinge.motor.target_position = target;
            }
        }
    }

    /// Turns the motors of all joints of a ragdoll on or off.
    pub fn set_enabled(&mut self, ragdoll: &Ragdoll, is_enabled: bool) {
        for joint in Bone::ALL.into_iter().filter_map(|bone| ragdoll.joint(bone)) {
            if let Ok(mut ball) = self.balls.get_mut(joint) {
                ball.motor.set_enabled(is_enabled);
            }
            if let Ok(mut hinge) = self.hinges.get_mut(joint) {
                hinge.motor.set_enabled(is_enabled);
            }
        }
    }
}
