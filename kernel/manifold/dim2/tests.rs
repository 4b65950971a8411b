//! Contacts against brute force in `f64`, and invariances.

use super::super::{FeatureCache, LocalManifold, LocalPoint};
use crate::manifold::collide;
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Ball, Capsule, Cuboid, Curved, Foreign, HalfSpace, Hull, Segment, Shape, Triangle};
use proptest::prelude::*;
use std::sync::Arc;

type P = [f64; 2];

fn dot(a: P, b: P) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn sub(a: P, b: P) -> P {
    [a[0] - b[0], a[1] - b[1]]
}

fn wide(v: Vector) -> P {
    [f64::from(v.x), f64::from(v.y)]
}

/// The core of a shape in `f64` and A's frame.
struct Core {
    points: Vec<P>,
    radius: f64,
}

impl Core {
    fn new(shape: &Shape, pose: &Pose, shift: P) -> Option<Self> {
        let (vertices, radius) = match shape {
            Shape::Ball(s) => (vec![Vector::ZERO], s.radius),
            Shape::Capsule(s) => (vec![s.a, s.b], s.radius),
            Shape::Segment(s) => (vec![s.a, s.b], 0.0),
            Shape::Cuboid(s) => (super::polygonal::corners(s.half).to_vec(), 0.0),
            Shape::Triangle(s) if (s.b - s.a).perp_dot(s.c - s.a) < 0.0 => (vec![s.a, s.c, s.b], 0.0),
            Shape::Triangle(s) => (vec![s.a, s.b, s.c], 0.0),
            Shape::Hull(s) => (s.vertices().to_vec(), s.radius()),
            Shape::Composite(_) | Shape::Curved(_) | Shape::HalfSpace(_) | Shape::Foreign(_) => return None,
        };
        let (c, s) = (f64::from(pose.rotation.cos), f64::from(pose.rotation.sin));
        let at = wide(pose.position);
        let place = |v: Vector| {
            let [x, y] = wide(v);
            [c * x - s * y + at[0] + shift[0], s * x + c * y + at[1] + shift[1]]
        };
        Some(Self { points: vertices.into_iter().map(place).collect(), radius: f64::from(radius) })
    }

    fn edges(&self) -> Vec<(P, P)> {
        let n = self.points.len();
        (0..n).filter(|_| n > 1).map(|i| (self.points[i], self.points[(i + 1) % n])).collect()
    }

    /// The greatest separation along an edge normal of this core.
    fn separation_along_edges(&self, other: &Self) -> f64 {
        self.edges().into_iter().fold(f64::NEG_INFINITY, |best, (p, q)| {
            let e = sub(q, p);
            let length = dot(e, e).sqrt();
            let normal = [e[1] / length, -e[0] / length];
            best.max(other.points.iter().map(|v| dot(sub(*v, p), normal)).fold(f64::INFINITY, f64::min))
        })
    }

    /// The distance from a point to the nearest vertex or edge.
    fn boundary_distance(&self, p: P) -> f64 {
        let to_vertex = |v: &P| dot(sub(p, *v), sub(p, *v)).sqrt();
        let to_edge = |(a, b): (P, P)| {
            let (e, f) = (sub(b, a), sub(p, a));
            let t = (dot(f, e) / dot(e, e).max(1e-300)).clamp(0.0, 1.0);
            to_vertex(&[a[0] + t * e[0], a[1] + t * e[1]])
        };
        let vertices = self.points.iter().map(to_vertex).fold(f64::INFINITY, f64::min);
        self.edges().into_iter().map(to_edge).fold(vertices, f64::min)
    }

    /// The signed distance of a point from the surface.
    fn distance(&self, p: P) -> f64 {
        let point = Self { points: vec![p], radius: 0.0 };
        let inside = self.points.len() > 2 && self.separation_along_edges(&point) < 0.0;
        self.boundary_distance(p) * if inside { -1.0 } else { 1.0 } - self.radius
    }

