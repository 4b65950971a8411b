//! The 2D scenes. Those named as in Box2D's benchmark have its set-up, at most with fewer bodies, which their
//! line then says.

use crate::{
    chains,
    dim2::{Body2, D2, Shape2, V2},
    scene::{Entry, Family, Scene, Scenes, Work},
};

mod bullets;
mod compounds;
mod joint_grid;
mod jointed;
mod junkyard;
mod pyramids;
mod raycast;
mod smash;
mod still;
mod tumbler;
mod washer;

pub(crate) use washer::sections as drum_sections;

impl Scenes for D2 {
    const ALL: &'static [Entry<Self>] = &[
        speed("large_pyramid", pyramids::large),
        speed("many_pyramids", pyramids::many),
        speed("joint_grid", joint_grid::scene),
        speed("bridge", jointed::bridge),
        speed("ragdolls", jointed::ragdolls),
        speed("cars", jointed::cars),
        speed("tumbler", tumbler::scene),
        speed("smash", smash::scene),
        speed("compounds", compounds::scene),
        speed("junkyard", junkyard::scene),
        speed("washer", washer::scene),
        speed("bullets", bullets::scene),
        Entry { name: "raycast", family: Family::Queries, build: raycast::raycast },
        Entry { name: "raycast_batch", family: Family::Queries, build: raycast::raycast_batch },
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
        growth("growth_1000", || pyramids::field(9, 2)),
        growth("growth_3000", || pyramids::field(18, 3)),
        growth("growth_10000", || pyramids::field(20, 9)),
        growth("growth_30000", || pyramids::field(20, 27)),
        growth("growth_50000", || pyramids::field(20, 45)),
    ];
}

const fn speed(name: &'static str, build: fn() -> Scene<D2>) -> Entry<D2> {
    Entry { name, family: Family::Speed, build }
}

const fn idle(name: &'static str, build: fn() -> Scene<D2>) -> Entry<D2> {
    Entry { name, family: Family::Idle, build }
}

const fn joints(name: &'static str, build: fn() -> Scene<D2>) -> Entry<D2> {
    Entry { name, family: Family::Joints, build }
}

/// A chain along an axis with a weight of a mass.
fn chain(axis: usize, mass: f32) -> Scene<D2> {
    let link = [Shape2::Box(0.5, 0.05), Shape2::Box(0.05, 0.5)][axis].clone();
    chains::chain(axis, (link, 10.0), (Shape2::Box(0.5, 0.5), mass), mass)
}

const fn growth(name: &'static str, build: fn() -> Scene<D2>) -> Entry<D2> {
    Entry { name, family: Family::Growth, build }
}

/// Adds a pyramid of unit boxes whose bottom row has `base`, starting at `left`, standing on `floor`. Returns
/// the index of its top box.
fn add_pyramid(bodies: &mut Vec<Body2>, base: usize, [left, floor]: V2) -> usize {
    for row in 0..base {
        for column in 0..base - row {
            let x = left + 0.5 * (row + 1) as f32 + column as f32;
            bodies.push(Body2::dynamic([x, floor + 0.5 + row as f32], Shape2::Box(0.5, 0.5)));
        }
    }
    bodies.len() - 1
}
