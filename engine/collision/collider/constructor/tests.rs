//! Tests that need no assets: they run with and without features for meshes and scenes.

use super::{
    ColliderConstructor, ColliderConstructorHierarchy, ColliderConstructorHierarchyReady,
    ColliderConstructorPlugin, ColliderConstructorReady, scene::Scenes,
};
use crate::collision::collider::Collider;
use bevy_app::App;
use bevy_ecs::prelude::*;

#[derive(Resource, Default)]
struct Log(Vec<(Entity, &'static str)>);

fn app() -> App {
    let mut app = App::new();
    app.add_plugins(ColliderConstructorPlugin)
        .init_resource::<Log>()
        .add_observer(|on: On<ColliderConstructorReady>, mut log: ResMut<Log>| log.0.push((on.entity, "one")))
        .add_observer(|on: On<ColliderConstructorHierarchyReady>, mut log: ResMut<Log>| {
            log.0.push((on.entity, "all"));
        });
    app
}

fn ball() -> ColliderConstructor {
    ColliderConstructor::Capsule { radius: 0.5, height: 0.0 }
}

#[test]
fn a_hierarchy_is_done_in_the_frame_in_which_it_has_descendants() {
    let mut app = app();
    let root = app.world_mut().spawn(ColliderConstructorHierarchy::new(ball())).id();
    if Scenes::ARE_KNOWN {
        app.update();
        // The hierarchy has nothing to wait for.
        assert_eq!(core::mem::take(&mut app.world_mut().resource_mut::<Log>().0), [(root, "all")]);
        app.world_mut().entity_mut(root).insert(ColliderConstructorHierarchy::new(ball()));
    } else {
        (0..3).for_each(|_| app.update());
        assert!(app.world().resource::<Log>().0.is_empty(), "it may be a scene");
    }
    let child = app.world_mut().spawn(ChildOf(root)).id();
    let below = app.world_mut().spawn(ChildOf(child)).id();
    app.update();
    let log = &app.world().resource::<Log>().0;
    assert!(log[..2].contains(&(child, "one")) && log[..2].contains(&(below, "one")), "{log:?}");
    assert_eq!(log[2..], [(root, "all")]);
    assert!(!app.world().entity(root).contains::<ColliderConstructorHierarchy>());
    assert!(!app.world().entity(root).contains::<Collider>(), "the root gets none");
    assert!(app.world().entity(below).contains::<Collider>());
}
