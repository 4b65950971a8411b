//! Trees of joints: what light bodies hold that bear heavy ones.

use super::dim::{SWINGS, TURN, sized, spin, spin_momentum, turned};
use super::joints::{SHIFTS, apart, chain, cuboid, gap, hinge, motor, post, weld};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Shape};
use kernel::solver::coordinate::DISTANCE;
use kernel::solver::{Axis, JointDef, JointFrame, JointSolver};
use kernel::table::{BodyKind, Velocity};

const LOADS: [f32; 4] = [1.0, 10.0, 100.0, 1000.0];

pub(super) fn sim(solver: JointSolver) -> Sim {
    let mut sim = Sim::new();
    (sim.checked, sim.joint_solver) = (false, solver);
    sim
}

/// How far the widest joint is open.
fn widest(sim: &Sim, joints: &[JointDef]) -> f32 {
    joints.iter().fold(0.0, |open, def| open.max(gap(sim, def)))
}

/// The speed of the fastest body.
pub(super) fn fastest(sim: &Sim, ids: &[u32]) -> f32 {
    ids.iter().fold(0.0, |fast, id| fast.max(sim.bodies.velocities[*id as usize].linear.length()))
}

fn set_linear(sim: &mut Sim, id: u32, linear: Vector) {
    sim.bodies.set_velocity(id, Velocity { linear, angular: spin(0.0) });
}

/// A joint of two points that are one.
fn pin(sim: &mut Sim, bodies: [u32; 2], anchors: [Vector; 2]) -> JointDef {
    let def = JointDef::free(bodies, anchors).with(SHIFTS, Axis::LOCKED);
    sim.join(def).unwrap();
    def
}

/// For some steps, how far a joint is open at most, and the most energy that is gained, J.
fn watch(sim: &mut Sim, joints: &[JointDef], steps: usize) -> (f32, f64) {
    let before = sim.energy();
    let (mut open, mut gained) = (0.0f32, f64::MIN);
    for _ in 0..steps {
        sim.step();
        open = open.max(widest(sim, joints));
        gained = gained.max(sim.energy() - before);
    }
    (open, gained)
}

#[test]
fn a_chain_hardly_stretches_under_any_load() {
    for load in LOADS {
        for (solver, most) in [(JointSolver::Auto, 0.01), (JointSolver::Rigid, 1.0e-5)] {
            let mut sim = sim(solver);
            let (ids, _) = chain(&mut sim, 30, load, -Vector::Y);
            sim.steps(600);
            let stretch = -sim.position(ids[30]).to_local().y / 30.5 - 1.0;
            assert!(stretch > -1.0e-5 && stretch < most, "{solver:?}, {load} kg: stretched by {stretch}");
            assert!(fastest(&sim, &ids) < 0.01, "{solver:?}, {load} kg: {} m/s", fastest(&sim, &ids));
        }
    }
}

#[test]
fn a_chain_that_swings_holds_any_load() {
    for load in LOADS {
        // In 3D also askew.
        for aside in [0.0, 5.0] {
            let mut sim = sim(JointSolver::Auto);
            let (ids, joints) = chain(&mut sim, 30, load, Vector::X);
            set_linear(&mut sim, ids[30], sized(0.0, 0.0, aside));
            let (open, gained) = watch(&mut sim, &joints, 600);
            let allowed = if load < 100.0 { 0.1 } else { 0.01 };
            assert!(open < allowed, "{load} kg: a joint is open by {open} m");
            assert!(gained < f64::from(load), "{load} kg: gains {gained} J");
        }
    }
}

