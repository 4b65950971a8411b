//! Manifolds against brute-force distances in `f64`, and the invariants of every pair.

use super::axis;
use super::clip::keep;
use super::oracle::Solid;
use super::view::{MatrixPose, View};
use crate::manifold::{FeatureCache, LocalManifold, LocalPoint, collide};
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Ball, Capsule, Cuboid, Curved, HalfSpace, Hull, Segment, Shape, Triangle};
use proptest::prelude::*;
use std::sync::Arc;

pub(super) fn v(x: f32, y: f32, z: f32) -> Vector {
    Vector { x, y, z }
}

pub(super) fn vector(range: f32) -> impl Strategy<Value = Vector> {
    [-range..range, -range..range, -range..range].prop_map(Vector::from_array)
}

pub(super) fn rotation() -> impl Strategy<Value = Rot> {
    [-1.0f32..1.0, -1.0..1.0, -1.0..1.0, -1.0..1.0]
        .prop_filter("not zero", |q| q.iter().map(|c| c * c).sum::<f32>() > 0.01)
        .prop_map(|[x, y, z, w]| Rot { x, y, z, w }.normalized())
}

pub(super) fn pose(range: f32) -> impl Strategy<Value = Pose> {
    (vector(range), rotation()).prop_map(|(p, r)| Pose::new(p, r))
}

fn hull() -> impl Strategy<Value = Shape> {
    prop::collection::vec(vector(1.0), 8..20)
        .prop_filter_map("no volume", |points| Hull::convex_hull_of(&points).ok())
        .prop_map(|h| Shape::Hull(Arc::new(h)))
}

fn rounded_hull() -> impl Strategy<Value = Shape> {
    (hull(), 0.05f32..0.5).prop_map(|(shape, radius)| {
        let Shape::Hull(hull) = shape else { unreachable!() };
        Shape::Hull(Arc::new(Hull::clone(&hull).rounded(radius).expect("a good radius")))
    })
}

fn cuboid() -> impl Strategy<Value = Shape> {
    [0.2f32..1.0, 0.2..1.0, 0.2..1.0].prop_map(|h| Shape::Cuboid(Cuboid { half: Vector::from_array(h) }))
}

fn triangle() -> impl Strategy<Value = Shape> {
    [vector(1.0), vector(1.0), vector(1.0)]
        .prop_filter("area", |[a, b, c]| (*b - *a).cross(*c - *a).length() > 0.2)
        .prop_map(|[a, b, c]| Shape::Triangle(Triangle { a, b, c }))
}

fn faceted() -> impl Strategy<Value = Shape> {
    prop_oneof![hull(), cuboid(), triangle(), rounded_hull()]
}

fn rounded() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (vector(1.0), vector(1.0), 0.1f32..0.5).prop_map(|(a, b, radius)| Shape::Capsule(Capsule {
            a,
            b,
            radius
        })),
        (vector(1.0), vector(1.0)).prop_map(|(a, b)| Shape::Segment(Segment { a, b })),
        (0.1f32..1.0).prop_map(|radius| Shape::Ball(Ball { radius })),
    ]
}

pub(super) fn bounded() -> impl Strategy<Value = Shape> {
    prop_oneof![faceted(), rounded()]
}

fn any_shape() -> impl Strategy<Value = Shape> {
    let half_space = vector(1.0)
        .prop_filter("direction", |n| n.length() > 0.1)
        .prop_map(|n| Shape::HalfSpace(HalfSpace { normal: n * (1.0 / n.length()) }));
    prop_oneof![4 => bounded(), 1 => half_space]
}

pub(super) fn fresh(a: &Shape, b: &Shape, pose: &Pose, prediction: f32) -> LocalManifold {
    let mut out = LocalManifold::default();
    collide(a, b, pose, prediction, &mut FeatureCache::NONE.clone(), &mut out);
    out
}

pub(super) fn deepest(m: &LocalManifold) -> f32 {
    m.points().iter().map(|p| p.separation).fold(f32::INFINITY, f32::min)
}

