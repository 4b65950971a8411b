//! A level with its colliders, saved and loaded by Bevy's worlds. Keys: S saves, L loads, space throws a ball. Save, throw some
//! balls, and load: look at the towers, which stand again as they were saved. The log says how many bytes were written, and how
//! far the loaded bodies are from the saved ones.
//!
//! `cargo run --release -p examples3d --example save_and_load`

use avian3d::prelude::*;
use bevy::{
    ecs::{entity::EntityHashMap, reflect::AppTypeRegistry},
    prelude::*,
    world_serialization::serde::WorldDeserializer,
};
use examples3d::Scenery;
use serde::de::DeserializeSeed;

fn main() {
    let scenery = Scenery::new(Vec3::new(6.0, 6.0, 12.0), Vec3::new(0.0, 1.5, 0.0));
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin, scenery))
        .init_resource::<Saved>()
        .add_systems(Startup, setup)
        .add_systems(Update, (throw, save_and_load).chain())
        .run();
}

/// The file, and where bodies were when it was written. A game writes the text to a disk.
#[derive(Resource, Default)]
struct Saved {
    text: String,
    places: Vec<(Entity, Position)>,
}

/// What is saved: all that has a body.
type OfLevel = With<RigidBody>;

fn setup(mut commands: Commands) {
    commands.spawn((
        Text::new("S save   L load   space throw"),
        Node { margin: UiRect::all(Val::Px(8.0)), ..default() },
    ));
    commands.spawn((
        RigidBody::Static,
        Collider::cuboid(20.0, 1.0, 20.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
    ));
    let shapes = [
        Collider::cuboid(1.0, 0.6, 1.0),
        Collider::cylinder(0.5, 0.6),
        Collider::compound(vec![
            (Vec3::X * 0.3, Quat::IDENTITY, Collider::cuboid(0.4, 0.6, 1.0)),
            (Vec3::NEG_X * 0.3, Quat::IDENTITY, Collider::cuboid(0.4, 0.6, 1.0)),
        ]),
    ];
    for (column, shape) in shapes.iter().enumerate() {
        for row in 0..5 {
            let at = Vec3::new(2.0 * column as f32 - 2.0, 0.3 + 0.6 * row as f32, 0.0);
            commands.spawn((RigidBody::Dynamic, shape.clone(), Transform::from_translation(at)));
        }
    }
}

fn throw(keys: Res<ButtonInput<KeyCode>>, mut commands: Commands, mut column: Local<i32>) {
    if keys.just_pressed(KeyCode::Space) {
        *column = (*column + 1) % 3;
        let from = Transform::from_xyz(2.0 * *column as f32 - 2.0, 2.0, 8.0);
        let heavy = ColliderDensity(5.0);
        commands.spawn((
            RigidBody::Dynamic,
            Collider::sphere(0.4),
            heavy,
            LinearVelocity(Vec3::NEG_Z * 15.0),
            from,
        ));
    }
}

fn save_and_load(world: &mut World) {
    let keys = world.resource::<ButtonInput<KeyCode>>();
    let (saves, loads) = (keys.just_pressed(KeyCode::KeyS), keys.just_pressed(KeyCode::KeyL));
    if !saves && !loads {
        return;
    }
    let mut level = world.query_filtered::<(Entity, &Position), OfLevel>();
    let places: Vec<_> = level.iter(world).map(|(entity, place)| (entity, *place)).collect();
    if saves {
        match save(world, places.clone()) {
            Ok(saved) => {
                info!("saved {} bodies in {} bytes", saved.places.len(), saved.text.len());
                world.insert_resource(saved);
            }
            Err(error) => error!("not saved: {error}"),
        }
    }
    if loads {
        let text = world.resource::<Saved>().text.clone();
        // A damaged file is an error, and leaves the level as it is.
        match read(world, &text) {
            Ok(loaded) => replace(world, &loaded, places),
            Err(error) => error!("not loaded: {error}"),
        }
    }
}

/// The level as text: everything that its entities have and that is reflected.
fn save(world: &World, places: Vec<(Entity, Position)>) -> Result<Saved, ron::Error> {
    let registry = world.resource::<AppTypeRegistry>().read();
    let level = DynamicWorldBuilder::from_world(world, &registry)
        .allow_all()
        .extract_entities(places.iter().map(|(entity, _)| *entity))
        .build();
    Ok(Saved { text: level.serialize(&registry)?, places })
}

fn read(world: &World, text: &str) -> Result<DynamicWorld, ron::de::SpannedError> {
    let registry = world.resource::<AppTypeRegistry>().read();
    let mut assets = world.resource::<AssetServer>().clone();
    let seed = WorldDeserializer { type_registry: &registry, load_from_path: &mut assets };
    let mut reader = ron::de::Deserializer::from_str(text)?;
    seed.deserialize(&mut reader).map_err(|error| reader.span_error(error))
}

/// Despawns the level, spawns the loaded one, and compares it with what was saved.
fn replace(world: &mut World, loaded: &DynamicWorld, old: Vec<(Entity, Position)>) {
    for (entity, _) in old {
        world.despawn(entity);
    }
    let mut entities = EntityHashMap::default();
    if let Err(error) = loaded.write_to_world(world, &mut entities) {
        error!("not loaded: {error}");
        return;
    }
    let mut off: f32 = 0.0;
    let places = world.resource::<Saved>().places.clone();
    for (entity, place) in &places {
        let now = entities.get(entity).and_then(|entity| world.get::<Position>(*entity));
        off = off.max(now.map_or(f32::INFINITY, |now| now.distance(place.0)));
    }
    info!("loaded {} bodies, at most {off} m from where they were saved", entities.len());
}
