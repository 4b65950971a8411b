//! Shapes with invalid sizes or coordinates: refused with an error, or repaired.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{Scalar, Vector},
    parry::shape::SharedShape,
    physics_transform::PhysicsTransformConfig,
    prelude::*,
};
use bevy_math::Vec3;
use bevy_transform::components::Transform;

use super::world::{WRONG_SIZES, Witness, at, ball, block, is_disabled, position, steps};

#[test]
fn sizes_that_are_none_make_colliders_that_can_be_lived_with() {
    for wrong in WRONG_SIZES {
        let mut witness = Witness::new();
        // An infinite size becomes a very large one, which would push all bodies.
        let apart = CollisionLayers::new(2, 2);
        let shapes = [
            Collider::capsule(wrong, 1.0),
            Collider::capsule(0.5, wrong),
            Collider::capsule_endpoints(0.5, Vector::splat(wrong), Vector::X),
            Collider::segment(Vector::splat(wrong), Vector::X),
            Collider::polyline(vec![Vector::splat(wrong), Vector::X, Vector::splat(wrong)], None),
            Collider::polyline(vec![], None),
        ];
        // The last is made by parry, without the constructors.
        let shapes = shapes.into_iter().chain([Collider::from(SharedShape::ball(wrong))]);
        let bodies: Vec<_> = shapes
            .enumerate()
            .map(|(i, shape)| witness.spawn((RigidBody::Dynamic, shape, at(4.0 * i as f32, 1.0), apart)))
            .collect();
        witness.is_undisturbed();
        for (i, body) in bodies.into_iter().enumerate() {
            // They meet each other only: very large ones overlap all, and are pushed out by metres. What
            // cannot be stepped is disabled.
            let at = position(&witness.app, body);
            let is_there =
                if is_disabled(&witness.app, body) { at.y == 1.0 } else { (-10.2..-1.9).contains(&at.y) };
            assert!(is_there && (at.x - 4.0 * i as Scalar).abs() < 10.0, "shape {i} with {wrong} is at {at}");
        }
    }
}

#[test]
fn a_scale_that_is_none_is_ignored_or_tiny() {
    for (wrong, by_transform) in WRONG_SIZES.into_iter().flat_map(|wrong| [(wrong, false), (wrong, true)]) {
        let mut witness = Witness::new();
        let mut config = witness.app.world_mut().resource_mut::<PhysicsTransformConfig>();
        config.transform_to_collider_scale = by_transform;
        let shapes = [(0.0, ball()), (3.0, block()), (6.0, Collider::capsule(0.2, 0.3))];
        let scaled = shapes.map(|(x, shape)| witness.spawn((RigidBody::Dynamic, shape, at(x, 1.0))));
        let heights = [0.5, 0.5, 0.35];
        steps(&mut witness.app, 30);
        for body in scaled {
            let mut body = witness.app.world_mut().entity_mut(body);
            if by_transform {
                body.get_mut::<Transform>().expect("a transform").scale = Vec3::splat(wrong as f32);
            } else {
                body.get_mut::<Collider>().expect("a collider").set_scale(Vector::splat(wrong), 8);
            }
        }
        witness.is_undisturbed();
        for (body, height) in scaled.into_iter().zip(heights) {
            let at = position(&witness.app, body);
            assert!(!is_disabled(&witness.app, body), "{wrong}");
            let height = if wrong == 0.0 && !by_transform { 0.0 } else { height };
            assert!((at.y - height).abs() < 1.0e-3, "{wrong}, by transform: {by_transform}, at {at}");
        }
    }
}

#[test]
fn meshes_of_nothing_can_be_lived_with() {
    let (zero, nan) = (Vector::ZERO, Vector::splat(Scalar::NAN));
    // Collinear points, coincident points, invalid points, indices out of range, no points.
    let line: Vec<Vector> = (0..3).map(|i| Vector::X * i as Scalar).collect();
    let meshes = [
        (line, vec![[0, 1, 2]]),
        (vec![zero; 3], vec![[0, 1, 2], [2, 1, 0]]),
        (vec![zero, Vector::X, nan], vec![[0, 1, 2]]),
        (vec![zero, Vector::X, Vector::Y], vec![[0, 1, 2], [0, 1, 7], [u32::MAX; 3]]),
        (vec![], vec![]),
        (vec![], vec![[0, 1, 2]]),
    ];
    for (vertices, indices) in meshes {
        for flags in [TrimeshFlags::empty(), TrimeshFlags::FIX_INTERNAL_EDGES, TrimeshFlags::all()] {
            let mut witness = Witness::new();
            for (i, body) in [RigidBody::Static, RigidBody::Dynamic].into_iter().enumerate() {
                let x = 5.0 * i as f32;
                let mesh = Collider::trimesh_with_config(vertices.clone(), indices.clone(), flags);
                let mesh = witness.spawn((body, mesh, at(x, 1.0)));
                let above = witness.spawn((RigidBody::Dynamic, block(), at(x + 0.3, 2.0)));
                steps(&mut witness.app, 30);
                let given = format!("{vertices:?} {indices:?} {flags:?}");
                // What falls lies on the mesh, if it is one, or is still on its way to the floor.
                let [mesh, at] = [mesh, above].map(|body| position(&witness.app, body));
                assert!((-0.2..1.001).contains(&mesh.y), "{given}: {mesh}");
                let is_there = (at.x - x - 0.3).abs() < 0.8 && (0.49..1.8).contains(&at.y);
                assert!(is_there && !is_disabled(&witness.app, above), "{given}: {at}");
            }
            witness.is_undisturbed();
        }
    }
}

#[test]
fn boxes_written_by_the_app_are_not_believed() {
    for (min, max) in
        [(Vector::X, Vector::NEG_X), (Vector::NAN, Vector::NAN), (Vector::NEG_INFINITY, Vector::INFINITY)]
    {
        for body in [RigidBody::Dynamic, RigidBody::Static] {
            let mut witness = Witness::new();
            let ill = witness.spawn((body, ball(), at(0.0, 0.5), ColliderAabb::from_min_max(min, max)));
            steps(&mut witness.app, 5);
            witness.insert(ill, ColliderAabb::from_min_max(min, max));
            let on_it =
                witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 1.6), LockedAxes::ROTATION_LOCKED));
            witness.is_undisturbed();
            let heights = [on_it, ill].map(|body| position(&witness.app, body).y);
            assert!((heights[0] - 1.5).abs() < 1.0e-3 && (heights[1] - 0.5).abs() < 1.0e-3, "{heights:?}");
            assert!(!is_disabled(&witness.app, ill));
        }
    }
}

#[test]
fn hulls_that_span_nothing_are_refused() {
    let nan = Vector::splat(Scalar::NAN);
    let in_a_line = (0..5).map(|i| Vector::X * i as Scalar).collect();
    for points in [
        vec![],
        vec![Vector::ZERO],
        vec![Vector::ZERO, Vector::X],
        vec![Vector::X; 10],
        vec![nan; 10],
        vec![Vector::ZERO, Vector::X, Vector::Y, nan],
        in_a_line,
    ] {
        assert!(Collider::convex_hull(points.clone()).is_none(), "{points:?}");
    }
}
