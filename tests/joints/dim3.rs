//! 3D parts of the tests of joints: ball and socket, and axes across the plane.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{Quaternion, Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use super::joints::{G, INERTIA, MASS, Rig};

/// A body without a collider.
pub fn rod() -> impl Bundle {
    (RigidBody::Dynamic, Mass(MASS as f32), AngularInertia::new(Vec3::splat(INERTIA as f32)))
}

/// The angle about z, in radians.
pub fn angle_of(rotation: Rotation) -> Scalar {
    2.0 * rotation.z.atan2(rotation.w)
}

/// The component about z.
pub fn spin_of(velocity: AngularVelocity) -> Scalar {
    velocity.0.z
}

/// A wheel that spins about z.
pub fn dim_wheel(wheel: WheelJoint) -> WheelJoint {
    wheel.with_axle(Vector::Z)
}

/// The angle between a body's y axis and the world's.
fn swing(rig: &Rig, body: Entity) -> Scalar {
    (*rig.get::<Rotation>(body) * Vector::Y).angle_between(Vector::Y)
}

#[test]
fn a_ball_falls_over_as_far_as_its_swing_may() {
    for direction in [Vector::X, Vector::Z, Vector::new(0.6, 0.0, 0.8)] {
        let mut rig = Rig::new();
        let post = rig.post(0.0, 0.0);
        let arm = rig.rod(0.0, 1.0);
        let joint =
            SphericalJoint::new(post, arm).with_local_anchor2(Vector::NEG_Y).with_swing_limits(0.0, 0.6);
        rig.spawn(joint);
        rig.insert(arm, LinearVelocity(direction * 0.5));
        let mut widest: Scalar = 0.0;
        for _ in 0..256 {
            rig.step();
            widest = widest.max(swing(&rig, arm));
        }
        assert!(widest < 0.6 + 0.02, "{direction}: {widest} rad");
        assert!((swing(&rig, arm) - 0.6).abs() < 0.01, "it leans on the limit: {}", swing(&rig, arm));
        assert!((rig.place(arm).length() - 1.0).abs() < 1e-3, "it stays on the ball");
    }
}

#[test]
fn a_twist_ends_at_its_limit() {
    let mut rig = Rig::weightless();
    let post = rig.post(0.0, 0.0);
    let arm = rig.rod(0.0, 0.0);
    rig.insert(arm, AngularVelocity(Vector::Y * 2.0));
    rig.spawn(SphericalJoint::new(post, arm).with_twist_limits(-0.5, 0.75));
    let mut widest: Scalar = 0.0;
    for _ in 0..128 {
        rig.step();
        let turn = rig.get::<Rotation>(arm).0;
        widest = widest.max(2.0 * turn.y.atan2(turn.w));
    }
    assert!(widest > 0.7 && widest < 0.75 + 0.02, "{widest} rad");
}

#[test]
fn a_hinge_keeps_its_axis_in_any_frame() {
    let mut rig = Rig::weightless();
    let basis = Quaternion::from_rotation_x(0.7) * Quaternion::from_rotation_y(0.4);
    let post = rig.post(0.0, 0.0);
    let wheel = rig.rod(0.0, 0.0);
    let joint = RevoluteJoint::new(post, wheel).with_hinge_axis(Vector::X).with_basis(basis);
    let axis = basis * Vector::X;
    // Half of it is about the axis.
    rig.insert(wheel, AngularVelocity(axis * 2.0 + axis.any_orthonormal_vector() * 2.0));
    rig.spawn(joint);
    rig.steps(128);
    let spin = rig.get::<AngularVelocity>(wheel).0;
    assert!((spin - axis * 2.0).length() < 0.02, "{spin}");
    let tilt = (*rig.get::<Rotation>(wheel) * axis).angle_between(axis);
    assert!(tilt < 0.01, "{tilt} rad");
}

#[test]
fn a_second_joint_of_an_entity_replaces_the_first() {
    let mut rig = Rig::new();
    let post = rig.post(0.0, 0.0);
    let rod = rig.rod(0.0, -1.0);
    let joint = rig.spawn((SphericalJoint::new(post, rod).with_local_anchor2(Vector::Y), JointForces::new()));
    rig.step();
    rig.insert(joint, DistanceJoint::new(post, rod).with_limits(0.0, 1.0));
    rig.steps(8);
    assert!(rig.app.world().get::<SphericalJoint>(joint).is_none() && rig.acts(joint));
    rig.remove::<DistanceJoint>(joint);
    rig.steps(8);
    assert!(!rig.acts(joint));
}

