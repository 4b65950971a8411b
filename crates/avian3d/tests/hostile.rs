//! Invalid input to avian3d is refused with an error, repaired or quarantined with a warning. It never panics, and
//! never affects unrelated bodies. The files are shared with avian2d.

#[path = "../../../tests/hostile/changes.rs"]
mod changes;
#[path = "../../../tests/hostile/dim3.rs"]
mod dim;
#[path = "../../../tests/hostile/numbers.rs"]
mod numbers;
#[path = "../../../tests/hostile/poses.rs"]
mod poses;
#[path = "../../../tests/hostile/shapes.rs"]
mod shapes;
#[path = "../../../tests/hostile/world.rs"]
mod world;
