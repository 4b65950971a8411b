//! Blows of boxes that land flat: their impulse is the momentum, in every phase of the step.

use super::landings_dim::mesh;
use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use scenes::dim::block;

#[derive(Resource, Default)]
struct Hits(Vec<CollisionHit>);

fn app(substeps: u32) -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.insert_resource(SubstepCount(substeps)).init_resource::<Hits>();
    app.add_systems(PostUpdate, |mut hits: MessageReader<CollisionHit>, mut seen: ResMut<Hits>| {
        seen.0.extend(hits.read());
    });
    app
}

/// Ground with its surface at the height 0.
fn spawn_ground(app: &mut App, kind: &str) {
    let world = app.world_mut();
    match kind {
        "box" => {
            _ = world.spawn((RigidBody::Static, block(20.0, 2.0, 20.0), Transform::from_xyz(0.0, -1.0, 0.0)));
        }
        "tiles" => {
            for x in -3..=3_i8 {
                for z in -3..=3_i8 {
                    if Vector::AXES.len() == 3 || z == 0 {
                        let place = Transform::from_xyz(0.7 * f32::from(x), -0.35, 0.7 * f32::from(z));
                        world.spawn((RigidBody::Static, block(0.7, 0.7, 0.7), place));
                    }
                }
            }
        }
        _ => _ = world.spawn((RigidBody::Static, mesh())),
    }
}

/// The sum of the impulses of a box of 3 kg that falls by `height`, and the fastest speed.
fn land(rate: f64, substeps: u32, ground: &str, height: f32) -> (Scalar, Scalar) {
    let mut app = app(substeps);
    spawn_ground(&mut app, ground);
    app.world_mut().spawn((
        RigidBody::Dynamic,
        block(1.0, 1.0, 1.0),
        Mass(3.0),
        CollisionHitsEnabled::default(),
        Transform::from_xyz(0.13, 0.5 + height, 0.07),
    ));
    let mut steps = 0;
    while app.world().resource::<Hits>().0.is_empty() {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / rate));
        app.update();
        steps += 1;
        assert!(steps < 500, "no blow");
    }
    for _ in 0..20 {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / rate));
        app.update();
    }
    let hits = &app.world().resource::<Hits>().0;
    let sum = hits.iter().map(|hit| hit.impulse).sum();
    (sum, hits.iter().fold(0.0, |speed, hit| speed.max(hit.speed)))
}

#[test]
fn issue_the_impulse_of_a_box_that_lands_flat_depended_on_the_phase_of_the_step() {
    for (rate, substeps) in [(60.0, 4), (64.0, 6), (30.0, 6), (144.0, 6)] {
        for ground in ["box", "tiles", "mesh"] {
            let [mut least, mut most] = [[Scalar::MAX; 2], [0.0; 2]];
            for phase in 0..28_u8 {
                // From a low height and a greater one in turns, each by the way of two steps.
                let (height, speed) = if phase % 2 == 0 { (0.2, 2.0) } else { (1.0, 4.5) };
                let fall = height + speed / rate as f32 * f32::from(phase) / 14.0;
                let (impulse, speed) = land(rate, substeps, ground, fall);
                let exact = (2.0 * 9.81 * Scalar::from(fall)).sqrt();
                for (i, ratio) in [impulse / (3.0 * exact), speed / exact].into_iter().enumerate() {
                    least[i] = least[i].min(ratio);
                    most[i] = most[i].max(ratio);
                }
            }
            let is_right = |i: usize| least[i] > 0.95 && most[i] < 1.05;
            assert!(
                is_right(0) && is_right(1),
                "{rate} Hz, {ground}: impulse and speed {least:?} to {most:?} of the exact ones"
            );
        }
    }
}
