//! Two shapes.

use super::super::*;
use super::{any_shape, composite, convex, half_space, parts, pose, unit, vector};
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Ball, Cuboid, HalfSpace, Shape};
use proptest::prelude::*;

/// The height of a shape along a direction; infinite for half-spaces, except along their normal.
fn height(shape: &Shape, pose: &Pose, along: Vector) -> f32 {
    let local = pose.rotation.inverse_rotate(along);
    let top = match shape {
        Shape::HalfSpace(s) if (local - s.normal).length() < 1.0e-5 => return pose.position.dot(along),
        Shape::HalfSpace(_) => return f32::INFINITY,
        shape => shape.support(local).expect("a convex shape"),
    };
    pose.transform(top).dot(along)
}

/// Whether a point is in a convex shape, as far as some planes decide.
fn is_in(shape: &Shape, pose: &Pose, point: Vector, planes: &[Vector], room: f32) -> bool {
    planes.iter().all(|n| point.dot(*n) <= height(shape, pose, *n) + room)
}

const ROOM: f32 = 2.0e-5;

/// Checks the nearest points of convex shapes from both sides.
fn certify(a: &Shape, b: &Shape, at: &Pose, found: &Closest, planes: &[Vector]) -> Result<(), TestCaseError> {
    let Closest { points: [on_a, on_b], normal, distance } = *found;
    prop_assert!((normal.length() - 1.0).abs() < 1.0e-5, "a unit normal: {found:?}");
    let top = height(a, &Pose::IDENTITY, normal);
    let bottom = -height(b, at, -normal);
    if distance > 0.0 {
        prop_assert!((on_b - on_a - normal * distance).length() < ROOM, "points apart along the normal");
        prop_assert!(is_in(a, &Pose::IDENTITY, on_a, planes, ROOM), "a point of A");
        prop_assert!(is_in(b, at, on_b, planes, ROOM), "a point of B");
        prop_assert!(bottom - top >= distance - ROOM, "a plane between: {} < {distance}", bottom - top);
    } else {
        prop_assert!(
            (top - bottom + distance).abs() < 1.0e-4,
            "{} along the normal: {found:?}",
            top - bottom
        );
        for n in planes {
            let depth = height(a, &Pose::IDENTITY, *n) + height(b, at, -*n);
            prop_assert!(depth >= -distance - 1.0e-3, "less depth {depth} along {n:?}: {found:?}");
        }
    }
    Ok(())
}

fn planes() -> impl Strategy<Value = Vec<Vector>> {
    prop::collection::vec(unit(), 60)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3_000))]

    #[test]
    fn nearest_points_of_convex_shapes_are_certified(
        a in convex(), b in convex(), at in pose(2.0), planes in planes(),
    ) {
        let found = closest(&a, &b, &at, f32::MAX).expect("bounded shapes have a distance");
        prop_assert_eq!(overlaps(&a, &b, &at), overlaps(&b, &a, &at.inverse()));
        if found.distance.abs() > ROOM {
            prop_assert_eq!(overlaps(&a, &b, &at), found.distance < 0.0);
        }
        let back = closest(&b, &a, &at.inverse(), f32::MAX).expect("as well");
        prop_assert!((back.distance - found.distance).abs() < 1.0e-3 * (found.distance < 0.0) as u8 as f32 + ROOM);
        certify(&a, &b, &at, &found, &planes)?;
    }

    #[test]
    fn nearest_points_of_a_half_space_are_certified(
        a in half_space(), b in convex(), at in pose(2.0), swap in any::<bool>(), planes in planes(),
    ) {
        let (a, b, at) = if swap { (b, a, at.inverse()) } else { (a, b, at) };
        let found = closest(&a, &b, &at, f32::MAX).expect("a half-space has a distance");
        if found.distance > 0.0 {
            certify(&a, &b, &at, &found, &planes)?;
        }
        prop_assert_eq!(overlaps(&a, &b, &at), found.distance <= 0.0);
    }
}

/// The least distance over all pairs of parts.
fn brute_closest(a: &Shape, b: &Shape, at: &Pose) -> f32 {
    let mut least = f32::INFINITY;
    for (pose_a, a) in parts(a) {
        for (pose_b, b) in parts(b) {
            let found = closest(&a, &b, &pose_a.inverse().then(&at.then(&pose_b)), f32::MAX);
            least = least.min(found.expect("convex parts have a distance").distance);
        }
    }
    least
}

