//! The parts of the course: blocks, a way through them, and what is judged.

use super::V;

/// A static box, turned about z and then about y.
pub struct Block {
    pub half: V,
    pub at: V,
    pub turn: [f32; 2],
}

/// A part of the course.
pub struct Part {
    pub name: &'static str,
    pub unit: &'static str,
    pub blocks: Vec<Block>,
    pub start: V,
    pub velocity: V,
    pub seconds: f32,
    /// By the places after each tick.
    pub judge: fn(&[V]) -> f32,
}

/// Middle of a character that stands on the ground.
const STANDING: f32 = 0.91;

/// Sine and cosine of the ramp, of 30 degrees, and its length in metres.
const RAMP: (f32, f32, f32) = (0.5, 0.866_025_4, 20.0);

/// All parts.
pub fn parts() -> Vec<Part> {
    let part = |name, unit, blocks, start, velocity, seconds, judge| Part {
        name,
        unit,
        blocks,
        start,
        velocity,
        seconds,
        judge,
    };
    let ahead = [3.0, 0.0, 0.0];
    let back = [-3.0, 0.0, 0.0];
    let foot = [-2.0, STANDING, 0.0];
    let way = "of the way on the flat";
    vec![
        part("up 20 steps of 0.25 x 0.4 m", way, stairs(), foot, ahead, 3.0, along),
        part("down the same", way, stairs(), [8.5, 5.0 + STANDING, 0.0], back, 3.0, along),
        part("up a ramp of 30 degrees", way, ramp(), foot, ahead, 3.0, along),
        part("down the same", way, ramp(), [14.0, 14.0 * 0.577 + 1.0, 0.0], back, 3.0, along),
        part("over 100 tiles: rises and falls by", "mm", tiles(), foot, ahead, 3.0, |way| {
            1e3 * spread(way, 1)
        }),
        part("along a wall of tiles, at 45 degrees", "m/s", wall(), foot, [2.0, 0.0, 2.0], 3.0, |way| {
            along(way) * 3.0
        }),
        part("in a corner of 60 degrees: shakes by", "mm", corner(), foot, ahead, 3.0, shakes),
    ]
}

/// The way along x after the first half second, as a share of that at 3 m/s.
fn along(way: &[V]) -> f32 {
    let (first, last) = (way[30], way[way.len() - 1]);
    (last[0] - first[0]).abs() / (0.05 * (way.len() - 31) as f32)
}

/// The difference between the greatest and the least of a coordinate after the first half second.
fn spread(way: &[V], axis: usize) -> f32 {
    let values = way[30..].iter().map(|at| at[axis]);
    values.clone().fold(f32::MIN, f32::max) - values.fold(f32::MAX, f32::min)
}

/// The farthest way between two places of the last second, in mm.
fn shakes(way: &[V]) -> f32 {
    let end = &way[way.len() - 60..];
    let distance = |a: &V, b: &V| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f32>().sqrt();
    1e3 * end.iter().map(|at| distance(at, &end[0])).fold(0.0, f32::max)
}

fn block(half: V, at: V, turn: [f32; 2]) -> Block {
    Block { half, at, turn }
}

/// A floor with its top at height 0.
fn floor() -> Block {
    block([50.0, 0.5, 50.0], [0.0, -0.5, 0.0], [0.0; 2])
}

fn stairs() -> Vec<Block> {
    let step = |i: u8| {
        let (x, rise) = (0.4 * f32::from(i), 0.125 * f32::from(i + 1));
        block([0.2, rise, 5.0], [x + 0.2, rise, 0.0], [0.0; 2])
    };
    let platform = block([5.0, 2.5, 5.0], [13.0, 2.5, 0.0], [0.0; 2]);
    [floor(), platform].into_iter().chain((0..20).map(step)).collect()
}

fn ramp() -> Vec<Block> {
    let (sine, cosine, length) = RAMP;
    let half = 0.5 * length;
    // The upper edge starts at the origin.
    let at = [half * cosine + 0.5 * sine, half * sine - 0.5 * cosine, 0.0];
    vec![floor(), block([half, 0.5, 5.0], at, [sine.asin(), 0.0])]
}

fn tiles() -> Vec<Block> {
    let tile = |i: u8| {
        let (row, place) = (f32::from(i / 5) - 5.0, f32::from(i % 5) - 2.0);
        block([0.5, 0.5, 0.5], [row, -0.5, place], [0.0; 2])
    };
    (0..100).map(tile).collect()
}

fn wall() -> Vec<Block> {
    let tile = |i: u8| block([0.25, 1.0, 0.25], [0.5 * f32::from(i) - 5.0, 1.0, 1.0], [0.0; 2]);
    (0..40).map(tile).chain([floor()]).collect()
}

fn corner() -> Vec<Block> {
    let side = |sign: f32| {
        let turn = sign * 30.0_f32.to_radians();
        // Its inner face goes through (2, 0, 0).
        let at = [
            2.0 - 3.0 * turn.cos() + sign * 0.5 * turn.sin(),
            1.0,
            sign * 0.5 * turn.cos() + 3.0 * turn.sin(),
        ];
        block([5.0, 1.0, 0.5], at, [0.0, turn])
    };
    vec![floor(), side(1.0), side(-1.0)]
}
