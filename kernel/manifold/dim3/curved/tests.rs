//! Frusta against the best of many directions, and the positions of their points.

use super::super::tests::{bounded, deepest, fresh, pose, rotation, scaled, v, vector};
use super::super::view::with_view;
use super::{bytes_of, normal_of};
use crate::distance::{Accuracy, Convex, Frame, closest_cores};
use crate::manifold::pairs::FARTHEST;
use crate::manifold::{FeatureCache, LocalManifold, collide};
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Ball, Capsule, Cuboid, Curved, HalfSpace, Segment, Shape, Triangle};
use crate::tuning::manifold::{ALIKE, KEPT, MARGIN, SAME};
use proptest::prelude::*;

fn curved() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.05f32..1.0, 0.05f32..1.0).prop_map(|(r, h)| Curved::cylinder(r, h)),
        (0.1f32..1.0, 0.1f32..1.0).prop_map(|(r, h)| Curved::cone(r, h)),
        (0.0f32..1.0, 0.0f32..1.0, 0.1f32..1.0).prop_map(|(l, u, h)| Curved::frustum(l, u, h)),
    ]
    .prop_map(|shape| Shape::Curved(shape.expect("good sizes")))
}

fn any_bounded() -> impl Strategy<Value = Shape> {
    prop_oneof![2 => bounded(), 1 => curved()]
}

/// The separation along a unit normal.
fn along(a: &Shape, b: &Shape, pose: &Pose, n: Vector) -> f32 {
    let far_b = b.support(-pose.rotation.inverse_rotate(n)).expect("bounded");
    n.dot(pose.transform(far_b)) - n.dot(a.support(n).expect("bounded"))
}

/// The largest separation along any direction: the best of many, improved step by step.
fn best_along(a: &Shape, b: &Shape, pose: &Pose) -> f32 {
    const SAMPLES: usize = 600;
    let value = |n: Vector| along(a, b, pose, n);
    let mut samples: Vec<(f32, Vector)> = (0..SAMPLES)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f32 / SAMPLES as f32;
            let (angle, r) = (i as f32 * 2.399_963_2, (1.0 - z * z).sqrt());
            let n = v(r * angle.cos(), r * angle.sin(), z);
            (value(n), n)
        })
        .collect();
    samples.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut most = f32::NEG_INFINITY;
    for (mut best, mut n) in samples.into_iter().take(6) {
        let mut step = 0.1;
        for _ in 0..60 {
            if step < 1.0e-4 {
                break;
            }
            let (u, w) = (n.any_orthonormal(), n.cross(n.any_orthonormal()));
            let before = best;
            for k in 0..24 {
                let angle = k as f32 * core::f32::consts::TAU / 24.0;
                let turned = n + (u * angle.cos() + w * angle.sin()) * step;
                let turned = turned * (1.0 / turned.length());
                if value(turned) > best {
                    (best, n) = (value(turned), turned);
                }
            }
            if best == before {
                step *= 0.5;
            }
        }
        most = most.max(best);
    }
    most
}

/// An upper bound of the distance: exact where the cores are apart.
fn at_most(a: &Shape, b: &Shape, pose: &Pose) -> f32 {
    let (core_a, core_b) = (Convex::of(a).expect("bounded"), Convex::of(b).expect("bounded"));
    let accuracy = Accuracy { tolerance: 1.0e-7, beyond: f64::INFINITY };
    let guess = pose.position.widen();
    let cores = closest_cores(&core_a, &core_b, &Frame::from(pose), guess, accuracy).expect("finite");
    cores.distance as f32 - core_a.radius - core_b.radius
}

/// The distance from the middle of a shape to its farthest point, about.
fn extent(shape: &Shape) -> f32 {
    let mut extent = 0.0;
    match shape {
        Shape::Curved(s) => extent = s.extent(Vector::ZERO),
        _ => with_view(shape, |view| extent = view.map_or(0.0, |view| view.extent)),
    }
    extent
}

/// How much deeper than the best axis the found axis may be: the preference for planes, the accuracy of the
/// search, the share of the depth at which it ends, and the rounding of positions of a metre or two.
fn allowed(a: &Shape, b: &Shape, best: f32) -> f32 {
    KEPT * extent(a).min(extent(b)) + SAME * (-best).max(0.0) + 1.0e-4
}

