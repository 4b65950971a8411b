//! The state of a body or collider right after it is spawned, attached or detached, before any
//! system has run.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::prelude::*;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use scenes::dim::{ball, block};

const DT: Duration = Duration::from_nanos(1_000_000_000 / 64);

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::default()));
    app.finish();
    app.cleanup();
    app.world_mut().resource_mut::<Time<Physics>>().pause();
    app
}

/// Steps by hand, as in the documentation of the clock: the schedule that hosts physics does not run.
fn by_hand(app: &mut App, steps: u32) {
    for _ in 0..steps {
        app.world_mut().resource_mut::<Time<Physics>>().advance_by(DT);
        app.world_mut().run_schedule(PhysicsSchedule);
    }
}

fn at(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

fn floor(app: &mut App) -> Entity {
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y))).id()
}

#[track_caller]
fn get<C: Component + Clone>(app: &App, entity: Entity) -> C {
    app.world().get::<C>(entity).expect("the entity has the component").clone()
}

#[track_caller]
fn is_near(value: Scalar, wanted: Scalar) {
    assert!((value - wanted).abs() < 0.02, "{value} is not {wanted}");
}

fn owner(app: &App, collider: Entity) -> Option<Entity> {
    app.world().get::<ColliderOf>(collider).map(|of| of.body)
}

fn listed(app: &App, body: Entity) -> Vec<Entity> {
    app.world().get::<RigidBodyColliders>(body).map(|list| list.to_vec()).unwrap_or_default()
}

fn mass(app: &App, body: Entity) -> f32 {
    get::<ComputedMass>(app, body).value() as f32
}

#[test]
fn issue_bodies_stepped_by_hand_had_no_mass_and_fell_through_the_floor() {
    let mut app = app();
    let floor = floor(&mut app);
    let body = app.world_mut().spawn((RigidBody::Dynamic, block(1.0, 1.0, 1.0), at(3.0, 1.0))).id();
    let unit = ColliderMassProperties::from_shape(&block(1.0, 1.0, 1.0), 1.0);
    assert!((mass(&app, body) - unit.mass).abs() < 1.0e-6);
    assert_eq!([owner(&app, body), owner(&app, floor)], [Some(body), Some(floor)]);
    assert_eq!(listed(&app, body), [body]);
    assert_eq!(get::<Position>(&app, body).0, Vector::X * 3.0 + Vector::Y);

    by_hand(&mut app, 128);
    is_near(get::<Position>(&app, body).y, 0.5);
    assert_eq!(mass(&app, body), unit.mass);
}

#[test]
fn colliders_below_a_body_are_attached_as_they_are_spawned() {
    let mut app = app();
    floor(&mut app);
    let body = app.world_mut().spawn((RigidBody::Dynamic, at(3.0, 2.0))).id();
    let middle = app.world_mut().spawn((at(0.0, -0.5), ChildOf(body))).id();
    let part = app.world_mut().spawn((ball(0.5), at(1.0, 0.0), ChildOf(middle))).id();
    let other = app.world_mut().spawn((ball(0.5), at(-1.0, -0.5), ChildOf(body))).id();
    assert_eq!([owner(&app, part), owner(&app, other)], [Some(body); 2]);
    assert_eq!(listed(&app, body), [part, other]);
    let offset = get::<ColliderTransform>(&app, part).translation;
    assert!(offset.distance(Vector::X - Vector::Y * 0.5) < 1.0e-6);

    by_hand(&mut app, 1);
    let unit = ColliderMassProperties::from_shape(&ball(0.5), 1.0).mass;
    assert!((mass(&app, body) - 2.0 * unit).abs() < 1.0e-5 * unit);
    let lowest = |app: &App| get::<ColliderAabb>(app, part).min.y.min(get::<ColliderAabb>(app, other).min.y);
    assert!(lowest(&app) > 0.8);
    by_hand(&mut app, 128);
    assert!(lowest(&app) > -0.05 && lowest(&app) < 0.05);
}

