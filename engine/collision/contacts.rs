//! The narrow phase's systems: manifolds of awake contacts, then the effects of contacts that began or ended.

use bevy_ecs::prelude::*;
use bevy_time::Time;
use kernel::{
    contact::{ContactFlags, ManifoldSource, Status, WorkerBuffers},
    manifold::LocalManifold,
    math::{Pose, Vector},
};

use crate::{
    collision::{
        collider::{Collider, foreign_ball_manifolds, foreign_manifolds},
        contact_types::views::ContactViews,
        custom_contacts::CustomContacts,
        diagnostics::CollisionDiagnostics,
        narrow_phase::input::Settings,
        touch::{StepEnd, touching_gap},
    },
    dynamics::{
        solver::config::PhysicsLengthUnit,
        tables::{Contacts, Tables},
    },
    schedule::Physics,
    threads::Threads,
};

/// Buffers of the narrow phase.
#[derive(Resource, Default)]
pub(crate) struct NarrowPhaseBuffers(Vec<WorkerBuffers>);

/// Manifolds of shapes that the kernel does not support: by parry, or by a collider type of the app.
pub(crate) struct Foreign<'a, 'w, 's, 'c> {
    pub(crate) colliders: &'a Query<'w, 's, &'c Collider>,
    /// The entity of each collider.
    pub(crate) entities: &'a [Entity],
    pub(crate) custom: &'a CustomContacts,
}

impl ManifoldSource for Foreign<'_, '_, '_, '_> {
    fn manifolds(&self, colliders: [u32; 2], pose: &Pose, prediction: f32, out: &mut Vec<LocalManifold>) {
        if let Ok([a, b]) = self.colliders.get_many(colliders.map(|id| self.entities[id as usize])) {
            foreign_manifolds(a, b, pose, prediction, out);
        } else {
            self.custom.find(colliders, pose, out);
        }
    }

    fn ball_manifolds(
        &self,
        collider: u32,
        center: Vector,
        radius: f32,
        prediction: f32,
        out: &mut Vec<LocalManifold>,
    ) {
        if let Ok(collider) = self.colliders.get(self.entities[collider as usize]) {
            foreign_ball_manifolds(collider, center, radius, prediction, out);
        }
    }
}

/// Updates the manifolds of all awake contacts.
pub(crate) fn update_contacts(
    shapes: Query<&Collider>,
    settings: Settings,
    (custom, views): (Res<CustomContacts>, Res<ContactViews>),
    mut threads: ResMut<Threads>,
    mut buffers: ResMut<NarrowPhaseBuffers>,
    mut diagnostics: ResMut<CollisionDiagnostics>,
    mut tables: Tables,
) {
    let start = bevy_platform::time::Instant::now();
    let colliders = &tables.colliders;
    let source = Foreign { colliders: &shapes, entities: &colliders.entities, custom: &custom };
    let input = settings.input(&tables.bodies.table, &colliders.table, &source);
    let contacts = &mut *tables.contacts;
    contacts.changed.clear();
    contacts.is_before_solver = true;
    let listeners = [&colliders.reporting, &colliders.tracking, &colliders.modifying, &colliders.hitting];
    contacts.table.sum_impulses = views.has_readers() || listeners.iter().any(|set| !set.is_empty());
    let workers = &settings.workers;
    threads.wake(contacts.table.active_len(), workers.0, || workers.resolve());
    contacts.table.update(&input, &threads.pool, &mut buffers.0, &mut contacts.changed);
    diagnostics.contact_count = contacts.table.len() as u32;
    diagnostics.narrow_phase += start.elapsed();
}

/// Applies the effects of contacts that gained or lost points: colours, islands, waking.
pub(crate) fn link_contacts(mut tables: Tables) {
    let changed = core::mem::take(&mut tables.contacts.changed);
    let mut parted = core::mem::take(&mut tables.contacts.parted);
    let (mut manager, mut reporter) = tables.contact_manager_and_reporter();
    manager.apply(&changed, |id, contact, status| {
        if reporter.note_points(id, contact, status) {
            parted.insert(id);
        }
    });
    (tables.contacts.changed, tables.contacts.parted) = (changed, parted);
    if cfg!(feature = "validate") {
        tables.contact_manager().validate();
    }
}

/// Finds the contacts that started touching in this step, once their impulses are known.
pub(crate) fn note_touching(unit: Res<PhysicsLengthUnit>, time: Res<Time<Physics>>, mut tables: Tables) {
    tables.contacts.is_before_solver = false;
    let Tables { bodies, contacts, .. } = &mut tables;
    let Contacts { table, nearing, met, changed, .. } = &mut **contacts;
    let step =
        StepEnd { bodies: &bodies.table, contacts: table, gap: touching_gap(&unit), dt: time.delta_secs() };
    // Contacts of resting bodies are updated once.
    let is_updated = |id: u32| table.is_active(id) || changed.contains(id);
    for id in nearing.iter() {
        // Other contacts of the set were removed.
        let is_near = table.is_live(id) && table.get(id).flags.has(ContactFlags::TOUCHING);
        if !is_near || is_updated(id) && step.touches(id) {
            met.insert(id);
        }
    }
    let new: Vec<u32> = met.iter().collect();
    for id in new {
        tables.contacts.nearing.remove(id);
        if tables.contacts.table.is_live(id) {
            let (manager, mut reporter) = tables.contact_manager_and_reporter();
            let contact = manager.contacts.get(id);
            if contact.flags.has(ContactFlags::TOUCHING) {
                reporter.note(contact, Status::Began);
                continue;
            }
        }
        tables.contacts.met.remove(id);
    }
    tables.contact_manager_and_reporter().1.drop_resumed();
}
