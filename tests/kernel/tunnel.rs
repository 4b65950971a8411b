//! Nothing passes what does not move, however fast it flies and spins.

use super::dim::{any_rotation, any_spin, bullets, sized, turned};
use super::extreme::Dice;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Cuboid, Shape};
use kernel::table::{BodyKind, ColliderDef, Velocity};

fn cuboid(x: f32, y: f32, depth: f32) -> Shape {
    Shape::Cuboid(Cuboid { half: sized(x, y, depth) })
}

/// Prediction and sweeps, on or off.
#[derive(Clone, Copy)]
struct Mode {
    predicts: bool,
    sweeps: bool,
}

const DEFAULT: Mode = Mode { predicts: true, sweeps: true };

/// Shoots a spinning body at a static wall at x = 0. Returns whether it got through within some steps.
fn passes(shape: &Shape, speed: f32, spin: f32, thickness: f32, dice: &mut Dice, mode: Mode) -> bool {
    let mut sim = Sim::new();
    sim.checked = false;
    (sim.dt, sim.substeps, sim.gravity) = (1.0 / 64.0, 6, Vector::ZERO);
    sim.add(BodyKind::Static, cuboid(0.5 * thickness, 1000.0, 1000.0), Vector::ZERO, Rot::IDENTITY);
    let extent = shape.extent(Vector::ZERO);
    let away = 0.5 * thickness + 1.05 * extent + speed * sim.dt * dice.unit();
    let rotation = any_rotation(dice);
    let id = sim.add(BodyKind::Dynamic, shape.clone(), Vector::X * -away, rotation);
    sim.sweeps = mode.sweeps;
    if !mode.predicts {
        let def = ColliderDef { speculative: 0.0, ..sim.colliders[id].def.clone() };
        sim.colliders.redefine(id, def, &mut sim.bodies);
    }
    let angular = any_spin(dice) * spin;
    let linear = turned(0.5 * dice.signed()).rotate(Vector::X * speed);
    sim.bodies.set_velocity(id, Velocity { linear, angular });
    (0..(away / speed * 64.0) as usize + 12).any(|_| {
        sim.step();
        // The ball within it gets through, not only a tip.
        sim.bodies.frame(id).transform(shape.core().0).to_local().x > 0.0
    })
}

fn through(shape: &Shape, speed: f32, spin: f32, thickness: f32, shots: u64) -> usize {
    through_in(DEFAULT, shape, speed, spin, thickness, shots)
}

fn through_in(mode: Mode, shape: &Shape, speed: f32, spin: f32, thickness: f32, shots: u64) -> usize {
    (0..shots).filter(|k| passes(shape, speed, spin, thickness, &mut Dice::new(*k), mode)).count()
}

/// The bodies of 5 cm.
#[test]
fn small_spinning_bodies_do_not_pass_a_thin_wall() {
    let mut bad = Vec::new();
    for (name, shape) in bullets(0.05) {
        for speed in [20.0, 50.0, 100.0, 200.0, 1000.0] {
            for (spin, thickness) in [(20.0, 0.01), (100.0, 0.01), (20.0, 0.1)] {
                let through = through(&shape, speed, spin, thickness, 120);
                if through > 0 {
                    bad.push((name, speed, spin, thickness, through));
                }
            }
        }
    }
    assert!(bad.is_empty(), "shape, speed, spin, wall, through of 120: {bad:#?}");
}

#[test]
fn long_rods_and_unit_boxes_do_not_pass_a_thin_wall() {
    let rods = [
        ("rod", cuboid(0.5, 0.025, 0.025)),
        ("thin rod", cuboid(0.5, 0.005, 0.005)),
        ("box", cuboid(0.5, 0.5, 0.5)),
    ];
    let mut bad = Vec::new();
    for (name, shape) in rods {
        for speed in [20.0, 50.0, 100.0] {
            for spin in [5.0, 20.0] {
                let through = through(&shape, speed, spin, 0.01, 60);
                if through > 0 {
                    bad.push((name, speed, spin, through));
                }
            }
        }
    }
    assert!(bad.is_empty(), "shape, speed, spin, through of 60: {bad:#?}");
}

/// Shapes of 2 to 50 cm at 20 to 2,000 m/s and up to 100 rad/s, at walls of 1 cm to 1 m.
#[test]
fn of_ten_thousand_random_bullets_none_passes_a_wall() {
    let passed: Vec<u64> = (0..10_000)
        .filter(|seed| {
            let dice = &mut Dice::new(*seed);
            let shapes = bullets(0.02 * 25.0f32.powf(dice.unit()));
            let shape = &shapes[*seed as usize % shapes.len()].1;
            let speed = 20.0 * 100.0f32.powf(dice.unit());
            let (spin, thickness) = (100.0 * dice.unit(), 0.01 * 100.0f32.powf(dice.unit()));
            passes(shape, speed, spin, thickness, dice, DEFAULT)
        })
        .collect();
    assert!(passed.is_empty(), "{} of 10,000 pass: {passed:?}", passed.len());
}

/// The table of `docs/design/collision-detection.md`.
pub fn table_of_modes() {
    let modes = [(false, false), (true, false), (false, true), (true, true)];
    for thickness in [0.01, 0.1, 1.0] {
        for speed in [20.0, 50.0, 100.0, 200.0, 1000.0] {
            let counts = modes.map(|(predicts, sweeps)| {
                let through = |(_, shape): &(_, Shape)| {
                    through_in(Mode { predicts, sweeps }, shape, speed, 20.0, thickness, 120)
                };
                let (shapes, all) = (bullets(0.05), bullets(0.05).len() * 120);
                let share = shapes.iter().map(through).sum::<usize>() as f32 / all as f32;
                format!("{:.1} %", 100.0 * share)
            });
            println!("| {speed} m/s | {} cm | {} |", 100.0 * thickness, counts.join(" | "));
        }
    }
}
