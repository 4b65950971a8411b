//! Fast bodies: what they pass by leaves them alone, and what is in their way stops them.

use super::dim::{any_rotation, bullets, sized};
use super::extreme::Dice;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::{BodyKind, ColliderDef, Velocity};

const BALL: f32 = 0.05;

/// A simulation without gravity, at 64 Hz.
fn free() -> Sim {
    let mut sim = Sim::new();
    (sim.dt, sim.substeps, sim.gravity) = (1.0 / 64.0, 6, Vector::ZERO);
    sim
}

fn cuboid(x: f32, y: f32, depth: f32) -> Shape {
    Shape::Cuboid(Cuboid { half: sized(x, y, depth) })
}

/// Sets the speculative margin of a body's collider.
fn limit(sim: &mut Sim, id: u32, speculative: f32) {
    let def = ColliderDef { speculative, ..sim.colliders[id].def.clone() };
    sim.colliders.redefine(id, def, &mut sim.bodies);
}

fn shoot(sim: &mut Sim, id: u32, velocity: Vector) {
    let angular = sim.bodies.velocities[id as usize].angular;
    sim.bodies.set_velocity(id, Velocity { linear: velocity, angular });
}

/// A ball whose speculative margin is small does not feel a surface from afar, whatever that of
/// the surface is.
#[test]
fn the_margin_of_a_wall_does_not_widen_that_of_a_ball() {
    for margin in [0.0f32, 0.02] {
        let mut sim = free();
        sim.sweeps = false;
        sim.add(BodyKind::Static, cuboid(0.5, 4.0, 4.0), Vector::X * 0.5, Rot::IDENTITY);
        let ball = sim.ball(BALL, Vector::X * -(BALL + 0.3));
        limit(&mut sim, ball, margin);
        shoot(&mut sim, ball, Vector::X * 25.6);
        sim.step();
        // 0.4 m in a step: the ball ends 0.1 m within the wall.
        assert!((sim.position(ball).to_local().x - 0.05).abs() < 1e-3, "{margin}: {:?}", sim.position(ball));
    }
}

/// What does not move needs no margin: a ball with an unlimited one is stopped by a wall with none.
#[test]
fn the_margin_of_a_wall_does_not_limit_that_of_a_ball() {
    for margin in [0.0f32, 0.02] {
        let mut sim = free();
        sim.sweeps = false;
        let wall = sim.add(BodyKind::Static, cuboid(0.5, 4.0, 4.0), Vector::X * 0.5, Rot::IDENTITY);
        limit(&mut sim, wall, margin);
        let ball = sim.ball(BALL, Vector::X * -(BALL + 0.3));
        shoot(&mut sim, ball, Vector::X * 25.6);
        sim.step();
        assert!(sim.position(ball).to_local().x < 1e-3 - BALL, "{margin}: {:?}", sim.position(ball));
    }
}

/// A ball with a margin rests on a floor as any other.
#[test]
fn a_ball_with_a_small_margin_rests_on_a_floor() {
    for margin in [0.0f32, 0.02] {
        let mut sim = free();
        sim.gravity = Vector::Y * -10.0;
        sim.floor();
        let ball = sim.ball(BALL, Vector::Y * 0.5);
        limit(&mut sim, ball, margin);
        sim.steps(200);
        let (place, velocity) = (sim.position(ball).to_local(), sim.bodies.velocities[ball as usize].linear);
        assert!(
            (place.y - BALL).abs() < 0.005 && velocity.length() < 0.01,
            "{margin}: {place:?} {velocity:?}"
        );
    }
}

/// Balls that pass a box at some gap, from all phases of a step and at some angles.
#[test]
fn a_ball_that_passes_a_box_is_not_deflected() {
    let mut bad = Vec::new();
    for gap in [0.05, 0.02, 0.01, 0.002] {
        for speed in [1.0, 5.0, 20.0, 60.0, 150.0] {
            // What is slow and all but touches is held at its present plane.
            if gap < 0.005 && speed < 5.0 {
                continue;
            }
            for slope in [0.0, 0.3, 1.0f32] {
                let direction = (Vector::X + Vector::Y * slope) * (1.0 / (1.0 + slope * slope).sqrt());
                // The corner nearest to the path is the upper left one, or all of the top.
                let corner = sized(-0.5, 0.5, 0.0);
                let normal = sized(-direction.y, direction.x, 0.0);
                let deflected = (0..20)
                    .filter(|k| {
                        let mut sim = free();
                        sim.add(BodyKind::Static, cuboid(0.5, 0.5, 0.5), Vector::ZERO, Rot::IDENTITY);
                        let before = 0.2 + speed * sim.dt * (2.0 + *k as f32 / 20.0);
                        let start = corner + normal * (BALL + gap) - direction * before;
                        let ball = sim.ball(BALL, start);
                        shoot(&mut sim, ball, direction * speed);
                        let time = (2.0 * before + 2.0) / speed;
                        sim.steps((time / sim.dt) as usize + 1);
                        (sim.bodies.velocities[ball as usize].linear - direction * speed).length()
                            > 1e-4 * speed
                    })
                    .count();
                if deflected > 0 {
                    bad.push((gap, speed, slope, deflected));
                }
            }
        }
    }
    assert!(bad.is_empty(), "gap, speed, slope, deflected of 20: {bad:?}");
}

