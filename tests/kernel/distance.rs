//! Distances between bodies: rods, springs and chains.

use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Shape};
use kernel::solver::coordinate::DISTANCE;
use kernel::solver::{AXES, Axis, Give, JointDef, JointError, Spring};
use kernel::table::{BodyKind, Velocity};
use std::f32::consts::TAU;

fn rod_at(bodies: [u32; 2], anchors: [Vector; 2], length: f32) -> JointDef {
    JointDef::free(bodies, anchors).with([DISTANCE], Axis::limited(length, length))
}

fn rod(a: u32, b: u32, length: f32) -> JointDef {
    rod_at([a, b], [Vector::ZERO; 2], length)
}

fn spring(a: u32, b: u32, length: f32, spring: Spring) -> JointDef {
    rod(a, b, length).with([DISTANCE], Axis::limited(length, length).with_give(Give::Spring(spring)))
}

/// A body with the shape of a small ball.
fn bead(sim: &mut Sim, kind: BodyKind, position: Vector) -> u32 {
    sim.add(kind, Shape::Ball(Ball { radius: 0.1 }), position, Rot::IDENTITY)
}

fn distance(sim: &Sim, a: u32, b: u32) -> f32 {
    (sim.position(a).to_local() - sim.position(b).to_local()).length()
}

/// A chain hangs from a static bead. Returns its beads, the static one first, and its links.
fn chain(sim: &mut Sim, links: u32) -> (Vec<u32>, Vec<u32>) {
    let mut beads = vec![bead(sim, BodyKind::Static, Vector::ZERO)];
    let mut rods = Vec::new();
    for i in 1..=links {
        let next = bead(sim, BodyKind::Dynamic, Vector::Y * (-0.5 * i as f32));
        rods.push(sim.join(rod(*beads.last().unwrap(), next, 0.5)).unwrap());
        beads.push(next);
    }
    (beads, rods)
}

/// The period of a pendulum of amplitude θ is 2π √(L/g) (1 + θ²/16 + 11 θ⁴/3072 + …).
#[test]
fn a_pendulum_keeps_its_length_and_period() {
    for angle in [0.2f32, 1.0] {
        let mut sim = Sim::new();
        let pivot = bead(&mut sim, BodyKind::Static, Vector::ZERO);
        let (sin, cos) = (f64::from(angle).sin() as f32, f64::from(angle).cos() as f32);
        let bob = bead(&mut sim, BodyKind::Dynamic, Vector::X * sin - Vector::Y * cos);
        sim.join(rod(pivot, bob, 1.0)).unwrap();
        let (mut crossings, mut time) = (Vec::new(), 0.0);
        let mut last = sin;
        while crossings.len() < 11 {
            sim.step();
            time += sim.dt;
            let x = sim.position(bob).to_local().x;
            if (x < 0.0) != (last < 0.0) {
                crossings.push(time - sim.dt * x / (x - last));
            }
            last = x;
            let error = (distance(&sim, pivot, bob) - 1.0).abs();
            assert!(error < 2.0e-3, "a rod of 1 m is off by {error} m");
            assert!(time < 60.0, "it swings");
        }
        let period = (crossings[10] - crossings[0]) / 5.0;
        let a2 = angle * angle;
        let expected = TAU * 0.1f32.sqrt() * (1.0 + a2 / 16.0 + 11.0 * a2 * a2 / 3072.0);
        assert!((period / expected - 1.0).abs() < 0.005, "amplitude {angle}: {period} s for {expected} s");
    }
}

/// A body that hangs from its rim swings as a physical pendulum: T = 2π √(I / (m g r)).
#[test]
fn a_rod_from_off_centre_turns_its_body() {
    let mut sim = Sim::new();
    let pivot = bead(&mut sim, BodyKind::Static, Vector::ZERO);
    let bob = sim.ball(0.5, Vector::Y * -1.5);
    sim.join(rod_at([pivot, bob], [Vector::ZERO, Vector::Y * 0.5], 1.0)).unwrap();
    sim.bodies.set_velocity(bob, Velocity { linear: Vector::X * 0.5, ..Velocity::default() });
    let mut most = 0.0f32;
    for _ in 0..300 {
        sim.step();
        let frame = sim.bodies.frame(bob);
        let rim = frame.position.to_local() + frame.rotation.rotate(Vector::Y * 0.5);
        assert!((rim.length() - 1.0).abs() < 2.0e-3, "the rod is {} m long", rim.length());
        most = most.max(frame.rotation.small_turn().length());
    }
    assert!(most > 0.02, "the body turns: {most} rad");
}

