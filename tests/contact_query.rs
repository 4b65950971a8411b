//! Queries of two colliders, and of one, against closed forms and proofs.

use super::contact_query_dim::{corners_of, turned};
use avian::{
    collision::{
        collider::contact_query::{self, ClosestPoints, TimeOfImpactStatus},
        contact_types::SingleContact,
    },
    math::{Scalar, Vector},
    prelude::*,
};
use proptest::prelude::*;

const ZERO: Vector = Vector::ZERO;

fn cube(half: Scalar) -> Collider {
    Collider::convex_hull(corners(half)).expect("a box is convex")
}

fn turn() -> Rotation {
    Rotation::default()
}

/// A collider, and the convex parts it is made of: the corners of each, and a radius around their hull.
struct Sample {
    collider: Collider,
    parts: Vec<(Vec<Vector>, Scalar)>,
}

/// The corners of [`cube`].
fn corners(half: Scalar) -> Vec<Vector> {
    let along = |axis| move |corner: Vector| [corner - axis * half, corner + axis * half];
    Vector::AXES.into_iter().fold(vec![ZERO], |all, axis| all.into_iter().flat_map(along(axis)).collect())
}

/// The ends of the axis of a capsule.
fn ends(length: Scalar) -> Vec<Vector> {
    vec![Vector::Y * (-0.5 * length), Vector::Y * (0.5 * length)]
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
    let moved = |points: Vec<Vector>, by: Vector| points.into_iter().map(|p| p + by).collect();
    vec![
        Sample { collider: cube(0.5), parts: vec![(corners(0.5), 0.0)] },
        Sample { collider: Collider::capsule(0.3, 1.0), parts: vec![(ends(1.0), 0.3)] },
        Sample { collider: Collider::capsule(0.5, 1.0e-3), parts: vec![(ends(1.0e-3), 0.5)] },
        Sample { parts: vec![(corners_of(&hull), 0.0)], collider: hull },
        Sample {
            collider: pair,
            parts: vec![(moved(corners(0.4), Vector::X), 0.0), (moved(ends(0.5), -Vector::X), 0.4)],
        },
    ]
}

fn shapes() -> Vec<Collider> {
    samples().into_iter().map(|sample| sample.collider).collect()
}

/// How far a part reaches along a unit vector.
fn reach((points, radius): &(Vec<Vector>, Scalar), along: Vector) -> Scalar {
    points.iter().map(|p| p.dot(along)).fold(Scalar::NEG_INFINITY, Scalar::max) + radius
}

/// How far a point lies outside of a part, in the direction of a set in which it lies farthest outside.
fn outside(part: &(Vec<Vector>, Scalar), point: Vector, directions: &[Vector]) -> Scalar {
    directions.iter().map(|n| point.dot(*n) - reach(part, *n)).fold(Scalar::NEG_INFINITY, Scalar::max)
}

/// The gap between two parts along a unit vector: no more than their distance, and equal to it in the
/// direction of the nearest points.
fn gap(a: &(Vec<Vector>, Scalar), b: &(Vec<Vector>, Scalar), n: Vector) -> Scalar {
    -reach(b, -n) - reach(a, n)
}

/// Unit vectors that cover all directions.
fn directions() -> Vec<Vector> {
    let all = (1..400).map(|i| {
        let axes = Vector::AXES.into_iter().enumerate();
        axes.fold(ZERO, |at, (k, axis)| at + axis * (i as Scalar * (0.7 + 0.37 * k as Scalar)).sin())
    });
    all.filter(|v| v.length() > 0.1).map(|v| v / v.length()).collect()
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

    /// A distance is proved by two points of the shapes that are so far apart, and by a direction in which
    /// all of them is so far apart. Both come with the contact.
    #[test]
    fn distances_are_proved_by_points_and_directions(
        (i, j) in (0..5_usize, 0..5_usize),
        (x, y, angle) in (-3.0..3.0_f64, -3.0..3.0_f64, 0.0..6.0_f64),
    ) {
        let (samples, at, directions) = (samples(), Vector::X * x as Scalar + Vector::Y * y as Scalar, directions());
        let (a, b, rotation) = (&samples[i], &samples[j], turned(angle));
        let moved: Vec<(Vec<Vector>, Scalar)> = b
            .parts
            .iter()
            .map(|(points, radius)| (points.iter().map(|p| at + rotation * *p).collect(), *radius))
            .collect();
        let found = contact_query::distance(&a.collider, ZERO, turn(), &b.collider, at, rotation).unwrap();
        let meet = contact_query::intersection_test(&a.collider, ZERO, turn(), &b.collider, at, rotation).unwrap();
        prop_assert_eq!(meet, found == 0.0);
        let touch = contact_query::contact(&a.collider, ZERO, turn(), &b.collider, at, rotation, 100.0);
        let touch = touch.unwrap().expect("nearer than 100 m");
        let least = |f: &dyn Fn(&(Vec<Vector>, Scalar), &(Vec<Vector>, Scalar)) -> Scalar| {
            let pairs = a.parts.iter().flat_map(|a| moved.iter().map(move |b| f(a, b)));
            pairs.fold(Scalar::INFINITY, Scalar::min)
        };
        let apart = least(&|a, b| directions.iter().map(|n| gap(a, b, *n)).fold(Scalar::NEG_INFINITY, Scalar::max));
        prop_assert!(apart < found + 1.0e-5, "{apart} m apart, found {found}");
        if found == 0.0 {
            return Ok(());
        }
        prop_assert!((touch.penetration + found).abs() < 1.0e-5, "{} m in contact, {found}", -touch.penetration);
        let p = touch.global_point1(&Position(ZERO), &turn());
        let q = touch.global_point2(&Position(at), &rotation);
        prop_assert!(((p - q).length() - found).abs() < 1.0e-5, "{p} and {q}, {found} m");
        let [p_out, q_out] = [(&a.parts, p), (&moved, q)].map(|(parts, point)| {
            parts.iter().map(|part| outside(part, point, &directions)).fold(Scalar::INFINITY, Scalar::min)
        });
        prop_assert!(p_out < 1.0e-5 && q_out < 1.0e-5, "{p_out} and {q_out} m outside");
        if a.parts.len() * b.parts.len() == 1 {
            let proved = gap(&a.parts[0], &moved[0], touch.global_normal1(&turn()));
            prop_assert!((proved - found).abs() < 1.0e-5, "{proved} m along the normal, found {found}");
        }
    }
}