/// Beads on rods, with a heavy ball at the end: distances without locked coordinates are members of
/// trees as well.
#[test]
fn a_rope_of_distances_hardly_stretches() {
    for load in LOADS {
        for direction in [-Vector::Y, Vector::X] {
            let mut sim = sim(JointSolver::Auto);
            let ball = |radius: f32| Shape::Ball(Ball { radius });
            let (mut last, mut joints, mut ids) = (post(&mut sim, Vector::ZERO), Vec::new(), Vec::new());
            for k in 1..=30 {
                let (radius, kg) = if k == 30 { (0.5, load) } else { (0.1, 1.0) };
                let id =
                    apart(&mut sim, BodyKind::Dynamic, ball(radius), direction * k as f32, Rot::IDENTITY);
                sim.load(id, kg / sim.mass(id) as f32);
                let def =
                    JointDef::free([last, id], [Vector::ZERO; 2]).with([DISTANCE], Axis::limited(1.0, 1.0));
                joints.push(sim.join(def).unwrap());
                ids.push(id);
                last = id;
            }
            let before = sim.energy();
            let (mut open, mut gained) = (0.0f32, f64::MIN);
            for _ in 0..600 {
                sim.step();
                open = joints.iter().fold(open, |open, id| open.max(sim.gap(*id).unwrap().length));
                gained = gained.max(sim.energy() - before);
            }
            let case = format!("{load} kg, {direction:?}");
            // A light end cracks like a whip when it comes around.
            let most = match load {
                _ if direction.x == 0.0 => 0.004,
                1.0 => 0.2,
                _ => 0.015,
            };
            assert!(open < most, "{case}: a rod is off by {open} m");
            assert!(gained < 0.25 * f64::from(29.0 + load), "{case}: gains {gained} J");
        }
    }
}

/// Stiffness follows the substeps, so the sag of softness follows their square.
#[test]
fn chains_hold_at_any_rate() {
    for (rate, substeps) in [(30.0f32, 4u32), (30.0, 8), (64.0, 6), (144.0, 2), (144.0, 4)] {
        for load in [1.0, 100.0] {
            for direction in [-Vector::Y, Vector::X] {
                let mut sim = sim(JointSolver::Auto);
                (sim.dt, sim.substeps) = (1.0 / rate, substeps);
                let (_, joints) = chain(&mut sim, 30, load, direction);
                let (open, gained) = watch(&mut sim, &joints, (5.0 * rate) as usize);
                let slow = 240.0 / (rate * substeps as f32);
                let case = format!("{load} kg at {rate} Hz in {substeps}, {direction:?}");
                assert!(open < 0.1 * slow * slow, "{case}: a joint is open by {open} m");
                assert!(gained < f64::from(load + 30.0), "{case}: gains {gained} J");
            }
        }
    }
}

/// A tree of 61 links whose 16 leaves are heavy, and thrown apart.
fn mobile(sim: &mut Sim, load: f32) -> Vec<JointDef> {
    let down = turned(-core::f32::consts::FRAC_PI_2);
    let link = cuboid(sized(0.5, 0.1, 0.1));
    let hook = post(sim, Vector::ZERO);
    let mut joints = Vec::new();
    let mut hang = |sim: &mut Sim, parent: u32, anchor: Vector, kg: f32| {
        let at = sim.bodies.frame(parent).transform(anchor).to_local();
        let id = apart(sim, BodyKind::Dynamic, link.clone(), at - Vector::Y * 0.5, down);
        sim.load(id, kg / sim.mass(id) as f32);
        joints.push(pin(sim, [parent, id], [anchor, Vector::X * -0.5]));
        id
    };
    let mut level = vec![hang(sim, hook, Vector::ZERO, 1.0)];
    for depth in 0..4 {
        let mut next = Vec::new();
        for &parent in &level {
            for side in [-1.0f32, 1.0] {
                let arm = hang(sim, parent, Vector::X * 0.5 + Vector::Y * (0.1 * side), 1.0);
                let leaf = hang(sim, arm, Vector::X * 0.5, if depth == 3 { load } else { 1.0 });
                if depth == 3 {
                    set_linear(sim, leaf, sized(3.0 * side, 0.0, 3.0));
                }
                next.push(leaf);
            }
        }
        level = next;
    }
    joints
}

#[test]
fn a_mobile_holds_its_leaves() {
    for load in LOADS {
        let mut sim = sim(JointSolver::Auto);
        let joints = mobile(&mut sim, load);
        assert_eq!(joints.len(), 61);
        let (open, gained) = watch(&mut sim, &joints, 600);
        assert!(open < 0.05, "{load} kg: a joint is open by {open} m");
        assert!(gained < f64::from(16.0 * load), "{load} kg: gains {gained} J");
    }
}

