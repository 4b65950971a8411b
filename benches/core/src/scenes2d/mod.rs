//! The 2D scenes. Those named as in Box2D's benchmark have its set-up, at most with fewer bodies, which their line
//! then says.

use crate::{
    dim2::{Body2, D2, Shape2, V2},
    scene::{Entry, Family, Scene},
};

mod joint_grid;
mod pyramids;
mod raycast;
mod smash;
mod tumbler;

/// All of them.
pub(crate) const ALL: &[Entry<D2>] = &[
    speed("large_pyramid", pyramids::large),
    speed("many_pyramids", pyramids::many),
    speed("joint_grid", joint_grid::scene),
    speed("tumbler", tumbler::scene),
    speed("smash", smash::scene),
    Entry { name: "raycast", family: Family::Queries, build: raycast::scene },
];

const fn speed(name: &'static str, build: fn() -> Scene<D2>) -> Entry<D2> {
    Entry { name, family: Family::Speed, build }
}

/// Adds a pyramid of unit boxes whose bottom row has `base`, starting at `left`, standing on `floor`. Returns the
/// index of its top box.
fn add_pyramid(bodies: &mut Vec<Body2>, base: usize, [left, floor]: V2) -> usize {
    for row in 0..base {
        for column in 0..base - row {
            let x = left + 0.5 * (row + 1) as f32 + column as f32;
            bodies.push(Body2::dynamic([x, floor + 0.5 + row as f32], Shape2::Box(0.5, 0.5)));
        }
    }
    bodies.len() - 1
}
