//! The kernel joint of each kind of joint, and the localization of global frames.

use bevy_ecs::{entity::Entity, world::World};
use kernel::{
    math::Vector as KernelVector,
    solver::{
        Axis, Drive, Give, JointDef, Motor, Spring,
        coordinate::{DISTANCE, X},
    },
};

use super::{
    DistanceJoint, FixedJoint, JointAnchor, JointBasis, JointDamping, JointFrame, LinearMotor, MotorModel,
    PrismaticJoint, RevoluteJoint,
    kind::{JointKind, definition},
    space::{ACROSS, ROTATIONS, TRANSLATIONS, rotation_of},
};
use crate::{
    math::{Scalar, Vector, vector_to_kernel},
    physics_transform::Rotation,
};

pub(super) fn entities() -> [Entity; 2] {
    let mut world = World::new();
    [world.spawn_empty().id(), world.spawn_empty().id()]
}

pub(super) fn define(joint: &impl JointKind) -> JointDef {
    definition(joint, [3, 5], None).expect("frames are local")
}

/// Whether an axis is locked at 0 with a compliance.
pub(super) fn is_locked(axis: Axis, compliance: f32) -> bool {
    let give = if compliance == 0.0 { Give::Rigid } else { Give::Compliance(compliance) };
    axis == Axis { limits: Some([0.0; 2]), give, ..Axis::FREE }
}

fn quarter() -> Rotation {
    Rotation::from(bevy_math::Quat::from_rotation_z(core::f32::consts::FRAC_PI_2))
}

#[test]
fn a_fixed_joint_locks_everything() {
    let [a, b] = entities();
    let joint = FixedJoint::new(a, b)
        .with_local_anchor1(Vector::X)
        .with_local_anchor2(Vector::Y * 2.0)
        .with_point_compliance(0.25)
        .with_angle_compliance(0.5);
    let def = define(&joint);
    assert_eq!((def.bodies, def.damping), ([3, 5], [0.0; 2]));
    assert_eq!(def.frames.map(|f| f.anchor), [Vector::X, Vector::Y * 2.0].map(vector_to_kernel));
    assert!(TRANSLATIONS.iter().all(|i| is_locked(def.axes[*i], 0.25)));
    assert!(ROTATIONS.iter().all(|i| is_locked(def.axes[*i], 0.5)));
    let locked = TRANSLATIONS.len() + ROTATIONS.len();
    assert_eq!(def.axes.iter().filter(|axis| **axis != Axis::FREE).count(), locked);
    assert!(is_locked(define(&FixedJoint::new(a, b)).axes[X], 0.0), "no compliance is rigid");
}

#[test]
fn a_distance_joint_limits_the_distance_unless_that_is_zero() {
    let [a, b] = entities();
    let rope = define(&DistanceJoint::new(a, b).with_limits(0.5, 2.0).with_compliance(0.125));
    assert_eq!(rope.axes[DISTANCE], Axis::limited(0.5, 2.0).with_give(Give::Compliance(0.125)));
    assert_eq!(rope.axes.iter().filter(|axis| **axis != Axis::FREE).count(), 1);
    let point = define(&DistanceJoint::new(a, b));
    assert!(
        TRANSLATIONS.iter().all(|i| is_locked(point.axes[*i], 0.0)) && point.axes[DISTANCE] == Axis::FREE
    );
    let apart = DistanceJoint::new(a, b).with_min_distance(1.0);
    assert_eq!((apart.limits.min, apart.limits.max), (1.0, Scalar::MAX));
    assert_eq!(
        DistanceJoint::new(a, b).with_limits(1.0, 3.0).with_min_distance(2.0).limits,
        (2.0, 3.0).into()
    );
}

