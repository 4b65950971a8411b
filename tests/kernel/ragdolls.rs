//! Ragdolls: humans of eleven capsules that fall.

use super::dim::{LIMB, SWING, TURN, any_rotation, plot, sized, spin};
use super::extreme::Dice;
use super::joints::{SHIFTS, hinge};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Capsule, Cuboid, Shape};
use kernel::solver::{Axis, Drive, JointDef, JointFrame, OrientationMotor};
use kernel::table::{BodyKind, Velocity};

/// A body: the middle of its capsule, half of its axis, and its radius, in metres. Sides are ahead, up, left.
const PARTS: [([f32; 3], [f32; 3], f32); 11] = [
    ([0.0, 0.0, 0.0], [0.0, 0.0, 0.08], 0.10),
    ([0.0, 0.35, 0.0], [0.0, 0.0, 0.10], 0.14),
    ([0.0, 0.68, 0.0], [0.0, 0.03, 0.0], 0.10),
    ([0.0, 0.29, -0.30], [0.0, 0.13, 0.0], 0.05),
    ([0.0, -0.02, -0.30], [0.0, 0.12, 0.0], 0.045),
    ([0.0, 0.29, 0.30], [0.0, 0.13, 0.0], 0.05),
    ([0.0, -0.02, 0.30], [0.0, 0.12, 0.0], 0.045),
    ([0.0, -0.31, -0.10], [0.0, 0.15, 0.0], 0.07),
    ([0.0, -0.73, -0.10], [0.0, 0.17, 0.0], 0.06),
    ([0.0, -0.31, 0.10], [0.0, 0.15, 0.0], 0.07),
    ([0.0, -0.73, 0.10], [0.0, 0.17, 0.0], 0.06),
];

/// What a joint lets turn, rad.
enum Bends {
    /// A hinge between two angles.
    Hinge(f32, f32),
    /// A ball with a cone and a twist.
    Ball(f32, f32),
}

/// Parts that are joined, and where.
const JOINTS: [(usize, usize, [f32; 3], Bends); 10] = [
    (0, 1, [0.0, 0.18, 0.0], Bends::Ball(0.5, 0.4)),
    (1, 2, [0.0, 0.54, 0.0], Bends::Ball(0.6, 0.6)),
    (1, 3, [0.0, 0.44, -0.28], Bends::Ball(1.3, 0.8)),
    (3, 4, [0.0, 0.13, -0.30], Bends::Hinge(0.0, 2.3)),
    (1, 5, [0.0, 0.44, 0.28], Bends::Ball(1.3, 0.8)),
    (5, 6, [0.0, 0.13, 0.30], Bends::Hinge(0.0, 2.3)),
    (0, 7, [0.0, -0.12, -0.10], Bends::Ball(1.0, 0.5)),
    (7, 8, [0.0, -0.51, -0.10], Bends::Hinge(-2.3, 0.0)),
    (0, 9, [0.0, -0.12, 0.10], Bends::Ball(1.0, 0.5)),
    (9, 10, [0.0, -0.51, 0.10], Bends::Hinge(-2.3, 0.0)),
];

fn at([x, y, z]: [f32; 3]) -> Vector {
    sized(x, y, z)
}

/// How joints resist turning.
#[derive(Clone, Copy, Debug)]
pub struct Losses {
    /// A torque in N·m, fully from 0.5 rad/s on.
    pub friction: f32,
    /// The share of relative angular velocity that is lost, 1/s.
    pub damping: f32,
}

impl Losses {
    pub const NONE: Self = Self { friction: 0.0, damping: 0.0 };
    /// Those of a ragdoll by default.
    const USUAL: Self = Self { damping: 10.0, ..Self::NONE };
    const FRICTION: Self = Self { friction: 3.0, ..Self::NONE };
}

