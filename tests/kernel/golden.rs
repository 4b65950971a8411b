//! Golden hashes: final states of whole scenes, bit by bit, for any number of workers and lanes, in any
//! profile and on any machine.
//!
//! A scene may use sums, products, quotients, square roots and the kernel's own functions, but not libm. The
//! expected hashes are in `golden2.rs` and `golden3.rs`. If a change of the simulation is intended, the table
//! printed by the failing test replaces the old one, and the commit says why.

use super::dim::golden_dim::{GOLDEN, coordinates, numbers, shapes, spun, terrain, tilted, trough};
use super::dim::{container, sized, terrain as surface, turned};
use super::jointed::jointed;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{AxisLocks, DIM, Pose, Rot, Scalar, Vector, WorldPose};
use kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Shape};
use kernel::table::{BodyKind, Velocity};

/// Name of a scene, and the function that builds and runs it.
const SCENES: [(&str, fn(&mut Sim)); 18] = [
    ("pyramid", pyramid),
    ("towers", towers),
    ("pairs", pairs),
    ("heap", heap),
    ("terrain", on_terrain),
    ("slopes", slopes),
    ("composites", composites),
    ("bounces", bounces),
    ("crowd", crowd),
    ("sleepers", sleepers),
    ("held", held),
    ("dominance", dominance),
    ("spin", spin),
    ("mixer", mixer),
    ("changes", changes),
    ("wall", wall),
    ("joints", jointed),
    ("landing", landing),
];

fn ball(radius: f32) -> Shape {
    Shape::Ball(Ball { radius })
}

fn block(half: f32) -> Shape {
    Shape::Cuboid(Cuboid { half: Vector::ONE * half })
}

/// Pseudo-random fractions from 0 up to 1.
struct Chance(u32);

impl Chance {
    fn next(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (self.0 >> 8) as f32 / (1 << 24) as f32
    }
}

/// Adds a dynamic body. A shape without volume gets the mass of a ball.
fn body(sim: &mut Sim, shape: Shape, at: Vector, turn: Rot, friction: f32, restitution: f32) -> u32 {
    let hollow = shape.mass_properties(1.0).mass == 0.0;
    let id = sim.add_with(BodyKind::Dynamic, shape, at, turn, friction, restitution);
    if hollow {
        sim.weigh(id, &ball(0.4));
    }
    id
}

fn push(sim: &mut Sim, id: u32, linear: Vector) {
    let velocity = Velocity { linear, ..sim.bodies.velocities[id as usize] };
    sim.bodies.set_velocity(id, velocity);
}

/// Builds a pyramid of unit boxes. Returns the first of them.
fn stack(sim: &mut Sim, base: usize, x: f32) -> u32 {
    let first = sim.bodies.ids.len() as u32;
    for row in 0..base {
        for column in 0..base - row {
            let x = x + 0.5 * row as f32 + column as f32 - 0.5 * base as f32;
            sim.cuboid(Vector::ONE * 0.5, sized(x, 0.5 + row as f32, 0.0));
        }
    }
    first
}

/// A pyramid that a fast ball hits.
fn pyramid(sim: &mut Sim) {
    sim.floor();
    stack(sim, 12, 0.0);
    let id = sim.ball(0.8, sized(-9.0, 3.0, 0.1));
    push(sim, id, Vector::X * 25.0);
    sim.steps(100);
}

/// Towers, some with displaced boxes, with an unusual time step.
fn towers(sim: &mut Sim) {
    (sim.dt, sim.substeps) = (1.0 / 50.0, 6);
    sim.floor();
    for (i, height) in [3, 5, 8, 13, 21, 13, 8].into_iter().enumerate() {
        for level in 0..height {
            let off = if i % 2 == 0 { 0.0 } else { 0.05 * (level % 3) as f32 };
            let at = sized(3.0 * i as f32 + off, 0.5 + level as f32, -off);
            sim.cuboid(sized(0.5, 0.5, 0.4), at);
        }
    }
    sim.steps(120);
}

