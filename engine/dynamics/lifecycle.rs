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
use kernel::table::NONE;

use crate::{
    collision::collider::{
        Collider, ColliderDisabled, CollisionLayers, Sensor, collider_hierarchy::ColliderOf,
        collider_transform::ColliderTransform,
    },
    dynamics::{
        ids::{BodyId, ColliderId},
        rigid_body::{
            AngularVelocity, LinearVelocity, RigidBody, RigidBodyDisabled,
            mass_properties::components::{ComputedAngularInertia, ComputedCenterOfMass, ComputedMass},
        },
        tables::Colliders,
    },
    physics_transform::{Position, Rotation},
};

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

/// Without any of these a body cannot be simulated. They come with it, but may be taken away.
pub(crate) type BodyEssentials = (
    Position,
    Rotation,
    LinearVelocity,
    AngularVelocity,
    ComputedMass,
    ComputedAngularInertia,
    ComputedCenterOfMass,
);

/// The filter for bodies that have them.
pub(crate) type IsComplete = (
    With<Position>,
    With<Rotation>,
    With<LinearVelocity>,
    With<AngularVelocity>,
    With<ComputedMass>,
    With<ComputedAngularInertia>,
    With<ComputedCenterOfMass>,
);

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
    app.add_observer(|on: On<Add, BodyEssentials>, mut queue: ResMut<LifecycleQueue>| {
        queue.bodies.push(on.entity);
        queue.colliders.push(on.entity);
    })
    .add_observer(|on: On<Remove, BodyEssentials>, mut queue: ResMut<LifecycleQueue>| {
        queue.bodies.push(on.entity);
        queue.colliders.push(on.entity);
    });
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

/// What a collider is, and where it is on its body.
type ColliderChanged = Or<(Changed<Collider>, Changed<ColliderTransform>)>;

/// Notes colliders that were changed in place, and moved ones that no body takes along.
pub(crate) fn note_changed_colliders(
    changed: Query<Entity, (With<ColliderId>, ColliderChanged)>,
    moved: Query<(Entity, &ColliderId), Or<(Changed<Position>, Changed<Rotation>)>>,
    colliders: Res<Colliders>,
    mut queue: ResMut<LifecycleQueue>,
) {
    queue.colliders.extend(&changed);
    let stands_alone = |id: u32| id != NONE && colliders.table[id].def.body == NONE;
    queue.colliders.extend(moved.iter().filter(|(_, id)| stands_alone(id.0)).map(|(entity, _)| entity));
}

fn lose_body(
    on: On<Remove, BodyId>,
    ids: Query<&BodyId, Allow<Disabled>>,
    mut queue: ResMut<LifecycleQueue>,
) {
    if let Ok(BodyId(id)) = ids.get(on.entity)
        && *id != NONE
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
        && *id != NONE
    {
        queue.lost_colliders.push(*id);
    }
}
