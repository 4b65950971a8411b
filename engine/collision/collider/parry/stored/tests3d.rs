use super::super::tests::Numbers;
use crate::{
    collision::collider::Collider,
    math::{Quaternion, Scalar, Vector},
    parry::{
        shape::{HeightField, HeightFieldCellStatus, HeightFieldFlags, SharedShape},
        utils::Array2,
    },
    physics_transform::Rotation,
};
use serde_json::{Value, json};

/// A pseudo-random rotation.
pub(in super::super) fn turned(n: &mut Numbers) -> Rotation {
    Rotation(Quaternion::from_xyzw(n.next(), -n.next(), n.next(), n.next()).normalize())
}

/// One collider of each kind that only 3D has.
pub(in super::super) fn shapes_of_dimension(n: &mut Numbers) -> Vec<Collider> {
    let heights = |n: &mut Numbers| (0..4).map(|_| (0..5).map(|_| n.next()).collect()).collect();
    let mut holes = HeightField::with_flags(
        Array2::from_fn(3, 4, |i, j| (i * j) as Scalar * 0.1),
        n.point().abs() + 0.1,
        HeightFieldFlags::FIX_INTERNAL_EDGES,
    );
    holes.set_cell_status(1, 2, HeightFieldCellStatus::ZIGZAG_SUBDIVISION);
    holes.set_cell_status(0, 1, HeightFieldCellStatus::CELL_REMOVED);
    let corners: Vec<Vector> = n.points(14);
    let mut all = vec![
        Collider::sphere(n.next()),
        Collider::cuboid(n.next(), n.next(), n.next()),
        Collider::round_cuboid(n.next(), n.next(), n.next(), n.next()),
        Collider::cylinder(n.next(), n.next()),
        Collider::cone(n.next(), n.next()),
        SharedShape::round_cylinder(n.next(), n.next(), 0.1).into(),
        SharedShape::round_cone(n.next(), n.next(), 0.1).into(),
        Collider::heightfield(heights(n), Vector::new(n.next(), n.next(), n.next())),
        SharedShape::new(holes).into(),
        // Faces of many corners.
        Collider::convex_hull(box_corners(n.point().abs() + 0.1)).expect("a box is convex"),
    ];
    all.extend(SharedShape::round_convex_hull(&corners, 0.2).map(Collider::from));
    all
}

fn box_corners(half: Vector) -> Vec<Vector> {
    let sign = |i: u32, bit: u32| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
    (0..8).map(|i| half * Vector::new(sign(i, 0), sign(i, 1), sign(i, 2))).collect()
}

/// Documents that describe no shape.
pub(in super::super) fn shapeless() -> Vec<Value> {
    let hull = Collider::convex_hull(box_corners(Vector::ONE)).expect("a box is convex");
    let stored = serde_json::to_value(&hull).expect("can be stored")["shape"].clone();
    let with = |field: &str, value: Value| {
        let mut spoiled = stored.clone();
        spoiled["Single"]["OfDimension"]["ConvexPolyhedron"][field] = value;
        spoiled
    };
    let special = |value: Value| json!({ "Single": { "OfDimension": value } });
    let field = |rows: usize, columns: usize, heights: Value| {
        let cells = vec![0; rows.saturating_sub(1).saturating_mul(columns.saturating_sub(1)).min(100)];
        json!({ "Single": { "HeightField": {
            "rows": rows, "columns": columns, "heights": heights, "cells": cells, "scale": Vector::ONE, "flags": 0,
        } } })
    };
    vec![
        special(json!({ "Cylinder": { "half_height": -1.0, "radius": 1.0 } })),
        special(json!({ "Cone": { "half_height": 1.0, "radius": null } })),
        special(json!({ "RoundCone": { "half_height": 1.0, "radius": 1.0, "border_radius": -1.0 } })),
        field(0, 0, json!([])),
        field(1, 4, json!([1.0, 1.0, 1.0, 1.0])),
        field(2, 2, json!([1.0, 1.0, 1.0])),
        field(2, 2, json!([1.0, 1.0, 1.0, null])),
        field(usize::MAX, 2, json!([1.0, 1.0])),
        with("points", json!([])),
        with("vertices", json!([])),
        with("faces", json!([])),
        with("edges", json!([])),
        with("faces_adj_to_vertex", json!([])),
        with("edges_adj_to_vertex", json!([])),
        with("edges_adj_to_face", json!([])),
        with("vertices_adj_to_face", json!([])),
        with("vertices_adj_to_face", json!(vec![8; 24])),
        with("edges_adj_to_vertex", json!(vec![1000; 24])),
        with("points", json!(vec![vec![Value::Null; 3]; 8])),
    ]
}
