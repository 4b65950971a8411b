//! avian3d in double precision; the file is shared with avian2d.

extern crate avian3d as avian;

#[path = "../../../tests/far.rs"]
mod far;
#[path = "../../../tests/forces/mod.rs"]
mod forces;
#[path = "../../../tests/forces/dim3.rs"]
mod forces_dim;

use avian::prelude::Collider;

fn floor() -> Collider {
    Collider::cuboid(100.0, 2.0, 100.0)
}

fn unit_box() -> Collider {
    Collider::cuboid(1.0, 1.0, 1.0)
}

#[test]
fn a_tower_stands() {
    far::a_tower_stands(floor(), unit_box());
}

#[test]
fn a_heap_falls_and_rests() {
    far::a_heap_falls_and_rests(floor(), unit_box());
}

#[test]
fn free_fall_is_exact() {
    far::free_fall_is_exact(floor(), unit_box());
}
