//! Kinematic bodies that follow their `Transform`.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::{TimePlugin, TimeUpdateStrategy, prelude::*};
use bevy_transform::{
    TransformPlugin,
    components::{GlobalTransform, Transform},
};
use core::time::Duration;
use scenes::dim::{ball, block, spin};

/// The app's animation: the transform at a time in s.
#[derive(Component, Clone, Copy)]
struct Path(fn(f32) -> Transform);

fn animate(time: Res<Time>, mut movers: Query<(&Path, &mut Transform)>) {
    for (path, mut transform) in &mut movers {
        *transform = path.0(time.elapsed_secs());
    }
}

/// Frames per second over ticks per second.
fn app(frames: f64, ticks: f64) -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()))
        .insert_resource(Time::<Fixed>::from_hz(ticks))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / frames)));
    app.finish();
    app.cleanup();
    app
}

/// Frames that are as long as several ticks, as long as some, and rates that do not divide each other.
const RATES: [(f64, f64); 5] = [(144.0, 64.0), (30.0, 64.0), (64.0, 64.0), (60.0, 30.0), (60.0, 144.0)];

fn get<T: Component + Clone>(app: &App, entity: Entity) -> T {
    app.world().get::<T>(entity).expect("the component").clone()
}

fn speed_x(app: &App, entity: Entity) -> f32 {
    get::<LinearVelocity>(app, entity).x as f32
}

fn lift(path: fn(f32) -> Transform) -> impl Bundle {
    (RigidBody::Kinematic, FollowTransform, block(6.0, 0.5, 6.0), path(0.0), Path(path))
}

/// There at 2 m/s for 2 s, then at rest.
fn there(t: f32) -> Transform {
    Transform::from_xyz(2.0 * t.min(2.0), 0.0, 0.0)
}

#[test]
fn the_velocity_is_that_of_the_transform_at_any_rates_and_riders_are_carried() {
    for (frames, ticks) in RATES {
        let what = format!("{frames} frames over {ticks} ticks");
        let mut app = app(frames, ticks);
        app.add_systems(Update, animate);
        let lift = app.world_mut().spawn(lift(there)).id();
        let rider = (RigidBody::Dynamic, block(0.5, 0.5, 0.5), Transform::from_xyz(0.0, 0.5, 0.0));
        let rider = app.world_mut().spawn((rider, Friction::new(0.6))).id();
        let mut start = None;
        for frame in 0..(4.0 * frames) as u32 {
            app.update();
            let now = f64::from(frame) / frames;
            if (0.2..1.9).contains(&now) {
                let v = speed_x(&app, lift);
                assert!((v - 2.0).abs() < 0.01, "{what}: {v} m/s after {now} s");
            }
            if (0.8..1.9).contains(&now) {
                assert!((speed_x(&app, rider) - 2.0).abs() < 0.02, "{what}: {} m/s", speed_x(&app, rider));
                let offset = get::<Position>(&app, rider).x - get::<Position>(&app, lift).x;
                let slip = (offset - *start.get_or_insert(offset)).abs();
                assert!(slip < 0.01, "{what}: slipped by {slip} m");
            }
            if now > 2.2 {
                assert_eq!(get::<LinearVelocity>(&app, lift), LinearVelocity::ZERO, "{what}");
                assert_eq!(get::<AngularVelocity>(&app, lift), AngularVelocity::ZERO, "{what}");
            }
        }
        assert!((get::<Position>(&app, lift).x as f32 - 4.0).abs() < 1.0e-5, "{what}: it gets there");
        assert_eq!(get::<Transform>(&app, lift), there(4.0), "{what}: the transform is the app's");
        assert!(app.world().get::<Sleeping>(rider).is_some(), "{what}: what lies on it sleeps");
    }
}

