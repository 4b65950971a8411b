//! Invalid input to avian2d is refused with an error, repaired or quarantined with a warning. It never panics, and
//! never affects unrelated bodies. The files are shared with avian3d.

#[path = "../../../tests/hostile/changes.rs"]
mod changes;
#[path = "../../../tests/hostile/dim2.rs"]
mod dim;
#[path = "../../../tests/hostile/numbers.rs"]
mod numbers;
#[path = "../../../tests/hostile/poses.rs"]
mod poses;
#[path = "../../../tests/hostile/shapes.rs"]
mod shapes;
#[path = "../../../tests/hostile/world.rs"]
mod world;
