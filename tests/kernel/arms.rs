//! Limits and motors of trees of joints against closed forms.

use super::dim::{TURN, sized};
use super::joint_trees::{fastest, sim};
use super::joints::{angle, apart, cuboid, hinge, post, weld};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::solver::{Axis, Drive, Give, JointSolver, Motor, Spring};
use kernel::table::BodyKind;

/// An arm of three links from a post, welded but for one hinge. Returns the hinge, its bodies, and the moment
/// of what hangs on it.
fn arm(sim: &mut Sim, hinged: usize, axis: Axis) -> (u32, [u32; 2], f32) {
    let mut last = (post(sim, Vector::ZERO), Vector::ZERO);
    let (mut joint, mut bodies, mut moment) = (0, [0; 2], 0.0);
    for k in 0..3 {
        let at = Vector::X * (k as f32 + 0.5);
        let id = apart(sim, BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.1)), at, Rot::IDENTITY);
        sim.load(id, 10.0 / sim.mass(id) as f32);
        let anchors = [last.1, Vector::X * -0.5];
        if k == hinged {
            joint = sim.join(hinge(last.0, id, anchors).with([TURN], axis)).unwrap();
            bodies = [last.0, id];
        } else {
            sim.join(hinge(last.0, id, anchors).with([TURN], Axis::LOCKED)).unwrap();
        }
        if k >= hinged {
            moment += 10.0 * sim.mass(id) as f32 * (at.x - hinged as f32);
        }
        last = (id, Vector::X * 0.5);
    }
    (joint, bodies, moment)
}

/// A limit that gives way is passed by its compliance times the load, and not by more as time passes.
#[test]
fn a_limit_that_gives_way_holds_in_a_tree() {
    for hinged in 0..3 {
        let mut sim = sim(JointSolver::Auto);
        let compliance = 1.0e-4;
        let axis = Axis::limited(0.0, 3.0).with_give(Give::Compliance(compliance));
        let (joint, _, moment) = arm(&mut sim, hinged, axis);
        sim.steps(600);
        let (off, expected) = (sim.gap(joint).unwrap().angle, moment * compliance);
        assert!((off - expected).abs() < 0.05 * expected, "joint {hinged}: {off} rad, not {expected}");
    }
}

/// A servo per mass sags by the same angle wherever it is in the tree: g over the square of its rate, for
/// what it moves.
#[test]
fn a_servo_of_a_tree_is_as_strong_as_what_it_moves_is_heavy() {
    for hinged in 0..3 {
        let mut sim = sim(JointSolver::Auto);
        let (frequency, damping_ratio) = (5.0, 1.0);
        let drive = Drive::Spring(Spring { frequency, damping_ratio });
        let motor = Motor { drive, target_velocity: 0.0, target_position: 0.0, max_force: f32::INFINITY };
        let (joint, bodies, moment) = arm(&mut sim, hinged, Axis { motor: Some(motor), ..Axis::FREE });
        sim.steps(600);
        // The inertia of rods of 1 m, 10 kg and 0.2 m across about the hinge.
        let rods = (3 - hinged) as f32;
        let inertia = 10.0 * (rods.powi(3) / 3.0 + rods * 0.04 / 12.0);
        let rate = core::f32::consts::TAU * frequency;
        let (told, expected) = (sim.reaction(joint).motors[TURN], moment / (inertia * rate * rate));
        let sag = angle(&sim, bodies[0]) - angle(&sim, bodies[1]);
        assert!((told - moment).abs() < 0.02 * moment, "joint {hinged}: {told} N·m, not {moment}");
        assert!((sag - expected).abs() < 0.05 * expected, "joint {hinged}: {sag} rad, not {expected}");
    }
}

/// A door that two hinges let turn between the same limits rests at its stop: one limit is superfluous.
#[test]
fn a_door_with_two_limited_hinges_rests_at_its_stop() {
    let mut sim = sim(JointSolver::Auto);
    let frame = post(&mut sim, Vector::ZERO);
    let door =
        apart(&mut sim, BodyKind::Dynamic, cuboid(sized(0.5, 0.05, 1.0)), Vector::X * 0.5, Rot::IDENTITY);
    let handle = apart(&mut sim, BodyKind::Dynamic, cuboid(Vector::ONE * 0.05), Vector::X, Rot::IDENTITY);
    for _ in 0..2 {
        let def = hinge(frame, door, [Vector::ZERO, Vector::X * -0.5]);
        sim.join(def.with([TURN], Axis::limited(-0.3, 1.0))).unwrap();
    }
    sim.join(weld(door, handle, [Vector::X * 0.5, Vector::ZERO])).unwrap();
    let mut fast = 0.0f32;
    for step in 0..600 {
        sim.step();
        fast = fast.max(if step < 120 { 0.0 } else { fastest(&sim, &[door, handle]) });
    }
    assert!(fast < 1.0e-3, "it rests at {fast} m/s");
    let height = sim.position(handle).to_local().y;
    assert!((height + 0.3f32.sin()).abs() < 5.0e-3, "the handle is at {height} m");
}
