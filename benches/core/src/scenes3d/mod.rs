//! The 3D scenes. Those named as in Box3D's benchmark have its set-up, at most with fewer bodies, which their
//! line then says.

use std::sync::Arc;

use crate::{
    chains,
    dim3::{Body3, D3, Shape3, V3},
    scene::{Entry, Family, Scene, Scenes, Work},
};

mod box_pile;
mod bullets;
mod convex_pile;
mod joint_grid;
mod junkyard;
mod mesh_terrain;
mod pile;
mod pyramids;
mod queries;
mod ragdolls;
mod still;
mod washer;

impl Scenes for D3 {
    const ALL: &'static [Entry<Self>] = &[
        speed("large_pyramid", pyramids::large),
        speed("many_pyramids", pyramids::many),
        speed("box_pile", box_pile::scene),
        speed("mesh_terrain", mesh_terrain::scene),
        speed("pile", pile::mixed),
        speed("cylinders", pile::cylinders),
        speed("joint_grid", joint_grid::scene),
        speed("ragdolls", ragdolls::scene),
        speed("convex_pile", convex_pile::scene),
        speed("junkyard", junkyard::scene),
        speed("washer", washer::scene),
        speed("bullets", bullets::scene),
        Entry { name: "raycast", family: Family::Queries, build: queries::raycast },
        Entry { name: "raycast_batch", family: Family::Queries, build: queries::raycast_batch },
        Entry { name: "ballcast", family: Family::Queries, build: queries::ballcast },
        idle("empty", still::empty),
        idle("sleeping", still::sleeping),
        idle("static", still::fixed),
        idle("static_and_awake", still::awake),
        Entry { name: "one", family: Family::Small, build: || still::few(1) },
        Entry { name: "ten", family: Family::Small, build: || still::few(10) },
        Entry { name: "hundred", family: Family::Small, build: || still::few(100) },
        Entry { name: "spawn", family: Family::Bulk, build: || still::bulk(Work::Spawn) },
        Entry { name: "despawn", family: Family::Bulk, build: || still::bulk(Work::Despawn) },
        joints("chain_1", || chain(1, 1.0)),
        joints("chain_100", || chain(1, 100.0)),
        joints("chain_1000", || chain(1, 1000.0)),
        joints("swing_1", || chain(0, 1.0)),
        joints("swing_100", || chain(0, 100.0)),
        joints("swing_1000", || chain(0, 1000.0)),
        growth("growth_100", || pyramids::field(2, 1)),
        growth("growth_300", || pyramids::field(6, 1)),
        growth("growth_1000", || pyramids::field(6, 3)),
        growth("growth_3000", || pyramids::field(9, 6)),
        growth("growth_10000", || pyramids::field(18, 10)),
        growth("growth_30000", || pyramids::field(27, 20)),
        growth("growth_50000", || pyramids::field(30, 30)),
    ];
}

const fn speed(name: &'static str, build: fn() -> Scene<D3>) -> Entry<D3> {
    Entry { name, family: Family::Speed, build }
}

const fn idle(name: &'static str, build: fn() -> Scene<D3>) -> Entry<D3> {
    Entry { name, family: Family::Idle, build }
}

const fn joints(name: &'static str, build: fn() -> Scene<D3>) -> Entry<D3> {
    Entry { name, family: Family::Joints, build }
}

/// A chain along an axis with a weight of a mass.
fn chain(axis: usize, mass: f32) -> Scene<D3> {
    let link = [Shape3::Box(0.5, 0.05, 0.05), Shape3::Box(0.05, 0.5, 0.05)][axis].clone();
    chains::chain(axis, (link, 100.0), (Shape3::Box(0.5, 0.5, 0.5), mass), mass)
}

const fn growth(name: &'static str, build: fn() -> Scene<D3>) -> Entry<D3> {
    Entry { name, family: Family::Growth, build }
}

/// A body of 100 kg/m³.
fn light(pos: V3, shape: Shape3) -> Body3 {
    Body3 { density: 100.0, ..Body3::dynamic(pos, shape) }
}

/// Adds a pyramid of unit boxes, one box deep. Returns the index of its top box.
fn add_pyramid(bodies: &mut Vec<Body3>, base: usize, left: f32, z: f32) -> usize {
    for row in 0..base {
        for column in 0..base - row {
            let x = left + 0.5 * (row + 1) as f32 + column as f32;
            bodies.push(light([x, 0.5 + row as f32, z], Shape3::Box(0.5, 0.5, 0.5)));
        }
    }
    bodies.len() - 1
}

/// A lumpy convex body of 12 points around a radius: a stretched icosahedron.
fn rock(radius: f32) -> Shape3 {
    let golden = 1.618_034_f32;
    let k = radius / (1.0 + golden * golden).sqrt();
    let mut points = Vec::new();
    for a in [-1.0, 1.0] {
        for b in [-golden, golden] {
            points.push([0.0, k * a, k * b]);
            points.push([k * a, k * b * 0.8, 0.0]);
            points.push([k * b, 0.0, k * a]);
        }
    }
    Shape3::Hull(Arc::new(points))
}
