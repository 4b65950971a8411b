//! Bodies at rest, and changes by the app.

use avian::{math::Vector, prelude::*};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use scenes::dim::{ball, block};

const DT: f32 = 1.0 / 64.0;

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.finish();
    app.cleanup();
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
    app
}

fn steps(app: &mut App, count: u32) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f32(DT));
        app.update();
    }
}

fn resting(app: &mut App, collider: Collider) -> Entity {
    app.world_mut().spawn((RigidBody::Dynamic, collider, Transform::from_xyz(0.0, 0.5, 0.0))).id()
}

fn timer(app: &App, body: Entity) -> f32 {
    app.world().get::<SleepTimer>(body).expect("every body has one").0
}

fn is_asleep(app: &App, body: Entity) -> bool {
    app.world().get::<Sleeping>(body).is_some()
}

#[test]
fn issue_the_sleep_timer_was_neither_there_nor_read() {
    let mut app = app();
    let body = resting(&mut app, block(1.0, 1.0, 1.0));
    assert_eq!(timer(&app, body), 0.0);
    assert_eq!(app.world().get::<SleepThreshold>(body), Some(&SleepThreshold::default()));
    steps(&mut app, 20);
    let before = timer(&app, body);
    steps(&mut app, 1);
    assert!(before > 0.0 && (timer(&app, body) - before - DT).abs() < 1.0e-5);
    // The app keeps it awake.
    for _ in 0..60 {
        app.world_mut().get_mut::<SleepTimer>(body).expect("every body has one").0 = 0.0;
        steps(&mut app, 1);
        assert!(!is_asleep(&app, body) && timer(&app, body) <= 1.01 * DT);
    }
    steps(&mut app, 40);
    assert!(is_asleep(&app, body));
    // A moving body has not rested.
    app.world_mut().get_mut::<LinearVelocity>(body).expect("every body has one").0 = Vector::Y * 5.0;
    steps(&mut app, 2);
    assert!(!is_asleep(&app, body) && timer(&app, body) == 0.0);
}

#[test]
fn issue_a_collider_marked_as_changed_woke_its_body() {
    for collider in [ball(0.5), block(1.0, 1.0, 1.0)] {
        let mut app = app();
        let body = resting(&mut app, collider);
        steps(&mut app, 80);
        assert!(is_asleep(&app, body));
        app.world_mut().get_mut::<Collider>(body).expect("spawned with one").set_changed();
        app.world_mut().get_mut::<ColliderTransform>(body).expect("every collider has one").set_changed();
        steps(&mut app, 2);
        assert!(is_asleep(&app, body));
        *app.world_mut().get_mut::<Collider>(body).expect("spawned with one") = ball(0.4);
        steps(&mut app, 2);
        assert!(!is_asleep(&app, body));
    }
}
