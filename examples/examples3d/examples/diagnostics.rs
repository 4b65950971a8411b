//! Boxes rain on the floor. Look at the panel: how many bodies and contacts there are, and where the time of a step goes.
//! Space hides it.
//!
//! `cargo run --release -p examples3d --example diagnostics`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
The panel tells how many bodies and contacts there are, and how long each part of a step takes.
Space: hide the panel.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(0.0, 6.0, 14.0), Vec3::new(0.0, 2.0, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDiagnosticsUiPlugin, scenery))
        .add_systems(Startup, load)
        .add_systems(Update, toggle)
        .add_systems(FixedUpdate, rain)
        .run();
}

/// The look of a box.
#[derive(Resource)]
struct Look(Handle<Mesh>, Handle<StandardMaterial>);

fn load(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let mesh = meshes.add(Cuboid::from_length(0.8));
    commands.insert_resource(Look(mesh, materials.add(Color::srgb(0.8, 0.5, 0.3))));
}

fn toggle(keys: Res<ButtonInput<KeyCode>>, mut settings: ResMut<PhysicsDiagnosticsUiSettings>) {
    if keys.just_pressed(KeyCode::Space) {
        settings.enabled = !settings.enabled;
    }
}

/// Drops a box every eighth of a second, until there are 200.
fn rain(mut commands: Commands, look: Res<Look>, mut count: Local<u32>) {
    *count += 1;
    if !(*count).is_multiple_of(8) || *count > 1600 {
        return;
    }
    let angle = *count as f32;
    commands.spawn((
        RigidBody::Dynamic,
        Collider::cuboid(0.8, 0.8, 0.8),
        Transform::from_xyz(angle.sin() * 3.0, 8.0, angle.cos() * 3.0),
        Mesh3d(look.0.clone()),
        MeshMaterial3d(look.1.clone()),
    ));
}