fn brute_cast(a: &Shape, b: &Shape, at: &Pose, direction: Vector, config: &CastConfig) -> Option<f32> {
    let mut least: Option<f32> = None;
    for (pose_a, a) in parts(a) {
        for (pose_b, b) in parts(b) {
            let inner = pose_a.inverse().then(&at.then(&pose_b));
            let along = pose_a.rotation.inverse_rotate(direction);
            if let Some(hit) = cast_shape(&a, &b, &inner, along, 20.0, config) {
                least = Some(least.map_or(hit.distance, |l| l.min(hit.distance)));
            }
        }
    }
    least
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1_000))]

    #[test]
    fn composites_are_as_near_as_their_nearest_parts(
        a in composite(), b in prop_oneof![convex(), composite(), half_space()], at in pose(5.0), limit in 0.0f32..4.0,
        swap in any::<bool>(),
    ) {
        let (a, b, at) = if swap { (b, a, at.inverse()) } else { (a, b, at) };
        let least = brute_closest(&a, &b, &at);
        let found = closest(&a, &b, &at, limit);
        match found {
            Some(found) => {
                let room = if least < 0.0 { 2.0e-3 } else { ROOM };
                prop_assert!((found.distance - least).abs() < room, "{} and not {least}", found.distance);
            }
            None => prop_assert!(least > limit - ROOM, "nothing within {limit}, but {least}"),
        }
        if least.abs() > ROOM {
            prop_assert_eq!(overlaps(&a, &b, &at), least < 0.0);
        }
    }

    #[test]
    fn casts_of_composites_are_those_of_their_parts(
        a in composite(), b in prop_oneof![convex(), composite(), half_space()], at in pose(5.0),
        direction in unit(), target in prop_oneof![Just(0.0), 0.0f32..0.3], swap in any::<bool>(),
        ignore in any::<bool>(),
    ) {
        let (a, b, at) = if swap { (b, a, at.inverse()) } else { (a, b, at) };
        let config = CastConfig { target_distance: target, ignore_origin_penetration: ignore, ..Default::default() };
        let found = cast_shape(&a, &b, &at, direction, 20.0, &config).map(|hit| hit.distance);
        let least = brute_cast(&a, &b, &at, direction, &config);
        match (found, least) {
            (Some(found), Some(least)) => {
                // A hit at a flat angle is as exact as its distance over its rate.
                prop_assert!((found - least).abs() < 5.0e-4, "{found} and not {least}");
            }
            (None, None) => {}
            // Whether a shape that passes by touches is decided within rounding.
            (Some(t), None) | (None, Some(t)) => {
                let then = Pose { position: at.position + direction * t, ..at };
                let near = brute_closest(&a, &b, &then) - target;
                let before = Pose { position: at.position + direction * (t - 0.01), ..at };
                let after = Pose { position: at.position + direction * (t + 0.01), ..at };
                let [before, after] = [before, after].map(|pose| brute_closest(&a, &b, &pose) - target);
                prop_assert!(near.abs() < 1.0e-4 && (before.min(after) > -1.0e-4 || t < 1.0e-4), "a hit at {t} of one only");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3_000))]

    #[test]
    fn casts_of_convex_shapes_stop_where_they_first_meet(
        a in prop_oneof![4 => convex(), 1 => half_space()], b in convex(), at in pose(4.0), aside in vector(0.8),
        other in unit(), aimed in any::<bool>(), target in prop_oneof![Just(0.0), 0.0f32..0.5], swap in any::<bool>(),
        planes in planes(),
    ) {
        let to = aside - at.position;
        let direction = if aimed && to.length() > 0.1 { to * (1.0 / to.length()) } else { other };
        let (a, b, at, direction) = if swap {
            (b, a, at.inverse(), -at.rotation.inverse_rotate(direction))
        } else {
            (a, b, at, direction)
        };
        let reach = 8.0;
        let config = CastConfig { target_distance: target, ..Default::default() };
        let moved = |t: f32| Pose { position: at.position + direction * t, ..at };
        let gap = |t: f32| closest(&a, &b, &moved(t), f32::MAX).expect("a distance").distance - target;
        let hit = cast_shape(&a, &b, &at, direction, reach, &config);
        let end = hit.map_or(reach, |hit| hit.distance);
        for k in 0..if end > 0.0 { 20 } else { 0 } {
            let t = end * k as f32 / 20.0;
            prop_assert!(gap(t) > -2.0e-5, "already met at {t} of {end}: {}", gap(t));
        }
        if let Some(hit) = hit {
            if hit.distance > 0.0 {
                prop_assert!(gap(end) < 2.0e-5, "apart by {} at {end}", gap(end));
                // Not by the depth: its normal may belong to a face that is about as good.
                let low = -height(&b, &moved(end), -hit.normal);
                let between = low - height(&a, &Pose::IDENTITY, hit.normal) - target;
                // The normal of two edges is accurate to 1e-4 rad, and edges are up to a metre long.
                prop_assert!(between > -1.0e-4, "not met before: {between}");
                prop_assert!((hit.normal.length() - 1.0).abs() < 1.0e-5);
                prop_assert!(hit.normal.dot(direction) <= 0.0, "the normal is against the way");
                let [on_a, on_b] = hit.points;
                prop_assert!((on_b - on_a - hit.normal * target).length() < 1.0e-5, "points at the target distance");
                prop_assert!(is_in(&a, &Pose::IDENTITY, on_a, &planes, 5.0e-5), "a point of A");
                prop_assert!(is_in(&b, &moved(end), on_b, &planes, 5.0e-5), "a point of B");
                let sharp = height(&a, &Pose::IDENTITY, hit.normal) - on_a.dot(hit.normal);
                // On a shape thinner than a millimetre any point is allowed.
                let thin = height(&a, &Pose::IDENTITY, hit.normal) + height(&a, &Pose::IDENTITY, -hit.normal) < 1.0e-3;
                prop_assert!(thin || sharp.abs() < 1.0e-4, "the normal is that of a plane between: {sharp}");
            } else {
                prop_assert!(gap(0.0) < 2.0e-5);
            }
        }
    }

    #[test]
    fn points_are_projected_onto_the_nearest_boundary(
        shape in any_shape(), point in vector(3.0), solid in any::<bool>(),
        planes in planes(),
    ) {
        let Some(found) = project_point(&shape, point, solid, f32::MAX) else {
            return Err(TestCaseError::fail("every shape has a nearest point"));
        };
        prop_assert!(((found.point - point).length() - found.distance).abs() < 1.0e-4, "{found:?}");
        if solid && found.is_inside {
            prop_assert_eq!(found.point, point);
        }
        let inside = parts(&shape).iter().any(|(pose, part)| {
            contains_point(part, pose.inverse_transform(point)) && !matches!(part, Shape::Segment(_))
        });
        if found.distance > ROOM {
            prop_assert_eq!(contains_point(&shape, point), inside);
        }
        if let Shape::Composite(_) = shape { return Ok(()) }
        if matches!(shape, Shape::HalfSpace(_)) { return Ok(()) }
        let depth = planes.iter().map(|n| height(&shape, &Pose::IDENTITY, *n) - point.dot(*n));
        let least = depth.fold(f32::INFINITY, f32::min);
        if least < 0.0 {
            prop_assert!(!found.is_inside && found.distance >= -least - ROOM);
        }
        prop_assert!(is_in(&shape, &Pose::IDENTITY, found.point, &planes, 1.0e-4), "a point of the shape");
        if found.is_inside && !solid {
            prop_assert!(found.distance <= least + 1.0e-3, "{} but {least} is nearer", found.distance);
        }
    }
}

