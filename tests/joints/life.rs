//! Joints are spawned, changed and removed in every order, and with bodies that come, go and change.

use super::*;
use avian::dynamics::joints::EntityConstraint;
use bevy_ecs::entity_disabling::Disabled;
use scenes::dim::{ball, block};

/// A weight a metre below a post, on a rope that says whether it pulls.
fn hanging(rig: &mut Rig) -> [Entity; 3] {
    let (post, body) = (rig.post(0.0, 0.0), rig.rod(0.0, -1.0));
    let rope = rig.spawn(rope(post, body));
    [post, body, rope]
}

fn rope(post: Entity, body: Entity) -> impl Bundle + use<> {
    (DistanceJoint::new(post, body).with_max_distance(1.0), JointForces::new())
}

fn pulls(rig: &mut Rig, rope: Entity) -> bool {
    rig.steps(4);
    rig.acts(rope)
}

#[test]
fn a_joint_acts_in_whatever_order_it_and_its_bodies_come() {
    for order in [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        for steps_between in [0, 3] {
            let mut rig = Rig::new();
            let [post, body, joint] = core::array::from_fn(|_| rig.spawn(()));
            for what in order {
                match what {
                    0 => rig.insert(post, (RigidBody::Static, at(0.0, 0.0))),
                    1 => rig.insert(body, (super::rod(), at(0.0, -1.0))),
                    _ => rig.insert(joint, rope(post, body)),
                }
                rig.steps(steps_between);
            }
            rig.steps(64);
            assert!(rig.acts(joint) && rig.place(body).length() < 1.6, "{order:?}, {steps_between} steps");
        }
    }
}

#[test]
fn a_joint_is_turned_off_and_on() {
    let mut rig = Rig::new();
    let [_, _, rope] = hanging(&mut rig);
    assert!(pulls(&mut rig, rope));
    rig.insert(rope, JointDisabled);
    assert!(!pulls(&mut rig, rope));
    rig.remove::<JointDisabled>(rope);
    assert!(pulls(&mut rig, rope));
    rig.insert(rope, Disabled);
    rig.steps(2);
    rig.remove::<Disabled>(rope);
    assert!(pulls(&mut rig, rope));
}

#[test]
fn a_joint_waits_for_a_body_that_leaves() {
    let mut rig = Rig::new();
    let [post, body, rope] = hanging(&mut rig);
    assert!(pulls(&mut rig, rope));
    rig.insert(post, RigidBodyDisabled);
    assert!(!pulls(&mut rig, rope));
    rig.remove::<RigidBodyDisabled>(post);
    assert!(pulls(&mut rig, rope));
    rig.remove::<RigidBody>(post);
    assert!(!pulls(&mut rig, rope));
    rig.insert(post, RigidBody::Kinematic);
    assert!(pulls(&mut rig, rope));
    rig.insert(body, RigidBodyDisabled);
    assert!(!pulls(&mut rig, rope));
    rig.remove::<RigidBodyDisabled>(body);
    assert!(pulls(&mut rig, rope));
    rig.despawn(body);
    assert!(!pulls(&mut rig, rope));
}

#[test]
fn a_joint_moves_to_another_body() {
    let mut rig = Rig::new();
    let [post, body, rope] = hanging(&mut rig);
    let other = rig.rod(5.0, -1.0);
    let far = rig.post(5.0, 0.0);
    assert!(pulls(&mut rig, rope));
    let mut joint = rig.app.world_mut().get_mut::<DistanceJoint>(rope).expect("a rope");
    (joint.body1, joint.body2) = (other, far);
    let before = rig.place(body).y;
    rig.steps(32);
    assert!(rig.place(body).y < before - 0.5, "the first one falls");
    assert!(rig.acts(rope) && rig.place(other).distance(rig.place(far)) < 1.6, "the other one is caught");
    assert_eq!(rig.get::<DistanceJoint>(rope).entities(), [other, far]);
    rig.despawn(post);
    assert!(pulls(&mut rig, rope));
}

#[test]
fn a_body_that_becomes_static_holds_what_hangs_on_it() {
    let mut rig = Rig::new();
    let [post, body, rope] = hanging(&mut rig);
    rig.steps(4);
    rig.insert(body, RigidBody::Static);
    rig.steps(4);
    let rest = rig.place(body);
    rig.steps(16);
    assert_eq!(rig.place(body), rest, "both are static, and the joint is parked");
    rig.insert(post, RigidBody::Dynamic);
    rig.insert(post, (Mass(1.0), GravityScale(1.0)));
    rig.steps(256);
    let way = rig.place(post).distance(rest);
    assert!(way < 1.05 && rig.place(post).y < 1.0, "it hangs on the other now: {way} m");
    assert!(rig.app.world().get::<DistanceJoint>(rope).is_some());
}

