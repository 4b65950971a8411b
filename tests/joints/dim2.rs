//! 2D parts of the tests of joints.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;

use super::joints::{INERTIA, MASS, Rig};

/// A body without a collider.
pub fn rod() -> impl Bundle {
    (RigidBody::Dynamic, Mass(MASS as f32), AngularInertia(INERTIA as f32))
}

/// The angle about z, in radians.
pub fn angle_of(rotation: Rotation) -> Scalar {
    rotation.as_radians()
}

/// The component about z.
pub fn spin_of(velocity: AngularVelocity) -> Scalar {
    velocity.0
}

/// A wheel that spins about z.
pub fn dim_wheel(wheel: WheelJoint) -> WheelJoint {
    wheel
}

/// The anchors of a ragdoll's joint.
pub fn anchors(rig: &Rig, joint: Entity) -> [Vector; 2] {
    let joint = rig.get::<RevoluteJoint>(joint);
    [joint.local_anchor1(), joint.local_anchor2()].map(|anchor| anchor.expect("it is local"))
}

fn angle_between(rig: &Rig, ragdoll: &Ragdoll, bone: Bone) -> Scalar {
    let Some(parent) = bone.parent() else { return 0.0 };
    let [a, b] = [parent, bone].map(|bone| *rig.get::<Rotation>(ragdoll.bone(bone)));
    (a.inverse() * b).as_radians()
}

/// How far a bone is turned against its parent, in rad.
pub fn bone_turn(rig: &Rig, ragdoll: &Ragdoll, bone: Bone) -> Scalar {
    angle_between(rig, ragdoll, bone).abs()
}

/// How far a bone is beyond its limit, in rad.
pub fn swing_beyond(rig: &Rig, ragdoll: &Ragdoll, bone: Bone) -> Scalar {
    let Some(joint) = ragdoll.joint(bone) else { return 0.0 };
    let limit = rig.get::<RevoluteJoint>(joint).angle_limit.expect("it has limits");
    let angle = angle_between(rig, ragdoll, bone);
    // A limit of 2.8 is passed on the other side of π.
    (angle - limit.max).max(limit.min - angle).max(0.0)
}

/// A turn of a bone outwards.
pub fn bend(bone: Bone, angle: Scalar) -> Rotation {
    let is_left = matches!(bone, Bone::LeftUpperArm | Bone::LeftForearm | Bone::LeftThigh);
    Rotation::radians(if is_left { -angle } else { angle })
}
