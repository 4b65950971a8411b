//! Closed forms and stability, on the kernel alone.

use super::dim::{BALL_INERTIA, sized, spin, spin_of, turned};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Capsule, Cuboid, Shape};
use kernel::table::BodyKind;

#[test]
fn a_box_comes_to_rest_on_the_floor() {
    let mut sim = Sim::new();
    sim.floor();
    let id = sim.cuboid(Vector::ONE * 0.5, Vector::Y * 2.0);
    sim.steps(180);
    let p = sim.position(id);
    assert!((p.y - 0.5).abs() < 0.01, "rests at {p:?}");
    assert!(p.x.abs() < 0.01, "landed flat, it hardly shifts: {p:?}");
    assert!(sim.bodies.velocities[id as usize].linear.length() < 1e-3);
}

/// Builds a pyramid of unit boxes and returns its top.
fn pyramid(sim: &mut Sim, base: usize, x: f32) -> u32 {
    let mut top = 0;
    for row in 0..base {
        for col in 0..base - row {
            let x = x + 0.5 * row as f32 + col as f32 - 0.5 * base as f32;
            top = sim.cuboid(Vector::ONE * 0.5, Vector::X * x + Vector::Y * (0.5 + row as f32));
        }
    }
    top
}

#[test]
fn a_pyramid_stands() {
    let mut sim = Sim::new();
    sim.floor();
    let top = pyramid(&mut sim, 20, 0.0);
    sim.steps(300);
    let before = sim.position(top);
    sim.steps(300);
    let after = sim.position(top);
    assert!((after - before).length() < 0.01, "the top moved from {before:?} to {after:?}");
    assert!(before.y > 19.5 - 0.4, "the top sagged to {before:?}");
}

#[test]
fn towers_stand() {
    for height in [10, 20, 50] {
        let mut sim = Sim::new();
        sim.floor();
        let mut top = 0;
        for i in 0..height {
            top = sim.cuboid(Vector::ONE * 0.5, Vector::Y * (0.5 + i as f32));
        }
        sim.steps(600);
        let p = sim.position(top);
        // Each contact sags by the load above it, and the tower by the square of its height: half as
        // much was seen.
        let height_squared = (height * height) as kernel::math::Scalar;
        assert!(
            p.y > height as kernel::math::Scalar - 0.5 - 3.0e-4 * height_squared && p.x.abs() < 0.01,
            "the top of {height} is at {p:?}"
        );
    }
}

#[test]
fn a_box_sticks_below_the_angle_of_friction_and_slides_above_it() {
    let mu = 0.5f32;
    for (offset, slides) in [(-0.5f64, false), (0.5, true)] {
        let angle = f64::from(mu).atan() + offset.to_radians();
        let tilt = turned(angle as f32);
        let mut sim = Sim::new();
        let half = Vector::ONE * 50.0;
        sim.add_with(
            BodyKind::Static,
            Shape::Cuboid(Cuboid { half }),
            tilt.rotate(Vector::Y * -50.0),
            tilt,
            mu,
            0.0,
        );
        let at = tilt.rotate(Vector::Y * 0.25);
        let shape = Shape::Cuboid(Cuboid { half: sized(0.5, 0.25, 0.5) });
        let id = sim.add_with(BodyKind::Dynamic, shape, at, tilt, mu, 0.0);
        sim.steps(60);
        let v0 = sim.bodies.velocities[id as usize].linear.length();
        sim.steps(120);
        let v1 = sim.bodies.velocities[id as usize].linear.length();
        if slides {
            let want = 10.0 * (angle.sin() - f64::from(mu) * angle.cos());
            let got = f64::from(v1 - v0) / 2.0;
            assert!((got - want).abs() < 0.02 * want, "slides with {got}, not {want}");
        } else {
            assert!(v1 < 1e-3, "creeps at {v1}");
        }
    }
}

