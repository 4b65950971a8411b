//! Colliders from constructors: shapes, frames in which they appear, events, and errors.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{Scalar, Vector},
    parry::shape::SharedShape,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_asset::{AssetApp, AssetPlugin, Assets, Handle, RenderAssetUsages};
use bevy_ecs::{
    prelude::*,
    reflect::{AppTypeRegistry, ReflectCommandExt},
};
use bevy_log::tracing_subscriber::{self, util::SubscriberInitExt};
use bevy_mesh::{Indices, Mesh, MeshPlugin, PrimitiveTopology};
use bevy_reflect::{TypePath, serde::ReflectDeserializer};
use bevy_time::Time;
use bevy_transform::TransformPlugin;
use serde::de::DeserializeSeed;
use std::{
    io::Write,
    sync::{Arc, Mutex},
    time::Duration,
};

use super::constructors_dim::{MeshComponent, describes, made_of, shape_of_mesh, wrong};

/// What was told, in order.
#[derive(Resource, Default)]
pub struct Log(Vec<Said>);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Said {
    Made(Entity),
    AllMade(Entity),
}
use Said::*;

/// An app without assets.
pub fn headless() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)))
        .init_resource::<Log>()
        .insert_resource(Gravity::ZERO)
        .add_observer(|on: On<ColliderConstructorReady>, mut log: ResMut<Log>| log.0.push(Made(on.entity)))
        .add_observer(|on: On<ColliderConstructorHierarchyReady>, mut log: ResMut<Log>| {
            log.0.push(AllMade(on.entity));
        });
    app
}

/// An app with meshes.
pub fn app() -> App {
    let mut app = headless();
    app.add_plugins((AssetPlugin::default(), MeshPlugin));
    start(&mut app);
    app
}

pub fn start(app: &mut App) {
    app.finish();
    app.cleanup();
}

pub fn frames(app: &mut App, count: u32) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(16));
        app.update();
    }
}

/// What was told since the last call.
pub fn said(app: &mut App) -> Vec<Said> {
    core::mem::take(&mut app.world_mut().resource_mut::<Log>().0)
}

pub fn add(app: &mut App, mesh: Mesh) -> Handle<Mesh> {
    app.world_mut().resource_mut::<Assets<Mesh>>().add(mesh)
}

/// What a shape is made of.
fn text(collider: &Collider) -> String {
    ron::to_string(collider).expect("shapes of constructors can be stored")
}

fn collider(app: &App, entity: Entity) -> Option<&Collider> {
    app.world().get::<Collider>(entity)
}

fn waits(app: &App, entity: Entity) -> bool {
    app.world().entity(entity).contains::<ColliderConstructor>()
}

fn ball(radius: Scalar) -> ColliderConstructor {
    ColliderConstructor::CapsuleEndpoints { radius, a: Vector::ZERO, b: Vector::X * 0.1 }
}

/// The half size of a collider's box along X.
fn half(collider: &Collider) -> Scalar {
    collider.aabb(Vector::ZERO, Rotation::default()).size().x * 0.5
}

/// The warnings that a closure gives on this thread.
pub fn warnings(run: impl FnOnce()) -> Vec<String> {
    #[derive(Clone, Default)]
    struct Lines(Arc<Mutex<Vec<u8>>>);
    impl Write for Lines {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().expect("no panic").extend_from_slice(bytes);
            Ok(bytes.len())
        }
        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }
    let lines = Lines::default();
    let writer = lines.clone();
    let subscriber = tracing_subscriber::fmt().with_writer(move || writer.clone()).with_ansi(false);
    let guard = subscriber.finish().set_default();
    run();
    drop(guard);
    let bytes = lines.0.lock().expect("no panic").clone();
    let text = String::from_utf8(bytes).expect("text");
    text.lines().filter(|line| line.contains("WARN")).map(str::to_owned).collect()
}

