//! Polygons against brute force in `f64`: outlines, supports, areas and rays.

use super::outline::edges;
use super::wide::{Point, cross, dot, length, sub, wide};
use super::*;
use crate::math::{Pose, Rot, WorldPose};
use crate::shape::{Ball, Cuboid, Segment, Shape, Triangle};
use proptest::prelude::*;
use std::sync::Arc;

fn vector(range: f32) -> impl Strategy<Value = Vector> {
    [-range..range, -range..range].prop_map(Vector::from_array)
}

fn polygon() -> impl Strategy<Value = Hull> {
    let radius = prop_oneof![Just(0.0), 0.0f32..1.0];
    (prop::collection::vec(vector(2.0), 3..12), radius)
        .prop_filter_map("no area", |(p, r)| Hull::convex_hull_of(&p, r).ok())
        .prop_filter("a sliver", |h| h.unit_mass().mass > 0.1)
}

fn circle(count: usize, radius: f32) -> Vec<Vector> {
    let at = |i| Rot::from_angle(std::f32::consts::TAU * i as f32 / count as f32);
    (0..count).map(|i| Vector { x: at(i).cos, y: at(i).sin } * radius).collect()
}

/// The signed distance of a point from a counter-clockwise polygon's core.
fn distance(vertices: &[Vector], p: Point) -> f64 {
    let mut inside = f64::NEG_INFINITY;
    let mut nearest = f64::INFINITY;
    for (a, b) in edges(vertices) {
        let (e, f) = (sub(wide(b), wide(a)), sub(p, wide(a)));
        let t = (dot(f, e) / dot(e, e)).clamp(0.0, 1.0);
        nearest = nearest.min(length(sub(f, [e[0] * t, e[1] * t])));
        inside = inside.max(cross(f, e) / length(e));
    }
    if inside < 0.0 { -nearest } else { nearest }
}

/// Area, centroid and moment of inertia about it by Green's theorem over a closed outline.
fn green(outline: &[Point]) -> (f64, Point, f64) {
    let (mut area, mut first, mut xx, mut yy) = (0.0, [0.0; 2], 0.0, 0.0);
    for (i, p) in outline.iter().enumerate() {
        let q = outline[(i + 1) % outline.len()];
        let c = cross(*p, q);
        area += c / 2.0;
        first = [first[0] + (p[0] + q[0]) * c / 6.0, first[1] + (p[1] + q[1]) * c / 6.0];
        xx += (p[0] * p[0] + p[0] * q[0] + q[0] * q[0]) * c / 12.0;
        yy += (p[1] * p[1] + p[1] * q[1] + q[1] * q[1]) * c / 12.0;
    }
    let center = first.map(|v| v / area);
    (area, center, xx + yy - area * dot(center, center))
}

/// The outline of a core grown by `radius`, with `steps` chords for every corner's arc.
fn grown(core: &[Point], radius: f64, steps: usize) -> Vec<Point> {
    let n = core.len();
    let angle = |i: usize| {
        let e = sub(core[(i + 1) % n], core[i % n]);
        (-e[0]).atan2(e[1])
    };
    let mut outline = Vec::new();
    for (i, corner) in core.iter().enumerate() {
        let (from, to) = (angle(i + n - 1), angle(i));
        let turn = (to - from).rem_euclid(std::f64::consts::TAU);
        for k in 0..=steps {
            let at = from + turn * k as f64 / steps as f64;
            outline.push([corner[0] + radius * at.cos(), corner[1] + radius * at.sin()]);
        }
    }
    outline
}