    fn crosses(&self, other: &Self) -> bool {
        let side = |(p, q): (P, P), v: P| {
            let (e, f) = (sub(q, p), sub(v, p));
            e[0] * f[1] - e[1] * f[0]
        };
        let parts = |s: &Self, o: &Self| {
            let edge = (s.points[0], s.points[1]);
            side(edge, o.points[0]) * side(edge, o.points[1]) < 0.0
        };
        self.points.len() == 2 && other.points.len() == 2 && parts(self, other) && parts(other, self)
    }
}

/// The signed distance of two shapes' surfaces by brute force: to the nearest vertex or edge of disjoint
/// cores, minus the least penetration along an edge normal of overlapping cores.
pub(super) fn oracle(a: &Shape, b: &Shape, pose: &Pose, shift: P) -> f64 {
    let (core_a, core_b) = (Core::new(a, &Pose::IDENTITY, [0.0; 2]), Core::new(b, pose, shift));
    match (core_a, core_b, a, b) {
        (Some(a), Some(b), ..) => {
            let along = a.separation_along_edges(&b).max(b.separation_along_edges(&a));
            let solid = a.points.len() > 2 || b.points.len() > 2;
            let cores = if (solid && along <= 0.0) || a.crosses(&b) {
                along
            } else {
                let first = b.points.iter().map(|p| a.boundary_distance(*p)).fold(f64::INFINITY, f64::min);
                a.points.iter().map(|p| b.boundary_distance(*p)).fold(first, f64::min)
            };
            cores - a.radius - b.radius
        }
        (None, Some(core), Shape::HalfSpace(plane), _) => {
            let n = wide(plane.normal);
            core.points.iter().map(|v| dot(*v, n)).fold(f64::INFINITY, f64::min) - core.radius
        }
        (Some(core), None, _, Shape::HalfSpace(plane)) => {
            let n = wide(pose.rotation.rotate(plane.normal));
            let at = wide(pose.position);
            let low = |v: &P| dot(sub(sub(*v, at), shift), n);
            core.points.iter().map(low).fold(f64::INFINITY, f64::min) - core.radius
        }
        _ => f64::INFINITY,
    }
}

fn vector(range: f32) -> impl Strategy<Value = Vector> {
    [-range..range, -range..range].prop_map(Vector::from_array)
}

fn rotation() -> impl Strategy<Value = Rot> {
    prop_oneof![
        3 => (-4.0f32..4.0).prop_map(Rot::from_angle),
        1 => (0..4).prop_map(|k| Rot::from_angle(std::f32::consts::FRAC_PI_2 * k as f32)),
    ]
}

/// A polygon of up to `count` corners, sometimes rounded; sometimes with parallel edges.
fn hull(scale: f32, count: usize) -> impl Strategy<Value = Shape> {
    let points = prop::collection::vec(vector(scale), 3..count);
    let radius = prop_oneof![Just(0.0), 0.0..0.5 * scale];
    (points, radius)
        .prop_filter_map("no area", |(p, r)| Hull::convex_hull_of(&p, r).ok())
        .prop_filter("a sliver", move |h| h.unit_mass().mass > 0.05 * scale * scale)
        .prop_map(|h| Shape::Hull(Arc::new(h)))
}

fn regular(count: usize, scale: f32) -> Shape {
    let corner = |i: usize| {
        let r = Rot::from_angle(std::f32::consts::TAU * i as f32 / count as f32);
        Vector { x: r.cos, y: r.sin } * scale
    };
    let corners: Vec<Vector> = (0..count).map(corner).collect();
    Shape::Hull(Arc::new(Hull::from_convex(&corners, 0.0).unwrap()))
}

