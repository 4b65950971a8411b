//! Closed forms of 2D shapes, primitives, and contacts of shapes that only parry has.

use super::super::tests::{assert_native, assert_usable, close, collide, half_size};
use super::super::*;
use crate::math::{PI, Scalar};
use crate::physics_transform::Rotation;
use bevy_heavy::ComputeMassProperties2d;
use bevy_math::primitives::*;
use bevy_math::{Dir2, Vec2};
use kernel::math::{Pose, Rot};

/// Area, moment of inertia per mass, and half size of the box.
#[track_caller]
fn assert_form(collider: &Collider, area: Scalar, inertia: Scalar, half: [Scalar; 2]) {
    let p = collider.mass_properties(2.0);
    assert!(close(p.mass, 2.0 * area as f32), "mass {} of {collider:?}, not {}", p.mass, 2.0 * area);
    assert!(close(p.unit_angular_inertia(), inertia as f32), "{} not {inertia}", p.unit_angular_inertia());
    assert!(close(collider.mass(2.0), p.mass) && close(collider.unit_angular_inertia(), inertia as f32));
    assert!((half_size(collider) - Vector::from_array(half)).length() < 1.0e-4, "{:?}", half_size(collider));
}

#[test]
fn constructors_have_the_closed_forms() {
    assert_form(&Collider::circle(2.0), 4.0 * PI, 2.0, [2.0, 2.0]);
    assert_form(&Collider::ellipse(2.0, 1.0), 2.0 * PI, 1.25, [2.0, 1.0]);
    assert_form(&Collider::rectangle(2.0, 4.0), 8.0, 20.0 / 12.0, [1.0, 2.0]);
    assert_form(
        &Collider::triangle(Vector::ZERO, Vector::X * 3.0, Vector::Y * 6.0),
        9.0,
        45.0 / 18.0,
        [1.5, 3.0],
    );
    assert_form(
        &Collider::triangle(Vector::ZERO, Vector::Y * 6.0, Vector::X * 3.0),
        9.0,
        45.0 / 18.0,
        [1.5, 3.0],
    );
    assert_form(&Collider::regular_polygon(2.0, 4), 8.0, 4.0 / 3.0, [2.0, 2.0]);
    // A rectangle of 2 r by h and two half discs, each with its centre 4 r / 3π from its side.
    let (r, h) = (0.5, 2.0);
    let (body, caps) = (2.0 * r * h, PI * r * r);
    let inertia =
        body * (h * h + 4.0 * r * r) / 12.0 + caps * (r * r / 2.0 + h * h / 4.0 + 4.0 * h * r / (3.0 * PI));
    assert_form(&Collider::capsule(r, h), body + caps, inertia / (body + caps), [0.5, 1.5]);
    let square = vec![Vector::ZERO, Vector::X * 2.0, Vector::ONE * 2.0, Vector::Y * 2.0];
    assert_form(&Collider::convex_hull(square.clone()).expect("a hull"), 4.0, 2.0 / 3.0, [1.0, 1.0]);
    assert_form(&Collider::convex_polyline(square).expect("convex"), 4.0, 2.0 / 3.0, [1.0, 1.0]);
    let round = Collider::round_rectangle(2.0, 4.0, 0.5);
    assert!(close(round.mass(1.0), (8.0 + 12.0 * 0.5 + PI * 0.25) as f32), "{}", round.mass(1.0));
    assert!((half_size(&round) - Vector::new(1.5, 2.5)).length() < 1.0e-5);
    let field = Collider::heightfield(vec![0.0, 1.0, -1.0], Vector::new(10.0, 2.0));
    assert!((half_size(&field) - Vector::new(5.0, 2.0)).length() < 1.0e-5);
    let voxels = Collider::voxels(Vector::new(1.0, 2.0), &[[0, 0].into(), [1, 0].into()]);
    assert!(close(voxels.mass(1.0), 4.0), "{}", voxels.mass(1.0));
    assert!(voxels.contains_point(Vector::ZERO, Rotation::default(), Vector::splat(1.9)));
    assert!(!voxels.contains_point(Vector::ZERO, Rotation::default(), Vector::splat(2.1)));
}

