//! Levels: colliders for all nodes of a hierarchy, and of scenes that are loaded.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{math::Vector, prelude::*};
use bevy_app::prelude::*;
use bevy_asset::{AssetPlugin, Assets, Handle};
use bevy_ecs::prelude::*;
use bevy_mesh::{Indices, Mesh, MeshPlugin};
use bevy_transform::components::{GlobalTransform, Transform, TransformTreeChanged};
use bevy_world_serialization::{WorldAsset, WorldAssetRoot, WorldSerializationPlugin};

use super::constructors::{Said::*, add, app, frames, said, start};
use super::constructors_dim::{MeshComponent, level_meshes, point, turn};

fn ball() -> ColliderConstructor {
    ColliderConstructor::Capsule { radius: 0.5, height: 1.0 }
}

fn child(app: &mut App, parent: Entity, name: &'static str, bundle: impl Bundle) -> Entity {
    app.world_mut().spawn((Name::new(name), ChildOf(parent), bundle)).id()
}

fn has_collider(app: &App, entity: Entity) -> bool {
    app.world().entity(entity).contains::<Collider>()
}

#[test]
fn names_choose_constructors_layers_and_densities() {
    let mut app = app();
    let (stone, air) = (CollisionLayers::from_bits(2, 3), CollisionLayers::from_bits(4, 5));
    let thin = ColliderConstructor::Capsule { radius: 0.1, height: 1.0 };
    let hierarchy = ColliderConstructorHierarchy::new(ball())
        .with_default_layers(stone)
        .with_default_density(3.0)
        .with_constructor_for_name("thin", thin)
        .with_layers_for_name("airy", air)
        .with_density_for_name("airy", 0.5)
        .without_constructor_for_name("ghost");
    let root = app.world_mut().spawn((Name::new("airy"), RigidBody::Static, hierarchy)).id();
    let plain = child(&mut app, root, "plain", ());
    let thin = child(&mut app, plain, "thin", ());
    let airy = child(&mut app, thin, "airy", ColliderDensity(9.0));
    let ghost = child(&mut app, root, "ghost", ());
    let under_ghost = app.world_mut().spawn(ChildOf(ghost)).id();
    let own = child(&mut app, root, "own", (ColliderDensity(7.0), CollisionLayers::from_bits(8, 8)));
    frames(&mut app, 1);
    let seen = |entity: Entity| {
        let entity = app.world().entity(entity);
        let radius = entity.get::<Collider>()?.shape().as_capsule()?.radius;
        Some((radius as f32, *entity.get::<CollisionLayers>()?, entity.get::<ColliderDensity>()?.0))
    };
    assert_eq!(seen(plain), Some((0.5, stone, 3.0)));
    assert_eq!(seen(thin), Some((0.1, stone, 3.0)));
    assert_eq!(seen(airy), Some((0.5, air, 0.5)), "a named one gets what its name says");
    assert_eq!(seen(own), Some((0.5, CollisionLayers::from_bits(8, 8), 7.0)), "others keep what they have");
    assert_eq!((seen(ghost), seen(root)), (None, None));
    assert!(seen(under_ghost).is_some());
    let told = said(&mut app);
    assert_eq!((told.len(), told.last()), (6, Some(&AllMade(root))), "{told:?}");
    assert!([plain, thin, airy, own, under_ghost].iter().all(|entity| told.contains(&Made(*entity))));
    assert!(!app.world().entity(root).contains::<ColliderConstructorHierarchy>());
    frames(&mut app, 3);
    assert!(said(&mut app).is_empty());
    let of = |entity: Entity| app.world().get::<ColliderOf>(entity).map(|of| of.body);
    assert_eq!((of(airy), of(under_ghost)), (Some(root), Some(root)));
}

#[test]
fn a_collider_or_constructor_of_its_own_stays_unless_the_name_is_in_the_config() {
    let mut app = app();
    let hierarchy = ColliderConstructorHierarchy::new(ball()).with_constructor_for_name("named", ball());
    let root = app.world_mut().spawn(hierarchy).id();
    let thin = || ColliderConstructor::Capsule { radius: 0.1, height: 1.0 };
    let kept = child(&mut app, root, "kept", Collider::capsule(0.2, 1.0));
    let described = child(&mut app, root, "described", thin());
    let named = child(&mut app, root, "named", (Collider::capsule(0.2, 1.0), thin()));
    frames(&mut app, 1);
    let radius = |entity: Entity| {
        app.world().get::<Collider>(entity)?.shape().as_capsule().map(|c| (c.radius * 10.0).round() as u32)
    };
    assert_eq!([kept, described, named].map(radius), [Some(2), Some(1), Some(5)]);
    assert_eq!(said(&mut app).last(), Some(&AllMade(root)), "it waited for the one described");
}

