//! Collision events: [`CollisionStart`] and [`CollisionEnd`], as messages and for observers.
//!
//! A collider with [`CollisionEventsEnabled`] reports when it starts and stops touching another collider. The
//! component may be inserted and removed at any time; it takes effect in the next step.
//!
//! - A **message** is written once per pair, if either collider reports. Read it with a `MessageReader`.
//! - An **entity event** is triggered for each of the two colliders that reports, with that collider first.
//!   Observe it on the collider's entity.
//!
//! Events are sent at the end of a step, in
//! [`CollisionEventSystems`](super::narrow_phase::CollisionEventSystems): the messages, then the triggers,
//! all starts before all ends, in order of the engine's ids. The order is the same in every run and with any
//! number of threads. At this time impulses are known, and [`Collisions`](super::contact_types::Collisions)
//! has the contacts.
//!
//! A collision also ends if a collider is despawned or its component is removed. This end is sent at once,
//! even while physics is paused; within a step it is sent with the events of the step. The event may name an
//! entity that no longer exists; observers of the other collider run.
//!
//! A collision ends in the next step if a collider or its body is disabled, if the body is removed, or if
//! layers no longer allow the pair. The colliders of a disabled body touch nothing. The colliders of a
//! removed body become colliders without a body, and may start to touch others one step later. A body that
//! falls asleep ends no collision. A collider that moves to another body ends no collision with a collider
//! that it still touches.
//!
//! Colliders touch from the step in which their surfaces meet or push each other, until the surfaces are 2 cm
//! (times the length unit) apart. So an object that rattles on the ground ends no collision with the ground.
//! Sensors touch while they overlap.
//!
//! A pair is reported if one of its bodies is dynamic or kinematic. A pair of colliders without bodies is
//! reported if one is a [`Sensor`](super::collider::Sensor). Colliders of static bodies form no pairs with
//! each other or with colliders without a body, sensors or not: a trigger zone does not report the floor
//! below it.
//!
//! ```
//! # use avian::prelude::*;
//! # use bevy_ecs::prelude::*;
//! # #[derive(Component)]
//! # struct Player;
//! fn spawn_plate(mut commands: Commands) {
//!     commands
//!         .spawn((Sensor, Collider::capsule(1.0, 2.0), CollisionEventsEnabled))
//!         .observe(|event: On<CollisionStart>, players: Query<&Player>| {
//!             if players.contains(event.collider2) {
//!                 println!("pressed");
//!             }
//!         });
//! }
//!
//! fn print_all(mut started: MessageReader<CollisionStart>) {
//!     for event in started.read() {
//!         println!("{} touches {}", event.collider1, event.collider2);
//!     }
//! }
//! ```

use bevy_ecs::{entity::EntityHashSet, message::Messages, prelude::*};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::{
    collision::collider::CollidingEntities,
    dynamics::{
        reports::{Report, Reports},
        tables::{Colliders, Contacts},
    },
};

/// Two colliders started touching. The [module](self) lists the receivers and the time of sending.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CollisionStart {
    /// The first collider, on which observers run.
    #[event_target]
    pub collider1: Entity,
    /// The second collider.
    pub collider2: Entity,
    /// The body of the first collider, if it has one in the simulation.
    pub body1: Option<Entity>,
    /// The body of the second collider, if it has one in the simulation.
    pub body2: Option<Entity>,
}

/// Two colliders stopped touching. The [module](self) lists the receivers and the time of sending.
///
/// Entities may no longer exist: despawning a collider ends its collisions.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CollisionEnd {
    /// The first collider, on which observers run.
    #[event_target]
    pub collider1: Entity,
    /// The second collider.
    pub collider2: Entity,
    /// The body of the first collider when they touched, if it had one.
    pub body1: Option<Entity>,
    /// The body of the second collider when they touched, if it had one.
    pub body2: Option<Entity>,
}

/// The former name of [`CollisionStart`].
#[deprecated(since = "0.4.0", note = "renamed to `CollisionStart`")]
pub type OnCollisionStart = CollisionStart;

/// The former name of [`CollisionEnd`].
#[deprecated(since = "0.4.0", note = "renamed to `CollisionEnd`")]
pub type OnCollisionEnd = CollisionEnd;

