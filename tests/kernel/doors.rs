//! A kinematic door that presses a crate into a wall, and opens.

use super::blows::{CLOCKS, clocked, cuboid, phases};
use super::dim::sized;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::table::{BodyKind, Velocity};

/// Depth by which the door presses the crate in, at least, in metres, and the speed at which it opens, m/s.
const DEPTH: f32 = 0.2;
const OPENING: f32 = 5.0;

/// The maximum speed of the crate in the half second after the door has begun to open, and its way, in
/// metres. The door closes at 2 m/s, and waits for some seconds.
fn opened(clock: (f32, u32), has_floor: bool, wait: f32, phase: f32) -> [f32; 2] {
    let mut sim = clocked(clock);
    let mut solid = |kind, half, at| sim.add_with(kind, cuboid(half), at, Rot::IDENTITY, 0.3, 0.0);
    if has_floor {
        solid(BodyKind::Static, sized(20.0, 1.0, 20.0), -Vector::Y);
    }
    solid(BodyKind::Static, sized(1.0, 2.0, 2.0), sized(1.0, 2.0, 0.0));
    let crate_id = solid(BodyKind::Dynamic, Vector::ONE * 0.5, sized(-0.5, 0.5, 0.0));
    let gap = 0.05 + 2.0 / clock.0 * phase;
    let door = solid(BodyKind::Kinematic, sized(0.1, 2.0, 2.0), sized(-1.1 - gap, 2.0, 0.0));
    if !has_floor {
        sim.gravity = Vector::ZERO;
    }
    sim.steps(5);
    sim.bodies.set_velocity(door, Velocity { linear: Vector::X * 2.0, ..Velocity::default() });
    while sim.position(door).to_local().x + 1.1 < DEPTH {
        sim.step();
    }
    sim.bodies.set_velocity(door, Velocity::default());
    sim.steps((wait * clock.0) as usize);
    let start = sim.position(crate_id).to_local();
    sim.bodies.set_velocity(door, Velocity { linear: Vector::X * -OPENING, ..Velocity::default() });
    let mut fastest = 0.0f32;
    for _ in 0..(0.5 * clock.0) as usize {
        sim.step();
        fastest = fastest.max(sim.bodies.velocities[crate_id as usize].linear.length());
    }
    [fastest, (sim.position(crate_id).to_local() - start).length()]
}

/// The crate is pushed out of the wall, and is not dragged along by the door. It has moved at up to
/// 6 m/s, and by 2 m.
#[test]
fn a_door_that_opens_leaves_the_crate_that_it_pressed() {
    let mut bad = Vec::new();
    for clock in [CLOCKS[0], CLOCKS[1], CLOCKS[3]] {
        for (has_floor, wait) in [(false, 0.0), (false, 0.3), (true, 0.0), (true, 0.3)] {
            let all = phases().map(|phase| opened(clock, has_floor, wait, phase));
            let [speed, way] = all.fold([0.0f32; 2], |most, one| [0, 1].map(|i| most[i].max(one[i])));

            // Without a floor the rest of the push-out is not braked.
            if speed > 1.3 || way > if has_floor { 0.35 } else { 0.65 } {
                bad.push(format!("{clock:?}, floor {has_floor}, wait {wait} s: {speed} m/s, {way} m"));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}