/// Tolerance of reported depths against the oracle: a face is preferred to an edge that is up to 0.2 % of the
/// extent better, and an axis counts as exact within 0.1 %.
const TOLERANCE: f64 = 0.006;

/// How much deeper shapes may overlap along a contact's normal than along the best normal. Capsules and
/// segments that touch along a line have the normal in the middle of the line, which is up to a tenth
/// (`CROSSED`) from the normal of their closest points.
fn slack(a: &Shape, b: &Shape, m: &LocalManifold) -> f64 {
    let length = |shape: &Shape| match shape {
        Shape::Capsule(s) => Some((s.b - s.a).length()),
        Shape::Segment(s) => Some((s.b - s.a).length()),
        _ => None,
    };
    match (length(a), length(b)) {
        (Some(a), Some(b)) if m.count == 2 => TOLERANCE + 0.1 * f64::from(a + b),
        _ => TOLERANCE,
    }
}

fn check_against_oracle(a: &Shape, b: &Shape, pose: &Pose) -> Result<(), TestCaseError> {
    let (of_a, of_b) = (Solid::new(a), Solid::new(b).at(pose));
    let m = fresh(a, b, pose, 100.0);
    prop_assert!(m.count > 0, "within the prediction distance");
    prop_assert!((m.normal.length() - 1.0).abs() < 1e-4);
    let along = of_a.separation_along(&of_b, m.normal);
    let got = f64::from(deepest(&m));
    let best = of_a.signed_distance(&of_b);
    prop_assert!(got <= best.max(along) + TOLERANCE, "reported {got}, true {best}, along the normal {along}");
    prop_assert!(got >= along - TOLERANCE, "reported {got}, along its normal only {along}");
    if best > 0.01 {
        prop_assert!((got - best).abs() < TOLERANCE, "apart by {best}, reported {got}");
    }
    prop_assert!(along > best - slack(a, b, &m), "the normal separates by {along}, the best axis by {best}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn polyhedra_agree_with_brute_force(a in faceted(), b in faceted(), pose in pose(2.0)) {
        check_against_oracle(&a, &b, &pose)?;
    }

    #[test]
    fn boxes_agree_with_brute_force(a in cuboid(), b in cuboid(), pose in pose(1.6)) {
        check_against_oracle(&a, &b, &pose)?;
    }

    #[test]
    fn round_shapes_agree_with_brute_force(a in rounded(), b in bounded(), pose in pose(2.0)) {
        check_against_oracle(&a, &b, &pose)?;
        check_against_oracle(&b, &a, &pose.inverse())?;
    }

    #[test]
    fn without_points_shapes_are_no_nearer_than_is_said(a in bounded(), b in bounded(), pose in pose(3.0)) {
        let m = fresh(&a, &b, &pose, 0.02);
        if m.count == 0 {
            let truth = Solid::new(&a).signed_distance(&Solid::new(&b).at(&pose));
            prop_assert!(f64::from(m.gap) < truth + 1e-4, "{} but {truth}", m.gap);
        }
    }

    #[test]
    fn half_spaces_say_how_far_shapes_are(b in bounded(), pose in pose(3.0)) {
        let m = fresh(&Shape::HalfSpace(HalfSpace { normal: Vector::Y }), &b, &pose, 0.02);
        let lowest = b.support(pose.rotation.inverse_rotate(-Vector::Y)).expect("it is bounded");
        let height = pose.transform(lowest).y;
        prop_assert!(m.count > 0 || (m.gap - height).abs() < 1e-5, "{} for {height}", m.gap);
    }

    #[test]
    fn swapping_gives_the_same_contact(a in any_shape(), b in any_shape(), pose in pose(1.5), prediction in 0.0f32..0.5) {
        let one = fresh(&a, &b, &pose, prediction);
        let two = fresh(&b, &a, &pose.inverse(), prediction).flipped(&pose.inverse());
        prop_assert_eq!(one.count > 0, two.count > 0);
        if one.count > 0 {
            prop_assert!((deepest(&one) - deepest(&two)).abs() < 0.006, "{} {}", deepest(&one), deepest(&two));
        }
    }

    #[test]
    fn turning_everything_turns_the_contact(
        points in prop::collection::vec(vector(1.0), 8..20), b in bounded(), pose in pose(1.5), turn in rotation(),
    ) {
        let turned: Vec<Vector> = points.iter().map(|p| turn.rotate(*p)).collect();
        if let (Ok(one), Ok(two)) = (Hull::convex_hull_of(&points), Hull::convex_hull_of(&turned)) {
            let (one, two) = (Shape::Hull(Arc::new(one)), Shape::Hull(Arc::new(two)));
            let pose_two = Pose::new(turn.rotate(pose.position), turn.mul(pose.rotation));
            let (m, n) = (fresh(&one, &b, &pose, 0.2), fresh(&two, &b, &pose_two, 0.2));
            if m.count > 0 && deepest(&m) < 0.19 {
                prop_assert!(n.count > 0);
                prop_assert!((deepest(&m) - deepest(&n)).abs() < 0.006);
            }
        }
    }

    #[test]
    fn every_pair_gives_usable_numbers(
        a in any_shape(), b in any_shape(), pose in pose(1.0), log_a in -5i32..5, log_b in -5i32..5,
        prediction in prop_oneof![Just(0.0f32), Just(0.05), Just(3.0), Just(f32::MAX)], centred in any::<bool>(),
    ) {
        let (ka, kb) = (10.0f32.powi(log_a), 10.0f32.powi(log_b));
        let (a, b) = (scaled(&a, ka), scaled(&b, kb));
        let position = if centred { Vector::ZERO } else { pose.position * (ka + kb) };
        let pose = Pose::new(position, if centred { Rot::IDENTITY } else { pose.rotation });
        let m = fresh(&a, &b, &pose, prediction);
        for p in m.points() {
            prop_assert!((m.normal.length() - 1.0).abs() < 1e-3);
            prop_assert!(p.point.is_finite() && p.separation <= prediction, "{:?}", p);
        }
        let overlap = !matches!((&a, &b), (Shape::HalfSpace(_), _) | (_, Shape::HalfSpace(_)))
            && Solid::new(&a).signed_distance(&Solid::new(&b).at(&pose)) < -1e-3 * f64::from(ka.min(kb)) - 1e-6 * f64::from(ka.max(kb));
        prop_assert!(!overlap || m.count > 0, "overlapping shapes have a contact");
    }

    #[test]
    fn a_kept_axis_gives_what_a_search_gives(
        a in bounded(), b in bounded(), pose in pose(1.4), shift in vector(0.002), spin in vector(0.002),
    ) {
        let (mut cache, mut out) = (FeatureCache::NONE, LocalManifold::default());
        collide(&a, &b, &pose, 0.1, &mut cache, &mut out);
        let moved = Pose::new(pose.position + shift, pose.rotation.integrated(spin));
        collide(&a, &b, &moved, 0.1, &mut cache, &mut out);
        let again = fresh(&a, &b, &moved, 0.1);
        if again.count > 0 && deepest(&again) < 0.09 {
            prop_assert!(out.count > 0);
            let (of_a, of_b) = (Solid::new(&a), Solid::new(&b).at(&moved));
            let along = of_a.separation_along(&of_b, out.normal);
            let best = of_a.signed_distance(&of_b);
            prop_assert!(along > best - TOLERANCE - slack(&a, &b, &out), "{along} of {best}");
        }
    }

    #[test]
    fn what_is_ruled_out_beforehand_would_not_have_been_found(a in hull(), b in hull(), pose in pose(1.5)) {
        let (Shape::Hull(a), Shape::Hull(b)) = (&a, &b) else { unreachable!() };
        let (a, b, frame) = (View::from(&**a), View::from(&**b), MatrixPose::new(&pose));
        let best = axis::best_face(&a, &b, &frame, f32::INFINITY);
        let all = (0..a.faces.len()).map(|i| axis::face_separation(&a, i, &b, &frame).separation);
        prop_assert!((best.separation - all.fold(f32::NEG_INFINITY, f32::max)).abs() < 1e-5);
        let inverse = frame.inverse();
        let of_b = axis::best_face(&b, &a, &inverse, f32::INFINITY);
        let known = |separation: f32| axis::Known {
            of_b_in_a: frame.point(b.vertices[best.lowest]),
            of_a_in_b: inverse.point(a.vertices[of_b.lowest]),
            separation,
        };
        let edges = |separation| axis::best_edges(&a, &b, &frame, &known(separation), f32::INFINITY);
        let bar = best.separation.max(of_b.separation) + 1e-4;
        // No separation is below minus infinity, so no pair is ruled out.
        match (edges(bar), edges(f32::NEG_INFINITY)) {
            (Some(found), Some(full)) => prop_assert!((found.separation - full.separation).abs() < 1e-5),
            (None, Some(full)) => prop_assert!(full.separation <= bar + 1e-5, "{} {bar}", full.separation),
            (found, None) => prop_assert!(found.is_none()),
        }
    }

    #[test]
    fn reduction_keeps_the_deepest(
        points in prop::collection::vec((-1.0f32..1.0, -1.0f32..1.0, -0.1f32..0.1), 5..40),
    ) {
        let list: Vec<LocalPoint> = points.iter().enumerate()
            .map(|(i, (x, z, s))| LocalPoint::new(v(*x, 0.0, *z), *s, i as u32)).collect();
        let mut out = LocalManifold { normal: Vector::Y, ..LocalManifold::default() };
        keep::<false>(&list, &mut out);
        let least = list.iter().map(|c| c.separation).fold(f32::INFINITY, f32::min);
        let size = list.iter().map(|c| (c.point - list[0].point).length()).fold(0.0, f32::max);
        prop_assert!(out.points[0].separation <= least + 1.01e-3 * size);
        let mut sorted: Vec<u32> = out.points().iter().map(|p| p.feature).collect();
        sorted.sort_unstable();
        sorted.dedup();
        prop_assert_eq!(sorted.len(), out.count, "no point twice");
    }

    #[test]
    fn features_last_while_a_box_rests(
        half in [0.3f32..1.0, 0.3..1.0, 0.3..1.0], x in -0.3f32..0.3, z in -0.3f32..0.3, angle in -3.0f32..3.0,
        shift in vector(0.001), as_hull in any::<bool>(),
    ) {
        let half = Vector::from_array(half);
        let small = if as_hull {
            Shape::Hull(Arc::new(Hull::cuboid(half).expect("positive")))
        } else {
            Shape::Cuboid(Cuboid { half })
        };
        let floor = Shape::Cuboid(Cuboid { half: v(5.0, 0.5, 5.0) });
        let pose = Pose::new(v(x, 0.5 + half.y - 0.002, z), Rot::from_axis_angle(Vector::Y, angle));
        let names = |m: &LocalManifold| {
            let mut f: Vec<u32> = m.points().iter().map(|p| p.feature).collect();
            f.sort_unstable();
            f
        };
        let (mut cache, mut first, mut second) = (FeatureCache::NONE, LocalManifold::default(), LocalManifold::default());
        collide(&floor, &small, &pose, 0.02, &mut cache, &mut first);
        let moved = Pose::new(pose.position + shift, pose.rotation.integrated(shift));
        collide(&floor, &small, &moved, 0.02, &mut cache, &mut second);
        prop_assert_eq!(first.count, 4);
        prop_assert_eq!(names(&first), names(&second));
        prop_assert_eq!(names(&second), names(&fresh(&floor, &small, &moved, 0.02)), "with and without cache");
    }
}

