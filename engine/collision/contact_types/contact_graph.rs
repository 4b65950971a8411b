//! [`ContactGraph`]: all contacts at one time, and pairs that the app adds.

use bevy_ecs::{
    entity::{Entity, EntityHashMap},
    resource::Resource,
};
use bevy_platform::collections::HashMap;
use core::sync::atomic::{AtomicBool, Ordering};

use super::pair::{ContactEdge, ContactId, ContactPair, ContactPairFlags};
use crate::data_structures::pair_key::PairKey;

/// All pairs of colliders whose boxes overlap, touching or not, awake or asleep, in order of ids.
///
/// The resource is filled after the narrow phase and after the solver, starting in the step after its first
/// read: an app that never reads it pays nothing. Contacts of despawned colliders are removed at once, and
/// the last contacts take their places in the order. [`Collisions::graph`](super::Collisions::graph) has no
/// such delay.
///
/// A broad phase of the app adds pairs to the resource with [`add_edge`](Self::add_edge), in
/// [`BroadPhaseSystems::CollectCollisions`](crate::prelude::BroadPhaseSystems::CollectCollisions). They
/// become contacts after that set. To change manifolds, use
/// [`CollisionHooks`](crate::prelude::CollisionHooks).
#[derive(Resource, Clone, Debug, Default)]
pub struct ContactGraph {
    /// Whether the app ever read the graph.
    is_read: Flag,
    /// Pairs to be added.
    added: Vec<AddedPair>,
    /// Pairs to be removed.
    removed: Vec<[Entity; 2]>,
    edges: Vec<ContactEdge>,
    active: Vec<ContactPair>,
    sleeping: Vec<ContactPair>,
    /// Indices into `edges` by contact id.
    by_id: HashMap<u32, usize>,
    /// Indices into `edges` by the indices of both entities.
    by_key: HashMap<u64, usize>,
    /// Indices into `edges` by collider.
    by_collider: EntityHashMap<Vec<usize>>,
}

/// A pair that the app adds.
#[derive(Clone, Debug)]
pub(crate) struct AddedPair {
    pub(crate) colliders: [Entity; 2],
    /// Whether the solver pushes the colliders apart.
    pub(crate) pushes: bool,
}

/// A flag that readers set.
#[derive(Debug, Default)]
struct Flag(AtomicBool);

impl Flag {
    fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }

    fn set(&self) {
        if !self.is_set() {
            self.0.store(true, Ordering::Relaxed);
        }
    }
}

impl Clone for Flag {
    fn clone(&self) -> Self {
        Self(AtomicBool::new(self.is_set()))
    }
}

/// The indices of the entities of a contact.
fn key_of(edge: &ContactEdge) -> u64 {
    PairKey::new(edge.collider1.index_u32(), edge.collider2.index_u32()).0
}

impl ContactGraph {
    /// Whether the app ever read the graph.
    pub(crate) fn is_read(&self) -> bool {
        self.is_read.is_set()
    }

    /// Takes the contacts of another graph.
    pub(crate) fn refill(&mut self, with: &Self) {
        let Self { edges, active, sleeping, by_id, by_key, by_collider, .. } = with;
        self.edges.clone_from(edges);
        self.active.clone_from(active);
        self.sleeping.clone_from(sleeping);
        self.by_id.clone_from(by_id);
        self.by_key.clone_from(by_key);
        self.by_collider.clone_from(by_collider);
    }

    /// Removes the contacts of a despawned collider. The last contacts take their places.
    pub(crate) fn remove_collider(&mut self, collider: Entity) {
        while let Some(&place) = self.by_collider.get(&collider).and_then(|places| places.last()) {
            self.remove_at(place);
        }
        self.by_collider.remove(&collider);
    }

