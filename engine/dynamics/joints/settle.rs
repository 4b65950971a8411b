//! Adds, changes and removes joints in the kernel to match their components.

use bevy_ecs::{entity_disabling::Disabled, prelude::*, system::SystemParam};
use bevy_log::warn;
use kernel::table::NONE;

use super::{
    JointCollisionDisabled, JointDamping, JointDisabled,
    dim::{AnyJoint, IsJoint},
    kind::{JointMut, definition},
    table::{Complaint, Held, JointTables},
};
use crate::{
    dynamics::{ids::BodyId, rigid_body::RigidBody, tables::Tables},
    physics_transform::{Position, Rotation},
};

/// Components of a joint.
type JointState =
    (AnyJoint, Option<&'static JointDamping>, Has<JointCollisionDisabled>, Has<JointDisabled>, Has<Disabled>);

/// Components of a joint's bodies.
type BodyState = (&'static BodyId, &'static Position, &'static Rotation);

/// Id and pose of a body.
type Found<'a> = (&'a BodyId, &'a Position, &'a Rotation);

/// Queries of joints and their bodies.
#[derive(SystemParam)]
pub(crate) struct JointCensus<'w, 's> {
    joints: Query<'w, 's, JointState, (IsJoint, Allow<Disabled>)>,
    bodies: Query<'w, 's, BodyState, (With<RigidBody>, Allow<Disabled>)>,
}

/// Adds, changes or removes all joints that may have changed. Ids follow the order in which the joints were
/// noted.
pub(crate) fn settle_joints(mut own: JointTables, mut tables: Tables, mut census: JointCensus) {
    for joint in core::mem::take(&mut own.joints.gone) {
        own.remove(joint, &mut tables);
    }
    let mut noted = core::mem::take(&mut own.joints.noted);
    for (joint, ()) in noted.drain() {
        census.settle(joint, &mut own, &mut tables);
    }
    own.joints.noted = noted;
}

/// Why a joint cannot act, with a message for the app.
type Refusal = (Complaint, String);

impl JointCensus<'_, '_> {
    fn settle(&mut self, entity: Entity, own: &mut JointTables, tables: &mut Tables) {
        let Self { joints, bodies } = self;
        let Ok((mut any, damping, is_apart, false, false)) = joints.get_mut(entity) else {
            return own.remove(entity, tables);
        };
        let Some(joint) = any.joint() else { return own.remove(entity, tables) };
        let ends = joint.bodies();
        if own.joints.get(entity).is_some_and(|record| record.bodies != ends) {
            own.remove(entity, tables);
        }
        own.joints.enlist(entity, ends);
        let held = match find(ends, bodies) {
            Ok(Some(found)) => hold(entity, joint, found, damping, own, tables),
            // The joint waits for a body.
            Ok(None) => return own.release(entity, tables),
            Err(refusal) => Err(refusal),
        };
        let complaint = match &held {
            Ok(()) => None,
            Err((complaint, _)) => Some(*complaint),
        };
        let is_new = own.joints.set_complaint(entity, complaint);
        match held {
            Ok(()) => keep_apart(entity, is_apart, own, tables),
            Err((_, why)) => {
                own.release(entity, tables);
                if is_new {
                    warn!("the joint {entity} has no effect: {why}");
                }
            }
        }
    }
}

/// The bodies of a joint. `None` while a body is not in the simulation.
fn find<'a>(
    ends: [Entity; 2],
    bodies: &'a Query<BodyState, (With<RigidBody>, Allow<Disabled>)>,
) -> Result<Option<[Found<'a>; 2]>, Refusal> {
    let [a, b] = ends;
    if a == b {
        return Err((Complaint::SameBody, format!("both its bodies are {a}")));
    }
    let get = |end: Entity| {
        let none = |_| (Complaint::NoBody(end), format!("{end} is no `RigidBody` yet, or no more"));
        bodies.get(end).map_err(none)
    };
    let found = [get(a)?, get(b)?];
    let is_there = found.iter().all(|(id, ..)| id.0 != NONE);
    Ok(is_there.then_some(found))
}

/// Makes the frames of a joint local.
fn localize(joint: &mut dyn JointMut, [a, b]: [Found; 2]) {
    let [frame1, frame2] = joint.kind().frames();
    if !(frame1.is_local() && frame2.is_local()) {
        joint.set_frames([frame1.localized(a.1.0, *a.2), frame2.localized(b.1.0, *b.2)]);
    }
}

/// Adds a joint to the kernel, or changes it.
fn hold(
    entity: Entity,
    joint: &mut dyn JointMut,
    found: [Found; 2],
    damping: Option<&JointDamping>,
    own: &mut JointTables,
    tables: &mut Tables,
) -> Result<(), Refusal> {
    localize(joint, found);
    let bodies = found.map(|(id, ..)| id.0);
    let kind = joint.kind();
    let coupling = kind.coupling();
    let held = own.joints.get(entity).and_then(|record| record.held).filter(|held| held.bodies == bodies);
    // The coordinates of a coupling count from the pose where it starts, so a changed coupling starts anew.
    let held = held.filter(|held| held.coupling == coupling);
    if held.is_none() {
        own.release(entity, tables);
    }
    let table = &mut own.solver.kernel.joints;
    let result = match (coupling, held) {
        (Some(_), Some(held)) => Ok(held.id),
        (Some(coupling), None) => {
            let poses = found.map(|(_, position, rotation)| (position.0, *rotation));
            table.add_coupling(&mut tables.contact_manager(), coupling.definition(bodies, poses))
        }
        (None, held) => {
            let Some(def) = definition(kind, bodies, damping) else { return Ok(()) };
            match held {
                Some(held) => table.set(&mut tables.contact_manager(), held.id, def).map(|()| held.id),
                None => table.add(&mut tables.contact_manager(), def),
            }
        }
    };
    let id = result.map_err(|error| (Complaint::Number, error.to_string()))?;
    let is_apart = held.is_some_and(|held| held.is_apart);
    own.joints.set_held(entity, Held { id, bodies, motor: kind.motor(), coupling, is_apart });
    Ok(())
}

/// Disables or enables collisions between the bodies of a joint.
fn keep_apart(entity: Entity, is_apart: bool, own: &mut JointTables, tables: &mut Tables) {
    let Some(held) = own.joints.get(entity).and_then(|record| record.held) else { return };
    if held.is_apart == is_apart {
        return;
    }
    own.joints.set_held(entity, Held { is_apart, ..held });
    if is_apart {
        tables.keep_apart(held.bodies);
    } else {
        tables.let_collide(held.bodies);
    }
}
