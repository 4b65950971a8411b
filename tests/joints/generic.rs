//! A joint with a setting for each axis is what the other joints are, and what they are not.

use super::*;

fn coordinate(along_x: bool) -> JointCoordinate {
    if along_x { JointCoordinate::X } else { JointCoordinate::Y }
}

#[test]
fn with_all_axes_locked_it_is_a_weld() {
    let mut rig = Rig::new();
    let (post, body) = (rig.post(0.0, 0.0), rig.rod(1.0, 0.0));
    let joint = GenericJoint::new(post, body).with_anchor(Vector::ZERO).with_locked(JointCoordinate::ALL);
    let joint = rig.spawn((joint, JointForces::new()));
    rig.steps(128);
    assert!((rig.place(body) - xy(1.0, 0.0)).length() < 5e-3, "{}", rig.place(body));
    let force = rig.get::<JointForces>(joint).force();
    assert!((force - Vector::Y * MASS * G).length() < 0.02 * MASS * G, "{force}");
}

#[test]
fn a_free_joint_holds_nothing() {
    let mut rig = Rig::new();
    let (post, body) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    rig.spawn(GenericJoint::new(post, body));
    rig.steps(64);
    assert!((rig.place(body).y + 0.5 * G).abs() < 0.1, "{}", rig.place(body));
}

/// With stiffness k = m (2π f)² the weight sags by g / (2π f)²; with compliance α by α m g.
#[test]
fn springs_and_compliance_sag_by_their_law() {
    let held = JointAxis::LOCKED;
    let frequency: Scalar = 2.0;
    let by_spring = G / (2.0 * avian::math::PI * frequency).powi(2);
    let compliance = 0.002;
    for (axis, sag) in [
        (held.with_soft_limits(frequency, 1.0), by_spring),
        (held.with_compliance(compliance), compliance * MASS * G),
    ] {
        let mut rig = Rig::new();
        let (post, body) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
        // At a turning point it would be slow enough to fall asleep.
        rig.insert(body, SleepingDisabled);
        let joint = GenericJoint::new(post, body)
            .with_locked(JointCoordinate::ALL)
            .with_axis(JointCoordinate::Y, axis);
        rig.spawn((joint, JointDamping { linear: 3.0, angular: 0.0 }));
        rig.steps(512);
        assert!((rig.place(body).y + sag).abs() < 0.02 * sag, "{axis:?}: {}", rig.place(body));
    }
}

#[test]
fn each_axis_has_limits_and_a_motor_of_its_own() {
    for along_x in [false, true] {
        let mut rig = Rig::weightless();
        let (post, body) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
        let [slides, held] = [coordinate(along_x), coordinate(!along_x)];
        let model = MotorModel::AccelerationBased { stiffness: 0.0, damping: 20.0 };
        let joint = GenericJoint::new(post, body)
            .with_locked(JointCoordinate::ALL)
            .with_axis(slides, JointAxis::limited(-0.5, 0.75))
            .with_motor(slides, LinearMotor::new(model).with_target_velocity(1.0).with_max_force(10.0))
            .with_limits(held, -0.1, 0.1);
        let joint = rig.spawn((joint, JointForces::new()));
        rig.insert(body, LinearVelocity(xy(1.0, 1.0)));
        rig.steps(128);
        let place = rig.place(body);
        let (along, across) = if along_x { (place.x, place.y) } else { (place.y, place.x) };
        assert!((along - 0.75).abs() < 5e-3 && across.abs() < 0.1 + 5e-3, "{place}");
        assert!((rig.get::<JointForces>(joint).motor_force() - 10.0).abs() < 0.2, "it presses on");
        let mut component = rig.app.world_mut().get_mut::<GenericJoint>(joint).expect("a joint");
        component.axis_mut(slides).motor.set_enabled(false);
        rig.insert(body, LinearVelocity(xy(-0.5, -0.5)));
        rig.steps(16);
        let place = rig.place(body);
        let along = if along_x { place.x } else { place.y };
        assert!((along - 0.75 + 0.125).abs() < 0.01, "it slides freely: {place}");
    }
}

#[test]
fn axes_that_are_no_numbers_have_no_effect() {
    let mut rig = Rig::new();
    let (post, body) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    let motor = AngularMotor::default();
    let turn = JointCoordinate::ROTATIONS[0];
    for joint in [
        GenericJoint::new(post, body).with_limits(JointCoordinate::Y, 1.0, -1.0),
        GenericJoint::new(post, body).with_limits(JointCoordinate::Y, Scalar::NAN, 1.0),
        GenericJoint::new(post, body)
            .with_limits(JointCoordinate::Y, 0.0, 0.0)
            .with_compliance(JointCoordinate::Y, -1.0),
        GenericJoint::new(post, body)
            .with_axis(JointCoordinate::Y, JointAxis::LOCKED.with_soft_limits(0.0, 1.0)),
        GenericJoint::new(post, body).with_motor(turn, motor.with_target_position(Scalar::NAN)),
        GenericJoint::new(post, body).with_motor(turn, motor.with_max_torque(-1.0)),
    ] {
        rig.spawn(joint);
    }
    rig.steps(64);
    assert!((rig.place(body).y + 0.5 * G).abs() < 0.1, "{}", rig.place(body));
}