/// A shape `k` times as large.
pub(super) fn scaled(shape: &Shape, k: f32) -> Shape {
    match shape {
        Shape::Ball(s) => Shape::Ball(Ball { radius: s.radius * k }),
        Shape::Capsule(s) => Shape::Capsule(Capsule { a: s.a * k, b: s.b * k, radius: s.radius * k }),
        Shape::Segment(s) => Shape::Segment(Segment { a: s.a * k, b: s.b * k }),
        Shape::Cuboid(s) => Shape::Cuboid(Cuboid { half: s.half * k }),
        Shape::Curved(s) => {
            Shape::Curved(Curved { lower: s.lower * k, upper: s.upper * k, half_height: s.half_height * k })
        }
        Shape::Triangle(s) => Shape::Triangle(Triangle { a: s.a * k, b: s.b * k, c: s.c * k }),
        Shape::Hull(h) => {
            let points: Vec<Vector> = h.vertices().iter().map(|p| *p * k).collect();
            let faces = h.faces().iter().map(|f| h.outline(f).to_vec()).collect();
            let hull = Hull::from_mesh(points, faces).and_then(|scaled| scaled.rounded(h.radius() * k));
            Shape::Hull(Arc::new(hull.expect("scaling keeps a hull a hull")))
        }
        other => other.clone(),
    }
}

