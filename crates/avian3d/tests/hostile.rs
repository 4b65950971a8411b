//! What avian3d makes of input that makes no sense: it is refused with an error, mended or quarantined with a
//! warning; it never ends in a panic, and never reaches bodies that have nothing to do with it. The files are shared
//! with avian2d.

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
