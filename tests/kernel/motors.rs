//! Motors of all angles at once, springs beside motors, and what joints tell of themselves.

use super::dim::{TURN, any_axis_turn, sized, spin, turn_vector, turned};
use super::joints::{SHIFTS, apart, chain, cuboid, gap, hinge, inertia, motor, post, slider, weld};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Shape};
use kernel::solver::coordinate::*;
use kernel::solver::{
    Axis, AxisSpring, Drive, Give, JointDef, JointError, JointSolver, Motor, OrientationMotor, Spring,
};
use kernel::table::BodyKind;
use std::f32::consts::TAU;

const SOLVERS: [JointSolver; 3] = [JointSolver::Auto, JointSolver::Rows, JointSolver::Rigid];

fn orientation(target: Rot, drive: Drive) -> OrientationMotor {
    let target_velocity = spin(0.0);
    OrientationMotor { target_rotation: target, target_velocity, max_torque: f32::INFINITY, drive }
}

/// A ball on a pin through its centre.
fn pinned(sim: &mut Sim, motor: OrientationMotor) -> (u32, u32) {
    sim.gravity = Vector::ZERO;
    let pin = post(sim, Vector::ZERO);
    let ball = apart(sim, BodyKind::Dynamic, Shape::Ball(Ball { radius: 0.5 }), Vector::ZERO, Rot::IDENTITY);
    let def = JointDef::free([pin, ball], [Vector::ZERO; 2]).with(SHIFTS, Axis::LOCKED);
    let id = sim.join(JointDef { orientation: Some(motor), ..def }).unwrap();
    (ball, id)
}

/// θ (1 + ω t) e^(−ω t) along one arc, whether the law is per inertia or not.
#[test]
fn an_orientation_is_reached_along_the_shortest_arc() {
    for solver in SOLVERS {
        for by_force in [false, true] {
            for (angle, frequency) in [(1.5f32, 0.7f32), (-2.8, 1.0)] {
                let mut sim = Sim::new();
                (sim.substeps, sim.joint_solver) = (16, solver);
                let target = any_axis_turn(angle);
                let spring = Drive::Spring(Spring { frequency, damping_ratio: 1.0 });
                let (ball, id) = pinned(&mut sim, orientation(target, spring));
                let omega = TAU * frequency;
                if by_force {
                    let about = inertia(&sim, ball);
                    let drive =
                        Drive::Force { stiffness: omega * omega * about, damping: 2.0 * omega * about };
                    let def = JointDef::free([0, ball], [Vector::ZERO; 2]).with(SHIFTS, Axis::LOCKED);
                    sim.rejoin(id, JointDef { orientation: Some(orientation(target, drive)), ..def })
                        .unwrap();
                }
                for step in 1..=120 {
                    sim.step();
                    let t = step as f32 / 60.0;
                    let want = angle * (1.0 + omega * t) * (-omega * t).exp();
                    let left = turn_vector(target.mul(sim.bodies.frame(ball).rotation.inverse()));
                    let ideal = turn_vector(any_axis_turn(want));
                    let off = (left - ideal).length_squared().sqrt();
                    assert!(
                        off < 0.03 * angle.abs(),
                        "{solver:?}, {by_force}, {angle}: off by {off} at {t} s"
                    );
                }
            }
        }
    }
}

