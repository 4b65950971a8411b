//! State that persists between steps and is not a component: the kernel's tables, as resources. Clones of
//! them are a snapshot.

use bevy_ecs::{change_detection::Tick, prelude::*, system::SystemParam};
use kernel::{
    contact::{Contact, ContactFlags, ContactManager, ContactTable, Status},
    data::{BitSet, PairSet},
    graph::{ColorGraph, Islands},
    math::WorldPose,
    table::{BodyKind, BodyTable, ColliderTable, NONE, Velocity},
};

use crate::{
    collider_tree::proxies::ProxyTable,
    dynamics::reports::{Hits, Report, Reports},
    physics_transform::{Position, Rotation},
    scan::Since,
};

/// All bodies in the simulation.
#[derive(Resource, Clone, Default)]
pub(crate) struct Bodies {
    pub(crate) table: BodyTable,
    /// The entity of each id.
    pub(crate) entities: Vec<Entity>,
    /// The last pose of each id's components, as read or written by the engine. A different pose is a change
    /// by the app. (The table's pose, of the centre of mass, would differ in the last bit.)
    pub(crate) seen: Vec<WorldPose>,
    /// Velocities of bodies that fell asleep in motion, by id, as long as needed. Components keep these
    /// velocities, and a body wakes with its velocity, so a stack continues as if it had not slept. In the
    /// kernel a sleeping body has no velocity: a velocity would sweep its box and find contacts that wake it.
    pub(crate) kept: Vec<Velocity>,
    /// Tick of the engine's last write of poses and velocities. The app has not changed components with this
    /// tick.
    pub(crate) written: Tick,
    /// Tick of the last read of poses in this step. Newer changes were made by the app within the step.
    pub(crate) read: Tick,
    /// Awake bodies that the app moved within this step, with their poses.
    pub(crate) moved_within: Vec<(u32, Position, Rotation)>,
    /// Bodies with a solver row in this step, in the order of rows, from row 1.
    pub(crate) listed: Vec<u32>,
    /// Pairs of bodies whose collisions are disabled by joints, with the number of these joints.
    pub(crate) apart: PairSet,
    /// Entities that are looked up one by one. A reused buffer.
    pub(crate) some: Vec<Entity>,
    /// Body ids. A reused buffer.
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

    /// Whether a pair of colliders may form a contact: [`may_collide`], and no joint disables it.
    pub(crate) fn may_pair(&self, colliders: &ColliderTable, pair: [u32; 2]) -> bool {
        let [a, b] = pair.map(|id| colliders.body(id));
        let is_apart = !self.apart.is_empty() && a != b && self.apart.contains(a, b);
        !is_apart && may_collide(&self.table, colliders, pair)
    }

    /// Whether the app, not the engine, made the change with this tick.
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
    /// Colliders whose pairs are searched in the next step: their enlarged boxes changed, or some pair waits.
    pub(crate) moved: BitSet,
    /// Colliders whose pose must be updated before the next search for pairs.
    pub(crate) stale: BitSet,
    /// The id of each entity, by the entity's index. Outdated for entities without a collider.
    by_entity: Vec<u32>,
    /// Colliders that report collisions.
    pub(crate) reporting: BitSet,
    /// Colliders with `CollidingEntities`.
    pub(crate) tracking: BitSet,
    /// Colliders whose pairs are filtered by hooks.
    pub(crate) filtering: BitSet,
    /// Colliders whose contacts are modified by hooks.
    pub(crate) modifying: BitSet,
    /// Colliders that report blows.
    pub(crate) hitting: BitSet,
}

impl Colliders {
    /// Stores the entity of a new id.
    pub(crate) fn name(&mut self, id: u32, entity: Entity) {
        let (place, index) = (id as usize, entity.index_u32() as usize);
        if self.entities.len() <= place {
            self.entities.resize(place + 1, Entity::PLACEHOLDER);
        }
        if self.by_entity.len() <= index {
            self.by_entity.resize(index + 1, NONE);
        }
        self.entities[place] = entity;
        self.by_entity[index] = id;
    }

