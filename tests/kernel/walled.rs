//! Characters: bodies that cannot turn, and that the app drives into a wall of pieces while they fall
//! along it or jump.

use super::dim::floors::blocks;
use super::dim::{more_riders, sized, tiles};
use super::sim::Sim;
use super::units::{BINARY, DECIMAL};
use crate::kernel;
use kernel::math::{AxisLocks, Rot, Vector};
use kernel::shape::{Capsule, Cuboid, Shape};
use kernel::table::{BodyKind, Velocity};

const GRAVITY: f32 = 10.0;
const UPRIGHT: AxisLocks = AxisLocks(0b000_111);

/// A body at a wall: the wall is a floor on y = 0, and gravity pulls along it.
#[derive(Clone, Debug)]
struct Character {
    name: &'static str,
    shape: Shape,
    /// The same as a solid, which gives it a mass.
    solid: Shape,
}

/// How a character is driven.
#[derive(Clone, Copy, Debug)]
struct Drive {
    /// The velocity into the wall that the app sets each step, in m/s.
    speed: f32,
    /// Steps per second.
    rate: f32,
    /// How far from the wall the body starts, in metres.
    gap: f32,
    /// The velocity along the wall at the start, in m/s.
    along: f32,
    /// The length unit of the world.
    unit: f32,
}

/// Where a character comes in some steps from x = 0, and how deep in the wall it was at most.
fn run(wall: &[(Shape, Vector)], who: &Character, drive: Drive, steps: usize) -> [f32; 2] {
    let mut sim = Sim::new();
    (sim.checked, sim.dt, sim.gravity) = (false, 1.0 / drive.rate, Vector::X * GRAVITY);
    sim.unit = drive.unit;
    for (shape, place) in wall {
        sim.add_with(BodyKind::Static, shape.clone(), *place, Rot::IDENTITY, 0.0, 0.0);
    }
    let low = who.shape.local_aabb(Rot::IDENTITY).min.y;
    let at = Vector::Y * (drive.gap - low);
    let id = sim.add_with(BodyKind::Dynamic, who.shape.clone(), at, Rot::IDENTITY, 0.0, 0.0);
    sim.weigh(id, &who.solid);
    sim.locks[id as usize] = UPRIGHT;
    let linear = Vector::X * drive.along;
    sim.bodies.set_velocity(id, Velocity { linear, ..Velocity::default() });
    sim.enter_units();
    let mut deepest = 0.0f32;
    for _ in 0..steps {
        let Velocity { linear, angular } = sim.bodies.velocities[id as usize];
        let linear = Vector { y: -drive.speed * drive.unit, ..linear };
        sim.bodies.set_velocity(id, Velocity { linear, angular });
        sim.step();
        deepest = deepest.max(-low - sim.position(id).to_local().y / drive.unit);
    }
    [sim.position(id).to_local().x / drive.unit, deepest]
}

fn cuboid(half: Vector) -> Shape {
    Shape::Cuboid(Cuboid { half })
}

/// Boxes of several sizes, as cuboids, hulls and meshes, and others.
fn characters() -> Vec<Character> {
    let capsule = Shape::Capsule(Capsule { a: Vector::X * -0.3, b: Vector::X * 0.3, radius: 0.25 });
    let mut all = vec![
        ("box", cuboid(Vector::ONE * 0.5)),
        ("small box", cuboid(Vector::ONE * 0.1)),
        ("tall box", cuboid(sized(0.9, 0.3, 0.4))),
        ("capsule", capsule),
    ];
    all.extend(more_riders().into_iter().map(|(name, shape, _)| (name, shape)));
    let hulls = || blocks().into_iter().take(2);
    all.extend(hulls().map(|(name, hull, _)| (name, hull)));
    let solid = all.into_iter().map(|(name, shape)| Character { name, solid: shape.clone(), shape });
    let meshes = hulls().map(|(name, solid, shape)| Character { name, shape, solid });
    solid.chain(meshes).collect()
}

/// Asserts that characters fall and jump along walls of pieces as beside them, at some speeds and rates.
#[track_caller]
fn assert_free(unit: f32, drives: &[(f32, f32)]) {
    let mut bad = Vec::new();
    for (name, wall) in tiles() {
        for who in characters() {
            for &(speed, rate) in drives {
                for (gap, along) in [(0.03, 0.0), (0.0, -6.0)] {
                    let drive = Drive { speed, rate, gap, along, unit };
                    // Until it has fallen 14 m, or is at the top of its jump.
                    let seconds = if along < 0.0 { -along / GRAVITY } else { (28.0 / GRAVITY).sqrt() };
                    let steps = (seconds * rate) as usize;
                    let ([x, deepest], [free, _]) =
                        (run(&wall, &who, drive, steps), run(&[], &who, drive, steps));
                    if !((x / free - 1.0).abs() < 0.02 && deepest < 0.02) {
                        bad.push(format!(
                            "{name}, {}, {drive:?}: {x} of {free} m, {deepest} m deep",
                            who.name
                        ));
                    }
                }
            }
        }
    }
    assert!(bad.is_empty(), "{}: {bad:#?}", bad.len());
}

/// The velocity into the wall counted as motion: the top of the next piece, met inside of the wall, was taken
/// for ground. A fall of 20 m took up to 6.5 times as long, and a jump ended at a tenth of its height.
#[test]
fn characters_fall_and_jump_along_walls_of_pieces_as_beside_them() {
    assert_free(1.0, &[(1.0, 60.0), (3.0, 30.0), (5.0, 64.0), (10.0, 60.0), (10.0, 144.0)]);
}

#[test]
fn characters_fall_and_jump_along_walls_in_any_length_unit() {
    DECIMAL.into_iter().chain(BINARY).for_each(|unit| assert_free(unit, &[(5.0, 64.0)]));
}

/// What stands out of the wall is ground.
#[test]
fn characters_land_on_ledges_of_walls() {
    let mut bad = Vec::new();
    for (name, mut wall) in tiles() {
        for height in [0.002, 0.01, 0.2] {
            let ledge = (cuboid(sized(0.25, 0.25, 2.0)), sized(5.25, height - 0.25, 0.0));
            wall.push(ledge);
            // The others slip off a low ledge.
            let is_square = |who: &Character| {
                matches!(who.name, "box" | "small box" | "tall box" | "square" | "cube" | "plate")
            };
            for who in characters().into_iter().filter(is_square) {
                for (speed, rate) in [(1.0, 60.0), (10.0, 30.0), (10.0, 144.0)] {
                    let drive = Drive { speed, rate, gap: 0.0, along: 0.0, unit: 1.0 };
                    let [x, _] = run(&wall, &who, drive, (1.5 * rate) as usize);
                    let foot = x + who.shape.local_aabb(Rot::IDENTITY).max.x;
                    if !((foot - 5.0).abs() < 0.02) {
                        bad.push(format!(
                            "{name}, {}, {height} m, {drive:?}: its foot is at {foot} m",
                            who.name
                        ));
                    }
                }
            }
            wall.pop();
        }
    }
    assert!(bad.is_empty(), "{}: {bad:#?}", bad.len());
}
