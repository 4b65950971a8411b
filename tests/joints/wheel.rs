//! Wheels on springs: how far the chassis sags, the spin, and what stops both.

use super::*;

/// A chassis that slides up and down on a post, and a wheel below it that stands on a static pad. Returns
/// chassis, wheel and the wheel's joint.
fn stand(rig: &mut Rig, wheel: impl FnOnce(WheelJoint) -> WheelJoint) -> [Entity; 3] {
    let (post, chassis) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    rig.spawn(PrismaticJoint::new(post, chassis).with_slider_axis(Vector::Y));
    let hub = rig.post(0.0, -0.5);
    let joint = WheelJoint::new(chassis, hub).with_local_anchor1(xy(0.0, -0.5));
    let joint = rig.spawn((wheel(joint), JointForces::new()));
    [chassis, hub, joint]
}

/// With stiffness k the chassis sags by m g / k.
#[test]
fn the_chassis_sags_by_its_weight_over_the_stiffness() {
    let stiffness = 400.0;
    let spring = MotorModel::ForceBased { stiffness, damping: 40.0 };
    let mut rig = Rig::new();
    let [chassis, ..] = stand(&mut rig, |joint| joint.with_suspension(LinearMotor::new(spring)));
    rig.steps(384);
    let sag = MASS * G / stiffness;
    assert!((rig.place(chassis).y + sag).abs() < 0.01 * sag, "{}", rig.place(chassis));

    // The stop bears what the spring does not.
    let mut rig = Rig::new();
    let [chassis, ..] = stand(&mut rig, |joint| {
        joint.with_suspension(LinearMotor::new(spring)).with_suspension_limits(-0.02, 0.02)
    });
    rig.steps(384);
    assert!((rig.place(chassis).y + 0.02).abs() < 1e-3, "{}", rig.place(chassis));
}

#[test]
fn a_wheel_spins_by_its_motor_and_stays_across() {
    let mut rig = Rig::weightless();
    let (chassis, wheel) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    let torque = 0.25;
    let model = MotorModel::AccelerationBased { stiffness: 0.0, damping: 20.0 };
    let motor = AngularMotor::new(model).with_target_velocity(100.0).with_max_torque(torque);
    let joint = rig.spawn((dim_wheel(WheelJoint::new(chassis, wheel)).with_motor(motor), JointForces::new()));
    rig.steps(64);
    assert!((rig.spin(wheel) / (torque / INERTIA) - 1.0).abs() < 0.01, "{}", rig.spin(wheel));
    assert!((rig.get::<JointForces>(joint).motor_force() / torque - 1.0).abs() < 0.02);
    rig.insert(wheel, LinearVelocity(xy(1.0, 0.0)));
    rig.steps(64);
    assert!(rig.place(wheel).length() < 2e-3, "the spring and the axis hold it: {}", rig.place(wheel));
}

#[test]
fn a_suspension_without_direction_has_no_effect() {
    let mut rig = Rig::new();
    let (chassis, wheel) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    for axis in [Vector::ZERO, Vector::NAN] {
        rig.spawn(WheelJoint::new(chassis, wheel).with_suspension_axis(axis));
    }
    rig.spawn(WheelJoint::new(chassis, wheel).with_suspension_limits(1.0, -1.0));
    rig.steps(64);
    assert!((rig.place(wheel).y + 0.5 * G).abs() < 0.1, "{}", rig.place(wheel));
}
