//! Which islands fall asleep, and the [`Sleeping`] component as their mirror.

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

/// For how many steps a body must have rested in any case. Whatever turns in its flight, or has just been let
/// go, is slow for a moment: with thresholds of 0.15 m/s for two steps of 1/60 s.
const STEPS_OF_REST: f32 = 4.0;

/// Bodies whose [`Sleeping`] component was added or removed since the last step, by the app or as a mirror,
/// and those that were forbidden to sleep.
#[derive(Resource, Default)]
pub(crate) struct SleepRequests {
    sleep: Noted,
    wake: Noted,
}

#[cfg(test)]
impl SleepRequests {
    /// How many bodies are noted.
    pub(crate) fn len(&self) -> usize {
        self.sleep.len() + self.wake.len()
    }
}

#[cfg(feature = "validate")]
impl SleepRequests {
    /// Whether something is still to be done about a body.
    pub(crate) fn concern(&self, entity: Entity) -> bool {
        self.sleep.contains(entity) || self.wake.contains(entity)
    }
}

/// Puts a body to sleep, and with it the island it is in, at the start of the next step. An error if the entity
/// is no body.
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

/// Wakes a body, and with it the island it is in, at the start of the next step; one that is awake is so for
/// another [`TimeToSleep`]. An error if the entity is no body.
pub struct WakeBody(pub Entity);

impl Command for WakeBody {
    type Out = Result;

    fn apply(self, world: &mut World) -> Result {
        body_mut(world, self.0)?.remove::<Sleeping>();
        // Nobody sleeps without the plugin that makes it.
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

/// Registers the observers of [`Sleeping`].
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

/// Notes bodies that the app puts to sleep. Not those that sleep already: the component only follows, and
/// what wakes them until the next step must not be undone.
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

/// Does what the app asked for by adding or removing [`Sleeping`]: with a body sleeps or wakes its island. Who
/// must not sleep wakes.
pub(crate) fn follow_requests(
    mut requests: ResMut<SleepRequests>,
    ids: Query<(&BodyId, Has<Sleeping>, Has<SleepingDisabled>)>,
    mut tables: Tables,
) {
    let SleepRequests { sleep, wake } = &mut *requests;
    for (entity, ()) in sleep.drain() {
        // Added and removed again: the state now is what counts.
        if let Ok((id, true, _)) = ids.get(entity)
            && id.0 != NONE
            && let Some(island) = tables.link().island_of(id.0)
        {
            tables.link().sleep_island(island);
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
            tables.link().wake_body(id.0);
        }
    }
}

/// Splits islands that lost contacts, a few in each step, and puts to sleep those whose bodies have all rested.
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
    // A NaN stays one: nobody sleeps.
    let time_to_sleep = if time_to_sleep.0 < least { least } else { time_to_sleep.0 };
    scan.0.scan(&mut islands.0, time_to_sleep, rested);
    for island in scan.0.splits() {
        islands.0.split(*island);
    }
    for island in scan.0.sleepers().to_vec() {
        if !tables.link().is_carried(island) {
            tables.link().sleep_island(island);
        }
    }
}

/// Adds and removes [`Sleeping`] where a body fell asleep or woke. Observers of one body's `Sleeping` may despawn
/// the next before it gets its own.
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
