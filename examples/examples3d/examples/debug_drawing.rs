//! All shapes as lines. Look at the outlines: dynamic bodies are orange while awake and dark when asleep, what is static
//! is gray. Keys show more: 1 bounding boxes, 2 contacts with normals as long as their force, 3 the collider trees,
//! 4 islands; 5 hides the meshes, 0 turns drawing off.
//!
//! `cargo run --release -p examples3d --example debug_drawing`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
Outlines are orange while a body is awake, dark when it sleeps, gray if it is static.
1: boxes. 2: contacts. 3: trees. 4: islands. 5: hide meshes. 0: no lines.";

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    let scenery =
        Scenery::new(Vec3::new(0.0, 5.0, 10.0), Vec3::new(0.0, 1.0, 0.0)).with_floor().with_hint(HINT);
    app.add_plugins((PhysicsPlugins::default(), PhysicsDebugPlugin, scenery))
        .insert_gizmo_config(
            PhysicsGizmos::default()
                .with_contact_point_color(Color::WHITE)
                .with_contact_normal_color(Color::srgb(1.0, 0.2, 0.2)),
            GizmoConfig::default(),
        )
        .add_systems(Startup, setup)
        .add_systems(Update, toggle);
}

fn toggle(keys: Res<ButtonInput<KeyCode>>, mut store: ResMut<GizmoConfigStore>) {
    let (config, gizmos) = store.config_mut::<PhysicsGizmos>();
    let switch = |color: &mut Option<Color>, on| *color = if color.is_some() { None } else { Some(on) };
    for key in keys.get_just_pressed() {
        match key {
            KeyCode::Digit1 => switch(&mut gizmos.aabb_color, Color::srgb(0.8, 0.8, 0.8)),
            KeyCode::Digit2 => {
                switch(&mut gizmos.contact_point_color, Color::WHITE);
                switch(&mut gizmos.contact_normal_color, Color::srgb(1.0, 0.2, 0.2));
            }
            KeyCode::Digit3 => switch(&mut gizmos.collider_tree_color, Color::srgb(0.4, 0.5, 1.0)),
            KeyCode::Digit4 => switch(&mut gizmos.island_color, Color::srgb(0.4, 1.0, 0.5)),
            KeyCode::Digit5 => gizmos.hide_meshes = !gizmos.hide_meshes,
            KeyCode::Digit0 => config.enabled = !config.enabled,
            _ => {}
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let corners =
        (0..20).map(|i| i as f32).map(|i| Vec3::new(i.sin(), (2.0 * i).cos(), (3.0 * i).sin()) * 0.6);
    let shapes = [
        Collider::sphere(0.5),
        Collider::cuboid(1.0, 0.8, 0.6),
        Collider::capsule(0.3, 0.8),
        Collider::cylinder(0.4, 0.9),
        Collider::cone(0.5, 1.0),
        Collider::round_cuboid(0.8, 0.6, 0.5, 0.15),
        Collider::convex_hull(corners.collect()).unwrap(),
        Collider::compound(vec![
            (Vec3::X * 0.4, Quat::IDENTITY, Collider::cuboid(0.8, 0.2, 0.2)),
            (Vec3::NEG_X * 0.2, Quat::IDENTITY, Collider::sphere(0.3)),
        ]),
    ];
    for (i, collider) in shapes.into_iter().enumerate() {
        for k in 0..2 {
            let place = Vec3::new(1.4 * i as f32 - 5.0, 1.0 + 1.5 * k as f32, -0.3 * k as f32);
            commands.spawn((RigidBody::Dynamic, collider.clone(), Transform::from_translation(place)));
        }
    }
    commands.spawn((
        RigidBody::Dynamic,
        Collider::cuboid(0.7, 0.7, 0.7),
        Transform::from_xyz(0.0, 1.0, 2.5),
        Mesh3d(meshes.add(Cuboid::from_length(0.7))),
        MeshMaterial3d(materials.add(Color::srgb(0.5, 0.6, 0.7))),
    ));
    commands.spawn((
        Transform::from_xyz(-6.0, 0.5, 2.5),
        RayCaster::new(Vec3::ZERO, Dir3::X).with_max_distance(9.0).with_max_hits(1),
    ));
    commands.spawn((
        Transform::from_xyz(3.0, 4.0, 2.0),
        ShapeCaster::new(Collider::sphere(0.4), Vec3::ZERO, Quat::IDENTITY, Dir3::NEG_Y)
            .with_max_distance(6.0)
            .with_max_hits(1),
    ));
}