#[test]
fn a_ball_rolls_down_as_a_solid_ball_does() {
    let angle = 15.0f64.to_radians();
    let tilt = turned(-angle as f32);
    let mut sim = Sim::new();
    let half = Vector::ONE * 50.0;
    sim.add(BodyKind::Static, Shape::Cuboid(Cuboid { half }), tilt.rotate(Vector::Y * -50.0), tilt);
    let id = sim.ball(0.5, tilt.rotate(Vector::Y * 0.5));
    sim.steps(120);
    let v0 = sim.bodies.velocities[id as usize].linear.length();
    sim.steps(60);
    let v1 = sim.bodies.velocities[id as usize].linear.length();
    let want = 10.0 * angle.sin() / f64::from(1.0 + BALL_INERTIA);
    assert!((f64::from(v1 - v0) - want).abs() < 0.01 * want, "{} is not {want}", v1 - v0);
    let w = spin_of(sim.bodies.velocities[id as usize].angular);
    assert!((w.abs() * 0.5 - v1).abs() < 0.01 * v1, "it rolls without slipping");
}

#[test]
fn round_shapes_do_not_sink_as_they_turn() {
    let ball = Shape::Ball(Ball { radius: 0.5 });
    let axis = sized(0.0, 0.0, 0.6);
    let roller = Shape::Capsule(Capsule { a: axis * -1.0, b: axis, radius: 0.5 });
    for shape in [ball, roller] {
        // Over a floor without friction, and on one with friction.
        for friction in [0.0, 0.5] {
            let mut sim = Sim::new();
            let floor = Shape::Cuboid(Cuboid { half: Vector::ONE * 200.0 });
            sim.add_with(BodyKind::Static, floor, Vector::Y * -200.0, Rot::IDENTITY, friction, 0.0);
            let y = Vector::Y * 0.5;
            let id = sim.add_with(BodyKind::Dynamic, shape.clone(), y, Rot::IDENTITY, friction, 0.0);
            sim.steps(30);
            let rest = sim.position(id).y;
            sim.bodies.velocities[id as usize].linear = Vector::X * 7.0;
            sim.bodies.velocities[id as usize].angular = spin(-14.0);
            for _ in 0..120 {
                sim.step();
                let (y, v) = (sim.position(id).y, sim.bodies.velocities[id as usize]);
                assert!((y - rest).abs() < 1e-4, "sank from {rest} to {y}");
                assert!(v.linear.y.abs() < 1e-3 && (v.linear.x - 7.0).abs() < 0.01, "{v:?}");
            }
        }
    }
}

#[test]
fn a_ball_that_slides_comes_to_roll_in_time() {
    // It decelerates by μ g until its contact point is at rest, at v₀ / (1 + k).
    let (mu, v0) = (0.2f32, 7.0f32);
    let mut sim = Sim::new();
    let floor = Shape::Cuboid(Cuboid { half: Vector::ONE * 200.0 });
    sim.add_with(BodyKind::Static, floor, Vector::Y * -200.0, Rot::IDENTITY, mu, 0.0);
    let ball = Shape::Ball(Ball { radius: 0.5 });
    let id = sim.add_with(BodyKind::Dynamic, ball, Vector::Y * 0.5, Rot::IDENTITY, mu, 0.0);
    sim.steps(15);
    sim.bodies.velocities[id as usize].linear = Vector::X * v0;
    let rolling = v0 / (1.0 + BALL_INERTIA);
    for i in 1..=120 {
        sim.step();
        let want = rolling.max(v0 - mu * 10.0 * i as f32 / 60.0);
        let got = sim.bodies.velocities[id as usize].linear.x;
        assert!((got - want).abs() < 5e-3, "step {i}: {got} m/s, not {want}");
    }
}