#[test]
fn a_batch_is_attached_and_weighed_when_it_is_spawned() {
    let mut app = app();
    let bodies = (0..2_000).map(|i| (RigidBody::Dynamic, ball(0.5), at(2.0 * i as f32, 0.0)));
    let bodies: Vec<Entity> = app.world_mut().spawn_batch(bodies.collect::<Vec<_>>()).collect();
    let unit = ColliderMassProperties::from_shape(&ball(0.5), 1.0).mass;
    for &body in &bodies {
        assert_eq!((owner(&app, body), mass(&app, body)), (Some(body), unit));
        assert_eq!(listed(&app, body), [body]);
    }
}

#[test]
fn issue_a_collider_with_a_body_of_its_own_choice_lost_it() {
    let mut app = app();
    floor(&mut app);
    let body = app.world_mut().spawn((RigidBody::Dynamic, at(3.0, 2.0))).id();
    let collider = app.world_mut().spawn((ball(0.5), ColliderOf { body })).id();
    let placed = app.world_mut().spawn((ball(0.25), ColliderOf { body }, at(4.0, 2.0))).id();
    let given = ColliderTransform { translation: -Vector::X, ..Default::default() };
    let offset = app.world_mut().spawn((ball(0.25), ColliderOf { body }, given)).id();
    let check = |app: &App| {
        assert_eq!([collider, placed, offset].map(|c| owner(app, c)), [Some(body); 3]);
        assert_eq!(listed(app, body), [collider, placed, offset]);
        let on_body = |c: Entity| get::<ColliderTransform>(app, c).translation;
        assert_eq!([collider, placed, offset].map(on_body), [Vector::ZERO, Vector::X, -Vector::X]);
    };
    check(&app);
    by_hand(&mut app, 64);
    check(&app);
    is_near(get::<Position>(&app, body).y, 0.5);
    // Also if the schedule around physics runs, with any change of the hierarchy.
    let parent = app.world_mut().spawn((RigidBody::Static, at(50.0, 0.0))).id();
    app.world_mut().entity_mut(collider).insert(ChildOf(parent));
    app.world_mut().run_schedule(FixedPostUpdate);
    check(&app);
    assert!(get::<Position>(&app, collider).0.distance(get::<Position>(&app, body).0) < 1.0e-4);
    app.world_mut().entity_mut(collider).remove::<ChildOf>();
    app.world_mut().run_schedule(FixedPostUpdate);
    check(&app);

    app.world_mut().entity_mut(collider).remove::<ColliderOf>();
    by_hand(&mut app, 64);
    assert_eq!(owner(&app, collider), None);
    is_near(get::<Position>(&app, body).y, 0.25);
    app.world_mut().entity_mut(body).despawn();
    assert!(app.world().get_entity(placed).is_err() && app.world().get_entity(collider).is_ok());
}

#[test]
fn issue_a_removed_collider_left_its_link_and_its_mass() {
    let mut app = app();
    floor(&mut app);
    let body = app.world_mut().spawn((RigidBody::Dynamic, ball(0.5), at(0.0, 0.5))).id();
    let part = app.world_mut().spawn((ball(0.5), at(1.0, 0.0), ChildOf(body))).id();
    by_hand(&mut app, 2);
    let unit = ColliderMassProperties::from_shape(&ball(0.5), 1.0).mass;
    for entity in [part, body] {
        app.world_mut().entity_mut(entity).remove::<Collider>();
        assert!(!app.world().entity(entity).contains::<ColliderMarker>());
        assert_eq!(owner(&app, entity), None);
        assert!(!listed(&app, body).contains(&entity));
    }
    app.world_mut().entity_mut(body).insert(Mass(2.0 * unit));
    by_hand(&mut app, 16);
    assert_eq!(mass(&app, body), 2.0 * unit);
    assert!(get::<Position>(&app, body).y < 0.3);
    app.world_mut().entity_mut(body).remove::<Mass>();
    by_hand(&mut app, 1);
    assert!(get::<ComputedMass>(&app, body).is_infinite());

    app.world_mut().entity_mut(body).insert((ball(0.5), Position(Vector::Y), LinearVelocity::ZERO));
    assert_eq!((owner(&app, body), listed(&app, body)), (Some(body), vec![body]));
    by_hand(&mut app, 128);
    assert_eq!(mass(&app, body), unit);
    is_near(get::<Position>(&app, body).y, 0.5);
}