/// Whether a manifold has the expected points, in any order.
fn has_points(m: &LocalManifold, expected: &[Vector]) -> bool {
    m.count == expected.len()
        && expected.iter().all(|e| m.points().iter().any(|p| (p.point - *e).length() < 3e-3))
}

fn both_kinds_of_box(half: Vector) -> [Shape; 2] {
    [Shape::Cuboid(Cuboid { half }), Shape::Hull(Arc::new(Hull::cuboid(half).expect("positive")))]
}

#[test]
fn a_box_on_a_box_touches_in_four_points() {
    for a in both_kinds_of_box(v(0.5, 0.5, 0.5)) {
        for b in both_kinds_of_box(v(0.5, 0.5, 0.5)) {
            let m = fresh(&a, &b, &Pose::new(v(0.25, 0.99, 0.0), Rot::IDENTITY), 0.02);
            assert!((m.normal - Vector::Y).length() < 1e-6);
            let corners = [(-0.25, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.25, 0.5)].map(|(x, z)| v(x, 0.495, z));
            assert!(has_points(&m, &corners), "{m:?}");
            assert!(m.points().iter().all(|p| (p.separation + 0.01).abs() < 1e-6));
        }
    }
}

#[test]
fn crossed_boxes_touch_where_they_cross() {
    for a in both_kinds_of_box(v(2.0, 0.5, 0.5)) {
        for b in both_kinds_of_box(v(0.5, 0.5, 2.0)) {
            let m = fresh(&a, &b, &Pose::new(v(0.0, 1.0, 0.0), Rot::IDENTITY), 0.02);
            let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, z)| v(x, 0.5, z));
            assert!(has_points(&m, &corners), "{m:?}");
        }
    }
}