#[test]
fn a_ball_rebounds_to_e_squared_of_the_height() {
    for e in [0.1f32, 0.3, 0.5, 0.7, 0.95] {
        let mut sim = Sim::new();
        sim.substeps = 6;
        sim.dt = 1.0 / 64.0;
        let floor = Shape::Cuboid(Cuboid { half: Vector::ONE * 200.0 });
        sim.add_with(BodyKind::Static, floor, Vector::Y * -200.0, Rot::IDENTITY, 0.5, e);
        let id = sim.add_with(
            BodyKind::Dynamic,
            Shape::Ball(Ball { radius: 0.5 }),
            Vector::Y * 10.5,
            Rot::IDENTITY,
            0.5,
            e,
        );
        let mut bounced = false;
        let mut highest: f32 = 0.0;
        for _ in 0..400 {
            sim.step();
            let v = sim.bodies.velocities[id as usize].linear.y;
            bounced |= v > 0.0;
            if bounced {
                highest = highest.max(sim.position(id).to_local().y - 0.5);
                if v < 0.0 {
                    break;
                }
            }
        }
        let want = e * e * 10.0;
        assert!((highest - want).abs() < 0.03 * want + 0.01, "e = {e}: {highest}, not {want}");
    }
}

#[test]
fn an_elastic_ball_keeps_its_height() {
    let mut sim = Sim::new();
    let floor = Shape::Cuboid(Cuboid { half: Vector::ONE * 200.0 });
    sim.add_with(BodyKind::Static, floor, Vector::Y * -200.0, Rot::IDENTITY, 0.5, 1.0);
    let ball = Shape::Ball(Ball { radius: 0.5 });
    let id = sim.add_with(BodyKind::Dynamic, ball, Vector::Y * 5.5, Rot::IDENTITY, 0.5, 1.0);
    let (mut bounces, mut highest, mut last) = (0, 0.0f32, 5.0f32);
    let mut rising = false;
    for _ in 0..2400 {
        sim.step();
        let (v, y) = (sim.bodies.velocities[id as usize].linear.y, sim.position(id).to_local().y - 0.5);
        highest = if v > 0.0 && !rising { y } else { highest.max(y) };
        if rising && v <= 0.0 {
            bounces += 1;
            assert!((highest - last).abs() < 1e-5 * last, "{last} m, then {highest} m");
            last = highest;
        }
        rising = v > 0.0;
    }
    assert!(bounces > 15, "it went on bouncing: {bounces}");
}

#[test]
fn as_many_balls_leave_a_newtons_cradle_as_enter() {
    for count in 1..5 {
        let mut sim = Sim::new();
        sim.gravity = Vector::ZERO;
        let balls: Vec<u32> = (0..5)
            .map(|i| {
                let x = 1.001 * i as f32 - if i < count { 0.1 } else { 0.0 };
                let ball = Shape::Ball(Ball { radius: 0.5 });
                let id = sim.add_with(BodyKind::Dynamic, ball, Vector::X * x, Rot::IDENTITY, 0.0, 1.0);
                sim.bodies.velocities[id as usize].linear = Vector::X * if i < count { 2.0 } else { 0.0 };
                id
            })
            .collect();
        sim.steps(24);
        for (i, id) in balls.into_iter().enumerate() {
            let want = if i >= 5 - count { 2.0 } else { 0.0 };
            let got = sim.bodies.velocities[id as usize].linear.x;
            assert!((got - want).abs() <= 0.1, "{count} in: ball {i} has {got} m/s, not {want}");
        }
    }
}

#[test]
fn a_free_swarm_keeps_its_momentum() {
    let mut sim = Sim::new();
    sim.gravity = Vector::ZERO;
    let mut ids = Vec::new();
    for i in 0..40 {
        let p = sized((i % 7) as f32 * 1.4, (i / 7) as f32 * 1.4, 0.3 * (i % 3) as f32);
        let id = if i % 2 == 0 { sim.ball(0.5, p) } else { sim.cuboid(Vector::ONE * 0.4, p) };
        let away = p - sized(4.0, 4.0, 0.3);
        sim.bodies.velocities[id as usize].linear = away * -1.0;
        ids.push(id);
    }
    let momentum = |sim: &Sim| {
        ids.iter().fold(Vector::ZERO, |sum, id| {
            let mass = sim.colliders[*id].def.shape.mass_properties(1.0).mass;
            sum + sim.bodies.velocities[*id as usize].linear * mass
        })
    };
    let scale: f32 = ids.iter().map(|id| sim.bodies.velocities[*id as usize].linear.length()).sum();
    let before = momentum(&sim);
    sim.steps(240);
    let change = (momentum(&sim) - before).length();
    assert!(change < 1e-4 * scale, "momentum changed by {change} of {scale}");
}

