//! The scenes that `tools/cost.sh` counts instructions in.
//!
//! Without a scene's name the program lists names and steps. With one it runs the scene and prints a
//! digest of the motion. A profiler collects in [`measured_steps`] only: building and settling a scene
//! is not counted.
//!
//! Shapes and places are written out here rather than taken from other tests. Two commits then run the same
//! scene.

use super::dim::floors::yawed;
use super::dim::{any_rotation, hull_of, sized, spin, terrain};
use super::extreme::Dice;
use super::ragdolls::{Losses, human};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{DIM, Rot, Vector};
use kernel::shape::{Ball, Capsule, Cuboid, Shape};
use kernel::solver::{Axis, JointDef};
use kernel::table::{BodyKind, Velocity};
use std::hint::black_box;

struct Scene {
    /// Names of scenes at rest begin with `resting`.
    name: &'static str,
    build: fn() -> Sim,
    /// Steps before those that are counted.
    settling: usize,
    measured: usize,
}

const SCENES: [Scene; 11] = [
    Scene { name: "resting-pyramid", build: pyramid, settling: 45, measured: 30 },
    Scene { name: "resting-towers", build: towers, settling: 45, measured: 60 },
    Scene { name: "resting-bodies", build: bodies, settling: 60, measured: 60 },
    Scene { name: "falling", build: falling, settling: 0, measured: 120 },
    Scene { name: "balls", build: balls, settling: 60, measured: 60 },
    Scene { name: "mixer", build: mixer, settling: 60, measured: 90 },
    Scene { name: "sliding-on-tiles", build: tiles, settling: 10, measured: 60 },
    Scene { name: "chains", build: chains, settling: 10, measured: 30 },
    Scene { name: "ragdolls", build: ragdolls, settling: 60, measured: 60 },
    Scene { name: "net", build: net, settling: 10, measured: 30 },
    Scene { name: "mesh", build: mesh, settling: 0, measured: 120 },
];

/// The simulation of all scenes: one worker, no sleep, no checks.
fn empty() -> Sim {
    let mut sim = Sim::new();
    (sim.checked, sim.sleeping) = (false, false);
    sim
}

/// The number of rows along z beside a number of columns along x.
fn rows(columns: usize) -> usize {
    if DIM == 2 { 1 } else { columns }
}

/// A number that differs between the dimensions.
fn by_dim(two: usize, three: usize) -> usize {
    if DIM == 2 { two } else { three }
}

/// Places of a grid that is centred on the y axis, from y = 0 upwards.
fn grid(columns: usize, count: usize, pitch: f32) -> impl Iterator<Item = Vector> {
    let rows = rows(columns);
    let centred = |k: usize, count: usize| k as f32 - 0.5 * (count as f32 - 1.0);
    (0..count).map(move |k| {
        let (x, z, y) = (k % columns, k / columns % rows, k / (columns * rows));
        sized(centred(x, columns), y as f32, centred(z, rows)) * pitch
    })
}

fn block(half: Vector) -> Shape {
    Shape::Cuboid(Cuboid { half })
}

/// Boxes, balls, capsules and hulls in turns.
fn mixed(i: usize, radius: f32) -> Shape {
    let along = Vector::X * (0.5 * radius);
    match i % 4 {
        0 => block(Vector::ONE * (0.8 * radius)),
        1 => Shape::Ball(Ball { radius }),
        2 => Shape::Capsule(Capsule { a: -along, b: along, radius: 0.6 * radius }),
        _ => hull_of(sized(1.0, 0.8, 0.9) * radius),
    }
}

fn fixed(sim: &mut Sim, half: Vector, at: Vector) {
    sim.add(BodyKind::Static, block(half), at, Rot::IDENTITY);
}

/// A floor and walls around the y axis.
fn bin(half: f32) -> Sim {
    let mut sim = empty();
    let (thick, high) = (1.0, 20.0);
    fixed(&mut sim, sized(half + 2.0, thick, half + 2.0), Vector::Y * -thick);
    for side in [-1.0, 1.0] {
        let away = side * (half + thick);
        fixed(&mut sim, sized(thick, high, half), sized(away, high, 0.0));
        if DIM == 3 {
            fixed(&mut sim, sized(half, high, thick), sized(0.0, high, away));
        }
    }
    sim
}

