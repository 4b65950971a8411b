//! [`Collisions`], the system parameter.

use bevy_ecs::{prelude::*, system::SystemParam};

use super::{
    contact_graph::ContactGraph,
    pair::ContactPair,
    views::{ContactViews, Source},
};
use crate::{
    data_structures::pair_key::PairKey,
    dynamics::{
        solver::schedule::SubstepCount,
        tables::{Bodies, Colliders, Contacts},
    },
};

/// The touching pairs of colliders, as a system parameter.
///
/// Colliders touch from the step in which their surfaces meet or push each other, until the surfaces are 2 cm
/// (times the length unit) apart. Sensors touch while they overlap.
///
/// Contact points are complete from [`NarrowPhaseSystems::Last`] on. Impulses, and pairs that start to touch
/// in the step, are known from [`SolverSystems::StoreContactImpulses`] on; in between, all pairs with points
/// count as touching. Systems that run between steps read the contacts of the last step, without colliders
/// that were despawned since. A contact is built when it is first read, once for all readers; a step without
/// reads costs nothing.
///
/// To react to changes, use [`CollisionStart`](crate::prelude::CollisionStart) and
/// [`CollisionEnd`](crate::prelude::CollisionEnd).
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # #[derive(Component)]
/// # struct Player;
/// fn print_load(players: Query<Entity, With<Player>>, collisions: Collisions) {
///     for player in &players {
///         for contact in collisions.collisions_with(player) {
///             println!("{} N·s", contact.total_normal_impulse_magnitude());
///         }
///     }
/// }
/// ```
///
/// [`NarrowPhaseSystems::Last`]: crate::collision::narrow_phase::NarrowPhaseSystems::Last
/// [`SolverSystems::StoreContactImpulses`]: crate::dynamics::solver::schedule::SolverSystems::StoreContactImpulses
#[derive(SystemParam)]
pub struct Collisions<'w> {
    views: Res<'w, ContactViews>,
    bodies: Res<'w, Bodies>,
    colliders: Res<'w, Colliders>,
    contacts: Res<'w, Contacts>,
    substeps: Option<Res<'w, SubstepCount>>,
}

impl Collisions<'_> {
    fn source(&self) -> Source<'_> {
        self.views.note_reader();
        Source {
            bodies: &self.bodies,
            colliders: &self.colliders,
            contacts: &self.contacts,
            substeps: self.substeps.as_ref().map_or(1, |count| count.0.max(1)),
        }
    }

    /// All contacts, including contacts of near colliders that do not touch. The graph is built again in each
    /// step in which it is read; [`get`](Self::get) and [`collisions_with`](Self::collisions_with) build only
    /// the requested contacts.
    pub fn graph(&self) -> &ContactGraph {
        self.views.graph(self.source())
    }

    /// The contact of two colliders that touch, in either order.
    pub fn get(&self, entity1: Entity, entity2: Entity) -> Option<&ContactPair> {
        let id = self.source().find(entity1, entity2)?;
        Some(self.views.pair(id, self.source()))
    }

    /// Whether two colliders touch.
    pub fn contains(&self, entity1: Entity, entity2: Entity) -> bool {
        self.source().find(entity1, entity2).is_some()
    }

    /// Whether two colliders touch, by the indices of their entities.
    pub fn contains_key(&self, pair_key: &PairKey) -> bool {
        let (first, second) = pair_key.get();
        let [first, second] = [first, second].map(|index| self.colliders.find_index(index));
        first.zip(second).is_some_and(|(first, second)| self.contains(first, second))
    }

    /// All touching pairs, in order of ids.
    pub fn iter(&self) -> impl Iterator<Item = &ContactPair> {
        let source = self.source();
        let touching = move |id: &u32| source.is_touching(*id);
        source
            .contacts
            .table
            .iter()
            .map(|(id, _)| id)
            .filter(touching)
            .map(move |id| self.views.pair(id, source))
    }

    /// The touching pairs of a collider, in order of ids.
    pub fn collisions_with(&self, entity: Entity) -> impl Iterator<Item = &ContactPair> {
        let source = self.source();
        source.touching(entity).into_iter().map(move |id| self.views.pair(id, source))
    }

    /// The colliders that touch a collider, in order of ids.
    pub fn entities_colliding_with(&self, entity: Entity) -> impl Iterator<Item = Entity> + '_ {
        let source = self.source();
        source.touching(entity).into_iter().map(move |id| {
            let [a, b] = source.entities(id);
            if a == entity { b } else { a }
        })
    }
}
