//! Random changes of joints and bodies. Feature `validate`, which is on in tests, compares the tables with
//! the world in every step.

use super::*;
use avian::dynamics::{joints::EntityConstraint, solver::joint_graph::JointGraph};
use bevy_ecs::entity_disabling::Disabled;
use proptest::prelude::*;
use scenes::dim::ball;

/// Number of bodies, and of joints.
const BODIES: usize = 6;
const JOINTS: usize = 5;

/// A change of a body or a joint, by number.
#[derive(Clone, Copy, Debug)]
enum Change {
    Spawn(usize),
    Despawn(usize),
    Retype(usize, u8),
    Strip(usize),
    Switch(usize, bool),
    Freeze(usize, bool),
    Push(usize),
    Join(usize, [usize; 2], u8),
    Swap(usize, [usize; 2]),
    Tighten(usize, i8),
    Drop(usize),
    Unjoin(usize),
    Disable(usize, bool),
    Hide(usize, bool),
    PassThrough(usize, bool),
    Pause(bool),
    Step,
}

fn change() -> impl Strategy<Value = Change> {
    let (body, joint) = (0..BODIES, 0..JOINTS);
    let pair = [0..BODIES, 0..BODIES];
    prop_oneof![
        3 => body.clone().prop_map(Change::Spawn),
        1 => body.clone().prop_map(Change::Despawn),
        1 => (body.clone(), 0..3u8).prop_map(|(body, kind)| Change::Retype(body, kind)),
        1 => body.clone().prop_map(Change::Strip),
        1 => (body.clone(), any::<bool>()).prop_map(|(body, off)| Change::Switch(body, off)),
        1 => (body.clone(), any::<bool>()).prop_map(|(body, off)| Change::Freeze(body, off)),
        1 => body.prop_map(Change::Push),
        4 => (joint.clone(), pair.clone(), 0..11u8).prop_map(|(joint, pair, kind)| Change::Join(joint, pair, kind)),
        2 => (joint.clone(), pair).prop_map(|(joint, pair)| Change::Swap(joint, pair)),
        1 => (joint.clone(), -2..4i8).prop_map(|(joint, to)| Change::Tighten(joint, to)),
        1 => joint.clone().prop_map(Change::Drop),
        1 => joint.clone().prop_map(Change::Unjoin),
        1 => (joint.clone(), any::<bool>()).prop_map(|(joint, off)| Change::Disable(joint, off)),
        1 => (joint.clone(), any::<bool>()).prop_map(|(joint, off)| Change::Hide(joint, off)),
        2 => (joint, any::<bool>()).prop_map(|(joint, on)| Change::PassThrough(joint, on)),
        1 => any::<bool>().prop_map(Change::Pause),
        6 => Just(Change::Step),
    ]
}

/// A world under change. Places of despawned entities keep dead ones.
struct Crowd {
    rig: Rig,
    bodies: [Entity; BODIES],
    joints: [Entity; JOINTS],
}

impl Crowd {
    fn new() -> Self {
        let mut rig = Rig::new();
        let bodies = core::array::from_fn(|_| rig.spawn(()));
        let joints = core::array::from_fn(|_| rig.spawn(()));
        Self { rig, bodies, joints }
    }

    /// Applies a change to an entity, if it is there.
    fn with(&mut self, entity: Entity, change: impl FnOnce(&mut EntityWorldMut)) {
        if let Ok(mut entity) = self.rig.app.world_mut().get_entity_mut(entity) {
            change(&mut entity);
        }
    }

    fn despawn(&mut self, entity: Entity) {
        if self.rig.app.world().get_entity(entity).is_ok() {
            self.rig.despawn(entity);
        }
    }

    fn toggle<C: Component + Default>(&mut self, entity: Entity, is_on: bool) {
        self.with(entity, |entity| {
            if is_on {
                entity.insert(C::default());
            } else {
                entity.remove::<C>();
            }
        });
    }

    fn join(&mut self, joint: Entity, [a, b]: [Entity; 2], kind: u8) {
        let above = xy(0.0, 0.5);
        self.with(joint, |joint| {
            _ = match kind {
                0 => joint.insert(FixedJoint::new(a, b).with_local_anchor1(above)),
                1 => joint.insert((DistanceJoint::new(a, b).with_limits(0.0, 1.0), JointCollisionDisabled)),
                2 => joint.insert(PrismaticJoint::new(a, b).with_limits(-1.0, 1.0)),
                3 => joint.insert(RevoluteJoint::new(a, b).with_anchor(above).with_angle_limits(-1.0, 1.0)),
                4 => joint.insert((RevoluteJoint::new(a, b), JointForces::new(), JointDamping::default())),
                5 => joint.insert((
                    GenericJoint::new(a, b).with_locked([JointCoordinate::Y]),
                    JointBreakThreshold::force(5.0),
                )),
                6 => joint.insert(MouseJoint::new(b).with_max_torque(1.0)),
                8 => joint.insert((GearJoint::new(a, b), JointError::default())),
                9 => joint.insert(PulleyJoint::new(a, b, [xy(0.0, 2.0), xy(1.0, 2.0)])),
                7 => joint.insert(WheelJoint::new(a, b).with_suspension_limits(-0.5, 0.5)),
                _ => joint.insert(DistanceJoint::new(a, b).with_limits(2.0, Scalar::NAN)),
            };
        });
    }