#[test]
fn a_cantilever_of_welds_bears_a_load() {
    let rigid = JointSolver::Rigid;
    for (solver, rate, substeps, most) in
        [(JointSolver::Auto, 60.0f32, 4, 0.5), (rigid, 60.0, 4, 0.001), (rigid, 64.0, 6, 0.001)]
    {
        let mut sim = sim(solver);
        (sim.dt, sim.substeps) = (1.0 / rate, substeps);
        let mut last = (post(&mut sim, Vector::ZERO), Vector::ZERO);
        for k in 0..9 {
            let at = Vector::X * (k as f32 + 0.5).min(8.0);
            let id = apart(&mut sim, BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.1)), at, Rot::IDENTITY);
            let (kg, end) = if k == 8 { (100.0, Vector::ZERO) } else { (1.0, Vector::X * -0.5) };
            sim.load(id, kg / sim.mass(id) as f32);
            sim.join(weld(last.0, id, [last.1, end])).unwrap();
            last = (id, Vector::X * 0.5);
        }
        sim.steps(1200);
        let sag = -sim.position(last.0).to_local().y;
        assert!(sag > 0.0 && sag < most, "{solver:?}: sags by {sag} m");
        assert!(fastest(&sim, &[last.0]) < 0.01, "{solver:?}: still moves");
    }
}

/// Two heavy balls turn about each other on a light chain.
#[test]
fn a_dumbbell_keeps_its_momentum() {
    for load in LOADS {
        let mut sim = sim(JointSolver::Auto);
        sim.gravity = Vector::ZERO;
        let (mut ids, _) = chain(&mut sim, 30, load, Vector::X);
        // Without its first joint it is free.
        sim.part(0).unwrap();
        let ball = Shape::Ball(Ball { radius: 0.5 });
        let ball = apart(&mut sim, BodyKind::Dynamic, ball, Vector::X * -0.5, Rot::IDENTITY);
        sim.load(ball, load / sim.mass(ball) as f32);
        pin(&mut sim, [ball, ids[0]], [Vector::X * 0.5, Vector::X * -0.5]);
        ids.push(ball);
        for id in &ids {
            let linear = Vector::Y * (sim.position(*id).to_local().x - 15.0);
            sim.bodies.set_velocity(*id, Velocity { linear, angular: spin(1.0) });
        }
        // About the centre of mass, in the plane of x and y.
        let momentum = |sim: &Sim| {
            let mut sums = [0.0f64; 6];
            for id in &ids {
                let (v, at) = (sim.bodies.velocities[*id as usize], sim.position(*id).to_local());
                let turn = sim.bodies.poses[*id as usize].rotation;
                let own = f64::from(spin_momentum(sim.masses[*id as usize].1, turn, v.angular).z);
                let ([x, y, vx, vy], m) =
                    ([at.x, at.y, v.linear.x, v.linear.y].map(f64::from), sim.mass(*id));
                let parts = [m, m * x, m * y, m * vx, m * vy, m * (x * vy - y * vx) + own];
                sums.iter_mut().zip(parts).for_each(|(sum, part)| *sum += part);
            }
            let [m, x, y, px, py, l] = sums;
            l - (x * py - y * px) / m
        };
        let before = momentum(&sim);
        sim.steps(600);
        let lost = momentum(&sim) / before - 1.0;
        assert!(lost.abs() < 0.001, "{load} kg: {lost} of the momentum");
    }
}

/// A bridge between two towers has no end that is free. Nothing damps it: it sways for minutes, ever less.
#[test]
fn a_bridge_of_planks_sways_ever_less() {
    let mut sim = sim(JointSolver::Auto);
    let mut last = (post(&mut sim, Vector::ZERO), Vector::ZERO);
    let (mut joints, mut ids) = (Vec::new(), Vec::new());
    let end = post(&mut sim, Vector::X * 160.0);
    for k in 0..=160 {
        let mut next = end;
        if k < 160 {
            let at = Vector::X * (k as f32 + 0.5);
            next = apart(&mut sim, BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.5)), at, Rot::IDENTITY);
            let kg = if k % 40 == 20 { 50.0 } else { 1.0 };
            sim.load(next, kg / sim.mass(next) as f32);
            ids.push(next);
        }
        let anchor = if k < 160 { Vector::X * -0.5 } else { Vector::ZERO };
        let def = hinge(last.0, next, [last.1, anchor]);
        sim.join(def).unwrap();
        joints.push(def);
        last = (next, Vector::X * 0.5);
    }
    let (open, _) = watch(&mut sim, &joints, 1200);
    assert!(open < 0.01, "a joint is open by {open} m");
    let sag = ids.iter().fold(0.0f32, |sag, id| sag.max(-sim.position(*id).to_local().y));
    assert!(sag < 8.0, "it sags by {sag} m");
    let speed = fastest(&sim, &ids);
    assert!(speed < 1.5, "{speed} m/s");
}

