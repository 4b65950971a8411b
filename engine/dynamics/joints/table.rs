//! All joints of the app, with their ids in the kernel.

use bevy_ecs::{
    entity::{EntityHashMap, EntityIndexSet},
    prelude::*,
    system::SystemParam,
};

use super::{breaking::JointBroken, coupling::Coupling};
use crate::{
    dynamics::{solver::substeps::StepSolver, tables::Tables},
    noted::Noted,
};

/// All joints that are neither disabled nor despawned, by entity, and the joints that may have changed since
/// the last step.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Joints {
    /// Entities whose joint may have to enter, leave or change.
    pub(crate) noted: Noted,
    /// Known joints that were despawned and lost their place in the queue to another entity.
    pub(crate) gone: Vec<Entity>,
    /// Joints that broke in this step.
    pub(crate) broken: Vec<JointBroken>,
    /// Whether joints are watched. Without their plugin they have no effect.
    #[cfg(feature = "validate")]
    pub(crate) is_watched: bool,
    records: EntityHashMap<Record>,
    /// The joints of each entity that is named as a body.
    of_body: EntityHashMap<EntityIndexSet>,
}

/// A joint of the app.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub(crate) bodies: [Entity; 2],
    /// The joint in the kernel, while both bodies are in the simulation and the joint is valid.
    pub(crate) held: Option<Held>,
    /// Why the joint cannot act, as reported to the app.
    pub(crate) told: Option<Complaint>,
}

/// A joint in the kernel.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Held {
    pub(crate) id: u32,
    /// Ids of the bodies.
    pub(crate) bodies: [u32; 2],
    /// The coordinate that the joint's motor drives.
    pub(crate) motor: Option<usize>,
    /// The settings, if the joint is a coupling.
    pub(crate) coupling: Option<Coupling>,
    /// Whether the joint disables collisions between its bodies.
    pub(crate) is_apart: bool,
}

/// Why a joint has no effect. The app gets one warning for each reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Complaint {
    /// Both bodies are the same.
    SameBody,
    /// An entity is not a body.
    NoBody(Entity),
    /// A number is not finite, or limits are in the wrong order.
    Number,
}

impl Joints {
    /// Queues an entity.
    pub(crate) fn note(&mut self, entity: Entity) {
        if let Some(gone) = self.noted.note(entity)
            && self.records.contains_key(&gone)
        {
            self.gone.push(gone);
        }
    }

    /// Queues the joints that name an entity as a body.
    pub(crate) fn note_of_body(&mut self, body: Entity) {
        if let Some(joints) = self.of_body.get(&body) {
            self.noted.extend(joints.iter().copied());
        }
    }

    /// The joint of an entity.
    pub(crate) fn get(&self, joint: Entity) -> Option<&Record> {
        self.records.get(&joint)
    }

    /// All joints that are known.
    #[cfg(feature = "validate")]
    pub(crate) fn iter(&self) -> impl Iterator<Item = (Entity, &Record)> {
        self.records.iter().map(|(entity, record)| (*entity, record))
    }

    /// Whether a joint is queued.
    #[cfg(feature = "validate")]
    pub(crate) fn is_queued(&self, joint: Entity) -> bool {
        self.noted.contains(joint) || self.gone.contains(&joint)
    }

    /// Adds the joint of an entity. A joint that is already known must have these bodies.
    pub(crate) fn enlist(&mut self, joint: Entity, bodies: [Entity; 2]) {
        self.records.entry(joint).or_insert(Record { bodies, held: None, told: None });
        for body in bodies {
            self.of_body.entry(body).or_default().insert(joint);
        }
    }

    /// Stores why a known joint cannot act. Returns whether the reason is new.
    pub(crate) fn set_complaint(&mut self, joint: Entity, complaint: Option<Complaint>) -> bool {
        let record = self.records.get_mut(&joint);
        record.is_some_and(|record| core::mem::replace(&mut record.told, complaint) != complaint)
    }

    /// Stores the kernel's joint of a known entity.
    pub(crate) fn set_held(&mut self, joint: Entity, held: Held) {
        if let Some(record) = self.records.get_mut(&joint) {
            record.held = Some(held);
        }
    }

    /// Forgets a joint that is no longer in the kernel.
    fn delist(&mut self, joint: Entity) {
        let Some(record) = self.records.remove(&joint) else { return };
        for body in record.bodies {
            if let Some(joints) = self.of_body.get_mut(&body) {
                joints.swap_remove(&joint);
                if joints.is_empty() {
                    self.of_body.remove(&body);
                }
            }
        }
    }
}

/// The tables of joints, of the engine and of the kernel.
#[derive(SystemParam)]
pub(crate) struct JointTables<'w> {
    pub(crate) joints: ResMut<'w, Joints>,
    pub(crate) solver: ResMut<'w, StepSolver>,
}

impl JointTables<'_> {
    /// Removes a joint from the kernel.
    pub(crate) fn release(&mut self, joint: Entity, tables: &mut Tables) {
        let Some(record) = self.joints.records.get_mut(&joint) else { return };
        let Some(held) = record.held.take() else { return };
        if held.is_apart {
            tables.let_collide(held.bodies);
        }
        let removed = self.solver.kernel.joints.remove(&mut tables.contact_manager(), held.id);
        debug_assert!(removed.is_ok(), "{joint} has a joint in the kernel: {removed:?}");
    }

    /// Removes a joint of the app.
    pub(crate) fn remove(&mut self, joint: Entity, tables: &mut Tables) {
        self.release(joint, tables);
        self.joints.delist(joint);
    }

    /// Removes the joints of a body from the kernel, before the body leaves. They return with the body.
    pub(crate) fn release_of_body(&mut self, body: Entity, tables: &mut Tables) {
        let Some(joints) = self.joints.of_body.get(&body) else { return };
        for joint in joints.iter().copied().collect::<Vec<_>>() {
            self.release(joint, tables);
        }
        self.joints.note_of_body(body);
    }
}
