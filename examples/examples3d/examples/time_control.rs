//! A tower is hit by a ball. Look at it in slow motion: Space pauses physics, Enter takes one step, the arrow keys make time
//! slower and faster.
//!
//! `cargo run --release -p examples3d --example time_control`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::{Readout, Scenery};

/// On the screen.
const HINT: &str = "\
A ball hits a tower: see it in slow motion.
Space: pause. Enter: one step. Up, Down: faster and slower.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(-8.0, 6.0, 14.0), Vec3::new(0.0, 4.0, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .add_systems(Update, control)
        .run();
}

/// Physics has a clock of its own.
fn control(
    keys: Res<ButtonInput<KeyCode>>,
    mut time: ResMut<Time<Physics>>,
    mut commands: Commands,
    mut readout: Single<&mut Text, With<Readout>>,
) {
    if keys.just_pressed(KeyCode::Space) {
        if time.is_paused() {
            time.unpause();
        } else {
            time.pause();
        }
    }
    if keys.just_pressed(KeyCode::Enter) {
        commands.queue(|world: &mut World| {
            let step = world.resource::<Time<Fixed>>().timestep();
            world.resource_mut::<Time<Physics>>().advance_by(step);
            world.run_schedule(PhysicsSchedule);
        });
    }
    let factor = match () {
        () if keys.just_pressed(KeyCode::ArrowUp) => 2.0,
        () if keys.just_pressed(KeyCode::ArrowDown) => 0.5,
        () => 1.0,
    };
    let speed = (time.relative_speed() * factor).clamp(0.125, 4.0);
    time.set_relative_speed(speed);
    let paused = if time.is_paused() { ", paused" } else { "" };
    readout.0 = format!("speed {speed}{paused}, {:.2} s", time.elapsed_secs());
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let brick = meshes.add(Cuboid::new(1.0, 0.5, 0.5));
    let clay = materials.add(Color::srgb(0.75, 0.4, 0.3));
    for layer in 0..16 {
        let rotation = Quat::from_rotation_y(core::f32::consts::FRAC_PI_2 * (layer % 2) as f32);
        for side in [-0.25, 0.25] {
            commands.spawn((
                RigidBody::Dynamic,
                Collider::cuboid(1.0, 0.5, 0.5),
                Transform::from_translation(rotation * Vec3::new(0.0, 0.25 + 0.5 * layer as f32, side))
                    .with_rotation(rotation),
                Mesh3d(brick.clone()),
                MeshMaterial3d(clay.clone()),
            ));
        }
    }
    commands.spawn((
        RigidBody::Dynamic,
        Collider::sphere(0.4),
        ColliderDensity(4.0),
        LinearVelocity(Vec3::new(12.0, 4.0, 0.0)),
        Transform::from_xyz(-12.0, 3.0, 0.0),
        Mesh3d(meshes.add(Sphere::new(0.4))),
        MeshMaterial3d(materials.add(Color::srgb(0.3, 0.3, 0.35))),
    ));
}