#[test]
fn a_tilted_box_touches_with_an_edge() {
    let eighth = Rot::from_axis_angle(Vector::Z, core::f32::consts::FRAC_PI_4);
    for b in both_kinds_of_box(v(0.5, 0.5, 0.5)) {
        let floor = Shape::Cuboid(Cuboid { half: v(5.0, 0.5, 5.0) });
        let m = fresh(&floor, &b, &Pose::new(v(0.0, 0.5 + 0.5f32.sqrt(), 0.0), eighth), 0.01);
        assert!(has_points(&m, &[v(0.0, 0.5, -0.5), v(0.0, 0.5, 0.5)]), "{m:?}");
    }
}

#[test]
fn edges_that_cross_touch_in_one_point() {
    // Two boxes that stand on an edge each, the edges at right angles.
    let eighth = core::f32::consts::FRAC_PI_4;
    let (about_x, about_z) =
        (Rot::from_axis_angle(Vector::X, eighth), Rot::from_axis_angle(Vector::Z, eighth));
    for a in both_kinds_of_box(v(0.5, 0.5, 0.5)) {
        for b in both_kinds_of_box(v(0.5, 0.5, 0.5)) {
            let height = 2.0 * 0.5f32.sqrt() - 0.01;
            let (lower, upper) = (Pose::new(Vector::ZERO, about_x), Pose::new(v(0.0, height, 0.0), about_z));
            let m = fresh(&a, &b, &lower.inverse().then(&upper), 0.02);
            assert_eq!(m.count, 1, "{m:?}");
            assert!((about_x.rotate(m.normal) - Vector::Y).length() < 1e-5);
            assert!((m.points[0].separation + 0.01).abs() < 1e-5);
            assert!((lower.transform(m.points[0].point) - v(0.0, height * 0.5, 0.0)).length() < 1e-5);
        }
    }
}