/// Drops bodies with any rotation onto what is in the simulation.
fn pour(sim: &mut Sim, places: impl Iterator<Item = Vector>, shape: impl Fn(usize) -> Shape) {
    let mut dice = Dice::new(5);
    for (i, at) in places.enumerate() {
        sim.add(BodyKind::Dynamic, shape(i), at, any_rotation(&mut dice));
    }
}

fn pyramid() -> Sim {
    let mut sim = empty();
    sim.floor();
    let base = by_dim(30, 10);
    for layer in 0..base {
        let columns = base - layer;
        for at in grid(columns, columns * rows(columns), 1.0) {
            sim.cuboid(Vector::ONE * 0.5, at + Vector::Y * (0.5 + layer as f32));
        }
    }
    sim
}

/// 20 towers of ten boxes.
fn towers() -> Sim {
    let mut sim = empty();
    sim.floor();
    for at in grid(by_dim(20, 5), 20, 2.0) {
        for i in 0..10 {
            sim.cuboid(Vector::ONE * 0.5, at + Vector::Y * (0.5 + i as f32));
        }
    }
    sim
}

/// 100 boxes, balls and capsules that touch the floor only.
fn bodies() -> Sim {
    let mut sim = empty();
    sim.floor();
    for (i, at) in grid(by_dim(100, 10), 100, 1.5).enumerate() {
        let shape = mixed(i % 3, 0.5);
        let at = at - Vector::Y * shape.local_aabb(Rot::IDENTITY).min.y;
        sim.add(BodyKind::Dynamic, shape, at, Rot::IDENTITY);
    }
    sim
}

/// 100 mixed bodies that fall into a bin and pile up.
fn falling() -> Sim {
    let columns = by_dim(10, 5);
    let mut sim = bin(0.5 * columns as f32);
    pour(&mut sim, grid(columns, 100, 0.95).map(|at| at + Vector::Y), |i| mixed(i, 0.45));
    sim
}

/// 200 balls of two sizes in a bin, while they settle.
fn balls() -> Sim {
    let columns = by_dim(20, 6);
    let mut sim = bin(0.5 * columns as f32);
    let ball = |i: usize| Shape::Ball(Ball { radius: if i.is_multiple_of(2) { 0.45 } else { 0.35 } });
    pour(&mut sim, grid(columns, 200, 0.95).map(|at| at + Vector::Y * 0.5), ball);
    sim
}

/// A paddle that turns in a bin of 100 mixed bodies.
fn mixer() -> Sim {
    let half = by_dim(5, 3) as f32;
    let mut sim = bin(half);
    let paddle = block(sized(0.8 * half, 0.2, 0.9 * half));
    let id = sim.add(BodyKind::Kinematic, paddle, Vector::Y * half, Rot::IDENTITY);
    sim.bodies.set_velocity(id, Velocity { angular: spin(2.0), ..Velocity::default() });
    let above = Vector::Y * (half + 1.0);
    pour(&mut sim, grid(by_dim(10, 6), 100, 0.95).map(|at| at + above), |i| mixed(i, 0.4));
    sim
}

/// 100 boxes that slide along x over tiles of a metre, turned about the vertical in 3D.
fn tiles() -> Sim {
    let mut sim = empty();
    let (columns, across) = (by_dim(220, 32), rows(22));
    for k in 0..columns * across {
        let (i, j) = (k / across, k % across);
        let at = sized(i as f32 - 0.13, -0.5, j as f32 - 0.29);
        sim.add_with(BodyKind::Static, block(Vector::ONE * 0.5), at, Rot::IDENTITY, 0.3, 0.0);
    }
    let mut dice = Dice::new(17);
    for k in 0..100 {
        let (i, j) = (k / rows(10), k % rows(10));
        let at = sized(1.0 + 2.0 * i as f32, 0.5, 1.0 + 2.0 * j as f32);
        let turn = yawed(&mut dice);
        let id = sim.add_with(BodyKind::Dynamic, block(Vector::ONE * 0.5), at, turn, 0.3, 0.0);
        let linear = Vector::X * 9.0;
        sim.bodies.set_velocity(id, Velocity { linear, ..Velocity::default() });
    }
    sim
}