/// In balance a spring of frequency f is longer by g / (2π f)².
#[test]
fn a_spring_gives_way_by_its_load() {
    for (frequency, damping_ratio) in [(1.0, 0.7), (3.0, 1.0)] {
        let mut sim = Sim::new();
        let pivot = bead(&mut sim, BodyKind::Static, Vector::ZERO);
        let bob = bead(&mut sim, BodyKind::Dynamic, Vector::Y * -1.0);
        let id = sim.join(spring(pivot, bob, 1.0, Spring { frequency, damping_ratio })).unwrap();
        sim.steps(600);
        let omega = TAU * frequency;
        let (stretch, expected) = (distance(&sim, pivot, bob) - 1.0, 10.0 / (omega * omega));
        assert!((stretch / expected - 1.0).abs() < 0.005, "{stretch} m for {expected} m");
        let force = sim.reaction(id).force.y as f64;
        assert!(
            (force / (10.0 * sim.mass(bob)) - 1.0).abs() < 0.002,
            "it pulls up with the weight: {force} N"
        );
    }
}

#[test]
fn a_chain_of_twenty_hangs_still_and_falls_asleep() {
    let mut sim = Sim::new();
    let (beads, _) = chain(&mut sim, 20);
    sim.steps(600);
    for (i, bead) in beads.iter().enumerate() {
        // The first rod is stretched by 20 m g · 2 / m · 7e-6 s² = 0.56 %, the last one hardly.
        let sag = (sim.position(*bead).to_local() + Vector::Y * (0.5 * i as f32)).length();
        assert!(sag <= 0.006 * 0.5 * i as f32, "bead {i} is off by {sag} m");
        let speed = sim.bodies.velocities[*bead as usize].linear.length();
        assert!(speed < 0.01, "bead {i} moves at {speed} m/s");
    }
    sim.sleeping = true;
    sim.steps(60);
    assert_eq!(sim.bodies.awake_dynamic().count(), 0, "it sleeps as one");
    assert!(sim.colors.is_empty(), "what sleeps has no colours");
    let before = sim.bodies.poses.clone();
    sim.contact_manager().wake_body(beads[10]);
    assert_eq!(sim.bodies.awake_dynamic().count(), 20, "it wakes as one");
    sim.steps(120);
    let most = beads.iter().map(|bead| {
        let moved = sim.bodies.poses[*bead as usize].center - before[*bead as usize].center;
        moved.to_local().length()
    });
    assert!(most.fold(0.0, f32::max) < 1.0e-3, "impulses were kept: it hangs on as it did");
}

/// Two beads in the air, one of which only hangs on the rod: they are one island, and fall together.
#[test]
fn what_is_removed_wakes_what_it_held() {
    let mut asleep = Sim::new();
    asleep.sleeping = true;
    let (beads, rods) = chain(&mut asleep, 6);
    asleep.steps(200);
    assert_eq!(asleep.bodies.awake_dynamic().count(), 0);

    let mut sim = asleep.clone();
    sim.part(rods[3]).unwrap();
    assert_eq!(sim.part(rods[3]), Err(JointError::NoJoint(rods[3])));
    assert_eq!(sim.bodies.awake_dynamic().count(), 6, "all of the island wakes");
    sim.steps(60);
    let fallen = -sim.position(beads[4]).to_local().y - 2.0;
    assert!((fallen - 5.0).abs() < 0.2, "the lower half falls freely: {fallen} m");
    assert!((distance(&sim, beads[0], beads[3]) - 1.5).abs() < 0.01, "the upper half hangs");

    let mut sim = asleep.clone();
    sim.remove(beads[2]);
    assert_eq!(sim.bodies.awake_dynamic().count(), 5);
    assert_eq!(sim.part(rods[1]), Err(JointError::NoJoint(rods[1])), "its rods went with it");
    sim.steps(60);
    assert!(sim.position(beads[3]).to_local().y < -4.0 && sim.position(beads[1]).to_local().y > -0.6);

    // The chain hangs from a bead that becomes dynamic.
    let mut sim = asleep.clone();
    sim.contact_manager().retype(beads[0], BodyKind::Dynamic);
    assert_eq!(sim.bodies.awake_dynamic().count(), 7);
    sim.steps(60);
    assert!(sim.position(beads[0]).to_local().y < -4.0, "all fall");
    sim.contact_manager().retype(beads[3], BodyKind::Static);
    sim.steps(30);
    assert!((distance(&sim, beads[3], beads[4]) - 0.5).abs() < 0.02, "and hang from another one");
}