#[test]
fn a_lying_capsule_touches_in_two_points() {
    let capsule = Shape::Capsule(Capsule { a: v(-1.0, 0.0, 0.0), b: v(1.0, 0.0, 0.0), radius: 0.25 });
    let expected = |y: f32| [v(-1.0, y, 0.0), v(1.0, y, 0.0)];
    let pose = Pose::new(v(0.0, 0.745, 0.0), Rot::IDENTITY);
    for floor in both_kinds_of_box(v(5.0, 0.5, 5.0)) {
        assert!(has_points(&fresh(&floor, &capsule, &pose, 0.02), &expected(0.4975)));
    }
    let ground = Shape::HalfSpace(HalfSpace { normal: Vector::Y });
    let pose = Pose::new(v(0.0, 0.245, 0.0), Rot::IDENTITY);
    assert!(has_points(&fresh(&ground, &capsule, &pose, 0.02), &expected(-0.0025)));
    let triangle =
        Shape::Triangle(Triangle { a: v(-9.0, 0.0, 9.0), b: v(9.0, 0.0, 9.0), c: v(0.0, 0.0, -9.0) });
    for pose in [pose, Pose::new(v(0.0, -0.245, 0.0), Rot::IDENTITY)] {
        let m = fresh(&triangle, &capsule, &pose, 0.02);
        assert!(has_points(&m, &expected(-0.0025 * pose.position.y.signum())), "two-sided: {m:?}");
    }
    let above = Pose::new(v(0.5, 0.5, 0.0), Rot::IDENTITY);
    assert!(has_points(&fresh(&capsule, &capsule, &above, 0.02), &[v(-0.5, 0.25, 0.0), v(1.0, 0.25, 0.0)]));
    // Half of the box is over the rim: points are beyond the rim only.
    let shelf = Shape::Cuboid(Cuboid { half: v(1.0, 0.5, 1.0) });
    let m = fresh(&shelf, &capsule, &Pose::new(v(0.5, 0.75, 0.0), Rot::IDENTITY), 0.02);
    assert!(has_points(&m, &[v(-0.5, 0.5, 0.0), v(1.0, 0.5, 0.0)]), "{m:?}");
}

#[test]
fn a_distant_corner_is_approached_along_the_true_direction() {
    // Two unit boxes corner to corner along the diagonal: the separation along each axis is 1, the distance
    // is √3.
    for a in both_kinds_of_box(v(0.5, 0.5, 0.5)) {
        for b in both_kinds_of_box(v(0.5, 0.5, 0.5)) {
            let pose = Pose::new(v(2.0, 2.0, 2.0), Rot::IDENTITY);
            let m = fresh(&a, &b, &pose, 3.0);
            assert_eq!(m.count, 1);
            assert!((m.points[0].separation - 3.0f32.sqrt()).abs() < 1e-5);
            assert!((m.points[0].point - v(1.0, 1.0, 1.0)).length() < 1e-5);
            assert_eq!(fresh(&a, &b, &pose, 1.5).count, 0, "no ghost contact");
        }
    }
}

#[test]
fn many_sided_faces_are_handled() {
    // Two prisms with 100 sides on each other: four points far out, none deeper than the overlap.
    let ring = |y: f32| {
        (0..100).map(move |i| {
            let (s, c) = crate::math::sin_cos(f64::from(i) * core::f64::consts::TAU / 100.0);
            v(c as f32, y, s as f32)
        })
    };
    let points: Vec<Vector> = ring(-0.5).chain(ring(0.5)).collect();
    let prism = Shape::Hull(Arc::new(Hull::convex_hull_of(&points).expect("a prism")));
    let Shape::Hull(h) = &prism else { unreachable!() };
    assert_eq!((h.vertices().len(), h.faces().len(), h.edges().len()), (200, 102, 300));
    let turn = Rot::from_axis_angle(Vector::Y, 0.3);
    let m = fresh(&prism, &prism, &Pose::new(v(0.3, 0.99, 0.1), turn), 0.02);
    assert_eq!(m.count, 4);
    assert!((m.normal - Vector::Y).length() < 1e-4);
    assert!(m.points().iter().all(|p| (p.separation + 0.01).abs() < 1e-4));
    let spread = m.points().iter().map(|p| (p.point - m.points[0].point).length()).fold(0.0, f32::max);
    assert!(spread > 1.5, "{spread}");
}