/// A velocity is reached by at most the torque: τ t / I.
#[test]
fn a_turning_motor_reaches_its_velocity_with_at_most_its_torque() {
    let drive = Drive::Acceleration { stiffness: 0.0, damping: 1.0e4 };
    let target_velocity = turn_vector(any_axis_turn(3.0)) * 4.0;
    let speed = target_velocity.length_squared().sqrt();
    let mut sim = Sim::new();
    let motor = OrientationMotor { target_velocity, ..orientation(Rot::IDENTITY, drive) };
    let (ball, id) = pinned(&mut sim, motor);
    let max_torque = speed * inertia(&sim, ball);
    let def = JointDef::free([0, ball], [Vector::ZERO; 2]).with(SHIFTS, Axis::LOCKED);
    let def = JointDef { orientation: Some(OrientationMotor { max_torque, ..motor }), ..def };
    sim.rejoin(id, def).unwrap();
    sim.steps(30);
    let w = sim.bodies.velocities[ball as usize].angular;
    assert!((w - target_velocity * 0.5).length_squared().sqrt() < 0.01 * speed, "{w:?}");
    let torque = sim.reaction(id).orientation.length_squared().sqrt();
    assert!((torque / max_torque - 1.0).abs() < 1.0e-3, "{torque} N·m of {max_torque}");
    sim.steps(40);
    let w = sim.bodies.velocities[ball as usize].angular;
    assert!((w - target_velocity).length_squared().sqrt() < 0.01 * speed, "{w:?}");
    assert!(sim.reaction(id).orientation.length_squared().sqrt() < 0.01 * max_torque, "it idles");
}

/// An arm of four links holds itself: k θ is the torque of the weight beyond each joint.
#[test]
fn an_arm_of_motors_bears_its_weight() {
    for solver in SOLVERS {
        for substeps in [4, 6] {
            let mut sim = Sim::new();
            (sim.substeps, sim.joint_solver) = (substeps, solver);
            let stiffness = 2000.0;
            let drive = Drive::Force { stiffness, damping: 200.0 };
            let mut last = (post(&mut sim, Vector::ZERO), Vector::ZERO);
            let (mut ids, mut joints) = (Vec::new(), Vec::new());
            for k in 0..4 {
                let at = Vector::X * (k as f32 + 0.5);
                let id = apart(&mut sim, BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.1)), at, Rot::IDENTITY);
                sim.load(id, 1.0 / sim.mass(id) as f32);
                let def = JointDef::free([last.0, id], [last.1, Vector::X * -0.5]).with(SHIFTS, Axis::LOCKED);
                let def = JointDef { orientation: Some(orientation(Rot::IDENTITY, drive)), ..def };
                joints.push((sim.join(def).unwrap(), def));
                ids.push(id);
                last = (id, Vector::X * 0.5);
            }
            sim.steps(600);
            for (k, (joint, def)) in joints.iter().enumerate() {
                let [a, b] = def.bodies.map(|id| sim.bodies.frame(id));
                let pin = b.transform(def.frames[1].anchor).to_local().x;
                let arms = ids[k..].iter().map(|id| sim.position(*id).to_local().x - pin);
                let weight = 10.0 * arms.sum::<f32>();
                let torque = -stiffness * turn_vector(b.rotation.mul(a.rotation.inverse())).z;
                let told = sim.reaction(*joint).orientation.z;
                let case = format!("{solver:?} in {substeps}, joint {k}");
                assert!((torque / weight - 1.0).abs() < 0.02, "{case}: {torque} N·m, not {weight}");
                assert!((told / weight - 1.0).abs() < 0.02, "{case}: tells {told} N·m, not {weight}");
                assert!(gap(&sim, def) < 2.0e-3, "{case}: open by {}", gap(&sim, def));
            }
            // Too weak, it gives way with its greatest torque.
            let (joint, def) = joints[0];
            let weak = OrientationMotor { max_torque: 30.0, ..orientation(Rot::IDENTITY, drive) };
            sim.rejoin(joint, JointDef { orientation: Some(weak), ..def }).unwrap();
            sim.steps(10);
            let told = sim.reaction(joint).orientation.length_squared().sqrt();
            assert!((told - 30.0).abs() < 0.01, "{solver:?}: {told} N·m");
            assert!(sim.bodies.velocities[ids[3] as usize].linear.y < -1.0, "{solver:?}: it falls");
        }
    }
}