    /// Removes the entity of a freed id.
    pub(crate) fn forget(&mut self, id: u32) {
        self.entities[id as usize] = Entity::PLACEHOLDER;
        self.reporting.remove(id);
        self.tracking.remove(id);
        self.filtering.remove(id);
        self.modifying.remove(id);
        self.hitting.remove(id);
    }

    /// The id of an entity's collider.
    pub(crate) fn find(&self, entity: Entity) -> Option<u32> {
        let id = *self.by_entity.get(entity.index_u32() as usize)?;
        (self.entities.get(id as usize) == Some(&entity)).then_some(id)
    }

    /// The entity with an index, if it has a collider.
    pub(crate) fn find_index(&self, index: u32) -> Option<Entity> {
        let id = *self.by_entity.get(index as usize)?;
        self.entities.get(id as usize).copied().filter(|entity| entity.index_u32() == index)
    }
}

/// All contacts, and their colours.
#[derive(Resource, Clone, Default)]
pub(crate) struct Contacts {
    pub(crate) table: ContactTable,
    pub(crate) colors: ColorGraph,
    /// Contacts that got their first points or lost their last ones in this step's narrow phase.
    pub(crate) changed: BitSet,
    /// Contacts with points that do not touch yet: their colliders approach or pass each other.
    pub(crate) nearing: BitSet,
    /// Whether the narrow phase of this step has begun and its impulses are not known yet. Until then, all
    /// contacts with points count as touching.
    pub(crate) is_before_solver: bool,
    /// Contacts that began to touch in this step, after the solver.
    pub(crate) met: BitSet,
    /// Contacts that stopped touching in this step's narrow phase.
    pub(crate) parted: BitSet,
    /// Collisions to be sent.
    pub(crate) reports: Reports,
    /// Fast contacts, and blows to be sent.
    pub(crate) hits: Hits,
}

impl Contacts {
    /// Whether the colliders of a contact touch.
    pub(crate) fn touches(&self, id: u32) -> bool {
        self.table.get(id).flags.has(ContactFlags::TOUCHING)
            && (self.is_before_solver || !self.nearing.contains(id))
    }

    /// Whether the colliders of a contact began to touch in this step.
    pub(crate) fn started(&self, id: u32) -> bool {
        let set = if self.is_before_solver { &self.changed } else { &self.met };
        set.contains(id) && self.touches(id)
    }
}

/// The islands. Absent without the island plugin, in which case no body sleeps.
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
    pub(crate) fn contact_manager(&mut self) -> ContactManager<'_> {
        self.contact_manager_and_reporter().0
    }

    /// The contact manager, and the reporter of collisions that begin and end.
    pub(crate) fn contact_manager_and_reporter(&mut self) -> (ContactManager<'_>, Reporter<'_>) {
        let Contacts { table: contacts, colors, reports, nearing, .. } = &mut *self.contacts;
        let Colliders { table: colliders, entities, reporting, tracking, .. } = &mut *self.colliders;
        let Bodies { table: bodies, entities: body_entities, .. } = &mut *self.bodies;
        let islands = self.islands.as_mut().map(|i| &mut i.0);
        let reporter =
            Reporter { bodies: body_entities, colliders: entities, reporting, tracking, reports, nearing };
        (ContactManager { bodies, colliders, contacts, colors, islands }, reporter)
    }

    /// Removes the contacts of a collider for which `is_gone` is true, and records the collisions that end.
    pub(crate) fn end_contacts(
        &mut self,
        collider: u32,
        is_gone: impl Fn(&ContactManager, &Contact) -> bool,
    ) {
        let (mut manager, mut reporter) = self.contact_manager_and_reporter();
        let all = manager.contacts.of_collider(collider, manager.colliders);
        let mut gone: Vec<u32> = all.filter(|id| is_gone(&manager, manager.contacts.get(*id))).collect();
        gone.sort_unstable();
        for id in gone {
            let contact = manager.contacts.get(id);
            if contact.flags.has(ContactFlags::TOUCHING) {
                reporter.note_points(id, contact, Status::Ended);
            }
            manager.destroy(id);
        }
    }
}

