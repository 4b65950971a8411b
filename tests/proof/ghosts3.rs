//! Bodies that slide over floors of many pieces within one collider or body, in 3D.

use avian::{math::Vector, prelude::*};
use bevy_ecs::hierarchy::ChildOf;
use bevy_transform::components::Transform;
use scenes::scene::at;

use super::world::Lab;

/// Extents of floors along x and z in metres, in pieces of a metre.
const LENGTH: i32 = 16;
const WIDTH: i32 = 4;

/// The corners of the pieces, row by row along x, with their tops at y = 0.
fn corners() -> (Vec<Vector>, Vec<[u32; 3]>) {
    let corner = |i: i32, j: i32| Vector::new((i - 3) as f32, 0.0, j as f32 - 2.13);
    let vertices = (0..=LENGTH).flat_map(|i| (0..=WIDTH).map(move |j| corner(i, j))).collect();
    let mut triangles = Vec::new();
    for i in 0..LENGTH as u32 {
        for j in 0..WIDTH as u32 {
            let (a, b) = (i * (WIDTH as u32 + 1) + j, (i + 1) * (WIDTH as u32 + 1) + j);
            triangles.extend([[a, a + 1, b], [b, a + 1, b + 1]]);
        }
    }
    (vertices, triangles)
}

fn tiles() -> impl Iterator<Item = Vector> {
    (0..LENGTH).flat_map(|i| (0..WIDTH).map(move |j| Vector::new(i as f32 - 2.5, -0.5, j as f32 - 1.63)))
}

fn floors() -> Vec<(&'static str, fn(&mut Lab))> {
    vec![
        ("children", |lab| {
            let body = lab.spawn((RigidBody::Static, Transform::default()));
            for tile in tiles() {
                lab.spawn((ChildOf(body), Collider::cuboid(1.0, 1.0, 1.0), at(tile.x, tile.y, tile.z)));
            }
        }),
        ("compound", |lab| {
            let parts =
                tiles().map(|tile| (tile, Rotation::IDENTITY, Collider::cuboid(1.0, 1.0, 1.0))).collect();
            lab.spawn((RigidBody::Static, Collider::compound(parts)));
        }),
        ("mesh", |lab| {
            let (vertices, triangles) = corners();
            lab.spawn((RigidBody::Static, Collider::trimesh(vertices, triangles)));
        }),
        ("height field", |lab| {
            let heights = vec![vec![0.0; 18]; 18];
            lab.spawn((
                RigidBody::Static,
                Collider::heightfield(heights, Vector::new(32.0, 1.0, 32.0)),
                at(5.3, 0.0, 0.13),
            ));
        }),
    ]
}

fn riders() -> Vec<(&'static str, Collider, f32)> {
    vec![
        ("box", Collider::cuboid(0.5, 0.5, 0.5), 0.25),
        ("ball", Collider::sphere(0.25), 0.25),
        ("capsule", Collider::capsule(0.2, 0.4), 0.4),
    ]
}

#[test]
fn meshes_compounds_and_children_do_not_stop_or_lift_what_slides_over_them() {
    let mut bad = Vec::new();
    for (floor, build) in floors() {
        for speed in [1.0f32, 3.0, 10.0] {
            let mut lab = Lab::with_steps(1.0 / 64.0, 6);
            lab.surfaces(0.0, 0.0);
            build(&mut lab);
            // Side by side, a piece apart: seams are below all alike.
            let riders = (-1..=1).zip(riders());
            let riders: Vec<_> = riders
                .map(|(z, (name, shape, height))| {
                    (name, lab.spawn((RigidBody::Dynamic, shape, at(0.0, height, z as f32))))
                })
                .collect();
            lab.steps(32);
            let starts: Vec<_> = riders.iter().map(|(_, body)| lab.at(*body)).collect();
            for (_, body) in &riders {
                lab.insert(*body, LinearVelocity(Vector::X * speed));
            }
            let mut bumps = [0.0f32; 3];
            for _ in 0..(10.0 / speed * 64.0) as usize {
                lab.steps(1);
                for (bump, ((_, body), start)) in bumps.iter_mut().zip(riders.iter().zip(&starts)) {
                    *bump = bump.max(lab.at(*body).y - start.y);
                }
            }
            for (bump, (name, body)) in bumps.into_iter().zip(&riders) {
                let gained = lab.get::<LinearVelocity>(*body).x / speed - 1.0;
                if gained.abs() > 1.0e-3 || bump > 5.0e-4 {
                    bad.push(format!("{name} over {floor} at {speed}: {gained:+.4}, bump {bump:.4}"));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}
