//! The same scene moved, rotated, scaled, and with other steps: row 21 of the required physics.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use scenes::{headless_app_with, scene::turned, sin_cos};

use super::{
    dim,
    world::{G, Lab},
};

/// The frame of the scene in the world.
#[derive(Clone, Copy)]
struct Frame {
    scale: f32,
    turn: f32,
    origin: Vec3,
    dt: f64,
}

const HERE: Frame = Frame { scale: 1.0, turn: 0.0, origin: Vec3::ZERO, dt: 1.0 / 60.0 };

impl Frame {
    fn lab(&self) -> Lab {
        let plugins = PhysicsPlugins::default().with_length_unit(self.scale);
        let mut lab = Lab { app: headless_app_with(self.dt, 4, plugins), dt: self.dt };
        lab.gravity(self.direction(0.0, -G * self.scale));
        lab
    }

    fn direction(&self, x: f32, y: f32) -> Vector {
        let (sin, cos) = sin_cos(self.turn);
        dim::sized(cos * x - sin * y, sin * x + cos * y, 0.0)
    }

    fn pose(&self, x: f32, y: f32) -> Transform {
        let rotation = turned(self.turn);
        Transform::from_translation(self.origin + rotation * Vec3::new(x, y, 0.0) * self.scale)
            .with_rotation(rotation)
    }

    /// A world position in the frame of the scene.
    fn home(&self, p: Vector) -> [f32; 2] {
        let (sin, cos) = sin_cos(self.turn);
        let (x, y) = (p.x - self.origin.x, p.y - self.origin.y);
        [(cos * x + sin * y) / self.scale, (cos * y - sin * x) / self.scale]
    }
}

/// A tower, a sliding box, a ball that rolls into a wall and back: all positions after `seconds`.
fn run(frame: Frame, seconds: f64) -> Vec<[f32; 2]> {
    let mut lab = frame.lab();
    let s = frame.scale;
    for (size, x, y) in [([60.0, 2.0, 60.0], 0.0, -1.0), ([1.0, 4.0, 4.0], 9.0, 2.0)] {
        lab.spawn((
            RigidBody::Static,
            dim::sized_block(s * size[0], s * size[1], s * size[2]),
            frame.pose(x, y),
        ));
    }
    let mut bodies: Vec<Entity> =
        (0..6).map(|i| lab.block([s; 3], frame.pose(-6.0, 0.5 + i as f32))).collect();
    let slider = lab.block([s, 0.5 * s, s], frame.pose(-3.0, 0.25));
    lab.insert(slider, LinearVelocity(frame.direction(4.0, 0.0) * s));
    let ball = lab.ball(0.5 * s, frame.pose(3.0, 1.5));
    lab.insert(ball, (LinearVelocity(frame.direction(3.0, 0.0) * s), Restitution::new(0.6)));
    bodies.extend([slider, ball]);
    lab.seconds(seconds);
    bodies.iter().map(|&b| frame.home(lab.at(b))).collect()
}

#[track_caller]
fn assert_same(frame: Frame, tolerance: f32, what: &str) {
    let (here, there) = (run(HERE, 4.0), run(frame, 4.0));
    let mut worst: f32 = 0.0;
    for (a, b) in here.iter().zip(&there) {
        worst = worst.max((a[0] - b[0]).abs()).max((a[1] - b[1]).abs());
    }
    println!("{what}: {worst} m off");
    assert!(worst <= tolerance, "{what}: {worst} m off\n{here:?}\n{there:?}");
}

#[test]
fn a_turned_scene_is_the_same_scene() {
    for degrees in [1.0, 30.0, 90.0, 137.0, 180.0] {
        assert_same(
            Frame { turn: Scalar::to_radians(degrees), ..HERE },
            0.02,
            &format!("turned by {degrees}"),
        );
    }
}

#[test]
fn a_scene_a_kilometre_away_is_the_same_scene() {
    for origin in [Vec3::X * 1000.0, Vec3::new(-700.0, 700.0, 0.0)] {
        assert_same(Frame { origin, ..HERE }, 0.02, &format!("at {origin}"));
    }
}

#[test]
fn a_scaled_scene_with_its_length_unit_is_the_same_scene() {
    for scale in [0.01, 0.1, 0.3, 3.0, 10.0, 100.0] {
        assert_same(Frame { scale, ..HERE }, 0.02, &format!("scaled by {scale}"));
    }
    // Powers of two scale without rounding.
    for scale in [0.125, 8.0] {
        assert_eq!(run(HERE, 2.0), run(Frame { scale, ..HERE }, 2.0), "scaled by {scale}");
    }
}

/// The mean height of a pile at rest, and its maximum speed.
fn rest_of_pile(dt: f64, seed: u64) -> (Scalar, Scalar) {
    let mut lab = Lab::with_steps(dt, 4);
    scenes::pile::mixed_by_chance(lab.app.world_mut(), dim::PILE_LAYERS, seed);
    lab.seconds(6.0);
    let world = lab.app.world_mut();
    let mut bodies = world.query::<(&RigidBody, &Position, &LinearVelocity)>();
    let (mut count, mut height, mut speed) = (0.0, 0.0, 0.0);
    for (_, position, velocity) in bodies.iter(world).filter(|(kind, ..)| kind.is_dynamic()) {
        count += 1.0;
        height += position.y;
        speed += velocity.length();
    }
    (height / count, speed / count)
}

#[test]
fn rest_is_the_same_in_steps_of_any_length() {
    // How a pile settles is chance: the heights of two piles differ by some per cent, their mean by less.
    let rest = |dt: f64| {
        let piles: Vec<_> = (1..=4).map(|seed| rest_of_pile(dt, seed)).collect();
        let mean = |of: fn(&(Scalar, Scalar)) -> Scalar| piles.iter().map(of).sum::<Scalar>() / 4.0;
        println!("dt {dt:.4}: mean heights and speeds {piles:.3?}");
        (mean(|p| p.0), mean(|p| p.1))
    };
    let (mean, _) = rest(1.0 / 60.0);
    for dt in [1.0 / 30.0, 1.0 / 240.0] {
        let (other, speed) = rest(dt);
        assert!((other - mean).abs() < 0.05 * mean, "dt {dt}: {other}, not {mean}");
        assert!(speed < 0.1, "dt {dt}: still at {speed} m/s");
    }
}