/// A motor that is turned off pushes no more, also in the first step.
#[test]
fn a_motor_of_a_tree_that_is_turned_off_is_off() {
    let mut sim = sim(JointSolver::Auto);
    let mut last = (post(&mut sim, Vector::ZERO), Vector::ZERO);
    let mut joints = Vec::new();
    for k in 0..4 {
        let at = Vector::X * (k as f32 + 0.5);
        let next = apart(&mut sim, BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.5)), at, Rot::IDENTITY);
        let def = hinge(last.0, next, [last.1, Vector::X * -0.5]);
        let on = def.with([TURN], Axis { motor: Some(motor(1.0, 50.0)), ..Axis::FREE });
        joints.push((sim.join(on).unwrap(), def));
        last = (next, Vector::X * 0.5);
    }
    sim.steps(10);
    for (id, _) in &joints {
        assert!(sim.reaction(*id).motors[TURN].abs() > 1.0, "it runs");
    }
    for (id, def) in &joints {
        sim.rejoin(*id, def.with([TURN], Axis { motor: Some(motor(1.0, 0.0)), ..Axis::FREE })).unwrap();
    }
    sim.steps(1);
    for (id, _) in &joints {
        assert_eq!(sim.reaction(*id).motors[TURN], 0.0);
    }
}

/// Friction in every hinge: all of them act in each pass.
#[test]
fn a_long_chain_with_friction_holds_and_only_loses_energy() {
    const LINKS: usize = 160;
    let mut sim = sim(JointSolver::Auto);
    let mut last = (post(&mut sim, Vector::ZERO), Vector::ZERO);
    let (mut joints, mut ids) = (Vec::new(), Vec::new());
    for k in 0..LINKS {
        let at = Vector::X * (k as f32 + 0.5);
        let next = apart(&mut sim, BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.5)), at, Rot::IDENTITY);
        sim.load(next, 1.0 / sim.mass(next) as f32);
        let turn = Axis { motor: Some(motor(0.0, 5.0)), ..Axis::FREE };
        let def = hinge(last.0, next, [last.1, Vector::X * -0.5]).with([TURN], turn);
        ids.push(sim.join(def).unwrap());
        joints.push(def);
        last = (next, Vector::X * 0.5);
    }
    let mut energy = sim.energy();
    for step in 0..60 {
        let (open, gained) = watch(&mut sim, &joints, 1);
        assert!(open < 0.01, "step {step}: a joint is open by {open} m");
        assert!(gained < 1.0e-3 * energy.abs().max(1.0), "step {step}: it gains {gained} J");
        energy = sim.energy();
    }
    let torques: Vec<f32> = ids.iter().map(|id| sim.reaction(*id).motors[TURN].abs()).collect();
    let most = torques.iter().copied().fold(0.0, f32::max);
    assert!(most < 5.001, "friction of {most} N·m");
    let slipping = torques.iter().filter(|torque| **torque > 4.999).count();
    assert!(slipping > 5 && slipping < LINKS, "{slipping} hinges turn");
}