/// Adds a human whose pelvis is at a place. Parts of one body pass through each other.
pub fn human(sim: &mut Sim, place: Vector, turn: Rot, losses: Losses) -> (Vec<u32>, Vec<u32>) {
    let Losses { friction, damping } = losses;
    let ids: Vec<u32> = PARTS
        .iter()
        .map(|(middle, half, radius)| {
            let capsule = Capsule { a: at(*half) * -1.0, b: at(*half), radius: *radius };
            let place = place + turn.rotate(at(*middle));
            let id = sim.add(BodyKind::Dynamic, Shape::Capsule(capsule), place, turn);
            sim.load(id, 1000.0);
            id
        })
        .collect();
    for (k, a) in ids.iter().enumerate() {
        ids[k + 1..].iter().for_each(|b| _ = sim.apart.insert([*a, *b]));
    }
    let joints = JOINTS.iter().map(|(a, b, joint, bends)| {
        let anchors = [*a, *b].map(|part| at(*joint) - at(PARTS[part].0));
        let (a, b) = (ids[*a], ids[*b]);
        let def = match bends {
            Bends::Hinge(min, max) => hinge(a, b, anchors).with([TURN], Axis::limited(*min, *max)),
            Bends::Ball(cone, twist) => {
                let frames = anchors.map(|anchor| JointFrame { anchor, basis: super::dim::limb_basis() });
                let def = JointDef { frames, ..JointDef::free([a, b], anchors) }.with(SHIFTS, Axis::LOCKED);
                def.with(LIMB, Axis::limited(-*twist, *twist))
                    .with([SWING.0], Axis::limited(SWING.1 * cone, *cone))
            }
        };
        let drive = Drive::Force { stiffness: 0.0, damping: 2.0 * friction };
        let (target_rotation, target_velocity) = (Rot::IDENTITY, spin(0.0));
        let motor = OrientationMotor { target_rotation, target_velocity, max_torque: friction, drive };
        let orientation = (friction > 0.0).then_some(motor);
        sim.join(JointDef { orientation, damping: [0.0, damping], ..def }).unwrap()
    });
    let joints = joints.collect();
    (ids, joints)
}

/// Steps until all sleep. Returns the number of steps, the widest gap, m, and the farthest limit
/// passed, degrees.
fn settle(sim: &mut Sim, joints: &[u32], steps: usize) -> (usize, f32, f32) {
    let (mut open, mut past) = (0.0f32, 0.0f32);
    for step in 0..steps {
        sim.step();
        for id in joints {
            let gap = sim.gap(*id).unwrap();
            (open, past) = (open.max(gap.length), past.max(gap.angle.to_degrees()));
        }
        if sim.bodies.awake_dynamic().next().is_none() {
            return (step, open, past);
        }
    }
    (steps, open, past)
}