/// Numbers that may be infinite, NaN, huge or tiny.
fn odd() -> impl Strategy<Value = f32> {
    prop_oneof![
        Just(f32::NAN),
        Just(f32::INFINITY),
        Just(-f32::MAX),
        Just(1.0e30f32),
        Just(0.0),
        Just(1.0e-40),
        -2.0f32..2.0
    ]
}

fn odd_vector() -> impl Strategy<Value = Vector> {
    prop::array::uniform3(odd()).prop_map(|v| Vector::from_array(core::array::from_fn(|i| v[i])))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3_000))]

    #[test]
    fn no_numbers_make_a_query_panic_or_give_what_is_not_finite(
        a in any_shape(), b in any_shape(), position in odd_vector(), direction in odd_vector(),
        limit in odd(), target in odd(), scale in odd(),
    ) {
        let at = Pose { position, rotation: Rot::IDENTITY };
        if let Some(found) = closest(&a, &b, &at, limit) {
            prop_assert!(found.distance <= limit && found.normal.is_finite());
        }
        overlaps(&a, &b, &at);
        let config = CastConfig { target_distance: target, ..Default::default() };
        if let Some(hit) = cast_shape(&a, &b, &at, direction, limit, &config) {
            prop_assert!(hit.distance >= 0.0 && hit.distance <= limit && hit.normal.is_finite());
        }
        if let Some(found) = project_point(&a, position, true, limit) {
            prop_assert!(found.point.is_finite() && found.distance <= limit);
        }
        let ball = Shape::Ball(crate::shape::Ball { radius: scale });
        let cube = Shape::Cuboid(crate::shape::Cuboid { half: direction });
        for odd in [ball, cube] {
            closest(&odd, &b, &at, limit);
            cast_shape(&b, &odd, &at, Vector::X, limit, &config);
            overlaps(&odd, &a, &at);
            project_point(&odd, position, false, limit);
        }
    }
}

