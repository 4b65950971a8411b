//! [`JointGraph`]: the joints between bodies, as a graph.

mod component_id;
mod plugin;

pub use component_id::JointComponentId;
pub use plugin::JointGraphPlugin;

use bevy_ecs::{
    entity::{Entity, EntityHashMap},
    resource::Resource,
    schedule::SystemSet,
};
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use core::fmt;

/// The graph of joints: each joint is an edge between two entities.
///
/// It contains the joints of all types with a [`JointGraphPlugin`] that are neither disabled nor despawned,
/// whether or not their entities are bodies. It is updated at once when a joint is spawned, inserted, removed
/// or disabled, and at the start of the next step when a joint's bodies were mutated. The joints of a body
/// are in the order in which they were added, unless some were removed.
///
/// ```
/// # use avian::{dynamics::solver::joint_graph::JointGraph, prelude::*};
/// # use bevy_ecs::prelude::*;
/// # #[derive(Component)]
/// # struct Player;
/// fn print(player: Single<Entity, With<Player>>, joints: Res<JointGraph>) {
///     for other in joints.bodies_attached_to(*player) {
///         println!("attached to {other}");
///     }
/// }
/// ```
#[derive(Resource, Clone, Debug, Default)]
pub struct JointGraph {
    /// Edges by id. Free ids have `None`.
    edges: Vec<Option<JointGraphEdge>>,
    free: Vec<JointId>,
    by_joint: EntityHashMap<JointId>,
    by_body: EntityHashMap<Vec<JointId>>,
}

/// The id of a joint in [`JointGraph`]. Ids of removed joints are reused.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, PartialEq)]
pub struct JointId(pub u32);

impl JointId {
    /// The id of a joint that is not in the graph.
    pub const PLACEHOLDER: Self = Self(u32::MAX);
}

impl fmt::Display for JointId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "JointId({})", self.0)
    }
}

/// A joint in [`JointGraph`].
#[derive(Clone, Debug, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug)]
pub struct JointGraphEdge {
    /// The id in the graph.
    pub id: JointId,
    /// The entity of the joint.
    pub entity: Entity,
    /// The first body.
    pub body1: Entity,
    /// The second body.
    pub body2: Entity,
    /// Whether the joint has [`JointCollisionDisabled`](crate::dynamics::joints::JointCollisionDisabled).
    pub collision_disabled: bool,
}

impl JointGraphEdge {
    /// An edge that is not in the graph.
    pub fn new(entity: Entity, body1: Entity, body2: Entity, collision_disabled: bool) -> Self {
        Self { id: JointId::PLACEHOLDER, entity, body1, body2, collision_disabled }
    }

    fn has(&self, body: Entity) -> bool {
        self.body1 == body || self.body2 == body
    }
}

impl JointGraph {
    /// The id of a joint's entity.
    pub fn entity_to_joint(&self, entity: Entity) -> Option<JointId> {
        self.by_joint.get(&entity).copied()
    }

    /// The edge of a joint's entity.
    pub fn get(&self, joint: Entity) -> Option<&JointGraphEdge> {
        self.get_by_id(self.entity_to_joint(joint)?)
    }

    /// The edge with an id.
    pub fn get_by_id(&self, joint_id: JointId) -> Option<&JointGraphEdge> {
        self.edges.get(joint_id.0 as usize)?.as_ref()
    }

    /// The edge of a joint's entity. Changing its fields does not change the graph.
    pub fn get_mut(&mut self, joint: Entity) -> Option<&mut JointGraphEdge> {
        self.get_mut_by_id(self.entity_to_joint(joint)?)
    }

    /// The edge with an id. Changing its fields does not change the graph.
    pub fn get_mut_by_id(&mut self, joint_id: JointId) -> Option<&mut JointGraphEdge> {
        self.edges.get_mut(joint_id.0 as usize)?.as_mut()
    }

    /// The joints between two bodies, in either order.
    pub fn joints_between(&self, body1: Entity, body2: Entity) -> impl Iterator<Item = &JointGraphEdge> {
        self.joints_of(body1).filter(move |edge| edge.has(body2))
    }

    /// The joints of a body.
    pub fn joints_of(&self, body: Entity) -> impl Iterator<Item = &JointGraphEdge> {
        self.ids_of(body).iter().filter_map(|id| self.get_by_id(*id))
    }

