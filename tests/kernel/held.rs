//! Bodies with locked axes that are pushed along and about them.

use super::sim::Sim;
use crate::kernel;
use kernel::math::{AxisLocks, DIM, Rot, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::BodyKind;

/// A heap of boxes and balls that overlap each other and the floor by 5 cm and more. Seven in ten
/// have locked axes.
fn heap(locks: AxisLocks) -> Sim {
    let mut sim = Sim::new();
    sim.floor();
    for i in 0..60u32 {
        let (column, layer) = ((i % 12) as f32, (i / 12) as f32);
        let position = Vector::Y * (0.45 + 0.97 * layer) + Vector::X * (0.97 * column + 0.03 * layer);
        let shape = if i % 3 == 0 {
            Shape::Ball(Ball { radius: 0.52 })
        } else {
            Shape::Cuboid(Cuboid { half: Vector::ONE * 0.5 })
        };
        let id = sim.add_with(BodyKind::Dynamic, shape, position, Rot::IDENTITY, 0.6, 0.0);
        if i % 10 < 7 {
            sim.locks[id as usize] = locks;
        }
    }
    sim
}

#[test]
fn nothing_flies_off_whatever_is_held() {
    for bits in 0..64u8 {
        // In 2D some of the bits are ignored.
        let locks = AxisLocks(if DIM == 2 { bits & 0b110_001 } else { bits });
        if DIM == 2 && locks.0 != bits {
            continue;
        }
        let mut sim = heap(locks);
        let mut fastest = 0.0f32;
        for _ in 0..60 {
            sim.step();
            for velocity in &sim.bodies.velocities {
                let speed = velocity.linear.length();
                assert!(speed.is_finite() && velocity.angular.is_finite(), "locks {bits:#08b}");
                fastest = fastest.max(speed);
            }
        }
        assert!(fastest < 25.0, "locks {bits:#08b}: {fastest} m/s");
    }
}

#[test]
fn rows_that_were_not_built_are_not_solved() {
    let mut sim = Sim::new();
    sim.checked = false;
    let half = Vector::ONE * 200.0;
    let floor =
        sim.add(BodyKind::Kinematic, Shape::Cuboid(Cuboid { half }), Vector::Y * -200.0, Rot::IDENTITY);
    sim.bodies.velocities[floor as usize].linear = Vector::Y * 0.01;
    for i in 0..200 {
        sim.cuboid(Vector::ONE * 0.5, Vector::X * (1.5 * i as f32 - 150.0) + Vector::Y * 0.5);
    }
    sim.steps(5);
    // The floor comes to rest, and its row is given to another body.
    sim.builds_rows = false;
    sim.contact_manager().set_kinematic_awake(floor, false);
    let before = sim.bodies.poses[1].center.y;
    sim.steps(20);
    assert!(sim.bodies.poses[1].center.y < before - 0.3, "nothing holds it");
}