/// Tolerance of the points' positions along the axis: an axis is exact, and a region ends, to within a
/// thousandth of the smaller shape. A plane that lacks its nearest point gets the point of an axis that is
/// farther out by up to the preference for planes.
fn inexact(a: &Shape, b: &Shape) -> f32 {
    2.0 * MARGIN * extent(a).min(extent(b)) + 1.0e-4
}

fn check(a: &Shape, b: &Shape, pose: &Pose) -> Result<(), TestCaseError> {
    let m = fresh(a, b, pose, 100.0);
    prop_assert!(m.count > 0, "within the prediction distance");
    prop_assert!((m.normal.length() - 1.0).abs() < 1e-4);
    let (along, best) = (along(a, b, pose, m.normal), best_along(a, b, pose));
    let got = deepest(&m);
    let off = inexact(a, b);
    prop_assert!((got - along).abs() < off, "reported {got}, along the normal {along}, best {best}");
    prop_assert!(along > best - allowed(a, b, best), "along the normal {along}, best {best}");
    // Points are between the surfaces: in both shapes, or as far out as half the separation.
    for p in m.points() {
        let half = 0.5 * p.separation.abs() + off;
        let over_a = along_point(a, p.point);
        let over_b = along_point(b, pose.inverse_transform(p.point));
        prop_assert!(over_a < half && over_b < half, "{over_a} {over_b} {half} of {:?}", m);
    }
    Ok(())
}