/// Columns of loose boxes that land at once: more than is struck exactly in a substep.
fn landing(sim: &mut Sim) {
    sim.floor();
    let rows = if DIM == 2 { 1 } else { 6 };
    for i in 0..24 * rows {
        let at = |k: usize| 0.7 * k as f32;
        let [x, z] = if DIM == 2 { [at(i), 0.0] } else { [at(i % 24), at(i / 24)] };
        for level in 0..12 {
            sim.cuboid(Vector::ONE * 0.25, sized(x, 0.6 + 0.58 * level as f32, z));
        }
    }
    sim.steps(80);
}

/// Every native shape collides with every other one, head-on and tilted.
fn pairs(sim: &mut Sim) {
    sim.gravity = Vector::ZERO;
    let shapes = shapes();
    for (i, a) in shapes.iter().enumerate() {
        for (j, b) in shapes.iter().enumerate() {
            for tilt in 0..3 {
                let middle = sized(4.0 * i as f32 + 32.0 * tilt as f32, 4.0 * j as f32, 0.0);
                let way = [Vector::X, Vector::Y, sized(0.6, 0.0, 0.8)][(i + j) % 3];
                let angle = tilt as f32 * (0.5 + 0.37 * i as f32 + 0.71 * j as f32);
                let bounce = if tilt == 2 { 0.4 } else { 0.0 };
                let at = [middle - way * 0.8, middle + way * 0.8];
                let first = body(sim, a.clone(), at[0], tilted(angle), 0.5, bounce);
                let second = body(sim, b.clone(), at[1], tilted(-0.7 * angle), 0.5, bounce);
                push(sim, first, way);
                push(sim, second, way * -1.0);
            }
        }
    }
    sim.steps(90);
}

/// Every native shape falls between half-spaces, one of which is added after the bodies.
fn heap(sim: &mut Sim) {
    let mut planes = trough();
    let last = planes.pop();
    for (shape, at) in planes {
        sim.add(BodyKind::Static, shape, at, Rot::IDENTITY);
    }
    let (shapes, mut chance) = (shapes(), Chance(1));
    for i in 0..112 {
        let (column, layer) = (i % 8, i / 8);
        let deep = if DIM == 2 { 0.0 } else { (column / 4) as f32 * 1.4 - 0.4 };
        let across = if DIM == 2 { column as f32 * 0.8 } else { (column % 4) as f32 * 1.3 } - 2.2;
        let at = sized(across, 3.5 + 1.3 * layer as f32, deep);
        let friction = 0.2 * (i % 5) as f32;
        body(sim, shapes[i % shapes.len()].clone(), at, tilted(6.0 * chance.next()), friction, 0.0);
    }
    if let Some((shape, at)) = last {
        sim.add(BodyKind::Static, shape, at, Rot::IDENTITY);
    }
    sim.steps(140);
}

/// Every native shape falls on triangles and segments, without recycling.
fn on_terrain(sim: &mut Sim) {
    sim.recycle = false;
    for shape in terrain() {
        sim.add(BodyKind::Static, shape, Vector::ZERO, Rot::IDENTITY);
    }
    let (shapes, mut chance) = (shapes(), Chance(2));
    for i in 0..70 {
        let at = sized((i % 14) as f32 - 6.5, 1.4 + 1.2 * (i / 14) as f32, 2.0 * chance.next() - 1.0);
        let id = body(sim, shapes[i % shapes.len()].clone(), at, tilted(6.0 * chance.next()), 0.6, 0.0);
        push(sim, id, Vector::X * (chance.next() - 0.5));
    }
    sim.steps(120);
}

