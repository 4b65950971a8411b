//! Notes joints that may have to enter, leave or change.
//!
//! ```text
//!   joint      waiting ──both bodies are there──▶ held ──one leaves, or is another──▶ waiting
//!   known      with a joint's component, and neither JointDisabled nor Disabled
//! ```

use bevy_app::App;
use bevy_ecs::{entity_disabling::Disabled, prelude::*, system::SystemChangeTick};

use super::{
    JointCollisionDisabled, JointDamping, JointDisabled,
    changes::each_changed,
    dim::{ChangedJoints, IsJoint, Kinds},
    table::Joints,
};
use crate::scan::Since;

/// Adds the observers, and notes joints that were spawned before.
pub(crate) fn watch(app: &mut App) {
    app.add_observer(note_joint::<Insert>).add_observer(note_joint::<Remove>);
    app.add_observer(note_settings::<Insert>).add_observer(note_settings::<Remove>);
    let world = app.world_mut();
    let joints: Vec<Entity> = world.query_filtered::<Entity, IsJoint>().iter(world).collect();
    let mut known = world.resource_mut::<Joints>();
    known.noted.extend(joints);
    #[cfg(feature = "validate")]
    {
        known.is_watched = true;
    }
}

fn note_joint<E: EntityEvent>(on: On<E, Kinds>, mut joints: ResMut<Joints>) {
    joints.note(on.event_target());
}

/// Components that affect the joint on the same entity.
type Settings = (JointDisabled, JointCollisionDisabled, JointDamping, Disabled);

fn note_settings<E: EntityEvent>(
    on: On<E, Settings>,
    known: Query<(), (IsJoint, Allow<Disabled>)>,
    mut joints: ResMut<Joints>,
) {
    let entity = on.event_target();
    if known.contains(entity) {
        joints.note(entity);
    }
}

/// Notes joints that were mutated.
pub(crate) fn note_changed_joints(
    changed: ChangedJoints,
    damping: Query<(Entity, Ref<JointDamping>)>,
    mut joints: ResMut<Joints>,
    system: SystemChangeTick,
) {
    let since = Since::last_run(system);
    let mut note = |entity: Entity| joints.note(entity);
    changed.each(since, &mut note);
    each_changed(&damping, since, note);
}
