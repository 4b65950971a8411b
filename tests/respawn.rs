//! Transforms that the app sets when a step is done: in observers of its events, in its last sets, and before
//! the write-back. They are newer than the step, and count.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};
use bevy_math::Vec3;
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use scenes::dim::{ball, spin};

const DT: Duration = Duration::from_micros(15_625);

/// Where bodies are put back to.
const HOME: Vec3 = Vec3::new(-20.0, 3.0, 0.0);

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)))
        .insert_resource(Gravity::ZERO);
    app
}

fn step(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(DT);
    app.update();
}

/// A body that flies to the right at 4 m/s, spins, and reports all that happens.
fn flyer() -> impl Bundle {
    (
        RigidBody::Dynamic,
        ball(0.5),
        LinearVelocity(Vector::X * 4.0),
        spin(2.0),
        CollisionEventsEnabled,
        CollisionHitsEnabled::default(),
        SleepingDisabled,
    )
}

fn get<C: Component + Copy>(app: &App, entity: Entity) -> C {
    *app.world().get::<C>(entity).expect("the component")
}

fn home() -> Vector {
    Vector::X * HOME.x as Scalar + Vector::Y * HOME.y as Scalar
}

/// How often the body was put back.
#[derive(Resource, Default)]
struct Returned(u32);

fn put_back<E: EntityEvent>(
    on: On<E>,
    mut transforms: Query<&mut Transform>,
    mut commands: Commands,
    mut returned: ResMut<Returned>,
    inserts: Res<Inserts>,
) {
    let body = on.event_target();
    if returned.0 == 0 {
        let mut transform = transforms.get_mut(body).expect("a body has one");
        if inserts.0 {
            commands.entity(body).insert(Transform { translation: HOME, ..*transform });
        } else {
            transform.translation = HOME;
        }
        returned.0 += 1;
    }
}

/// Whether the transform is inserted by a command.
#[derive(Resource)]
struct Inserts(bool);

#[test]
fn issue_a_transform_set_in_an_observer_of_an_event_was_overwritten() {
    for (kind, inserts) in [(0, false), (1, false), (2, false), (0, true), (1, true), (2, true)] {
        let what = format!("event {kind}, inserted: {inserts}");
        let mut app = app();
        app.init_resource::<Returned>().insert_resource(Inserts(inserts));
        let zone = (RigidBody::Static, ball(0.5), Transform::from_xyz(2.0, 0.0, 0.0));
        let mut zone = app.world_mut().spawn(zone);
        if kind < 2 {
            zone.insert(Sensor);
        }
        let body = app.world_mut().spawn(flyer()).id();
        // It turns as one that meets nothing.
        let twin = app.world_mut().spawn((flyer(), Transform::from_xyz(0.0, 50.0, 0.0))).id();
        let mut body_mut = app.world_mut().entity_mut(body);
        _ = match kind {
            0 => body_mut.observe(put_back::<CollisionStart>),
            1 => body_mut.observe(put_back::<CollisionEnd>),
            _ => body_mut.observe(put_back::<CollisionHit>),
        };
        for _ in 0..200 {
            step(&mut app);
            if app.world().resource::<Returned>().0 > 0 {
                break;
            }
        }
        assert_eq!(get::<Transform>(&app, body).translation, HOME, "{what}");
        if kind < 2 {
            assert_eq!(get::<Rotation>(&app, body), get::<Rotation>(&app, twin), "{what}");
        }
        step(&mut app);
        let way = get::<Position>(&app, body).0 - home();
        assert!(way.length() < 0.1, "{what}: {way}");
        if kind < 2 {
            assert!((way - Vector::X * 4.0 / 64.0).length() < 1.0e-5, "{what}: {way}");
            assert_eq!(get::<Rotation>(&app, body), get::<Rotation>(&app, twin), "{what}");
        }
    }
}

/// Puts the body back once.
fn put_back_late(mut bodies: Query<&mut Transform, With<RigidBody>>, mut returned: ResMut<Returned>) {
    returned.0 += 1;
    if returned.0 == 5 {
        bodies.iter_mut().for_each(|mut transform| transform.translation = HOME);
    }
}

fn goes_on(schedule: impl ScheduleLabel, set: impl SystemSet, what: &str) {
    let mut app = app();
    app.init_resource::<Returned>().add_systems(schedule, put_back_late.in_set(set));
    let body = app.world_mut().spawn(flyer()).id();
    for steps in 1..=10u8 {
        step(&mut app);
        let way = Vector::X * 4.0 * Scalar::from(steps) / 64.0;
        let expected = if steps < 6 { way } else { home() + way - Vector::X * 4.0 * 5.0 / 64.0 };
        let position = get::<Position>(&app, body).0;
        assert!((position - expected).length() < 1.0e-4, "{what}, step {steps}: {position}");
    }
}