/// Contacts win. Neighbours that touch press on each other as well, and are no load.
#[test]
fn a_chain_that_falls_comes_to_rest_on_the_floor() {
    let mut wide = Vec::new();
    for load in LOADS {
        for neighbours in [false, true] {
            if neighbours && load > 100.0 {
                continue;
            }
            let mut sim = sim(JointSolver::Auto);
            sim.floor();
            let turn = turned(0.5);
            let (mut ids, mut joints) = (Vec::<u32>::new(), Vec::new());
            for k in 0..20 {
                let at = turn.rotate(Vector::X * (k as f32 + 0.5)) + Vector::Y * 2.0;
                let id = sim.add(BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.1)), at, turn);
                sim.load(id, if k == 19 { load } else { 1.0 } / sim.mass(id) as f32);
                if !neighbours {
                    sim.meets_static_only(id);
                }
                if let Some(before) = ids.last() {
                    joints.push(pin(&mut sim, [*before, id], [Vector::X * 0.5, Vector::X * -0.5]));
                }
                ids.push(id);
            }
            let (open, gained) = watch(&mut sim, &joints, 1200);
            let case = format!("{load} kg, neighbours touch: {neighbours}");
            if open >= 0.03 {
                wide.push(format!("{case}: a joint is open by {open} m"));
            }
            assert!(gained < 0.01, "{case}: gains {gained} J");
            let corners = [[-0.5, -0.1], [-0.5, 0.1], [0.5, -0.1], [0.5, 0.1]];
            let corners = corners.map(|[x, y]| sized(x, y, 0.1)).into_iter();
            let corners: Vec<Vector> = corners.chain(corners_behind()).collect();
            for id in &ids {
                let low = corners.iter().map(|at| sim.bodies.frame(*id).transform(*at).to_local().y);
                let low = low.fold(f32::MAX, f32::min);
                let most = if neighbours { 0.004 } else { 0.001 };
                assert!(low > -most, "{case}: overlaps by {} m", -low);
            }
            assert!(fastest(&sim, &ids) < 0.05, "{case}: {} m/s", fastest(&sim, &ids));
        }
    }
    assert!(wide.is_empty(), "{wide:#?}");
}

fn corners_behind() -> impl Iterator<Item = Vector> {
    [[-0.5, -0.1], [-0.5, 0.1], [0.5, -0.1], [0.5, 0.1]].into_iter().map(|[x, y]| sized(x, y, -0.1))
}

/// Leaves of a screen, each with limits to the next one: what strikes its limit opens no joint of the others.
#[test]
fn limits_of_a_tree_open_no_joint() {
    for rate in [2.0f32, 10.0] {
        let mut sim = sim(JointSolver::Auto);
        sim.gravity = Vector::ZERO;
        let mut last = (post(&mut sim, Vector::ZERO), Vector::ZERO);
        let (mut joints, mut ids) = (Vec::new(), Vec::new());
        for k in 0..3 {
            let out = 0.75 + 1.5 * k as f32;
            let shape = cuboid(sized(0.75, 0.1, 1.0));
            let leaf = apart(&mut sim, BodyKind::Dynamic, shape, Vector::X * out, Rot::IDENTITY);
            let turn = if k == 0 { Axis::limited(-0.5, 1.5) } else { Axis::limited(-0.2, 0.2) };
            let def = hinge(last.0, leaf, [last.1, Vector::X * -0.75]).with([TURN], turn);
            sim.join(def).unwrap();
            sim.bodies.set_velocity(leaf, Velocity { linear: Vector::Y * (rate * out), angular: spin(rate) });
            joints.push(def);
            ids.push(leaf);
            last = (leaf, Vector::X * 0.75);
        }
        let before = sim.energy();
        let (mut open, mut past) = (0.0f32, 0.0f32);
        for _ in 0..180 {
            sim.step();
            open = open.max(widest(&sim, &joints));
            for def in &joints {
                let [a, b] = def.bodies.map(|id| sim.bodies.frame(id).rotation);
                let x = a.inverse().mul(b).rotate(Vector::X);
                let angle = f64::from(x.y).atan2(f64::from(x.x)) as f32;
                let [min, max] = def.axes[TURN].limits.unwrap();
                past = past.max(min - angle).max(angle - max);
            }
        }
        assert!(sim.energy() < before, "{rate} rad/s: gains energy");
        assert!(open < 0.015, "{rate} rad/s: a joint is open by {open} m");
        assert!(past.to_degrees() < 0.2 * rate, "{rate} rad/s: {} degrees past a limit", past.to_degrees());
    }
}