#[test]
fn descendants_without_meshes_get_no_collider_from_meshes() {
    let mut app = app();
    let mesh = MeshComponent(add(&mut app, level_meshes().remove(0)));
    let root =
        app.world_mut().spawn(ColliderConstructorHierarchy::new(ColliderConstructor::TrimeshFromMesh)).id();
    let bare = child(&mut app, root, "bare", ());
    let meshy = child(&mut app, bare, "meshy", mesh);
    frames(&mut app, 1);
    assert_eq!((has_collider(&app, bare), has_collider(&app, meshy)), (false, true));
    assert_eq!(said(&mut app), [Made(meshy), AllMade(root)]);
}

#[test]
fn a_hierarchy_is_done_when_its_last_mesh_is_loaded() {
    let mut app = app();
    let loaded = MeshComponent(add(&mut app, level_meshes().remove(0)));
    let reserved = app.world().resource::<Assets<Mesh>>().reserve_handle();
    let spawn = |app: &mut App| {
        let hierarchy = ColliderConstructorHierarchy::new(ColliderConstructor::TrimeshFromMesh);
        let root = app.world_mut().spawn((RigidBody::Static, hierarchy)).id();
        let first = child(app, root, "loaded", loaded.clone());
        let last = child(app, root, "loading", MeshComponent(reserved.clone()));
        (root, first, last)
    };
    let (root, first, last) = spawn(&mut app);
    let (cancelled, .., orphan) = spawn(&mut app);
    let (despawned, ..) = spawn(&mut app);
    let (childless, .., gone) = spawn(&mut app);
    frames(&mut app, 3);
    let told = said(&mut app);
    assert!(told.len() == 4 && told.contains(&Made(first)), "{told:?}");
    app.world_mut().entity_mut(cancelled).remove::<ColliderConstructorHierarchy>();
    app.world_mut().despawn(despawned);
    app.world_mut().despawn(gone);
    frames(&mut app, 2);
    assert_eq!(said(&mut app), [AllMade(childless)], "nothing is left to wait for");
    app.world_mut()
        .resource_mut::<Assets<Mesh>>()
        .insert(&reserved, level_meshes().remove(1))
        .expect("reserved");
    frames(&mut app, 2);
    let told = said(&mut app);
    assert!(told.len() == 3 && told.contains(&Made(orphan)) && told.contains(&Made(last)), "{told:?}");
    assert_eq!(told.last(), Some(&AllMade(root)));
}

#[test]
fn a_node_that_makes_no_shape_does_not_hold_up_the_others() {
    let mut app = app();
    let flat = ColliderConstructor::Segment { a: Vector::ZERO, b: Vector::ZERO };
    let hierarchy = ColliderConstructorHierarchy::new(ball()).with_constructor_for_name("flat", flat);
    let root = app.world_mut().spawn(hierarchy).id();
    let good = child(&mut app, root, "good", ());
    let bad = child(&mut app, root, "flat", ());
    frames(&mut app, 1);
    assert_eq!(said(&mut app), [Made(good), AllMade(root)]);
    assert!(!has_collider(&app, bad));
}

/// A level as a file would have it: nested and turned nodes with meshes, as a scene.
fn level(meshes: &[Handle<Mesh>]) -> WorldAsset {
    let mut world = World::new();
    let frame = |i: u32| {
        let i = i as f32;
        Transform::from_xyz(3.0 * i.sin(), 2.0 - i, 0.0).with_rotation(turn(0.4 * i))
    };
    let root = world.spawn((Name::new("Level"), frame(1))).id();
    let mut parent = root;
    for i in 0..12u32 {
        let mesh = MeshComponent(meshes[i as usize % meshes.len()].clone());
        let node = world.spawn((Name::new(format!("Node {i}")), frame(i), ChildOf(parent))).id();
        world.spawn((Name::new(format!("Mesh {i}")), frame(i + 2), mesh, ChildOf(node)));
        // Groups of nodes that are up to three deep.
        parent = if i % 3 == 2 { root } else { node };
    }
    WorldAsset { world }
}