/// 20 chains of 20 links that swing.
fn chains() -> Sim {
    let mut sim = empty();
    for at in grid(by_dim(20, 5), 20, 30.0) {
        let mut last = (sim.add(BodyKind::Static, block(Vector::ONE * 0.1), at, Rot::IDENTITY), Vector::ZERO);
        for k in 0..20 {
            let at = at + Vector::X * (k as f32 + 0.5);
            let id = sim.add(BodyKind::Dynamic, block(sized(0.5, 0.1, 0.1)), at, Rot::IDENTITY);
            sim.ghost(id);
            pin(&mut sim, [last.0, id], [last.1, Vector::X * -0.5]);
            last = (id, Vector::X * 0.5);
        }
    }
    sim
}

/// 20 humans that fall into a bin, on each other.
fn ragdolls() -> Sim {
    let columns = by_dim(4, 2);
    let mut sim = bin(columns as f32);
    for at in grid(columns, 20, 2.0) {
        human(&mut sim, at + Vector::Y * 2.0, Rot::IDENTITY, Losses::NONE);
    }
    sim
}

/// A net of 20 by 20 balls that hangs on four of them.
fn net() -> Sim {
    let mut sim = empty();
    let mut ids = Vec::new();
    for y in 0..20 {
        for x in 0..20 {
            let at = sized(x as f32, -(y as f32), 0.0);
            let kind = if y == 0 && x % 6 == 0 { BodyKind::Static } else { BodyKind::Dynamic };
            let id = sim.add(kind, Shape::Ball(Ball { radius: 0.3 }), at, Rot::IDENTITY);
            sim.ghost(id);
            ids.push(id);
            for (dx, dy) in [(1, 0), (0, 1)] {
                if x >= dx && y >= dy {
                    let half = sized(dx as f32, -(dy as f32), 0.0) * 0.5;
                    pin(&mut sim, [ids[(y - dy) * 20 + x - dx], id], [half, half * -1.0]);
                }
            }
        }
    }
    sim
}

fn pin(sim: &mut Sim, bodies: [u32; 2], anchors: [Vector; 2]) {
    sim.join(JointDef::free(bodies, anchors).with(0..DIM, Axis::LOCKED)).unwrap();
}

/// 100 small mixed bodies that fall onto a hilly surface with a rim, and roll.
fn mesh() -> Sim {
    let mut sim = empty();
    let rim = |x: f32, from: f32| 2.0 * (x.abs() - from).max(0.0);
    let hills = |x: f32, z: f32| 0.2 * (1.9 * x).sin() * (1.3 * z).cos();
    let ground = terrain(0.25, |x: f32, z: f32| {
        hills(x, z) + rim(x - 5.5, 7.5) + if DIM == 2 { 0.0 } else { rim(z, 1.5) }
    });
    sim.add(BodyKind::Static, ground, Vector::ZERO, Rot::IDENTITY);
    let places = (0..100).map(|k| {
        let (i, j) = (k % 20, k / 20);
        let height = 0.8 + 0.7 * by_dim(j, 0) as f32;
        sized(5.5 + 0.7 * (i as f32 - 9.5), height, 0.65 * (j as f32 - 2.0))
    });
    pour(&mut sim, places, |i| mixed(i, 0.25));
    sim
}

/// The part of a run that is counted. Its name is known to `tools/cost.sh`.
#[inline(never)]
fn measured_steps(sim: &mut Sim, steps: usize) {
    sim.steps(steps);
    black_box(sim);
}

/// A number that is the same where bodies moved in the same way.
fn digest(sim: &Sim) -> u64 {
    let numbers = sim.bodies.velocities.iter().flat_map(|v| [v.linear.x, v.linear.y]);
    numbers.fold(0, |sum: u64, x| (sum ^ u64::from(x.to_bits())).wrapping_mul(0x0000_0100_0000_01B3))
}

pub fn main() {
    // `cargo bench` passes options.
    let Some(name) = std::env::args().skip(1).find(|argument| !argument.starts_with('-')) else {
        SCENES.iter().for_each(|scene| println!("{} {}", scene.name, scene.measured));
        return;
    };
    let scene = SCENES.iter().find(|scene| scene.name == name).expect("the name of a scene");
    let mut sim = (scene.build)();
    sim.steps(scene.settling);
    measured_steps(&mut sim, scene.measured);
    println!("{:016x}", digest(&sim));
}
