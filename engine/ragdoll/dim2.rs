//! The joints of a ragdoll in 2D, seen from the front. `dim3` exports the same names.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_math::Vec3;

use super::bone::{Bone, Ragdoll};
use crate::{
    collision::collider::Collider,
    dynamics::{
        joints::{AngularMotor, RevoluteJoint},
        rigid_body::mass_properties::bevy_heavy::ComputeMassProperties2d,
    },
    math::{AsF32, Scalar, Vector},
    physics_transform::Rotation,
};

/// The place of a joint.
pub(super) struct Place {
    pub(super) bodies: [Entity; 2],
    pub(super) anchors: [Vector; 2],
}

/// A point of the plan.
pub(super) fn vector([x, y]: [Scalar; 2], height: Scalar) -> Vector {
    Vector::new(x, y) * height
}

/// A point of the plan.
pub(super) fn point(point: [Scalar; 2], height: Scalar) -> Vec3 {
    vector(point, height).f32().extend(0.0)
}

/// The area of a collider, in m².
pub(super) fn volume(collider: &Collider) -> f32 {
    collider.mass(1.0)
}

/// The least and the greatest angle of a bone: inward and outward for arms and legs.
fn limits(bone: Bone) -> [Scalar; 2] {
    let [inward, outward] = match bone {
        Bone::Pelvis | Bone::Chest => [0.5, 0.5],
        Bone::Head => [0.7, 0.7],
        Bone::LeftUpperArm | Bone::RightUpperArm => [0.2, 2.8],
        Bone::LeftForearm | Bone::RightForearm => [0.0, 2.5],
        Bone::LeftThigh | Bone::RightThigh => [0.1, 1.5],
        Bone::LeftShin | Bone::RightShin => [2.0, 0.0],
    };
    // Outward is counter-clockwise on the right side.
    if bone.side() > 0.0 { [-inward, outward] } else { [-outward, inward] }
}

/// Spawns the joint of a bone.
pub(super) fn spawn_joint(
    commands: &mut Commands,
    bone: Bone,
    place: Place,
    drive: Option<AngularMotor>,
) -> Entity {
    let Place { bodies: [parent, child], anchors: [anchor1, anchor2] } = place;
    let [min, max] = limits(bone);
    let mut joint = RevoluteJoint::new(parent, child)
        .with_local_anchor1(anchor1)
        .with_local_anchor2(anchor2)
        .with_angle_limits(min, max);
    if let Some(drive) = drive {
        joint.motor = drive.with_target_position(0.0).with_target_velocity(0.0);
    }
    commands.spawn(joint).id()
}

/// The joints of all ragdolls, for setting the pose to which they are driven.
///
/// ```
/// # use avian2d::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn wave(ragdolls: Query<&Ragdoll>, mut joints: RagdollJoints) {
///     for ragdoll in &ragdolls {
///         joints.set_target(ragdoll, Bone::RightUpperArm, Rotation::radians(2.0));
///     }
/// }
/// ```
#[derive(SystemParam)]
pub struct RagdollJoints<'w, 's> {
    hinges: Query<'w, 's, &'static mut RevoluteJoint>,
}

impl RagdollJoints<'_, '_> {
    /// Sets the wanted rotation of a bone relative to its parent. The identity is the rotation at spawning.
    pub fn set_target(&mut self, ragdoll: &Ragdoll, bone: Bone, rotation: impl Into<Rotation>) {
        let target = rotation.into().as_radians();
        if let Some(joint) = ragdoll.joint(bone)
            && let Ok(mut hinge) = self.hinges.get_mut(joint)
            && hinge.motor.target_position != target
        {
            hinge.motor.target_position = target;
        }
    }

    /// Turns the motors of all joints of a ragdoll on or off.
    pub fn set_enabled(&mut self, ragdoll: &Ragdoll, is_enabled: bool) {
        for joint in Bone::ALL.into_iter().filter_map(|bone| ragdoll.joint(bone)) {
            if let Ok(mut hinge) = self.hinges.get_mut(joint) {
                hinge.motor.set_enabled(is_enabled);
            }
        }
    }
}