/// Bodies and compounds on a surface of waves, and a compound as a platform that moves under them.
fn composites(sim: &mut Sim) {
    let waves = |x: f32, z: f32| {
        let wave = |t: f32| (t / 4.0 - (t / 4.0).floor() - 0.5).abs();
        wave(x) + wave(z)
    };
    sim.add_with(BodyKind::Static, surface(0.6, waves), Vector::ZERO, Rot::IDENTITY, 0.6, 0.0);
    let part = |x: f32, half| (Pose::new(Vector::X * x, Rot::IDENTITY), Shape::Cuboid(Cuboid { half }));
    let hook = [part(0.0, sized(0.5, 0.1, 0.1)), part(0.4, sized(0.1, 0.4, 0.2))];
    let hook = Shape::compound(hook.to_vec()).expect("blocks are solid");
    let plates = [part(-1.0, sized(1.0, 0.1, 1.0)), part(1.0, sized(1.0, 0.1, 1.0))];
    let plates = Shape::compound(plates.to_vec()).expect("blocks are solid");
    let platform = sim.add_with(BodyKind::Kinematic, plates, sized(3.0, 1.5, 0.0), Rot::IDENTITY, 0.6, 0.0);
    push(sim, platform, Vector::X);
    for (i, shape) in shapes().into_iter().chain([hook.clone(), hook]).enumerate() {
        for k in 0..3 {
            let at = sized(0.9 * i as f32, 2.2 + 1.1 * k as f32, 0.2 * k as f32 - 0.2);
            body(sim, shape.clone(), at, turned(0.3 * k as f32), 0.6, 0.0);
        }
    }
    sim.steps(150);
}

/// Rolling, sliding and sticking on slopes: boxes, a half-space, and rotating floors.
fn slopes(sim: &mut Sim) {
    for lane in 0..4 {
        let angle = 0.15 * lane as f32;
        let middle = sized(0.0, -20.0 * lane as f32, 0.0);
        let half = sized(12.0, 0.5, 8.0);
        let (kind, shape) = match lane {
            0 => (BodyKind::Kinematic, Shape::Cuboid(Cuboid { half })),
            3 => (BodyKind::Static, Shape::HalfSpace(HalfSpace { normal: Vector::Y })),
            _ => (BodyKind::Static, Shape::Cuboid(Cuboid { half })),
        };
        let floor = sim.add_with(kind, shape, middle, turned(angle), 1.0, 0.0);
        if lane == 0 {
            sim.bodies.set_velocity(floor, Velocity { linear: Vector::X, angular: spun(0.0, 0.0, 0.2) });
        }
        let up = turned(angle).rotate(Vector::Y);
        for (i, shape) in shapes().into_iter().enumerate() {
            for k in 0..2 {
                let along = turned(angle).rotate(Vector::X) * (2.5 * i as f32 - 8.0 + 1.1 * k as f32);
                let at = middle + along + up * if lane == 3 { 0.6 } else { 1.1 };
                body(sim, shape.clone(), at, turned(angle), k as f32 * 0.4, 0.0);
            }
        }
    }
    sim.steps(120);
}

/// Restitution: on a floor, between bodies, and through a row of balls.
fn bounces(sim: &mut Sim) {
    sim.dt = 1.0 / 64.0;
    let floor = Shape::Cuboid(Cuboid { half: Vector::ONE * 200.0 });
    sim.add_with(BodyKind::Static, floor, Vector::Y * -200.0, Rot::IDENTITY, 0.5, 0.5);
    let shapes = shapes();
    for i in 0..60 {
        let at = sized((i % 12) as f32 * 1.3, 1.5 + 1.5 * (i / 12) as f32, 0.0);
        let turn = turned(if i % 3 == 0 { 0.0 } else { 0.2 * i as f32 });
        body(sim, shapes[i % shapes.len()].clone(), at, turn, 0.3, 0.25 * (i % 5) as f32);
    }
    for i in 0..8 {
        let capsule = Shape::Capsule(Capsule { a: Vector::Y * -0.2, b: Vector::Y * 0.2, radius: 0.5 });
        let shape = if i == 4 { capsule } else { ball(0.5) };
        let at = sized(-20.0 + 1.001 * i as f32 - if i < 2 { 1.0 } else { 0.0 }, 0.501, 0.0);
        let id = body(sim, shape, at, Rot::IDENTITY, 0.0, 1.0);
        push(sim, id, Vector::X * if i < 2 { 4.0 } else { 0.0 });
    }
    sim.steps(130);
}

