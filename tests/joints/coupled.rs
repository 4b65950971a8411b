//! Gears, racks and pulleys, and how far joints are off.

use super::*;

/// A motor that only wants a velocity.
const TOWARDS: MotorModel = MotorModel::AccelerationBased { stiffness: 0.0, damping: 20.0 };

/// A wheel on a post.
fn wheel(rig: &mut Rig, x: Scalar, motor: Option<AngularMotor>) -> Entity {
    let (post, wheel) = (rig.post(x, 0.0), rig.rod(x, 0.0));
    let hinge = RevoluteJoint::new(post, wheel);
    rig.spawn(motor.map_or(hinge.clone(), |motor| hinge.with_motor(motor)));
    wheel
}

/// Gears of radii r and s turn by −r/s, and share a torque τ: α = τ / (I + I r²/s²).
#[test]
fn gears_turn_by_their_radii_and_share_a_torque() {
    let (r, s) = (0.5, 1.5);
    let mut rig = Rig::weightless();
    let torque = 2.0;
    let driven = wheel(
        &mut rig,
        0.0,
        Some(AngularMotor::new(TOWARDS).with_target_velocity(1e3).with_max_torque(torque)),
    );
    let follower = wheel(&mut rig, 2.0, None);
    let gear = rig.spawn((
        GearJoint::new(driven, follower).with_radii(r, s),
        JointForces::new(),
        JointError::default(),
    ));
    rig.steps(64);
    let wanted = torque / (INERTIA * (1.0 + r * r / (s * s)));
    assert!((rig.spin(driven) / wanted - 1.0).abs() < 0.01, "{}", rig.spin(driven));
    assert!((rig.spin(follower) + rig.spin(driven) * r / s).abs() < 1e-3 * rig.spin(driven));
    let borne = rig.get::<JointForces>(gear).motor_force();
    let share = -wanted * INERTIA * r * r / (s * s);
    assert!((borne / share - 1.0).abs() < 0.02, "{borne} N·m");
    rig.steps(512);
    assert!(rig.get::<JointError>(gear).angle < 1e-3, "no tooth slips: {:?}", rig.get::<JointError>(gear));
}

#[test]
fn gears_keep_their_mesh_while_settings_are_written_and_begin_anew_when_they_change() {
    let mut rig = Rig::weightless();
    let motor = AngularMotor::new(TOWARDS).with_target_velocity(3.0);
    let driven = wheel(&mut rig, 0.0, Some(motor));
    let follower = wheel(&mut rig, 2.0, None);
    let gear = rig.spawn((GearJoint::new(driven, follower), JointError::default()));
    for _ in 0..256 {
        rig.app.world_mut().get_mut::<GearJoint>(gear).expect("a gear").set_changed();
        rig.step();
        assert!(rig.get::<JointError>(gear).angle < 2e-3);
    }
    assert!(
        (rig.angle(driven) + rig.angle(follower)).abs() < 5e-3,
        "{} and {}",
        rig.angle(driven),
        rig.angle(follower)
    );
    rig.app.world_mut().get_mut::<GearJoint>(gear).expect("a gear").ratio = -2.0;
    rig.steps(64);
    assert!(
        (rig.spin(follower) - 0.5 * rig.spin(driven)).abs() < 0.02,
        "a chain now: {}",
        rig.spin(follower)
    );
    rig.insert(gear, JointDisabled);
    let before = rig.spin(follower);
    rig.insert(follower, scenes::dim::spin(-7.0));
    rig.steps(64);
    assert!((rig.spin(follower) + 7.0).abs() < 1e-2, "it is free, not at {before}");
    rig.remove::<JointDisabled>(gear);
    rig.steps(64);
    assert!((rig.spin(follower) - 0.5 * rig.spin(driven)).abs() < 0.02, "it meshes where it is");
    rig.despawn(driven);
    rig.steps(8);
}

#[test]
fn a_rack_moves_by_the_radius_for_each_radian() {
    let mut rig = Rig::weightless();
    let motor = AngularMotor::new(TOWARDS).with_target_velocity(1.0);
    let pinion = wheel(&mut rig, 0.0, Some(motor));
    let (post, rack) = (rig.post(0.0, -0.5), rig.rod(0.0, -0.5));
    rig.spawn(PrismaticJoint::new(post, rack));
    rig.spawn(RackAndPinionJoint::new(pinion, rack).with_radius(0.5));
    rig.steps(128);
    let turned = rig.angle(pinion);
    assert!(
        turned > 1.5 && (rig.place(rack).x - 0.5 * turned).abs() < 1e-3,
        "{turned} rad, {}",
        rig.place(rack)
    );
}

