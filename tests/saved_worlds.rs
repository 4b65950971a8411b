//! Bevy's worlds in files: a level comes back with its colliders, which collide as before.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_asset::{AssetPlugin, AssetServer};
use bevy_ecs::{entity::EntityHashMap, prelude::*, reflect::AppTypeRegistry};
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use bevy_world_serialization::{DynamicWorld, DynamicWorldBuilder, serde::WorldDeserializer};
use core::time::Duration;
use scenes::dim::{ball, block};
use serde::de::DeserializeSeed;

use super::stored::{bits, pile};

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), AssetPlugin::default(), TransformPlugin));
    app.add_plugins(PhysicsPlugins::new(Update));
    app.register_type::<(Transform, ChildOf, Children)>();
    app.insert_resource(Gravity(-Vector::Y * 10.0));
    app.finish();
    app.cleanup();
    app
}

fn steps(app: &mut App, count: u32) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(16));
        app.update();
    }
}

/// A pile, and things of a level: a mesh, a line, a hinge, a sensor, and a part below a part.
fn level(app: &mut App) -> Vec<Entity> {
    let mut all = pile(app, 0);
    let corner = |x: Scalar, y: Scalar| Vector::X * x + Vector::Y * y;
    let corners = || vec![corner(-9.0, -2.0), corner(9.0, -2.0), corner(9.0, -1.0), corner(-9.0, -1.0)];
    let world = app.world_mut();
    let mut add = |bundle: (RigidBody, Collider, Transform)| world.spawn(bundle).id();
    let mesh = Collider::trimesh(corners(), vec![[0, 1, 2], [0, 2, 3]]);
    let at = Transform::from_xyz;
    all.push(add((RigidBody::Static, mesh, at(20.0, 0.0, 0.0))));
    all.push(add((RigidBody::Static, Collider::polyline(corners(), None), at(-20.0, 0.0, 0.0))));
    all.extend([20.0, -20.0].map(|x| add((RigidBody::Dynamic, ball(0.5), at(x, 1.0, 0.0)))));
    let post = add((RigidBody::Static, block(0.5, 0.5, 0.5), at(9.0, 6.0, 0.0)));
    let weight = add((RigidBody::Dynamic, block(0.5, 0.5, 0.5), at(11.0, 6.0, 0.0)));
    let hinge = RevoluteJoint::new(post, weight).with_local_anchor2(Vector::X * -2.0);
    let hinge = world.spawn(hinge).id();
    let zone = (Sensor, block(3.0, 3.0, 3.0), at(0.0, 1.0, 0.0), CollidingEntities::default());
    let layers = CollisionLayers::new([LayerMask(2)], [LayerMask(1), LayerMask(4)]);
    let zone = world.spawn((zone, layers)).id();
    let arm = world.spawn((at(0.5, 0.0, 0.0), ChildOf(weight))).id();
    let tip =
        world.spawn((ball(0.2), at(0.5, 0.0, 0.0).with_scale(bevy_math::Vec3::splat(1.5)), ChildOf(arm)));
    let tip = tip.id();
    all.extend([post, weight, hinge, zone, arm, tip]);
    all
}

fn save(app: &App, entities: &[Entity]) -> String {
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let level = DynamicWorldBuilder::from_world(app.world(), &registry).allow_all();
    let level = level.extract_entities(entities.iter().copied()).build();
    level.serialize(&registry).expect("all of it can be stored")
}

fn read(app: &App, text: &str) -> Result<DynamicWorld, String> {
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let mut assets = app.world().resource::<AssetServer>().clone();
    let seed = WorldDeserializer { type_registry: &registry, load_from_path: &mut assets };
    let mut text = ron::Deserializer::from_str(text).map_err(|error| error.to_string())?;
    seed.deserialize(&mut text).map_err(|error| error.to_string())
}

/// The entities in the order of those they were saved from. Bevy stores them in an order of its own; with
/// `sorts` they are spawned in that of the level, which is that of the engine's ids.
fn load(app: &mut App, text: &str, saved: &[Entity], sorts: bool) -> Vec<Entity> {
    let mut level = read(app, text).expect("was stored");
    if sorts {
        level.entities.sort_by_key(|stored| saved.iter().position(|entity| *entity == stored.entity));
    }
    let mut map = EntityHashMap::default();
    level.write_to_world(app.world_mut(), &mut map).expect("all types are registered");
    saved.iter().map(|entity| map[entity]).collect()
}

/// The state of all bodies as bits, and the places in `entities` of what is in the sensor.
fn state(app: &App, entities: &[Entity]) -> (Vec<String>, Vec<usize>) {
    let place = |entity: &Entity| entities.iter().position(|e| e == entity).expect("one of them");
    let colliding = entities.iter().filter_map(|entity| app.world().get::<CollidingEntities>(*entity));
    let mut told: Vec<usize> = colliding.flat_map(|told| told.iter().map(place)).collect();
    told.sort_unstable();
    (bits(app, entities), told)
}