/// A spring and a motor on one coordinate add up: the motor's force moves the spring's rest by F / k.
#[test]
fn a_spring_bears_what_a_motor_does_not() {
    for solver in SOLVERS {
        let mut sim = Sim::new();
        sim.joint_solver = solver;
        let frame = post(&mut sim, Vector::ZERO);
        let load = apart(&mut sim, BodyKind::Dynamic, cuboid(Vector::ONE * 0.5), Vector::ZERO, Rot::IDENTITY);
        let (mass, stiffness, force) = (sim.mass(load) as f32, 400.0f32, 30.0f32);
        let law = Drive::Force { stiffness, damping: 40.0 };
        let up = |motor: Option<Motor>, limits: Option<[f32; 2]>| {
            let axis = Axis { limits, spring: Some(AxisSpring { rest: 0.2, law }), motor, ..Axis::FREE };
            slider(frame, load, Axis::LOCKED).with([Y], axis)
        };
        let height = |sim: &Sim| sim.position(load).to_local().y;
        let id = sim.join(up(None, None)).unwrap();
        sim.steps(600);
        let rest = 0.2 - 10.0 * mass / stiffness;
        assert!((height(&sim) - rest).abs() < 1.0e-3, "{solver:?}: rests at {}, not {rest}", height(&sim));
        sim.rejoin(id, up(Some(motor(100.0, force)), None)).unwrap();
        sim.steps(600);
        let lifted = rest + force / stiffness;
        assert!((height(&sim) - lifted).abs() < 1.0e-3, "{solver:?}: lifted to {}", height(&sim));
        assert!((sim.reaction(id).motors[Y] - force).abs() < 0.01);
        // A strong one holds what the spring would move.
        let drive = Drive::Acceleration { stiffness: 0.0, damping: 1.0e6 };
        sim.rejoin(id, up(Some(Motor { drive, ..motor(0.0, 1.0e6) }), None)).unwrap();
        sim.bodies.set_velocity(load, Default::default());
        sim.steps(60);
        assert!((height(&sim) - lifted).abs() < 2.0e-3, "{solver:?}: held at {}", height(&sim));
        assert!((sim.reaction(id).motors[Y] - force).abs() < 0.5, "{}", sim.reaction(id).motors[Y]);
        // Limits stop both.
        sim.rejoin(id, up(Some(motor(100.0, 100.0)), Some([-1.0, 0.3]))).unwrap();
        sim.steps(120);
        assert!((height(&sim) - 0.3).abs() < 1.0e-3, "{solver:?}: stopped at {}", height(&sim));
        // A lock that gives way has a motor as well: the same spring.
        let give = Give::Compliance(1.0 / stiffness);
        let soft = Axis { motor: Some(motor(100.0, force)), ..Axis::limited(0.2, 0.2).with_give(give) };
        let def = slider(frame, load, Axis::LOCKED).with([Y], soft);
        sim.rejoin(id, JointDef { damping: [5.0, 0.0], ..def }).unwrap();
        sim.steps(900);
        assert!((height(&sim) - lifted).abs() < 1.0e-3, "{solver:?}: soft lock at {}", height(&sim));
    }
}

/// A joint tells how far it is off.
#[test]
fn a_joint_tells_its_gap() {
    let mut sim = Sim::new();
    let wall = post(&mut sim, Vector::ZERO);
    let turn = turned(0.2);
    let at = sized(0.53, 0.04, 0.0);
    let body = apart(&mut sim, BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.1)), at, turn);
    let anchor = turn.inverse_rotate(Vector::X * -0.5);
    let id = sim.join(weld(wall, body, [Vector::ZERO, anchor])).unwrap();
    let gap = sim.gap(id).unwrap();
    assert!((gap.length - 0.05).abs() < 1.0e-5 && (gap.angle - 0.2).abs() < 1.0e-5, "{gap:?}");
    let limits = Axis::limited(-0.1, 0.15);
    sim.rejoin(id, hinge(wall, body, [Vector::ZERO, anchor]).with([TURN], limits)).unwrap();
    let gap = sim.gap(id).unwrap();
    assert!((gap.length - 0.05).abs() < 1.0e-5 && (gap.angle - 0.05).abs() < 1.0e-5, "{gap:?}");
    let rope =
        JointDef::free([wall, body], [Vector::ZERO, anchor]).with([DISTANCE], Axis::limited(0.0, 0.03));
    sim.rejoin(id, rope).unwrap();
    let gap = sim.gap(id).unwrap();
    assert!((gap.length - 0.02).abs() < 1.0e-5 && gap.angle == 0.0, "{gap:?}");
    assert_eq!(sim.gap(77), None);
}