/// In each tick, or in each frame with physics in `Update`: the body is there in the same step.
#[test]
fn a_transform_that_is_set_for_the_step_is_reached_in_it() {
    for fixed in [true, false] {
        let mut app = if fixed { app(60.0, 64.0) } else { App::new() };
        if fixed {
            app.add_systems(FixedUpdate, animate);
        } else {
            app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin));
            app.add_plugins(PhysicsPlugins::new(PostUpdate)).add_systems(Update, animate);
            app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
            app.finish();
            app.cleanup();
        }
        let path = |t: f32| {
            Transform::from_xyz(3.0 * t, 0.0, 0.0).with_rotation(Quat::from_rotation_z(-1.5 * t.min(1.0)))
        };
        let lift = app.world_mut().spawn(lift(path)).id();
        // Off the centre of mass, so that the body turns about another point than its origin.
        app.world_mut().spawn((block(1.0, 1.0, 1.0), Transform::from_xyz(4.0, 1.0, 0.0), ChildOf(lift)));
        let mut steps = 0;
        for _ in 0..100 {
            app.update();
            let (transform, position) = (get::<Transform>(&app, lift), get::<Position>(&app, lift));
            if position.x == 0.0 {
                continue;
            }
            steps += 1;
            let off = (Position::from(GlobalTransform::from(transform)).0 - position.0).length();
            assert!(off < 1.0e-5, "fixed: {fixed}: {off} m");
            let turned = Rotation::from(transform.rotation).angle_between(get::<Rotation>(&app, lift));
            assert!(turned.abs() < 1.0e-5, "fixed: {fixed}: {turned} rad");
        }
        assert!(steps > 90 && get::<AngularVelocity>(&app, lift) == AngularVelocity::ZERO);
    }
}

/// `translation += …`, as beginners write it.
#[test]
fn a_transform_may_be_moved_by_increments() {
    for (frames, ticks) in RATES {
        let mut app = app(frames, ticks);
        app.add_systems(
            Update,
            |time: Res<Time>, mut lifts: Query<&mut Transform, With<FollowTransform>>| {
                for mut transform in &mut lifts {
                    transform.translation.y += time.delta_secs();
                }
            },
        );
        let lift = app
            .world_mut()
            .spawn((RigidBody::Kinematic, FollowTransform, ball(0.5), Transform::default()))
            .id();
        for _ in 0..(2.0 * frames) as u32 {
            app.update();
        }
        let late = 1.0 / frames + 1.0 / ticks;
        let y = get::<Position>(&app, lift).y as f64;
        let drawn = f64::from(get::<Transform>(&app, lift).translation.y);
        assert!((drawn - 2.0).abs() < 1.5 / frames, "{drawn} m");
        assert!(y <= drawn && y > drawn - late - 1.0e-3, "{frames} over {ticks}: {y} of {drawn} m");
        assert!((get::<LinearVelocity>(&app, lift).y - 1.0).abs() < 0.01);
    }
}

#[test]
fn a_lift_carries_up_and_down_without_throwing_off_or_sinking_in() {
    for (frames, ticks) in RATES {
        let mut app = app(frames, ticks);
        app.add_systems(Update, animate);
        // At most 3 m/s² of acceleration.
        let lift = app.world_mut().spawn(lift(|t| Transform::from_xyz(0.0, (t * 1.5).cos() - 1.0, 0.0))).id();
        let rider = (RigidBody::Dynamic, block(0.5, 0.5, 0.5), Transform::from_xyz(0.0, 0.5, 0.0));
        let rider = app.world_mut().spawn(rider).id();
        for _ in 0..(5.0 * frames) as u32 {
            app.update();
            let gap = get::<Position>(&app, rider).y - get::<Position>(&app, lift).y - 0.5;
            assert!((gap as f32).abs() < 0.02, "{frames} over {ticks}: {gap} m");
        }
    }
}

#[test]
fn what_is_in_its_way_is_hit_with_its_velocity() {
    let mut app = app(60.0, 64.0);
    app.add_systems(Update, animate).insert_resource(Gravity::ZERO);
    let bat = (RigidBody::Kinematic, FollowTransform, block(0.5, 2.0, 2.0), Restitution::new(1.0));
    let path: fn(f32) -> Transform = |t| Transform::from_xyz(5.0 * t, 0.0, 0.0);
    app.world_mut().spawn((bat, path(0.0), Path(path)));
    let ball = (RigidBody::Dynamic, ball(0.25), Restitution::new(1.0), Transform::from_xyz(3.0, 0.0, 0.0));
    let ball = app.world_mut().spawn(ball).id();
    for _ in 0..90 {
        app.update();
    }
    // A wall of 5 m/s that is hit at rest throws at twice its speed.
    let v = speed_x(&app, ball);
    assert!((v - 10.0).abs() < 0.1, "{v} m/s");
}