/// What hangs on a loop is solved directly, the loop by rows.
#[test]
fn a_ring_bears_a_chain() {
    let mut sim = sim(JointSolver::Auto);
    let link = cuboid(sized(0.5, 0.1, 0.1));
    let hook = post(&mut sim, Vector::ZERO);
    let corners = [[0.0, 0.0], [0.6, -0.8], [0.0, -1.6], [-0.6, -0.8]].map(|[x, y]| sized(x, y, 0.0));
    let mut joints = Vec::new();
    let sides: Vec<u32> = (0..4)
        .map(|k| {
            let (from, to) = (corners[k], corners[(k + 1) % 4]);
            let turn = turned(f64::from(to.y - from.y).atan2(f64::from(to.x - from.x)) as f32);
            let id = apart(&mut sim, BodyKind::Dynamic, link.clone(), (from + to) * 0.5, turn);
            sim.load(id, 1.0 / sim.mass(id) as f32);
            id
        })
        .collect();
    for k in 0..4 {
        joints.push(pin(&mut sim, [sides[k], sides[(k + 1) % 4]], [Vector::X * 0.5, Vector::X * -0.5]));
    }
    joints.push(pin(&mut sim, [hook, sides[0]], [Vector::ZERO, Vector::X * -0.5]));
    let mut last = (sides[1], Vector::X * 0.5);
    let down = turned(-core::f32::consts::FRAC_PI_2);
    for k in 0..10 {
        let id = apart(&mut sim, BodyKind::Dynamic, link.clone(), Vector::Y * (-2.1 - k as f32), down);
        sim.load(id, if k == 9 { 20.0 } else { 1.0 } / sim.mass(id) as f32);
        joints.push(pin(&mut sim, [last.0, id], [last.1, Vector::X * -0.5]));
        last = (id, Vector::X * 0.5);
    }
    let (open, gained) = watch(&mut sim, &joints, 600);
    assert!(open < 0.05, "a joint is open by {open} m");
    assert!(gained < 20.0, "gains {gained} J");
}

/// Locked axes, kinematic hooks, joints that hold what others hold, springs, and changes of all of them.
#[test]
fn trees_of_odd_bodies_stay_together() {
    use kernel::math::AxisLocks;
    let mut sim = sim(JointSolver::Auto);
    let hook =
        apart(&mut sim, BodyKind::Kinematic, Shape::Ball(Ball { radius: 0.1 }), Vector::ZERO, Rot::IDENTITY);
    set_linear(&mut sim, hook, Vector::X);
    let mut last = (hook, Vector::ZERO);
    let mut joints = Vec::new();
    for k in 0..8 {
        let shape = cuboid(sized(0.5, 0.1, 0.1));
        let id = apart(&mut sim, BodyKind::Dynamic, shape, Vector::X * (k as f32 + 0.5), Rot::IDENTITY);
        let def = hinge(last.0, id, [last.1, Vector::X * -0.5]);
        if k == 3 {
            sim.locks[id as usize] = AxisLocks(1);
        }
        let number = sim.join(def).unwrap();
        joints.push((number, def));
        if k == 0 {
            // The same once more.
            sim.join(def).unwrap();
        }
        last = (id, Vector::X * 0.5);
    }
    let defs: Vec<JointDef> = joints.iter().map(|(_, def)| *def).collect();
    let (open, _) = watch(&mut sim, &defs, 240);
    assert!(open < 0.02, "a joint is open by {open} m");
    // Parted in the middle, both halves go on.
    sim.part(joints[5].0).unwrap();
    sim.rejoin(joints[6].0, defs[6].with(SWINGS, Axis::FREE)).unwrap();
    let rest: Vec<JointDef> = defs[..5].iter().chain(&defs[6..]).copied().collect();
    let (open, _) = watch(&mut sim, &rest, 240);
    assert!(open < 0.02, "a joint is open by {open} m");
    assert!(sim.position(hook).to_local().x > 7.9);
}