/// The force of each joint is the weight below it, whatever solves it.
#[test]
fn joints_of_a_chain_tell_the_weight_below() {
    for solver in SOLVERS {
        for (rate, substeps) in [(60.0f32, 4u32), (64.0, 6)] {
            for load in [1.0f32, 10.0, 100.0] {
                if solver == JointSolver::Rows && load > 10.0 {
                    continue;
                }
                let mut sim = Sim::new();
                (sim.checked, sim.joint_solver) = (false, solver);
                (sim.dt, sim.substeps) = (1.0 / rate, substeps);
                chain(&mut sim, 10, load, -Vector::Y);
                sim.steps(900);
                for k in 0..=10 {
                    let (told, weight) = (sim.reaction(k).force.y, 10.0 * (load + 10.0 - k as f32));
                    let case = format!("{solver:?} at {rate} Hz in {substeps}, {load} kg, joint {k}");
                    assert!((told / weight - 1.0).abs() < 0.02, "{case}: {told} N, not {weight}");
                }
            }
        }
    }
}

/// A welded beam tells force and torque at each weld.
#[test]
fn welds_of_a_beam_tell_force_and_torque() {
    for solver in [JointSolver::Auto, JointSolver::Rigid] {
        let mut sim = Sim::new();
        (sim.checked, sim.joint_solver) = (false, solver);
        let mut last = (post(&mut sim, Vector::ZERO), Vector::ZERO);
        let mut ids = Vec::new();
        for k in 0..5 {
            let at = Vector::X * (k as f32 + 0.5);
            let id = apart(&mut sim, BodyKind::Dynamic, cuboid(sized(0.5, 0.1, 0.1)), at, Rot::IDENTITY);
            sim.load(id, 2.0 / sim.mass(id) as f32);
            ids.push((sim.join(weld(last.0, id, [last.1, Vector::X * -0.5])).unwrap(), k));
            last = (id, Vector::X * 0.5);
        }
        sim.steps(900);
        for (id, k) in ids {
            let (reaction, beyond) = (sim.reaction(id), 5.0 - k as f32);
            let (force, torque) = (20.0 * beyond, 20.0 * beyond * 0.5 * beyond);
            assert!((reaction.force.y / force - 1.0).abs() < 0.02, "{solver:?}, {k}: {:?}", reaction.force);
            assert!(
                (reaction.torque.z / torque - 1.0).abs() < 0.02,
                "{solver:?}, {k}: {:?}",
                reaction.torque
            );
        }
    }
}

#[test]
fn motors_of_nonsense_are_refused() {
    let mut sim = Sim::new();
    let (ball, id) =
        pinned(&mut sim, orientation(Rot::IDENTITY, Drive::Force { stiffness: 1.0, damping: 1.0 }));
    let def = JointDef { orientation: None, ..JointDef::free([0, ball], [Vector::ZERO; 2]) };
    let good = orientation(Rot::IDENTITY, Drive::Force { stiffness: 1.0, damping: 1.0 });
    for bad in [
        OrientationMotor { max_torque: -1.0, ..good },
        OrientationMotor { max_torque: f32::NAN, ..good },
        OrientationMotor { target_velocity: spin(f32::NAN), ..good },
        OrientationMotor { drive: Drive::Force { stiffness: f32::INFINITY, damping: 0.0 }, ..good },
        OrientationMotor { drive: Drive::Spring(Spring { frequency: 0.0, damping_ratio: 1.0 }), ..good },
    ] {
        let result = sim.rejoin(id, JointDef { orientation: Some(bad), ..def });
        assert_eq!(result, Err(JointError::Orientation));
    }
    let law = Drive::Force { stiffness: f32::NAN, damping: 0.0 };
    let axis = Axis { spring: Some(AxisSpring { rest: 0.0, law }), ..Axis::FREE };
    assert_eq!(sim.rejoin(id, def.with([X], axis)), Err(JointError::Axis(X)));
    sim.steps(10);
}
