//! A level of a million triangles.

use avian3d::{prelude::*, schedule::StepTimes};
use bevy::prelude::*;

use crate::world::{app, median, milliseconds};

/// Quads along each side.
const SIDE: usize = 708;

/// Measures how long a mesh of a million triangles takes until a ball lies on it.
pub fn measure() {
    let (mut make, mut first, mut second, mut count) = (Vec::new(), Vec::new(), Vec::new(), 0);
    let mut slowest = String::new();
    for _ in 0..5 {
        let mut app = app(|app| {
            app.add_plugins(PhysicsPlugins::new(Update));
        });
        app.world().resource::<StepTimes>().total();
        app.update();
        let (vertices, indices) = hills();
        count = indices.len();
        let world = app.world_mut();
        make.push(milliseconds(|| {
            world.spawn((RigidBody::Static, Collider::trimesh(vertices, indices)));
        }));
        world.spawn((RigidBody::Dynamic, Collider::sphere(0.5), Transform::from_xyz(350.0, 8.0, 350.0)));
        first.push(milliseconds(|| app.update()));
        let parts = app.world().resource::<StepTimes>().parts();
        let (part, time) = parts.max_by_key(|(_, time)| *time).expect("a step was taken");
        slowest = format!("{part} {:.1}", time.as_secs_f64() * 1e3);
        second.push(milliseconds(|| app.update()));
    }
    let [make, first, second] = [make, first, second].map(median);
    println!(
        "mesh of {count} triangles: the collider {make:.1}, the first step {first:.1} (of this {slowest}), the second \
         {second:.3}"
    );
}

/// Vertices and triangles of a hilly square, which is a metre a quad.
fn hills() -> (Vec<Vec3>, Vec<[u32; 3]>) {
    let height = |x: usize, z: usize| 3.0 * (x as f32 * 0.1).sin() * (z as f32 * 0.13).cos();
    let line = SIDE + 1;
    let vertices = (0..line * line).map(|i| (i % line, i / line));
    let vertices = vertices.map(|(x, z)| Vec3::new(x as f32, height(x, z), z as f32)).collect();
    let corners = (0..SIDE * SIDE).map(|i| (i / SIDE * line + i % SIDE) as u32);
    let line = line as u32;
    let indices = corners.flat_map(|i| [[i, i + line, i + 1], [i + 1, i + line, i + line + 1]]).collect();
    (vertices, indices)
}