/// Any bounded shape of about the given size.
fn bounded(scale: f32) -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.05f32..1.0).prop_map(move |r| Shape::Ball(Ball::new(scale * r).unwrap())),
        (vector(scale), vector(scale), 0.0f32..0.5)
            .prop_filter("short", move |(a, b, _)| (*a - *b).length() > 0.1 * scale)
            .prop_map(move |(a, b, r)| Shape::Capsule(Capsule::new(a, b, scale * r).unwrap())),
        (0.05f32..1.0, 0.05f32..1.0)
            .prop_map(move |(x, y)| Shape::Cuboid(Cuboid::new(Vector { x, y } * scale).unwrap())),
        hull(scale, 9),
        (3usize..40).prop_map(move |n| regular(n, scale)),
        (vector(scale), vector(scale), vector(scale))
            .prop_filter("thin", move |(a, b, c)| (*b - *a).perp_dot(*c - *a).abs() > 0.1 * scale * scale)
            .prop_map(|(a, b, c)| Shape::Triangle(Triangle::new(a, b, c).unwrap())),
        (vector(scale), vector(scale))
            .prop_filter("short", move |(a, b)| (*a - *b).length() > 0.1 * scale)
            .prop_map(|(a, b)| Shape::Segment(Segment::new(a, b).unwrap())),
    ]
}

fn any_shape(scale: f32) -> impl Strategy<Value = Shape> {
    prop_oneof![
        8 => bounded(scale),
        1 => (-4.0f32..4.0).prop_map(|angle| {
            Shape::HalfSpace(HalfSpace::new(Rot::from_angle(angle).rotate(Vector::X)).unwrap())
        }),
    ]
}

/// Two shapes and a pose at which their signed distance is about a given distance, if such a pose exists.
fn near_pair() -> impl Strategy<Value = (Shape, Shape, Pose)> {
    let distance = prop_oneof![-0.6f32..0.04, -0.02f32..0.04];
    (any_shape(1.0), any_shape(1.0), rotation(), -4.0f32..4.0, distance).prop_map(|(a, b, turn, angle, d)| {
        let away = Rot::from_angle(angle).rotate(Vector::X);
        let (mut low, mut high) = (0.0f32, 8.0f32);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            if oracle(&a, &b, &Pose::new(away * middle, turn), [0.0; 2]) < f64::from(d) {
                low = middle;
            } else {
                high = middle;
            }
        }
        (a, b, Pose::new(away * high, turn))
    })
}

const PREDICTION: f32 = 0.02;
const TOLERANCE: f64 = 5.0e-5;

fn contact(a: &Shape, b: &Shape, pose: &Pose) -> LocalManifold {
    let mut out = LocalManifold::default();
    collide(a, b, pose, PREDICTION, &mut FeatureCache::default(), &mut out);
    out
}

fn least(m: &LocalManifold) -> f64 {
    m.points().iter().map(|p| f64::from(p.separation)).fold(f64::INFINITY, f64::min)
}