/// Makes a collider report when it starts and stops touching other colliders, by [`CollisionStart`] and
/// [`CollisionEnd`].
///
/// To make all colliders report, call
/// `app.register_required_components::<Collider, CollisionEventsEnabled>()`.
#[derive(Component, Clone, Copy, Debug, Default, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default)]
pub struct CollisionEventsEnabled;

/// Makes one of the two events from a report, as seen from one of the colliders.
macro_rules! seen_from {
    ($event:ident, $report:expr, $side:expr) => {{
        let (report, one, other): (&Report, usize, usize) = ($report, $side, 1 - $side);
        $event {
            collider1: report.colliders[one],
            collider2: report.colliders[other],
            body1: report.bodies[one],
            body2: report.bodies[other],
        }
    }};
}

/// Whether events are being sent. Collisions that end because of their observers are reported afterwards.
#[derive(Resource, Default)]
pub(crate) struct IsSending(pub(crate) bool);

/// Sends the collisions that started and ended since the last call. Observers may despawn colliders, which
/// ends more collisions.
pub(crate) fn send_collision_events(world: &mut World) {
    if core::mem::replace(&mut world.resource_mut::<IsSending>().0, true) {
        return;
    }
    loop {
        let mut contacts = world.resource_mut::<Contacts>();
        let reports = core::mem::take(&mut contacts.bypass_change_detection().reports);
        if reports.started.is_empty() && reports.ended.is_empty() && reports.trackers.is_empty() {
            break;
        }
        send(world, reports);
    }
    world.resource_mut::<IsSending>().0 = false;
}

fn send(world: &mut World, Reports { started, ended, trackers }: Reports) {
    let sent = |reports: &[Report]| reports.iter().copied().filter(|r| r.is_sent).collect::<Vec<_>>();
    let (started, ended) = (sent(&started), sent(&ended));
    if let Some(mut messages) = world.get_resource_mut::<Messages<CollisionStart>>() {
        messages.write_batch(started.iter().map(|report| seen_from!(CollisionStart, report, 0)));
    }
    if let Some(mut messages) = world.get_resource_mut::<Messages<CollisionEnd>>() {
        messages.write_batch(ended.iter().map(|report| seen_from!(CollisionEnd, report, 0)));
    }
    update_trackers(world, trackers.into_iter().collect());
    for report in &started {
        for side in [0, 1] {
            if is_reporting(world, report.colliders[side]) {
                world.trigger(seen_from!(CollisionStart, report, side));
                // The commands of this observer are applied before the next observer runs.
                world.flush();
            }
        }
    }
    for report in &ended {
        for side in [0, 1] {
            if is_reporting(world, report.colliders[side]) {
                world.trigger(seen_from!(CollisionEnd, report, side));
                world.flush();
            }
        }
    }
}

/// Whether an entity exists and reports. An observer may have just despawned it.
fn is_reporting(world: &World, collider: Entity) -> bool {
    world.get_entity(collider).is_ok_and(|entity| entity.contains::<CollisionEventsEnabled>())
}

/// Updates the `CollidingEntities` of colliders whose collisions changed.
fn update_trackers(world: &mut World, trackers: Vec<Entity>) {
    if trackers.is_empty() {
        return;
    }
    let (colliders, contacts) = (world.resource::<Colliders>(), world.resource::<Contacts>());
    let touching = |collider: Entity| -> EntityHashSet {
        let Some(id) = colliders.find(collider) else { return EntityHashSet::default() };
        let all = contacts.table.of_collider(id, &colliders.table);
        let touching = all.filter(|contact| contacts.touches(*contact));
        let other = |[a, b]: [u32; 2]| colliders.entities[if a == id { b } else { a } as usize];
        touching.map(|contact| other(contacts.table.get(contact).colliders)).collect()
    };
    let sets: Vec<(Entity, EntityHashSet)> = trackers.into_iter().map(|e| (e, touching(e))).collect();
    for (collider, set) in sets {
        if let Ok(mut entity) = world.get_entity_mut(collider)
            && let Some(mut shown) = entity.get_mut::<CollidingEntities>()
        {
            shown.set_if_neq(CollidingEntities(set));
        }
    }
}
