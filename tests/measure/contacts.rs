//! Contacts of separate pairs.

use super::pairs::{PREDICTION, Pair};
use crate::kernel;
use kernel::contact::{ContactManager, ContactTable, NarrowPhaseInput, WorkerBuffers};
use kernel::data::BitSet;
use kernel::graph::ColorGraph;
use kernel::math::{Pose, Vector, WorldPose};
use kernel::table::{BodyKind, BodyTable, ColliderDef, ColliderTable, Fattening};
use kernel::thread_pool::ThreadPool;

/// Bodies in pairs, and what updates their contacts.
pub struct Contacts {
    pub bodies: BodyTable,
    pub colliders: ColliderTable,
    pub contacts: ContactTable,
    pool: ThreadPool,
    buffers: Vec<WorkerBuffers>,
    changed: BitSet,
}

impl Contacts {
    /// Places each pair where no other is.
    pub fn of(pairs: &[Pair]) -> Self {
        let (mut bodies, mut colliders) = (BodyTable::default(), ColliderTable::default());
        let mut contacts = ContactTable::default();
        let mut colors = ColorGraph::new();
        for (i, pair) in pairs.iter().enumerate() {
            let at = Vector::X * (4.0 * (i % 256) as f32) + Vector::Y * (4.0 * (i / 256) as f32);
            let frame = WorldPose::new(at.to_world(), pair.poses[0].rotation);
            for (shape, pose) in pair.shapes.iter().zip([Pose::IDENTITY, pair.poses[0]]) {
                let place = frame.then(&pose);
                let center = shape.mass_properties(1.0).center;
                let body = bodies.add(BodyKind::Dynamic, center, place);
                let def = ColliderDef::new(shape.clone(), body);
                let id = colliders.add(def, place, &mut bodies);
                colliders.refresh(id, &bodies, Fattening { margin: 0.1, dt: 1.0 / 60.0 });
            }
            let mut manager = ContactManager {
                bodies: &mut bodies,
                colliders: &mut colliders,
                contacts: &mut contacts,
                colors: &mut colors,
                islands: None,
            };
            manager.create(2 * i as u32, 2 * i as u32 + 1);
        }
        let (pool, buffers) = (ThreadPool::default(), Vec::new());
        Self { bodies, colliders, contacts, pool, buffers, changed: BitSet::default() }
    }

    /// Moves every second body a little.
    pub fn nudge(&mut self) {
        for id in (1..self.bodies.poses.len()).step_by(2) {
            self.bodies.poses[id].center += (Vector::ONE * 0.0005).to_world();
            self.colliders.refresh(id as u32, &self.bodies, Fattening { margin: 0.1, dt: 1.0 / 60.0 });
        }
    }

    /// Updates all contacts, with recycling if `recycle`.
    pub fn update(&mut self, recycle: bool) {
        let input = NarrowPhaseInput {
            speculative: PREDICTION,
            recycle_distance: if recycle { 0.05 } else { 0.0 },
            ..NarrowPhaseInput::new(&self.bodies, &self.colliders, &(), 1.0 / 60.0)
        };
        self.changed.clear();
        self.contacts.update(&input, &self.pool, &mut self.buffers, &mut self.changed);
    }
}
