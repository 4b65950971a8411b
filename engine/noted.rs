//! A queue of entities without duplicates.
//!
//! Observers fill these queues even while physics is paused, for an unlimited time. Therefore a queue holds
//! one entry per entity index: an entity replaces the entry of a despawned entity with the same index. The
//! queue is never longer than the largest number of entities alive at one time.

use bevy_ecs::entity::Entity;

/// An index without an entry.
const NOWHERE: u32 = u32::MAX;

/// Queues with fewer entries than this are not compacted.
const SMALL: usize = 64;

/// Entities in the order in which they were first queued, each with its last queued value.
///
/// An `EntityIndexSet` is not suitable: its hash uses only the index, so the many generations of one index in
/// an app with paused physics would all collide.
#[derive(Clone, Debug)]
pub(crate) struct Noted<T = ()> {
    /// Entries. Removed ones are `None`.
    order: Vec<Option<(Entity, T)>>,
    /// Index in `order` of each entity index.
    places: Vec<u32>,
    len: usize,
}

impl<T> Default for Noted<T> {
    fn default() -> Self {
        Self { order: Vec::new(), places: Vec::new(), len: 0 }
    }
}

impl<T> Noted<T> {
    /// Queues an entity, or replaces its value. Returns the despawned entity whose entry it replaces.
    pub(crate) fn put(&mut self, entity: Entity, value: T) -> Option<Entity> {
        let index = entity.index_u32() as usize;
        if self.places.len() <= index {
            self.places.resize(index + 1, NOWHERE);
        }
        let mut displaced = None;
        if let Some(entry) = self.order.get_mut(self.places[index] as usize) {
            match entry {
                Some((held, old)) if *held == entity => {
                    *old = value;
                    return None;
                }
                _ => displaced = entry.take().map(|(held, _)| held),
            }
            self.len -= 1;
        }
        if self.order.len() > SMALL.max(2 * self.len) {
            self.compact();
        }
        self.places[index] = self.order.len() as u32;
        self.order.push(Some((entity, value)));
        self.len += 1;
        displaced
    }

    fn compact(&mut self) {
        self.order.retain(Option::is_some);
        for (place, (entity, _)) in self.order.iter().flatten().enumerate() {
            self.places[entity.index_u32() as usize] = place as u32;
        }
    }

    /// Whether the entity is queued.
    #[cfg(any(test, feature = "validate"))]
    pub(crate) fn contains(&self, entity: Entity) -> bool {
        let place = self.places.get(entity.index_u32() as usize);
        let entry = place.and_then(|place| self.order.get(*place as usize)?.as_ref());
        entry.is_some_and(|(held, _)| *held == entity)
    }

    /// The number of queued entities.
    pub(crate) fn len(&self) -> usize {
        self.len
    }

    /// Whether the queue is empty.
    pub(crate) fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The entities in order.
    pub(crate) fn entities(&self) -> impl Iterator<Item = Entity> + '_ {
        self.order.iter().flatten().map(|(entity, _)| *entity)
    }

    /// Empties the queue and iterates over its entries.
    pub(crate) fn drain(&mut self) -> impl Iterator<Item = (Entity, T)> + '_ {
        for (entity, _) in self.order.iter().flatten() {
            self.places[entity.index_u32() as usize] = NOWHERE;
        }
        self.len = 0;
        self.order.drain(..).flatten()
    }
}

impl Noted {
    /// Queues an entity. Returns the despawned entity whose entry it replaces.
    #[inline]
    pub(crate) fn note(&mut self, entity: Entity) -> Option<Entity> {
        // Observers of one entity's components run one after the other, so repeats are adjacent.
        if self.order.last() == Some(&Some((entity, ()))) {
            return None;
        }
        self.put(entity, ())
    }

    /// Queues entities in order.
    pub(crate) fn extend(&mut self, entities: impl IntoIterator<Item = Entity>) {
        entities.into_iter().for_each(|entity| _ = self.note(entity));
    }

    /// Empties the queue into a list.
    pub(crate) fn take(&mut self) -> Vec<Entity> {
        self.drain().map(|(entity, ())| entity).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bevy_ecs::entity::{EntityGeneration, EntityIndex};
    use proptest::prelude::*;

    fn entity(index: u32, generation: u32) -> Entity {
        let index = EntityIndex::from_raw_u32(index).expect("a small index");
        Entity::from_index_and_generation(index, EntityGeneration::from_bits(generation))
    }

    proptest! {
        /// Compares the queue with a list with linear search.
        #[test]
        fn each_index_is_noted_once_in_order(
            notes in prop::collection::vec((0..200u32, 0..4u32, any::<u16>(), 0..400u32), 0..3000),
        ) {
            let mut noted = Noted::<u16>::default();
            let mut model: Vec<(Entity, u16)> = Vec::new();
            for (index, generation, value, kind) in notes {
                let new = entity(index, generation);
                if kind == 0 {
                    prop_assert_eq!(noted.drain().collect::<Vec<_>>(), core::mem::take(&mut model));
                } else if let Some(held) = model.iter_mut().find(|(held, _)| *held == new) {
                    held.1 = value;
                    prop_assert_eq!(noted.put(new, value), None);
                } else {
                    let old = model.iter().position(|(held, _)| held.index() == new.index());
                    let displaced = old.map(|place| model.remove(place).0);
                    model.push((new, value));
                    prop_assert_eq!(noted.put(new, value), displaced);
                }
                prop_assert_eq!(noted.len(), model.len());
                prop_assert!(noted.order.len() <= 2 * noted.len() + SMALL + 1);
                prop_assert_eq!(noted.contains(new), model.iter().any(|(held, _)| *held == new));
            }
            prop_assert!(noted.entities().eq(model.iter().map(|(held, _)| *held)));
        }
    }
}
