//! Queries of two colliders, and of one, against parry's answers and closed forms.

use super::contact_query_dim::{pose, turned};
use avian::{
    collision::{
        collider::contact_query::{self, ClosestPoints, TimeOfImpactStatus},
        contact_types::SingleContact,
    },
    math::{Scalar, Vector},
    parry::{self, shape::SharedShape},
    prelude::*,
};
use proptest::prelude::*;

const ZERO: Vector = Vector::ZERO;

fn cube(half: Scalar) -> Collider {
    let mut corners = vec![ZERO];
    for axis in Vector::AXES {
        corners = corners.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

fn turn() -> Rotation {
    Rotation::default()
}

/// A collider, and what it is made of: polytopes at places, each grown by a radius. Parry is exact for polytopes, and up to
/// 6 mm off for round shapes.
struct Sample {
    collider: Collider,
    cores: Vec<(Vector, SharedShape, Scalar)>,
}

fn sample(collider: Collider, cores: impl IntoIterator<Item = (Vector, Collider, Scalar)>) -> Sample {
    let cores =
        cores.into_iter().map(|(at, core, radius)| (at, core.shape_scaled().clone(), radius)).collect();
    Sample { collider, cores }
}

/// The axis of a capsule.
fn axis(length: Scalar) -> Collider {
    Collider::segment(Vector::Y * (-0.5 * length), Vector::Y * (0.5 * length))
}

/// The shapes that the random tests draw from.
fn samples() -> Vec<Sample> {
    let scattered: Vec<Vector> = (0..9)
        .map(|i| {
            let i = i as Scalar;
            let axes = Vector::AXES.into_iter().enumerate();
            axes.fold(ZERO, |at, (k, axis)| at + axis * (i * (1.3 + k as Scalar)).sin())
        })
        .collect();
    let hull = Collider::convex_hull(scattered).expect("a hull");
    let pair = Collider::compound(vec![
        (Vector::X, turn(), cube(0.4)),
        (-Vector::X, turn(), Collider::capsule(0.4, 0.5)),
    ]);
    vec![
        sample(cube(0.5), [(ZERO, cube(0.5), 0.0)]),
        sample(Collider::capsule(0.3, 1.0), [(ZERO, axis(1.0), 0.3)]),
        sample(Collider::capsule(0.5, 1.0e-3), [(ZERO, axis(1.0e-3), 0.5)]),
        sample(hull.clone(), [(ZERO, hull, 0.0)]),
        sample(pair, [(Vector::X, cube(0.4), 0.0), (-Vector::X, axis(0.5), 0.4)]),
    ]
}

fn shapes() -> Vec<Collider> {
    samples().into_iter().map(|sample| sample.collider).collect()
}

/// The distance of two samples, by that of their cores.
fn expected_distance(a: &Sample, b: &Sample, at: Vector, rotation: Rotation) -> Scalar {
    let mut least = Scalar::INFINITY;
    for (place_a, core_a, radius_a) in &a.cores {
        for (place_b, core_b, radius_b) in &b.cores {
            let (pose_a, pose_b) = (pose(*place_a, turn()), pose(at + rotation * *place_b, rotation));
            let apart = parry::query::distance(&pose_a, &**core_a, &pose_b, &**core_b).unwrap();
            least = least.min(apart - radius_a - radius_b);
        }
    }
    least.max(0.0)
}

#[test]
fn distance_and_points_of_two_boxes_are_exact() {
    let (a, b) = (cube(0.5), cube(1.0));
    let at = Vector::X * 4.0 + Vector::Y * 0.1;
    let gap = contact_query::distance(&a, ZERO, turn(), &b, at, turn()).unwrap();
    assert!((gap - 2.5).abs() < 1.0e-5, "{gap}");
    let ClosestPoints::WithinMargin(p, q) =
        contact_query::closest_points(&a, ZERO, turn(), &b, at, turn(), 3.0).unwrap()
    else {
        panic!("they are within 3 m")
    };
    assert!((p.x - 0.5).abs() < 1.0e-5 && (q.x - 3.0).abs() < 1.0e-5, "{p} {q}");
    let far = contact_query::closest_points(&a, ZERO, turn(), &b, at, turn(), 2.0).unwrap();
    assert_eq!(far, ClosestPoints::OutsideMargin);
    let inside = contact_query::closest_points(&a, ZERO, turn(), &b, Vector::X, turn(), 2.0).unwrap();
    assert_eq!(inside, ClosestPoints::Intersecting);
    assert!(contact_query::intersection_test(&a, ZERO, turn(), &b, Vector::X, turn()).unwrap());
    assert!(!contact_query::intersection_test(&a, ZERO, turn(), &b, at, turn()).unwrap());
}

#[test]
fn a_contact_is_the_same_from_both_sides() {
    let (a, b) = (cube(0.5), Collider::capsule(0.3, 1.0));
    let at = Vector::X * 0.7;
    let seen = |c: SingleContact| (c.local_point1, c.local_normal1, c.penetration);
    let one = contact_query::contact(&a, ZERO, turn(), &b, at, turn(), 0.1).unwrap().expect("they overlap");
    let other = contact_query::contact(&b, at, turn(), &a, ZERO, turn(), 0.1).unwrap().expect("they overlap");
    assert!((one.penetration - 0.1).abs() < 1.0e-4, "{one:?}");
    assert!((one.local_normal1 - Vector::X).length() < 1.0e-4, "{one:?}");
    let (p, n, d) = seen(other.flipped());
    assert!((one.penetration - d).abs() < 1.0e-4 && (one.local_normal1 - n).length() < 1.0e-3);
    assert!((p.x - one.local_point1.x).abs() < 1.0e-3);
    let apart = contact_query::contact(&a, ZERO, turn(), &b, Vector::X * 2.0, turn(), 0.1).unwrap();
    assert!(apart.is_none());
    let near = contact_query::contact(&a, ZERO, turn(), &b, Vector::X * 0.85, turn(), 0.1).unwrap();
    assert!((near.expect("within 0.1 m").penetration + 0.05).abs() < 1.0e-4);
}

#[test]
fn manifolds_of_boxes_have_all_points() {
    let (a, b) = (cube(1.0), cube(0.5));
    let at = Vector::Y * 1.49;
    let mut manifolds = vec![];
    contact_query::contact_manifolds(&a, ZERO, turn(), &b, at, turn(), 0.1, &mut manifolds);
    assert_eq!(manifolds.len(), 1);
    let manifold = &manifolds[0];
    assert_eq!(manifold.points.len(), 1 << (Vector::AXES.len() - 1));
    assert!((manifold.normal - Vector::Y).length() < 1.0e-5);
    for point in &manifold.points {
        assert!((point.penetration - 0.01).abs() < 1.0e-4);
        assert!((point.anchor1 - (point.anchor2 + at)).length() < 1.0e-5);
        assert!((point.point - point.anchor1).length() < 1.0e-5);
    }
    contact_query::contact_manifolds(&a, ZERO, turn(), &b, Vector::Y * 9.0, turn(), 0.1, &mut manifolds);
    assert!(manifolds.is_empty(), "old manifolds are removed");
}

#[test]
fn time_of_impact_is_exact() {
    let (a, b) = (cube(0.5), cube(0.5));
    let (from, towards) = (Vector::X * 5.0, Vector::X * -2.0);
    let hit =
        contact_query::time_of_impact(&a, ZERO, turn(), Vector::X * 2.0, &b, from, turn(), towards, 3.0);
    let hit = hit.unwrap().expect("they meet");
    assert!((hit.time_of_impact - 1.0).abs() < 1.0e-4, "{hit:?}");
    assert!((hit.point1.x - 0.5).abs() < 1.0e-3 && (hit.point2.x + 0.5).abs() < 1.0e-3, "{hit:?}");
    assert!((hit.normal1 - Vector::X).length() < 1.0e-3 && (hit.normal2 + Vector::X).length() < 1.0e-3);
    assert_eq!(hit.status, TimeOfImpactStatus::Converged);
    let soon =
        contact_query::time_of_impact(&a, ZERO, turn(), Vector::X * 2.0, &b, from, turn(), towards, 0.9);
    assert!(soon.unwrap().is_none());
    let still = contact_query::time_of_impact(&a, ZERO, turn(), ZERO, &b, from, turn(), ZERO, 9.0).unwrap();
    assert!(still.is_none());
    let inside =
        contact_query::time_of_impact(&a, ZERO, turn(), ZERO, &b, Vector::X * 0.5, turn(), ZERO, 9.0);
    let inside = inside.unwrap().expect("they overlap");
    assert_eq!(
        (inside.time_of_impact, inside.status),
        (0.0, TimeOfImpactStatus::PenetratingOrWithinTargetDist)
    );
}

#[test]
fn points_and_rays_of_one_collider_are_exact() {
    let cube = cube(0.5);
    let at = Vector::X * 2.0;
    let (nearest, inside) = cube.project_point(at, turn(), ZERO, true);
    assert!((nearest - Vector::X * 1.5).length() < 1.0e-5 && !inside);
    assert!((cube.distance_to_point(at, turn(), ZERO, true) - 1.5).abs() < 1.0e-5);
    let within = Vector::X * 2.4;
    assert_eq!(cube.project_point(at, turn(), within, true), (within, true));
    let (edge, inside) = cube.project_point(at, turn(), within, false);
    assert!((edge - Vector::X * 2.5).length() < 1.0e-4 && inside, "{edge}");
    assert_eq!(cube.distance_to_point(at, turn(), within, true), 0.0);
    assert!((cube.distance_to_point(at, turn(), within, false) + 0.1).abs() < 1.0e-4);
    assert!(cube.contains_point(at, turn(), within) && !cube.contains_point(at, turn(), ZERO));
    let hit = cube.cast_ray(at, turn(), ZERO, Vector::X * 2.0, 5.0, true).expect("it hits");
    assert!((hit.0 - 0.75).abs() < 1.0e-5 && (hit.1 + Vector::X).length() < 1.0e-5, "{hit:?}");
    assert!(
        cube.intersects_ray(at, turn(), ZERO, Vector::X, 1.6)
            && !cube.intersects_ray(at, turn(), ZERO, Vector::X, 1.4)
    );
    assert_eq!(cube.cast_ray(at, turn(), at, Vector::X, 5.0, true), Some((0.0, ZERO)));
    let out = cube.cast_ray(at, turn(), at, Vector::X, 5.0, false).expect("it leaves");
    assert!((out.0 - 0.5).abs() < 1.0e-5, "{out:?}");
}

#[test]
fn values_that_are_not_finite_are_no_hits() {
    let shapes = shapes();
    for bad in [Scalar::NAN, Scalar::INFINITY, Scalar::MAX] {
        let v = Vector::splat(bad);
        for a in &shapes {
            for b in &shapes {
                let _ = contact_query::contact(a, v, turn(), b, ZERO, turn(), 1.0);
                let _ = contact_query::contact(a, ZERO, turn(), b, ZERO, turn(), bad);
                let _ = contact_query::closest_points(a, ZERO, turn(), b, v, turn(), bad);
                let _ = contact_query::distance(a, ZERO, turn(), b, v, turn());
                let _ = contact_query::intersection_test(a, v, turn(), b, v, turn());
                let _ = contact_query::time_of_impact(a, ZERO, turn(), v, b, ZERO, turn(), ZERO, bad);
                contact_query::contact_manifolds(a, v, turn(), b, ZERO, turn(), bad, &mut vec![]);
            }
            if !bad.is_finite() {
                assert!(a.cast_ray(ZERO, turn(), v, Vector::X, 1.0, true).is_none());
                assert!(a.cast_ray(ZERO, turn(), ZERO, v, 1.0, true).is_none());
                assert!(!a.contains_point(ZERO, turn(), v) && !a.contains_point(v, turn(), ZERO));
            }
            assert!(a.cast_ray(ZERO, turn(), ZERO, ZERO, 1.0, true).is_none());
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2_000))]

    /// Distances are those of the cores less the radii.
    #[test]
    fn distances_and_overlaps_are_those_of_the_cores(
        (i, j) in (0..5_usize, 0..5_usize),
        (x, y, angle) in (-3.0..3.0_f64, -3.0..3.0_f64, 0.0..6.0_f64),
    ) {
        let (samples, x, y) = (samples(), x as Scalar, y as Scalar);
        let (a, b) = (&samples[i].collider, &samples[j].collider);
        let at = Vector::X * x + Vector::Y * y;
        let rotation = turned(angle);
        let expected = expected_distance(&samples[i], &samples[j], at, rotation);
        let found = contact_query::distance(a, ZERO, turn(), b, at, rotation).unwrap();
        prop_assert!((found - expected).abs() < 1.0e-4, "{found} for {expected}");
        if found > 1.0e-3 {
            prop_assert!(!contact_query::intersection_test(a, ZERO, turn(), b, at, rotation).unwrap());
            let touch = contact_query::contact(a, ZERO, turn(), b, at, rotation, 100.0).unwrap().unwrap();
            prop_assert!((touch.penetration + found).abs() < 1.0e-5);
            // Both points are the nearest.
            let p = touch.global_point1(&Position(ZERO), &turn());
            let q = touch.global_point2(&Position(at), &rotation);
            prop_assert!(((p - q).length() - found).abs() < 1.0e-4);
        }
    }
}