    fn remove_at(&mut self, place: usize) {
        let edge = self.edges.swap_remove(place);
        self.by_id.remove(&edge.id.0);
        self.by_key.remove(&key_of(&edge));
        for collider in [edge.collider1, edge.collider2] {
            if let Some(places) = self.by_collider.get_mut(&collider) {
                places.retain(|held| *held != place);
            }
        }
        if let Some(moved) = self.edges.get(place) {
            let from = self.edges.len();
            self.by_id.insert(moved.id.0, place);
            self.by_key.insert(key_of(moved), place);
            for collider in [moved.collider1, moved.collider2] {
                let places = self.by_collider.get_mut(&collider).into_iter().flatten();
                places.filter(|held| **held == from).for_each(|held| *held = place);
            }
        }
        let pairs = if edge.is_sleeping() { &mut self.sleeping } else { &mut self.active };
        pairs.swap_remove(edge.pair_index);
        if let Some(moved) = pairs.get(edge.pair_index) {
            self.edges[self.by_id[&moved.contact_id.0]].pair_index = edge.pair_index;
        }
    }

    /// Takes the pairs that the app added and removed since the last call.
    pub(crate) fn take_changes(&mut self) -> (Vec<AddedPair>, Vec<[Entity; 2]>) {
        (core::mem::take(&mut self.added), core::mem::take(&mut self.removed))
    }

    /// Adds a pair of colliders. The pair becomes a contact after the broad phase of this step, or of the
    /// next step if that phase is over. The contact lasts until the enlarged boxes of the colliders separate.
    ///
    /// Returns `None` if the pair has a contact or was added already. The id is [`ContactId::PLACEHOLDER`]:
    /// the contact gets its own id when it is created. Bodies and flags of `contact_edge` are not used; they
    /// follow from the colliders.
    ///
    /// No contact is created between a collider and itself, between colliders of one body, between layers
    /// that do not interact, and without a dynamic or kinematic body, unless neither collider has a body and
    /// one is a sensor.
    pub fn add_edge(&mut self, contact_edge: ContactEdge) -> Option<ContactId> {
        self.add_edge_with(contact_edge, |_| ())
    }

    /// As [`add_edge`](Self::add_edge). If `pair_callback` clears [`ContactPairFlags::GENERATE_CONSTRAINTS`],
    /// the solver does not push the colliders apart. Other changes to the pair are ignored.
    pub fn add_edge_with<F>(&mut self, contact_edge: ContactEdge, pair_callback: F) -> Option<ContactId>
    where
        F: FnMut(&mut ContactPair),
    {
        let ContactEdge { collider1, collider2, .. } = contact_edge;
        let key = PairKey::new(collider1.index_u32(), collider2.index_u32());
        self.add_edge_and_key_with(contact_edge, key, pair_callback)
    }

    /// As [`add_edge_with`](Self::add_edge_with), with the key of the pair if it is known.
    pub fn add_edge_and_key_with<F>(
        &mut self,
        contact_edge: ContactEdge,
        pair_key: PairKey,
        mut pair_callback: F,
    ) -> Option<ContactId>
    where
        F: FnMut(&mut ContactPair),
    {
        let ContactEdge { collider1, collider2, .. } = contact_edge;
        let colliders = [collider1, collider2];
        if self.contains_key(&pair_key) && self.get_edge(collider1, collider2).is_some() {
            return None;
        }
        let mut pair = ContactPair::new(collider1, collider2, ContactId::PLACEHOLDER);
        pair.flags = ContactPairFlags::GENERATE_CONSTRAINTS;
        pair_callback(&mut pair);
        self.added.push(AddedPair { colliders, pushes: pair.generates_constraints() });
        Some(ContactId::PLACEHOLDER)
    }

    /// Removes the contact of two colliders after the broad phase of this step, or of the next step. Returns
    /// the contact. If it touched, the end of the collision is reported.
    ///
    /// The broad phase finds the pair again when one of the colliders moves.
    pub fn remove_edge(&mut self, entity1: Entity, entity2: Entity) -> Option<ContactEdge> {
        self.removed.push([entity1, entity2]);
        self.get_edge(entity1, entity2).cloned()
    }

