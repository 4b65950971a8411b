//! All colliders in trees.

use super::super::*;
use super::{any_shape, pose, unit, vector};
use crate::bvh::{TreeKind, Trees};
use crate::math::{Scalar, Vector, WorldPose, WorldVector};
use crate::shape::{Aabb, Shape};
use proptest::prelude::*;

type Scene = Vec<(Shape, WorldPose)>;

/// Places as far from the world's origin as their precision allows.
const FAR: [Scalar; 3] = [0.0, 100.0, if size_of::<Scalar>() == 8 { 1.0e8 } else { 1.0e3 }];

fn scene() -> impl Strategy<Value = (WorldVector, Scene)> {
    let shapes = prop::collection::vec((any_shape(), pose(20.0)), 1..40);
    (0..3usize, shapes).prop_map(|(far, shapes)| {
        let origin = Vector::ONE.to_world() * FAR[far];
        let place = |(shape, pose): (Shape, crate::math::Pose)| {
            (shape, WorldPose { position: origin + pose.position.to_world(), rotation: pose.rotation })
        };
        (origin, shapes.into_iter().map(place).collect())
    })
}

fn trees(scene: &Scene) -> Trees {
    let mut trees = Trees::default();
    for (id, (shape, pose)) in scene.iter().enumerate() {
        trees[TreeKind::ALL[id % 4]].insert(id as u32, shape.aabb(pose));
    }
    trees
}

fn all<H: Hit>(scene: &Scene, mut hit: impl FnMut(u32, &Shape, &WorldPose) -> Option<H>) -> Vec<H> {
    let mut hits: Vec<H> =
        scene.iter().enumerate().filter_map(|(id, (shape, pose))| hit(id as u32, shape, pose)).collect();
    sort_hits(&mut hits);
    hits
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn trees_find_what_looking_at_all_colliders_finds(
        (origin, scene) in scene(), from in vector(25.0), direction in unit(), solid in any::<bool>(),
        max in prop_oneof![Just(Scalar::INFINITY), 0.0..30.0 as Scalar], cast in any_shape(), turned in pose(0.1),
        target in prop_oneof![Just(0.0), 0.0f32..1.0],
    ) {
        let trees = trees(&scene);
        let start = origin + from.to_world();
        let ray = Ray::new(start, direction.to_world(), max, solid).expect("a ray");
        let expected = all(&scene, |id, shape, pose| ray.hit(id, shape, pose, ray.max_distance()));
        let (mut nearest, mut found) = (Nearest::default(), Vec::new());
        ray.visit(&trees, |id, limit| {
            let (shape, pose) = &scene[id as usize];
            nearest.offer(ray.hit(id, shape, pose, limit), limit)
        });
        ray.visit(&trees, |id, limit| {
            let (shape, pose) = &scene[id as usize];
            found.extend(ray.hit(id, shape, pose, ray.max_distance()));
            limit
        });
        sort_hits(&mut found);
        prop_assert_eq!(nearest.best(), expected.first().copied());
        prop_assert_eq!(&found, &expected);

        let config = CastConfig { target_distance: target, ..Default::default() };
        let at = WorldPose { position: start, rotation: turned.rotation };
        let sweep = ShapeCast::new(&cast, &at, direction.to_world(), max, &config);
        let Some(sweep) = sweep else { return Err(TestCaseError::fail("a cast")) };
        let expected = all(&scene, |id, shape, pose| sweep.hit(id, shape, pose, sweep.max_distance()));
        let (mut nearest, mut found) = (Nearest::default(), Vec::new());
        sweep.visit(&trees, |id, limit| {
            let (shape, pose) = &scene[id as usize];
            nearest.offer(sweep.hit(id, shape, pose, limit), limit)
        });
        sweep.visit(&trees, |id, limit| {
            let (shape, pose) = &scene[id as usize];
            found.extend(sweep.hit(id, shape, pose, sweep.max_distance()));
            limit
        });
        sort_hits(&mut found);
        prop_assert_eq!(nearest.best(), expected.first().copied());
        prop_assert_eq!(&found, &expected);

        let mut inside = Vec::new();
        visit_touching(&trees, &Aabb::new(Vector::ZERO, Vector::ZERO).at(start), |id| {
            let (shape, pose) = &scene[id as usize];
            if contains_point(shape, pose.inverse_transform(start)) {
                inside.push(id);
            }
            true
        });
        inside.sort_unstable();
        let expected: Vec<u32> = (0..scene.len() as u32)
            .filter(|id| {
                let (shape, pose) = &scene[*id as usize];
                contains_point(shape, pose.inverse_transform(start))
            })
            .collect();
        prop_assert_eq!(inside, expected);

        let mut near = Scalar::INFINITY;
        visit_near(&trees, start, Scalar::INFINITY, |id, limit| {
            let (shape, pose) = &scene[id as usize];
            let found = project_point(shape, pose.inverse_transform(start), solid, limit as f32);
            near = found.map_or(near, |p| near.min(p.distance as Scalar));
            limit.min(near)
        });
        let least = scene.iter().filter_map(|(shape, pose)| {
            project_point(shape, pose.inverse_transform(start), solid, f32::MAX)
        });
        let least = least.fold(Scalar::INFINITY, |least, p| least.min(p.distance as Scalar));
        prop_assert_eq!(near, least);
    }

    #[test]
    fn rays_from_afar_are_as_exact_as_those_from_near(
        shape in super::convex(), turned in pose(0.1), target in vector(0.5), direction in unit(), solid in any::<bool>(),
        back in 10.0f32..200.0,
    ) {
        let pose = WorldPose { position: WorldVector::ZERO, rotation: turned.rotation };
        let near = (target - direction * 4.0).to_world();
        let far = near - direction.to_world() * back as Scalar;
        let hit = |from: WorldVector| {
            let ray = Ray::new(from, direction.to_world(), Scalar::INFINITY, solid)?;
            ray.hit(0, &shape, &pose, Scalar::MAX)
        };
        let (a, b) = (hit(near), hit(far));
        if let (Some(a), Some(b)) = (a, b) {
            // At a flat angle a lateral error is larger along the ray.
            let rate = a.normal.dot(direction).abs().max(1.0e-3);
            let room = (4.0e-7 * back + 4.0e-6) as Scalar / rate as Scalar;
            prop_assert!((b.distance - a.distance - back as Scalar).abs() < room + 2.0e-5, "{a:?} {b:?}");
        }
    }
}

