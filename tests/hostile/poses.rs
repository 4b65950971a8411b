//! Invalid positions, directions and speeds: only the body with them is quarantined.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_transform::{TransformPlugin, components::Transform};

use super::{
    dim,
    world::{WRONG, Witness, at, ball, block, is_disabled, position, resting, steps},
};

#[test]
fn a_position_that_is_not_finite_is_put_back_and_its_body_disabled() {
    for wrong in WRONG {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let ill = witness.spawn((body, ball(), at(0.0, 0.5)));
            let neighbour = witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 1.5)));
            steps(&mut witness.app, 5);
            witness.insert(ill, Position(Vector::X * wrong));
            witness.is_undisturbed();
            assert!(is_disabled(&witness.app, ill), "{body:?} at {wrong}");
            assert!(position(&witness.app, ill).length() < 1.0);
            let place = position(&witness.app, neighbour);
            assert!(place.y > 0.4 && place.y < 1.6 && place.x.abs() < 5.0, "the neighbour is at {place}");
            // With a finite pose it takes part again.
            witness.app.world_mut().entity_mut(ill).remove::<RigidBodyDisabled>();
            witness.insert(ill, (Position(Vector::Y * 3.0), LinearVelocity(Vector::ZERO)));
            steps(&mut witness.app, 10);
            assert_eq!(position(&witness.app, ill).y < 2.9, body.is_dynamic());
        }
    }
}

#[test]
fn a_body_spawned_where_no_place_is_does_not_enter() {
    for wrong in WRONG {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let ill = witness.spawn((body, ball(), Position(Vector::Y * wrong)));
            witness.spawn((body, ball(), Transform::from_xyz(f32::NAN, 0.0, 0.0)));
            witness.is_undisturbed();
            assert!(is_disabled(&witness.app, ill), "{body:?} at {wrong}");
        }
    }
}

#[test]
fn a_velocity_that_is_not_finite_stops_its_body_and_no_other() {
    for wrong in WRONG {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let ill = witness.spawn((body, ball(), at(0.0, 0.5)));
            let neighbour = witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 1.5)));
            steps(&mut witness.app, 5);
            witness.insert(ill, LinearVelocity(Vector::Y * wrong));
            witness.is_undisturbed();
            assert!(is_disabled(&witness.app, ill), "{body:?} with {wrong} m/s");
            let [own, place] = [ill, neighbour].map(|body| position(&witness.app, body));
            assert!(own.length() < 1.0, "{body:?} with {wrong} m/s is at {own}");
            assert!(place.y > 0.4 && place.y < 1.6 && place.x.abs() < 5.0, "the neighbour is at {place}");
            let velocity = witness.app.world().get::<LinearVelocity>(ill).expect("a body has a velocity");
            assert_eq!(velocity.0, Vector::ZERO);
        }
    }
}

#[test]
fn an_angular_velocity_that_is_not_finite_stops_its_body_and_no_other() {
    for wrong in WRONG {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let late = witness.spawn((body, ball(), at(0.0, 0.5)));
            let early = witness.spawn((body, ball(), at(5.0, 0.5), dim::spin(wrong)));
            steps(&mut witness.app, 5);
            witness.insert(late, dim::spin(wrong));
            witness.is_undisturbed();
            for ill in [late, early] {
                assert!(is_disabled(&witness.app, ill), "{body:?} with {wrong} rad/s");
                assert!(position(&witness.app, ill).is_finite());
            }
        }
    }
}

#[test]
fn a_rotation_without_direction_disables_its_body() {
    for wrong in [Scalar::NAN, Scalar::INFINITY, 0.0] {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let rotation = dim::scaled(wrong);
            let early = witness.spawn((body, block(), at(0.0, 0.5), rotation));
            let late = witness.spawn((body, block(), at(5.0, 0.5)));
            steps(&mut witness.app, 5);
            witness.insert(late, rotation);
            witness.is_undisturbed();
            assert!([early, late].iter().all(|e| is_disabled(&witness.app, *e)), "{body:?} by {wrong}");
            let held = *witness.app.world().get::<Rotation>(late).expect("a body has a rotation");
            assert!((held * Vector::X - Vector::X).length() < 1.0e-3, "it is put back: {held:?}");
        }
    }
}

