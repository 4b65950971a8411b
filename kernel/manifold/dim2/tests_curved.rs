//! Ellipses against the best of many directions.

use super::super::{FeatureCache, LocalManifold};
use crate::manifold::collide;
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Ball, Capsule, Cuboid, Curved, HalfSpace, Hull, Segment, Shape, Triangle};
use proptest::prelude::*;
use std::sync::Arc;

fn vector(range: f32) -> impl Strategy<Value = Vector> {
    [-range..range, -range..range].prop_map(Vector::from_array)
}

fn pose(range: f32) -> impl Strategy<Value = Pose> {
    (vector(range), -3.2f32..3.2).prop_map(|(p, angle)| Pose::new(p, Rot::from_angle(angle)))
}

fn ellipse() -> impl Strategy<Value = Shape> {
    [0.2f32..1.0, 0.2..1.0].prop_map(|half| Shape::Curved(Curved { half: Vector::from_array(half) }))
}

fn bounded() -> impl Strategy<Value = Shape> {
    prop_oneof![
        (0.0f32..1.0).prop_map(|radius| Shape::Ball(Ball { radius })),
        (vector(1.0), vector(1.0), 0.0f32..0.5).prop_map(|(a, b, radius)| Shape::Capsule(Capsule {
            a,
            b,
            radius
        })),
        (vector(1.0), vector(1.0)).prop_map(|(a, b)| Shape::Segment(Segment { a, b })),
        [0.2f32..1.0, 0.2..1.0].prop_map(|half| Shape::Cuboid(Cuboid { half: Vector::from_array(half) })),
        (vector(1.0), vector(1.0), vector(1.0))
            .prop_filter("area", |(a, b, c)| (*b - *a).perp_dot(*c - *a).abs() > 0.2)
            .prop_map(|(a, b, c)| Shape::Triangle(Triangle { a, b, c })),
        (prop::collection::vec(vector(1.0), 5..12), 0.0f32..0.3).prop_filter_map(
            "flat",
            |(points, radius)| {
                Hull::convex_hull_of(&points, radius).ok().map(|hull| Shape::Hull(Arc::new(hull)))
            }
        ),
        ellipse(),
    ]
}

fn fresh(a: &Shape, b: &Shape, pose: &Pose, prediction: f32) -> LocalManifold {
    let mut out = LocalManifold::default();
    collide(a, b, pose, prediction, &mut FeatureCache::NONE.clone(), &mut out);
    out
}

fn along(a: &Shape, b: &Shape, pose: &Pose, n: Vector) -> f32 {
    let far_b = b.support(-pose.rotation.inverse_rotate(n)).expect("bounded");
    n.dot(pose.transform(far_b)) - n.dot(a.support(n).expect("bounded"))
}