impl Tables<'_> {
    /// Disables collisions between two bodies, until [`let_collide`](Self::let_collide) is called as often.
    pub(crate) fn keep_apart(&mut self, [a, b]: [u32; 2]) {
        let count = self.bodies.apart.get(a, b).unwrap_or(0);
        self.bodies.apart.insert(a, b, count + 1);
        if count == 0 {
            for collider in self.movable_colliders([a, b]) {
                self.end_contacts(collider, |_, contact| {
                    [a, b].iter().all(|body| contact.bodies.contains(body))
                });
            }
        }
    }

    /// Enables collisions between two bodies again.
    pub(crate) fn let_collide(&mut self, [a, b]: [u32; 2]) {
        match self.bodies.apart.remove(a, b) {
            None | Some(0 | 1) => {
                // Pairs are found as for colliders that moved.
                for collider in self.movable_colliders([a, b]) {
                    self.colliders.moved.insert(collider);
                }
            }
            Some(count) => _ = self.bodies.apart.insert(a, b, count - 1),
        }
    }

    /// The colliders of one of two bodies, preferably of a body that is not static. Every contact of the two
    /// bodies has one of these colliders.
    fn movable_colliders(&self, [a, b]: [u32; 2]) -> Vec<u32> {
        let bodies = &self.bodies.table;
        let body = if bodies[a].kind == BodyKind::Static { b } else { a };
        self.colliders.table.of_body(body, bodies).collect()
    }
}

/// Records collisions of colliders that report or track them.
pub(crate) struct Reporter<'a> {
    bodies: &'a [Entity],
    colliders: &'a [Entity],
    reporting: &'a BitSet,
    tracking: &'a BitSet,
    reports: &'a mut Reports,
    nearing: &'a mut BitSet,
}

impl Reporter<'_> {
    /// Records that a contact got its first points, or lost its last points. Returns whether its colliders
    /// stopped touching.
    pub(crate) fn note_points(&mut self, id: u32, contact: &Contact, status: Status) -> bool {
        match status {
            Status::Began => _ = self.nearing.insert(id),
            Status::Ended if self.nearing.remove(id) => {}
            Status::Ended => {
                self.note(contact, status);
                return true;
            }
        }
        false
    }

    /// Records that a contact began or ended.
    #[inline]
    pub(crate) fn note(&mut self, contact: &Contact, status: Status) {
        let is_sent = contact.colliders.iter().any(|id| self.reporting.contains(*id));
        if !is_sent && !contact.colliders.iter().any(|id| self.tracking.contains(*id)) {
            return;
        }
        let colliders = contact.colliders.map(|id| self.colliders[id as usize]);
        let bodies = contact.bodies.map(|id| (id != NONE).then(|| self.bodies[id as usize]));
        for (id, entity) in contact.colliders.into_iter().zip(colliders) {
            if self.tracking.contains(id) {
                self.reports.trackers.insert(entity);
            }
        }
        let report = Report { colliders, bodies, is_sent };
        match status {
            Status::Began => self.reports.started.push(report),
            Status::Ended => self.reports.ended.push(report),
        }
    }

    /// Drops collisions that ended and began again in this step.
    pub(crate) fn drop_resumed(&mut self) {
        self.reports.drop_resumed();
    }
}

/// Whether two colliders of different bodies may form a contact: both are active, their layers interact, and
/// one of them belongs to a dynamic or kinematic body. Of two colliders without a body one must be a sensor.
pub(crate) fn may_collide(bodies: &BodyTable, colliders: &ColliderTable, pair: [u32; 2]) -> bool {
    let [a, b] = pair.map(|id| &colliders[id].def);
    let moves = |body: u32| body != NONE && bodies[body].kind != BodyKind::Static;
    let detects = [a.body, b.body] == [NONE; 2] && (a.flags.sensor || b.flags.sensor);
    let active = !(a.flags.inactive || b.flags.inactive);
    active && (moves(a.body) || moves(b.body) || detects) && a.layers.interacts_with(b.layers)
}

/// Whether looking up the wanted entities is cheaper than iterating over the queries: they are less than a
/// quarter of all entities. `all` are the size hints of the queries.
pub(crate) fn is_minority<const N: usize>(wanted: usize, all: [(usize, Option<usize>); N]) -> bool {
    4 * wanted < all.iter().map(|hint| hint.1.unwrap_or(0)).sum()
}
