//! Restitution and conservation laws: rows 7 to 9 of the required physics.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use scenes::{Rng, scene::at};

use super::{
    dim,
    world::{Lab, assert_close},
};

/// The heights between bounces of a ball dropped from 10 m, the drop first.
fn bounces(e: Scalar, count: usize) -> Vec<Scalar> {
    let mut lab = Lab::with_steps(1.0 / 64.0, 6);
    lab.surfaces(0.5, e);
    lab.floor();
    let ball = lab.ball(0.5, at(0.0, 10.5, 0.0));
    let mut heights = vec![10.0];
    let (mut rising, mut highest) = (false, 0.0);
    for _ in 0..4000 {
        lab.steps(1);
        let (v, y) = (lab.velocity(ball).y, lab.at(ball).y - 0.5);
        if v > 0.0 && !rising {
            (rising, highest) = (true, 0.0);
        }
        highest = y.max(highest);
        if rising && v <= 0.0 {
            rising = false;
            heights.push(highest);
            if heights.len() > count {
                break;
            }
        }
    }
    heights
}

#[test]
fn a_ball_rebounds_to_e_squared_of_its_height() {
    for e in [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 0.95] {
        assert_close(bounces(e, 1)[1], e * e * 10.0, 0.03, &format!("e = {e}"));
    }
}

#[test]
fn an_elastic_ball_keeps_bouncing_and_never_higher() {
    let heights = bounces(1.0, 10);
    assert_eq!(heights.len(), 11, "it came to rest: {heights:?}");
    for pair in heights.windows(2) {
        assert!(pair[1] <= 10.0 * 1.0001, "above the start: {heights:?}");
        assert!(pair[1] >= 0.99 * pair[0], "more than 1 % lost: {heights:?}");
    }
}

#[test]
fn what_does_not_bounce_stays_down() {
    let mut lab = Lab::new();
    lab.surfaces(0.5, 0.0);
    lab.floor();
    let ball = lab.ball(0.5, at(0.0, 5.5, 0.0));
    lab.seconds(1.2);
    let mut highest: Scalar = 0.0;
    for _ in 0..120 {
        lab.steps(1);
        highest = highest.max(lab.at(ball).y - 0.5);
    }
    assert!(highest < 0.01, "rebounds to {highest}");
}

#[test]
fn impacts_along_a_line_share_momentum_as_restitution_says() {
    // v1' = (m1 − e m2) / (m1 + m2) v, v2' = (1 + e) m1 / (m1 + m2) v
    for (m1, m2, e) in [(1.0, 1.0, 1.0), (1.0, 1.0, 0.0), (1.0, 1.0, 0.5), (3.0, 1.0, 1.0), (1.0, 10.0, 0.8)]
    {
        let mut lab = Lab::weightless();
        lab.surfaces(0.0, e);
        let v = 4.0;
        let one = lab.ball(0.5, at(-2.0, 0.0, 0.0));
        lab.insert(one, (Mass(m1), LinearVelocity(Vector::X * v)));
        let two = lab.ball(0.5, at(0.0, 0.0, 0.0));
        lab.insert(two, Mass(m2));
        lab.seconds(2.0);
        let sum = m1 + m2;
        let got = [lab.velocity(one).x, lab.velocity(two).x];
        let want = [(m1 - e * m2) / sum * v, (1.0 + e) * m1 / sum * v];
        for (got, want) in got.into_iter().zip(want) {
            assert!((got - want).abs() < 0.01 * v, "masses {m1}, {m2}, e = {e}: {got} is not {want}");
        }
    }
}

/// Swings `count` of five balls against the others, and expects as many to leave at the far end.
fn cradle(count: usize, gap: f32, dt: f64) {
    let mut lab = Lab::with_steps(dt, 4);
    lab.gravity(Vector::ZERO);
    lab.surfaces(0.0, 1.0);
    let (v, run_up) = (2.0, 0.1);
    let balls: Vec<Entity> = (0..5)
        .map(|i| {
            let swung = i < count;
            let x = (1.0 + gap) * i as f32 - if swung { run_up } else { 0.0 };
            let ball = lab.ball(0.5, at(x, 0.0, 0.0));
            lab.insert(ball, (LinearVelocity(Vector::X * if swung { v } else { 0.0 }), SleepingDisabled));
            ball
        })
        .collect();
    lab.seconds(0.4);
    for (i, &ball) in balls.iter().enumerate() {
        let want = if i >= 5 - count { v } else { 0.0 };
        let got = lab.velocity(ball).x;
        assert!((got - want).abs() <= 0.05 * v, "{count} in: ball {i} has {got} m/s, not {want}");
    }
}