/// The turn that a body has made, in its own axes.
fn apart(rotation: Quaternion, other: Quaternion) -> Scalar {
    rotation.angle_between(other)
}

#[test]
fn a_ball_turns_to_its_target_and_follows_a_new_one() {
    let mut rig = Rig::weightless();
    let (post, arm) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    let basis = Quaternion::from_rotation_z(0.5);
    let target = Quaternion::from_scaled_axis(Vector::new(0.7, -1.1, 0.4));
    let motor = SphericalMotor::default().with_target_rotation(Rotation(target));
    let joint = SphericalJoint::new(post, arm).with_local_basis1(basis).with_motor(motor);
    let joint = rig.spawn(joint);
    rig.steps(128);
    let now = rig.get::<Rotation>(arm).0;
    assert!(apart(now, basis * target) < 1e-3, "{}", apart(now, basis * target));
    let target = Quaternion::from_scaled_axis(Vector::new(-0.3, 2.0, 0.9));
    rig.app.world_mut().get_mut::<SphericalJoint>(joint).expect("a joint").motor.target_rotation = target;
    rig.steps(128);
    let now = rig.get::<Rotation>(arm).0;
    assert!(apart(now, basis * target) < 1e-3, "{}", apart(now, basis * target));
}

#[test]
fn a_ball_reaches_a_velocity_about_its_twist_axis() {
    let mut rig = Rig::weightless();
    let (post, arm) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    let model = MotorModel::AccelerationBased { stiffness: 0.0, damping: 20.0 };
    let motor = SphericalMotor::new(model).with_target_velocity(Vector::Y * 3.0);
    rig.spawn(SphericalJoint::new(post, arm).with_motor(motor));
    rig.steps(128);
    let spin = rig.get::<AngularVelocity>(arm).0;
    assert!((spin - Vector::Y * 3.0).length() < 0.03, "{spin}");
}

/// An arm of length L needs the torque m g L to stay level.
#[test]
fn a_swing_motor_stalls_where_a_twist_motor_would_not() {
    for (share, stays) in [(0.5, false), (1.5, true)] {
        let mut rig = Rig::new();
        let (post, arm) = (rig.post(0.0, 0.0), rig.rod(1.0, 0.0));
        let model = MotorModel::SpringDamper { frequency: 10.0, damping_ratio: 1.0 };
        let swing = AngularDrive::new(model).with_max_torque(share * MASS * G);
        let motor = SphericalMotor::default().with_twist_and_swing(AngularDrive::new(model), swing);
        rig.spawn(SphericalJoint::new(post, arm).with_local_anchor2(Vector::NEG_X).with_motor(motor));
        rig.steps(48);
        assert_eq!(rig.angle(arm) > -0.05, stays, "{share}: {} rad", rig.angle(arm));
    }
}

#[test]
fn a_motor_without_a_rotation_has_no_effect() {
    let mut rig = Rig::new();
    let (post, arm) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    for motor in [
        SphericalMotor { target_rotation: Quaternion::from_xyzw(0.0, 0.0, 0.0, 0.0), ..Default::default() },
        SphericalMotor::default().with_target_velocity(Vector::NAN),
        SphericalMotor::default().with_max_torque(-1.0),
    ] {
        rig.spawn(SphericalJoint::new(post, arm).with_motor(motor));
    }
    rig.steps(64);
    assert!((rig.place(arm).y + 5.0).abs() < 0.1, "it falls: {}", rig.place(arm));
}

#[test]
fn a_wheel_is_steered_about_its_suspension() {
    let mut rig = Rig::weightless();
    let (chassis, wheel) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    let model = MotorModel::AccelerationBased { stiffness: 0.0, damping: 20.0 };
    let spin = AngularMotor::new(model).with_target_velocity(5.0);
    let steering = AngularMotor::default().with_target_position(0.5);
    let joint = WheelJoint::new(chassis, wheel).with_motor(spin).with_steering(steering);
    let joint = rig.spawn(joint.with_steering_limits(-0.4, 0.4));
    rig.steps(128);
    let axle = *rig.get::<Rotation>(wheel) * Vector::X;
    let wanted = Quaternion::from_rotation_y(0.4) * Vector::X;
    // What spins tilts its axle a little: the joint gives way to the torque of the turning spin.
    assert!(axle.angle_between(wanted) < 0.02, "its limit holds it: {axle}");
    let speed = rig.get::<AngularVelocity>(wheel).0;
    assert!(speed.dot(axle) > 4.9, "and it spins: {speed}");
    rig.app.world_mut().get_mut::<WheelJoint>(joint).expect("a wheel").steering.set_enabled(false);
    rig.steps(128);
    let axle = *rig.get::<Rotation>(wheel) * Vector::X;
    assert!(axle.angle_between(Vector::X) < 0.01, "without steering it is straight: {axle}");
}