#[test]
fn joints_that_cannot_act_do_no_harm_and_act_once_they_are_mended() {
    let mut rig = Rig::new();
    let (post, body) = (rig.post(0.0, 0.0), rig.rod(0.0, -1.0));
    let nothing = rig.spawn(());
    let gone = rig.spawn(());
    rig.despawn(gone);
    let looped = rig.spawn((FixedJoint::new(body, body), JointForces::new()));
    let loose = rig.spawn((FixedJoint::new(post, nothing), JointForces::new()));
    rig.spawn(FixedJoint::new(gone, Entity::PLACEHOLDER));
    rig.spawn(FixedJoint::new(post, body).with_point_compliance(Scalar::NAN));
    rig.spawn(FixedJoint::new(post, body).with_angle_compliance(-1.0));
    rig.spawn(FixedJoint::new(post, body).with_local_anchor1(Vector::NAN));
    rig.spawn(FixedJoint::new(post, body).with_anchor(Vector::INFINITY));
    rig.spawn(PrismaticJoint::new(post, body).with_slider_axis(Vector::ZERO));
    rig.spawn(DistanceJoint::new(post, body).with_limits(2.0, 1.0));
    let motor = AngularMotor::default().with_max_torque(-1.0);
    rig.spawn(RevoluteJoint::new(post, body).with_motor(motor));
    rig.spawn((FixedJoint::new(post, body), JointDamping { linear: Scalar::NAN, angular: 0.0 }));
    let rope = rig.spawn((DistanceJoint::new(post, body).with_limits(0.0, Scalar::NAN), JointForces::new()));
    rig.steps(16);
    let fallen = 0.5 * G * (16.0 * DT) * (16.0 * DT);
    assert!((rig.place(body).y + 1.0 + fallen).abs() < 0.1, "it falls freely: {}", rig.place(body));
    for joint in [looped, loose, rope] {
        assert!(!rig.acts(joint));
    }
    rig.app.world_mut().get_mut::<DistanceJoint>(rope).expect("a rope").limits.max = 1.5;
    rig.insert(nothing, (super::rod(), at(0.0, -0.5)));
    rig.steps(16);
    assert!(rig.acts(rope) && rig.acts(loose));
}

/// Many joints of one body leave with it, and come back.
#[test]
fn a_hub_with_thousands_of_joints_is_despawned() {
    let mut rig = Rig::weightless();
    let hub = rig.spawn((super::rod(), at(0.0, 0.0)));
    let ends: Vec<Entity> = (0..3000).map(|i| rig.rod(Scalar::from(i as u16), 1.0)).collect();
    let joints: Vec<Entity> =
        ends.iter().map(|end| rig.spawn(DistanceJoint::new(hub, *end).with_max_distance(1e4))).collect();
    rig.steps(2);
    rig.insert(hub, RigidBodyDisabled);
    rig.step();
    rig.remove::<RigidBodyDisabled>(hub);
    rig.step();
    rig.despawn(hub);
    rig.steps(2);
    joints.into_iter().for_each(|joint| rig.despawn(joint));
    rig.step();
}

#[test]
fn jointed_bodies_fall_asleep_and_wake_together() {
    let mut rig = Rig::new();
    let [_, body, rope] = hanging(&mut rig);
    let below = rig.rod(0.0, -2.0);
    let damping = JointDamping { linear: 2.0, angular: 2.0 };
    rig.insert(rope, damping);
    rig.spawn((FixedJoint::new(body, below).with_local_anchor1(xy(0.0, -1.0)), damping));
    rig.steps(192);
    assert!(rig.sleeps(body) && rig.sleeps(below), "they rest");
    let held = rig.get::<JointForces>(rope).force();
    assert!((held.length() / (2.0 * MASS * G) - 1.0).abs() < 0.02, "the rope is as tight as before: {held}");

    rig.insert(below, LinearVelocity(Vector::X));
    rig.step();
    assert!(!rig.sleeps(body) && !rig.sleeps(below), "a push wakes both");
    rig.steps(1024);
    assert!(rig.sleeps(body), "they rest again");

    rig.app.world_mut().get_mut::<DistanceJoint>(rope).expect("a rope").limits.max = 0.5;
    rig.steps(2);
    assert!(!rig.sleeps(below), "a changed joint wakes them");
    rig.steps(512);
    assert!(rig.sleeps(body));
    // Writing what it is already wakes nothing.
    rig.app.world_mut().get_mut::<DistanceJoint>(rope).expect("a rope").set_changed();
    rig.steps(2);
    assert!(rig.sleeps(body));
    rig.despawn(rope);
    rig.steps(8);
    assert!(!rig.sleeps(body) && rig.place(body).y < -0.55, "they fall without it");
}

/// Two boxes in each other, joined at their middles.
fn overlapping(rig: &mut Rig) -> [Entity; 3] {
    let bodies = [0.0, 0.25].map(|x| {
        rig.spawn((RigidBody::Dynamic, block(1.0, 1.0, 1.0), CollidingEntities::default(), at(x, 0.0)))
    });
    let joint = rig.spawn(RevoluteJoint::new(bodies[0], bodies[1]).with_local_anchor1(xy(0.25, 0.0)));
    [bodies[0], bodies[1], joint]
}