fn bounded_by_planes(a: &Shape, b: &Shape) -> bool {
    !matches!((a, b), (Shape::HalfSpace(_), Shape::HalfSpace(_)))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(8000))]

    #[test]
    fn separation_and_normal_are_those_of_brute_force((a, b, pose) in near_pair()) {
        let truth = oracle(&a, &b, &pose, [0.0; 2]);
        let m = contact(&a, &b, &pose);
        if truth > f64::from(PREDICTION) + TOLERANCE || !bounded_by_planes(&a, &b) {
            prop_assert_eq!(m.count, 0);
            return Ok(());
        }
        prop_assume!(truth < f64::from(PREDICTION) - TOLERANCE);
        prop_assert!(m.count > 0, "missed a contact of separation {truth}");
        prop_assert!((least(&m) - truth).abs() < TOLERANCE, "{} is not {truth}: {m:?}", least(&m));
        prop_assert!((m.normal.length() - 1.0).abs() < 1e-5);
        // Moved back by the separation along the normal, the shapes just touch.
        let n = wide(m.normal);
        let moved = oracle(&a, &b, &pose, [-truth * n[0], -truth * n[1]]);
        prop_assert!(moved.abs() < 2.0 * TOLERANCE, "{moved} apart after moving by {truth}: {m:?}");
    }

    #[test]
    fn without_points_shapes_are_no_nearer_than_is_said((a, b, pose) in near_pair(), farther in 1.0f32..2.0) {
        let pose = Pose::new(pose.position * farther, pose.rotation);
        let m = contact(&a, &b, &pose);
        if m.count == 0 && bounded_by_planes(&a, &b) {
            let truth = oracle(&a, &b, &pose, [0.0; 2]);
            prop_assert!(f64::from(m.gap) < truth + TOLERANCE, "{} but {truth}", m.gap);
            prop_assert!(m.gap > 0.0, "no bound for {truth}");
        }
    }

    #[test]
    fn points_lie_midway((a, b, pose) in near_pair()) {
        let m = contact(&a, &b, &pose);
        for p in m.points() {
            prop_assert!(p.separation <= PREDICTION);
            let reach = 0.5 * f64::from(p.separation.abs()) + TOLERANCE;
            for core in [Core::new(&a, &Pose::IDENTITY, [0.0; 2]), Core::new(&b, &pose, [0.0; 2])] {
                let Some(core) = core else { continue };
                let d = core.distance(wide(p.point));
                prop_assert!(d <= reach, "{d} off a surface, {m:?}");
            }
        }
        // The deepest point is half of the separation off both surfaces.
        let Some(p) = m.points().iter().min_by(|p, q| p.separation.total_cmp(&q.separation)) else { return Ok(()) };
        let half = wide(m.normal * (0.5 * p.separation));
        let at = wide(p.point);
        for (core, sign) in [(Core::new(&a, &Pose::IDENTITY, [0.0; 2]), -1.0), (Core::new(&b, &pose, [0.0; 2]), 1.0)] {
            let Some(core) = core else { continue };
            let d = core.distance([at[0] + sign * half[0], at[1] + sign * half[1]]);
            prop_assert!(d.abs() < 2.0 * TOLERANCE, "{d} off the surface, {m:?}");
        }
    }

    #[test]
    fn the_swapped_pair_gives_the_flipped_contact((a, b, pose) in near_pair()) {
        let m = contact(&a, &b, &pose);
        let inverse = pose.inverse();
        let swapped = contact(&b, &a, &inverse).flipped(&inverse);
        prop_assert!(m.count == 0 || swapped.count == 0 || (least(&m) - least(&swapped)).abs() < TOLERANCE);
        // Of two equally good normals, either may be chosen.
        if m.count == 0 || m.normal.dot(swapped.normal) < 0.999_999_9 {
            return Ok(());
        }
        let turn = |f: u32| f.rotate_left(16);
        for p in m.points().iter().filter(|p| p.separation < PREDICTION - 1e-4) {
            let off = |q: &LocalPoint| (q.point - p.point).length() + (q.separation - p.separation).abs();
            let twin = swapped.points().iter().min_by(|q, r| off(q).total_cmp(&off(r)));
            prop_assert!(twin.is_some_and(|q| (q.point - p.point).length() < 2e-3), "{m:?} and {swapped:?}");
            let twin = twin.expect("just seen");
            prop_assert!((twin.separation - p.separation).abs() < 2e-3);
            let distinct = m.count == 1 || (m.points[0].point - m.points[1].point).length() > 5e-3;
            if distinct && swapped.count == m.count {
                prop_assert_eq!(turn(twin.feature), p.feature, "{:?} and {:?}", m, swapped);
            }
        }
    }

    #[test]
    fn the_frame_of_a_shape_does_not_matter((a, b, pose) in near_pair(), at in vector(2.0), turn in rotation()) {
        let frame = Pose::new(at, turn);
        let go = |v: Vector| frame.transform(v);
        let moved = match &b {
            Shape::Capsule(s) => Shape::Capsule(Capsule { a: go(s.a), b: go(s.b), radius: s.radius }),
            Shape::Segment(s) => Shape::Segment(Segment { a: go(s.a), b: go(s.b) }),
            Shape::Triangle(s) => Shape::Triangle(Triangle { a: go(s.a), b: go(s.b), c: go(s.c) }),
            Shape::Hull(s) => {
                let vertices: Vec<Vector> = s.vertices().iter().map(|v| go(*v)).collect();
                Shape::Hull(Arc::new(Hull::from_convex(&vertices, s.radius()).unwrap()))
            }
            _ => return Ok(()),
        };
        let (m, other) = (contact(&a, &b, &pose), contact(&a, &moved, &pose.then(&frame.inverse())));
        if m.count > 0 && other.count > 0 {
            prop_assert!((least(&m) - least(&other)).abs() < TOLERANCE);
        } else {
            prop_assert!(least(&m).min(least(&other)) > f64::from(PREDICTION) - TOLERANCE || m.count == other.count);
        }
    }

    #[test]
    fn cuboids_agree_with_the_same_polygons(
        ha in [0.05f32..1.0, 0.05f32..1.0], hb in [0.05f32..1.0, 0.05f32..1.0],
        turn in rotation(), at in vector(1.6),
    ) {
        let polygon = |h: [f32; 2]| {
            let corners = super::polygonal::corners(Vector::from_array(h));
            Shape::Hull(Arc::new(Hull::from_convex(&corners, 0.0).unwrap()))
        };
        let cuboid = |h| Shape::Cuboid(Cuboid::new(Vector::from_array(h)).unwrap());
        let pose = Pose::new(at, turn);
        let fast = contact(&cuboid(ha), &cuboid(hb), &pose);
        let slow = contact(&polygon(ha), &polygon(hb), &pose);
        prop_assert!(fast.count == 0 || slow.count == 0 || (least(&fast) - least(&slow)).abs() < 1e-5);
        if fast.count > 0 && fast.normal.dot(slow.normal) > 0.999_999_9 {
            for (p, q) in fast.points().iter().zip(slow.points()) {
                if fast.count == slow.count {
                    prop_assert_eq!(p.feature, q.feature);
                    prop_assert!((p.point - q.point).length() < 1e-3);
                }
            }
        }
    }

    #[test]
    fn hostile_sizes_and_places_give_finite_contacts(
        sizes in [-6.0f64..4.0, -6.0f64..4.0, -8.0f64..4.0], coincident in any::<bool>(),
        (a, b) in (any_shape(1.0), any_shape(1.0)), turn in rotation(), at in vector(1.0), flat in 0..4,
        cache in (0u8..5, any::<u8>(), any::<u8>()),
    ) {
        let [sa, sb, sp] = sizes.map(|e| 10f64.powf(e) as f32);
        let (a, b) = (scaled(&a, sa, flat & 1 == 1), scaled(&b, sb, flat & 2 == 2));
        let at = if coincident { Vector::ZERO } else { at * sp };
        let pose = Pose::new(at, turn);
        let mut cache = FeatureCache { kind: cache.0, a: cache.1, b: cache.2, separation: 0.0 };
        for _ in 0..2 {
            let mut m = LocalManifold::default();
            collide(&a, &b, &pose, PREDICTION, &mut cache, &mut m);
            prop_assert!(m.count == 0 || (m.normal.length() - 1.0).abs() < 1e-4, "{m:?}");
            for p in m.points() {
                prop_assert!(p.point.is_finite() && p.separation.is_finite() && p.separation <= PREDICTION);
            }
            let truth = oracle(&a, &b, &pose, [0.0; 2]);
            let rounding = 1e-5 * f64::from(sa.max(sb).max(sp)) + TOLERANCE;
            if flat == 0 && bounded_by_planes(&a, &b) {
                prop_assert!(m.count > 0 || truth > f64::from(PREDICTION) - rounding, "missed {truth}");
                prop_assert!(m.count == 0 || (least(&m) - truth).abs() < rounding, "{} is not {truth}: {m:?}", least(&m));
            }
        }
    }
}