/// The anchors of a ragdoll's joint.
pub fn anchors(rig: &Rig, joint: Entity) -> [Vector; 2] {
    let world = rig.app.world();
    let ball = world.get::<SphericalJoint>(joint).map(|ball| [ball.local_anchor1(), ball.local_anchor2()]);
    let hinge = world.get::<RevoluteJoint>(joint).map(|hinge| [hinge.local_anchor1(), hinge.local_anchor2()]);
    ball.or(hinge).expect("a joint").map(|anchor| anchor.expect("it is local"))
}

fn relative(rig: &Rig, ragdoll: &Ragdoll, bone: Bone) -> Quaternion {
    let Some(parent) = bone.parent() else { return Quaternion::IDENTITY };
    let [a, b] = [parent, bone].map(|bone| rig.get::<Rotation>(ragdoll.bone(bone)).0);
    a.inverse() * b
}

/// How far a bone is turned against its parent, in rad.
pub fn bone_turn(rig: &Rig, ragdoll: &Ragdoll, bone: Bone) -> Scalar {
    apart(relative(rig, ragdoll, bone), Quaternion::IDENTITY)
}

/// How far a bone is beyond its limits of swing or angle, in rad.
pub fn swing_beyond(rig: &Rig, ragdoll: &Ragdoll, bone: Bone) -> Scalar {
    let Some(joint) = ragdoll.joint(bone) else { return 0.0 };
    let turn = relative(rig, ragdoll, bone);
    if let Some(ball) = rig.app.world().get::<SphericalJoint>(joint) {
        let (axis, limit) =
            (ball.local_twist_axis1().expect("it is local"), ball.swing_limit.expect("it has limits"));
        return (axis.angle_between(turn * Vector::Y) - limit.max).max(0.0);
    }
    let limit = rig.get::<RevoluteJoint>(joint).angle_limit.expect("it has limits");
    let angle = 2.0 * turn.x.atan2(turn.w);
    (angle - limit.max).max(limit.min - angle).max(0.0)
}

/// A turn of a bone: forearms about x, others outwards.
pub fn bend(bone: Bone, angle: Scalar) -> Rotation {
    let is_elbow = matches!(bone, Bone::LeftForearm | Bone::RightForearm);
    let axis = if is_elbow { Vector::X } else { Vector::Z };
    Rotation(Quaternion::from_axis_angle(axis, angle))
}

/// On the shortest arc the axis of the turn stays.
#[test]
fn by_default_a_ball_takes_the_shortest_arc() {
    let mut rig = Rig::weightless();
    let (post, arm) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    rig.insert(arm, SleepingDisabled);
    let axis = Vector::new(1.0, 2.0, -2.0) / 3.0;
    let target = Quaternion::from_axis_angle(axis, 2.5);
    let model = MotorModel::SpringDamper { frequency: 1.0, damping_ratio: 1.0 };
    let motor = SphericalMotor::new(model).with_target_rotation(Rotation(target));
    rig.spawn(SphericalJoint::new(post, arm).with_motor(motor));
    for _ in 0..48 {
        rig.step();
        let turn = rig.get::<Rotation>(arm).0.to_scaled_axis();
        assert!(turn.length() < 1e-3 || turn.normalize().dot(axis) > 0.9999, "{turn}");
    }
    rig.steps(128);
    assert!(apart(rig.get::<Rotation>(arm).0, target) < 1e-3);
}

/// With a torque τ the spin is τ t / I, about any axis, and the reported torque is τ.
#[test]
fn the_greatest_torque_is_that_about_any_axis() {
    for axis in [Vector::X, Vector::Y, Vector::new(0.6, 0.0, 0.8)] {
        let mut rig = Rig::weightless();
        let (post, arm) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
        let model = MotorModel::AccelerationBased { stiffness: 0.0, damping: 20.0 };
        let motor = SphericalMotor::new(model).with_target_velocity(axis * 100.0).with_max_torque(0.25);
        let joint = rig.spawn((SphericalJoint::new(post, arm).with_motor(motor), JointForces::new()));
        rig.steps(64);
        let spin = rig.get::<AngularVelocity>(arm).0;
        assert!((spin - axis * 0.25 / INERTIA).length() < 0.01, "{spin}");
        assert!((rig.get::<JointForces>(joint).motor_force() - 0.25).abs() < 0.005);
    }
}