/// The same bits for any number of workers and any width.
#[test]
fn trees_do_not_depend_on_workers() {
    let run = |workers: usize, narrow: bool| {
        let mut sim = sim(JointSolver::Auto);
        sim.set_workers(workers);
        if narrow {
            sim.set_narrow();
        }
        sim.floor();
        let mut ids = Vec::new();
        for c in 0..6 {
            let turn = turned(0.3 + 0.4 * c as f32);
            let mut last = None;
            for k in 0..8 {
                let at =
                    turn.rotate(Vector::X * (k as f32 + 0.5)) + sized(3.0 * c as f32, 2.0, 0.4 * c as f32);
                let id = sim.add(BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.1)), at, turn);
                if let Some(before) = last {
                    let limits = Axis::limited(-0.6, 0.8);
                    let anchors = [Vector::X * 0.5, Vector::X * -0.5];
                    sim.join(hinge(before, id, anchors).with([TURN], limits)).unwrap();
                }
                ids.push(id);
                last = Some(id);
            }
        }
        sim.steps(180);
        let bits = |id: &u32| {
            let (v, at) = (sim.bodies.velocities[*id as usize], sim.position(*id).to_local());
            [v.linear.x, v.linear.y, v.angular.z, at.x, at.y].map(f32::to_bits)
        };
        ids.iter().map(bits).collect::<Vec<_>>()
    };
    let one = run(1, false);
    for workers in [2, 5] {
        assert!(run(workers, workers == 5) == one, "{workers} workers");
    }
}

/// A mast and a jib of welds bear a load on a cable, and hold to the millimetre; the foot tells
/// weight and moment.
#[test]
fn a_crane_holds_in_rigid_mode() {
    for (rate, substeps) in [(60.0f32, 4u32), (64.0, 6)] {
        let mut sim = sim(JointSolver::Rigid);
        (sim.dt, sim.substeps) = (1.0 / rate, substeps);
        let link = cuboid(sized(0.5, 0.1, 0.1));
        let up = turned(core::f32::consts::FRAC_PI_2);
        let mut last = (post(&mut sim, Vector::ZERO), Vector::ZERO);
        let mut welds = Vec::new();
        let mut add = |sim: &mut Sim, at: Vector, turn: Rot, kg: f32, is_weld: bool| {
            let id = apart(sim, BodyKind::Dynamic, link.clone(), at, turn);
            sim.load(id, kg / sim.mass(id) as f32);
            let anchors = [last.1, Vector::X * -0.5];
            let def = if is_weld {
                // The frames are those of the body before.
                let basis = [last.0, id].map(|body| sim.bodies.frame(body).rotation.inverse());
                let def = weld(last.0, id, anchors);
                let frames = [0, 1].map(|side| JointFrame { basis: basis[side], ..def.frames[side] });
                JointDef { frames, ..def }
            } else {
                JointDef::free([last.0, id], anchors).with(SHIFTS, Axis::LOCKED)
            };
            welds.push((sim.join(def).unwrap(), is_weld));
            last = (id, Vector::X * 0.5);
            id
        };
        (0..4).for_each(|k| _ = add(&mut sim, Vector::Y * (k as f32 + 0.5), up, 5.0, true));
        for k in 0..4 {
            add(&mut sim, Vector::Y * 4.0 + Vector::X * (k as f32 + 0.5), Rot::IDENTITY, 5.0, true);
        }
        let down = turned(-core::f32::consts::FRAC_PI_2);
        let mut hook = 0;
        for k in 0..3 {
            let at = Vector::X * 4.0 + Vector::Y * (3.5 - k as f32);
            hook = add(&mut sim, at, down, if k == 2 { 200.0 } else { 1.0 }, false);
        }
        let before = sim.position(hook).to_local();
        sim.steps(900);
        let case = format!("{rate} Hz in {substeps}");
        let moved = (sim.position(hook).to_local() - before).length();
        assert!(moved < 2.0e-3, "{case}: the load moves by {moved} m");
        for (id, is_weld) in &welds {
            let gap = sim.gap(*id).unwrap();
            assert!(gap.length < 1.0e-3 && (!is_weld || gap.angle < 1.0e-3), "{case}, joint {id}: {gap:?}");
        }
        let foot = sim.reaction(welds[0].0);
        let (weight, moment) = (10.0 * (8.0 * 5.0 + 202.0), 10.0 * (4.0 * 5.0 * 2.0 + 202.0 * 4.0));
        assert!((foot.force.y / weight - 1.0).abs() < 0.02, "{case}: {:?}, not {weight} N", foot.force);
        assert!((foot.torque.z / moment - 1.0).abs() < 0.02, "{case}: {:?}, not {moment} N·m", foot.torque);
    }
}
