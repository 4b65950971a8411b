//! Two thousand discs rain into a bowl. Look at the numbers: once a second they tell how long each part of a step took.
//!
//! `cargo run --release -p examples2d --example step_times`

use avian2d::{prelude::*, schedule::StepTimes};
use bevy::{prelude::*, time::common_conditions::on_timer};
use core::time::Duration;
use examples2d::{Readout, Scenery};

/// On the screen.
const HINT: &str = "Parts of a step that take a hundredth of it or more, once a second.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::default().with_hint(HINT)))
        .add_systems(Startup, setup)
        .add_systems(Update, show.run_if(on_timer(Duration::from_secs(1))))
        .run();
}

fn show(times: Res<StepTimes>, mut readout: Single<&mut Text, With<Readout>>) {
    let milliseconds = |time: Duration| 1e3 * time.as_secs_f32();
    let total = times.total();
    readout.0 = format!("{:6.2} ms in one step", milliseconds(total));
    for (part, time) in times.parts().filter(|(_, time)| *time > total / 100) {
        readout.0 += &format!("\n{:6.2} ms {part}", milliseconds(time));
    }
}

fn setup(
    mut commands: Commands,
    times: Res<StepTimes>,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    // Steps are timed from the first reading on.
    times.total();
    let grey = materials.add(Color::srgb(0.35, 0.4, 0.45));
    for (x, angle) in [(-6.0, -0.5f32), (6.0, 0.5)] {
        commands.spawn((
            RigidBody::Static,
            Collider::rectangle(16.0, 0.5),
            Transform::from_xyz(x, 2.5, 0.0).with_rotation(Quat::from_rotation_z(angle)),
            Mesh2d(meshes.add(Rectangle::new(16.0, 0.5))),
            MeshMaterial2d(grey.clone()),
        ));
    }
    let disc = meshes.add(Circle::new(0.1));
    let teal = materials.add(Color::srgb(0.2, 0.65, 0.6));
    for i in 0..2000 {
        let (x, y) = (0.25 * (i % 40) as f32 - 4.9, 7.0 + 0.25 * (i / 40) as f32);
        commands.spawn((
            RigidBody::Dynamic,
            Collider::circle(0.1),
            Transform::from_xyz(x + 0.05 * (i / 40 % 3) as f32, y, 0.0),
            Mesh2d(disc.clone()),
            MeshMaterial2d(teal.clone()),
        ));
    }
}
