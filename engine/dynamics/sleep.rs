//! Systems that put islands to sleep, and update [`Sleeping`] components.

use bevy_app::App;
use bevy_ecs::{entity_disabling::Disabled, error::Result, prelude::*, system::Command};
use bevy_time::Time;
use kernel::{
    graph::SleepScan,
    table::{BodyKind, NONE, Velocity},
};

use crate::{
    dynamics::{
        ids::BodyId,
        rigid_body::{
            RigidBody,
            sleeping::{Sleeping, SleepingDisabled, TimeToSleep},
        },
        tables::{Bodies, Tables},
    },
    noted::Noted,
    schedule::Physics,
};

/// Minimum number of steps at rest before a body sleeps. A body at the top of its flight, or a body that was
/// just released, is slow for a moment: with a threshold of 0.15 m/s for two steps of 1/60 s.
const STEPS_OF_REST: f32 = 4.0;

/// Bodies whose [`Sleeping`] component was added or removed since the last step, by the app or the engine,
/// and bodies that got [`SleepingDisabled`].
#[derive(Resource, Default)]
pub(crate) struct SleepRequests {
    sleep: Noted,
    wake: Noted,
}

#[cfg(test)]
impl SleepRequests {
    /// The number of recorded bodies.
    pub(crate) fn len(&self) -> usize {
        self.sleep.len() + self.wake.len()
    }
}

#[cfg(feature = "validate")]
impl SleepRequests {
    /// Whether a request for a body is pending.
    pub(crate) fn concern(&self, entity: Entity) -> bool {
        self.sleep.contains(entity) || self.wake.contains(entity)
    }
}

/// Puts a body and its island to sleep at the start of the next step. An error if the entity is not a body.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn freeze(bodies: Query<Entity, With<RigidBody>>, mut commands: Commands) {
///     bodies.iter().for_each(|body| commands.queue(SleepBody(body)));
/// }
/// ```
pub struct SleepBody(pub Entity);

impl Command for SleepBody {
    type Out = Result;

    fn apply(self, world: &mut World) -> Result {
        body_mut(world, self.0)?.insert(Sleeping);
        Ok(())
    }
}

/// Wakes a body and its island at the start of the next step. An awake body stays awake for another
/// [`TimeToSleep`]. An error if the entity is not a body.
pub struct WakeBody(pub Entity);

impl Command for WakeBody {
    type Out = Result;

    fn apply(self, world: &mut World) -> Result {
        body_mut(world, self.0)?.remove::<Sleeping>();
        // Without the sleeping plugin no body sleeps.
        if let Some(mut requests) = world.get_resource_mut::<SleepRequests>() {
            requests.wake.note(self.0);
        }
        Ok(())
    }
}

fn body_mut(world: &mut World, entity: Entity) -> Result<EntityWorldMut<'_>> {
    let body = world.get_entity_mut(entity)?;
    if !body.contains::<RigidBody>() {
        return Err(format!("{entity} has no `RigidBody`: only bodies sleep and wake").into());
    }
    Ok(body)
}

/// Buffers of the sleep scan.
#[derive(Resource, Default)]
pub(crate) struct SleepBuffers(SleepScan);

/// Adds the observers of [`Sleeping`].
pub(crate) fn watch_sleeping(app: &mut App) {
    app.init_resource::<SleepRequests>()
        .init_resource::<SleepBuffers>()
        .add_observer(ask_to_sleep)
        .add_observer(|on: On<Remove, Sleeping>, mut requests: ResMut<SleepRequests>| {
            requests.wake.note(on.entity);
        })
        .add_observer(|on: On<Add, SleepingDisabled>, mut requests: ResMut<SleepRequests>| {
            requests.wake.note(on.entity);
        });
}