#[test]
fn as_many_balls_leave_a_newtons_cradle_as_enter() {
    for count in 1..5 {
        for dt in [1.0 / 60.0, 1.0 / 240.0, 1.0 / 4000.0] {
            cradle(count, 0.001, dt);
        }
        cradle(count, 0.05, 1.0 / 60.0);
    }
}

#[test]
fn a_free_swarm_keeps_its_momentum_and_gains_no_energy() {
    let mut lab = Lab::weightless();
    let mut rng = Rng::new(7);
    let shapes = dim::shapes();
    let bodies: Vec<Entity> = (0..60)
        .map(|i| {
            let (x, y) = ((i % 8) as f32 * 1.5 - 5.25, (i / 8) as f32 * 1.5 - 5.25);
            let body = lab.spawn((RigidBody::Dynamic, shapes[i % shapes.len()].clone(), at(x, y, 0.0)));
            let v = dim::sized(-x, -y, 0.0) + dim::sized(rng.between(-1.0, 1.0), rng.between(-1.0, 1.0), 0.0);
            lab.insert(body, LinearVelocity(v));
            body
        })
        .collect();
    lab.steps(1);
    let mass = |lab: &Lab, body| lab.get::<ComputedMass>(body).value();
    let momentum =
        |lab: &Lab| bodies.iter().fold(Vector::ZERO, |sum, &b| sum + lab.velocity(b) * mass(lab, b));
    let energy = |lab: &Lab| -> Scalar {
        bodies.iter().map(|&b| 0.5 * mass(lab, b) * lab.velocity(b).length_squared()).sum()
    };
    let scale: Scalar = bodies.iter().map(|&b| mass(&lab, b) * lab.velocity(b).length()).sum();
    let (before, start) = (momentum(&lab), energy(&lab));
    lab.steps(300);
    let change = (momentum(&lab) - before).length();
    assert!(change <= 1e-4 * scale, "momentum changed by {change} of {scale}");
    assert!(energy(&lab) < start, "energy grew from {start} to {}", energy(&lab));
}

/// The relative change of angular momentum in one off-centre impact of two balls.
fn spin_lost(dt: f64, v: Scalar, offset: Scalar) -> Scalar {
    let mut lab = Lab::with_steps(dt, 4);
    lab.gravity(Vector::ZERO);
    lab.surfaces(0.5, 0.5);
    let balls = [(-1.3, 0.5 * offset, v), (1.3, -0.5 * offset, -v)].map(|(x, y, v)| {
        let ball = lab.ball(0.5, at(x, y, 0.0));
        lab.insert(ball, LinearVelocity(Vector::X * v));
        ball
    });
    let mass = dim::ball_mass(0.5);
    let inertia = dim::BALL_INERTIA * mass * 0.25;
    let total = |lab: &Lab| -> Scalar {
        balls
            .iter()
            .map(|&b| {
                let (p, v) = (lab.at(b), lab.velocity(b));
                mass * (p.x * v.y - p.y * v.x) + inertia * lab.spin(b)
            })
            .sum()
    };
    lab.steps(1);
    let before = total(&lab);
    lab.seconds(1.0);
    let moved = lab.velocity(balls[0]).x;
    assert!(moved < 0.9 * v, "they met: {moved}");
    ((total(&lab) - before) / before).abs()
}

#[test]
fn an_impact_changes_angular_momentum_by_no_more_than_the_step_is_coarse() {
    let (v, offset) = (5.0, 0.5);
    let lost = [1.0 / 60.0, 1.0 / 240.0, 1.0 / 960.0].map(|dt| (dt, spin_lost(dt, v, offset)));
    for (dt, lost) in lost {
        let bound = v * dt as Scalar / offset;
        assert!(lost <= bound, "{lost} is more than v dt / b = {bound}");
    }
    // Balls that move farther than 2 cm in a step are followed to where they meet.
    let (_, coarse) = lost[0];
    assert!(coarse < 0.01, "{coarse} with steps of 1/60 s");
}
