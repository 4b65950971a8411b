//! All that joints can do in one scene: the same bits for any number of workers and any width.

use super::dim::{any_axis_turn, sized, spin};
use super::joints::{SHIFTS, chain};
use super::ragdolls::{Losses, human};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector, WorldPose};
use kernel::shape::{Ball, Shape};
use kernel::solver::{
    Axis, CouplingDef, CouplingEnd, Drive, EndCoordinate, Give, JointDef, JointFrame, OrientationMotor,
    Spring,
};
use kernel::table::BodyKind;

/// A chain with a heavy ball, humans that fall on a pyramid, an arm of motors, gears, and a weight on a rope.
pub fn jointed(sim: &mut Sim) {
    sim.floor();
    for row in 0..4 {
        for column in 0..5 - row {
            let at = sized(column as f32 + 0.5 * row as f32 - 2.0, 0.5 + row as f32, 0.0);
            sim.cuboid(Vector::ONE * 0.5, at);
        }
    }
    chain(sim, 12, 100.0, Vector::X);
    for k in 0..6 {
        let at = Vector::X * (1.5 * k as f32 - 4.0) + Vector::Y * (6.5 + 0.3 * k as f32);
        let losses = [Losses::NONE, Losses { friction: 2.0, ..Losses::NONE }];
        human(sim, at, any_axis_turn(0.7 * k as f32), losses[k % 2]);
    }
    let drive = Drive::Spring(Spring { frequency: 3.0, damping_ratio: 0.7 });
    let (target_velocity, max_torque) = (spin(0.0), 50.0);
    let mut last = sim.add(
        BodyKind::Static,
        Shape::Ball(Ball { radius: 0.1 }),
        Vector::X * -9.0 + Vector::Y * 6.0,
        Rot::IDENTITY,
    );
    let mut arm = Vec::new();
    for k in 0..4 {
        let at = Vector::X * (-10.5 - k as f32) + Vector::Y * 6.0;
        let id = sim.ball(0.3, at);
        let anchors = [Vector::X * if k == 0 { -1.0 } else { -0.5 }, Vector::X * 0.5];
        let target_rotation = any_axis_turn(0.3 + 0.1 * k as f32);
        let motor = OrientationMotor { target_rotation, target_velocity, max_torque, drive };
        let def = JointDef::free([last, id], anchors).with(SHIFTS, Axis::LOCKED);
        sim.join(JointDef { orientation: Some(motor), ..def }).unwrap();
        arm.push(id);
        last = id;
    }
    for (coordinate, ratio) in [(EndCoordinate::Turn, -1.5), (EndCoordinate::Distance, 0.7)] {
        let end = |k: usize| {
            let ground =
                WorldPose::new((Vector::X * -12.0 + Vector::Y * 9.0).to_world(), any_axis_turn(k as f32));
            CouplingEnd { coordinate, frame: JointFrame::default(), ground }
        };
        let (bodies, ends, limits) = ([arm[1], arm[3]], [end(1), end(2)], [-2.0, 7.0]);
        sim.couple(CouplingDef { bodies, ends, ratio, limits, give: Give::Rigid }).unwrap();
    }
    sim.steps(150);
}

#[test]
fn jointed_scenes_do_not_depend_on_workers() {
    let run = |workers: usize, narrow: bool| {
        let mut sim = Sim::new();
        sim.checked = false;
        sim.set_workers(workers);
        if narrow {
            sim.set_narrow();
        }
        jointed(&mut sim);
        let bits = |id: u32| {
            let (v, at) = (sim.bodies.velocities[id as usize], sim.position(id).to_local());
            assert!(at.is_finite() && v.linear.is_finite());
            [v.linear.x, v.linear.y, v.angular.z, at.x, at.y].map(f32::to_bits)
        };
        sim.bodies.awake_dynamic().map(bits).collect::<Vec<_>>()
    };
    let one = run(1, false);
    for (workers, narrow) in [(1, true), (2, false), (5, true)] {
        assert!(run(workers, narrow) == one, "{workers} workers, narrow: {narrow}");
    }
}
