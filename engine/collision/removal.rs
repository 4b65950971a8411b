//! Ends the collisions of colliders that are despawned or lose their shape: at once, or at the end of a step
//! that is running.

use bevy_app::App;
use bevy_ecs::{entity_disabling::Disabled, prelude::*, system::SystemParam};

use super::{
    collider::{Collider, CollidingEntities, custom::CustomShape},
    collision_events::{IsSending, send_collision_events},
    contact_types::{ContactGraph, views::ContactViews},
};
use crate::dynamics::{
    ids::ColliderId,
    lifecycle::LifecycleQueue,
    tables::{Colliders, Tables},
};

/// Adds the observers.
pub(crate) fn watch(app: &mut App) {
    app.init_resource::<IsSending>()
        .add_observer(|on: On<Discard, ColliderId>, mut leaving: Leaving| leaving.lose(on.entity))
        .add_observer(|on: On<Remove, Collider>, mut leaving: Leaving| leaving.lose_shape(on.entity))
        .add_observer(|on: On<Remove, CustomShape>, mut leaving: Leaving| leaving.lose_shape(on.entity));
}

/// All state about the collisions of a collider.
#[derive(SystemParam)]
struct Leaving<'w, 's> {
    ids: Query<'w, 's, &'static ColliderId, Allow<Disabled>>,
    queue: ResMut<'w, LifecycleQueue>,
    tables: Tables<'w>,
    views: ResMut<'w, ContactViews>,
    graph: ResMut<'w, ContactGraph>,
    shown: Query<'w, 's, &'static mut CollidingEntities, Allow<Disabled>>,
    commands: Commands<'w, 's>,
}

impl Leaving<'_, '_> {
    /// The id of a collider in the tables.
    fn id_of(&self, entity: Entity) -> Option<u32> {
        let id = self.ids.get(entity).ok()?.0;
        let Colliders { table, entities, .. } = &*self.tables.colliders;
        (table.ids.is_live(id) && entities[id as usize] == entity).then_some(id)
    }

    /// Ends the collisions of a collider whose id is discarded. During a step nothing is done here: the
    /// removal of the id ends them.
    fn lose(&mut self, entity: Entity) {
        if !self.queue.is_within_step
            && let Some(id) = self.id_of(entity)
        {
            self.end(entity, id);
        }
    }

    /// Ends the collisions of a collider without a shape.
    fn lose_shape(&mut self, entity: Entity) {
        let Some(id) = self.id_of(entity) else { return };
        if self.queue.is_within_step {
            return self.queue.shapeless.push(id);
        }
        self.end(entity, id);
        // The collider may get another shape before the next step, and then needs its pairs.
        self.tables.colliders.moved.insert(id);
    }

    fn end(&mut self, entity: Entity, id: u32) {
        if self.tables.contacts.table.of_collider(id, &self.tables.colliders.table).next().is_none() {
            return;
        }
        // The sets below are updated one by one. Rebuilding them would visit all contacts of the other
        // colliders.
        let trackers = core::mem::take(&mut self.tables.contacts.reports.trackers);
        let first = self.tables.contacts.reports.ended.len();
        self.tables.end_contacts(id, |_, _| true);
        self.tables.contacts.reports.trackers = trackers;
        self.views.forget();
        self.graph.bypass_change_detection().remove_collider(entity);

        let ended = &self.tables.contacts.reports.ended[first..];
        for report in ended {
            let [a, b] = report.colliders;
            for (collider, other) in [(a, b), (b, a)] {
                if let Ok(mut shown) = self.shown.get_mut(collider)
                    && shown.contains(&other)
                {
                    shown.remove(&other);
                }
            }
        }
        if ended.iter().any(|report| report.is_sent) {
            self.commands.queue(send_collision_events);
        } else {
            self.tables.contacts.reports.ended.truncate(first);
        }
    }
}