/// Many bodies at one place, and some that a ball pushes into each other.
fn crowd(sim: &mut Sim) {
    sim.floor();
    let shapes = shapes();
    for i in 0..50 {
        let at = sized(0.01 * i as f32, 1.0, 0.002 * i as f32);
        let id = body(sim, shapes[i % 5].clone(), at, tilted(0.1 * i as f32), 0.6, 0.0);
        sim.locks[id as usize] = AxisLocks(if i == 7 { 0b100_000 } else { 0 });
    }
    for i in 0..8 {
        sim.cuboid(Vector::ONE * 0.5, sized(20.0 + 0.8 * i as f32, 0.4, 0.0));
    }
    let id = sim.ball(0.4, sized(18.0, 0.6, 0.0));
    push(sim, id, Vector::X * 60.0);
    sim.steps(100);
}

/// Pyramids fall asleep. One is hit, and one is carried off by its platform.
fn sleepers(sim: &mut Sim) {
    sim.sleeping = true;
    sim.floor();
    let half = sized(4.0, 0.5, 4.0);
    let lift =
        sim.add(BodyKind::Kinematic, Shape::Cuboid(Cuboid { half }), sized(20.0, -0.5, 0.0), Rot::IDENTITY);
    sim.contact_manager().set_kinematic_awake(lift, false);
    let [_, _, lifted] = [-20.0, 0.0, 20.0].map(|x| stack(sim, 6, x));
    sim.steps(90);
    assert_eq!(sim.bodies.awake_dynamic().count(), 0, "they sleep by now");
    let id = sim.ball(0.6, sized(-26.0, 1.5, 0.0));
    push(sim, id, Vector::X * 15.0);
    sim.contact_manager().set_kinematic_awake(lift, true);
    sim.contact_manager().wake_body(lifted);
    sim.bodies.set_velocity(lift, Velocity { linear: Vector::Y, ..Velocity::default() });
    let mut most = 0;
    for _ in 0..60 {
        sim.step();
        most = most.max(sim.bodies.awake_dynamic().count());
    }
    assert_eq!(most, 43, "two woke, the third was not touched");
    sim.bodies.set_velocity(lift, Velocity::default());
    sim.contact_manager().set_kinematic_awake(lift, false);
    sim.steps(60);
}

/// Bodies with locked axes, in a heap.
fn held(sim: &mut Sim) {
    sim.floor();
    let shapes = shapes();
    for i in 0..96u8 {
        let (column, layer) = ((i % 16) as f32, (i / 16) as f32);
        let at = sized(0.95 * column + 0.03 * layer, 0.5 + 0.9 * layer, 0.02 * column);
        let id = body(sim, shapes[usize::from(i % 5)].clone(), at, turned(0.3 * layer), 0.6, 0.0);
        let locks = if i % 3 == 0 { 0 } else { i.wrapping_mul(29) & 0b111_111 };
        sim.locks[id as usize] = AxisLocks(if DIM == 2 { locks & 0b110_001 } else { locks });
    }
    sim.steps(80);
}

/// Stacks of bodies of different dominance, one of them on a moving floor.
fn dominance(sim: &mut Sim) {
    sim.floor();
    let half = sized(3.0, 0.5, 3.0);
    let floor =
        sim.add(BodyKind::Kinematic, Shape::Cuboid(Cuboid { half }), sized(0.0, 1.0, 0.0), Rot::IDENTITY);
    sim.bodies.set_velocity(floor, Velocity { linear: Vector::X * 0.7, angular: spun(0.0, 0.3, 0.0) });
    sim.bodies.any_dominance = true;
    for i in 0..80u8 {
        let (column, layer) = (i % 16, i / 16);
        let foot = if (6..10).contains(&column) { 1.5 } else { 0.0 };
        let at = sized(1.3 * column as f32 - 9.75, foot + 0.5 + layer as f32, 0.0);
        let shape = if i % 7 == 0 { ball(0.5) } else { block(0.5) };
        let id = body(sim, shape, at, Rot::IDENTITY, 0.6, 0.0);
        sim.bodies[id].dominance = (i % 7) as i8 * 5 % 7 - 3;
    }
    sim.steps(100);
}