#[test]
fn every_constructor_makes_the_collider_of_its_function() {
    let mut app = app();
    let pairs = describes();
    let spawned: Vec<_> = pairs.iter().map(|(data, _)| app.world_mut().spawn(data.clone()).id()).collect();
    frames(&mut app, 1);
    for ((data, expected), entity) in pairs.iter().zip(&spawned) {
        let direct = Collider::try_from_constructor(data.clone(), None).expect("a shape");
        assert_eq!(text(&direct), text(expected), "{data:?}");
        let made = collider(&app, *entity).expect("in the frame in which it was spawned");
        assert_eq!(text(made), text(expected), "{data:?}");
        assert!(!waits(&app, *entity) && !data.requires_mesh());
    }
    let mut told = said(&mut app);
    told.sort_by_key(|said| format!("{said:?}"));
    let mut expected: Vec<_> = spawned.iter().map(|entity| Made(*entity)).collect();
    expected.sort_by_key(|said| format!("{said:?}"));
    assert_eq!(told, expected, "each once");
    frames(&mut app, 3);
    assert!(said(&mut app).is_empty());
}

#[test]
fn compounds_of_constructors_may_be_nested() {
    let at = |x: Scalar| Vector::X * x;
    let inner = ColliderConstructor::compound(vec![(at(2.0), Rotation::default(), ball(0.5))]);
    let outer = ColliderConstructor::compound(vec![
        (at(3.0), Rotation::default(), inner),
        (at(-1.0), Rotation::default(), ball(0.25)),
    ]);
    let made = Collider::try_from_constructor(outer, None).expect("two capsules");
    let bounds = made.aabb(Vector::ZERO, Rotation::default());
    assert!((bounds.max.x - 5.6).abs() < 1.0e-5 && (bounds.min.x + 1.25).abs() < 1.0e-5, "{bounds:?}");
    let of_mesh = ColliderConstructor::compound(vec![(
        at(0.0),
        Rotation::default(),
        ColliderConstructor::TrimeshFromMesh,
    )]);
    assert!(of_mesh.requires_mesh());
}

#[test]
fn constructors_of_no_shape_give_one_warning_with_the_name_and_nothing_else() {
    let mut hostile = wrong();
    let nan = Scalar::NAN;
    for radius in [0.0, -1.0, nan, Scalar::INFINITY, 1.0e30] {
        hostile.push(ball(radius));
        hostile.push(ColliderConstructor::Capsule { radius, height: 1.0 });
        hostile.push(ColliderConstructor::compound(vec![(Vector::ZERO, Rotation::default(), ball(radius))]));
        let normal = if radius > 1.0 { Vector::splat(nan) } else { Vector::ZERO };
        hostile.push(ColliderConstructor::HalfSpace { outward_normal: normal });
    }
    hostile.extend([
        ColliderConstructor::Segment { a: Vector::ONE, b: Vector::ONE },
        ColliderConstructor::Triangle { a: Vector::ZERO, b: Vector::X, c: Vector::X * 2.0 },
        ColliderConstructor::Triangle { a: Vector::ZERO, b: Vector::X, c: Vector::splat(nan) },
        ColliderConstructor::Polyline { vertices: vec![], indices: None },
        ColliderConstructor::Polyline { vertices: vec![Vector::ZERO; 2], indices: Some(vec![[0, 7]]) },
        ColliderConstructor::Trimesh { vertices: vec![], indices: vec![] },
        ColliderConstructor::Trimesh {
            vertices: vec![Vector::X; 3],
            indices: vec![[0, 1, 1], [0, 1, u32::MAX]],
        },
        ColliderConstructor::ConvexHull { points: vec![Vector::ZERO, Vector::X, Vector::X * 2.0] },
        ColliderConstructor::Voxels { voxel_size: Vector::ZERO, grid_coordinates: vec![] },
        ColliderConstructor::Voxels { voxel_size: Vector::ONE, grid_coordinates: vec![] },
        ColliderConstructor::Compound(vec![]),
        ColliderConstructor::compound(vec![(Vector::splat(nan), Rotation::default(), ball(1.0))]),
    ]);
    for data in hostile {
        assert!(Collider::try_from_constructor(data.clone(), None).is_none(), "{data:?}");
        let mut app = app();
        let entity = app.world_mut().spawn((Name::new("Sphinx"), RigidBody::Static, data.clone())).id();
        let given = warnings(|| frames(&mut app, 3));
        assert!(given.len() == 1 && given[0].contains("Sphinx"), "{data:?}: {given:#?}");
        assert!(collider(&app, entity).is_none() && !waits(&app, entity), "{data:?}");
        assert!(said(&mut app).is_empty());
    }
}

