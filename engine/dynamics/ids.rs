//! The components that say which body or collider of the tables an entity is.
//!
//! Only the drain gives ids out, by writing to a component that is there. They mean nothing outside of the world
//! and the tables they belong to, so they do not reflect, are not cloned, and one that is inserted, by whatever
//! way, counts for nothing: the entity gets its own in the next step.

use bevy_ecs::{lifecycle::HookContext, prelude::*, world::DeferredWorld};
use kernel::table::NONE;

/// A body's number in the tables; `u32::MAX` while it takes no part in the simulation.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[component(clone_behavior = Ignore, on_insert = forget_body)]
pub struct BodyId(pub(crate) u32);

/// A collider's number in the tables; `u32::MAX` while it takes no part in the simulation.
#[derive(Component, Clone, Copy, Debug, PartialEq, Eq)]
#[component(clone_behavior = Ignore, on_insert = forget_collider)]
pub struct ColliderId(pub(crate) u32);

impl Default for BodyId {
    fn default() -> Self {
        Self(NONE)
    }
}

impl Default for ColliderId {
    fn default() -> Self {
        Self(NONE)
    }
}

fn forget_body(mut world: DeferredWorld, context: HookContext) {
    if let Some(mut id) = world.get_mut::<BodyId>(context.entity) {
        id.bypass_change_detection().0 = NONE;
    }
}

fn forget_collider(mut world: DeferredWorld, context: HookContext) {
    if let Some(mut id) = world.get_mut::<ColliderId>(context.entity) {
        id.bypass_change_detection().0 = NONE;
    }
}

#[cfg(all(test, feature = "default-collider"))]
mod tests {
    use super::*;
    use crate::{PhysicsPlugins, collision::collider::Collider, dynamics::rigid_body::RigidBody};
    use bevy_app::{App, TaskPoolPlugin, Update};
    use bevy_transform::TransformPlugin;

    fn ids(app: &App, entity: Entity) -> [Option<u32>; 2] {
        let entity = app.world().entity(entity);
        [entity.get::<BodyId>().map(|id| id.0), entity.get::<ColliderId>().map(|id| id.0)]
    }

    /// As from a saved scene: ids of another world, or of another entity, are not this entity's.
    #[test]
    fn ids_from_elsewhere_are_none() {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
        let loaded = (RigidBody::Dynamic, Collider::default(), BodyId(7), ColliderId(7));
        let first = app.world_mut().spawn(loaded).id();
        assert_eq!(ids(&app, first), [Some(NONE); 2]);
        app.world_mut().run_schedule(crate::schedule::PhysicsSchedule);
        assert_eq!(ids(&app, first), [Some(0); 2]);

        let second = (RigidBody::Dynamic, Collider::default(), BodyId(0), ColliderId(0));
        let second = app.world_mut().spawn(second).id();
        app.world_mut().run_schedule(crate::schedule::PhysicsSchedule);
        assert_eq!([ids(&app, first), ids(&app, second)], [[Some(0); 2], [Some(1); 2]]);

        // Over one's own id: the old place is given up, and another taken.
        app.world_mut().entity_mut(first).insert((BodyId(1), ColliderId(1)));
        app.world_mut().run_schedule(crate::schedule::PhysicsSchedule);
        app.world_mut().run_schedule(crate::schedule::PhysicsSchedule);
        assert_eq!(ids(&app, second), [Some(1); 2]);
        let [body, collider] = ids(&app, first);
        assert!(![Some(1), Some(NONE)].contains(&body) && ![Some(1), Some(NONE)].contains(&collider));
    }
}