#[test]
fn a_pile_falls_asleep_and_wakes_together() {
    let mut sim = Sim::new();
    sim.sleeping = true;
    sim.floor();
    let top = pyramid(&mut sim, 5, 0.0);
    sim.steps(240);
    assert_eq!(sim.bodies.awake_dynamic().count(), 0, "all asleep");
    assert_eq!(sim.contacts.active_len(), 0, "sleeping contacts cost nothing");
    let p = sim.position(top).to_local();
    sim.ball(0.2, p + Vector::Y * 1.5);
    let mut woken = 0;
    for _ in 0..60 {
        sim.step();
        woken = woken.max(sim.bodies.awake_dynamic().count());
    }
    assert_eq!(woken, 16, "the hit woke the pyramid");
    sim.steps(400);
    assert_eq!(sim.bodies.awake_dynamic().count(), 0, "and asleep again");
}

#[test]
fn a_falling_pile_gains_no_energy() {
    let mut sim = Sim::new();
    sim.floor();
    for i in 0..30 {
        let p = sized((i % 3) as f32 * 1.2, 1.0 + (i / 3) as f32 * 1.3, 0.2 * (i % 2) as f32);
        if i % 2 == 0 {
            sim.ball(0.5, p);
        } else {
            sim.cuboid(Vector::ONE * 0.45, p);
        }
    }
    let start = sim.energy();
    for _ in 0..300 {
        sim.step();
        assert!(sim.energy() < 1.001 * start, "{} J from {start} J", sim.energy());
    }
    assert!(sim.energy() < 0.7 * start, "it came to rest");
}

#[test]
fn the_same_bits_twice() {
    let run = || {
        let mut sim = Sim::new();
        sim.floor();
        pyramid(&mut sim, 8, 0.0);
        sim.ball(0.7, Vector::Y * 12.0 + Vector::X * 0.3);
        sim.steps(200);
        sim.bodies.poses.iter().map(|p| format!("{p:?}")).collect::<Vec<_>>()
    };
    assert_eq!(run(), run());
}

#[test]
fn a_copy_goes_on_with_the_same_bits() {
    let mut sim = Sim::new();
    sim.sleeping = true;
    sim.floor();
    pyramid(&mut sim, 8, 0.0);
    sim.ball(0.7, Vector::Y * 12.0 + Vector::X * 0.3);
    sim.steps(60);
    let mut copy = sim.clone();
    sim.steps(240);
    copy.steps(240);
    let bits = |sim: &Sim| sim.bodies.poses.iter().map(|p| format!("{p:?}")).collect::<Vec<_>>();
    assert_eq!(bits(&sim), bits(&copy));
}

#[test]
fn the_same_bits_with_four_lanes_and_with_as_many_as_there_are() {
    let run = |narrow: bool| {
        let mut sim = Sim::new();
        if narrow {
            sim.set_narrow();
        }
        sim.floor();
        pyramid(&mut sim, 9, 0.0);
        let ball = Shape::Ball(Ball { radius: 0.7 });
        let held = sim.cuboid(Vector::ONE * 0.5, Vector::X * 9.0 + Vector::Y * 0.5);
        sim.locks[held as usize] = kernel::math::AxisLocks(0b100_000);
        sim.add_with(BodyKind::Dynamic, ball, Vector::Y * 13.0 + Vector::X * 0.3, turned(0.4), 0.3, 0.5);
        sim.steps(240);
        let velocities = sim.bodies.velocities.iter().map(|v| format!("{v:?}"));
        sim.bodies.poses.iter().map(|p| format!("{p:?}")).chain(velocities).collect::<Vec<_>>()
    };
    assert_eq!(run(true), run(false));
}