#[test]
fn a_constructor_replaces_the_collider_and_can_come_again() {
    let mut app = app();
    let entity = app.world_mut().spawn((Collider::capsule(3.0, 1.0), ball(1.0))).id();
    frames(&mut app, 1);
    assert!((half(collider(&app, entity).expect("a collider")) - 1.05).abs() < 1.0e-5);
    app.world_mut().entity_mut(entity).insert(ball(2.0));
    frames(&mut app, 1);
    assert!((half(collider(&app, entity).expect("a collider")) - 2.05).abs() < 1.0e-5);
    assert_eq!(said(&mut app), [Made(entity); 2]);
}

#[test]
fn colliders_are_made_while_physics_is_paused_and_fall_afterwards() {
    let mut app = app();
    app.insert_resource(Gravity(Vector::NEG_Y * 10.0));
    app.world_mut().resource_mut::<Time<Physics>>().pause();
    let body = app.world_mut().spawn((RigidBody::Dynamic, ball(0.5))).id();
    frames(&mut app, 2);
    assert_eq!(said(&mut app), [Made(body)]);
    assert!(
        app.world().get::<ComputedMass>(body).expect("a body").value() > 0.1,
        "it has the collider's mass"
    );
    app.world_mut().resource_mut::<Time<Physics>>().unpause();
    frames(&mut app, 10);
    assert!(app.world().get::<Position>(body).expect("a body").y < -0.05);
}

#[test]
fn apps_without_assets_make_colliders_and_tell_what_they_lack() {
    for (assets, meshes) in [(false, false), (true, false), (true, true)] {
        let mut app = headless();
        if assets {
            app.add_plugins(AssetPlugin::default());
        }
        if meshes {
            app.init_asset::<Mesh>();
        }
        start(&mut app);
        let plain = app.world_mut().spawn(ball(0.5)).id();
        let component = MeshComponent(Handle::default());
        let of_mesh = (Name::new("Sphinx"), component, ColliderConstructor::ConvexHullFromMesh);
        let of_mesh = app.world_mut().spawn(of_mesh).id();
        let without = (Name::new("Riddle"), ColliderConstructor::ConvexHullFromMesh);
        let without = app.world_mut().spawn(without).id();
        let given = warnings(|| frames(&mut app, 4));
        assert!(collider(&app, plain).is_some());
        assert_eq!(said(&mut app), [Made(plain)]);
        assert_eq!(given.len(), 2, "{given:#?}");
        assert!(
            given.iter().any(|line| line.contains("Sphinx")) && given.iter().any(|l| l.contains("Riddle"))
        );
        assert_eq!((waits(&app, of_mesh), waits(&app, without)), (meshes, true));
    }
}

/// Half of a cube's surface, or of a square's outline, and more.
fn tetrahedron() -> Mesh {
    let positions = vec![[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]];
    Mesh::new(PrimitiveTopology::TriangleList, RenderAssetUsages::default())
        .with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, positions)
        .with_inserted_indices(Indices::U16(vec![0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]))
}

#[test]
fn constructors_from_meshes_make_what_their_functions_make() {
    for mesh in shape_of_mesh() {
        let mut app = app();
        let handle = add(&mut app, mesh.clone());
        for (data, expected) in made_of(&mesh) {
            assert!(data.requires_mesh());
            let entity = app.world_mut().spawn((MeshComponent(handle.clone()), data.clone())).id();
            frames(&mut app, 1);
            let made = collider(&app, entity).expect("the mesh is there");
            assert_eq!(text(made), text(&expected), "{data:?}");
            assert_eq!(said(&mut app), [Made(entity)]);
            assert!(Collider::try_from_constructor(data, None).is_none(), "without a mesh");
        }
    }
}

