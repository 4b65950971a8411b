//! A broad phase of the app, which tests every two boxes: simple, and fast enough for a hundred bodies. Look at
//! `find_pairs`: it adds pairs to [`ContactGraph`]; everything else is as with the engine's own broad phase.
//!
//! `cargo run --release -p examples3d --example custom_broad_phase`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "A heap of boxes whose pairs are found by a system of the app.";

fn main() {
    App::new()
        .add_plugins((
            DefaultPlugins,
            PhysicsPlugins::default().build().disable::<BvhBroadPhasePlugin>(),
            Scenery::new(Vec3::new(-8.0, 6.0, 12.0), Vec3::Y * 2.0).with_floor().with_hint(HINT),
        ))
        .add_systems(PhysicsSchedule, find_pairs.in_set(BroadPhaseSystems::CollectCollisions))
        .add_systems(Startup, setup)
        .run();
}

/// Adds every two colliders whose boxes overlap, unless they have a contact already or nothing could move them.
fn find_pairs(
    colliders: Query<(Entity, &ColliderAabb, &ColliderOf)>,
    bodies: Query<&RigidBody>,
    mut graph: ResMut<ContactGraph>,
) {
    for [(collider1, aabb1, of1), (collider2, aabb2, of2)] in colliders.iter_combinations() {
        if !aabb1.intersects(aabb2) || graph.contains(collider1, collider2) {
            continue;
        }
        let is_static = |of: &ColliderOf| bodies.get(of.body).is_ok_and(RigidBody::is_static);
        if of1.body != of2.body && !(is_static(of1) && is_static(of2)) {
            let mut edge = ContactEdge::new(collider1, collider2);
            (edge.body1, edge.body2) = (Some(of1.body), Some(of2.body));
            graph.add_edge(edge);
        }
    }
}

/// A heap of a hundred boxes.
fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let (mesh, material) = (meshes.add(Cuboid::default()), materials.add(Color::srgb(0.9, 0.6, 0.2)));
    for i in 0..100 {
        let (x, y, z) = ((i % 5) as f32, (i / 25) as f32, (i / 5 % 5) as f32);
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(1.0, 1.0, 1.0),
            Transform::from_xyz(1.1 * x - 2.0 + 0.1 * y, 1.5 * y + 1.0, 1.1 * z - 2.0 - 0.1 * y),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(material.clone()),
        ));
    }
}