/// The parent is no body. A rider stands on the turntable below it, off its axis.
#[test]
fn a_body_below_an_animated_parent_follows_it_and_turns() {
    for (frames, ticks) in RATES {
        let mut app = app(frames, ticks);
        app.add_systems(Update, animate).insert_resource(Gravity::ZERO);
        let path: fn(f32) -> Transform =
            |t| Transform::from_xyz(t, 1.0, 0.0).with_rotation(Quat::from_rotation_z(t));
        let parent = app.world_mut().spawn((path(0.0), Path(path))).id();
        let arm = (RigidBody::Kinematic, FollowTransform, ball(0.5), Transform::from_xyz(2.0, 0.0, 0.0));
        let arm = app.world_mut().spawn((arm, ChildOf(parent))).id();
        for frame in 0..(2.0 * frames) as u32 {
            app.update();
            if f64::from(frame) < 0.3 * frames {
                continue;
            }
            // v = v₀ + ω × r with 1 rad/s, 2 m from the parent.
            let around = get::<LinearVelocity>(&app, arm).0 - Vector::X;
            assert!((around.length() as f32 - 2.0).abs() < 0.02, "{frames} over {ticks}: {around}");
        }
        let local = get::<Transform>(&app, arm);
        assert!(local.translation.abs_diff_eq(Vec3::X * 2.0, 1.0e-6), "its transform stays: {local:?}");
    }
}

#[test]
fn a_position_teleports_it_and_its_transform() {
    let mut app = app(60.0, 60.0);
    let lift =
        app.world_mut().spawn((RigidBody::Kinematic, FollowTransform, ball(0.5), Transform::default())).id();
    (0..5).for_each(|_| app.update());
    let rest = |app: &App, x: f32| {
        assert!((get::<Position>(app, lift).x as f32 - x).abs() < 1.0e-5);
        assert!((get::<Transform>(app, lift).translation.x - x).abs() < 1.0e-5);
        assert_eq!(get::<LinearVelocity>(app, lift), LinearVelocity::ZERO);
    };
    app.world_mut().get_mut::<Position>(lift).expect("a body").x = 500.0;
    for _ in 0..5 {
        app.update();
        app.update();
        rest(&app, 500.0);
    }
    // It follows its transform again.
    app.world_mut().get_mut::<Transform>(lift).expect("a body").translation.x = 501.0;
    (0..4).for_each(|_| app.update());
    rest(&app, 501.0);
    // Spawned with a position.
    let body = (RigidBody::Kinematic, FollowTransform, ball(0.5), Position(Vector::X * 7.0));
    let body = app.world_mut().spawn(body).id();
    (0..4).for_each(|_| app.update());
    assert_eq!((get::<Position>(&app, body).x, get::<Transform>(&app, body).translation.x), (7.0, 7.0));
}

#[test]
fn what_moved_while_physics_was_paused_is_put_there() {
    let mut app = app(60.0, 60.0);
    app.add_systems(Update, animate);
    let lift = app.world_mut().spawn(lift(there)).id();
    (0..30).for_each(|_| app.update());
    app.world_mut().resource_mut::<Time<Physics>>().pause();
    let paused_at = get::<Position>(&app, lift).x;
    (0..60).for_each(|_| app.update());
    assert_eq!(get::<Position>(&app, lift).x, paused_at);
    app.world_mut().resource_mut::<Time<Physics>>().unpause();
    for _ in 0..10 {
        app.update();
        let v = speed_x(&app, lift);
        assert!(v <= 2.01, "{v} m/s");
    }
    assert!(get::<Position>(&app, lift).x > 2.9 && (speed_x(&app, lift) - 2.0).abs() < 0.01);
}