/// The computed mass properties of a body.
fn weighed(app: &App, body: Entity) -> String {
    let (mass, center) = (get::<ComputedMass>(app, body), get::<ComputedCenterOfMass>(app, body));
    format!("{mass:?} {:?} {center:?}", get::<ComputedAngularInertia>(app, body))
}

#[test]
fn issue_colliders_below_a_body_weighed_nothing_until_the_next_step() {
    let mut app = app();
    let unit = ColliderMassProperties::from_shape(&ball(0.5), 1.0).mass;
    let part = |x: f32| (ball(0.5), at(x, 0.0));
    // The mass after the command equals the mass after the step.
    let check = |app: &mut App, body: Entity, parts: f32, center: f32| {
        let now = weighed(app, body);
        let (mass, at) = (mass(app, body), get::<ComputedCenterOfMass>(app, body).0.x);
        assert!((mass - parts * unit).abs() < 1.0e-4 * unit, "{mass} is not {parts} of {unit}");
        assert!((at - center).abs() < 1.0e-4, "{at} is not {center}");
        by_hand(app, 1);
        assert_eq!(now, weighed(app, body));
    };
    let body = app.world_mut().spawn((RigidBody::Dynamic, at(3.0, 2.0))).with_child(part(1.0)).id();
    check(&mut app, body, 1.0, 1.0);
    let later = app.world_mut().spawn((part(-2.0), ChildOf(body))).id();
    check(&mut app, body, 2.0, -0.5);
    app.world_mut().entity_mut(later).insert(Sensor);
    check(&mut app, body, 1.0, 1.0);
    app.world_mut().entity_mut(later).remove::<Sensor>();
    check(&mut app, body, 2.0, -0.5);
    app.world_mut().entity_mut(later).insert(ColliderDensity(3.0));
    check(&mut app, body, 4.0, -1.25);
    app.world_mut().entity_mut(later).insert((ball(0.25), ColliderDensity(1.0)));
    let small = ColliderMassProperties::from_shape(&ball(0.25), 1.0).mass / unit;
    check(&mut app, body, 1.0 + small, (1.0 - 2.0 * small) / (1.0 + small));
    app.world_mut().entity_mut(later).insert(ColliderDisabled);
    check(&mut app, body, 1.0, 1.0);
    app.world_mut().entity_mut(later).remove::<ColliderDisabled>().insert(ball(0.5));
    check(&mut app, body, 2.0, -0.5);

    let other = app.world_mut().spawn((RigidBody::Dynamic, at(-30.0, 2.0), part(0.0).0)).id();
    app.world_mut().entity_mut(later).insert(ChildOf(other));
    check(&mut app, body, 1.0, 1.0);
    check(&mut app, other, 2.0, -1.0);
    app.world_mut().entity_mut(later).despawn();
    check(&mut app, other, 1.0, 0.0);
    // Includes the body's own collider.
    app.world_mut().entity_mut(other).insert(ColliderDensity(2.0));
    check(&mut app, other, 2.0, 0.0);
    app.world_mut().entity_mut(other).remove::<Collider>();
    assert!(get::<ComputedMass>(&app, other).is_infinite(), "nothing is left of it");
}

#[test]
fn a_body_of_hundreds_of_colliders_weighs_what_they_do_in_the_next_step() {
    let mut app = app();
    let body = app.world_mut().spawn((RigidBody::Dynamic, at(0.0, 50.0))).id();
    for i in 0..300 {
        app.world_mut().spawn((ball(0.5), at(i as f32, 0.0), ChildOf(body)));
    }
    by_hand(&mut app, 1);
    let unit = ColliderMassProperties::from_shape(&ball(0.5), 1.0).mass;
    assert!((mass(&app, body) / (300.0 * unit) - 1.0).abs() < 1.0e-4);
}
