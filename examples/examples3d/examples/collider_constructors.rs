//! Colliders from meshes. Look at the orange lines: the arch is one hierarchy of meshes and gets all of its colliders from
//! `ColliderConstructorHierarchy`, but for the glass, which everything falls through. What falls is made of its meshes too:
//! rings of convex parts, which can hang on something, and hulls of knots, which cannot.
//!
//! `cargo run --release -p examples3d --example collider_constructors`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
All colliders come from meshes. Everything falls through the glass. Gold rings can hang on something.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(6.0, 6.0, 14.0), Vec3::new(0.0, 2.5, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin, scenery))
        .add_systems(Startup, spawn_arch)
        .add_observer(drop_rings)
        .run();
}

fn spawn_arch(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let stone = materials.add(Color::srgb(0.6, 0.55, 0.5));
    let glass = materials.add(StandardMaterial {
        base_color: Color::srgba(0.6, 0.8, 1.0, 0.3),
        alpha_mode: AlphaMode::Blend,
        ..default()
    });
    let pillar = Mesh3d(meshes.add(Cylinder::new(0.4, 4.0)));
    let beam = Mesh3d(meshes.add(Capsule3d::new(0.25, 5.0)));
    let pane = Mesh3d(meshes.add(Cuboid::new(4.2, 0.1, 3.0)));

    // Pillars and panes take the default, the triangles of their mesh; a beam is convex.
    let hierarchy = ColliderConstructorHierarchy::new(ColliderConstructor::TrimeshFromMesh)
        .with_constructor_for_name("Beam", ColliderConstructor::ConvexHullFromMesh)
        .without_constructor_for_name("Glass");
    let lying = Quat::from_rotation_z(1.57);
    commands.spawn((
        RigidBody::Static,
        hierarchy,
        Visibility::default(),
        Transform::from_rotation(Quat::from_rotation_y(0.3)),
        children![
            (pillar.clone(), MeshMaterial3d(stone.clone()), Transform::from_xyz(-2.5, 2.0, 0.0)),
            (pillar, MeshMaterial3d(stone.clone()), Transform::from_xyz(2.5, 2.0, 0.0)),
            (
                Name::new("Beam"),
                beam,
                MeshMaterial3d(stone),
                Transform::from_xyz(0.0, 4.2, 0.0).with_rotation(lying),
            ),
            (Name::new("Glass"), pane, MeshMaterial3d(glass), Transform::from_xyz(0.0, 2.0, 0.0)),
        ],
    ));
}

/// Comes when the whole arch collides.
fn drop_rings(
    _: On<ColliderConstructorHierarchyReady>,
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let ring = Mesh3d(meshes.add(Torus::new(0.35, 0.75).mesh().minor_resolution(8).major_resolution(16)));
    let knot = Mesh3d(meshes.add(Tetrahedron::default()));
    let (gold, iron) =
        (materials.add(Color::srgb(0.9, 0.7, 0.2)), materials.add(Color::srgb(0.4, 0.4, 0.45)));
    let params = VhacdParameters { concavity: 0.05, resolution: 32, ..default() };
    for i in 0..24 {
        let place =
            Transform::from_xyz((i % 4) as f32 * 1.6 - 2.4, 6.0 + 1.2 * i as f32, 0.2 * (i % 3) as f32)
                .with_rotation(Quat::from_rotation_x(i as f32));
        // The rings share a mesh and a constructor, so that they are decomposed once.
        let (mesh, material, constructor) = match i % 2 {
            0 => (&ring, &gold, ColliderConstructor::ConvexDecompositionFromMeshWithConfig(params.clone())),
            _ => (&knot, &iron, ColliderConstructor::ConvexHullFromMesh),
        };
        commands.spawn((
            RigidBody::Dynamic,
            constructor,
            mesh.clone(),
            MeshMaterial3d(material.clone()),
            place,
        ));
    }
}