#[test]
fn the_same_bits_with_any_number_of_workers() {
    let run = |workers: usize| {
        let mut sim = Sim::new();
        sim.set_workers(workers);
        sim.floor();
        pyramid(&mut sim, 40, 0.0);
        for i in 0..40 {
            let p = Vector::Y * (45.0 + i as f32) + Vector::X * (0.3 * i as f32 - 6.0);
            let ball = Shape::Ball(Ball { radius: 0.7 });
            let id = sim.add_with(BodyKind::Dynamic, ball, p, Rot::IDENTITY, 0.3, 0.5);
            sim.locks[id as usize] = kernel::math::AxisLocks(if i % 5 == 0 { 0b100_000 } else { 0 });
        }
        sim.steps(200);
        assert_eq!(sim.shared > 4, workers > 1, "{workers} workers share {} stages", sim.shared);
        let velocities = sim.bodies.velocities.iter().map(|v| format!("{v:?}"));
        sim.bodies.poses.iter().map(|p| format!("{p:?}")).chain(velocities).collect::<Vec<_>>()
    };
    let alone = run(1);
    for workers in [2, 4, 8] {
        assert!(run(workers) == alone, "{workers} workers");
    }
}

#[test]
fn a_kinematic_floor_carries_and_is_not_moved() {
    let mut sim = Sim::new();
    let floor = sim.add(
        BodyKind::Kinematic,
        Shape::Cuboid(Cuboid { half: sized(5.0, 0.5, 5.0) }),
        Vector::Y * -0.5,
        Rot::IDENTITY,
    );
    sim.bodies.velocities[floor as usize].linear = Vector::X * 0.5;
    let id = sim.cuboid(Vector::ONE * 0.5, Vector::Y * 0.5);
    sim.steps(240);
    let (v, p) = (sim.bodies.velocities[id as usize].linear, sim.position(floor));
    assert!((v.x - 0.5).abs() < 1e-2, "the box rides along at {v:?}");
    assert!((p.x - 2.0).abs() < 1e-3 && p.y == -0.5, "the floor moves as told: {p:?}");
}

#[test]
fn a_dominant_body_stands_on_what_cannot_be_moved() {
    for kind in [BodyKind::Static, BodyKind::Kinematic] {
        let mut sim = Sim::new();
        let half = sized(5.0, 0.5, 5.0);
        sim.add(kind, Shape::Cuboid(Cuboid { half }), Vector::Y * -0.5, Rot::IDENTITY);
        let id = sim.cuboid(Vector::ONE * 0.5, Vector::Y * 0.5);
        let yielding = sim.cuboid(Vector::ONE * 0.5, Vector::Y * 1.5);
        sim.bodies[id].dominance = 1;
        sim.bodies[yielding].dominance = -3;
        sim.bodies.any_dominance = true;
        sim.steps(120);
        let (below, above) = (sim.position(id).y, sim.position(yielding).y);
        assert!((below - 0.5).abs() < 0.01, "on what is {kind:?} it stands at {below}");
        assert!((above - 1.5).abs() < 0.01, "on it stands what yields, at {above}");
    }
}

#[test]
fn a_body_held_along_an_axis_only_moves_along_the_others() {
    let mut sim = Sim::new();
    sim.floor();
    let held = sim.cuboid(Vector::ONE * 0.5, Vector::Y * 0.5);
    sim.locks[held as usize] = kernel::math::AxisLocks(0b100_000);
    let ball = sim.ball(0.4, Vector::Y * 0.6 + Vector::X * -3.0);
    sim.bodies.velocities[ball as usize].linear = Vector::X * 8.0;
    sim.steps(120);
    let p = sim.position(held);
    assert_eq!(p.x, 0.0, "not pushed along x");
    assert!((p.y - 0.5).abs() < 0.02);
    let b = sim.position(ball);
    assert!(b.x < -0.85, "the ball stopped at what it could not move: {b:?}");
}