/// An app that loads scenes.
fn app_with_scenes() -> App {
    let mut app = super::constructors::headless();
    app.add_plugins((AssetPlugin::default(), MeshPlugin, WorldSerializationPlugin))
        .register_type::<(Transform, GlobalTransform, TransformTreeChanged)>()
        .register_type::<Transform>()
        .register_type::<GlobalTransform>()
        .register_type::<TransformTreeChanged>()
        .register_type::<Name>()
        .register_type::<ChildOf>()
        .register_type::<Children>()
        .register_type::<MeshComponent>();
    start(&mut app);
    app
}

/// Compares the collider of each node with its mesh, triangle by triangle, in the world. Returns
/// their number.
pub fn compare(app: &mut App) -> usize {
    type Solid = (&'static Collider, &'static Position, &'static Rotation);
    let mut nodes = app.world_mut().query::<(&Name, &MeshComponent, &GlobalTransform, Option<Solid>)>();
    let meshes = app.world().resource::<Assets<Mesh>>();
    let mut count = 0;
    for (name, mesh, frame, solid) in nodes.iter(app.world()) {
        let (collider, position, rotation) = solid.unwrap_or_else(|| panic!("{name} has no collider"));
        let shape = collider.shape_scaled().as_trimesh().expect("a mesh of triangles");
        let mut mesh = meshes.get(&mesh.0).expect("loaded").clone();
        // Bevy finds no triangles in a mesh without indices.
        if mesh.indices().is_none() {
            mesh.insert_indices(Indices::U32((0..mesh.count_vertices() as u32).collect()));
        }
        let drawn: Vec<_> = mesh.triangles().expect("triangles").collect();
        assert_eq!(shape.num_triangles(), drawn.len(), "{name}");
        for (solid, drawn) in shape.triangles().zip(drawn) {
            let solid = [solid.a, solid.b, solid.c].map(|corner| position.0 + *rotation * corner);
            let [first, second, third] = drawn.vertices.map(|corner| point(frame.transform_point(corner)));
            // Colliders keep the outer side of a triangle where the frame mirrors it.
            let mirrors = frame.affine().matrix3.determinant() < 0.0;
            let drawn = if mirrors { [first, third, second] } else { [first, second, third] };
            for (a, b) in solid.into_iter().zip(drawn) {
                assert!(a.distance(b) < 1.0e-4, "{name}: {a} is not at {b}");
            }
            count += 1;
        }
    }
    count
}

#[test]
fn a_level_has_the_triangles_of_its_meshes() {
    for is_loaded_first in [false, true] {
        let mut app = app_with_scenes();
        let meshes: Vec<_> = level_meshes().into_iter().map(|mesh| add(&mut app, mesh)).collect();
        let scenes = app.world_mut().resource_mut::<Assets<WorldAsset>>();
        let handle = scenes.reserve_handle();
        let load = |app: &mut App| {
            let mut scenes = app.world_mut().resource_mut::<Assets<WorldAsset>>();
            scenes.insert(&handle, level(&meshes)).expect("it was reserved");
        };
        if is_loaded_first {
            load(&mut app);
            frames(&mut app, 5);
        }
        let root = (
            RigidBody::Static,
            Transform::from_xyz(5.0, -3.0, 0.0).with_rotation(turn(1.0)),
            WorldAssetRoot(handle.clone()),
            ColliderConstructorHierarchy::new(ColliderConstructor::TrimeshFromMesh),
        );
        let root = app.world_mut().spawn(root).id();
        if !is_loaded_first {
            frames(&mut app, 5);
            assert!(said(&mut app).is_empty(), "the scene is not there");
            load(&mut app);
        }
        frames(&mut app, 5);
        let told = said(&mut app);
        assert_eq!((told.len(), told.last()), (13, Some(&AllMade(root))), "{told:?}");
        assert!(compare(&mut app) > 100);
    }
}

#[test]
fn a_scene_within_a_level_is_waited_for() {
    let mut app = app_with_scenes();
    let handle = app.world_mut().resource_mut::<Assets<WorldAsset>>().reserve_handle();
    let root = app.world_mut().spawn(ColliderConstructorHierarchy::new(ball())).id();
    let lamp = child(&mut app, root, "lamp", WorldAssetRoot(handle.clone()));
    frames(&mut app, 3);
    assert!(said(&mut app).is_empty() && !has_collider(&app, lamp));
    let mut world = World::new();
    world.spawn((Name::new("bulb"), Transform::default()));
    let mut scenes = app.world_mut().resource_mut::<Assets<WorldAsset>>();
    scenes.insert(&handle, WorldAsset { world }).expect("reserved");
    frames(&mut app, 5);
    assert_eq!(said(&mut app).len(), 3, "the lamp, its bulb and all of it");
    assert!(has_collider(&app, lamp));
}
