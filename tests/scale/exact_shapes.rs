//! Scaled and mirrored shapes, point by point.

use super::*;

/// Mirrored and evenly scaled shapes are exact: distances are those of the shape, times the factor.
#[test]
fn mirrored_and_evenly_scaled_shapes_are_exact() {
    for (name, shape, _) in shapes() {
        for (mirror, factor) in mirrors().into_iter().flat_map(|mirror| [(mirror, 1.0), (mirror, 2.5)]) {
            let mut other = shape.clone();
            other.set_scale(mirror * factor, 10);
            assert_eq!(other.scale(), mirror * factor, "{name}");
            for point in points(200) {
                let (expected, found) = (distance(&shape, point), distance(&other, point * mirror * factor));
                let error = (found - expected * factor).abs();
                assert!(error < 2.0e-3, "{name} by {}: {point}, {found} and not {expected}", mirror * factor);
            }
            let masses = [&shape, &other].map(|collider| collider.mass(1.0));
            let volume = (factor as f32).powi(DIM as i32);
            assert!((masses[1] - masses[0] * volume).abs() <= 1.0e-3 * masses[1].abs(), "{name}: {masses:?}");
        }
    }
}

/// Points of the surface stay on it, and points inside stay inside.
#[test]
fn unevenly_scaled_polytopes_are_exact() {
    for (name, shape, _) in shapes().into_iter().filter(|(.., is_exact)| *is_exact) {
        for scale in mirrors().into_iter().map(|mirror| mirror * uneven()) {
            let mut other = shape.clone();
            other.set_scale(scale, 10);
            for point in points(200) {
                let (on, _) = shape.project_point(Vector::ZERO, Rotation::default(), point, false);
                let off = distance(&other, on * scale).abs();
                assert!(off < 2.0e-3, "{name} by {scale}: {on} is {off} m off the surface");
                let inside = |c: &Collider, p| c.contains_point(Vector::ZERO, Rotation::default(), p);
                if distance(&shape, point).abs() > 1.0e-2 {
                    assert_eq!(
                        inside(&other, point * scale),
                        inside(&shape, point),
                        "{name} by {scale}: {point}"
                    );
                }
            }
            let masses = [&shape, &other].map(|collider| collider.mass(1.0));
            let volume = scale.to_array().iter().product::<Scalar>().abs() as f32;
            assert!((masses[1] - masses[0] * volume).abs() <= 1.0e-3 * masses[1].abs(), "{name}: {masses:?}");
        }
    }
}

/// Rounded by polytopes: inside of the exact shape, and of nearly its size.
#[test]
fn unevenly_scaled_curved_shapes_are_almost_exact() {
    for (name, shape, _) in
        shapes().into_iter().filter(|(name, _, exact)| !exact && *name != "turned compound")
    {
        for scale in mirrors().into_iter().map(|mirror| mirror * uneven()) {
            let mut other = shape.clone();
            other.set_scale(scale, 10);
            let bounds = [&shape, &other].map(|c| c.aabb(Vector::ZERO, Rotation::default()));
            let (expected, found) = (bounds[0].size() * scale.abs(), bounds[1].size());
            // Edges rounded with 0.2 m have a radius that follows the smallest scale.
            let least = expected - (scale.abs() - scale.abs().min_element()) * 0.4;
            let fits = found.cmple(expected * 1.001).all() && found.cmpge(least * 0.75).all();
            assert!(fits, "{name} by {scale}: {found} {expected}");
            assert!(other.mass(1.0).is_finite());
        }
    }
}

#[test]
fn a_mirrored_half_space_is_on_the_other_side() {
    let normal = (Vector::X + Vector::Y * 2.0).normalize();
    for mirror in mirrors() {
        let mut half_space = Collider::half_space(normal);
        half_space.set_scale(mirror * uneven(), 10);
        for along in [-1.0, 1.0] {
            let point = normal * along * mirror * uneven();
            let inside = half_space.contains_point(Vector::ZERO, Rotation::default(), point);
            assert_eq!(inside, along < 0.0, "{mirror}");
        }
    }
}

/// The kernel's shapes, too: rays at a mirrored collider hit where mirrored rays hit the collider.
#[test]
fn rays_meet_mirrored_colliders_at_mirrored_places() {
    for (name, shape, _) in shapes() {
        let mut app = app();
        let plain = app.world_mut().spawn((shape.clone(), Transform::default())).id();
        let others: Vec<(Entity, Vector)> = mirrors()
            .into_iter()
            .map(|mirror| (app.world_mut().spawn((shape.clone(), scaled(mirror))).id(), mirror))
            .collect();
        step(&mut app);
        let cast = move |queries: SpatialQuery| {
            let (mut hits, mut count) = (0, 0);
            for (from, to) in points(60).zip(points(121).skip(60)) {
                let Ok(direction) = Dir::new(to - from) else { continue };
                let distance = |entity: Entity, origin, direction| {
                    let all = SpatialQueryFilter::default();
                    let is_it = |hit: Entity| hit == entity;
                    let hit = queries.cast_ray_predicate(origin, direction, 20.0, true, &all, &is_it);
                    hit.map_or(99.0, |hit| hit.distance)
                };
                let expected = distance(plain, from, direction);
                hits += u32::from(expected < 99.0);
                for &(other, mirror) in &others {
                    let direction = Dir::new(*direction * mirror).expect("a direction");
                    let found = distance(other, from * mirror, direction);
                    count += u32::from((found - expected).abs() > 1.0e-3);
                }
            }
            (hits, count)
        };
        let (hits, wrong) = app.world_mut().run_system_once(cast).expect("the system runs");
        assert!(wrong <= 1, "{name}: {wrong} rays of {hits} that hit differ (one may graze an edge)");
        assert!(hits > 0 || name == "segment" || name == "polyline", "{name} is never hit");
    }
}