#[test]
fn issue_a_transform_set_after_the_solver_was_overwritten() {
    for set in [PhysicsStepSystems::Sleeping, PhysicsStepSystems::Finalize, PhysicsStepSystems::Last] {
        goes_on(PhysicsSchedule, set, &format!("{set:?}"));
    }
    #[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
    struct Between;
    let mut app = app();
    app.configure_sets(
        Update,
        Between.after(PhysicsSystems::StepSimulation).before(PhysicsSystems::Writeback),
    );
    app.init_resource::<Returned>().add_systems(Update, put_back_late.in_set(Between));
    let body = app.world_mut().spawn(flyer()).id();
    (0..6).for_each(|_| step(&mut app));
    let way = get::<Position>(&app, body).0 - home();
    assert!((way - Vector::X * 4.0 / 64.0).length() < 1.0e-4, "{way}");
}

/// A pose that the app sets wins over a transform, whichever comes first.
#[test]
fn a_pose_set_after_the_solver_wins_over_a_transform() {
    let mut app = app();
    let set = |mut bodies: Query<(&mut Transform, &mut Position)>, mut returned: ResMut<Returned>| {
        returned.0 += 1;
        for (mut transform, mut position) in bodies.iter_mut().filter(|_| returned.0 == 3) {
            position.0 = Vector::Y * 7.0;
            transform.translation = HOME;
        }
    };
    app.init_resource::<Returned>().add_systems(PhysicsSchedule, set.in_set(PhysicsStepSystems::Last));
    let body = app.world_mut().spawn(flyer()).id();
    (0..3).for_each(|_| step(&mut app));
    assert_eq!(get::<Transform>(&app, body).translation, Vec3::Y * 7.0);
    step(&mut app);
    assert!((get::<Position>(&app, body).0 - Vector::Y * 7.0 - Vector::X * 4.0 / 64.0).length() < 1.0e-5);
}

#[test]
fn parts_of_a_transform_that_are_no_pose_change_no_bit_of_the_motion() {
    let run = |touches: bool| {
        let mut app = app();
        let touch = |mut bodies: Query<&mut Transform>, mut returned: ResMut<Returned>| {
            returned.0 += 1;
            for mut transform in &mut bodies {
                if Vector::AXES.len() == 2 {
                    transform.translation.z = returned.0 as f32;
                }
                transform.set_changed();
            }
        };
        app.init_resource::<Returned>();
        if touches {
            app.add_systems(PhysicsSchedule, touch.in_set(PhysicsStepSystems::Last));
        }
        let body = app.world_mut().spawn(flyer()).id();
        (0..50).for_each(|_| step(&mut app));
        (get::<Position>(&app, body), get::<Rotation>(&app, body))
    };
    assert_eq!(run(false), run(true));
}

#[test]
fn an_eased_body_that_an_observer_puts_back_is_drawn_at_its_new_place() {
    for frame in [Duration::from_millis(5), Duration::from_micros(16_667), Duration::from_millis(33)] {
        let mut app = App::new();
        let plugins = PhysicsPlugins::default().set(PhysicsInterpolationPlugin::interpolate_all());
        app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, plugins))
            .insert_resource(TimeUpdateStrategy::ManualDuration(frame))
            .insert_resource(Gravity::ZERO)
            .insert_resource(Inserts(false))
            .init_resource::<Returned>();
        app.finish();
        app.cleanup();
        let zone = (RigidBody::Static, ball(0.5), Sensor, Transform::from_xyz(2.0, 0.0, 0.0));
        app.world_mut().spawn(zone);
        let body = app.world_mut().spawn(flyer()).observe(put_back::<CollisionStart>).id();
        while app.world().resource::<Returned>().0 == 0 {
            app.update();
        }
        // The frames of one tick draw the way there.
        let mut elapsed = Duration::ZERO;
        while elapsed < Duration::from_millis(500) {
            app.update();
            elapsed += frame;
            let drawn = get::<Transform>(&app, body).translation.x - HOME.x;
            let latest = 4.0 * elapsed.as_secs_f32() + 0.2;
            if elapsed > Duration::from_millis(35) {
                assert!((-0.2..latest).contains(&drawn), "{frame:?}, after {elapsed:?}: {drawn}");
                assert!((get::<Position>(&app, body).0.x - home().x).abs() < 4.0, "{frame:?}");
            }
        }
        assert_eq!(app.world().resource::<Returned>().0, 1, "{frame:?}");
    }
}
