//! State that persists between steps and is no component: the kernel's tables, as resources. Clones of them are a
//! snapshot.

use bevy_ecs::{change_detection::Tick, prelude::*, system::SystemParam};
use kernel::{
    contact::{ContactTable, Link},
    data::BitSet,
    graph::{ColorGraph, Islands},
    math::WorldPose,
    table::{BodyTable, ColliderTable, Velocity},
};

use crate::{
    collider_tree::proxies::ProxyTable,
    physics_transform::{Position, Rotation},
    scan::Since,
};

/// All bodies in the simulation.
#[derive(Resource, Clone, Default)]
pub(crate) struct Bodies {
    pub(crate) table: BodyTable,
    /// The entity of each id.
    pub(crate) entities: Vec<Entity>,
    /// The last pose of each id's components, as read or written by the engine. A different pose is a change by the
    /// app. (The table's pose, of the centre of mass, would differ in the last bit.)
    pub(crate) seen: Vec<WorldPose>,
    /// Velocities of bodies that fell asleep in motion, by id, as long as needed. Components keep them, and a body
    /// wakes with its velocity, so that a stack continues as if it had not slept. In the kernel a sleeping body has no
    /// velocity, since that would sweep its box and find contacts that wake it.
    pub(crate) kept: Vec<Velocity>,
    /// Tick of the engine's last write of poses and velocities. Components with this tick were not changed by the app.
    pub(crate) written: Tick,
    /// Tick of the last read of poses in this step. Newer changes were made by the app within the step.
    pub(crate) read: Tick,
    /// Awake bodies that the app moved within this step, with their poses.
    pub(crate) moved_within: Vec<(u32, Position, Rotation)>,
    /// Bodies with a solver row in this step, in the order of rows, from row 1.
    pub(crate) listed: Vec<u32>,
    /// Entities that are looked up one by one. Kept for its buffer.
    pub(crate) some: Vec<Entity>,
    /// Body ids. Kept for its buffer.
    pub(crate) ids: Vec<u32>,
}

impl Bodies {
    /// Stops a body that fell asleep, and stores its velocity.
    pub(crate) fn still(&mut self, id: u32) {
        let velocity = self.table.velocities[id as usize];
        if velocity == Velocity::default() {
            return;
        }
        if self.kept.len() <= id as usize {
            self.kept.resize(self.entities.len(), Velocity::default());
        }
        self.kept[id as usize] = velocity;
        self.table.set_velocity(id, Velocity::default());
    }

    /// Whether a change tick is from the app, not from the engine.
    pub(crate) fn is_set_by_app(&self, changed: Tick, since: Since) -> bool {
        since.is_new(changed) && changed != self.written
    }
}

/// All colliders in the simulation, and their trees.
#[derive(Resource, Clone, Default)]
pub(crate) struct Colliders {
    pub(crate) table: ColliderTable,
    /// The entity of each id.
    pub(crate) entities: Vec<Entity>,
    pub(crate) trees: ProxyTable,
    /// Colliders whose fat box changed since the last search for pairs.
    pub(crate) moved: BitSet,
    /// Colliders whose pose must be updated before the next search for pairs.
    pub(crate) stale: BitSet,
}

/// All contacts, and their colours.
#[derive(Resource, Clone, Default)]
pub(crate) struct Contacts {
    pub(crate) table: ContactTable,
    pub(crate) colors: ColorGraph,
    /// Contacts that began or ceased to touch in this step's narrow phase.
    pub(crate) changed: BitSet,
}

/// The islands. Absent without the island plugin: then no body sleeps.
#[derive(Resource, Clone, Default)]
pub(crate) struct PhysicsIslands(pub(crate) Islands);

/// All tables that a change of contacts may affect.
#[derive(SystemParam)]
pub(crate) struct Tables<'w> {
    pub(crate) bodies: ResMut<'w, Bodies>,
    pub(crate) colliders: ResMut<'w, Colliders>,
    pub(crate) contacts: ResMut<'w, Contacts>,
    pub(crate) islands: Option<ResMut<'w, PhysicsIslands>>,
}

impl Tables<'_> {
    /// The kernel's interface for changes of contacts.
    pub(crate) fn link(&mut self) -> Link<'_> {
        let Contacts { table, colors, .. } = &mut *self.contacts;
        Link {
            bodies: &mut self.bodies.table,
            colliders: &mut self.colliders.table,
            contacts: table,
            colors,
            islands: self.islands.as_mut().map(|i| &mut i.0),
        }
    }
}

/// Whether looking up the wanted entities is cheaper than iterating the queries: they are less than a quarter of all. `all`
/// are the size hints of the queries.
pub(crate) fn is_minority<const N: usize>(wanted: usize, all: [(usize, Option<usize>); N]) -> bool {
    4 * wanted < all.iter().map(|hint| hint.1.unwrap_or(0)).sum()
}