#[test]
fn every_primitive_converts() {
    let area = |c: Collider, area: f32, x: f32, y: f32| {
        assert!(close(c.mass(1.0), area), "{c:?} has {} not {area}", c.mass(1.0));
        let half = half_size(&c);
        assert!(close(half.x as f32, x) && close(half.y as f32, y), "{c:?} {half}");
    };
    let pi = core::f32::consts::PI;
    area(Circle::new(0.5).into(), pi / 4.0, 0.5, 0.5);
    area(Ellipse::new(3.0, 1.0).into(), 3.0 * pi, 3.0, 1.0);
    area(Segment2d::new(Vec2::ZERO, Vec2::new(2.0, 4.0)).into(), 0.0, 1.0, 2.0);
    area(Line2d { direction: Dir2::X }.into(), 0.0, 10_000.0, 0.0);
    area(Polyline2d::new([Vec2::ZERO, Vec2::X, Vec2::ONE]).into(), 0.0, 0.5, 0.5);
    area(Triangle2d::new(Vec2::ZERO, Vec2::Y, Vec2::X).into(), 0.5, 0.5, 0.5);
    area(Rectangle::new(2.0, 6.0).into(), 12.0, 1.0, 3.0);
    area(Rhombus::new(2.0, 6.0).into(), 6.0, 1.0, 3.0);
    area(RegularPolygon::new(1.0, 4).into(), 2.0, 1.0, 1.0);
    area(Capsule2d::new(1.0, 2.0).into(), 4.0 + pi, 1.0, 2.0);
    let square = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y];
    area(ConvexPolygon::new(square).expect("convex").into(), 1.0, 0.5, 0.5);
    // An L, in both orientations.
    let l = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)].map(Vec2::from);
    area(Polygon::new(l).into(), 3.0, 1.0, 1.0);
    area(Polygon::new(l.into_iter().rev()).into(), 3.0, 1.0, 1.0);
    let plane = Collider::from(Plane2d::new(Vec2::X));
    assert!(plane.contains_point(Vector::ZERO, Rotation::default(), Vector::NEG_X * 7.0));
    assert!(!plane.contains_point(Vector::ZERO, Rotation::default(), Vector::X * 0.1));
}

#[test]
fn hostile_input_gives_usable_shapes() {
    for bad in [0.0, -1.0, Scalar::NAN, Scalar::INFINITY, Scalar::MAX] {
        let point = Vector::splat(bad);
        assert_usable(&Collider::circle(bad));
        assert_usable(&Collider::ellipse(bad, 1.0));
        assert_usable(&Collider::rectangle(1.0, bad));
        assert_usable(&Collider::round_rectangle(bad, bad, bad));
        assert_usable(&Collider::triangle(point, point, point));
        assert_usable(&Collider::triangle(point, Vector::ZERO, Vector::X));
        assert_usable(&Collider::triangle_unchecked(point, Vector::X, Vector::Y));
        assert_usable(&Collider::regular_polygon(bad as f32, 5));
        assert_usable(&Collider::heightfield(vec![bad, 1.0], point));
        assert_usable(&Collider::heightfield(vec![bad], Vector::ONE));
        assert_usable(&Collider::convex_decomposition(
            vec![point, Vector::X, Vector::Y],
            vec![[0, 1], [1, 2], [2, 0]],
        ));
        assert_usable(&Collider::voxelized_polyline(
            &[point, Vector::X],
            &[[0, 1]],
            0.5,
            FillMode::SurfaceOnly,
        ));
        assert_usable(&Polygon::new([Vec2::splat(bad as f32), Vec2::X, Vec2::Y]).into());
    }
    for sides in [0, 1, 2, 3, u32::MAX] {
        assert_usable(&Collider::regular_polygon(1.0, sides));
    }
    assert_usable(&Collider::convex_decomposition(vec![], vec![[0, 1]]));
    assert_usable(&Polygon::new(Vec::<Vec2>::new()).into());
    let bow_tie = [(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)].map(Vec2::from);
    assert_usable(&Polygon::new(bow_tie).into());
}

