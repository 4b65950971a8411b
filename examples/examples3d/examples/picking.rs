//! A wall of boxes to click at. Point at a box: it turns yellow. Click: it is pushed where you clicked, away from you, so
//! that boxes clicked at their rim spin.
//!
//! `cargo run --release -p examples3d --example picking`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "Point at a box, and click: it is pushed where you clicked, away from you.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(-6.0, 4.5, 9.0), Vec3::new(0.0, 2.2, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsPickingPlugin, scenery))
        .add_systems(Startup, setup)
        .add_observer(push)
        .run();
}

/// Momentum of a click, in N·s: 4 m/s for a box of 1 kg.
const IMPULSE: f32 = 4.0;

fn push(click: On<Pointer<Click>>, mut bodies: Query<Forces>, cameras: Query<&GlobalTransform>) {
    let (Some(point), Some(normal)) = (click.hit.position, click.hit.normal) else { return };
    // Neither floor nor sky.
    if let Ok(mut body) = bodies.get_mut(click.entity)
        && let Ok(camera) = cameras.get(click.hit.camera)
    {
        let away = (*camera.forward() - normal).normalize();
        body.apply_linear_impulse_at_point(away * IMPULSE, point);
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let cube = meshes.add(Cuboid::default());
    // Like a chessboard, so that boxes tell apart.
    let shades =
        [Color::srgb(0.8, 0.45, 0.3), Color::srgb(0.55, 0.35, 0.3)].map(|color| materials.add(color));
    let pointed_at = materials.add(Color::srgb(1.0, 0.9, 0.3));
    for i in 0..30 {
        let (column, row) = (i % 6, i / 6);
        let plain = &shades[(column + row) % 2];
        let (over, out) = (pointed_at.clone(), plain.clone());
        commands
            .spawn((
                RigidBody::Dynamic,
                Collider::cuboid(1.0, 1.0, 1.0),
                Mass(1.0),
                Transform::from_xyz(column as f32 - 2.5, 0.5 + row as f32, 0.0),
                Mesh3d(cube.clone()),
                MeshMaterial3d(plain.clone()),
            ))
            .observe(paint::<Over>(over))
            .observe(paint::<Out>(out));
    }
}

/// Gives a box a material when a pointer comes or goes.
fn paint<E: core::fmt::Debug + Clone + Reflect>(
    material: Handle<StandardMaterial>,
) -> impl Fn(On<Pointer<E>>, Query<&mut MeshMaterial3d<StandardMaterial>>) {
    move |event, mut materials| {
        if let Ok(mut current) = materials.get_mut(event.entity) {
            current.0 = material.clone();
        }
    }
}