    /// The joints of a body. Changing the fields of an edge does not change the graph.
    pub fn joints_of_mut(&mut self, body: Entity) -> impl Iterator<Item = &mut JointGraphEdge> {
        let mut ids: Vec<usize> = self.ids_of(body).iter().map(|id| id.0 as usize).collect();
        ids.sort_unstable();
        let mut rest = self.edges.iter_mut().enumerate();
        // Both lists are in ascending order.
        ids.into_iter().filter_map(move |id| rest.find(|(place, _)| *place == id)?.1.as_mut())
    }

    /// The bodies of a joint.
    pub fn bodies_of(&self, joint: Entity) -> Option<[Entity; 2]> {
        self.get(joint).map(|edge| [edge.body1, edge.body2])
    }

    /// The bodies attached to a body by joints, once per joint.
    pub fn bodies_attached_to(&self, body: Entity) -> impl Iterator<Item = Entity> + '_ {
        self.joints_of(body).map(move |edge| if edge.body1 == body { edge.body2 } else { edge.body1 })
    }

    /// Adds an edge between two bodies, or replaces the edge of the joint's entity. The arguments determine
    /// the fields of the edge.
    pub fn add_joint(&mut self, body1: Entity, body2: Entity, joint_edge: JointGraphEdge) -> JointId {
        self.remove_joint(joint_edge.entity);
        let id = self.free.pop().unwrap_or(JointId(self.edges.len() as u32));
        let edge = JointGraphEdge { id, body1, body2, ..joint_edge };
        self.by_joint.insert(edge.entity, id);
        self.by_body.entry(body1).or_default().push(id);
        if body2 != body1 {
            self.by_body.entry(body2).or_default().push(id);
        }
        match self.edges.get_mut(id.0 as usize) {
            Some(place) => *place = Some(edge),
            None => self.edges.push(Some(edge)),
        }
        id
    }

    /// Removes the edge of a joint's entity.
    pub fn remove_joint(&mut self, joint_entity: Entity) -> Option<JointGraphEdge> {
        let id = self.by_joint.remove(&joint_entity)?;
        let edge = self.edges.get_mut(id.0 as usize)?.take()?;
        self.free.push(id);
        for body in [edge.body1, edge.body2] {
            if let Some(ids) = self.by_body.get_mut(&body) {
                if let Some(place) = ids.iter().position(|other| *other == id) {
                    ids.swap_remove(place);
                }
                if ids.is_empty() {
                    self.by_body.remove(&body);
                }
            }
        }
        Some(edge)
    }

    fn ids_of(&self, body: Entity) -> &[JointId] {
        self.by_body.get(&body).map_or(&[], Vec::as_slice)
    }
}

/// The systems that update edges of mutated joints.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct SyncEdges;

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_ecs::world::World;

    #[test]
    fn edges_are_found_by_joint_and_by_body_until_they_are_removed() {
        let mut world = World::new();
        let [a, b, c, first, second, looped] = core::array::from_fn(|_| world.spawn_empty().id());
        let mut graph = JointGraph::default();
        let add = |graph: &mut JointGraph, joint, one, other| {
            graph.add_joint(one, other, JointGraphEdge::new(joint, one, other, false))
        };
        let id = add(&mut graph, first, a, b);
        add(&mut graph, second, b, c);
        add(&mut graph, looped, c, c);
        assert_eq!(graph.entity_to_joint(first), Some(id));
        assert_eq!(graph.get_by_id(id).map(|edge| edge.entity), Some(first));
        assert_eq!(graph.bodies_of(second), Some([b, c]));
        assert!(graph.bodies_attached_to(b).eq([a, c]));
        assert_eq!(graph.joints_between(b, a).count(), 1);
        assert_eq!(graph.joints_between(a, c).count(), 0);
        assert_eq!(graph.joints_of(c).count(), 2, "the loop counts once");
        graph.joints_of_mut(b).for_each(|edge| edge.collision_disabled = true);
        assert!(graph.joints_of(b).all(|edge| edge.collision_disabled));

        // The joint moves to other bodies.
        add(&mut graph, first, c, a);
        assert_eq!(graph.joints_of(b).count(), 1);
        assert!(graph.remove_joint(first).is_some() && graph.remove_joint(first).is_none());
        assert_eq!(graph.joints_of(a).count(), 0);
        graph.remove_joint(second);
        graph.remove_joint(looped);
        assert!(graph.by_body.is_empty() && graph.by_joint.is_empty(), "nothing is left");
    }
}
