//! Whether stacks come to rest.

use super::dim::{across, sized};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{DIM, Rot, Vector};
use kernel::shape::{Cuboid, Shape};
use kernel::table::BodyKind;

/// The scene `large_pyramid`. Returns the top box.
fn large_pyramid(sim: &mut Sim, base: usize) -> u32 {
    let half = sized(400.0, 1.0, 400.0);
    let mut top = sim.add(BodyKind::Static, Shape::Cuboid(Cuboid { half }), Vector::Y * -1.0, Rot::IDENTITY);
    for row in 0..base {
        let count = base - row;
        for i in 0..count {
            let x = i as f32 - 0.5 * (count - 1) as f32;
            top = sim.cuboid(Vector::ONE * 0.5, Vector::X * x + Vector::Y * (row as f32 + 0.5));
        }
    }
    top
}

fn fastest(sim: &Sim) -> f32 {
    sim.bodies.velocities.iter().fold(0.0, |fastest, v| fastest.max(v.linear.length()))
}

#[test]
fn a_pyramid_does_not_shake_itself() {
    let mut sim = Sim::new();
    large_pyramid(&mut sim, 16);
    sim.steps(1800);
    assert!(fastest(&sim) < 2e-3, "after half a minute something moves at {} m/s", fastest(&sim));
}

#[test]
fn a_pyramid_of_base_64_stands_for_a_minute() {
    let mut sim = Sim::new();
    sim.checked = false;
    let top = large_pyramid(&mut sim, 64);
    sim.steps(600);
    let settled = sim.position(top).to_local();
    assert!(settled.y > 0.98 * 63.5, "it sagged to {settled:?}");
    let mut farthest = 0.0f32;
    for _ in 0..3000 {
        sim.step();
        farthest = farthest.max((sim.position(top).to_local() - settled).length());
    }
    assert!(farthest < 0.01, "in 50 s the top moved by up to {farthest} m");
}

/// Box2D's pyramid moves at 0.042 m/s on average then.
#[test]
fn a_large_pyramid_has_calmed_down_after_8_s() {
    let mut sim = Sim::new();
    sim.checked = false;
    large_pyramid(&mut sim, if DIM == 2 { 100 } else { 30 });
    sim.steps(480);
    let speeds = sim.bodies.awake_dynamic().map(|id| sim.bodies.velocities[id as usize].linear.length());
    let mean = speeds.sum::<f32>() / sim.bodies.awake_dynamic().count() as f32;
    assert!(mean < 0.042, "it moves at {mean} m/s on average");
}

#[test]
fn boxes_that_land_flat_do_not_all_jump_to_one_side() {
    let mut sim = Sim::new();
    sim.floor();
    let boxes: Vec<(u32, Vector)> = (0..64)
        .map(|i| Vector::Y * 2.0 + Vector::X * (i as f32 * 3.0 - 96.0))
        .map(|p| (sim.cuboid(Vector::ONE * 0.5, p), p))
        .collect();
    sim.steps(240);
    let (mut mean, mut most) = (Vector::ZERO, 0.0f32);
    for (id, start) in boxes {
        let moved = sim.position(id).to_local() - start;
        most = most.max(moved.x.abs()).max(across(moved).abs());
        mean += moved * (1.0 / 64.0);
    }
    assert!(most < 0.01, "one jumped by {most} m");
    assert!(mean.x.abs().max(across(mean).abs()) < 0.2 * most, "on average they jumped by {mean:?}");
}

/// Displacement of the top of a pyramid in the 50 s after 10 s of settling, for a tower and pyramids of
/// several sizes.
pub fn unrest_of_tops() {
    for base in [16, 32, 60, 62, 64, 66] {
        let mut sim = Sim::new();
        let top = large_pyramid(&mut sim, base);
        sim.steps(600);
        let settled = sim.position(top).to_local();
        let (mut farthest, mut after_ten) = ([0.0f32; 3], 0.0);
        for step in 1..=3000 {
            sim.step();
            let moved = (sim.position(top).to_local() - settled) * 1e3;
            for (far, now) in farthest.iter_mut().zip([moved.x, moved.y, across(moved)]) {
                *far = far.max(now.abs());
            }
            if step == 600 {
                after_ten = moved.length();
            }
        }
        let end = (sim.position(top).to_local() - settled).length() * 1e3;
        let speed = fastest(&sim) * 1e3;
        println!(
            "pyramid of {base}: after 10 s {after_ten:.1} mm, after 50 s {end:.1} mm, at most {farthest:.1?} mm, {speed:.2} mm/s; from {settled:.3?}"
        );
    }
    for height in [10, 20, 50, 100] {
        let mut sim = Sim::new();
        sim.floor();
        let mut top = 0;
        for i in 0..height {
            top = sim.cuboid(Vector::ONE * 0.5, Vector::Y * (0.5 + i as f32));
        }
        let mut farthest = 0.0f32;
        for _ in 0..3600 {
            sim.step();
            let p = sim.position(top).to_local();
            farthest = farthest.max(p.x.abs()).max(across(p).abs());
        }
        println!("tower of {height}: at most {:.1} mm to the side in 60 s", farthest * 1e3);
    }
}