#[test]
fn a_mesh_that_is_not_there_yet_is_waited_for() {
    let mut app = app();
    let handle = app.world().resource::<Assets<Mesh>>().reserve_handle();
    let hull = || ColliderConstructor::ConvexHullFromMesh;
    let spawn = |app: &mut App| app.world_mut().spawn((MeshComponent(handle.clone()), hull())).id();
    let [patient, removed, despawned] = [(); 3].map(|()| spawn(&mut app));
    let late = app.world_mut().spawn(hull()).id();
    let given = warnings(|| frames(&mut app, 3));
    assert_eq!(given.len(), 4, "one each: {given:#?}");
    assert!([patient, removed, late].iter().all(|entity| waits(&app, *entity)));
    app.world_mut().entity_mut(removed).remove::<ColliderConstructor>();
    app.world_mut().despawn(despawned);
    app.world_mut().entity_mut(late).insert(MeshComponent(handle.clone()));
    frames(&mut app, 2);
    assert!(said(&mut app).is_empty());
    app.world_mut().resource_mut::<Assets<Mesh>>().insert(&handle, tetrahedron()).expect("it was reserved");
    let given = warnings(|| frames(&mut app, 3));
    assert!(given.is_empty(), "{given:#?}");
    let mut told = said(&mut app);
    told.sort_by_key(|said| format!("{said:?}"));
    let mut expected = [Made(patient), Made(late)];
    expected.sort_by_key(|said| format!("{said:?}"));
    assert_eq!(told, expected);
    assert!(collider(&app, removed).is_none() && collider(&app, patient).is_some());
}

#[test]
fn meshes_of_no_shape_give_one_warning() {
    let plain = |topology| Mesh::new(topology, RenderAssetUsages::default());
    let list = || plain(PrimitiveTopology::TriangleList);
    let with =
        |mesh: Mesh, points: Vec<[f32; 3]>| mesh.with_inserted_attribute(Mesh::ATTRIBUTE_POSITION, points);
    let mut taken = tetrahedron();
    taken.take_gpu_data().expect("it has data");
    let meshes = [
        list(),
        with(list(), vec![]),
        with(list(), vec![[f32::NAN; 3]; 3]),
        with(list(), vec![[0.0; 3]; 3]).with_inserted_indices(Indices::U32(vec![0, 1, 9, u32::MAX, 1, 2])),
        with(list(), vec![[0.0; 3]; 2]),
        with(plain(PrimitiveTopology::LineList), vec![[0.0; 3], [1.0, 0.0, 0.0]]),
        with(plain(PrimitiveTopology::TriangleStrip), vec![[0.0; 3], [1.0, 0.0, 0.0]]),
        taken,
    ];
    let fill_mode = FillMode::SurfaceOnly;
    for (i, mesh) in meshes.into_iter().enumerate() {
        for data in [
            ColliderConstructor::TrimeshFromMesh,
            ColliderConstructor::ConvexHullFromMesh,
            ColliderConstructor::ConvexDecompositionFromMesh,
            ColliderConstructor::VoxelizedTrimeshFromMesh { voxel_size: 0.1, fill_mode },
        ] {
            let mut app = app();
            let mesh = MeshComponent(add(&mut app, mesh.clone()));
            let entity = app.world_mut().spawn((Name::new("Sphinx"), mesh, data.clone())).id();
            let given = warnings(|| frames(&mut app, 3));
            assert!(given.len() == 1 && given[0].contains("Sphinx"), "{i} {data:?}: {given:#?}");
            assert!(!waits(&app, entity) && collider(&app, entity).is_none());
        }
    }
    for voxel_size in [0.0, -1.0, Scalar::NAN, 1.0e-4 * 0.1, Scalar::INFINITY] {
        assert!(Collider::voxelized_trimesh_from_mesh(&tetrahedron(), voxel_size, fill_mode).is_none());
    }
}

fn shape(app: &App, entity: Entity) -> &SharedShape {
    collider(app, entity).expect("a collider").shape()
}

fn is_shared(app: &App, a: Entity, b: Entity) -> bool {
    Arc::ptr_eq(&shape(app, a).0, &shape(app, b).0)
}