/// A shape scaled about its origin and, if `flat`, without height or (balls, capsules) without size.
fn scaled(shape: &Shape, factor: f32, flat: bool) -> Shape {
    let go = |v: Vector| if flat { Vector { x: v.x * factor, y: 0.0 } } else { v * factor };
    let size = if flat { 0.0 } else { factor };
    match shape {
        Shape::Ball(s) => Shape::Ball(Ball { radius: s.radius * size }),
        Shape::Capsule(s) => {
            let b = if flat { s.a } else { s.b };
            Shape::Capsule(Capsule { a: s.a * factor, b: b * factor, radius: s.radius * factor })
        }
        Shape::Segment(s) => Shape::Segment(Segment { a: go(s.a), b: go(s.b) }),
        Shape::Triangle(s) => Shape::Triangle(Triangle { a: go(s.a), b: go(s.b), c: go(s.c) }),
        Shape::Cuboid(s) => Shape::Cuboid(Cuboid { half: go(s.half) }),
        Shape::Hull(s) => {
            let vertices: Vec<Vector> = s.vertices().iter().map(|v| *v * factor).collect();
            Shape::Hull(Arc::new(Hull::from_convex(&vertices, s.radius() * factor).unwrap()))
        }
        other => other.clone(),
    }
}

fn cuboid(x: f32, y: f32) -> Shape {
    Shape::Cuboid(Cuboid::new(Vector { x, y }).unwrap())
}