fn assert_mass(shape: &Shape, core: &[Vector], radius: f32) -> Result<(), TestCaseError> {
    let mass = shape.mass_properties(2.0);
    let core: Vec<Point> = core.iter().copied().map(wide).collect();
    let (area, center, inertia) =
        green(&grown(&core, f64::from(radius), if radius > 0.0 { 1000 } else { 1 }));
    prop_assert!((f64::from(mass.mass) / (2.0 * area) - 1.0).abs() < 1e-5, "{mass:?} is not {area}");
    prop_assert!((f64::from(mass.inertia) / (2.0 * inertia) - 1.0).abs() < 2e-5, "{mass:?} is not {inertia}");
    prop_assert!(length(sub(wide(mass.center), center)) < 1e-5, "{mass:?} is not {center:?}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn hulls_are_convex_contain_their_points_and_have_no_others(
        points in prop::collection::vec(vector(2.0), 3..60), grid in any::<bool>(),
    ) {
        // A coarse grid gives many duplicates and points on lines.
        let points: Vec<Vector> = points
            .into_iter()
            .map(|p| if grid { Vector { x: p.x.round(), y: p.y.round() } } else { p })
            .collect();
        let Ok(hull) = Hull::convex_hull_of(&points, 0.0) else {
            let flat = |p: Vector, q: Vector| points.iter().all(|r| (q - p).perp_dot(*r - p).abs() < 1e-4);
            let all = points.iter().flat_map(|p| points.iter().map(move |q| (*p, *q)));
            let (p, q) = all.max_by(|s, t| (s.1 - s.0).length().total_cmp(&(t.1 - t.0).length())).unwrap();
            prop_assert!(flat(p, q), "refused points with an area");
            return Ok(());
        };
        let v = hull.vertices();
        prop_assert!(v.iter().all(|v| points.contains(v)));
        prop_assert!(points.iter().all(|p| distance(v, wide(*p)) < 2e-5));
        for i in 0..v.len() {
            let (p, q, r) = (v[i], v[(i + 1) % v.len()], v[(i + 2) % v.len()]);
            prop_assert!(cross(sub(wide(q), wide(p)), sub(wide(r), wide(q))) > 0.0);
            let n = hull.normals()[i];
            prop_assert!((n.length() - 1.0).abs() < 1e-6 && n.dot(q - p).abs() < 1e-5 && n.perp().dot(q - p) > 0.0);
        }
        // The hull's own outline, in either orientation and from any start, gives the same polygon.
        let mut outline = v.to_vec();
        outline.rotate_left(v.len() / 2);
        outline.reverse();
        let again = Hull::from_convex(&outline, 0.0).unwrap();
        let start = again.vertices().iter().position(|p| *p == v[0]).expect("the same corners");
        prop_assert!((0..v.len()).all(|i| again.vertices()[(start + i) % v.len()] == v[i]));
    }

    #[test]
    fn supports_and_boxes_are_those_of_all_vertices(
        hull in polygon(), d in vector(3.0), angle in -4.0f32..4.0,
    ) {
        prop_assume!(d.length() > 1e-3);
        let best = hull.vertices().iter().map(|v| dot(wide(*v), wide(d))).fold(f64::NEG_INFINITY, f64::max);
        let support = hull.support(d);
        let expected = best + f64::from(hull.radius()) * length(wide(d));
        prop_assert!((dot(wide(support), wide(d)) - expected).abs() < 1e-5);
        prop_assert!((distance(hull.vertices(), wide(support)) - f64::from(hull.radius())).abs() < 1e-5);
        let shape = Shape::Hull(Arc::new(hull));
        let rotation = Rot::from_angle(angle);
        let aabb = shape.aabb(&WorldPose { rotation, ..WorldPose::IDENTITY });
        for (axis, low, high) in [(Vector::X, aabb.min.x, aabb.max.x), (Vector::Y, aabb.min.y, aabb.max.y)] {
            let local = rotation.inverse_rotate(axis);
            prop_assert!((shape.support(local).unwrap().dot(local) - high).abs() < 1e-5);
            prop_assert!((shape.support(-local).unwrap().dot(local) - low).abs() < 1e-5);
        }
    }

    #[test]
    fn masses_are_those_of_the_outline(
        hull in polygon(), a in vector(2.0), b in vector(2.0), c in vector(2.0), r in 0.01f32..2.0,
    ) {
        assert_mass(&Shape::Hull(Arc::new(hull.clone())), hull.vertices(), hull.radius())?;
        assert_mass(&Shape::Ball(Ball::new(r).unwrap()), &[Vector::ZERO, Vector::X * 1e-9], r)?;
        if (b - a).length() > 0.01 {
            assert_mass(&Shape::Capsule(Capsule::new(a, b, r).unwrap()), &[a, b], r)?;
        }
        let half = a.abs() + Vector::ONE * 0.01;
        let cuboid = Cuboid::new(half).unwrap();
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        assert_mass(&Shape::Cuboid(cuboid), &corners.map(|s| Vector::from_array(s).scale(half)), 0.0)?;
        let area = (b - a).perp_dot(c - a);
        if area.abs() > 0.1 {
            let ordered = if area > 0.0 { [a, b, c] } else { [a, c, b] };
            assert_mass(&Shape::Triangle(Triangle::new(a, b, c).unwrap()), &ordered, 0.0)?;
        }
    }

    #[test]
    fn rays_hit_the_first_boundary(
        hull in polygon(), as_triangle in any::<bool>(), origin in vector(4.0), target in vector(1.0),
        solid in any::<bool>(),
    ) {
        let d = direction_or(target - origin, Vector::X);
        let (shape, core, radius) = if as_triangle {
            let v = [hull.vertices()[0], hull.vertices()[1], hull.vertices()[2]];
            prop_assume!((v[1] - v[0]).perp_dot(v[2] - v[0]) > 0.05);
            (Shape::Triangle(Triangle::new(v[1], v[0], v[2]).unwrap()), v.to_vec(), 0.0)
        } else {
            (Shape::Hull(Arc::new(hull.clone())), hull.vertices().to_vec(), f64::from(hull.radius()))
        };
        let at = |t: f64| {
            let (o, d) = (wide(origin), wide(d));
            distance(&core, [o[0] + d[0] * t, o[1] + d[1] * t]) - radius
        };
        let hit = shape.cast_ray(origin, d, 12.0, solid);
        let start = at(0.0);
        prop_assume!(start.abs() > 1e-4);
        if start < 0.0 && solid {
            prop_assert_eq!(hit, Some(RayHit { distance: 0.0, normal: Vector::ZERO }));
            return Ok(());
        }
        let end = hit.map_or(12.0, |h| f64::from(h.distance));
        for k in 0..200 {
            prop_assert!(at(end * f64::from(k) / 200.0) * start.signum() > -1e-4, "crossed a boundary before {end}");
        }
        if let Some(hit) = hit {
            prop_assert!(at(end).abs() < 1e-4);
            prop_assert!((hit.normal.length() - 1.0).abs() < 1e-5);
            prop_assert!(hit.normal.dot(d) * start.signum() as f32 <= 1e-2);
            let p = origin + d * hit.distance + hit.normal * 0.01;
            prop_assert!((distance(&core, wide(p)) - radius - 0.01).abs() < 2e-4, "not the surface's normal");
        }
    }

    #[test]
    fn rays_cross_segments_from_both_sides(a in vector(2.0), b in vector(2.0), t in 0.02f32..0.98, from in vector(4.0)) {
        let target = a + (b - a) * t;
        let (d, distance) = (direction_or(target - from, Vector::X), (target - from).length());
        let across = (b - a).perp_dot(d).abs();
        prop_assume!(across > 0.05 && distance > 0.05);
        let segment = Shape::Segment(Segment::new(a, b).unwrap());
        let hit = segment.cast_ray(from, d, 12.0, true).expect("aimed at it");
        prop_assert!((hit.distance - distance).abs() < 1e-4 / across);
        prop_assert!(hit.normal.dot(d) < 0.0 && hit.normal.dot(b - a).abs() < 1e-5);
        prop_assert_eq!(segment.cast_ray(from, d, distance * 0.99 - 2e-3 / across, true), None);
        prop_assert_eq!(segment.cast_ray(from, -d, 12.0, true), None);
        let beside = direction_or(b + (b - a) * 0.05 - from, Vector::X);
        prop_assert_eq!(segment.cast_ray(from, beside, 12.0, true), None);
    }
}

