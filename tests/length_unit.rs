//! The warning where the length unit was forgotten.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, schedule::SingleThreadedExecutor};
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

use super::constructors::warnings;

/// The warnings of two seconds of physics.
fn warned(
    plugins: impl PluginGroup,
    gravity: Scalar,
    hertz: u32,
    setup: impl FnOnce(&mut World),
) -> Vec<String> {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, plugins));
    app.insert_resource(Gravity(Vector::NEG_Y * gravity));
    // Warnings are caught on this thread.
    app.edit_schedule(Last, |schedule| _ = schedule.set_executor(SingleThreadedExecutor::new()));
    app.finish();
    app.cleanup();
    setup(app.world_mut());
    warnings(|| {
        for _ in 0..2 * hertz {
            app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs(1) / hertz);
            app.update();
        }
    })
}

fn plugins(unit: Scalar) -> PhysicsPlugins {
    PhysicsPlugins::new(Update).with_length_unit(unit)
}

/// A body with a round collider.
fn ball(body: RigidBody, x: f32, diameter: Scalar) -> impl Bundle {
    let collider = Collider::capsule(diameter * 0.5, diameter * 0.01);
    (body, collider, Transform::from_xyz(x, 0.0, 0.0))
}

#[test]
fn one_warning_where_the_length_unit_was_forgotten() {
    for (unit, gravity, diameter) in [(1.0, 9.81, 64.0), (1.0, 981.0, 16.0), (100.0, 9.81, 0.5)] {
        for hertz in [30, 60, 144] {
            let told = warned(plugins(unit), gravity, hertz, |world| {
                world.spawn(ball(RigidBody::Dynamic, 0.0, diameter));
                world.spawn(ball(RigidBody::Kinematic, 500.0, diameter));
                // What is static does not count: floors are as long as a level.
                world.spawn(ball(RigidBody::Static, 1500.0, 1.0));
            });
            assert_eq!(told.len(), 1, "{unit}, {gravity}, {diameter}: {told:?}");
            assert!(told[0].contains("with_length_unit") && told[0].contains("LengthUnitCheckPlugin"));
        }
    }
}

#[test]
fn no_warning_where_one_body_is_of_an_ordinary_size_or_the_plugin_is_disabled() {
    let giant = |world: &mut World| _ = world.spawn(ball(RigidBody::Dynamic, 0.0, 64.0));
    assert_eq!(warned(plugins(1.0), 9.81, 60, giant).len(), 1);
    assert_eq!(warned(plugins(64.0), 9.81 * 64.0, 60, giant).len(), 0, "with its unit");
    assert_eq!(warned(plugins(1.0), 0.0, 60, giant).len(), 0, "without gravity");
    let group = plugins(1.0).build().disable::<LengthUnitCheckPlugin>();
    assert_eq!(warned(group, 9.81, 60, giant).len(), 0, "without the plugin");
    let with_player = |world: &mut World| {
        giant(world);
        world.spawn(ball(RigidBody::Kinematic, 100.0, 1.8));
    };
    assert_eq!(warned(plugins(1.0), 9.81, 60, with_player).len(), 0, "beside a player");
    let with_cargo = |world: &mut World| {
        let ship = world.spawn(ball(RigidBody::Dynamic, 0.0, 64.0)).id();
        world.spawn((Collider::capsule(0.5, 1.0), ChildOf(ship)));
    };
    assert_eq!(warned(plugins(1.0), 9.81, 60, with_cargo).len(), 0, "with a small part");
    assert_eq!(warned(plugins(1.0), 9.81, 60, |_| ()).len(), 0, "of nothing");
    let frozen = |world: &mut World| {
        giant(world);
        world.resource_mut::<Time<Physics>>().pause();
    };
    assert_eq!(warned(plugins(1.0), 9.81, 60, frozen).len(), 0, "while paused");
}