fn best_along(a: &Shape, b: &Shape, pose: &Pose) -> f32 {
    let at = |angle: f32| along(a, b, pose, Vector { x: angle.cos(), y: angle.sin() });
    let step = core::f32::consts::TAU / 720.0;
    let start = (0..720).map(|i| i as f32 * step).max_by(|a, b| at(*a).total_cmp(&at(*b))).expect("some");
    (-100..=100).map(|i| at(start + i as f32 * 0.01 * step)).fold(f32::NEG_INFINITY, f32::max)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(20_000))]

    #[test]
    fn ellipses_agree_with_the_best_of_many_directions(a in ellipse(), b in bounded(), pose in pose(2.0)) {
        for (a, b, pose) in [(&a, &b, pose), (&b, &a, pose.inverse())] {
            let m = fresh(a, b, &pose, 100.0);
            prop_assert_eq!(m.count, 1);
            prop_assert!((m.normal.length() - 1.0).abs() < 1e-4);
            let (got, best) = (m.points[0].separation, best_along(a, b, &pose));
            let along = along(a, b, &pose, m.normal);
            prop_assert!((got - along).abs() < 1e-4, "{got}, along the normal {along}, best {best}");
            // For deep overlap a nearly best axis is good enough.
            let allowed = 2e-3 + 0.05 * (-0.1 - best).max(0.0);
            prop_assert!(along > best - allowed, "{along} of {best}");
            if got > -0.05 {
                // The point is midway, on the line between both surfaces.
                let on_a = m.points[0].point - m.normal * (0.5 * got);
                let on_b = pose.inverse_transform(m.points[0].point + m.normal * (0.5 * got));
                let ball = Shape::Ball(Ball { radius: 0.0 });
                for (shape, point) in [(a, on_a), (b, on_b)] {
                    let off = best_along(shape, &ball, &Pose::new(point, Rot::IDENTITY));
                    prop_assert!(off < 3e-3, "{off} outside: {m:?}");
                }
            }
        }
    }

    #[test]
    fn without_a_point_ellipses_are_no_nearer_than_is_said(a in ellipse(), b in bounded(), pose in pose(3.0)) {
        let m = fresh(&a, &b, &pose, 0.02);
        if m.count == 0 {
            prop_assert!(m.gap <= best_along(&a, &b, &pose) + 1e-3, "{}", m.gap);
        }
    }

    #[test]
    fn ellipses_lie_on_half_spaces(shape in ellipse(), pose in pose(1.0)) {
        let ground = Shape::HalfSpace(HalfSpace { normal: Vector::Y });
        let lowest = pose.transform(shape.support(pose.rotation.inverse_rotate(-Vector::Y)).expect("bounded"));
        for (m, swap) in [(fresh(&ground, &shape, &pose, 0.1), false), (fresh(&shape, &ground, &pose.inverse(), 0.1), true)] {
            let m = if swap && m.count > 0 { m.flipped(&pose.inverse()) } else { m };
            prop_assert_eq!(m.count > 0, lowest.y <= 0.1);
            if m.count > 0 {
                prop_assert!((m.points[0].separation - lowest.y).abs() < 1e-5);
                prop_assert!((m.points[0].point.x - lowest.x).abs() < 1e-5);
            } else {
                prop_assert!((m.gap - lowest.y).abs() < 1e-5);
            }
        }
    }

    #[test]
    fn ellipses_of_any_size_give_usable_numbers(
        b in bounded(), pose in pose(1.0), sizes in [-6i32..6, -6i32..6], flat in any::<bool>(), prediction in prop_oneof![Just(0.0f32), Just(0.05), Just(f32::MAX)],
    ) {
        let [x, y] = sizes.map(|log| 10.0f32.powi(log));
        let a = Shape::Curved(Curved { half: Vector { x, y: if flat { 0.0 } else { y } } });
        for m in [fresh(&a, &b, &pose, prediction), fresh(&b, &a, &pose, prediction), fresh(&a, &a, &pose, prediction)] {
            for p in m.points() {
                prop_assert!((m.normal.length() - 1.0).abs() < 1e-3 && p.point.is_finite() && p.separation <= prediction);
            }
            prop_assert!(m.radii.iter().all(|r| r.is_finite() && *r >= 0.0), "{:?}", m.radii);
        }
    }
}

#[test]
fn hostile_ellipses_give_no_contact() {
    let nan = f32::NAN;
    let shapes = [
        Shape::Curved(Curved { half: Vector::ZERO }),
        Shape::Curved(Curved { half: Vector { x: nan, y: 1.0 } }),
        Shape::Curved(Curved { half: Vector { x: f32::INFINITY, y: 1.0 } }),
        Shape::Cuboid(Cuboid { half: Vector::ONE }),
        Shape::HalfSpace(HalfSpace { normal: Vector::Y }),
        Shape::Ball(Ball { radius: nan }),
    ];
    for a in &shapes {
        for b in &shapes {
            for position in [Vector::ZERO, Vector::X, Vector::ONE * 1e30] {
                for p in fresh(a, b, &Pose::new(position, Rot::IDENTITY), 0.1).points() {
                    assert!(p.point.is_finite() && p.separation.is_finite(), "{a:?} {b:?}");
                }
            }
        }
    }
}

/// The best of sixteen directions was on the other side of a blade.
#[test]
fn issue_a_small_ball_was_pushed_through_a_flat_ellipse() {
    let ball = Shape::Ball(Ball { radius: 0.02 });
    for flat in [0.0, 0.001, 0.02] {
        let blade = Shape::Curved(Curved { half: Vector { x: 1.0, y: flat } });
        for i in 0..200 {
            let turn = Rot::from_angle(0.0317 * i as f32);
            let x = -0.9 + 0.009 * i as f32;
            let y = flat * (1.0 - x * x).sqrt();
            let normal = Vector { x: flat * x, y: (1.0 - x * x).sqrt() };
            let normal = normal * (1.0 / normal.length());
            // The ball overlaps the blade by 1 mm.
            let center = Vector { x, y } + normal * 0.019;
            let pose = Pose::new(turn.rotate(-center), turn);
            let m = fresh(&ball, &blade, &pose, 0.1);
            let off = (m.normal + turn.rotate(normal)).length();
            assert!(off < 0.02 && (m.points[0].separation + 0.001).abs() < 2e-4, "{flat} {x}: {m:?}");
        }
    }
}
