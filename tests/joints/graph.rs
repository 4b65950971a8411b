//! [`JointGraph`] lists joints as they are.

use super::*;
use avian::dynamics::{
    joints::EntityConstraint,
    solver::joint_graph::{JointComponentId, JointGraph, JointGraphPlugin},
};
use bevy_ecs::entity::{EntityMapper, MapEntities};

fn graph(rig: &Rig) -> &JointGraph {
    rig.app.world().resource::<JointGraph>()
}

#[test]
fn the_graph_follows_joints_at_once() {
    let mut rig = Rig::weightless();
    let [a, b, c] = [0.0, 1.0, 2.0].map(|x| rig.rod(x, 0.0));
    let first = rig.spawn(RevoluteJoint::new(a, b));
    let second = rig.spawn((DistanceJoint::new(b, c), JointCollisionDisabled));
    assert!(graph(&rig).bodies_attached_to(b).eq([a, c]));
    assert_eq!(graph(&rig).bodies_of(second), Some([b, c]));
    let disabled = |rig: &Rig| graph(rig).get(second).map(|edge| edge.collision_disabled);
    assert_eq!(disabled(&rig), Some(true));
    rig.remove::<JointCollisionDisabled>(second);
    assert_eq!(disabled(&rig), Some(false));
    rig.insert(first, JointDisabled);
    assert!(graph(&rig).get(first).is_none() && graph(&rig).joints_between(a, b).next().is_none());
    rig.remove::<JointDisabled>(first);
    assert_eq!(graph(&rig).joints_between(b, a).map(|edge| edge.entity).collect::<Vec<_>>(), [first]);
    let id = graph(&rig).entity_to_joint(first).expect("it is listed");
    assert_eq!(graph(&rig).get_by_id(id).map(|edge| edge.entity), Some(first));

    // A mutation is seen in the next step.
    rig.app.world_mut().get_mut::<RevoluteJoint>(first).expect("a joint").body1 = c;
    rig.step();
    assert_eq!(graph(&rig).bodies_of(first), Some([c, b]));
    assert_eq!(graph(&rig).joints_of(a).count(), 0);
    rig.remove::<RevoluteJoint>(first);
    assert!(graph(&rig).get(first).is_none() && rig.app.world().get::<JointComponentId>(first).is_none());
    rig.despawn(second);
    assert_eq!(graph(&rig).joints_of(b).count(), 0);
}

#[test]
fn an_entity_has_one_joint() {
    let mut rig = Rig::weightless();
    let [a, b] = [0.0, 1.0].map(|x| rig.rod(x, 0.0));
    let joint = rig.spawn(FixedJoint::new(a, b));
    rig.insert(joint, PrismaticJoint::new(b, a));
    assert!(rig.app.world().get::<FixedJoint>(joint).is_none());
    assert_eq!(graph(&rig).bodies_of(joint), Some([b, a]));
    assert_eq!(graph(&rig).joints_of(a).count(), 1);
    rig.insert(joint, FixedJoint::new(a, b));
    assert!(rig.app.world().get::<PrismaticJoint>(joint).is_none());
    assert_eq!(graph(&rig).bodies_of(joint), Some([a, b]));
    rig.steps(2);
}

/// A constraint of the app.
#[derive(Component)]
struct Spring(Entity, Entity);

impl MapEntities for Spring {
    fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
        self.0 = mapper.get_mapped(self.0);
        self.1 = mapper.get_mapped(self.1);
    }
}

impl EntityConstraint<2> for Spring {
    fn entities(&self) -> [Entity; 2] {
        [self.0, self.1]
    }
}

#[test]
fn constraints_of_the_app_are_listed() {
    let group = PhysicsPlugins::new(Update).build().add(JointGraphPlugin::<Spring>::default());
    let mut rig = Rig::with(group);
    let [a, b] = [0.0, 1.0].map(|x| rig.rod(x, 0.0));
    let spring = rig.spawn(Spring(a, b));
    rig.step();
    assert_eq!(graph(&rig).bodies_of(spring), Some([a, b]));
    rig.remove::<Spring>(spring);
    assert!(graph(&rig).get(spring).is_none());
}

#[test]
fn entities_of_a_joint_are_mapped() {
    struct Swap(Entity, Entity);

    impl EntityMapper for Swap {
        fn get_mapped(&mut self, source: Entity) -> Entity {
            if source == self.0 { self.1 } else { self.0 }
        }

        fn set_mapped(&mut self, _: Entity, _: Entity) {}
    }

    let mut rig = Rig::weightless();
    let [a, b] = [0.0, 1.0].map(|x| rig.rod(x, 0.0));
    let mut joint = DistanceJoint::new(a, b);
    joint.map_entities(&mut Swap(a, b));
    assert_eq!(joint, DistanceJoint::new(b, a));
    let mut joint = RevoluteJoint::new(a, b);
    joint.map_entities(&mut Swap(a, b));
    assert_eq!(joint.entities(), [b, a]);
}