#[test]
fn points_of_turned_prisms_lie_in_both() {
    // The maximum number of corners: the clipped face has the corners of both faces.
    let prism = |sides: u32, phase: f64| {
        let corner = |i: u32, y: f32| {
            let (s, c) =
                crate::math::sin_cos(phase + f64::from(i) * core::f64::consts::TAU / f64::from(sides));
            v(c as f32, y, s as f32)
        };
        let points: Vec<Vector> = (0..sides).flat_map(|i| [corner(i, -0.5), corner(i, 0.5)]).collect();
        Shape::Hull(Arc::new(Hull::convex_hull_of(&points).expect("a prism")))
    };
    for (sides_a, sides_b) in [(8, 8), (4, 12), (12, 4), (32, 32), (5, 7)] {
        let (a, b) = (prism(sides_a, 0.0), prism(sides_b, 0.0));
        for turn in [0.0, 0.1, 0.3, core::f32::consts::FRAC_PI_8, 1.0, 2.0] {
            let pose = Pose::new(v(0.0, 0.99, 0.0), Rot::from_axis_angle(Vector::Y, turn));
            let m = fresh(&a, &b, &pose, 0.02);
            assert_eq!(m.count, 4, "{sides_a} on {sides_b} turned by {turn}");
            for p in m.points() {
                let inside = |shape: &Shape, point: Vector| {
                    let Shape::Hull(hull) = shape else { unreachable!() };
                    hull.faces()
                        .iter()
                        .all(|f| f.normal.y.abs() > 0.5 || f.normal.dot(point) <= f.offset + 2e-3)
                };
                assert!(inside(&a, p.point), "{sides_a} on {sides_b} turned by {turn}: {p:?}");
                assert!(inside(&b, pose.inverse_transform(p.point)), "{sides_b} turned by {turn}: {p:?}");
            }
        }
    }
}