#[test]
fn a_rotation_of_another_length_is_one_of_unit_length() {
    for length in [0.5, 2.0, 1.0e-9, 1.0e9] {
        let mut witness = Witness::new();
        // Only the blocks on it wake.
        let apart = CollisionLayers::new(2, 2);
        let table = (RigidBody::Static, block(), dim::scaled(length), Position(Vector::Y * 3.0), apart);
        witness.spawn(table);
        let on_it = witness.spawn((RigidBody::Dynamic, block(), dim::scaled(length), at(0.0, 4.0), apart));
        let body = witness.spawn((RigidBody::Dynamic, block(), dim::scaled(length), at(5.0, 0.5)));
        steps(&mut witness.app, 10);
        witness.insert(body, dim::scaled(length));
        witness.is_undisturbed();
        for (entity, y) in [(on_it, 4.0), (body, 0.5)] {
            assert!(!is_disabled(&witness.app, entity));
            let off = position(&witness.app, entity).y - y;
            assert!(off.abs() < 0.02, "with a length of {length} it is off by {off}");
            // The value is given once: it does not count as a change in every step.
            assert!(witness.app.world().get::<Sleeping>(entity).is_some(), "{length}");
        }
    }
}

#[test]
fn without_the_sync_a_body_with_a_position_alone_is_not_turned() {
    for body in [RigidBody::Dynamic, RigidBody::Static] {
        let mut app = App::new();
        let plugins = PhysicsPlugins::new(Update).build().disable::<PhysicsTransformPlugin>();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, plugins));
        app.finish();
        app.cleanup();
        app.insert_resource(Gravity::ZERO);
        // Without the plugin no component requires them.
        let pose = (Position(Vector::Y), Rotation::PLACEHOLDER);
        let block = app.world_mut().spawn((body, block(), pose, Transform::IDENTITY)).id();
        let child = app.world_mut().spawn((ball(), at(0.0, 3.0), ChildOf(block))).id();
        steps(&mut app, 10);
        assert!(!is_disabled(&app, block));
        assert_eq!(position(&app, block), Vector::Y);
        assert_eq!(position(&app, child), Vector::Y * 4.0);
        let aabb = app.world().get::<ColliderAabb>(block).expect("a collider has a box");
        assert!((aabb.max - aabb.min - Vector::ONE).length() < 1.0e-4, "{aabb:?}");
    }
}

/// The box of a collider.
fn aabb(app: &App, entity: Entity) -> ColliderAabb {
    *app.world().get(entity).expect("a collider has a box")
}

#[test]
fn a_collider_whose_place_is_not_finite_takes_no_part_until_it_is() {
    for wrong in WRONG {
        let mut witness = Witness::new();
        let alone = witness.spawn((ball(), Position(Vector::X * wrong), Sensor));
        let moved = witness.spawn((ball(), at(3.0, 3.0), Sensor));
        let body = witness.spawn((RigidBody::Kinematic, LinearVelocity(Vector::Y), at(0.0, 9.0)));
        let child = witness.spawn((ball(), Transform::IDENTITY, ChildOf(body)));
        steps(&mut witness.app, 2);
        let offset = Transform::from_xyz(wrong as f32, 0.0, 0.0);
        witness.insert(moved, Position(Vector::X * wrong));
        witness.insert(child, offset);
        witness.is_undisturbed();
        for collider in [moved, child] {
            let aabb = aabb(&witness.app, collider);
            assert!(aabb.min.is_finite() && aabb.max.is_finite(), "{aabb:?} at {wrong}");
        }
        witness.insert(alone, Position(Vector::X * 7.0));
        witness.insert(moved, Position(Vector::X * 8.0));
        witness.insert(child, at(9.0, 0.0));
        witness.is_undisturbed();
        for (collider, x) in [(alone, 7.0), (moved, 8.0), (child, 9.0)] {
            let aabb = aabb(&witness.app, collider);
            assert!((aabb.min.x - x + 0.5).abs() < 0.01, "{aabb:?} should be about {x}");
        }
    }
}

#[test]
fn a_sleeping_body_with_a_velocity_of_nan_is_quarantined() {
    let mut witness = Witness::new();
    let ill = resting(&mut witness.app, 0.0);
    steps(&mut witness.app, 120);
    assert!(witness.app.world().get::<Sleeping>(ill).is_some());
    witness.insert(ill, LinearVelocity(Vector::splat(Scalar::NAN)));
    witness.is_undisturbed();
    assert!(is_disabled(&witness.app, ill));
}

#[test]
fn speeds_and_distances_near_the_limits_of_floats_stay_with_their_body() {
    for huge in [1.0e12, 1.0e19, 1.0e30, 3.0e38] {
        let mut witness = Witness::new();
        witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 0.5), LinearVelocity(Vector::X * huge)));
        witness.spawn((RigidBody::Kinematic, ball(), at(3.0, 0.5), LinearVelocity(Vector::NEG_Y * huge)));
        witness.spawn((RigidBody::Dynamic, ball(), Position(Vector::X * huge)));
        witness.spawn((RigidBody::Dynamic, ball(), Position(Vector::NEG_X * huge)));
        witness.is_undisturbed();
    }
}
