//! A mouse joint pulls a body to its own entity.

use super::*;

#[test]
fn a_body_follows_the_joints_entity_and_wakes_for_it() {
    let mut rig = Rig::weightless();
    let body = rig.rod(0.0, 0.0);
    let mouse = rig.spawn((MouseJoint::new(body), at(1.0, 2.0)));
    rig.steps(128);
    assert!((rig.place(body) - xy(1.0, 2.0)).length() < 1e-3, "{}", rig.place(body));
    rig.steps(256);
    assert!(rig.sleeps(body), "it rests");
    let mut target = rig.app.world_mut().get_mut::<Transform>(mouse).expect("a pose");
    target.translation.x = -1.0;
    rig.steps(128);
    assert!((rig.place(body) - xy(-1.0, 2.0)).length() < 1e-3, "{}", rig.place(body));
    rig.despawn(mouse);
    rig.insert(body, LinearVelocity(Vector::X));
    rig.steps(64);
    assert!((rig.place(body) - xy(0.0, 2.0)).length() < 1e-2, "it is free: {}", rig.place(body));
}

/// A spring of frequency f lets a weight sag by g / (2π f)².
#[test]
fn it_pulls_at_the_point_that_was_picked() {
    let mut rig = Rig::new();
    let body = rig.rod(0.0, 0.0);
    rig.insert(body, SleepingDisabled);
    let picked = xy(0.5, 0.0);
    rig.spawn((
        MouseJoint::new(body).with_anchor(picked),
        JointDamping { linear: 0.0, angular: 8.0 },
        at(0.5, 0.0),
    ));
    rig.steps(512);
    let sag = G / (10.0 * avian::math::PI).powi(2);
    // It hangs from the point, half a metre below.
    assert!((rig.place(body) - xy(0.5, -0.5 - sag)).length() < 0.01, "{}", rig.place(body));
}

#[test]
fn it_lifts_no_more_than_its_force() {
    for (share, lifts) in [(0.9, false), (1.1, true)] {
        let mut rig = Rig::new();
        let body = rig.rod(0.0, 0.0);
        rig.spawn((MouseJoint::new(body).with_max_force(share * MASS * G), at(0.0, 0.5)));
        rig.steps(128);
        assert_eq!(rig.place(body).y > 0.0, lifts, "{share}: {}", rig.place(body));
    }
}

#[test]
fn with_a_torque_it_turns_the_body_too() {
    let mut rig = Rig::weightless();
    let body = rig.rod(0.0, 0.0);
    let mouse = rig.spawn((MouseJoint::new(body).with_max_torque(50.0), at(0.0, 0.0)));
    rig.insert(mouse, turned(1.2));
    rig.steps(128);
    assert!((rig.angle(body) - 1.2).abs() < 1e-3, "{}", rig.angle(body));
}

#[test]
fn it_does_no_harm_to_itself_and_what_is_no_body() {
    let mut rig = Rig::new();
    let (body, nothing) = (rig.rod(0.0, 0.0), rig.spawn(()));
    let mouse = rig.spawn((MouseJoint::new(nothing), at(0.0, 1.0)));
    let itself = rig.spawn(at(0.0, 0.0));
    rig.insert(itself, MouseJoint::new(itself));
    let wrong = [
        MouseJoint::new(body).with_max_force(Scalar::NAN),
        MouseJoint::new(body).with_max_force(-1.0),
        MouseJoint::new(body).with_max_torque(Scalar::NAN),
        MouseJoint::new(body).with_local_anchor(Vector::NAN),
        MouseJoint::new(body)
            .with_motor_model(MotorModel::SpringDamper { frequency: -1.0, damping_ratio: 1.0 }),
    ];
    for joint in wrong {
        rig.spawn((joint, at(5.0, 0.0)));
    }
    rig.steps(16);
    assert!(rig.place(body).x.abs() < 1e-6 && rig.place(body).y < -0.2, "it falls freely");
    // It takes another body.
    rig.insert(mouse, MouseJoint::new(body));
    rig.steps(128);
    assert!((rig.place(body) - xy(0.0, 1.0)).length() < 0.02, "{}", rig.place(body));
    rig.app.world_mut().get_mut::<MouseJoint>(mouse).expect("a joint").body = nothing;
    rig.steps(64);
    assert!(rig.place(body).y < 0.0, "it was let go");
}