#[test]
fn hostile_input_gives_no_contact() {
    let shapes = [
        Shape::Ball(Ball { radius: 0.0 }),
        Shape::Ball(Ball { radius: f32::NAN }),
        Shape::Capsule(Capsule { a: Vector::ZERO, b: Vector::ZERO, radius: 0.5 }),
        Shape::Segment(Segment { a: Vector::X, b: Vector::X }),
        Shape::Triangle(Triangle { a: Vector::ZERO, b: Vector::X, c: Vector::X * 2.0 }),
        Shape::Triangle(Triangle { a: Vector::Y, b: Vector::Y, c: Vector::Y }),
        Shape::Cuboid(Cuboid { half: v(1.0, 0.0, 1.0) }),
        Shape::Cuboid(Cuboid { half: Vector::ZERO }),
        Shape::Cuboid(Cuboid { half: v(1.0, f32::NAN, 1.0) }),
        Shape::HalfSpace(HalfSpace { normal: Vector::Y }),
    ];
    let nan = Vector::ONE * f32::NAN;
    let positions =
        [Vector::ZERO, Vector::X, nan, Vector::ONE * f32::INFINITY, Vector::ONE * 1e30, Vector::Y * 1e-30];
    let rotations = [Rot::IDENTITY, Rot { x: f32::NAN, ..Rot::IDENTITY }, Rot { w: 0.0, ..Rot::IDENTITY }];
    for a in &shapes {
        for b in &shapes {
            for position in positions {
                for rotation in rotations {
                    for prediction in [0.0, 0.1, f32::MAX, f32::INFINITY, f32::NAN] {
                        let m = fresh(a, b, &Pose::new(position, rotation), prediction);
                        for p in m.points() {
                            assert!(p.point.is_finite() && p.separation.is_finite());
                            assert!((m.normal.length() - 1.0).abs() < 1e-3);
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn a_ball_beside_a_face_as_near_as_its_plane_is_not_missed() {
    // Beyond the edge of a sliver's face, so that clipping leaves no points, and within rounding of the
    // face's plane.
    let points = [
        v(0.0, 0.0, -0.21818882),
        v(0.0, 0.0, -0.5602403),
        v(0.032914832, -0.53013474, 0.8290511),
        v(-0.5548305, 0.51874983, -0.70095223),
        v(-0.3668308, 0.055974785, 0.00292276),
    ];
    let sliver = Shape::Hull(Arc::new(Hull::convex_hull_of(&points).expect("it has a volume")));
    let turn = Rot { x: -0.87632227, y: 0.29615477, z: -0.24989757, w: -0.2861866 };
    let pose = Pose::new(v(0.89893055, 1.1044351, -0.08116335), turn);
    let ball = Shape::Ball(Ball { radius: 0.1 });
    check_against_oracle(&ball, &sliver, &pose).expect("as brute force finds it");
    check_against_oracle(&sliver, &ball, &pose.inverse()).expect("as brute force finds it");
}

#[test]
fn a_box_past_the_edge_of_a_vast_one_touches_it_where_it_is() {
    let cuboid = |half| Shape::Cuboid(Cuboid { half });
    let (cube, floor) = (cuboid(Vector::ONE * 0.5), cuboid(v(1000.0, 1.0, 1000.0)));
    for beside in [0.0, 1.0e-3, 3.0e-3, 1.0e-2] {
        let pose = Pose::new(v(1000.5 + beside, 1.52, 0.0), Rot::IDENTITY);
        for (a, b, pose) in [(&floor, &cube, pose), (&cube, &floor, pose.inverse())] {
            let m = fresh(a, b, &pose, 0.05);
            assert!(m.count > 0, "{beside} beside the edge");
            for p in m.points() {
                let center = if core::ptr::eq(a, &floor) { pose.position } else { Vector::ZERO };
                assert!((p.point - center).length() < 1.0, "{beside}: {p:?}");
                let distance = (0.02f32 * 0.02 + beside * beside).sqrt();
                assert!((p.separation - distance).abs() < 1e-3, "{beside}: {p:?}");
            }
        }
    }
}

#[test]
fn a_small_box_beside_a_face_as_near_as_its_plane_is_not_missed() {
    let cuboid = |x, y, z| Shape::Cuboid(Cuboid { half: v(x, y, z) });
    let turn = Rot { x: 0.61542994, y: -0.50162625, z: 0.5816331, w: 0.17697482 };
    let pose = Pose::new(v(2.63221, 0.3689928, -2.5911958), turn);
    let (a, b) = (cuboid(0.02602681, 0.031777676, 0.022768507), cuboid(2.9284203, 3.1612728, 1.7466228));
    for (a, b, pose) in [(&a, &b, pose), (&b, &a, pose.inverse())] {
        let m = fresh(a, b, &pose, 0.02);
        assert!(m.count == 1 && (m.points()[0].separation - 0.005035617).abs() < 1e-4, "{m:?}");
    }
}

#[test]
fn issue_a_capsule_on_a_long_rail_touched_in_one_point() {
    let capsule = |half: f32| {
        let end = Vector { x: half, y: 0.0, z: 0.0 };
        Shape::Capsule(Capsule { a: -end, b: end, radius: 0.1 })
    };
    let (rail, short) = (capsule(50.0), capsule(0.25));
    let pose = Pose::new(Vector { x: 3.0, y: 0.195, z: 0.0 }, Rot::IDENTITY);
    assert_eq!(fresh(&rail, &short, &pose, 0.02).count, 2);
    assert_eq!(fresh(&short, &rail, &pose.inverse(), 0.02).count, 2);
}