/// Two weights on a rope: a = g (m − n) / (m + n); with the ratio 2 a weight of 2 m hangs on one
/// of m at rest.
#[test]
fn weights_on_a_pulley_move_by_their_difference() {
    let mut rig = Rig::new();
    let (heavy, light) = (rig.rod(0.0, 0.0), rig.rod(2.0, 0.0));
    rig.insert(heavy, Mass(3.0));
    rig.insert(light, Mass(1.0));
    let pulleys = [xy(0.0, 5.0), xy(2.0, 5.0)];
    let rope =
        rig.spawn((PulleyJoint::new(heavy, light, pulleys), JointForces::new(), JointError::default()));
    rig.steps(32);
    let wanted = -0.5 * (G / 2.0) * 0.25;
    assert!((rig.place(heavy).y / wanted - 1.0).abs() < 0.05, "{}", rig.place(heavy));
    assert!((rig.place(light).y + rig.place(heavy).y).abs() < 1e-3, "{}", rig.place(light));
    // The tension is 2 m n g / (m + n).
    let tension = rig.get::<JointForces>(rope).force();
    assert!((tension - Vector::Y * 15.0).length() < 0.3, "{tension}");
    assert!(rig.get::<JointError>(rope).length < 1e-3);

    let mut rig = Rig::new();
    let (one, other) = (rig.rod(0.0, 0.0), rig.rod(2.0, 0.0));
    rig.insert(other, Mass(2.0 * MASS as f32));
    rig.spawn(PulleyJoint::new(one, other, pulleys).with_ratio(2.0));
    rig.steps(128);
    assert!(rig.place(one).y.abs() < 2e-3 && rig.place(other).y.abs() < 2e-3, "{}", rig.place(one));
    // It breaks as any joint.
    let slack =
        rig.spawn((PulleyJoint::new(one, other, pulleys).with_length(1e3), JointBreakThreshold::force(1.0)));
    rig.steps(4);
    assert!(rig.app.world().get::<JointDisabled>(slack).is_none(), "a slack rope bears nothing");
}

#[test]
fn couplings_that_are_no_numbers_have_no_effect() {
    let mut rig = Rig::new();
    let (a, b) = (rig.rod(0.0, 0.0), rig.rod(2.0, 0.0));
    let pulleys = [xy(0.0, 5.0), xy(2.0, 5.0)];
    for ratio in [0.0, Scalar::NAN, Scalar::INFINITY] {
        rig.spawn(GearJoint::new(a, b).with_ratio(ratio));
        rig.spawn(PulleyJoint::new(a, b, pulleys).with_ratio(ratio));
    }
    rig.spawn(GearJoint::new(a, a));
    rig.spawn(GearJoint::new(a, Entity::PLACEHOLDER));
    rig.spawn(GearJoint::new(a, b).with_compliance(-1.0));
    rig.spawn(RackAndPinionJoint::new(a, b).with_radius(0.0));
    rig.spawn(RackAndPinionJoint::new(a, b).with_rack_axis(Vector::ZERO));
    rig.spawn(PulleyJoint::new(a, b, [Vector::NAN, Vector::ZERO]));
    rig.spawn(PulleyJoint::new(a, b, pulleys).with_length(Scalar::NAN));
    rig.spawn(PulleyJoint::new(a, b, pulleys).with_local_anchor1(Vector::NAN));
    rig.steps(32);
    assert!((rig.place(a).y + 0.125 * G).abs() < 0.05 && (rig.place(b).y + 0.125 * G).abs() < 0.05);
}

/// A spring of compliance α gives way by α times the force, and that is its error.
#[test]
fn the_error_of_a_joint_is_how_far_it_gives_way() {
    let mut rig = Rig::new();
    let (post, body) = (rig.post(0.0, 0.0), rig.rod(0.0, -1.0));
    // It would fall asleep where it turns.
    rig.insert(body, SleepingDisabled);
    let compliance = 0.001;
    let rope = DistanceJoint::rope(post, body, 1.0).with_compliance(compliance);
    let rope = rig.spawn((rope, JointDamping { linear: 2.0, angular: 0.0 }, JointError::default()));
    rig.steps(384);
    let error = *rig.get::<JointError>(rope);
    assert!((error.length / (compliance * MASS * G) - 1.0).abs() < 0.02 && error.angle == 0.0, "{error:?}");
    rig.insert(rope, JointDisabled);
    rig.steps(2);
    assert_eq!(*rig.get::<JointError>(rope), JointError::default());

    let mut rig = Rig::new();
    let (post, arm) = (rig.post(0.0, 0.0), rig.rod(1.0, 0.0));
    rig.insert(arm, SleepingDisabled);
    let weld = FixedJoint::new(post, arm).with_local_anchor2(xy(-1.0, 0.0)).with_angle_compliance(0.002);
    let weld = rig.spawn((weld, JointDamping { linear: 0.0, angular: 2.0 }, JointError::default()));
    rig.steps(384);
    let error = rig.get::<JointError>(weld).angle;
    assert!((error + rig.angle(arm)).abs() < 1e-3 && error > 0.03, "{error} rad");
}

/// A motor and a spring on one axis: at rest k x = F, with the motor's stall force F.
#[test]
fn a_motor_stretches_the_spring_on_its_axis() {
    let mut rig = Rig::weightless();
    let (post, body) = (rig.post(0.0, 0.0), rig.rod(0.0, 0.0));
    rig.insert(body, SleepingDisabled);
    let spring = MotorModel::ForceBased { stiffness: 50.0, damping: 20.0 };
    let motor = LinearMotor::new(TOWARDS).with_target_velocity(10.0).with_max_force(10.0);
    let axis = JointAxis::limited(-1.0, 1.0).with_spring(0.1, spring).with_motor(motor);
    let joint = GenericJoint::new(post, body).with_locked(JointCoordinate::ALL);
    rig.spawn(joint.with_axis(JointCoordinate::X, axis));
    rig.steps(256);
    assert!((rig.place(body).x - 0.3).abs() < 3e-3, "{}", rig.place(body));
}