#[test]
fn on_other_bodies_it_has_no_effect_and_may_be_changed_at_any_time() {
    let mut app = app(60.0, 60.0);
    app.insert_resource(Gravity::ZERO);
    let world = app.world_mut();
    let bodies = [RigidBody::Dynamic, RigidBody::Static]
        .map(|body| world.spawn((body, FollowTransform, ball(0.5), Transform::default())).id());
    let moving = world.spawn((RigidBody::Kinematic, ball(0.5), LinearVelocity(Vector::X * 3.0))).id();
    (0..3).for_each(|_| app.update());
    for body in bodies {
        app.world_mut().get_mut::<Transform>(body).expect("a body").translation.y = 5.0;
        (0..3).for_each(|_| app.update());
        assert_eq!(
            (get::<Position>(&app, body).y, get::<LinearVelocity>(&app, body)),
            (5.0, LinearVelocity::ZERO)
        );
    }
    // A moving body that gets the component stops at its transform. Without it the body obeys its
    // velocity again.
    app.world_mut().entity_mut(moving).insert(FollowTransform);
    (0..4).for_each(|_| app.update());
    assert_eq!(get::<LinearVelocity>(&app, moving), LinearVelocity::ZERO);
    app.world_mut().entity_mut(moving).remove::<FollowTransform>();
    app.world_mut().get_mut::<LinearVelocity>(moving).expect("a body").x = 3.0;
    let before = get::<Position>(&app, moving).x;
    (0..60).for_each(|_| app.update());
    let way = get::<Position>(&app, moving).x - before;
    assert!((way as f32 - 3.0).abs() < 0.1, "{way} m");
    assert!(
        (get::<Transform>(&app, moving).translation.x as Scalar - get::<Position>(&app, moving).x).abs()
            < 1.0e-4
    );
    // Retyped, disabled, and with numbers that are not finite.
    let lift =
        app.world_mut().spawn((RigidBody::Kinematic, FollowTransform, ball(0.5), Transform::default())).id();
    (0..3).for_each(|_| app.update());
    for wrong in [f32::NAN, f32::INFINITY, f32::MAX] {
        app.world_mut().get_mut::<Transform>(lift).expect("a body").translation.x = wrong;
        (0..3).for_each(|_| app.update());
        assert!(get::<Position>(&app, lift).0.is_finite() && get::<LinearVelocity>(&app, lift).0.is_finite());
    }
    app.world_mut().get_mut::<Position>(lift).expect("a body").0 = Vector::ZERO;
    (0..3).for_each(|_| app.update());
    app.world_mut().entity_mut(lift).insert(RigidBodyDisabled);
    app.world_mut().get_mut::<Transform>(lift).expect("a body").translation.x = 50.0;
    (0..3).for_each(|_| app.update());
    app.world_mut().entity_mut(lift).remove::<RigidBodyDisabled>();
    (0..3).for_each(|_| app.update());
    assert_eq!(
        (get::<Position>(&app, lift).x, get::<LinearVelocity>(&app, lift)),
        (50.0, LinearVelocity::ZERO)
    );
    app.world_mut().entity_mut(lift).insert(RigidBody::Dynamic);
    app.world_mut().get_mut::<LinearVelocity>(lift).expect("a body").x = 60.0;
    (0..60).for_each(|_| app.update());
    let transform = get::<Transform>(&app, lift).translation.x;
    assert!((transform - 110.0).abs() < 2.0, "{transform}");
}

/// Two doors with the origin at the hinge: one by its centre of mass, one by its transform.
#[test]
fn a_door_turns_about_its_edge() {
    let mut app = app(60.0, 60.0);
    app.add_systems(FixedUpdate, animate).insert_resource(Gravity::ZERO);
    let path: fn(f32) -> Transform =
        |t| Transform::from_xyz(3.0, 1.0, 0.0).with_rotation(Quat::from_rotation_z(0.5 * t));
    let panel = || (block(2.0, 0.1, 2.0), Transform::from_xyz(1.0, 0.0, 0.0));
    let by_mass = (CenterOfMass::ZERO, NoAutoCenterOfMass, spin(0.5));
    let by_mass = app.world_mut().spawn((RigidBody::Kinematic, by_mass, path(0.0))).id();
    let by_transform = (FollowTransform, Path(path));
    let by_transform = app.world_mut().spawn((RigidBody::Kinematic, by_transform, path(0.0))).id();
    let panels = [by_mass, by_transform].map(|door| app.world_mut().spawn((panel(), ChildOf(door))).id());
    for _ in 0..120 {
        app.update();
        for door in [by_mass, by_transform] {
            let off = get::<Position>(&app, door).0 - (Vector::X * 3.0 + Vector::Y);
            assert!(off.length() < 1.0e-5, "the hinge is off by {off}");
        }
        let [a, b] = panels.map(|panel| get::<Position>(&app, panel).0);
        assert!((a - b).length() < 0.02, "both open at the same rate: {a}, {b}");
    }
    let turned = get::<Rotation>(&app, by_transform).angle_between(Rotation::IDENTITY);
    assert!(turned.abs() > 0.9, "{turned} rad");
    assert!(get::<LinearVelocity>(&app, by_transform).length() > 0.4, "that of its centre of mass");
}