#[test]
fn a_box_on_a_box_touches_at_two_points() {
    let (ground, top) = (cuboid(2.0, 0.5), cuboid(0.5, 0.5));
    for separation in [-0.01, 0.0, 0.01] {
        let m = contact(&ground, &top, &Pose::new(Vector { x: 1.8, y: 1.0 + separation }, Rot::IDENTITY));
        assert_eq!((m.count, m.normal), (2, Vector::Y));
        let mut points = m.points;
        points.sort_by(|p, q| p.point.x.total_cmp(&q.point.x));
        for (p, x) in points.iter().zip([1.3, 2.0]) {
            assert!((p.separation - separation).abs() < 1e-6);
            assert!((p.point - Vector { x, y: 0.5 + 0.5 * separation }).length() < 1e-6, "{p:?}");
        }
        assert_ne!(points[0].feature, points[1].feature);
    }
    assert_eq!(contact(&ground, &top, &Pose::new(Vector { x: 0.0, y: 1.021 }, Rot::IDENTITY)).count, 0);
}

#[test]
fn equal_boxes_stacked_exactly_touch_at_two_points() {
    let b = cuboid(0.5, 0.5);
    for separation in [-0.005f32, -1e-7, 0.0, 1e-7, 1e-4, 0.015] {
        for shift in [0.0, 1e-7, -1e-7, 1e-5, -1e-5] {
            let m = contact(&b, &b, &Pose::new(Vector { x: shift, y: 1.0 + separation }, Rot::IDENTITY));
            assert_eq!((m.count, m.normal), (2, Vector::Y), "{separation} {shift}");
        }
    }
}

#[test]
fn lying_capsules_touch_at_two_points() {
    let capsule = Shape::Capsule(Capsule::new(Vector::X * -0.5, Vector::X * 0.5, 0.25).unwrap());
    let pose = Pose::new(Vector { x: 0.2, y: 0.5 }, Rot::IDENTITY);
    for other in [capsule.clone(), cuboid(1.0, 0.25)] {
        for m in [
            contact(&other, &capsule, &pose),
            contact(&other, &capsule, &Pose::new(pose.position, Rot::from_angle(core::f32::consts::PI))),
        ] {
            assert_eq!(m.count, 2, "{m:?}");
            assert!((m.normal - Vector::Y).length() < 1e-6);
            assert!(m.points().iter().all(|p| (p.point.y - 0.25).abs() < 1e-6 && p.separation.abs() < 1e-6));
            // From −0.3 to the end of the other capsule's flat side.
            let end = if matches!(other, Shape::Capsule(_)) { 0.5 } else { 0.7 };
            let mut x = m.points.map(|p| p.point.x);
            x.sort_by(f32::total_cmp);
            assert!((x[0] + 0.3).abs() < 1e-6 && (x[1] - end).abs() < 1e-6, "{x:?}");
        }
    }
    let plane = Shape::HalfSpace(HalfSpace::new(Vector::Y).unwrap());
    let m = contact(&plane, &capsule, &Pose::new(Vector::Y * 0.24, Rot::IDENTITY));
    assert_eq!((m.count, m.normal), (2, Vector::Y));
    assert!(
        m.points().iter().all(|p| (p.separation + 0.01).abs() < 1e-6 && (p.point.y + 0.005).abs() < 1e-6)
    );
}

