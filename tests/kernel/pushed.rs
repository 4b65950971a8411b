//! Bodies whose velocity was set by hand hit obstacles in the next step.

use super::dim::{sized, spin};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Cuboid, Shape};
use kernel::table::{BodyKind, Velocity};

const BALL: f32 = 0.1;

fn slab(half: Vector) -> Shape {
    Shape::Cuboid(Cuboid { half })
}

/// How many of 20 balls pass a wall of 2 cm, from rest at different distances within one step's motion.
fn pass(speed: f32) -> usize {
    (0..20)
        .filter(|k| {
            let mut sim = Sim::new();
            sim.gravity = Vector::ZERO;
            sim.add(BodyKind::Static, slab(sized(0.01, 2.0, 2.0)), Vector::ZERO, Rot::IDENTITY);
            let gap = speed / 60.0 * (*k as f32 + 0.5) / 20.0;
            let ball = sim.ball(BALL, Vector::X * -(0.01 + BALL + gap));
            sim.steps(30);
            sim.bodies.set_velocity(ball, Velocity { linear: Vector::X * speed, angular: spin(0.0) });
            sim.steps(30);
            sim.position(ball).x > 0.0
        })
        .count()
}

#[test]
fn a_resting_ball_that_is_shot_at_a_thin_wall_hits_it() {
    for speed in [10.0, 20.0, 60.0] {
        assert_eq!(pass(speed), 0, "of 20 pass at {speed} m/s");
    }
}
