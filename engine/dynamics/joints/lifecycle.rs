//! Notes which joints may have to enter, leave or change.
//!
//! ```text
//!   joint      waiting ──both bodies are there──▶ held ──one leaves, or is another──▶ waiting
//!   known      with a joint's component, and neither JointDisabled nor Disabled
//! ```

use bevy_app::App;
use bevy_ecs::{component::Mutable, entity_disabling::Disabled, prelude::*, system::SystemChangeTick};

use super::{
    JointCollisionDisabled, JointDamping, JointDisabled,
    changes::each_changed,
    dim::{ChangedJoints, IsJoint, each_kind},
    kind::{EntityConstraint, JointKind, KindVisitor},
    table::Joints,
};
use crate::scan::Since;

/// Adds the observers, and notes joints that were spawned before.
pub(crate) fn watch(app: &mut App) {
    each_kind(&mut Watch { app });
    note_setting::<JointDisabled>(app);
    note_setting::<JointCollisionDisabled>(app);
    note_setting::<JointDamping>(app);
    note_setting::<Disabled>(app);
    let world = app.world_mut();
    let joints: Vec<Entity> = world.query_filtered::<Entity, IsJoint>().iter(world).collect();
    let mut known = world.resource_mut::<Joints>();
    known.noted.extend(joints);
    #[cfg(feature = "validate")]
    {
        known.is_watched = true;
    }
}

/// Observes each kind of joint.
struct Watch<'a> {
    app: &'a mut App,
}

impl KindVisitor for Watch<'_> {
    fn visit<J: JointKind + EntityConstraint<2> + Component<Mutability = Mutable>>(&mut self) {
        self.app
            .add_observer(|on: On<Insert, J>, mut joints: ResMut<Joints>| joints.note(on.entity))
            .add_observer(|on: On<Remove, J>, mut joints: ResMut<Joints>| joints.note(on.entity));
    }
}

/// Observes a component beside joints.
fn note_setting<C: Component>(app: &mut App) {
    app.add_observer(|on: On<Insert, C>, known: Query<(), IsKnown>, joints: ResMut<Joints>| {
        note_known(on.entity, &known, joints);
    })
    .add_observer(|on: On<Remove, C>, known: Query<(), IsKnown>, joints: ResMut<Joints>| {
        note_known(on.entity, &known, joints);
    });
}

/// The filter for entities with a joint, disabled or not.
type IsKnown = (IsJoint, Allow<Disabled>);

fn note_known(entity: Entity, known: &Query<(), IsKnown>, mut joints: ResMut<Joints>) {
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