#[test]
fn segments_are_two_sided_and_meet_end_to_end() {
    let s = Shape::Segment(Segment::new(Vector::ZERO, Vector::X).unwrap());
    let ball = Shape::Ball(Ball::new(0.5).unwrap());
    for y in [0.5, -0.5] {
        let m = contact(&s, &ball, &Pose::new(Vector { x: 0.5, y }, Rot::IDENTITY));
        assert_eq!((m.count, m.normal), (1, Vector::Y * y.signum()));
    }
    // On one line: 1 m apart, 1 cm apart, overlapping.
    let meet = |x: f32| contact(&s, &s, &Pose::new(Vector::X * x, Rot::IDENTITY));
    assert_eq!(meet(2.0).count, 0);
    assert_eq!((meet(1.01).count, meet(1.01).normal), (1, Vector::X));
    assert!((meet(1.01).points[0].separation - 0.01).abs() < 1e-6);
    let over = meet(0.5);
    assert_eq!((over.count, over.normal.x), (2, 0.0));
    assert!(over.points().iter().all(|p| p.separation == 0.0));
    // An end that touches the inside: the normal points to where the rest of the segment is.
    for up in [1.0, -1.0] {
        let t = contact(&s, &s, &Pose::new(Vector::X * 0.5, Rot { cos: 0.0, sin: up }));
        assert_eq!((t.count, t.normal), (1, Vector::Y * up));
    }
}

#[test]
fn concentric_shapes_get_a_fixed_normal() {
    let ball = Shape::Ball(Ball::new(1.0).unwrap());
    let m = contact(&ball, &ball, &Pose::IDENTITY);
    assert_eq!((m.count, m.normal, m.points[0].separation), (1, Vector::Y, -2.0));
    let m = contact(&cuboid(1.0, 1.0), &cuboid(1.0, 1.0), &Pose::IDENTITY);
    assert_eq!((m.count, least(&m)), (2, -2.0));
}

#[test]
fn foreign_shapes_half_spaces_and_nan_give_nothing() {
    let plane = Shape::HalfSpace(HalfSpace::new(Vector::Y).unwrap());
    let foreign = Shape::Foreign(Foreign { aabb: crate::shape::Aabb::EVERYTHING });
    let b = cuboid(1.0, 1.0);
    for (a, b) in [(&plane, &plane), (&foreign, &b), (&b, &foreign), (&plane, &foreign), (&foreign, &plane)] {
        assert_eq!(contact(a, b, &Pose::IDENTITY).count, 0);
    }
    for shape in [&b, &plane, &Shape::Ball(Ball { radius: 1.0 }), &regular(5, 1.0)] {
        for bad in [f32::NAN, f32::INFINITY] {
            let pose = Pose::new(Vector { x: bad, y: 0.0 }, Rot::IDENTITY);
            assert_eq!(contact(&b, shape, &pose).count, 0);
            assert_eq!(contact(shape, &b, &Pose::new(Vector::ZERO, Rot { cos: bad, sin: 0.0 })).count, 0);
        }
    }
}

