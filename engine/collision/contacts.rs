//! The narrow phase's systems: manifolds of awake contacts, then the effects of contacts that began or ended.

use bevy_ecs::prelude::*;
use kernel::{
    contact::{ManifoldSource, WorkerBuffers},
    manifold::LocalManifold,
    math::{Pose, Vector},
};

use crate::{
    collision::{
        collider::{Collider, Workspace, foreign_ball_manifolds, foreign_manifolds},
        contact_types::views::ContactViews,
        custom_contacts::CustomContacts,
        diagnostics::CollisionDiagnostics,
        narrow_phase::input::Settings,
    },
    dynamics::tables::Tables,
    threads::Threads,
};

/// Buffers of the narrow phase.
#[derive(Resource, Default)]
pub(crate) struct NarrowPhaseBuffers(Vec<WorkerBuffers<Workspace>>);

/// Manifolds of shapes that the kernel does not have: by parry, or those of collider types of the app.
pub(crate) struct Foreign<'a, 'w, 's, 'c> {
    pub(crate) colliders: &'a Query<'w, 's, &'c Collider>,
    /// The entity of each collider.
    pub(crate) entities: &'a [Entity],
    pub(crate) custom: &'a CustomContacts,
}

impl ManifoldSource for Foreign<'_, '_, '_, '_> {
    type Workspace = Workspace;

    fn manifolds(
        &self,
        colliders: [u32; 2],
        pose: &Pose,
        prediction: f32,
        workspace: &mut Workspace,
        out: &mut Vec<LocalManifold>,
    ) {
        if let Ok([a, b]) = self.colliders.get_many(colliders.map(|id| self.entities[id as usize])) {
            foreign_manifolds(a, b, pose, prediction, workspace, out);
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
        workspace: &mut Workspace,
        out: &mut Vec<LocalManifold>,
    ) {
        if let Ok(collider) = self.colliders.get(self.entities[collider as usize]) {
            foreign_ball_manifolds(collider, center, radius, prediction, workspace, out);
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
    let listeners = [&colliders.reporting, &colliders.tracking, &colliders.modifying];
    contacts.table.sum_impulses = views.has_readers() || listeners.iter().any(|set| !set.is_empty());
    let workers = &settings.workers;
    threads.wake(contacts.table.active_len(), workers.0, || workers.resolve());
    contacts.table.update(&input, &threads.pool, &mut buffers.0, &mut contacts.changed);
    diagnostics.contact_count = contacts.table.len() as u32;
    diagnostics.narrow_phase += start.elapsed();
}

/// Applies the effects of contacts that began or ended: colours, islands, waking.
pub(crate) fn link_contacts(mut tables: Tables) {
    let changed = core::mem::take(&mut tables.contacts.changed);
    let (mut link, mut reporter) = tables.link_and_reporter();
    link.apply(&changed, |_, contact, status| reporter.note(contact, status));
    reporter.drop_resumed();
    tables.contacts.changed = changed;
    if cfg!(feature = "validate") {
        tables.link().validate();
    }
}