#[test]
fn entities_with_the_same_mesh_share_a_shape_until_the_mesh_changes() {
    let mut app = app();
    let handle = add(&mut app, tetrahedron());
    let data = ColliderConstructor::TrimeshFromMesh;
    let spawn = |app: &mut App, data: &ColliderConstructor| {
        app.world_mut().spawn((MeshComponent(handle.clone()), data.clone())).id()
    };
    let (one, two) = (spawn(&mut app, &data), spawn(&mut app, &data));
    let hull = spawn(&mut app, &ColliderConstructor::ConvexHullFromMesh);
    frames(&mut app, 5);
    assert!(is_shared(&app, one, two) && !is_shared(&app, one, hull));
    let mut scaled = spawn(&mut app, &data);
    frames(&mut app, 1);
    let first = shape(&app, scaled).clone();
    let mut later = Vec::new();
    for factor in [3.0f32, 5.0] {
        // The app learns of the change at the end of the frame; the constructor comes before.
        let change = |meshes: &mut Assets<Mesh>| {
            let mut mesh = meshes.get_mut(&handle).expect("it is there");
            let points = vec![[0.0; 3], [factor, 0.0, 0.0], [0.0, factor, 0.0], [0.0, 0.0, factor]];
            mesh.insert_attribute(Mesh::ATTRIBUTE_POSITION, points);
        };
        change(&mut app.world_mut().resource_mut::<Assets<Mesh>>());
        scaled = spawn(&mut app, &data);
        frames(&mut app, 1);
        assert!((half(collider(&app, scaled).expect("made")) - 0.5 * Scalar::from(factor)).abs() < 1.0e-5);
        later.push(shape(&app, scaled).clone());
        frames(&mut app, 4);
    }
    assert!(!Arc::ptr_eq(&first.0, &later[0].0) && !Arc::ptr_eq(&later[0].0, &later[1].0));
    let again = spawn(&mut app, &data);
    frames(&mut app, 1);
    assert!((half(collider(&app, again).expect("made")) - 2.5).abs() < 1.0e-5);
}

#[test]
fn without_the_cache_shapes_are_made_one_by_one() {
    let mut app = App::new();
    let plugins = PhysicsPlugins::new(Update).build().disable::<ColliderCachePlugin>();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, plugins))
        .add_plugins((AssetPlugin::default(), MeshPlugin));
    start(&mut app);
    let mesh = MeshComponent(add(&mut app, tetrahedron()));
    let spawned =
        [(); 2].map(|()| app.world_mut().spawn((mesh.clone(), ColliderConstructor::ConvexHullFromMesh)).id());
    frames(&mut app, 2);
    assert!(!is_shared(&app, spawned[0], spawned[1]));
}

#[test]
fn an_observer_of_the_entity_sees_the_collider_and_may_despawn_it() {
    let mut app = app();
    let entity = app
        .world_mut()
        .spawn(ball(0.5))
        .observe(|on: On<ColliderConstructorReady>, colliders: Query<&Collider>, mut commands: Commands| {
            assert!(colliders.contains(on.entity));
            commands.entity(on.entity).despawn();
        })
        .id();
    frames(&mut app, 2);
    assert_eq!(said(&mut app), [Made(entity)]);
    assert!(app.world().get_entity(entity).is_err());
}

#[test]
fn files_of_other_programs_name_constructors_as_avian_does() {
    let mut app = app();
    let path = ColliderConstructor::type_path();
    assert!(path.ends_with("d::collision::collider::constructor::ColliderConstructor"), "{path}");
    let handle = add(&mut app, tetrahedron());
    for (value, needs_mesh) in
        [(r#""ConvexHullFromMesh""#, true), (r#"{ "Capsule": { "radius": 0.5, "height": 1.0 } }"#, false)]
    {
        let text = format!(r#"{{ "{path}": {value} }}"#);
        let registry = app.world().resource::<AppTypeRegistry>().clone();
        let read = {
            let registry = registry.read();
            let mut reader = serde_json::Deserializer::from_str(&text);
            ReflectDeserializer::new(&registry).deserialize(&mut reader).expect("a constructor")
        };
        let entity = app.world_mut().spawn(MeshComponent(handle.clone())).id();
        app.world_mut().commands().entity(entity).insert_reflect(read);
        app.world_mut().flush();
        assert!(waits(&app, entity), "it was inserted");
        let data = app.world().get::<ColliderConstructor>(entity).expect("inserted");
        assert_eq!(data.requires_mesh(), needs_mesh);
        frames(&mut app, 1);
        assert!(collider(&app, entity).is_some());
    }
}
