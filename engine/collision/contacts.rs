//! The narrow phase's systems: manifolds of awake contacts, then the effects of contacts that began or ended.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_time::Time;
use kernel::{
    contact::{ManifoldSource, NarrowPhaseInput, WorkerBuffers},
    manifold::LocalManifold,
    math::{Pose, Vector},
};

use crate::{
    collision::{
        collider::{Collider, Workspace, foreign_ball_manifolds, foreign_manifolds},
        diagnostics::CollisionDiagnostics,
        narrow_phase::NarrowPhaseConfig,
    },
    dynamics::{
        solver::{
            RowWidth, WorkerCount,
            config::{LINEAR_SLOP, PhysicsLengthUnit},
        },
        tables::Tables,
    },
    math::to_f32,
    schedule::Physics,
    threads::Threads,
};

/// Prediction distance of contacts at rest, times the length unit. With less, stacks lose contact points. With more,
/// contacts that never touch are computed.
const SPECULATIVE: f32 = (4.0 * LINEAR_SLOP) as f32;
/// Maximum relative motion of two surfaces for which a manifold is recycled, times the length unit. With more, contacts
/// lag behind rolling bodies. With less, stacks jitter and steps take longer.
const RECYCLE: f32 = (10.0 * LINEAR_SLOP) as f32;

/// Buffers of the narrow phase.
#[derive(Resource, Default)]
pub(crate) struct NarrowPhaseBuffers(Vec<WorkerBuffers<Workspace>>);

/// Manifolds of shapes that the kernel does not have, by parry.
pub(crate) struct Foreign<'a, 'w, 's, 'c> {
    pub(crate) colliders: &'a Query<'w, 's, &'c Collider>,
    /// The entity of each collider.
    pub(crate) entities: &'a [Entity],
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

/// Settings of the narrow phase.
#[derive(SystemParam)]
pub(crate) struct Settings<'w> {
    config: Res<'w, NarrowPhaseConfig>,
    unit: Res<'w, PhysicsLengthUnit>,
    time: Res<'w, Time<Physics>>,
    workers: Res<'w, WorkerCount>,
    width: Res<'w, RowWidth>,
}

/// Updates the manifolds of all awake contacts.
pub(crate) fn update_contacts(
    shapes: Query<&Collider>,
    Settings { config, unit, time, workers, width }: Settings,
    mut threads: ResMut<Threads>,
    mut buffers: ResMut<NarrowPhaseBuffers>,
    mut diagnostics: ResMut<CollisionDiagnostics>,
    mut tables: Tables,
) {
    let start = bevy_platform::time::Instant::now();
    let unit = unit.metres();
    let colliders = &tables.colliders;
    let source = Foreign { colliders: &shapes, entities: &colliders.entities };
    let input = NarrowPhaseInput {
        bodies: &tables.bodies.table,
        colliders: &colliders.table,
        source: &source,
        dt: time.delta_secs(),
        tolerance: to_f32(config.contact_tolerance).max(0.0) * unit,
        speculative: SPECULATIVE * unit,
        recycle_distance: RECYCLE * unit,
        match_points: config.match_contacts,
        narrow: *width == RowWidth::Four,
    };
    let contacts = &mut *tables.contacts;
    contacts.changed.clear();
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