#[test]
fn outlines_are_cleaned_and_refused() {
    let square = circle(4, 1.0);
    let mut full = Vec::new();
    for (p, q) in edges(&square) {
        full.extend([p, p, (p + q) * 0.5]);
    }
    assert_eq!(Hull::from_convex(&full, 0.25).unwrap().vertices().len(), 4);
    let error = |points: &[Vector]| Hull::from_convex(points, 0.0).unwrap_err();
    assert_eq!(error(&[]), ShapeError::Degenerate);
    assert_eq!(error(&[Vector::X]), ShapeError::Degenerate);
    assert_eq!(error(&[Vector::X, Vector::Y, Vector::X]), ShapeError::Degenerate);
    assert_eq!(error(&[Vector::ZERO, Vector::X, Vector::X * 2.0, Vector::X * 3.0]), ShapeError::Degenerate);
    let dart = [Vector::ZERO, Vector::X * 2.0, Vector { x: 0.5, y: 0.5 }, Vector::Y * 2.0];
    assert_eq!(error(&dart), ShapeError::NotConvex);
    let c = circle(5, 1.0);
    assert_eq!(error(&[c[0], c[2], c[4], c[1], c[3]]), ShapeError::NotConvex, "a star goes round twice");
    let spike = [Vector::ZERO, Vector::X, Vector::X * 2.0, Vector::X, Vector::ONE, Vector::Y];
    assert_eq!(error(&spike), ShapeError::NotConvex);
    assert_eq!(error(&[Vector::X, Vector::Y, Vector::X * f32::NAN]), ShapeError::NotFinite);
    assert_eq!(Hull::from_convex(&square, -1.0), Err(ShapeError::Negative));
    assert_eq!(Hull::convex_hull_of(&square, f32::INFINITY), Err(ShapeError::NotFinite));
    for points in [&[][..], &[Vector::X], &[Vector::X; 5], &[Vector::ZERO, Vector::ONE, Vector::ONE * 3.0]] {
        assert_eq!(Hull::convex_hull_of(points, 0.1), Err(ShapeError::Degenerate));
    }
}