    /// As [`remove_edge`](Self::remove_edge), by the id of the contact.
    pub fn remove_edge_by_id(&mut self, _pair_key: &PairKey, id: ContactId) -> Option<ContactEdge> {
        let &ContactEdge { collider1, collider2, .. } = self.get_edge_by_id(id)?;
        self.remove_edge(collider1, collider2)
    }

    /// Adds a contact.
    pub(super) fn push(&mut self, mut edge: ContactEdge, pair: ContactPair) {
        let place = self.edges.len();
        let pairs = if edge.is_sleeping() { &mut self.sleeping } else { &mut self.active };
        edge.pair_index = pairs.len();
        pairs.push(pair);
        self.by_id.insert(edge.id.0, place);
        self.by_key.insert(key_of(&edge), place);
        for collider in [edge.collider1, edge.collider2] {
            self.by_collider.entry(collider).or_default().push(place);
        }
        self.edges.push(edge);
    }

    /// The contact of two colliders, in either order.
    pub fn get_edge(&self, entity1: Entity, entity2: Entity) -> Option<&ContactEdge> {
        self.is_read.set();
        let key = PairKey::new(entity1.index_u32(), entity2.index_u32());
        let edge = &self.edges[*self.by_key.get(&key.0)?];
        let colliders = [edge.collider1, edge.collider2];
        (colliders == [entity1, entity2] || colliders == [entity2, entity1]).then_some(edge)
    }

    /// The contact with an id.
    pub fn get_edge_by_id(&self, id: ContactId) -> Option<&ContactEdge> {
        self.is_read.set();
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
        self.is_read.set();
        self.by_key.contains_key(&pair_key.0)
    }

    /// The pairs with an awake body, or without a body that can sleep.
    pub fn active_pairs(&self) -> &[ContactPair] {
        self.is_read.set();
        &self.active
    }

    /// The pairs of sleeping bodies.
    pub fn sleeping_pairs(&self) -> &[ContactPair] {
        self.is_read.set();
        &self.sleeping
    }

    /// The pairs with an awake body, or without a body that can sleep.
    pub fn iter_active(&self) -> impl Iterator<Item = &ContactPair> {
        self.active_pairs().iter()
    }

    /// The touching pairs with an awake body, or without a body that can sleep.
    pub fn iter_active_touching(&self) -> impl Iterator<Item = &ContactPair> {
        self.active_pairs().iter().filter(|pair| pair.is_touching())
    }

    /// The pairs of sleeping bodies.
    pub fn iter_sleeping(&self) -> impl Iterator<Item = &ContactPair> {
        self.sleeping_pairs().iter()
    }

    /// The touching pairs of sleeping bodies.
    pub fn iter_sleeping_touching(&self) -> impl Iterator<Item = &ContactPair> {
        self.sleeping_pairs().iter().filter(|pair| pair.is_touching())
    }

    /// The contacts of a collider.
    pub fn contact_edges_with(&self, entity: Entity) -> impl Iterator<Item = &ContactEdge> {
        self.is_read.set();
        let places = self.by_collider.get(&entity).map_or(&[][..], Vec::as_slice);
        places.iter().map(|place| &self.edges[*place])
    }

    /// The contacts of a collider, with their manifolds.
    pub fn contact_pairs_with(&self, entity: Entity) -> impl Iterator<Item = &ContactPair> {
        self.contact_edges_with(entity).filter_map(|edge| self.get_pair_by_edge(edge))
    }

    /// The colliders whose boxes overlap the box of a collider.
    pub fn entities_colliding_with(&self, entity: Entity) -> impl Iterator<Item = Entity> + '_ {
        self.contact_edges_with(entity)
            .map(move |edge| if edge.collider1 == entity { edge.collider2 } else { edge.collider1 })
    }
}