/// Long and flat bodies that spin about all axes, first separately, then into each other.
fn spin(sim: &mut Sim) {
    sim.gravity = Vector::ZERO;
    let shapes = shapes();
    for i in 0..60 {
        let at = sized((i % 10) as f32 * 2.0 - 9.0, (i / 10) as f32 * 2.0 - 5.0, (i % 4) as f32);
        let shape = match i % 3 {
            0 => Shape::Cuboid(Cuboid { half: sized(0.8, 0.3, 0.1) }),
            1 => Shape::Cuboid(Cuboid { half: sized(0.2, 0.9, 0.5) }),
            _ => shapes[3].clone(),
        };
        let id = body(sim, shape, at, tilted(0.2 * i as f32), 0.4, 0.2);
        let angular = spun(0.1, 6.0 - 0.2 * i as f32, 0.3 * (i % 7) as f32);
        sim.bodies.set_velocity(id, Velocity { linear: at * -0.8, angular });
    }
    sim.steps(120);
}

/// A kinematic paddle turns in a closed box of small bodies.
fn mixer(sim: &mut Sim) {
    let (half, walls, cells) = container();
    for (size, place) in walls {
        sim.add(BodyKind::Static, Shape::Cuboid(Cuboid { half: size * 0.5 }), place, Rot::IDENTITY);
    }
    let middle = Vector::Y * half;
    let paddle = Shape::Cuboid(Cuboid { half: sized(0.8 * half, 0.15, 0.8 * half) });
    let paddle = sim.add(BodyKind::Kinematic, paddle, middle, Rot::IDENTITY);
    sim.bodies.set_velocity(paddle, Velocity { linear: Vector::ZERO, angular: spun(0.0, 0.0, 3.0) });
    let shapes = shapes();
    for (i, cell) in cells.into_iter().enumerate() {
        let shape = match i % 4 {
            0 => ball(0.3),
            1 => block(0.25),
            2 => Shape::Capsule(Capsule { a: Vector::X * -0.15, b: Vector::X * 0.15, radius: 0.2 }),
            _ => shapes[3].clone(),
        };
        body(sim, shape, cell, tilted(0.5 * i as f32), 0.6, 0.1);
    }
    sim.steps(130);
}

/// Changes by an app: bodies are moved, pushed, scaled, locked and added.
fn changes(sim: &mut Sim) {
    sim.sleeping = true;
    sim.floor();
    let shapes = shapes();
    let first = sim.bodies.ids.len() as u32;
    for i in 0..60 {
        let at = sized(1.05 * (i % 15) as f32, 0.6 + 1.1 * (i / 15) as f32, 0.0);
        body(sim, shapes[i % 5].clone(), at, turned(0.1 * i as f32), 0.6, 0.0);
    }
    for round in 0..10u32 {
        let id = first + (7 * round) % 60;
        sim.contact_manager().wake_body(id);
        let at = sim.position(id).to_local();
        match round % 5 {
            0 => {
                let position = (at + Vector::Y * 2.0).to_world();
                sim.bodies.teleport(id, WorldPose { position, rotation: turned(0.5) });
            }
            1 => push(sim, id, sized(3.0, 4.0, 1.0)),
            2 => sim.reshape(id, block(0.7)),
            3 => sim.contact_manager().retype(id, BodyKind::Static),
            _ => {
                sim.ball(0.4, at + Vector::Y * 6.0);
            }
        }
        sim.steps(12);
    }
}

/// A scene with many blocks: a high pyramid in a rain of balls.
fn wall(sim: &mut Sim) {
    sim.floor();
    stack(sim, 40, 0.0);
    let mut chance = Chance(3);
    for i in 0..40 {
        let at = sized(1.1 * i as f32 - 22.0, 30.0 + 12.0 * chance.next(), 0.0);
        body(sim, ball(0.5), at, Rot::IDENTITY, 0.3, 0.5);
    }
    sim.steps(60);
}

