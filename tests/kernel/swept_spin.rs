//! A rotating rod hits bodies in its path, and does not affect bodies beside it.

use super::dim::{any_rotation, any_spin, hull_of, sized, spin, turned};
use super::extreme::Dice;
use super::sim::Sim;
use crate::kernel;
use kernel::bvh::{Mover, Movers, PairMask, TreeKind};
use kernel::math::{Rot, Vector};
use kernel::shape::{Aabb, Ball, Capsule, Cuboid, Shape};
use kernel::table::{BodyKind, Velocity};

const BALL: f32 = 0.1;
const THICK: f32 = 0.05;

fn rods(length: f32) -> [Shape; 2] {
    let half = 0.5 * length;
    let end = Vector::X * (half - THICK);
    [
        Shape::Cuboid(Cuboid { half: sized(half, THICK, THICK) }),
        Shape::Capsule(Capsule { a: -end, b: end, radius: THICK }),
    ]
}

/// Rotates a rod by half a turn at a speed, from a phase, beside a ball with the mass of one of some radius.
/// Returns whether the ball moved.
fn moves(rod: &Shape, speed: f32, phase: f32, at: Vector, weight: f32) -> bool {
    let mut sim = Sim::new();
    sim.gravity = Vector::ZERO;
    let rod = sim.add(BodyKind::Dynamic, rod.clone(), Vector::ZERO, turned(phase));
    let ball = sim.ball(BALL, at);
    sim.weigh(ball, &Shape::Ball(Ball { radius: weight }));
    sim.bodies.set_velocity(rod, Velocity { linear: Vector::ZERO, angular: spin(speed) });
    let steps = (core::f32::consts::PI / speed / sim.dt).ceil() as usize;
    let energy = 1.01 * sim.energy();
    (0..steps).any(|_| {
        sim.step();
        assert!(sim.energy() < energy, "{} of {energy} J", sim.energy());
        sim.bodies.velocities[ball as usize] != Velocity::default()
    })
}

fn polar(radius: f32, angle: f32) -> Vector {
    turned(angle).rotate(Vector::X * radius)
}

#[test]
fn a_rod_hits_each_ball_in_its_way_however_fast_it_turns() {
    for (length, speed) in [1.0, 3.0, 8.0].into_iter().flat_map(|l| [10.0, 20.0, 40.0].map(|s| (l, s))) {
        for (kind, rod) in rods(length).into_iter().enumerate() {
            for weight in [0.02, BALL, 1.0] {
                let missed = (0..20).filter(|k| {
                    let mut dice = Dice::new(*k);
                    // From beside the middle to where the end barely grazes it, up to half a turn away.
                    let out = 0.2 * length + dice.unit() * (0.3 * length + 0.5 * BALL);
                    let near = (2.0 * THICK + 1.1 * BALL) / out;
                    let ahead = near + dice.unit() * (2.8 - 2.0 * near);
                    let phase = 6.0 * dice.unit();
                    !moves(&rod, speed, phase, polar(out, phase + ahead), weight)
                });
                let missed = missed.count();
                assert_eq!(missed, 0, "of 20 by {length} m at {speed} rad/s, kind {kind}, weight {weight}");
            }
        }
    }
}

#[test]
fn a_rod_leaves_alone_what_it_passes_by() {
    for (length, speed) in [1.0, 3.0, 8.0].into_iter().flat_map(|l| [10.0, 20.0, 40.0].map(|s| (l, s))) {
        for (kind, rod) in rods(length).into_iter().enumerate() {
            for k in 0..20 {
                let mut dice = Dice::new(k);
                let (ahead, phase) = (3.0 * dice.unit(), 6.0 * dice.unit());
                let beyond = polar(rod.extent(Vector::ZERO) + BALL + 0.02, phase + ahead);
                let beside = sized(0.0, 0.0, THICK + BALL + 0.02);
                let above = polar(0.4 * length * dice.unit(), phase + ahead) + beside;
                let places = if beside == Vector::ZERO { vec![beyond] } else { vec![beyond, above] };
                for at in places {
                    let touched = moves(&rod, speed, phase, at, BALL);
                    assert!(!touched, "{length} m at {speed} rad/s, kind {kind}, at {at:?}");
                }
            }
        }
    }
}

