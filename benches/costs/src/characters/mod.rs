//! Characters beside Rapier's: a thousand on a mesh, timed, and one on a course, judged.

mod course;
mod ours;
mod rapier;

/// A place, a velocity or half a size.
type V = [f32; 3];

/// Seconds of a tick.
const DT: f32 = 1.0 / 60.0;

/// Radius of a capsule, and length between its caps, in metres.
const SIZE: [f32; 2] = [0.4, 1.0];

/// Highest step in metres.
const STEP: f32 = 0.3;

/// Measures both dimensions, and Rapier in 3D. Bevy's compute pool has one thread, beside the main thread;
/// `taskset -c 0` leaves both one core.
pub fn measure() {
    crowd();
    println!("one character on a course, this and Rapier:");
    for part in course::parts() {
        let [ours, rapier] = [ours::walk(&part), rapier::walk(&part)].map(|way| (part.judge)(&way));
        println!("{:<42} {ours:>8.3} {rapier:>8.3}  {}", part.name, part.unit);
    }
}

/// Prints the times of a thousand characters.
fn crowd() {
    for (dimension, [step, characters]) in [("2D", ours::flat_crowd()), ("3D", ours::crowd())] {
        println!(
            "{} characters on a mesh, {dimension}: a step {step:.2}, of this characters {characters:.2}",
            SIDE * SIDE
        );
    }
    let [step, characters] = rapier::crowd();
    println!("the same with Rapier, 3D: a step {step:.2}, of this characters {characters:.2}");
}

/// Characters along each side of the square of the crowd. In 2D all stand in a row.
const SIDE: usize = 32;

/// Steps of the crowd before the first that is timed, and steps that are timed.
const STEPS: [usize; 2] = [60, 300];

/// Points along a side of the crowd's ground.
const LINE: u32 = 201;

/// The height of the crowd's hills.
fn height(x: f32, z: f32) -> f32 {
    3.0 * (x * 0.1).sin() * (z * 0.13).cos()
}

/// The velocity along x of a character of the crowd, in m/s: half of them walk one way, half of
/// them the other.
fn speed(i: usize) -> f32 {
    if i.is_multiple_of(2) { 3.0 } else { -3.0 }
}

/// Where a character of the crowd starts.
fn place(i: usize) -> V {
    let (x, z) = (2.0 * (i % SIDE) as f32, 2.0 * (i / SIDE) as f32);
    [x, height(x, z) + 1.2, z]
}

/// The crowd's ground.
fn hills() -> (Vec<V>, Vec<[u32; 3]>) {
    let vertices = (0..LINE * LINE).map(|i| ((i % LINE) as f32 * 0.5 - 18.0, (i / LINE) as f32 * 0.5 - 18.0));
    let vertices = vertices.map(|(x, z)| [x, height(x, z), z]).collect();
    let side = LINE - 1;
    let corners = (0..side * side).map(|i| i / side * LINE + i % side);
    let triangles = corners.flat_map(|i| [[i, i + LINE, i + 1], [i + 1, i + LINE, i + LINE + 1]]).collect();
    (vertices, triangles)
}