#[test]
fn outlines_of_any_size_and_place_keep_their_corners() {
    for size in [1e-6, 1e-3, 1.0, 1e4] {
        for count in [3, 8, 255, 400] {
            assert_eq!(Hull::from_convex(&circle(count, size), 0.0).unwrap().vertices().len(), count);
            assert_eq!(Hull::convex_hull_of(&circle(count, size), 0.0).unwrap().vertices().len(), count);
        }
    }
    let far = Pose::new(Vector { x: 1000.0, y: -500.0 }, Rot::from_angle(0.3));
    let moved: Vec<Vector> = circle(8, 1.0).into_iter().map(|v| far.transform(v)).collect();
    let (near, moved) = (Hull::from_convex(&circle(8, 1.0), 0.1), Hull::from_convex(&moved, 0.1));
    let (near, moved) = (near.unwrap().unit_mass(), moved.unwrap().unit_mass());
    assert!((near.mass - moved.mass).abs() < 1e-3 && (near.inertia - moved.inertia).abs() < 1e-3);
    assert!((moved.center - far.position).length() < 1e-3);
}

#[test]
fn flat_shapes_have_no_mass_and_flat_triangles_act_as_segments() {
    let flat = Triangle::new(Vector::X * -1.0, Vector::X * 2.0, Vector::X).unwrap();
    assert_eq!(Shape::Triangle(flat).mass_properties(1.0).mass, 0.0);
    let hit = Shape::Triangle(flat).cast_ray(Vector { x: 1.5, y: 1.0 }, -Vector::Y, 9.0, true).unwrap();
    assert_eq!((hit.distance, hit.normal), (1.0, Vector::Y));
    let segment = Shape::Segment(Segment::new(Vector::X, Vector::X * 2.0).unwrap());
    assert_eq!(segment.mass_properties(1.0), MassProperties::ZERO);
    let along = segment.cast_ray(Vector::ZERO, Vector::X, 9.0, true).unwrap();
    assert_eq!((along.distance, along.normal), (1.0, -Vector::X));
    assert_eq!(segment.cast_ray(Vector::X * 3.0, Vector::X, 9.0, true), None);
}
