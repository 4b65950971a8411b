//! Nearly touching cores and degenerate triangles, against closed forms.

use super::super::LocalManifold;
use super::tests::fresh;
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Ball, Capsule, Shape, Triangle};
use proptest::prelude::*;

fn vector(range: f32) -> impl Strategy<Value = Vector> {
    [-range..range, -range..range, -range..range].prop_map(Vector::from_array)
}

fn unit() -> impl Strategy<Value = Vector> {
    let long = vector(1.0).prop_filter("direction", |v| v.length() > 0.2);
    long.prop_map(|v| v * (1.0 / v.length()))
}

/// Two unit vectors that are not parallel.
fn two_axes() -> impl Strategy<Value = [Vector; 2]> {
    [unit(), unit()].prop_filter("across", |[u, v]| u.cross(*v).length() > 0.1)
}

fn rotation() -> impl Strategy<Value = Rot> {
    (unit(), 0.0f32..3.0).prop_map(|(axis, angle)| Rot::from_axis_angle(axis, angle))
}

/// Distances of cores, down to the rounding of 0.
fn gap() -> impl Strategy<Value = f32> {
    let tenths = |(gap, times): (f32, u32)| (0..times).fold(gap, |gap, _| 0.1 * gap);
    prop_oneof![Just(0.0f32), (0.03f32..0.3, 0..9u32).prop_map(tenths)]
}

/// A point between `a` and `b`, not near either end.
fn inner() -> impl Strategy<Value = f32> {
    0.1f32..0.9
}

fn leans(m: &LocalManifold, along: Vector) -> f32 {
    m.normal.cross(along).length()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn crossing_capsules_part_across_both_axes_however_near_they_are(
        [u, v] in two_axes(), (s, t) in (inner(), inner()), gap in gap(), turn in rotation(), at in vector(1.0),
        [ra, rb] in [0.05f32..0.5, 0.05..0.5],
    ) {
        let across = u.cross(v) * (1.0 / u.cross(v).length());
        // B's frame is rotated, with its origin at any point of its axis.
        let middle = u * (2.0 * s - 1.0) + across * gap - v * (2.0 * t - 1.0);
        let pose = Pose::new(middle + at, turn);
        let a = Shape::Capsule(Capsule { a: -u, b: u, radius: ra });
        let place = |p: Vector| pose.inverse_transform(p);
        let b = Shape::Capsule(Capsule { a: place(middle - v), b: place(middle + v), radius: rb });
        let m = fresh(&a, &b, &pose, 0.5);
        prop_assert_eq!(m.count, 1);
        prop_assert!(leans(&m, across) < 1e-3, "{} at {gap}", leans(&m, across));
        prop_assert!(gap < 1e-4 || m.normal.dot(across) > 0.0, "on the wrong side at {gap}");
        let separation = m.points[0].separation;
        prop_assert!((separation - (gap - ra - rb)).abs() < 5e-5, "{separation} at {gap}");
    }

    #[test]
    fn a_small_turn_of_capsules_side_by_side_hardly_turns_their_normal(
        u in unit(), side in unit(), tilt in -0.1f32..0.1, axis in unit(), radius in 0.2f32..0.5,
    ) {
        let side = side - u * side.dot(u);
        prop_assume!(side.length() > 0.1);
        let side = side * (1.0 / side.length());
        let half = u * (0.8 * radius);
        let a = Shape::Capsule(Capsule { a: -half, b: half, radius });
        let normal = |extra: f32| {
            let turn = Rot::from_axis_angle(axis, extra).mul(Rot::from_axis_angle(side, tilt));
            fresh(&a, &a, &Pose::new(side * (1.99 * radius), turn), 0.5).normal
        };
        // Two capsules that cross in a point turn it by the turn over the sine of their angle.
        let turned = (normal(4.0e-3) - normal(0.0)).length();
        prop_assert!(turned < 8.0e-3, "{turned} of 0.004");
    }

    #[test]
    fn a_ball_on_a_capsules_axis_parts_across_it(u in unit(), side in unit(), s in inner(), gap in gap()) {
        let side = side - u * side.dot(u);
        prop_assume!(side.length() > 0.1);
        let side = side * (1.0 / side.length());
        let a = Shape::Capsule(Capsule { a: -u, b: u, radius: 0.2 });
        let center = u * (2.0 * s - 1.0) + side * gap;
        let m = fresh(&a, &Shape::Ball(Ball { radius: 0.1 }), &Pose::new(center, Rot::IDENTITY), 0.5);
        prop_assert_eq!(m.count, 1);
        prop_assert!(m.normal.dot(u).abs() < 0.02, "{} at {gap}", m.normal.dot(u));
        prop_assert!(gap < 1e-4 || m.normal.dot(side) > 0.99, "{} at {gap}", m.normal.dot(side));
        prop_assert!((m.points[0].separation - (gap - 0.3)).abs() < 5e-5, "{:?} at {gap}", m.points[0]);
    }

    #[test]
    fn a_ball_in_a_triangles_plane_parts_along_its_normal(
        [u, v] in two_axes(), (s, t) in (0.1f32..0.4, 0.1f32..0.4), gap in gap(), above in any::<bool>(), at in vector(1.0),
    ) {
        let across = u.cross(v) * (1.0 / u.cross(v).length());
        let a = Shape::Triangle(Triangle { a: at, b: at + u, c: at + v });
        let center = at + u * s + v * t + across * if above { gap } else { -gap };
        let m = fresh(&a, &Shape::Ball(Ball { radius: 0.1 }), &Pose::new(center, Rot::IDENTITY), 0.5);
        prop_assert_eq!(m.count, 1);
        prop_assert!(leans(&m, across) < 0.02, "{} at {gap}", leans(&m, across));
        prop_assert!(gap < 1e-4 || (m.normal.dot(across) > 0.0) == above, "on the wrong side at {gap}");
        prop_assert!((m.points[0].separation - (gap - 0.1)).abs() < 5e-5, "{:?} at {gap}", m.points[0]);
    }

    #[test]
    fn a_triangle_without_area_is_the_longest_of_its_sides(
        (from, to) in (vector(1.0), vector(1.0)), inner in prop_oneof![Just(0.0f32), Just(1.0), 0.0f32..1.0], order in 0..6usize,
        center in vector(2.0), is_point in prop::bool::weighted(0.1), on in prop::bool::weighted(0.3),
    ) {
        let to = if is_point { from } else { to };
        let third = from + (to - from) * inner;
        let [a, b, c] = match order {
            0 => [from, to, third],
            1 => [from, third, to],
            2 => [third, from, to],
            3 => [to, from, third],
            4 => [to, third, from],
            _ => [third, to, from],
        };
        let center = if on { third } else { center };
        let axis = to - from;
        let square = axis.length_squared();
        let along = if square > 0.0 { ((center - from).dot(axis) / square).clamp(0.0, 1.0) } else { 0.0 };
        let away = center - (from + axis * along);
        let triangle = Shape::Triangle(Triangle { a, b, c });
        let m = fresh(&triangle, &Shape::Ball(Ball { radius: 0.1 }), &Pose::new(center, Rot::IDENTITY), 10.0);
        prop_assert_eq!(m.count, 1);
        let separation = m.points[0].separation;
        prop_assert!((separation - (away.length() - 0.1)).abs() < 5e-5, "{separation} of {}", away.length() - 0.1);
        if away.length() > 1e-3 {
            prop_assert!((m.normal - away * (1.0 / away.length())).length() < 0.01, "{:?} not along {away:?}", m.normal);
        }
    }
}