/// Joints without friction hold as well, but limbs that are propped up may swing on.
#[test]
fn a_human_that_falls_holds_together_and_sleeps() {
    let (mut failed, mut torn) = (Vec::new(), 0);
    for (rate, substeps) in [(60.0f32, 4u32), (64.0, 6)] {
        let cases = [(1.0f32, Losses::FRICTION), (3.0, Losses::FRICTION), (30.0, Losses::FRICTION)];
        for (height, losses) in
            cases.into_iter().chain([(3.0, Losses::USUAL), (30.0, Losses::USUAL), (30.0, Losses::NONE)])
        {
            for seed in 0..4 {
                let mut dice = Dice::new(seed);
                let mut sim = Sim::new();
                (sim.sleeping, sim.checked) = (true, false);
                (sim.dt, sim.substeps) = (1.0 / rate, substeps);
                sim.floor();
                let turn = any_rotation(&mut dice);
                let (_, joints) = human(&mut sim, Vector::Y * (1.0 + height), turn, losses);
                let before = sim.energy();
                let (steps, open, past) = settle(&mut sim, &joints, (11.0 * rate) as usize);
                let gained = sim.energy() - before;
                let seconds = steps as f32 / rate;
                let is_late = losses.friction + losses.damping > 0.0 && seconds > 10.0;
                // Of 24 that fall 30 m, two may be torn for a moment.
                let is_torn = height > 3.0 && (open > 0.02 || past > 3.5);
                torn += u32::from(is_torn);
                let [widest, farthest] = if is_torn && torn <= 2 { [0.06, 20.0] } else { [0.02, 3.5] };
                if open > widest || past > farthest || is_late || gained > 0.0 {
                    let case = format!("{height} m, {losses:?}, {rate} Hz in {substeps}, seed {seed}");
                    failed
                        .push(format!("{case}: open {open} m, past {past} degrees, {seconds} s, {gained} J"));
                }
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Without losses limbs that hang free swing on: then a heap is only calm.
#[test]
fn a_heap_of_humans_comes_to_rest() {
    let mut failed = Vec::new();
    for losses in [Losses::NONE, Losses::FRICTION, Losses::USUAL] {
        let mut dice = Dice::new(7);
        let mut sim = Sim::new();
        (sim.sleeping, sim.checked) = (true, false);
        sim.floor();
        let mut joints = Vec::new();
        for k in 0..36 {
            let (column, layer) = (k % 9, k / 9);
            let aside = sized(0.3 * dice.signed(), 0.0, 0.3 * dice.signed());
            let place = plot(column) * 2.0 + Vector::Y * (2.0 + 2.0 * layer as f32) + aside;
            let turn = any_rotation(&mut dice);
            joints.extend(human(&mut sim, place, turn, losses).1);
        }
        let (steps, open, past) = settle(&mut sim, &joints, 720);
        let seconds = steps as f32 / 60.0;
        let mut speeds: Vec<f32> =
            sim.bodies.awake_dynamic().map(|id| sim.bodies.velocities[id as usize].linear.length()).collect();
        speeds.sort_by(f32::total_cmp);
        let [half, most] = [50, 99].map(|q| speeds.get(speeds.len() * q / 100).copied().unwrap_or(0.0));
        // Without damping the last of a heap rock on. In 20 heaps with it all slept within 8 s.
        let is_restless = half > 0.001 || losses.damping > 0.0 && seconds > 10.0;
        if open > 0.015 || past > 8.0 || is_restless {
            failed.push(format!(
                "{losses:?}: open {open} m, past {past} degrees, after {seconds} s {} awake, {half} and {most} m/s",
                speeds.len()
            ));
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// A limb that is stopped before a thin wall stops the whole body with it: its joints do not open by the way
/// that is left.
#[test]
fn a_human_thrown_at_a_thin_wall_neither_passes_nor_is_torn() {
    let mut failed = Vec::new();
    for speed in [10.0f32, 20.0, 40.0] {
        for seed in 0..8 {
            let mut dice = Dice::new(seed);
            let mut sim = Sim::new();
            sim.checked = false;
            let wall = Shape::Cuboid(Cuboid { half: sized(0.01, 20.0, 20.0) });
            sim.add(BodyKind::Static, wall, Vector::ZERO, Rot::IDENTITY);
            let turn = any_rotation(&mut dice);
            let (ids, joints) = human(&mut sim, Vector::X * -3.0, turn, Losses::USUAL);
            for id in &ids {
                sim.bodies.set_velocity(*id, Velocity { linear: Vector::X * speed, ..Velocity::default() });
            }
            let mut open = 0.0f32;
            for _ in 0..60 {
                sim.step();
                for joint in &joints {
                    open = open.max(sim.gap(*joint).unwrap().length);
                }
            }
            let passed = ids.iter().filter(|id| sim.position(**id).to_local().x > 0.0).count();
            if passed > 0 || open > 0.05 {
                failed
                    .push(format!("{speed} m/s, seed {seed}: {passed} parts pass, joints open by {open} m"));
            }
        }
    }
    assert!(failed.is_empty(), "{failed:#?}");
}

/// Trees of equal shape are solved side by side, four or eight of them: what strikes some must not
/// change others.
#[test]
fn humans_side_by_side_do_not_disturb_each_other() {
    for losses in [Losses::NONE, Losses::USUAL, Losses::FRICTION] {
        let fall = |narrow: bool| {
            let mut sim = Sim::new();
            (sim.sleeping, sim.checked) = (false, false);
            if narrow {
                sim.set_narrow();
            }
            sim.floor();
            let mut dice = Dice::new(7);
            for k in 0..11 {
                let place = Vector::X * (4.0 * k as f32 - 20.0) + Vector::Y * (1.5 + 0.3 * k as f32);
                let turn = any_rotation(&mut dice);
                human(&mut sim, place, turn, losses);
            }
            sim.steps(120);
            sim.bodies.poses.iter().copied().zip(sim.bodies.velocities.iter().copied()).collect::<Vec<_>>()
        };
        let [wide, narrow] = [false, true].map(fall);
        for (body, (wide, narrow)) in wide.iter().zip(&narrow).enumerate() {
            assert!(wide == narrow, "{losses:?}, body {body}: {wide:?} and {narrow:?}");
        }
    }
}