#[test]
fn only_convex_outlines_are_convex() {
    let v = |points: &[(f32, f32)]| points.iter().map(|p| Vec2::from(*p).adjust()).collect::<Vec<_>>();
    assert!(Collider::convex_polyline(v(&[(0.0, 0.0), (2.0, 0.0), (1.0, 0.5), (0.0, 2.0)])).is_none());
    assert!(Collider::convex_polyline(v(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)])).is_none());
    assert!(Collider::convex_polyline(vec![]).is_none());
    let star = (0..5).map(|i| Vector::from_angle(i as Scalar * 0.8 * PI)).collect();
    assert!(Collider::convex_polyline(star).is_none(), "a star turns left all the way, twice round");
    assert!(Collider::convex_polyline(v(&[(0.0, 0.0), (0.0, 2.0), (2.0, 0.0)])).is_some(), "clockwise");
}

/// A shorthand for the tests.
trait Adjust {
    fn adjust(&self) -> Vector;
}

impl Adjust for Vec2 {
    fn adjust(&self) -> Vector {
        crate::math::AdjustPrecision::adjust_precision(self)
    }
}

#[test]
fn native_shapes_of_the_plane() {
    assert_native(&Collider::rectangle(1.0, 3.0));
    assert_native(&Collider::triangle(Vector::ZERO, Vector::X, Vector::Y));
    assert_native(&Collider::regular_polygon(1.5, 5));
    assert_native(&Collider::round_rectangle(1.0, 3.0, 0.25));
    assert_native(&Collider::heightfield(vec![0.0, 1.0], Vector::ONE));
    assert_native(&Collider::ellipse(2.0, 1.0));
}

#[test]
fn decompositions_cover_the_shape() {
    let l = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]
        .map(|p| Vec2::from(p).adjust());
    let indices = (0..6).map(|i| [i, (i + 1) % 6]).collect();
    let parts = Collider::convex_decomposition(l.to_vec(), indices);
    assert!((parts.mass(1.0) - 3.0).abs() < 0.15, "{}", parts.mass(1.0));
    assert!((half_size(&parts) - 1.0).length() < 0.05);
}

#[test]
fn an_ellipse_lies_on_a_rectangle() {
    let (ground, ellipse) = (Collider::rectangle(10.0, 2.0), Collider::ellipse(2.0, 1.0));
    for (gap, touches) in [(0.05f32, true), (-0.1, true), (0.3, false)] {
        let above = Pose::new(kernel::math::Vector { x: 0.5, y: 2.0 + gap }, Rot::IDENTITY);
        let mut out = vec![];
        collide(&ground, &ellipse, &above, 0.1, &mut out);
        assert_eq!(out.len(), usize::from(touches), "at {gap}");
        for manifold in &out {
            assert!((manifold.normal - kernel::math::Vector::Y).length() < 1.0e-3, "{manifold:?}");
            for p in manifold.points() {
                assert!((p.separation - gap).abs() < 2.0e-3, "{p:?}");
                assert!(
                    (p.point.x - 0.5).abs() < 0.05 && (p.point.y - 1.0 - gap / 2.0).abs() < 2.0e-3,
                    "{p:?}"
                );
            }
        }
    }
}

#[test]
fn ellipses_touch_ellipses_and_half_spaces() {
    let ellipse = Collider::ellipse(2.0, 1.0);
    let at = |x: f32, y: f32| Pose::new(kernel::math::Vector { x, y }, Rot::IDENTITY);
    let mut out = vec![];
    collide(&ellipse, &ellipse, &at(3.9, 0.0), 0.1, &mut out);
    assert!(!out.is_empty() && (out[0].points()[0].separation + 0.1).abs() < 1.0e-2, "{out:?}");
    out.clear();
    collide(&Collider::half_space(Vector::Y), &ellipse, &at(7.0, 0.95), 0.1, &mut out);
    assert!(!out.is_empty() && (out[0].points()[0].separation + 0.05).abs() < 1.0e-3, "{out:?}");
}

