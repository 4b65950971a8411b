//! [`ContactGraph`]: all contacts at one time.

use bevy_ecs::{
    entity::{Entity, EntityHashMap},
    resource::Resource,
};
use bevy_platform::collections::HashMap;

use super::pair::{ContactEdge, ContactId, ContactPair};
use crate::data_structures::pair_key::PairKey;

/// All pairs of colliders whose boxes overlap, touching or not, awake or asleep, in the order of ids.
///
/// [`Collisions::graph`](super::Collisions::graph) makes it when it is called. The engine does not keep one as a
/// resource: filling it in every step would cost time where nothing reads it. An app that wants a copy of one step as a
/// resource inserts it.
#[derive(Resource, Clone, Debug, Default)]
pub struct ContactGraph {
    edges: Vec<ContactEdge>,
    active: Vec<ContactPair>,
    sleeping: Vec<ContactPair>,
    /// Places in `edges` by contact id.
    by_id: HashMap<u32, usize>,
    /// Places in `edges` by the indices of both entities.
    by_key: HashMap<u64, usize>,
    /// Places in `edges` by collider.
    by_collider: EntityHashMap<Vec<usize>>,
}

impl ContactGraph {
    /// Adds a contact.
    pub(super) fn push(&mut self, mut edge: ContactEdge, pair: ContactPair) {
        let place = self.edges.len();
        let pairs = if edge.is_sleeping() { &mut self.sleeping } else { &mut self.active };
        edge.pair_index = pairs.len();
        pairs.push(pair);
        self.by_id.insert(edge.id.0, place);
        let key = PairKey::new(edge.collider1.index_u32(), edge.collider2.index_u32());
        self.by_key.insert(key.0, place);
        for collider in [edge.collider1, edge.collider2] {
            self.by_collider.entry(collider).or_default().push(place);
        }
        self.edges.push(edge);
    }

    /// The contact of two colliders, in either order.
    pub fn get_edge(&self, entity1: Entity, entity2: Entity) -> Option<&ContactEdge> {
        let key = PairKey::new(entity1.index_u32(), entity2.index_u32());
        let edge = &self.edges[*self.by_key.get(&key.0)?];
        let colliders = [edge.collider1, edge.collider2];
        (colliders == [entity1, entity2] || colliders == [entity2, entity1]).then_some(edge)
    }

    /// The contact with an id.
    pub fn get_edge_by_id(&self, id: ContactId) -> Option<&ContactEdge> {
        self.by_id.get(&id.0).map(|place| &self.edges[*place])
    }

    /// The contact of two colliders, in either order, with its manifolds.
    pub fn get(&self, entity1: Entity, entity2: Entity) -> Option<(&ContactEdge, &ContactPair)> {
        let edge = self.get_edge(entity1, entity2)?;
        Some((edge, self.get_pair_by_edge(edge)?))
    }

    /// The contact with an id, with its manifolds.
    pub fn get_by_id(&self, id: ContactId) -> Option<(&ContactEdge, &ContactPair)> {
        let edge = self.get_edge_by_id(id)?;
        Some((edge, self.get_pair_by_edge(edge)?))
    }

    /// The manifolds of a contact of this graph.
    pub fn get_pair_by_edge(&self, edge: &ContactEdge) -> Option<&ContactPair> {
        let pairs = if edge.is_sleeping() { &self.sleeping } else { &self.active };
        pairs.get(edge.pair_index)
    }

    /// Whether the boxes of two colliders overlap.
    pub fn contains(&self, entity1: Entity, entity2: Entity) -> bool {
        self.get_edge(entity1, entity2).is_some()
    }

    /// Whether the boxes of two colliders overlap, by the indices of their entities.
    pub fn contains_key(&self, pair_key: &PairKey) -> bool {
        self.by_key.contains_key(&pair_key.0)
    }

    /// The pairs of which a body is awake, or none can sleep.
    pub fn active_pairs(&self) -> &[ContactPair] {
        &self.active
    }

    /// The pairs of sleeping bodies.
    pub fn sleeping_pairs(&self) -> &[ContactPair] {
        &self.sleeping
    }

    /// The pairs of which a body is awake, or none can sleep.
    pub fn iter_active(&self) -> impl Iterator<Item = &ContactPair> {
        self.active.iter()
    }

    /// The pairs that touch, and of which a body is awake or none can sleep.
    pub fn iter_active_touching(&self) -> impl Iterator<Item = &ContactPair> {
        self.active.iter().filter(|pair| pair.is_touching())
    }

    /// The pairs of sleeping bodies.
    pub fn iter_sleeping(&self) -> impl Iterator<Item = &ContactPair> {
        self.sleeping.iter()
    }

    /// The pairs of sleeping bodies that touch.
    pub fn iter_sleeping_touching(&self) -> impl Iterator<Item = &ContactPair> {
        self.sleeping.iter().filter(|pair| pair.is_touching())
    }

    /// The contacts of a collider.
    pub fn contact_edges_with(&self, entity: Entity) -> impl Iterator<Item = &ContactEdge> {
        let places = self.by_collider.get(&entity).map_or(&[][..], Vec::as_slice);
        places.iter().map(|place| &self.edges[*place])
    }

    /// The contacts of a collider, with their manifolds.
    pub fn contact_pairs_with(&self, entity: Entity) -> impl Iterator<Item = &ContactPair> {
        self.contact_edges_with(entity).filter_map(|edge| self.get_pair_by_edge(edge))
    }

    /// The colliders whose boxes overlap that of a collider.
    pub fn entities_colliding_with(&self, entity: Entity) -> impl Iterator<Item = Entity> + '_ {
        self.contact_edges_with(entity)
            .map(move |edge| if edge.collider1 == entity { edge.collider2 } else { edge.collider1 })
    }
}
