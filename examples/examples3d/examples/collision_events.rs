//! Boxes and balls rain through a glowing gate. Look at the colors: what begins to touch something flashes white and
//! fades, and the gate, a sensor, is brighter the more bodies are in it. The harder a body hits the floor, the redder it
//! becomes: its impulse is read from `Collisions`. Bodies that have passed are taken away and fall again.
//!
//! `cargo run --release -p examples3d --example collision_events`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
Bodies flash white at each new contact, and redden with the impulse. The gate is brighter with more in it.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(0.0, 6.0, 13.0), Vec3::new(0.0, 2.0, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, (flash, redden, light_gate))
        .add_systems(Update, (fade, fall_again))
        .run();
}

/// How bright a body is, in two ways that fade.
#[derive(Component, Default)]
struct Glow {
    flash: f32,
    blow: f32,
}

#[derive(Component)]
struct Gate;

/// Messages tell of all pairs of which one collider reports.
fn flash(mut started: MessageReader<CollisionStart>, mut bodies: Query<&mut Glow>) {
    for event in started.read() {
        for collider in [event.collider1, event.collider2] {
            if let Ok(mut glow) = bodies.get_mut(collider) {
                glow.flash = 1.0;
            }
        }
    }
}

/// Contacts have the impulses of the last step.
fn redden(mut bodies: Query<(Entity, &mut Glow, &ComputedMass)>, collisions: Collisions) {
    for (body, mut glow, mass) in &mut bodies {
        let impulse: f32 =
            collisions.collisions_with(body).map(|pair| pair.total_normal_impulse_magnitude()).sum();
        let change_of_speed = impulse * mass.inverse();
        glow.blow = glow.blow.max((change_of_speed / 8.0).min(1.0));
    }
}

/// A component keeps what touches now.
fn light_gate(
    gates: Query<(&CollidingEntities, &MeshMaterial3d<StandardMaterial>), With<Gate>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    for (inside, material) in &gates {
        if let Some(mut material) = materials.get_mut(&material.0) {
            material.base_color = Color::srgba(0.2, 0.9, 0.4, 0.1 + 0.08 * inside.len() as f32);
        }
    }
}

fn fade(
    mut bodies: Query<(&mut Glow, &MeshMaterial3d<StandardMaterial>)>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    time: Res<Time>,
) {
    for (mut glow, material) in &mut bodies {
        glow.flash = (glow.flash - 3.0 * time.delta_secs()).max(0.0);
        glow.blow = (glow.blow - 0.5 * time.delta_secs()).max(0.0);
        if let Some(mut material) = materials.get_mut(&material.0) {
            let white = glow.flash;
            material.emissive = LinearRgba::rgb(white + 2.0 * glow.blow, white, white);
        }
    }
}

fn fall_again(mut bodies: Query<(&mut Transform, &mut LinearVelocity)>) {
    for (mut transform, mut velocity) in &mut bodies {
        if transform.translation.length() > 14.0 {
            transform.translation = Vec3::new(0.0, 9.0, 0.0);
            velocity.0 = Vec3::ZERO;
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        Gate,
        Sensor,
        Collider::cuboid(5.0, 2.0, 5.0),
        CollidingEntities::default(),
        Transform::from_xyz(0.0, 2.5, 0.0),
        Mesh3d(meshes.add(Cuboid::new(5.0, 2.0, 5.0))),
        MeshMaterial3d(materials.add(StandardMaterial { alpha_mode: AlphaMode::Blend, ..default() })),
    ));
    for i in 0..40 {
        let place =
            Vec3::new((i % 4) as f32 - 1.5, 6.0 + 1.5 * (i / 4) as f32, (i * 7 % 5) as f32 * 0.5 - 1.0);
        let (mesh, collider) = match i % 2 {
            0 => (meshes.add(Sphere::new(0.35)), Collider::sphere(0.35)),
            _ => (meshes.add(Cuboid::from_length(0.6)), Collider::cuboid(0.6, 0.6, 0.6)),
        };
        commands.spawn((
            Glow::default(),
            RigidBody::Dynamic,
            collider,
            CollisionEventsEnabled,
            Restitution::new(0.5),
            LinearVelocity(Vec3::new((i % 7) as f32 - 3.0, 0.0, (i % 5) as f32 - 2.0)),
            Transform::from_translation(place),
            Mesh3d(mesh),
            MeshMaterial3d(materials.add(Color::srgb(0.4, 0.45, 0.6))),
        ));
    }
}
