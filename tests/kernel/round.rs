//! Round bodies come to rest, roll straight, and stand still.

use super::super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Cuboid, Curved, Hull, Shape};
use kernel::table::BodyKind;
use std::sync::Arc;

fn v(x: f32, y: f32, z: f32) -> Vector {
    Vector { x, y, z }
}

fn cylinder(radius: f32, half: f32) -> Shape {
    Shape::Curved(Curved::cylinder(radius, half).expect("good sizes"))
}

/// The shapes of the piles, each about as large as a ball of radius 0.5.
fn kinds() -> [(&'static str, Shape); 5] {
    let round = Hull::cuboid(Vector::ONE * 0.4).and_then(|hull| hull.rounded(0.1)).expect("good sizes");
    // The corners of an icosahedron.
    let corners: Vec<Vector> = (0..12)
        .map(|i| {
            let side = |bit: i32, size: f32| if (i % 4) & bit == 0 { -size } else { size };
            let (short, long) = (side(1, 0.263), side(2, 0.425));
            [v(0.0, short, long), v(short, long, 0.0), v(long, 0.0, short)][(i / 4) as usize]
        })
        .collect();
    let hull = Hull::convex_hull_of(&corners).expect("good corners");
    [
        ("cylinders", cylinder(0.5, 0.5)),
        ("cones", Shape::Curved(Curved::cone(0.5, 0.5).expect("good sizes"))),
        ("frusta", Shape::Curved(Curved::frustum(0.5, 0.3, 0.4).expect("good sizes"))),
        ("rounded boxes", Shape::Hull(Arc::new(round))),
        ("hulls", Shape::Hull(Arc::new(hull))),
    ]
}

/// A pile in a box without a lid, `wide` metres wide, from layers of `wide`² bodies.
fn pile(shape: &Shape, wide: usize, count: usize) -> Sim {
    let mut sim = Sim::new();
    sim.checked = false;
    sim.sleeping = true;
    let half = 0.5 * wide as f32 + 0.1;
    let wall = |sim: &mut Sim, size: Vector, place: Vector| {
        sim.add(BodyKind::Static, Shape::Cuboid(Cuboid { half: size }), place, Rot::IDENTITY);
    };
    wall(&mut sim, v(half + 2.0, 1.0, half + 2.0), v(0.0, -1.0, 0.0));
    for side in [-1.0, 1.0] {
        wall(&mut sim, v(1.0, 20.0, half + 2.0), v(side * (half + 1.0), 20.0, 0.0));
        wall(&mut sim, v(half + 2.0, 20.0, 1.0), v(0.0, 20.0, side * (half + 1.0)));
    }
    for i in 0..count {
        let (layer, at) = (i / (wide * wide), i % (wide * wide));
        let place = |k: usize| k as f32 + 0.5 - 0.5 * wide as f32;
        // A little aside, each differently.
        let shift = |k: usize| 0.05 * ((k * 7919 % 101) as f32 / 50.5 - 1.0);
        let position =
            v(place(at % wide) + shift(i), 0.6 + 1.1 * layer as f32, place(at / wide) + shift(3 * i + 1));
        let rotation = Rot::IDENTITY.integrated(v(shift(i + 5), shift(i + 9) * 20.0, shift(i + 2)) * 4.0);
        sim.add(BodyKind::Dynamic, shape.clone(), position, rotation);
    }
    sim
}

fn awake(sim: &Sim) -> usize {
    sim.bodies.awake_dynamic().count()
}

/// The time until all sleep, in seconds; `None` if some do not.
fn time_to_rest(sim: &mut Sim, limit: f32) -> Option<f32> {
    for step in 0..(limit * 60.0) as usize {
        sim.step();
        if awake(sim) == 0 {
            return Some(step as f32 / 60.0);
        }
    }
    None
}

#[test]
fn piles_of_each_shape_fall_asleep() {
    for (name, shape) in kinds() {
        let rest = time_to_rest(&mut pile(&shape, 5, 100), 8.0);
        assert!(rest.is_some(), "100 {name} do not sleep within 8 s");
    }
    let (name, shape) = &kinds()[0];
    let rest = time_to_rest(&mut pile(shape, 7, 441), 12.0);
    assert!(rest.is_some(), "441 {name} do not sleep within 12 s");
}

#[test]
fn a_cylinder_rolls_straight_down_a_slope() {
    let mut sim = Sim::new();
    sim.checked = false;
    let tilt = Rot::from_axis_angle(Vector::Z, -0.1);
    let slope = Shape::Cuboid(Cuboid { half: v(100.0, 1.0, 20.0) });
    sim.add(BodyKind::Static, slope, tilt.rotate(v(0.0, -1.0, 0.0)), tilt);
    let lying = Rot::from_axis_angle(Vector::X, core::f32::consts::FRAC_PI_2);
    let start = tilt.rotate(v(0.0, 0.5, 0.0));
    let id = sim.add(BodyKind::Dynamic, cylinder(0.5, 0.5), start, tilt.mul(lying));
    let (mut time, mut aside, mut lifted) = (0.0, 0.0f32, 0.0f32);
    let mut moved = Vector::ZERO;
    while moved.x < 40.0 && time < 30.0 {
        sim.step();
        time += sim.dt;
        moved = tilt.inverse_rotate(sim.position(id).to_local() - start);
        aside = aside.max(moved.z.abs());
        lifted = lifted.max(moved.y.abs());
    }
    // s = ½ a t² with a = ⅔ g sin α, rolling.
    let expected = 0.5 * (2.0 / 3.0) * 10.0 * 0.1f32.sin() * time * time;
    assert!((moved.x - expected).abs() < 0.01 * expected, "{} m of {expected} in {time} s", moved.x);
    // The solver lets shapes overlap by 5 mm.
    assert!(aside < 0.005 && lifted < 0.005, "{aside} m aside, {lifted} m up or down");
}

#[test]
fn a_standing_cylinder_that_turns_stays_and_keeps_its_spin() {
    for friction in [0.0, 0.6] {
        let mut sim = Sim::new();
        let (up, still) = (Vector::Y * 0.5, Rot::IDENTITY);
        let ground = Shape::Cuboid(Cuboid { half: v(20.0, 1.0, 20.0) });
        sim.add_with(BodyKind::Static, ground, -Vector::Y, still, friction, 0.0);
        let id = sim.add_with(BodyKind::Dynamic, cylinder(0.5, 0.5), up, still, friction, 0.0);
        sim.steps(60);
        let settled = sim.position(id).to_local();
        sim.bodies.velocities[id as usize].angular = Vector::Y * 5.0;
        let mut most = 0.0f32;
        for _ in 0..300 {
            sim.step();
            most = most.max((sim.position(id).to_local() - settled).length());
        }
        assert!(most < 1.0e-3, "friction {friction}: moved by {most} m");
        // Without friction nothing slows the spin. With it, the torque ⅔ μ m g r of a disc stops it in 0.3 s.
        let spin = sim.bodies.velocities[id as usize].angular.y;
        let kept = if friction == 0.0 { (spin - 5.0).abs() < 0.005 } else { spin.abs() < 1.0e-3 };
        assert!(kept, "friction {friction}: a spin of {spin} rad/s is left of 5");
    }
}