#[test]
fn what_is_no_ray_hits_nothing() {
    let zero = WorldVector::ZERO;
    let along = Vector::X.to_world();
    let nan = along * Scalar::NAN;
    for (origin, direction, max) in [
        (zero, zero, 1.0),
        (zero, nan, 1.0),
        (nan, along, 1.0),
        (zero, along * Scalar::INFINITY, 1.0),
        (along * Scalar::INFINITY, along, 1.0),
        (zero, along, Scalar::NAN),
        (zero, along, -1.0),
    ] {
        assert!(Ray::new(origin, direction, max, true).is_none());
        let pose = WorldPose { position: origin, ..WorldPose::IDENTITY };
        let ball = Shape::Ball(crate::shape::Ball { radius: 1.0 });
        assert!(ShapeCast::new(&ball, &pose, direction, max, &CastConfig::default()).is_none());
    }
    for length in [Scalar::MIN_POSITIVE, 1.0e-30, 1.0e30, Scalar::MAX] {
        let ray = Ray::new(zero, along * length, Scalar::INFINITY, true).expect("any length is a direction");
        let ball = Shape::Ball(crate::shape::Ball { radius: 1.0 });
        let at = WorldPose { position: Vector::X.to_world() * 3.0, ..WorldPose::IDENTITY };
        let hit = ray.hit(7, &ball, &at, Scalar::MAX).expect("it is in the way");
        assert_eq!((hit.collider, hit.distance, hit.normal), (7, 2.0, -Vector::X));
    }
}

#[test]
fn equally_near_hits_are_in_the_order_of_ids() {
    let hit = |collider: u32, distance: Scalar| RayCastHit { collider, distance, normal: Vector::X };
    let mut nearest = Nearest::default();
    for id in [5, 3, 4] {
        assert_eq!(nearest.offer(Some(hit(id, 1.0)), 9.0), 1.0);
    }
    assert_eq!(nearest.best().map(|hit| hit.collider), Some(3));
    let mut hits = [hit(2, 1.0), hit(9, 0.5), hit(1, 1.0)];
    sort_hits(&mut hits);
    assert_eq!(hits.map(|hit| hit.collider), [9, 1, 2]);
}
