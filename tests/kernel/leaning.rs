//! Bodies that lean at a wall slide down, and none of them gains energy.

use super::super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Capsule, Cuboid, Hull, Shape};
use kernel::table::BodyKind;
use std::sync::Arc;

/// Half the length of the longest side of each shape, in metres.
const HALF: f32 = 0.5;

fn prism(corners: usize, radius: f32, half: f32) -> Shape {
    let corner = |i: usize, y: f32| {
        let angle = i as f32 / corners as f32 * core::f32::consts::TAU;
        Vector { x: radius * angle.cos(), y, z: radius * angle.sin() }
    };
    let points: Vec<Vector> = (0..corners).flat_map(|i| [corner(i, -half), corner(i, half)]).collect();
    Shape::Hull(Arc::new(Hull::convex_hull_of(&points).expect("a prism is solid")))
}

fn shapes() -> [(&'static str, Shape); 5] {
    [
        ("coin", prism(16, HALF, 0.04)),
        ("rod", Shape::Cuboid(Cuboid { half: Vector { x: 0.05, y: HALF, z: 0.05 } })),
        ("plate", Shape::Cuboid(Cuboid { half: Vector { x: HALF, y: 0.05, z: 0.3 } })),
        ("box", Shape::Cuboid(Cuboid { half: Vector { x: 0.3, y: HALF, z: 0.2 } })),
        ("pencil", prism(6, 0.05, HALF)),
    ]
}

/// The extent of a shape in a direction.
fn reach(shape: &Shape, rotation: Rot, direction: Vector) -> f32 {
    let aabb = shape.local_aabb(rotation);
    if direction.x + direction.y + direction.z > 0.0 {
        aabb.max.dot(direction)
    } else {
        aabb.min.dot(direction)
    }
}

/// Maximum rise of a body's energy above its initial one. Energies are the maximum of each quarter second.
fn rise(shape: &Shape, tilt: f32, friction: f32, seconds: usize) -> f64 {
    let mut sim = Sim::new();
    sim.checked = false;
    let wall = Shape::Cuboid(Cuboid { half: Vector::ONE * 10.0 });
    sim.add_with(BodyKind::Static, wall.clone(), Vector::Y * -10.0, Rot::IDENTITY, friction, 0.0);
    sim.add_with(BodyKind::Static, wall, Vector { x: 10.0, y: 5.0, z: 0.0 }, Rot::IDENTITY, friction, 0.0);
    let yaw = Rot::from_axis_angle(Vector::Y, 0.1 + tilt);
    let rotation = Rot::from_axis_angle(Vector::Z, -tilt).mul(Rot::from_axis_angle(Vector::X, 0.02)).mul(yaw);
    let (x, y) = (reach(shape, rotation, Vector::X), reach(shape, rotation, -Vector::Y));
    let position = Vector { x: -x - 0.001, y: y + 0.001, z: 0.0 };
    sim.add_with(BodyKind::Dynamic, shape.clone(), position, rotation, friction, 0.0);
    let start = sim.energy();
    let (mut least, mut rise) = (start, 0.0f64);
    for _ in 0..4 * seconds {
        let mut most = f64::MIN;
        for _ in 0..15 {
            sim.step();
            most = most.max(sim.energy());
        }
        rise = rise.max(most - least);
        least = least.min(most);
    }
    rise / start
}

/// The largest rise of a shape's energy over 30 angles at which it leans.
fn worst(shape: &Shape, friction: f32) -> f64 {
    (1..=30).map(|i| rise(shape, i as f32 * 0.05, friction, 20)).fold(0.0, f64::max)
}

#[test]
fn what_leans_at_a_wall_gains_no_energy() {
    for (name, shape) in shapes() {
        for friction in [0.0, 0.3, 0.6, 1.0] {
            let worst = worst(&shape, friction);
            assert!(worst < 5.0e-4, "{name} with friction {friction}: {worst}");
        }
    }
}

/// A thin capsule rolls in the corner of floor and wall, ever faster: to 100 rad/s and more about its own axis, while
/// the axis swings. Contacts keep the arms of the start of the step, so friction acts beside the current axis: the
/// capsule gains up to half of its initial energy before it falls. With a step of the gyroscopic torque between
/// contacts and integration it gained six times as much.
#[test]
fn a_capsule_that_rolls_in_a_corner_gains_at_most_half_of_its_energy() {
    let end = Vector::Y * (HALF - 0.05);
    let shape = Shape::Capsule(Capsule { a: -end, b: end, radius: 0.05 });
    for friction in [0.0, 0.3, 0.6, 1.0] {
        let (worst, allowed) = (worst(&shape, friction), if friction < 0.5 { 0.01 } else { 0.6 });
        assert!(worst < allowed, "friction {friction}: {worst}");
    }
}
