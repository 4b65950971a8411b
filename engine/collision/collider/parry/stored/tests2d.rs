use super::super::tests::Numbers;
use crate::{
    collision::collider::Collider,
    math::Vector,
    parry::shape::{HeightField, Polyline, PolylineFlags, SharedShape},
    physics_transform::Rotation,
};
use serde_json::{Value, json};

/// A pseudo-random rotation.
pub(in super::super) fn turned(n: &mut Numbers) -> Rotation {
    Rotation::radians(3.0 * n.next())
}

/// One collider of each kind that only 2D has.
pub(in super::super) fn shapes_of_dimension(n: &mut Numbers) -> Vec<Collider> {
    let mut holes = HeightField::new((0..6).map(|_| n.next()).collect(), n.point().abs() + 0.1);
    holes.set_segment_removed(2, true);
    let oriented = Polyline::with_flags(n.points(6), None, PolylineFlags::ORIENTED);
    let corners = n.points(14);
    // Some of the corners lie in sides.
    let rough: Vec<_> =
        (0..40).map(|i| Vector::from_angle(i as f32 as crate::math::Scalar * 0.157)).collect();
    let mut all = vec![
        Collider::circle(n.next()),
        Collider::ellipse(n.next(), n.next()),
        Collider::rectangle(n.next(), n.next()),
        Collider::round_rectangle(n.next(), n.next(), n.next()),
        Collider::regular_polygon(n.next() as f32, 3 + n.index(9)),
        Collider::heightfield((0..5).map(|_| n.next()).collect(), Vector::new(n.next(), n.next())),
        SharedShape::new(holes).into(),
        SharedShape::new(oriented).into(),
        Collider::convex_hull(rough).expect("a round hull"),
    ];
    all.extend(SharedShape::round_convex_hull(&corners, 0.2).map(Collider::from));
    all
}

/// Documents that describe no shape.
pub(in super::super) fn shapeless() -> Vec<Value> {
    let points = json!([Vector::ZERO, Vector::X, Vector::Y]);
    let special = |value: Value| json!({ "Single": { "OfDimension": value } });
    let polygon = |points: Value, normals: Value| {
        special(json!({ "ConvexPolygon": { "points": points, "normals": normals } }))
    };
    let field = |heights: Value, cells: Value, scale: Value| json!({ "Single": { "HeightField": { "heights": heights, "cells": cells, "scale": scale } } });
    vec![
        special(json!({ "Ellipse": { "half_size": [1.0, -1.0] } })),
        special(json!({ "Ellipse": { "half_size": [1.0, null] } })),
        special(json!({ "RegularPolygon": { "circumradius": 1.0, "sides": 2 } })),
        special(json!({ "RegularPolygon": { "circumradius": -1.0, "sides": 5 } })),
        special(json!({ "RegularPolygon": { "circumradius": 1.0, "sides": -1 } })),
        polygon(json!([]), json!([])),
        polygon(points.clone(), json!([])),
        polygon(points.clone(), points.clone()),
        polygon(json!([[null, 0.0], [1.0, 0.0], [0.0, 1.0]]), json!([[1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])),
        field(json!([]), json!([]), json!(Vector::ONE)),
        field(json!([1.0]), json!([]), json!(Vector::ONE)),
        field(json!([1.0, 2.0]), json!([]), json!(Vector::ONE)),
        field(json!([1.0, null]), json!([true]), json!(Vector::ONE)),
        field(json!([1.0, 2.0]), json!([true]), json!(Vector::ZERO)),
    ]
}
