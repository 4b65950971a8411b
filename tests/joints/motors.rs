//! Motors reach their targets, and stall at their maximum.

use super::*;

/// A motor that only wants a velocity.
const TOWARDS: MotorModel = MotorModel::AccelerationBased { stiffness: 0.0, damping: 20.0 };

#[test]
fn a_wheel_reaches_its_speed_with_each_model() {
    let models = [
        TOWARDS,
        MotorModel::ForceBased { stiffness: 0.0, damping: 20.0 * INERTIA },
        MotorModel::ForceBased { stiffness: 0.0, damping: 1.0e5 },
    ];
    for model in models {
        let mut rig = Rig::weightless();
        let (post, wheel) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
        let motor = AngularMotor::new(model).with_target_velocity(3.0);
        rig.spawn(RevoluteJoint::new(post, wheel).with_motor(motor));
        rig.steps(64);
        assert!((rig.spin(wheel) - 3.0).abs() < 0.03, "{model:?}: {} rad/s", rig.spin(wheel));
    }
}

/// With a torque τ the spin is τ t / I until it has its target.
#[test]
fn a_wheel_speeds_up_by_no_more_than_its_torque() {
    let mut rig = Rig::weightless();
    let (post, wheel) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    let torque: Scalar = 0.25;
    let motor = AngularMotor::new(TOWARDS).with_target_velocity(100.0).with_max_torque(torque);
    let joint = rig.spawn((RevoluteJoint::new(post, wheel).with_motor(motor), JointForces::new()));
    rig.steps(64);
    let expected = torque / INERTIA;
    assert!((rig.spin(wheel) / expected - 1.0).abs() < 0.01, "{} rad/s", rig.spin(wheel));
    let forces = rig.get::<JointForces>(joint);
    assert!((forces.motor_force() / torque - 1.0).abs() < 0.02, "{}", forces.motor_force());
}

/// An arm of length L needs the torque m g L to stay level.
#[test]
fn an_arm_stalls_if_its_weight_is_more_than_its_torque() {
    for (share, stays) in [(0.5, false), (1.5, true)] {
        let mut rig = Rig::new();
        let (post, arm) = (rig.post(0.0, 0.0), rig.rod(1.0, 0.0));
        let model = MotorModel::SpringDamper { frequency: 10.0, damping_ratio: 1.0 };
        let motor = AngularMotor::new(model).with_max_torque(share * MASS * G);
        rig.spawn(RevoluteJoint::new(post, arm).with_local_anchor2(xy(-1.0, 0.0)).with_motor(motor));
        rig.steps(48);
        let angle = rig.angle(arm);
        assert_eq!(angle > -0.05, stays, "{share}: {angle} rad");
    }
}

#[test]
fn a_lift_rises_to_its_target_and_follows_a_new_one() {
    let mut rig = Rig::new();
    let (post, cabin) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    let model = MotorModel::SpringDamper { frequency: 4.0, damping_ratio: 1.0 };
    let motor = LinearMotor::new(model).with_target_position(2.0);
    let lift = PrismaticJoint::new(post, cabin).with_slider_axis(Vector::Y).with_motor(motor);
    let lift = rig.spawn((lift, JointForces::new()));
    rig.steps(128);
    // A spring of 4 Hz sags by g / (2π f)².
    let sag = G / (8.0 * avian::math::PI).powi(2);
    assert!((rig.place(cabin).y - (2.0 - sag)).abs() < 2e-3, "{}", rig.place(cabin));
    let force = rig.get::<JointForces>(lift).motor_force();
    assert!((force / (MASS * G) - 1.0).abs() < 0.02, "{force} N");
    for _ in 0..128 {
        let mut joint = rig.app.world_mut().get_mut::<PrismaticJoint>(lift).expect("a lift");
        joint.motor.target_position = -1.0;
        rig.step();
    }
    assert!((rig.place(cabin).y + 1.0 + sag).abs() < 2e-3, "{}", rig.place(cabin));
}

#[test]
fn a_motor_stops_at_the_limits_and_can_be_turned_off() {
    let mut rig = Rig::weightless();
    let (post, arm) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    let motor = AngularMotor::new(TOWARDS).with_target_velocity(2.0).with_max_torque(5.0);
    let joint = RevoluteJoint::new(post, arm).with_angle_limits(-1.0, 1.0).with_motor(motor);
    let joint = rig.spawn(joint);
    rig.steps(96);
    assert!((rig.angle(arm) - 1.0).abs() < 0.02, "{} rad", rig.angle(arm));
    let mut component = rig.app.world_mut().get_mut::<RevoluteJoint>(joint).expect("a joint");
    component.motor.set_enabled(false);
    rig.insert(arm, scenes::dim::spin(-0.5));
    rig.steps(64);
    assert!((rig.spin(arm) + 0.5).abs() < 1e-3, "it turns freely: {} rad/s", rig.spin(arm));
}
