//! What persists between steps and has no component: the kernel's tables, as resources that can be cloned
//! for a snapshot.

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
    /// The pose that the components of each id last said, read or written: what differs, the app changed. The
    /// table's own, from the centre of mass, would differ in the last bit.
    pub(crate) seen: Vec<WorldPose>,
    /// The velocity of each body that fell asleep in motion, by id as far as one did. Components keep it, and the
    /// body wakes with it: a stack goes on as if it had not slept. To the kernel a sleeping body stands still, or
    /// its velocity would widen boxes and bring contacts that wake it.
    pub(crate) kept: Vec<Velocity>,
    /// When the engine last wrote poses and velocities: what bears this tick the app did not change.
    pub(crate) written: Tick,
    /// When poses were last read in this step: what is newer the app changed within it.
    pub(crate) read: Tick,
    /// The bodies that are moving and that the app put elsewhere within this step, and where.
    pub(crate) moved_within: Vec<(u32, Position, Rotation)>,
    /// The bodies with a solver row in this step, in the order of their rows from row 1.
    pub(crate) listed: Vec<u32>,
    /// The entities of a few bodies that are looked up one by one, kept for its memory.
    pub(crate) some: Vec<Entity>,
    /// The ids of a few bodies, kept for its memory.
    pub(crate) ids: Vec<u32>,
}

impl Bodies {
    /// Stops a body that fell asleep, and keeps its velocity.
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

    /// Whether the app, not the engine, changed what bears a tick.
    pub(crate) fn is_set_by_app(&self, changed: Tick, since: Since) -> bool {
        since.is_new(changed) && changed != self.written
    }
}

/// All colliders in the simulation, and the trees they are in.
#[derive(Resource, Clone, Default)]
pub(crate) struct Colliders {
    pub(crate) table: ColliderTable,
    /// The entity of each id.
    pub(crate) entities: Vec<Entity>,
    pub(crate) trees: ProxyTable,
    /// Colliders whose fat box changed since pairs were last looked for.
    pub(crate) moved: BitSet,
    /// Colliders to be put where their bodies are before the next pairs.
    pub(crate) stale: BitSet,
}

/// All contacts, and the colours they are solved in.
#[derive(Resource, Clone, Default)]
pub(crate) struct Contacts {
    pub(crate) table: ContactTable,
    pub(crate) colors: ColorGraph,
    /// Contacts that began or ended to touch in this step's narrow phase.
    pub(crate) changed: BitSet,
}

/// Which bodies touch each other and sleep together. Absent without the island plugin: then nobody sleeps.
#[derive(Resource, Clone, Default)]
pub(crate) struct PhysicsIslands(pub(crate) Islands);

/// All tables that a change of contacts touches.
#[derive(SystemParam)]
pub(crate) struct Tables<'w> {
    pub(crate) bodies: ResMut<'w, Bodies>,
    pub(crate) colliders: ResMut<'w, Colliders>,
    pub(crate) contacts: ResMut<'w, Contacts>,
    pub(crate) islands: Option<ResMut<'w, PhysicsIslands>>,
}

impl Tables<'_> {
    /// The kernel's door for changes of contacts.
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

/// Whether so few of the entities that some queries hold are wanted that looking them up is cheaper than walking
/// through all of them. `all` are the size hints of the queries.
pub(crate) fn is_minority<const N: usize>(wanted: usize, all: [(usize, Option<usize>); N]) -> bool {
    4 * wanted < all.iter().map(|hint| hint.1.unwrap_or(0)).sum()
}
