//! The one door through which bodies and colliders enter and leave the simulation.
//!
//! Observers only note *which* entities may have changed, and which ids lost their component. Once per
//! step the queue is drained: for each noted entity what it is now is compared with what the tables hold,
//! and the difference applied. That makes the order of changes irrelevant, and changes that cancel out free.
//!
//! ```text
//!   body       absent ──enters──▶ awake ⇄ asleep ──leaves──▶ absent        (static: neither awake nor asleep)
//!   collider   absent ──enters──▶ in its body's tree ──leaves──▶ absent
//!   enters     RigidBody (Collider) is there, and neither Disabled nor, for colliders, ColliderDisabled
//!   leaves     despawned, component removed, disabled
//!   retyped    RigidBody is another value: contacts stay, colours, islands and tree change
//!   rebodied   ColliderOf names another body, or that body entered, left or is RigidBodyDisabled: leaves, enters
//! ```

use bevy_app::App;
use bevy_ecs::{entity_disabling::Disabled, prelude::*};
use bevy_reflect::Reflect;

use crate::{
    collision::collider::{
        Collider, ColliderDisabled, CollisionLayers, Sensor, collider_hierarchy::ColliderOf,
    },
    dynamics::rigid_body::{RigidBody, RigidBodyDisabled},
};

/// A body's number in the tables; `u32::MAX` while it takes no part in the simulation.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[component(clone_behavior = Ignore)]
#[reflect(Component, Debug, PartialEq)]
pub struct BodyId(pub(crate) u32);

/// A collider's number in the tables; `u32::MAX` while it takes no part in the simulation.
#[derive(Component, Reflect, Clone, Copy, Debug, PartialEq, Eq)]
#[component(clone_behavior = Ignore)]
#[reflect(Component, Debug, PartialEq)]
pub struct ColliderId(pub(crate) u32);

impl Default for BodyId {
    fn default() -> Self {
        Self(kernel::table::NONE)
    }
}

impl Default for ColliderId {
    fn default() -> Self {
        Self(kernel::table::NONE)
    }
}

/// What may have changed since the last step.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct LifecycleQueue {
    /// Entities whose body may enter, leave, be retyped.
    pub(crate) bodies: Vec<Entity>,
    /// Entities whose collider may enter, leave, be redefined.
    pub(crate) colliders: Vec<Entity>,
    /// Ids whose component went with its entity.
    pub(crate) lost_bodies: Vec<u32>,
    /// Ids whose component went with its entity.
    pub(crate) lost_colliders: Vec<u32>,
}

/// Registers the observers, and notes what was spawned before them.
pub(crate) fn watch(app: &mut App) {
    if app.world().contains_resource::<LifecycleQueue>() {
        return;
    }
    app.init_resource::<LifecycleQueue>();
    note_body::<RigidBody>(app);
    note_body::<RigidBodyDisabled>(app);
    note_body::<Disabled>(app);
    note_collider::<Collider>(app);
    note_collider::<ColliderOf>(app);
    note_collider::<ColliderDisabled>(app);
    note_collider::<CollisionLayers>(app);
    note_collider::<Sensor>(app);
    note_collider::<Disabled>(app);
    app.add_observer(lose_body).add_observer(lose_collider);

    let world = app.world_mut();
    let mut bodies = world.query_filtered::<Entity, With<RigidBody>>();
    let mut colliders = world.query_filtered::<Entity, With<Collider>>();
    let (bodies, colliders) = (bodies.iter(world).collect(), colliders.iter(world).collect());
    let mut queue = world.resource_mut::<LifecycleQueue>();
    queue.bodies = bodies;
    queue.colliders = colliders;
}

fn note_body<C: Component>(app: &mut App) {
    app.add_observer(|on: On<Insert, C>, mut queue: ResMut<LifecycleQueue>| queue.bodies.push(on.entity))
        .add_observer(|on: On<Remove, C>, mut queue: ResMut<LifecycleQueue>| queue.bodies.push(on.entity));
}

fn note_collider<C: Component>(app: &mut App) {
    app.add_observer(|on: On<Insert, C>, mut queue: ResMut<LifecycleQueue>| queue.colliders.push(on.entity))
        .add_observer(|on: On<Remove, C>, mut queue: ResMut<LifecycleQueue>| {
            queue.colliders.push(on.entity);
        });
}

fn lose_body(
    on: On<Remove, BodyId>,
    ids: Query<&BodyId, Allow<Disabled>>,
    mut queue: ResMut<LifecycleQueue>,
) {
    if let Ok(BodyId(id)) = ids.get(on.entity)
        && *id != kernel::table::NONE
    {
        queue.lost_bodies.push(*id);
    }
}

fn lose_collider(
    on: On<Remove, ColliderId>,
    ids: Query<&ColliderId, Allow<Disabled>>,
    mut queue: ResMut<LifecycleQueue>,
) {
    if let Ok(ColliderId(id)) = ids.get(on.entity)
        && *id != kernel::table::NONE
    {
        queue.lost_colliders.push(*id);
    }
}