#[test]
fn a_box_on_a_floor_slides_on_if_what_it_overlaps_is_ignored() {
    let floor = Shape::Cuboid(crate::shape::Cuboid { half: Vector::ONE * 5.0 - Vector::Y * 4.5 });
    let cube = Shape::Cuboid(crate::shape::Cuboid { half: Vector::ONE * 0.5 });
    let at = Pose { position: Vector::Y * 0.99, rotation: Rot::IDENTITY };
    let ignoring = CastConfig { ignore_origin_penetration: true, ..Default::default() };
    let cast =
        |direction: Vector, config: &CastConfig| cast_shape(&floor, &cube, &at, direction, 9.0, config);
    let hit = cast(Vector::X, &CastConfig::default()).expect("it overlaps");
    assert_eq!(hit.distance, 0.0);
    assert!((hit.normal - Vector::Y).length() < 1.0e-6);
    assert_eq!(cast(Vector::X, &ignoring), None);
    assert_eq!(cast(Vector::Y, &ignoring), None);
    assert!(cast(-Vector::Y, &ignoring).is_some(), "it would go deeper");
    let silent = CastConfig { compute_contact_on_penetration: false, ..Default::default() };
    assert_eq!(cast(Vector::X, &silent).map(|hit| hit.normal), Some(Vector::ZERO));
}

#[test]
fn issue_casts_close_above_a_large_floor_hit_far_too_early() {
    for size in [1.0f32, 100.0, 10_000.0] {
        let floor = Shape::Cuboid(Cuboid { half: (Vector::ONE - Vector::Y) * size + Vector::Y * 0.5 });
        let ball = Shape::Ball(Ball { radius: 0.125 });
        let start = Pose::new(Vector::Y * (0.625 + 1.0 / 512.0), Rot::IDENTITY);
        let down = Vector::X - Vector::Y * (1.0 / 256.0);
        let direction = down * (1.0 / down.length());
        let hit = cast_shape(&floor, &ball, &start, direction, 5.0, &CastConfig::default()).expect("a hit");
        assert!((hit.distance - 0.5).abs() < 0.005, "{} m of 0.5 over {size} m", hit.distance);
    }
}

#[test]
fn half_spaces_that_meet_have_points_across_from_each_other() {
    let [ground, ceiling] = [Vector::Y, -Vector::Y].map(|normal| Shape::HalfSpace(HalfSpace { normal }));
    let start = Pose::new(Vector::Y * 2.0, Rot::IDENTITY);
    let direction = (Vector::X - Vector::Y) * 0.5f32.sqrt();
    let hit = cast_shape(&ground, &ceiling, &start, direction, 10.0, &CastConfig::default()).expect("a hit");
    assert!((hit.points[0] - hit.points[1]).length() < 1.0e-6, "{hit:?}");
    assert!((hit.points[0] - Vector::X * 2.0).length() < 1.0e-6, "{hit:?}");
}