#[test]
fn a_prismatic_joint_slides_along_the_x_axis_of_its_turned_frames() {
    let [a, b] = entities();
    let axis = Vector::X * 3.0 + Vector::Y * 4.0;
    let model = MotorModel::ForceBased { stiffness: 7.0, damping: 8.0 };
    let motor =
        LinearMotor::new(model).with_target_velocity(1.0).with_target_position(2.0).with_max_force(9.0);
    let joint = PrismaticJoint::new(a, b)
        .with_slider_axis(axis)
        .with_local_basis1(quarter())
        .with_limits(-1.0, 2.0)
        .with_align_compliance(0.25)
        .with_angle_compliance(0.5)
        .with_limit_compliance(0.125)
        .with_motor(motor);
    let def = define(&joint);
    let apart = |side: usize, axis: Vector| {
        let x = def.frames[side].basis.rotate(KernelVector::X);
        (x - vector_to_kernel(axis / 5.0)).length()
    };
    assert!(apart(0, quarter() * axis) < 1e-6 && apart(1, axis) < 1e-6);
    let drive = Drive::Force { stiffness: 7.0, damping: 8.0 };
    let motor = Motor { target_velocity: 1.0, target_position: 2.0, max_force: 9.0, drive };
    let slider = Axis::limited(-1.0, 2.0).with_give(Give::Compliance(0.125));
    assert_eq!(def.axes[X], Axis { motor: Some(motor), ..slider });
    assert!(ACROSS.iter().all(|i| is_locked(def.axes[*i], 0.25)));
    assert!(ROTATIONS.iter().all(|i| is_locked(def.axes[*i], 0.5)));
    assert_eq!(define(&PrismaticJoint::new(a, b)).axes[X], Axis::FREE, "neither limits nor a motor");
}

#[test]
fn motors_have_three_laws_and_a_switch() {
    let [a, b] = entities();
    let motor = |motor: LinearMotor| define(&PrismaticJoint::new(a, b).with_motor(motor)).axes[X].motor;
    let spring = motor(LinearMotor::default()).expect("it is enabled");
    assert_eq!(spring.drive, Drive::Spring(Spring { frequency: 5.0, damping_ratio: 1.0 }));
    assert_eq!(spring.max_force, f32::INFINITY, "no maximum");
    let model = MotorModel::AccelerationBased { stiffness: 2.0, damping: 3.0 };
    let acceleration = motor(LinearMotor::new(model)).map(|motor| motor.drive);
    assert_eq!(acceleration, Some(Drive::Acceleration { stiffness: 2.0, damping: 3.0 }));
    assert_eq!(motor(LinearMotor::new_disabled(model)), None);
    let nothing = MotorModel::SpringDamper { frequency: 0.0, damping_ratio: 1.0 };
    assert_eq!(motor(LinearMotor::new(nothing)), None);
}

#[test]
fn damping_is_handed_on() {
    let [a, b] = entities();
    let damping = JointDamping { linear: 0.5, angular: 2.0 };
    let def = definition(&FixedJoint::new(a, b), [0, 1], Some(&damping)).expect("frames are local");
    assert_eq!(def.damping, [0.5, 2.0]);
}

#[test]
fn frames_in_the_world_become_local() {
    let (position, rotation) = (Vector::X * 2.0 + Vector::Y, quarter());
    let point = Vector::X * 2.0 + Vector::Y * 4.0;
    let [anchor, kept] = JointAnchor::compute_local(
        JointAnchor::FromGlobal(point),
        JointAnchor::Local(point),
        position,
        position,
        &rotation,
        &rotation,
    );
    let back = position + rotation * anchor.local().expect("it is local");
    assert!((back - point).length() < 1e-5, "{back}");
    assert_eq!(kept, JointAnchor::Local(point), "local anchors stay");

    let frame = JointFrame { anchor: JointAnchor::FromGlobal(point), ..JointFrame::IDENTITY };
    assert!(!frame.is_local() && frame.get_local_isometry().is_none());
    let [a, b] = entities();
    let joint = RevoluteJoint::new(a, b).with_anchor(point).with_basis(rotation);
    assert!(definition(&joint, [0, 1], None).is_none(), "it has to be made local before");
    let [local, _] =
        JointFrame::compute_local(joint.frame1, joint.frame2, position, position, &rotation, &rotation);
    assert!(local.is_local() && local.get_local_isometry().is_some());
    let JointBasis::Local(basis) = local.basis else { panic!("{local:?}") };
    assert!((rotation_of(basis) * Vector::X - Vector::X).length() < 1e-6, "the body has the basis already");
}
