//! Joints that break: at their load, once, with an event and a message.

use super::*;
use bevy_ecs::message::Messages;

/// The events that observers saw.
#[derive(Resource, Default)]
struct Seen(Vec<JointBroken>);

/// A weight a metre below a post, on a rope that breaks.
fn hanging(rig: &mut Rig, threshold: JointBreakThreshold) -> [Entity; 3] {
    let (post, body) = (rig.post(0.0, 0.0), rig.rod(0.0, -1.0));
    let rope = rig.spawn((DistanceJoint::new(post, body).with_max_distance(1.0), threshold));
    [post, body, rope]
}

fn messages(rig: &mut Rig) -> Vec<JointBroken> {
    rig.app.world_mut().resource_mut::<Messages<JointBroken>>().drain().collect()
}

fn is_off(rig: &Rig, joint: Entity) -> bool {
    rig.app.world().get::<JointDisabled>(joint).is_some()
}

#[test]
fn a_rope_breaks_by_a_little_more_than_it_bears_and_not_before() {
    let weight = MASS * G;
    let mut rig = Rig::new();
    let [_, body, rope] = hanging(&mut rig, JointBreakThreshold::force(1.02 * weight));
    for _ in 0..256 {
        rig.step();
        assert!(!is_off(&rig, rope));
    }
    assert!(rig.acts(rope), "forces are written without being asked for");
    assert_eq!(messages(&mut rig), []);
    rig.insert(rope, JointBreakThreshold::force(0.98 * weight));
    rig.step();
    let broken = messages(&mut rig);
    assert_eq!(broken.len(), 1);
    assert!((broken[0].force - Vector::Y * weight).length() < 0.02 * weight, "{}", broken[0].force);
    rig.steps(32);
    assert!(is_off(&rig, rope) && !rig.acts(rope) && rig.place(body).y < -1.5, "it falls");
    assert_eq!(messages(&mut rig), [], "it breaks once");
}

/// A beam of length L from its end bears m g L there.
#[test]
fn a_weld_breaks_by_torque() {
    let torque = MASS * G;
    for (threshold, breaks) in [(1.02, false), (0.98, true)] {
        let mut rig = Rig::new();
        let (post, beam) = (rig.post(0.0, 0.0), rig.rod(1.0, 0.0));
        let weld = FixedJoint::new(post, beam).with_local_anchor2(xy(-1.0, 0.0));
        let weld = rig.spawn(weld);
        rig.steps(128);
        rig.insert(weld, JointBreakThreshold::torque(threshold * torque));
        rig.steps(2);
        assert_eq!(is_off(&rig, weld), breaks, "{threshold}");
    }
}

#[test]
fn an_observer_sees_the_joint_off_and_can_remove_it() {
    let mut rig = Rig::new();
    rig.app.init_resource::<Seen>();
    let [post, body, rope] = hanging(&mut rig, JointBreakThreshold::new(1.0, 1.0));
    let observe = |broken: On<JointBroken>,
                   off: Query<(), With<JointDisabled>>,
                   mut seen: ResMut<Seen>,
                   mut commands: Commands| {
        assert!(off.contains(broken.joint));
        seen.0.push(*broken);
        commands.entity(broken.joint).despawn();
    };
    rig.app.world_mut().entity_mut(rope).observe(observe);
    rig.steps(8);
    let seen = &rig.app.world().resource::<Seen>().0;
    assert_eq!(seen.len(), 1);
    assert_eq!((seen[0].joint, seen[0].body1, seen[0].body2), (rope, post, body));
    assert!(rig.app.world().get_entity(rope).is_err());
}

#[test]
fn a_broken_joint_is_mended_and_breaks_again() {
    let mut rig = Rig::new();
    let [_, body, rope] = hanging(&mut rig, JointBreakThreshold::force(0.5 * MASS * G));
    rig.steps(8);
    assert!(is_off(&rig, rope));
    rig.insert(rope, JointBreakThreshold::default());
    rig.insert(body, (at(0.0, -0.9), LinearVelocity(Vector::ZERO)));
    rig.remove::<JointDisabled>(rope);
    rig.steps(128);
    assert!(rig.acts(rope) && rig.place(body).length() < 1.1, "without a threshold it holds");
    rig.insert(rope, JointBreakThreshold::force(0.5 * MASS * G));
    rig.step();
    assert!(is_off(&rig, rope));
    assert_eq!(messages(&mut rig).len(), 1, "messages of earlier frames are gone");
}

#[test]
fn thresholds_that_are_no_numbers_bear_anything() {
    for (threshold, breaks) in [(Scalar::NAN, false), (Scalar::INFINITY, false), (-1.0, true), (0.0, true)] {
        let mut rig = Rig::new();
        let [.., rope] = hanging(&mut rig, JointBreakThreshold::new(threshold, threshold));
        rig.steps(16);
        assert_eq!(is_off(&rig, rope), breaks, "{threshold}");
    }
    // One that waits for its bodies bears nothing.
    let mut rig = Rig::new();
    let [_, body, rope] = hanging(&mut rig, JointBreakThreshold::new(-1.0, -1.0));
    rig.insert(body, RigidBodyDisabled);
    rig.steps(4);
    assert!(!is_off(&rig, rope) && messages(&mut rig).is_empty());
    rig.remove::<RigidBodyDisabled>(body);
    rig.steps(4);
    assert!(is_off(&rig, rope));
}