/// A plate that falls over flat onto a slab of the same thickness comes to rest on it.
#[test]
fn a_plank_that_falls_over_does_not_pass_a_thin_floor() {
    for length in [2.0, 6.0, 20.0] {
        let mut sim = Sim::new();
        let half = sized(30.0, 0.01, 30.0);
        sim.add(BodyKind::Static, Shape::Cuboid(Cuboid { half }), Vector::ZERO, Rot::IDENTITY);
        let half = sized(0.5 * length, 0.01, 0.2);
        let start = turned(1.2);
        let up = start.rotate(Vector::X * (0.5 * length)).y + 0.02;
        let plank = sim.add(BodyKind::Dynamic, Shape::Cuboid(Cuboid { half }), Vector::Y * up, start);
        let mut lowest = f32::INFINITY;
        for _ in 0..400 {
            sim.step();
            let frame = sim.bodies.frame(plank);
            for end in [-0.5 * length, 0.5 * length] {
                lowest = lowest.min(frame.transform(Vector::X * end).to_local().y);
            }
        }
        assert!(lowest > -0.01, "{length} m: an end comes to {lowest} m");
    }
}

#[test]
fn a_fat_box_holds_each_place_a_shape_turns_through_in_the_step() {
    for k in 0..2_000 {
        let mut dice = Dice::new(k);
        let length = 0.5 + 9.5 * dice.unit();
        let [bar, capsule] = rods(length);
        let shape = match k % 3 {
            0 => bar,
            1 => capsule,
            _ => hull_of(sized(0.5 * length, 0.1, 0.3)),
        };
        let mut sim = Sim::new();
        let place = Vector::ONE * (20.0 * dice.signed());
        let start = any_rotation(&mut dice);
        let id = sim.add(BodyKind::Dynamic, shape.clone(), place, start);
        let angular = any_spin(&mut dice) * (80.0 * dice.unit());
        // The box of any body contains smaller turns.
        if shape.extent(Vector::ZERO) * angular.length() * sim.dt < 0.05 {
            continue;
        }
        let linear = Vector::X * (30.0 * dice.signed());
        sim.bodies.set_velocity(id, Velocity { linear, angular });
        sim.colliders.refresh(id, &sim.bodies, sim.fattening());
        let fat = sim.colliders.fat[id as usize].grown(1e-4);
        let most = sim.dt.min(1.5 / angular.length());
        for time in (0..=20).map(|i| i as f32 / 20.0 * most) {
            let mut pose = sim.bodies.poses[id as usize];
            pose.center += (linear * time).to_world();
            pose.rotation = Rot::IDENTITY.turned_by(angular * time).mul(start);
            let aabb = shape.aabb(&pose.frame(sim.bodies[id].local_center));
            assert!(fat.contains(&aabb), "shape {k} after {time} s: {aabb:?} is not in {fat:?}");
        }
    }
}

/// A body that is set spinning in the step it is spawned in must not keep its old box.
#[test]
fn a_mover_inserted_twice_counts_with_its_last_box() {
    let mover = |id: u32, size: f32, mask: PairMask| {
        let aabb = Aabb::new(Vector::ZERO, Vector::ONE * size);
        Mover { id, kind: TreeKind::Dynamic, mask, aabb }
    };
    let mut movers = Movers::default();
    assert!(movers.insert(mover(7, 1.0, PairMask::NONE)));
    assert!(movers.insert(mover(3, 1.0, PairMask::ALL)));
    assert!(!movers.insert(mover(7, 2.0, PairMask::ALL)));
    assert_eq!(movers.list(), [mover(7, 2.0, PairMask::ALL), mover(3, 1.0, PairMask::ALL)]);
}