/// A kinematic body pulls, is not pulled, and keeps what it pulls awake.
#[test]
fn a_kinematic_body_pulls_what_hangs_on_it() {
    let mut sim = Sim::new();
    (sim.sleeping, sim.gravity) = (true, Vector::ZERO);
    let hand = bead(&mut sim, BodyKind::Kinematic, Vector::ZERO);
    let bob = bead(&mut sim, BodyKind::Dynamic, Vector::X * -1.0);
    sim.join(rod(hand, bob, 1.0)).unwrap();
    sim.bodies.set_velocity(hand, Velocity { linear: Vector::X * 0.05, ..Velocity::default() });
    let island = sim.contact_manager().island_of(bob).unwrap();
    assert!(sim.contact_manager().is_carried(island), "what is pulled may not sleep, however slowly");
    sim.sleeping = false;
    sim.steps(240);
    assert!((distance(&sim, hand, bob) - 1.0).abs() < 1.0e-3);
    assert!((sim.position(hand).to_local().x - 0.2).abs() < 1.0e-4, "the hand goes its own way");
    sim.bodies.set_velocity(hand, Velocity::default());
    sim.contact_manager().set_kinematic_awake(hand, false);
    sim.bodies.set_velocity(bob, Velocity::default());
    assert!(!sim.contact_manager().is_carried(island));
    sim.sleeping = true;
    sim.steps(60);
    assert_eq!(sim.bodies.awake_dynamic().count(), 0);
    sim.contact_manager().set_kinematic_awake(hand, true);
    assert_eq!(sim.bodies.awake_dynamic().count(), 1, "a hand that wakes wakes what it holds");
}

/// Nets of rods and springs fall on boxes: rows of all kinds, some in the overflow, some with locked axes.
fn net(sim: &mut Sim) {
    sim.sleeping = true;
    sim.floor();
    for i in 0..12 {
        sim.cuboid(Vector::ONE * 0.5, Vector::X * (1.1 * i as f32) + Vector::Y * 0.5);
    }
    let hub = bead(sim, BodyKind::Dynamic, Vector::X * 6.0 + Vector::Y * 5.0);
    let mut rows: Vec<Vec<u32>> = Vec::new();
    for row in 0..6 {
        let height = 2.0 + 0.4 * row as f32;
        rows.push(
            (0..24)
                .map(|i| bead(sim, BodyKind::Dynamic, Vector::X * (0.5 * i as f32) + Vector::Y * height))
                .collect(),
        );
    }
    for (i, row) in rows.iter().enumerate() {
        for (k, &a) in row.iter().enumerate() {
            if let Some(&b) = row.get(k + 1) {
                let soft = spring(a, b, 0.5, Spring { frequency: 5.0, damping_ratio: 0.3 });
                sim.join(if k % 3 == 0 { soft } else { rod(a, b, 0.5) }).unwrap();
            }
            if let Some(below) = i.checked_sub(1) {
                let anchors = [Vector::X * 0.1, Vector::X * -0.1];
                sim.join(rod_at([a, rows[below][k]], anchors, 0.45)).unwrap();
            }
        }
    }
    for &a in &rows[5] {
        let length = distance(sim, hub, a);
        sim.join(rod(hub, a, length)).unwrap();
    }
    sim.locks[rows[2][5] as usize] = kernel::math::AxisLocks(0b100_000);
    assert!(
        sim.contact_manager()
            .colors
            .constraints(kernel::graph::ConstraintKind::Joint, kernel::graph::OVERFLOW)
            .len()
            > 2
    );
    sim.steps(90);
}

