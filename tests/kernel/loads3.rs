//! Scenes whose instructions are counted, with the kernel alone.
//!
//! `cargo test --release -p avian_kernel3d --test it -- --ignored --exact shared::dim::loads::NAME` under a profiler that
//! collects in `Sim::step`.

use super::super::extreme::Dice;
use super::super::sim::Sim;
use super::floors::squares;
use crate::kernel::math::{Rot, Vector};
use crate::kernel::shape::{Ball, Capsule, Cuboid, Hull, Shape, Surface};
use crate::kernel::table::BodyKind;
use std::sync::Arc;

/// Steps of a count: the fall, and the first rest.
const STEPS: usize = 110;

/// A hilly surface of 20,000 triangles in cells of a metre, with a steep rim.
fn hills() -> Shape {
    let rim = |x: f32| 2.0 * (x.abs() - 43.0).max(0.0);
    let hill = |x: f32, z: f32| 1.5 * (0.21 * x).sin() * (0.17 * z).cos();
    let bump = |x: f32, z: f32| 0.25 * (0.9 * x + 0.3).sin() * (0.8 * z).sin();
    let vertex = |i: u32, j: u32| {
        let (x, z) = (i as f32 - 50.0, j as f32 - 50.0);
        Vector { x, y: hill(x, z) + bump(x, z) + rim(x) + rim(z), z }
    };
    let (vertices, facets) = squares([100; 2], vertex, |_, _| false);
    Shape::surface(Surface::new(vertices, facets).expect("a surface"))
}

/// A lumpy convex body of 12 points around a radius: a stretched icosahedron.
fn rock(radius: f32) -> Shape {
    let golden = 1.618_034;
    let k = radius / (1.0f32 + golden * golden).sqrt();
    let mut points = Vec::new();
    for a in [-1.0, 1.0] {
        for b in [-golden, golden] {
            points.push(Vector { x: 0.0, y: k * a, z: k * b });
            points.push(Vector { x: k * a, y: k * b * 0.8, z: 0.0 });
            points.push(Vector { x: k * b, y: 0.0, z: k * a });
        }
    }
    Shape::Hull(Arc::new(Hull::convex_hull_of(&points).expect("it is solid")))
}

/// A prism of 12 sides.
fn prism(radius: f32, half: f32) -> Shape {
    let corner = |i: usize| {
        let angle = (i % 12) as f32 * core::f32::consts::TAU / 12.0;
        Vector { x: radius * angle.cos(), y: if i < 12 { -half } else { half }, z: radius * angle.sin() }
    };
    let points: Vec<_> = (0..24).map(corner).collect();
    Shape::Hull(Arc::new(Hull::convex_hull_of(&points).expect("it is solid")))
}

/// 1,024 bodies of four shapes above the ground.
fn rain(ground: Shape, shapes: [Shape; 4], spacing: f32) -> Sim {
    let mut sim = Sim::new();
    sim.checked = false;
    sim.add(BodyKind::Static, ground, Vector::ZERO, Rot::IDENTITY);
    let mut dice = Dice::new(9);
    for i in 0..32 {
        for j in 0..32 {
            let place = |k: usize| spacing * (k as f32 - 15.5);
            let at = Vector { x: place(i), y: 4.75 + 0.75 * dice.signed(), z: place(j) };
            let axis = Vector { x: dice.signed(), y: 1.1, z: dice.signed() };
            let turn = Rot::from_axis_angle(axis * (1.0 / axis.length()), 2.0 * dice.signed());
            sim.add(BodyKind::Dynamic, shapes[(i + 2 * j) % 4].clone(), at, turn);
        }
    }
    sim
}

fn block(half: f32) -> Shape {
    Shape::Cuboid(Cuboid { half: Vector::ONE * half })
}

fn capsule() -> Shape {
    Shape::Capsule(Capsule { a: Vector::Y * -0.3, b: Vector::Y * 0.3, radius: 0.3 })
}

fn run(mut sim: Sim) {
    let start = std::time::Instant::now();
    sim.steps(STEPS);
    let lowest = sim.bodies.poses.iter().skip(1).fold(f64::INFINITY, |low, p| low.min(f64::from(p.center.y)));
    println!(
        "{:.2} ms a step, the lowest body at {lowest}",
        start.elapsed().as_secs_f64() * 1e3 / STEPS as f64
    );
}

#[test]
#[ignore = "for counting instructions"]
fn mixed_on_mesh() {
    let ball = Shape::Ball(Ball { radius: 0.45 });
    run(rain(hills(), [block(0.4), rock(0.5), capsule(), ball], 2.5));
}

#[test]
#[ignore = "for counting instructions"]
fn small_polyhedra_on_mesh() {
    run(rain(hills(), [block(0.15), rock(0.2), prism(0.2, 0.1), rock(0.15)], 2.5));
}

#[test]
#[ignore = "for counting instructions"]
fn large_polyhedra_on_mesh() {
    run(rain(hills(), [block(0.9), rock(1.1), prism(1.0, 0.5), rock(0.9)], 2.5));
}

#[test]
#[ignore = "for counting instructions"]
fn polyhedra_on_a_box() {
    let floor = Shape::Cuboid(Cuboid { half: Vector { x: 60.0, y: 1.0, z: 60.0 } });
    run(rain(floor, [block(0.4), rock(0.5), prism(0.4, 0.3), rock(0.45)], 0.9));
}
