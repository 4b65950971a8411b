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
        for (i, shape) in shapes.into_iter().enumerate() {
            witness.spawn((RigidBody::Dynamic, shape, at(4.0 * i as f32, 1.0), apart));
        }
        // Made by parry, without the constructors.
        witness.spawn((RigidBody::Dynamic, Collider::from(SharedShape::ball(wrong)), at(40.0, 1.0), apart));
        witness.is_undisturbed();
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
        for body in scaled {
            assert!(!is_disabled(&witness.app, body) && position(&witness.app, body).is_finite(), "{wrong}");
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
                assert!(position(&witness.app, mesh).is_finite(), "{given}");
                assert!(
                    position(&witness.app, above).is_finite() && !is_disabled(&witness.app, above),
                    "{given}"
                );
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
            assert!(position(&witness.app, on_it).is_finite() && !is_disabled(&witness.app, ill));
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