/// How far a point is outside of a shape, at least, along directions in which it may be.
fn along_point(shape: &Shape, point: Vector) -> f32 {
    let ball = Shape::Ball(Ball { radius: 0.0 });
    let m = fresh(shape, &ball, &Pose::new(point, Rot::IDENTITY), 100.0);
    m.points()[0].separation
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn frusta_agree_with_the_best_of_many_directions(a in curved(), b in any_bounded(), pose in pose(1.6)) {
        check(&a, &b, &pose)?;
        check(&b, &a, &pose.inverse())?;
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn contacts_of_frusta_are_usable_and_the_same_from_both_sides(
        a in curved(), b in any_bounded(), pose in pose(1.5), prediction in 0.0f32..0.3,
    ) {
        let one = fresh(&a, &b, &pose, prediction);
        let two = fresh(&b, &a, &pose.inverse(), prediction).flipped(&pose.inverse());
        let (p, q) = (deepest(&one), deepest(&two));
        let edge = prediction - allowed(&a, &b, prediction);
        prop_assert!((one.count > 0) == (two.count > 0) || p.min(q) > edge, "{p} {q} of {prediction}");
        if one.count > 0 && two.count > 0 {
            prop_assert!((p - q).abs() < allowed(&a, &b, p.max(q)), "{p} {q}");
            prop_assert!((one.normal.length() - 1.0).abs() < 1e-4);
            let (along, best) = (along(&a, &b, &pose, one.normal), best_along(&a, &b, &pose));
            prop_assert!((p - along).abs() < inexact(&a, &b), "reported {p}, along the normal {along}, best {best}: {one:?}");
        } else if one.count == 0 {
            // A climb along the best of many directions stalls on ridges.
            let most = at_most(&a, &b, &pose);
            prop_assert!(one.gap <= most + 1e-4, "a gap of {} of {most}", one.gap);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn turning_a_frustum_about_its_axis_changes_nothing(a in curved(), b in any_bounded(), pose in pose(1.4), angle in -3.0f32..3.0) {
        let turn = Rot::from_axis_angle(Vector::Y, angle);
        let turned = Pose::new(turn.rotate(pose.position), turn.mul(pose.rotation));
        let (m, n) = (fresh(&a, &b, &pose, 0.2), fresh(&a, &b, &turned, 0.2));
        if m.count > 0 && deepest(&m) < 0.19 {
            prop_assert!(n.count > 0 && (deepest(&m) - deepest(&n)).abs() < allowed(&a, &b, deepest(&m)), "{m:?} {n:?}");
        }
    }

    #[test]
    fn half_spaces_touch_the_lowest_points(shape in curved(), rotation in rotation(), height in -0.5f32..1.5) {
        let ground = Shape::HalfSpace(HalfSpace { normal: Vector::Y });
        let pose = Pose::new(v(0.3, height, -0.2), rotation);
        let lowest = pose.transform(shape.support(rotation.inverse_rotate(-Vector::Y)).expect("bounded"));
        let m = fresh(&ground, &shape, &pose, 0.05);
        prop_assert_eq!(m.count > 0, lowest.y <= 0.05);
        if m.count > 0 {
            // The points of a circle stay while one of them is nearly the lowest.
            prop_assert!((deepest(&m) - lowest.y).abs() < 2.0 * ALIKE + 1e-5, "{} {}", deepest(&m), lowest.y);
        } else {
            prop_assert!((m.gap - lowest.y).abs() < 1e-5);
        }
    }

    #[test]
    fn every_size_gives_usable_numbers(
        a in any_bounded(), b in curved(), pose in pose(1.0), log_a in -5i32..5, log_b in -5i32..5,
        thin in prop::sample::select(vec![0.0f32, 1e-6, 1e-3, 1.0]), prediction in prop_oneof![Just(0.0f32), Just(0.05), Just(3.0), Just(f32::MAX)],
    ) {
        let (ka, kb) = (10.0f32.powi(log_a), 10.0f32.powi(log_b));
        let Shape::Curved(b) = scaled(&b, kb) else { unreachable!() };
        let flat = Shape::Curved(Curved { half_height: b.half_height * thin, ..b });
        let needle = Shape::Curved(Curved { lower: b.lower * thin, upper: b.upper * thin, ..b });
        let a = scaled(&a, ka);
        let pose = Pose::new(pose.position * (ka + kb), pose.rotation);
        for b in [flat, needle] {
            for (m, pose) in [(fresh(&a, &b, &pose, prediction), pose), (fresh(&b, &a, &pose.inverse(), prediction), pose.inverse())] {
                for p in m.points() {
                    prop_assert!((m.normal.length() - 1.0).abs() < 1e-3);
                    prop_assert!(p.point.is_finite() && p.separation <= prediction, "{p:?} {pose:?}");
                }
                prop_assert!(m.radii.iter().all(|r| r.is_finite() && *r >= 0.0));
            }
            let deep = best_along(&a, &b, &pose) < -1e-3 * ka.min(kb) - 1e-6 * ka.max(kb);
            prop_assert!(!deep || fresh(&a, &b, &pose, prediction).count > 0, "overlapping shapes have a contact");
        }
    }

    #[test]
    fn features_last_while_a_cylinder_stands(
        radius in 0.2f32..1.0, half in 0.1f32..1.0, shift in vector(0.001), spin in -3.0f32..3.0, tilt in vector(0.0004),
        floor in 0..3usize,
    ) {
        let floors = [
            Shape::Cuboid(Cuboid { half: v(5.0, 0.5, 5.0) }),
            Shape::Curved(Curved::cylinder(4.0, 0.5).expect("good sizes")),
            Shape::HalfSpace(HalfSpace { normal: Vector::Y }),
        ];
        let (floor, top) = (&floors[floor], if floor == 2 { 0.0 } else { 0.5 });
        let cylinder = Shape::Curved(Curved::cylinder(radius, half).expect("good sizes"));
        let pose = Pose::new(v(0.3, top + half - 0.002, 0.1), Rot::from_axis_angle(Vector::Y, spin));
        let moved = Pose::new(pose.position + shift, Rot::from_axis_angle(Vector::Y, -spin).integrated(tilt));
        let names = |m: &LocalManifold| {
            let mut f: Vec<u32> = m.points().iter().map(|p| p.feature).collect();
            f.sort_unstable();
            f
        };
        let (mut cache, mut first, mut second) = (FeatureCache::NONE, LocalManifold::default(), LocalManifold::default());
        collide(floor, &cylinder, &pose, 0.02, &mut cache, &mut first);
        collide(floor, &cylinder, &moved, 0.02, &mut cache, &mut second);
        prop_assert_eq!(first.count, 4);
        prop_assert_eq!(names(&first), names(&second));
        // Points keep their places on the floor, however the cylinder is turned. Tilting moves its foot.
        let foot = tilt.length() * half + 1e-4;
        for p in first.points() {
            let other = second.points().iter().find(|q| q.feature == p.feature).expect("the same names");
            let moved = other.point - p.point - shift;
            prop_assert!(v(moved.x, 0.0, moved.z).length() < foot, "{first:?} {second:?}");
        }
    }

    #[test]
    fn directions_keep_in_two_bytes(n in vector(1.0)) {
        prop_assume!(n.length() > 0.1);
        let n = n * (1.0 / n.length());
        let [a, b] = bytes_of(n);
        let back = normal_of(FeatureCache { a, b, ..FeatureCache::NONE });
        // Half a step of 1/127 both ways moves a point of the octahedron by √6/254, and the point of the
        // sphere by up to √3 as far.
        prop_assert!((back - n).length() < 18.0_f32.sqrt() / 254.0 + 1e-4, "{n:?} {back:?}");
    }
}

fn cylinder(radius: f32, half: f32) -> Shape {
    Shape::Curved(Curved::cylinder(radius, half).expect("good sizes"))
}

#[test]
fn a_lying_cylinder_touches_in_two_points_and_rolls_about_its_axis() {
    let lying = Rot::from_axis_angle(Vector::X, core::f32::consts::FRAC_PI_2);
    let floor = Shape::Cuboid(Cuboid { half: v(5.0, 0.5, 5.0) });
    for roll in [0.0, 0.3, 2.0] {
        let pose = Pose::new(v(0.0, 0.995, 0.0), lying.mul(Rot::from_axis_angle(Vector::Y, roll)));
        let m = fresh(&floor, &cylinder(0.5, 1.0), &pose, 0.02);
        assert_eq!(m.count, 2, "{m:?}");
        assert!((m.normal - Vector::Y).length() < 1e-6);
        assert!((m.radii[1] - 0.5).abs() < 1e-4 && m.radii[0] == 0.0);
        for p in m.points() {
            assert!(p.point.x.abs() < 1e-4 && (p.point.z.abs() - 1.0).abs() < 1e-4, "{p:?}");
            assert!((p.separation + 0.005).abs() < 1e-5, "{p:?}");
        }
    }
}

#[test]
fn parallel_cylinders_touch_in_two_points() {
    let lying = Rot::from_axis_angle(Vector::Z, core::f32::consts::FRAC_PI_2);
    let pose = Pose::new(v(0.4, 0.995, 0.0), Rot::IDENTITY);
    let pose = Pose::new(lying.inverse_rotate(pose.position), Rot::IDENTITY);
    let m = fresh(&cylinder(0.5, 1.0), &cylinder(0.5, 1.0), &pose, 0.02);
    assert_eq!(m.count, 2, "{m:?}");
    let ends: Vec<f32> = m.points().iter().map(|p| lying.rotate(p.point).x).collect();
    assert!((ends[0] - ends[1]).abs() > 1.59, "{ends:?}");
    assert!(m.radii.iter().all(|r| (r - 0.5).abs() < 1e-4));
}

#[test]
fn a_cylinder_over_the_rim_of_a_box_touches_where_both_are() {
    let shelf = Shape::Cuboid(Cuboid { half: v(1.0, 0.5, 1.0) });
    let pose = Pose::new(v(1.2, 0.995, 0.0), Rot::IDENTITY);
    let m = fresh(&shelf, &cylinder(0.5, 0.5), &pose, 0.02);
    assert!(m.count >= 3, "{m:?}");
    for p in m.points() {
        assert!(p.point.x < 1.002 && (p.point - v(1.2, p.point.y, 0.0)).length() < 0.502, "{p:?}");
    }
    // A larger box holds the whole top.
    let m = fresh(&shelf, &cylinder(2.0, 0.5), &Pose::new(v(0.1, 0.995, 0.2), Rot::IDENTITY), 0.02);
    assert_eq!(m.count, 4);
    assert!(
        m.points()
            .iter()
            .all(|p| (p.point.x.abs() - 1.0).abs() < 1e-3 && (p.point.z.abs() - 1.0).abs() < 1e-3)
    );
}

/// The side of a disc was treated as the side of a cylinder with the smaller radius.
#[test]
fn issue_a_ball_within_the_larger_circle_of_a_flat_frustum_was_outside() {
    for (lower, upper) in [(0.2, 1.0), (1.0, 0.2), (0.0, 1.0)] {
        let disc = Shape::Curved(Curved { lower, upper, half_height: 0.0 });
        let others = [
            Shape::Ball(Ball { radius: 0.1 }),
            Shape::Cuboid(Cuboid { half: v(0.1, 0.1, 0.1) }),
            Shape::Curved(Curved { lower: 0.1, upper: 0.1, half_height: 0.1 }),
        ];
        for other in &others {
            for x in [0.0, 0.1, 0.3, 0.6, 0.85] {
                for side in [1.0, -1.0] {
                    let pose = Pose::new(v(x, side * 0.15, 0.0), Rot::IDENTITY);
                    for (m, flip) in [
                        (fresh(&disc, other, &pose, 0.2), 1.0),
                        (fresh(other, &disc, &pose.inverse(), 0.2), -1.0),
                    ] {
                        assert!(m.count > 0 && (deepest(&m) - 0.05).abs() < 1e-4, "{x} {side} {m:?}");
                        assert!((m.normal - Vector::Y * (side * flip)).length() < 1e-3, "{x} {side} {m:?}");
                        // Points are between the disc and the other shape.
                        for p in m.points() {
                            let at = if flip > 0.0 { p.point } else { pose.transform(p.point) };
                            assert!((at.x - x).abs() < 0.102 && (at.y - side * 0.025).abs() < 1e-3, "{m:?}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn hostile_frusta_give_no_contact() {
    let bad = |lower, upper, half_height| Shape::Curved(Curved { lower, upper, half_height });
    let nan = f32::NAN;
    let shapes = [
        bad(0.0, 0.0, 0.0),
        bad(0.0, 0.0, 1.0),
        bad(1.0, 0.0, 0.0),
        bad(1.0, 1.0, 0.0),
        bad(nan, 1.0, 1.0),
        bad(1.0, 1.0, nan),
        bad(f32::INFINITY, 1.0, 1.0),
        bad(1e30, 1.0, 1e30),
        Shape::Triangle(Triangle { a: Vector::Y, b: Vector::Y, c: Vector::Y }),
        Shape::Segment(Segment { a: Vector::X, b: Vector::X }),
        Shape::Cuboid(Cuboid { half: Vector::ZERO }),
        Shape::HalfSpace(HalfSpace { normal: Vector::Y }),
        Shape::Ball(Ball { radius: nan }),
    ];
    let positions = [Vector::ZERO, Vector::X, Vector::ONE * nan, Vector::ONE * FARTHEST, Vector::Y * 1e-30];
    for a in &shapes {
        for b in &shapes {
            for position in positions {
                for prediction in [0.0, 0.1, f32::MAX, f32::INFINITY, nan] {
                    let m = fresh(a, b, &Pose::new(position, Rot::IDENTITY), prediction);
                    for p in m.points() {
                        assert!(p.point.is_finite() && p.separation.is_finite());
                        assert!((m.normal.length() - 1.0).abs() < 1e-3);
                    }
                }
            }
        }
    }
}

/// Pairs for which an axis was taken that is only a local optimum.
#[test]
fn axes_are_the_best_of_all() -> Result<(), TestCaseError> {
    let capsule = |a, b, radius| Shape::Capsule(Capsule { a, b, radius });
    let rotation = |x, y, z, w| Rot { x, y, z, w }.normalized();
    // The rim of a cylinder is nearer to a segment deep in it than its side.
    let segment =
        Segment { a: v(0.07000804, -0.5067903, -0.046310727), b: v(-0.6157158, 0.29327282, -0.5137353) };
    let at = v(0.16254582, 0.43978733, -0.1787359);
    let turn = rotation(0.7315438, 0.08169755, -0.4675439, 0.48946095);
    check(&cylinder(0.34532756, 0.94567895), &Shape::Segment(segment), &Pose::new(at, turn))?;
    // The axes of both are nearly parallel, and the direction across both differs from the direction between
    // them.
    let long = capsule(v(-0.6836069, -0.95247144, 0.21732204), v(-0.2826874, 0.7144522, -0.4633216), 0.1);
    let turn = rotation(-0.17359795, -0.90071565, 0.12352323, -0.37857246);
    check(&cylinder(0.05, 0.05), &long, &Pose::new(Vector::ZERO, turn))?;
    // A point under the base of a cone is outside of its side.
    let cone = Shape::Curved(Curved::cone(0.8984116, 0.53445065).expect("good sizes"));
    let stub = capsule(v(-0.32375482, 0.08810592, 0.035762273), v(0.0, -0.2867679, 0.0), 0.44923484);
    let turn = rotation(-0.5352065, 0.120785296, 0.7028287, -0.4527658);
    check(&cone, &stub, &Pose::new(v(-0.25770807, -0.708012, -1.1463908), turn))
}

#[test]
fn issue_a_cylinder_on_a_long_rail_touched_in_one_point() {
    let pose = Pose::new(v(0.195, 3.0, 0.0), Rot::IDENTITY);
    let end = v(0.0, 50.0, 0.0);
    let rails = [cylinder(0.1, 50.0), Shape::Capsule(Capsule { a: -end, b: end, radius: 0.1 })];
    for rail in rails {
        assert_eq!(fresh(&rail, &cylinder(0.1, 0.25), &pose, 0.02).count, 2);
        assert_eq!(fresh(&cylinder(0.1, 0.25), &rail, &pose.inverse(), 0.02).count, 2);
    }
}