#[test]
fn a_level_comes_back_with_its_colliders_and_runs_with_the_same_bits() {
    let mut first = app();
    let level = level(&mut first);
    let text = save(&first, &level);
    assert_eq!(text.matches("::Collider\": ").count(), level.len() - 2, "a joint and an arm have none");
    // Beside other things, which shift the ids of entities.
    let mut again = app();
    (0..7).for_each(|_| _ = again.world_mut().spawn_empty());
    let loaded = load(&mut again, &text, &level, true);
    for step in 0..15 {
        steps(&mut first, 10);
        steps(&mut again, 10);
        let [expected, found] = [state(&first, &level), state(&again, &loaded)];
        assert!(expected == found, "after {} steps: {expected:?}, {found:?}", 10 * (step + 1));
    }
    for (old, new) in level.iter().zip(&loaded) {
        let shape = |app: &App, entity: &Entity| {
            let collider = app.world().get::<Collider>(*entity)?;
            Some((format!("{:?}", collider.shape_scaled().as_typed_shape()), collider.scale()))
        };
        assert_eq!(shape(&first, old), shape(&again, new));
    }
    assert!(!state(&again, &loaded).1.is_empty(), "bodies fell into the sensor");
    let of = |entity: Entity| again.world().get::<ColliderOf>(entity).map(|of| of.body);
    assert_eq!(of(loaded[level.len() - 1]), Some(loaded[level.len() - 5]), "the tip is the weight's");
    assert_eq!(save(&again, &loaded).len() / 1000, save(&first, &level).len() / 1000);
}

/// Saved in the middle of its motion, and loaded into the app that it came from.
#[test]
fn a_running_level_comes_back_as_it_was() {
    let mut app = app();
    let level = level(&mut app);
    steps(&mut app, 40);
    let (text, expected) = (save(&app, &level), bits(&app, &level));
    steps(&mut app, 20);
    level.iter().for_each(|entity| _ = app.world_mut().try_despawn(*entity));
    steps(&mut app, 1);
    let loaded = load(&mut app, &text, &level, false);
    assert_eq!(bits(&app, &loaded), expected);
    steps(&mut app, 200);
    let heights = loaded.iter().filter_map(|entity| app.world().get::<Position>(*entity)).map(|p| p.y);
    assert!(heights.fold(0.0, |a: Scalar, b| a.min(b)) > -2.1, "none fell through the floor");
    // A file gives the same world each time.
    let [once, twice] = [(); 2].map(|()| {
        let mut app = self::app();
        let loaded = load(&mut app, &text, &level, false);
        steps(&mut app, 100);
        bits(&app, &loaded)
    });
    assert!(once == twice && once != expected);
}

#[test]
fn files_that_make_no_shapes_are_errors() {
    let mut first = app();
    let corners = || vec![Vector::X, Vector::Y, -Vector::X, Vector::ONE * -1.0];
    let both =
        vec![(Vector::X, Rotation::default(), ball(0.3)), (-Vector::X, Rotation::default(), ball(0.2))];
    let shapes = [
        block(0.7, 0.5, 0.6),
        Collider::capsule(0.2, 0.5),
        Collider::compound(both),
        Collider::trimesh(corners(), vec![[0, 1, 2], [0, 2, 3]]),
        Collider::polyline(corners(), None),
    ];
    let level = shapes.map(|shape| first.world_mut().spawn((RigidBody::Static, shape)).id());
    let text = save(&first, &level);
    // Each number of a collider in turn, and the file cut off there.
    let mut found = text.match_indices("::Collider\": ").map(|(at, _)| at);
    let (mut refused, mut tried) = (0, 0);
    let mut reader = app();
    for (i, start) in found.by_ref().enumerate() {
        let end = start + text[start..].find("::CollisionLayers").unwrap_or(text.len() - start);
        let is_digit = |c: char| c.is_ascii_digit();
        let numbers = text[start..end].split_inclusive(|c: char| !(is_digit(c) || ".-e".contains(c)));
        let mut at = start;
        for (k, word) in numbers.enumerate() {
            let length = word.trim_end_matches(|c: char| !is_digit(c)).len();
            let begin = at;
            at += word.len();
            if length == 0 || !word.starts_with(|c: char| is_digit(c) || c == '-') || (k + i) % 2 != 0 {
                continue;
            }
            for wrong in ["NaN", "inf", "-1.0", "1e30", "0", "4000000000", "\"text\"", "("] {
                let bad = format!("{}{wrong}{}", &text[..begin], &text[begin + length..]);
                tried += 1;
                refused += u32::from(read(&reader, &bad).is_err());
            }
            assert!(read(&reader, &text[..begin]).is_err());
        }
    }
    // The others are shapes, too: of another size or at another place.
    assert!(tried > 200 && refused > tried / 2, "{refused} of {tried}");
    assert!(read(&reader, &text.replace("::Collider\"", "::Kollider\"")).is_err());
    load(&mut reader, &text, &level, false);
    steps(&mut reader, 3);
}