/// Two balls that pass each other are not deflected either.
#[test]
fn balls_that_pass_each_other_are_not_deflected() {
    for (gap, speed) in [0.05, 0.01, 0.002].into_iter().flat_map(|g| [5.0, 20.0, 60.0, 150.0].map(|s| (g, s)))
    {
        for k in 0..20 {
            let mut sim = free();
            let before = speed * sim.dt * (1.0 + k as f32 / 20.0);
            let at = |side: f32| sized(-before * side, (BALL + 0.5 * gap) * side, 0.0);
            let balls = [1.0, -1.0].map(|side| (sim.ball(BALL, at(side)), Vector::X * (speed * side)));
            balls.iter().for_each(|(ball, velocity)| shoot(&mut sim, *ball, *velocity));
            sim.steps(4);
            for (ball, velocity) in balls {
                let changed = sim.bodies.velocities[ball as usize].linear - velocity;
                assert!(changed.length() < 1e-4 * speed, "gap {gap}, {speed} m/s, phase {k}: {changed:?}");
            }
        }
    }
}

/// How many of 60 balls of 5 cm pass a static wall of 1 cm.
fn pass(speed: f32, slope: f32, restitution: f32) -> usize {
    (0..60)
        .filter(|k| {
            let mut sim = free();
            sim.add_with(
                BodyKind::Static,
                cuboid(0.005, 40.0, 40.0),
                Vector::ZERO,
                Rot::IDENTITY,
                0.0,
                restitution,
            );
            let shape = Shape::Ball(Ball { radius: BALL });
            let start = -(0.3 + speed / 64.0 * (*k as f32 / 60.0));
            let ball =
                sim.add_with(BodyKind::Dynamic, shape, Vector::X * start, Rot::IDENTITY, 0.0, restitution);
            shoot(&mut sim, ball, (Vector::X + Vector::Y * slope) * speed);
            sim.steps((0.4 / speed * 64.0) as usize + 5);
            let velocity = sim.bodies.velocities[ball as usize].linear;
            // It keeps its speed along the wall, and rebounds with the share of the restitution.
            let along = (velocity.y - slope * speed).abs() < 0.01 * speed;
            let back = (velocity.x + restitution * speed).abs() < 0.01 * speed;
            !(sim.position(ball).to_local().x < 0.0 && along && back)
        })
        .count()
}

#[test]
fn balls_rebound_from_a_thin_wall_at_any_speed() {
    for speed in [5.0, 20.0, 60.0, 150.0, 400.0, 1000.0] {
        for (slope, restitution) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5)] {
            let through = pass(speed, slope, restitution);
            assert_eq!(through, 0, "of 60 at {speed} m/s, slope {slope}, restitution {restitution}");
        }
    }
}

/// A spin of -0 is no spin: what met a body with one passed through it.
#[test]
fn a_spin_of_minus_zero_lets_nothing_through() {
    for x in [-0.4, -0.6, -0.8] {
        let mut sim = free();
        let ids = [x, 0.0].map(|x| sim.ball(BALL, Vector::X * x));
        let none = Velocity { linear: Vector::ZERO, angular: kernel::math::Angular::ZERO * -1.0 };
        sim.bodies.set_velocity(ids[0], Velocity { linear: Vector::X * 60.0, ..none });
        sim.bodies.set_velocity(ids[1], none);
        sim.step();
        let [a, b] = ids.map(|id| sim.bodies.velocities[id as usize].linear.x);
        assert!(a < 31.0 && b > 29.0, "from {x} m it goes on at {a} m/s, the other at {b} m/s");
    }
}

/// Shapes of all kinds that pass each other with a gap above one and below the other.
#[test]
fn shapes_that_pass_each_other_are_not_deflected() {
    let shapes = bullets(0.5);
    let mut bad = Vec::new();
    for (name_a, a) in &shapes {
        for (name_b, b) in &shapes {
            for speed in [20.0, 60.0] {
                let deflected = (0..30u64)
                    .filter(|seed| {
                        let dice = &mut Dice::new(*seed);
                        let turns = [any_rotation(dice), any_rotation(dice)];
                        let gap = 0.01 + 0.02 * dice.unit();
                        let above = a.local_aabb(turns[0]).max.y - b.local_aabb(turns[1]).min.y + gap;
                        let before = 1.0 + speed / 64.0 * dice.unit();
                        let mut sim = free();
                        let still = sim.add(BodyKind::Dynamic, a.clone(), Vector::ZERO, turns[0]);
                        let start = sized(-before, above, 0.3 * dice.signed());
                        let passing = sim.add(BodyKind::Dynamic, b.clone(), start, turns[1]);
                        shoot(&mut sim, passing, Vector::X * speed);
                        sim.steps((2.0 * before / speed * 64.0) as usize + 1);
                        let velocity = |id: u32| sim.bodies.velocities[id as usize].linear;
                        velocity(still).length() > 1e-3 * speed
                            || (velocity(passing) - Vector::X * speed).length() > 1e-3 * speed
                    })
                    .count();
                if deflected > 0 {
                    bad.push((name_b, name_a, speed, deflected));
                }
            }
        }
    }
    assert!(bad.is_empty(), "what passed what, m/s, deflected of 30: {bad:#?}");
}
