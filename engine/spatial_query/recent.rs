//! Colliders that differ from the tables: the app spawned, changed, moved or removed them since the last
//! step.
//!
//! The tables and trees follow components once per step. Until then a query skips the changed colliders in
//! the tables, and searches their components instead, through a separate tree. All systems and observers
//! share this state: each run adds the changes since the last one (`world.rs`).

use bevy_ecs::{
    entity::{EntityHashMap, EntityIndexSet},
    prelude::*,
};
use kernel::{
    bvh::{ProxyId, TreeKind, Trees},
    data::BitSet,
    math::WorldPose,
    shape::Shape,
    table::NONE,
};

use crate::collision::collider::CollisionLayers;

/// Orders of colliders without an id begin here, above all ids.
const RECENT: u32 = 1 << 31;

/// A collider that differs from the tables.
#[derive(Clone, Debug)]
pub(super) struct RecentCollider {
    pub(super) entity: Entity,
    /// Its id in the tables, or [`NONE`].
    pub(super) id: u32,
    pub(super) shape: Shape,
    pub(super) pose: WorldPose,
    pub(super) layers: CollisionLayers,
    /// Whether the collider uses its own pose, though it has a body.
    pub(super) is_detached: bool,
}

impl RecentCollider {
    /// The id of the collider, or a number above all ids if it has none. Orders hits at the same distance.
    pub(super) fn order(&self) -> u32 {
        if self.id == NONE { RECENT | self.entity.index_u32() } else { self.id }
    }
}

/// The present state of an entity that may differ from the tables.
pub(super) struct Seen {
    pub(super) entity: Entity,
    /// The id of the entity in the tables, or [`NONE`].
    pub(super) id: u32,
    /// The collider of the entity, if it takes part in queries.
    pub(super) collider: Option<RecentCollider>,
}

/// All colliders that differ from the tables.
#[derive(Clone, Default)]
pub(super) struct Recent {
    /// Ids of colliders whose data in the tables is outdated.
    pub(super) replaced: BitSet,
    /// A tree over the places of colliders.
    pub(super) trees: Trees,
    colliders: Vec<Option<(RecentCollider, ProxyId)>>,
    /// The place of each entity's collider.
    places: EntityHashMap<u32>,
    /// Places without a collider.
    free: Vec<u32>,
    /// Colliders that use their own pose, though they have a body.
    pub(super) detached: EntityIndexSet,
}

impl Recent {
    /// The collider at a place of the tree.
    pub(super) fn collider(&self, place: u32) -> Option<&RecentCollider> {
        self.colliders.get(place as usize)?.as_ref().map(|(collider, _)| collider)
    }

    /// Whether an entity's collider is in this set.
    pub(super) fn holds(&self, entity: Entity) -> bool {
        self.places.contains_key(&entity)
    }

    /// Replaces the known state of some entities.
    pub(super) fn update(&mut self, all: impl Iterator<Item = Seen>) {
        let tree = &mut self.trees[TreeKind::Standalone];
        let (mut leaves, mut new) = (Vec::new(), Vec::new());
        for Seen { entity, id, collider } in all {
            if id != NONE {
                self.replaced.insert(id);
            }
            if collider.as_ref().is_some_and(|collider| collider.is_detached) {
                self.detached.insert(entity);
            } else {
                self.detached.swap_remove(&entity);
            }
            let known = self.places.get(&entity).copied();
            let held = known.and_then(|place| self.colliders[place as usize].as_mut());
            match (held, collider) {
                (Some((old, proxy)), Some(collider)) => {
                    tree.set(*proxy, collider.shape.aabb(&collider.pose));
                    *old = collider;
                }
                (Some((_, proxy)), None) => {
                    tree.remove(*proxy);
                    if let Some(place) = self.places.remove(&entity) {
                        self.colliders[place as usize] = None;
                        self.free.push(place);
                    }
                }
                (None, Some(collider)) => {
                    let place = self.free.pop().unwrap_or_else(|| {
                        self.colliders.push(None);
                        self.colliders.len() as u32 - 1
                    });
                    self.places.insert(entity, place);
                    leaves.push((place, collider.shape.aabb(&collider.pose)));
                    new.push(collider);
                }
                (None, None) => {}
            }
        }
        let mut proxies = Vec::with_capacity(leaves.len());
        tree.insert_many(&leaves, &mut proxies);
        for ((collider, proxy), (place, _)) in new.into_iter().zip(proxies).zip(leaves) {
            self.colliders[place as usize] = Some((collider, proxy));
        }
    }
}
