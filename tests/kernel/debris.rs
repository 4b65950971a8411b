//! Small and thin things thrown onto ground of facets.

use super::dim::{any_rotation, any_spin, cone, cylinder, hull_of, sized, terrain};
use super::extreme::Dice;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Cuboid, HalfSpace, Shape};
use kernel::table::{BodyKind, Velocity};

fn hills(x: f32, z: f32) -> f32 {
    0.15 * (1.7 * x).sin() + 0.1 * (2.3 * z + 0.5).cos()
}

/// Grounds, each with the height below which a piece has passed it.
fn grounds() -> Vec<(&'static str, Shape, f32)> {
    vec![
        ("flat facets", terrain(0.25, |_, _| 0.0), -0.002),
        ("hills", terrain(0.25, hills), -0.4),
        ("half-space", Shape::HalfSpace(HalfSpace { normal: Vector::Y }), -0.002),
    ]
}

fn pieces() -> Vec<(&'static str, Shape)> {
    let cuboid = |x, y, z| Shape::Cuboid(Cuboid { half: sized(x, y, z) });
    vec![
        ("shell", cuboid(0.025, 0.005, 0.025)),
        ("splinter", cuboid(0.05, 0.005, 0.005)),
        ("brick", cuboid(0.05, 0.025, 0.025)),
        ("stone", hull_of(sized(0.03, 0.02, 0.03))),
    ]
}

/// Throws pieces that do not meet each other, and counts those that pass the ground, or keep a speed
/// but not move.
fn stuck((ground, lowest): (&Shape, f32), piece: &Shape, speed: f32) -> [usize; 2] {
    let mut sim = Sim::new();
    sim.checked = false;
    sim.add_with(BodyKind::Static, ground.clone(), Vector::ZERO, Rot::IDENTITY, 0.5, 0.0);
    let mut dice = Dice::new(speed as u64);
    let thrown: Vec<u32> = (0..100)
        .map(|_| {
            let start = sized(2.0 + 6.0 * dice.unit(), 1.0 + dice.unit(), 0.8 * dice.signed());
            let turn = any_rotation(&mut dice);
            let id = sim.add_with(BodyKind::Dynamic, piece.clone(), start, turn, 0.5, 0.0);
            sim.meets_static_only(id);
            let aim = sized(0.5 * dice.signed(), -1.0, 0.3 * dice.signed());
            let angular = any_spin(&mut dice) * 3.0;
            sim.bodies.set_velocity(id, Velocity { linear: aim * (speed / aim.length()), angular });
            id
        })
        .collect();
    sim.steps(300);
    let before: Vec<Vector> = thrown.iter().map(|id| sim.position(*id).to_local()).collect();
    sim.steps(30);
    let passed = before
        .iter()
        .filter(|at| at.x > -2.5 && at.x < 13.5 && super::dim::across(**at).abs() < 1.5 && at.y < lowest)
        .count();
    let is_stuck = |(id, before): &(&u32, &Vector)| {
        let moved = (sim.position(**id).to_local() - **before).length();
        let speed = sim.bodies.velocities[**id as usize].linear.length();
        before.y > lowest && speed > 0.2 && moved < 0.2 * speed
    };
    [passed, thrown.iter().zip(&before).filter(is_stuck).count()]
}

#[test]
fn debris_neither_passes_the_ground_nor_sticks_in_it() {
    let mut bad = Vec::new();
    for (name, ground, lowest) in grounds() {
        for (piece, shape) in pieces() {
            for speed in [5.0, 10.0, 20.0, 40.0] {
                let [passed, stuck] = stuck((&ground, lowest), &shape, speed);
                if passed + stuck > 0 {
                    bad.push((piece, name, speed, passed, stuck));
                }
            }
        }
    }
    assert!(bad.is_empty(), "piece, ground, m/s, passed, stuck of 100: {bad:#?}");
}

/// The ball within a needle was at one end, and swept along a chord while the needle turned. The middle of the
/// needle came under the surface first, and facets then pushed it down.
#[test]
fn needles_and_spikes_do_not_pass_facets() {
    let ground = terrain(0.25, |_, _| 0.0);
    for (name, piece, speed) in
        [("needle", cylinder(0.005, 0.025), 10.0), ("spike", cone(0.005, 0.025), 20.0)]
    {
        let [passed, _] = stuck((&ground, -0.002), &piece, speed);
        assert_eq!(passed, 0, "{name} at {speed} m/s: passed of 100");
    }
}