#[test]
fn a_box_on_a_polyline_has_a_manifold_per_segment() {
    let line = Collider::polyline(vec![Vector::X * -5.0, Vector::ZERO, Vector::X * 5.0], None);
    let square = Collider::rectangle(2.0, 2.0);
    let mut out = vec![];
    let pose = Pose::new(kernel::math::Vector { x: 0.3, y: 0.99 }, Rot::IDENTITY);
    collide(&line, &square, &pose, 0.02, &mut out);
    assert_eq!(out.len(), 2, "{out:?}");
    let features: Vec<_> = out.iter().flat_map(|m| m.points()).map(|p| p.feature).collect();
    for (i, f) in features.iter().enumerate() {
        assert!(!features[..i].contains(f), "features tell the points apart: {out:?}");
    }
    for manifold in &out {
        assert!((manifold.normal - kernel::math::Vector::Y).length() < 1.0e-3, "{manifold:?}");
        assert!(manifold.points().iter().all(|p| (p.separation + 0.01).abs() < 1.0e-3), "{manifold:?}");
    }
    let mut flipped = vec![];
    collide(&square, &line, &pose.inverse(), 0.02, &mut flipped);
    assert_eq!(flipped.len(), 2);
    assert!(flipped.iter().all(|m| (m.normal + kernel::math::Vector::Y).length() < 1.0e-3));
    let mut none = vec![];
    let nan = Pose::new(kernel::math::Vector { x: f32::NAN, y: 0.0 }, Rot::IDENTITY);
    collide(&line, &square, &nan, 0.02, &mut none);
    assert!(none.is_empty());
}

#[test]
fn constructors_of_the_plane_return_errors() {
    use super::super::tests_strict::{BAD, fails};
    use ColliderError as Error;
    let outline = [Vector::ZERO, Vector::X, Vector::ONE];
    let (sides, mode) = ([[0, 1], [1, 2], [2, 0]], FillMode::SurfaceOnly);
    for bad in BAD {
        fails(Collider::try_circle(bad), Error::InvalidSize);
        fails(Collider::try_ellipse(1.0, bad), Error::InvalidSize);
        fails(Collider::try_rectangle(bad, 1.0), Error::InvalidSize);
        fails(Collider::try_round_rectangle(1.0, bad, 0.1), Error::InvalidSize);
        fails(Collider::try_regular_polygon(bad as f32, 5), Error::InvalidSize);
        fails(Collider::try_voxelized_polyline(&outline, &sides, bad, mode), Error::InvalidSize);
        fails(Collider::try_heightfield(vec![0.0; 3], Vector::new(bad, 1.0)), Error::InvalidSize);
        if !(0.0..1.0).contains(&bad) {
            fails(Collider::try_round_rectangle(1.0, 1.0, bad), Error::NegativeSize);
        }
    }
    for sides in [0, 2, u32::MAX] {
        fails(Collider::try_regular_polygon(1.0, sides), Error::InvalidSides);
    }
    let star = vec![Vector::ZERO, Vector::ONE, Vector::X, Vector::Y];
    fails(Collider::try_convex_polyline(star), Error::NotConvex);
    fails(Collider::try_convex_polyline(vec![Vector::splat(Scalar::NAN); 3]), Error::InvalidPoint);
    fails(Collider::try_voxelized_polyline(&outline, &sides, 2.0e-5, mode), Error::TooManyVoxels);
    fails(Collider::try_voxelized_polyline(&outline, &[[0, 3]], 0.1, mode), Error::InvalidElement(0));
    fails(Collider::try_heightfield(vec![0.0], Vector::ONE), Error::TooFewHeights);
    fails(Collider::try_heightfield(vec![0.0, Scalar::NAN], Vector::ONE), Error::InvalidPoint);
    assert!(Collider::try_heightfield(vec![0.0, -1.0], Vector::ONE).is_ok());
    assert!(Collider::try_voxelized_polyline(&outline, &sides, 0.1, mode).is_ok());
}