fn touches(rig: &Rig, body: Entity) -> usize {
    rig.get::<CollidingEntities>(body).len()
}

#[test]
fn bodies_of_a_joint_collide_unless_it_says_otherwise() {
    let mut rig = Rig::weightless();
    let [a, b, joint] = overlapping(&mut rig);
    rig.steps(2);
    assert_eq!((touches(&rig, a), touches(&rig, b)), (1, 1));
    rig.insert(joint, JointCollisionDisabled);
    rig.steps(2);
    assert_eq!((touches(&rig, a), touches(&rig, b)), (0, 0), "their contact is gone");
    // A collider that is added later passes through as well, and others do not.
    let child = rig.spawn((ball(0.4), Transform::default(), ChildOf(b), CollidingEntities::default()));
    let third = rig.spawn((RigidBody::Dynamic, ball(0.4), CollidingEntities::default(), at(0.0, 0.2)));
    rig.steps(2);
    assert_eq!((touches(&rig, child), touches(&rig, a)), (1, 1), "of the third body");
    assert_eq!(touches(&rig, third), 3);
    rig.despawn(third);
    rig.remove::<JointCollisionDisabled>(joint);
    rig.steps(2);
    assert!(touches(&rig, a) >= 1 && touches(&rig, b) == 1, "they collide again");
}

#[test]
fn bodies_collide_again_when_the_last_joint_that_says_otherwise_is_gone() {
    let mut rig = Rig::weightless();
    let [a, b, joint] = overlapping(&mut rig);
    let second = rig.spawn((FixedJoint::new(b, a).with_anchor(Vector::ZERO), JointCollisionDisabled));
    rig.insert(joint, JointCollisionDisabled);
    rig.steps(2);
    assert_eq!(touches(&rig, a), 0);
    rig.despawn(joint);
    rig.steps(2);
    assert_eq!(touches(&rig, a), 0, "the other joint holds them");
    rig.insert(second, JointDisabled);
    rig.steps(2);
    assert_eq!(touches(&rig, a), 1);
    rig.remove::<JointDisabled>(second);
    rig.steps(2);
    assert_eq!(touches(&rig, a), 0);
    // The body leaves, and another takes its id.
    rig.despawn(b);
    rig.step();
    let other =
        rig.spawn((RigidBody::Dynamic, block(1.0, 1.0, 1.0), CollidingEntities::default(), at(0.3, 0.0)));
    rig.steps(2);
    assert_eq!((touches(&rig, a), touches(&rig, other)), (1, 1));
}

#[test]
fn joints_are_changed_while_physics_is_paused() {
    let mut rig = Rig::new();
    let [post, body, rope] = hanging(&mut rig);
    rig.steps(2);
    rig.app.world_mut().resource_mut::<Time<Physics>>().pause();
    for _ in 0..100 {
        let joint = rig.spawn((FixedJoint::new(post, body), JointCollisionDisabled));
        rig.step();
        rig.despawn(joint);
        rig.insert(rope, JointDisabled);
        rig.remove::<JointDisabled>(rope);
    }
    rig.app.world_mut().resource_mut::<Time<Physics>>().unpause();
    assert!(pulls(&mut rig, rope));
}

#[test]
fn joints_act_where_contacts_do_not() {
    let mut rig = Rig::new();
    let detect = NarrowPhasePlugin::<Collider>::new(avian::prelude::PhysicsSchedule, false);
    let mut only = Rig::with(PhysicsPlugins::new(Update).build().set(detect));
    for rig in [&mut rig, &mut only] {
        let [_, body, rope] = hanging(rig);
        rig.spawn((RigidBody::Static, Collider::half_space(Vector::Y), at(0.0, -3.0)));
        let falling = rig.spawn((RigidBody::Dynamic, ball(0.5), at(3.0, -2.0)));
        rig.steps(64);
        assert!(rig.acts(rope) && (rig.place(body).y + 1.0).abs() < 2e-3);
        rig.insert(falling, Name::new("a ball"));
    }
    let lowest = |rig: &mut Rig| {
        let mut balls = rig.app.world_mut().query_filtered::<&Position, With<Name>>();
        balls.single(rig.app.world()).expect("one ball").y
    };
    assert!(lowest(&mut rig) > -2.6 && lowest(&mut only) < -4.0, "contacts are detected only");
}

#[test]
fn without_their_plugin_joints_do_nothing() {
    let mut rig = Rig::with(PhysicsPlugins::new(Update).build().disable::<JointPlugin>());
    let [_, body, rope] = hanging(&mut rig);
    rig.steps(64);
    assert!(rig.place(body).y < -5.0 && !rig.acts(rope), "{}", rig.place(body));
}