    fn apply(&mut self, change: Change) {
        let types = [RigidBody::Dynamic, RigidBody::Static, RigidBody::Kinematic];
        match change {
            Change::Spawn(i) => {
                let place = at(0.6 * i as Scalar, 0.3 * (i % 3) as Scalar);
                if self.rig.app.world().get_entity(self.bodies[i]).is_err() {
                    self.bodies[i] = self.rig.spawn(());
                }
                self.rig.insert(self.bodies[i], (types[usize::from(i == 0)], ball(0.5), place));
            }
            Change::Despawn(i) => self.despawn(self.bodies[i]),
            Change::Retype(i, kind) => self.with(self.bodies[i], |body| {
                if body.contains::<RigidBody>() {
                    body.insert(types[usize::from(kind)]);
                }
            }),
            Change::Strip(i) => self.with(self.bodies[i], |body| _ = body.remove::<RigidBody>()),
            Change::Switch(i, off) => self.toggle::<RigidBodyDisabled>(self.bodies[i], off),
            Change::Freeze(i, off) => self.toggle::<Disabled>(self.bodies[i], off),
            Change::Push(i) => self.with(self.bodies[i], |body| {
                if let Some(mut velocity) = body.get_mut::<LinearVelocity>() {
                    velocity.0 += Vector::Y;
                }
            }),
            Change::Join(i, pair, kind) => {
                if self.rig.app.world().get_entity(self.joints[i]).is_err() {
                    self.joints[i] = self.rig.spawn(());
                }
                self.join(self.joints[i], pair.map(|body| self.bodies[body]), kind);
            }
            Change::Swap(i, pair) => {
                let [a, b] = pair.map(|body| self.bodies[body]);
                self.with(self.joints[i], |joint| {
                    if let Some(mut joint) = joint.get_mut::<RevoluteJoint>() {
                        (joint.body1, joint.body2) = (a, b);
                    }
                    if let Some(mut joint) = joint.get_mut::<DistanceJoint>() {
                        (joint.body1, joint.body2) = (a, b);
                    }
                });
            }
            Change::Tighten(i, to) => self.with(self.joints[i], |joint| {
                if let Some(mut joint) = joint.get_mut::<DistanceJoint>() {
                    joint.limits.max = Scalar::from(to);
                }
            }),
            Change::Drop(i) => self.with(self.joints[i], |joint| {
                joint.remove::<(FixedJoint, DistanceJoint, PrismaticJoint, RevoluteJoint)>();
                joint.remove::<(GenericJoint, MouseJoint, WheelJoint, GearJoint, PulleyJoint)>();
            }),
            Change::Unjoin(i) => self.despawn(self.joints[i]),
            Change::Disable(i, off) => self.toggle::<JointDisabled>(self.joints[i], off),
            Change::Hide(i, off) => self.toggle::<Disabled>(self.joints[i], off),
            Change::PassThrough(i, on) => self.toggle::<JointCollisionDisabled>(self.joints[i], on),
            Change::Pause(true) => self.rig.app.world_mut().resource_mut::<Time<Physics>>().pause(),
            Change::Pause(false) => self.rig.app.world_mut().resource_mut::<Time<Physics>>().unpause(),
            Change::Step => self.rig.step(),
        }
    }

    /// The bodies of a joint that is not disabled.
    fn listed(&self, joint: Entity) -> Option<[Entity; 2]> {
        let joint = self.rig.app.world().get_entity(joint).ok()?;
        if joint.contains::<JointDisabled>() || joint.contains::<Disabled>() {
            return None;
        }
        // In the order in which the graph looks for kinds on one entity.
        let of = [
            joint.get::<FixedJoint>().map(EntityConstraint::entities),
            joint.get::<DistanceJoint>().map(EntityConstraint::entities),
            joint.get::<PrismaticJoint>().map(EntityConstraint::entities),
            joint.get::<RevoluteJoint>().map(EntityConstraint::entities),
            joint.get::<GenericJoint>().map(EntityConstraint::entities),
            joint.get::<MouseJoint>().map(EntityConstraint::entities),
            joint.get::<WheelJoint>().map(EntityConstraint::entities),
            joint.get::<GearJoint>().map(EntityConstraint::entities),
            joint.get::<PulleyJoint>().map(EntityConstraint::entities),
        ];
        of.into_iter().flatten().next()
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, max_shrink_iters: 200, ..ProptestConfig::default() })]
    #[test]
    fn random_changes_leave_tables_and_graph_as_the_world_is(
        changes in prop::collection::vec(change(), 20..60),
    ) {
        let mut crowd = Crowd::new();
        for change in changes {
            crowd.apply(change);
        }
        crowd.apply(Change::Pause(false));
        (0..3).for_each(|_| crowd.apply(Change::Step));
        let graph = crowd.rig.app.world().resource::<JointGraph>();
        for joint in crowd.joints {
            prop_assert_eq!(graph.bodies_of(joint), crowd.listed(joint));
        }
        for body in crowd.bodies {
            if let Some(position) = crowd.rig.app.world().get::<Position>(body) {
                prop_assert!(position.is_finite());
            }
        }
        // Nothing of it is left when all is gone.
        for entity in crowd.joints.into_iter().chain(crowd.bodies) {
            crowd.despawn(entity);
        }
        crowd.rig.steps(2);
        let graph = crowd.rig.app.world().resource::<JointGraph>();
        prop_assert!(crowd.joints.iter().all(|joint| graph.get(*joint).is_none()));
    }
}
