//! Ball joints with limits of swing and twist.

use super::super::extreme::Dice;
use super::super::sim::Sim;
use crate::kernel::math::{Rot, Vector};
use crate::kernel::shape::{Ball, Cuboid, Shape};
use crate::kernel::solver::coordinate::{CONE, SWING_Y, SWING_Z, TWIST, X, Z};
use crate::kernel::solver::{Axis, Drive, JointDef, JointFrame, JointSolver, Motor};
use crate::kernel::table::{BodyKind, Velocity};

/// Swing and twist of a body whose axis is its x axis, which hangs down at rest.
fn swing_and_twist(turn: Rot, rest: Rot) -> (f32, f32) {
    let q = rest.inverse().mul(turn);
    let (x, w) = (f64::from(q.x), f64::from(q.w));
    let axis = q.rotate(Vector::X);
    let swing = f64::from(axis.y.hypot(axis.z)).atan2(f64::from(axis.x));
    let mut twist = 2.0 * x.atan2(w);
    if twist > std::f64::consts::PI {
        twist -= std::f64::consts::TAU;
    } else if twist < -std::f64::consts::PI {
        twist += std::f64::consts::TAU;
    }
    (swing as f32, twist as f32)
}

/// A limb that is thrown about stays within its cone and its twist.
#[test]
fn a_limb_keeps_within_cone_and_twist() {
    for seed in 0..20 {
        let mut dice = Dice::new(seed);
        let mut sim = Sim::new();
        let hold = sim.add(BodyKind::Static, Shape::Ball(Ball { radius: 0.1 }), Vector::ZERO, Rot::IDENTITY);
        // Its x axis points down.
        let rest = Rot::from_axis_angle(Vector::Z, -core::f32::consts::FRAC_PI_2);
        let half = Vector { x: 0.3, y: 0.08, z: 0.1 };
        let limb = sim.add(BodyKind::Dynamic, Shape::Cuboid(Cuboid { half }), Vector::Y * -0.3, rest);
        sim.ghost(hold);
        sim.ghost(limb);
        let (cone, twist) = (0.3 + dice.unit(), 0.2 + dice.unit());
        let frames = [
            JointFrame { anchor: Vector::ZERO, basis: rest },
            JointFrame { anchor: Vector::X * -0.3, basis: Rot::IDENTITY },
        ];
        let def = JointDef { frames, ..JointDef::free([hold, limb], [Vector::ZERO; 2]) }
            .with(X..=Z, Axis::LOCKED)
            .with([CONE], Axis::limited(0.0, cone))
            .with([TWIST], Axis::limited(-twist, 0.5 * twist));
        sim.join(def).unwrap();
        let mut angular = || Vector { x: dice.signed(), y: 3.0 * dice.signed(), z: dice.signed() } * 10.0;
        let (mut most_swing, mut most_twist) = (0.0f32, [0.0f32; 2]);
        for step in 0..240 {
            if step % 60 == 0 {
                let angular = angular();
                let linear = angular.cross(Vector::Y * -0.3);
                sim.bodies.set_velocity(limb, Velocity { linear, angular });
            }
            sim.step();
            let frame = sim.bodies.frame(limb);
            let (swing, turn) = swing_and_twist(frame.rotation, rest);
            most_swing = most_swing.max(swing);
            most_twist = [most_twist[0].min(turn), most_twist[1].max(turn)];
            let gap = frame.transform(Vector::X * -0.3).to_local().length();
            assert!(gap < 0.02, "seed {seed}, step {step}: open by {gap} m");
        }
        let past = [most_swing - cone, -twist - most_twist[0], most_twist[1] - 0.5 * twist];
        let most = past.map(f32::to_degrees).into_iter().fold(f32::MIN, f32::max);
        assert!(most < 2.0, "seed {seed}: {past:?} rad past cone {cone} and twist {twist}");
        assert!(most_swing > 0.2, "seed {seed}: it swings by {most_swing} rad only");
    }
}

/// Twist and swings are driven apart, and stop at the cone: alone, in a row of joints, and in trees.
#[test]
fn twist_and_swings_are_driven_within_a_cone() {
    for solver in [JointSolver::Auto, JointSolver::Rows, JointSolver::Rigid] {
        for links in [1, 4] {
            for (cone, swing) in [(1.2f32, [0.5f32, -0.4]), (0.4, [0.8, 0.6])] {
                let mut sim = Sim::new();
                (sim.joint_solver, sim.gravity) = (solver, Vector::ZERO);
                // By force: springs per mass differ with the inertia that each swing moves.
                let drive = Drive::Force { stiffness: 1.5, damping: 0.5 };
                let to = |target_position: f32| {
                    let motor = Motor { target_velocity: 0.0, target_position, max_force: 1.0e6, drive };
                    Axis { motor: Some(motor), ..Axis::FREE }
                };
                let twist = 0.9;
                let shape = Shape::Cuboid(Cuboid { half: Vector { x: 0.3, y: 0.08, z: 0.1 } });
                let mut last =
                    sim.add(BodyKind::Static, Shape::Ball(Ball { radius: 0.1 }), Vector::ZERO, Rot::IDENTITY);
                sim.ghost(last);
                let mut pairs = Vec::new();
                for k in 0..links {
                    let at = Vector::X * (0.3 + 0.6 * k as f32);
                    let limb = sim.add(BodyKind::Dynamic, shape.clone(), at, Rot::IDENTITY);
                    sim.ghost(limb);
                    let anchors = [Vector::X * if k == 0 { 0.0 } else { 0.3 }, Vector::X * -0.3];
                    let def = JointDef::free([last, limb], anchors)
                        .with(X..=Z, Axis::LOCKED)
                        .with([TWIST], to(twist))
                        .with([SWING_Y], to(swing[0]))
                        .with([SWING_Z], to(swing[1]))
                        .with([CONE], Axis::limited(0.0, cone));
                    pairs.push((sim.join(def).unwrap(), def));
                    last = limb;
                }
                sim.steps(480);
                for (id, def) in &pairs {
                    let [a, b] = def.bodies.map(|id| sim.bodies.frame(id).rotation);
                    let (angle, turn) = swing_and_twist(b, a);
                    let case = format!("{solver:?}, {links} links, cone {cone}");
                    assert!((turn - twist).abs() < 0.01, "{case}: twist {turn}");
                    let wanted = swing[0].hypot(swing[1]).min(cone);
                    // Motors press against the cone, which gives way by a degree where joints are rows.
                    let most = if wanted < cone { 0.01 } else { 0.02 };
                    assert!((angle - wanted).abs() < most, "{case}: swing {angle}, not {wanted}");
                    let axis = a.inverse().mul(b).rotate(Vector::X);
                    // About y the x axis goes to −z, about z to y.
                    let along = axis.y * swing[0] + axis.z * swing[1];
                    assert!(along.abs() < 0.01, "{case}: it swings aside, {axis:?}");
                    let gap = sim.gap(*id).unwrap();
                    assert!(gap.length < 1.0e-3 && gap.angle < most, "{case}: {gap:?}");
                }
            }
        }
    }
}