/// Squares of sizes overflowed, and the contact had a NaN normal.
#[test]
fn issue_sizes_that_overflow_gave_contacts_that_were_no_numbers() {
    let around = |size: f32| {
        let v = |x: f32, y: f32| Vector { x, y } * size;
        [
            Shape::Ball(Ball { radius: size }),
            Shape::Capsule(Capsule { a: v(-0.5, 0.0), b: v(0.5, 0.1), radius: 0.5 * size }),
            Shape::Segment(Segment { a: v(-0.5, -0.2), b: v(0.5, 0.1) }),
            Shape::Cuboid(Cuboid { half: v(0.7, 0.4) }),
            Shape::Triangle(Triangle { a: v(-0.5, -0.5), b: v(0.5, -0.5), c: v(0.0, 0.5) }),
            Shape::Curved(Curved { half: v(0.7, 0.4) }),
            Shape::HalfSpace(HalfSpace { normal: Vector::Y }),
        ]
    };
    let sizes = [1.0e-38, 1.0, 1.0e12, 1.0e19, 1.0e30, 1.0e38, f32::MAX];
    for (a, b) in sizes.into_iter().flat_map(|a| sizes.map(|b| (around(a), around(b)))) {
        for (a, b) in a.iter().flat_map(|a| b.iter().map(move |b| (a, b))) {
            for (x, angle) in [(0.0, 0.0), (0.3, 0.7), (1.0e14, 2.0), (1.0e19, 1.0), (f32::MAX, 3.0)] {
                let m = contact(a, b, &Pose::new(Vector { x, y: -0.2 * x }, Rot::from_angle(angle)));
                assert!(m.count == 0 || (m.normal.length() - 1.0).abs() < 1e-3, "{a:?} {b:?} {m:?}");
                assert!(m.points().iter().all(|p| p.point.is_finite() && p.separation.is_finite()), "{m:?}");
            }
        }
    }
}

#[test]
fn polygons_beyond_the_cache_collide() {
    let big = regular(400, 1.0);
    let mut cache = FeatureCache::default();
    for k in 0..40 {
        let away = Rot::from_angle(0.37 * k as f32).rotate(Vector::X);
        let pose = Pose::new(away * 1.99, Rot::from_angle(0.2 * k as f32));
        let mut m = LocalManifold::default();
        collide(&big, &big, &pose, PREDICTION, &mut cache, &mut m);
        assert!((least(&m) - oracle(&big, &big, &pose, [0.0; 2])).abs() < TOLERANCE);
        assert!(m.normal.dot(away) > 0.99);
    }
}

#[test]
fn resting_contacts_keep_their_features_and_reference() {
    for shapes in [
        [cuboid(1.0, 0.5), cuboid(0.4, 0.5)],
        [regular(6, 0.5), regular(6, 0.5)],
        [cuboid(1.0, 0.433), regular(6, 0.5)],
    ] {
        let [a, b] = shapes;
        let height = |s: &Shape| if let Shape::Cuboid(c) = s { c.half.y } else { 0.433_012_7 };
        let rest = height(&a) + height(&b) - 0.004;
        let mut cache = FeatureCache::default();
        let mut features = None;
        let mut kept = None;
        for k in 0..200 {
            // The box slides by 1 mm a step and rocks by the noise of a solver.
            let rock = 4.0e-5 * ((k * 7 % 5) as f32 - 2.0);
            let pose =
                Pose::new(Vector { x: -0.1 + 0.001 * k as f32, y: rest + 0.1 * rock }, Rot::from_angle(rock));
            let mut m = LocalManifold::default();
            collide(&a, &b, &pose, PREDICTION, &mut cache, &mut m);
            assert_eq!(m.count, 2);
            let now = (m.points[0].feature, m.points[1].feature);
            assert_eq!(*features.get_or_insert(now), now, "at step {k}");
            let reference = (cache.kind, cache.a, cache.b);
            assert_eq!(*kept.get_or_insert(reference), reference, "at step {k}");
        }
    }
}

#[test]
fn a_cached_edge_that_still_separates_ends_the_search() {
    let (a, b) = (regular(7, 1.0), regular(9, 1.0));
    let mut cache = FeatureCache::default();
    let mut m = LocalManifold::default();
    let mut step = |x: f32, cache: &mut FeatureCache| {
        collide(&a, &b, &Pose::new(Vector::X * x, Rot::IDENTITY), PREDICTION, cache, &mut m);
        m.count
    };
    assert_eq!(step(2.5, &mut cache), 0);
    let edge = (cache.kind, cache.a, cache.b);
    assert!(cache.kind != 0 && cache.separation > PREDICTION);
    let before = cache.separation;
    assert_eq!(step(2.4, &mut cache), 0);
    assert_eq!((cache.kind, cache.a, cache.b), edge);
    assert!(cache.separation < before);
    assert!(step(1.8, &mut cache) > 0);
}