#[test]
fn bits_do_not_depend_on_workers_or_lanes() {
    let run = |workers, is_narrow| {
        let mut sim = Sim::new();
        sim.set_workers(workers);
        if is_narrow {
            sim.set_narrow();
        }
        net(&mut sim);
        assert!(sim.bodies.poses.iter().all(|pose| pose.center.is_finite_world()));
        (sim.shared, format!("{:?} {:?}", sim.bodies.poses, sim.bodies.velocities))
    };
    let (_, one) = run(1, false);
    for (workers, is_narrow) in [(1, true), (2, false), (4, true), (4, false)] {
        let (shared, same) = run(workers, is_narrow);
        assert!(workers == 1 || shared > 4, "stages are shared");
        assert!(one == same, "{workers} workers, narrow: {is_narrow}");
    }
}

#[test]
fn hostile_input_is_told() {
    let mut sim = Sim::new();
    let a = bead(&mut sim, BodyKind::Dynamic, Vector::ZERO);
    let b = bead(&mut sim, BodyKind::Dynamic, Vector::X);
    assert_eq!(sim.join(rod(a, a, 1.0)), Err(JointError::SameBody(a)));
    assert_eq!(sim.join(rod(a, 77, 1.0)), Err(JointError::NoBody(77)));
    assert_eq!(sim.join(rod(u32::MAX, b, 1.0)), Err(JointError::NoBody(u32::MAX)));
    for length in [-1.0, f32::INFINITY, f32::NAN] {
        assert_eq!(sim.join(rod(a, b, length)), Err(JointError::Axis(DISTANCE)));
    }
    let anchors = [Vector::X * f32::NAN, Vector::ZERO];
    assert!(matches!(sim.join(rod_at([a, b], anchors, 1.0)), Err(JointError::Frame(_))));
    for (frequency, damping_ratio) in
        [(0.0, 1.0), (-1.0, 1.0), (f32::NAN, 1.0), (1.0, -0.1), (1.0, f32::INFINITY)]
    {
        let def = spring(a, b, 1.0, Spring { frequency, damping_ratio });
        assert_eq!(sim.join(def), Err(JointError::Axis(DISTANCE)));
    }
    for damping in [f32::NAN, -1.0, f32::INFINITY] {
        let def = JointDef { damping: [0.0, damping], ..rod(a, b, 1.0) };
        assert!(matches!(sim.join(def), Err(JointError::Damping(_))));
    }
    for compliance in [f32::NAN, -1.0, 0.0] {
        let axis = Axis::limited(0.0, 1.0).with_give(Give::Compliance(compliance));
        assert_eq!(sim.join(rod(a, b, 1.0).with([AXES - 1], axis)), Err(JointError::Axis(AXES - 1)));
    }
    assert_eq!(sim.part(0), Err(JointError::NoJoint(0)));
    assert_eq!(sim.rejoin(0, rod(a, b, 1.0)), Err(JointError::NoJoint(0)));
    assert_eq!(sim.reaction(9), Default::default());
    // Two coincident points have no direction, but separate. Constraints between immovable bodies
    // have no effect.
    sim.gravity = Vector::ZERO;
    let c = bead(&mut sim, BodyKind::Static, Vector::Y * 3.0);
    let d = bead(&mut sim, BodyKind::Static, Vector::Y * 5.0);
    sim.join(rod_at([a, b], [Vector::X, Vector::ZERO], 1.0)).unwrap();
    sim.join(rod(c, d, 1.0)).unwrap();
    sim.steps(60);
    assert!(sim.bodies.poses.iter().all(|pose| pose.center.is_finite_world()));
    let apart = sim.bodies.frame(a).transform(Vector::X).to_local() - sim.position(b).to_local();
    assert!((apart.length() - 1.0).abs() < 0.02, "{apart:?}");
}