/// FNV-1a of 64 bits (Fowler, Noll and Vo) over positions, rotations and velocities, by id.
fn hash(sim: &Sim) -> u64 {
    let mut hash = 0xcbf2_9ce4_8422_2325u64;
    let mut take = |bytes: &[u8]| {
        for &byte in bytes {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
    };
    for (pose, velocity) in sim.bodies.poses.iter().zip(&sim.bodies.velocities) {
        assert!(pose.center.is_finite_world() && velocity.linear.is_finite());
        for coordinate in coordinates(pose.center) {
            take(&coordinate.to_le_bytes());
        }
        let turning = numbers(pose.rotation, velocity.angular);
        for number in turning.into_iter().chain(velocity.linear.to_array()) {
            take(&number.to_le_bytes());
        }
    }
    hash
}

/// The hash of a scene with a number of workers, and four lanes or all that the CPU has.
fn hash_of(run: fn(&mut Sim), workers: usize, narrow: bool) -> u64 {
    let mut sim = Sim::new();
    sim.checked = false;
    sim.set_workers(workers);
    if narrow {
        sim.set_narrow();
    }
    run(&mut sim);
    hash(&sim)
}

/// Whether world positions are in `f64`.
const IS_DOUBLE: bool = size_of::<Scalar>() == 8;

/// Positions, rotations and velocities, by id, in metres.
fn in_metres(sim: &Sim) -> Vec<f64> {
    let (mut all, metres) = (Vec::new(), 1.0 / f64::from(sim.unit));
    for (pose, velocity) in sim.bodies.poses.iter().zip(&sim.bodies.velocities) {
        all.extend(coordinates(pose.center).into_iter().map(|x| f64::from(x) * metres));
        all.extend(velocity.linear.to_array().map(|v| f64::from(v) * metres));
        all.extend(numbers(pose.rotation, velocity.angular).into_iter().map(f64::from));
    }
    all
}

/// The scenes that end otherwise in worlds with other length units, powers of two, and the greatest
/// difference. Bodies have the masses that they have in metres. Scenes that act on their bodies after the
/// first step do so in metres, and are left out.
pub fn differing(units: &[f32]) -> Vec<(&'static str, f32, f64)> {
    let mut list = Vec::new();
    for (name, run) in SCENES.into_iter().filter(|(name, _)| !["sleepers", "changes"].contains(name)) {
        let end = |unit: f32| {
            let mut sim = Sim::new();
            (sim.checked, sim.unit) = (false, unit);
            sim.density = unit.powi(-(DIM as i32));
            run(&mut sim);
            in_metres(&sim)
        };
        let here = end(1.0);
        for &unit in units {
            let off = here.iter().zip(end(unit)).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
            if off > 0.0 {
                list.push((name, unit, off));
            }
        }
    }
    list
}

#[test]
fn scenes_have_their_golden_hashes() {
    let (mut table, mut lines) = (Vec::new(), String::new());
    for (i, (name, run)) in SCENES.into_iter().enumerate() {
        let (_, single, double) = GOLDEN.get(i).copied().unwrap_or_default();
        let hash = hash_of(run, 1, false);
        let (single, double) = if IS_DOUBLE { (single, hash) } else { (hash, double) };
        table.push((name, single, double));
        lines += &format!("    (\"{name}\", {single:#018x}, {double:#018x}),\n");
    }
    assert!(table == GOLDEN, "scenes do not end as they did. If that is meant, this is the table:\n{lines}");
}

#[test]
fn hashes_do_not_depend_on_workers_or_lanes() {
    for ((name, run), (_, single, double)) in SCENES.into_iter().zip(GOLDEN) {
        let golden = if IS_DOUBLE { double } else { single };
        for (workers, narrow) in [(1, true), (2, false), (4, true), (8, false)] {
            let lanes = if narrow { "four lanes" } else { "all lanes" };
            let same = hash_of(run, workers, narrow) == golden;
            assert!(same, "{name}: {workers} workers with {lanes} do not come to the golden hash");
        }
    }
}