/// Records bodies that the app puts to sleep. Bodies that already sleep are skipped: the engine inserted the
/// component, and these bodies may wake before the next step.
fn ask_to_sleep(
    on: On<Add, Sleeping>,
    ids: Query<&BodyId, Allow<Disabled>>,
    bodies: Res<Bodies>,
    mut requests: ResMut<SleepRequests>,
) {
    let sleeps = |id: &BodyId| {
        let dynamic = id.0 != NONE && bodies.table[id.0].kind == BodyKind::Dynamic;
        dynamic && !bodies.table[id.0].awake
    };
    if !ids.get(on.entity).is_ok_and(sleeps) {
        requests.sleep.note(on.entity);
    }
}

/// Applies the requests of the app: puts the islands of bodies to sleep or wakes them. Bodies that must not
/// sleep wake.
pub(crate) fn follow_requests(
    mut requests: ResMut<SleepRequests>,
    ids: Query<(&BodyId, Has<Sleeping>, Has<SleepingDisabled>)>,
    mut tables: Tables,
) {
    let SleepRequests { sleep, wake } = &mut *requests;
    for (entity, ()) in sleep.drain() {
        // The component may have been added and removed again, so its current state counts.
        if let Ok((id, true, _)) = ids.get(entity)
            && id.0 != NONE
            && let Some(island) = tables.contact_manager().island_of(id.0)
        {
            tables.contact_manager().sleep_island(island);
        }
    }
    let bodies = &mut *tables.bodies;
    for i in 0..bodies.table.flipped.len() {
        let id = bodies.table.flipped[i];
        if bodies.table.ids.is_live(id)
            && bodies.table[id].kind == BodyKind::Dynamic
            && !bodies.table[id].awake
        {
            bodies.still(id);
        }
    }
    for (entity, ()) in wake.drain() {
        if let Ok((id, false, _) | (id, true, true)) = ids.get(entity)
            && id.0 != NONE
        {
            tables.contact_manager().wake_body(id.0);
        }
    }
}

/// Splits some of the islands that lost contacts, and puts islands to sleep if all their bodies have rested.
pub(crate) fn sleep_islands(
    mut scan: ResMut<SleepBuffers>,
    time_to_sleep: Res<TimeToSleep>,
    time: Res<Time<Physics>>,
    mut tables: Tables,
) {
    let Tables { bodies, islands, .. } = &mut tables;
    let Some(islands) = islands else { return };
    let rested = |body: u32| Some(bodies.table[body].sleep_timer).filter(|t| *t > 0.0);
    let least = STEPS_OF_REST * time.delta_secs();
    // NaN stays NaN, and then no body sleeps.
    let time_to_sleep = if time_to_sleep.0 < least { least } else { time_to_sleep.0 };
    scan.0.scan(&mut islands.0, time_to_sleep, rested);
    for island in scan.0.splits() {
        islands.0.split(*island);
    }
    for island in scan.0.sleepers().to_vec() {
        if !tables.contact_manager().is_carried(island) {
            tables.contact_manager().sleep_island(island);
        }
    }
}

/// Adds and removes [`Sleeping`] on bodies that fell asleep or woke. Observers of one body's `Sleeping` may
/// despawn the next body before it is processed.
pub(crate) fn mirror_sleeping(mut tables: Tables, sleeping: Query<Has<Sleeping>>, mut commands: Commands) {
    let bodies = &mut *tables.bodies;
    for id in core::mem::take(&mut bodies.table.flipped) {
        if !bodies.table.ids.is_live(id) || bodies.table[id].kind != BodyKind::Dynamic {
            continue;
        }
        let entity = bodies.entities[id as usize];
        let asleep = !bodies.table[id].awake;
        if asleep {
            bodies.still(id);
        } else if let Some(kept) = bodies.kept.get_mut(id as usize) {
            *kept = Velocity::default();
        }
        match (asleep, sleeping.get(entity)) {
            (true, Ok(false)) => {
                commands.entity(entity).try_insert(Sleeping);
            }
            (false, Ok(true)) => {
                commands.entity(entity).try_remove::<Sleeping>();
            }
            _ => {}
        }
    }
}
