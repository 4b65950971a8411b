//! Many rays and casts in random worlds, each with one kind of shape, compared with a search of every
//! collider.
//!
//! `QUERY_CASES` is the number of rays for each kind of shape. There are a tenth as many casts.

use super::super::*;
use super::{composite, convex, dim, half_space, pose, unit, vector};
use crate::bvh::{TreeKind, Trees};
use crate::math::{Pose, Scalar, Vector, WorldPose};
use crate::shape::{Ball, Capsule, Cuboid, Segment, Shape, Triangle};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

const SHAPES: usize = 24;
const RAYS_PER_WORLD: usize = 250;

/// Maximum distance of a hit from the surface, in metres, after a ray of `distance` metres. The distance is
/// rounded, and so is the slope at which a line comes down far away.
fn room(distance: f32) -> f32 {
    1.0e-4 + 4.0e-7 * distance
}

/// Maximum excess of [`closest`] over the least depth of shapes of 2 m that touch in passing; in metres.
const DEPTH: f32 = 2.0e-3;

fn rays_per_kind() -> usize {
    std::env::var("QUERY_CASES").ok().and_then(|n| n.parse().ok()).unwrap_or(2_000)
}

fn kinds() -> Vec<(&'static str, BoxedStrategy<Shape>)> {
    let radius = || prop_oneof![Just(0.0), 0.0f32..0.5];
    let hull = (prop::collection::vec(vector(1.0), 4..24), radius());
    vec![
        ("ball", (0.0f32..1.0).prop_map(|radius| Shape::Ball(Ball { radius })).boxed()),
        (
            "capsule",
            (vector(1.0), vector(1.0), radius())
                .prop_map(|(a, b, radius)| Shape::Capsule(Capsule { a, b, radius }))
                .boxed(),
        ),
        ("cuboid", vector(1.0).prop_map(|half| Shape::Cuboid(Cuboid { half: half.abs() })).boxed()),
        ("hull", hull.prop_filter_map("no hull", |(points, radius)| dim::hull(&points, radius)).boxed()),
        (
            "triangle",
            [vector(1.0), vector(1.0), vector(1.0)]
                .prop_map(|[a, b, c]| Shape::Triangle(Triangle { a, b, c }))
                .boxed(),
        ),
        ("segment", [vector(1.0), vector(1.0)].prop_map(|[a, b]| Shape::Segment(Segment { a, b })).boxed()),
        ("curved", dim::curved().boxed()),
        ("half-space", half_space().boxed()),
        ("composite", composite().boxed()),
        ("convex", convex().boxed()),
    ]
}

struct World {
    colliders: Vec<(Shape, WorldPose)>,
    trees: Trees,
}

impl World {
    fn new(shape: &impl Strategy<Value = Shape>, sample: &mut Sample) -> Self {
        let place = pose(12.0);
        let mut world = Self { colliders: Vec::new(), trees: Trees::default() };
        for id in 0..SHAPES {
            let (shape, pose) = (sample.of(shape), sample.of(&place));
            let pose = WorldPose { position: pose.position.to_world(), rotation: pose.rotation };
            world.trees[TreeKind::ALL[id % 4]].insert(id as u32, shape.aabb(&pose));
            world.colliders.push((shape, pose));
        }
        world
    }

    fn nearest_of_all<H: Hit>(&self, hit: impl Fn(u32, &Shape, &WorldPose) -> Option<H>) -> Option<H> {
        let mut nearest = Nearest::default();
        for (id, (shape, pose)) in self.colliders.iter().enumerate() {
            nearest.offer(hit(id as u32, shape, pose), Scalar::MAX);
        }
        nearest.best()
    }
}

/// Values of strategies, the same in every run.
struct Sample(TestRunner);

impl Sample {
    fn of<T: core::fmt::Debug>(&mut self, strategy: &impl Strategy<Value = T>) -> T {
        strategy.new_tree(&mut self.0).expect("a value").current()
    }

    /// A line, often towards a collider.
    fn line(&mut self, world: &World) -> (Vector, Vector) {
        let (from, aside, direction) = (self.of(&vector(16.0)), self.of(&vector(1.0)), self.of(&unit()));
        let target = self.of(&(0..2 * SHAPES));
        let to = world.colliders.get(target).map(|(_, pose)| pose.position.to_local() + aside - from);
        (from, to.filter(|to| to.length() > 0.1).unwrap_or(direction))
    }
}

fn check_ray(name: &str, world: &World, ray: &Ray, from: Vector, along: Vector) -> bool {
    let expected = world.nearest_of_all(|id, shape, pose| ray.hit(id, shape, pose, ray.max_distance()));
    let mut nearest = Nearest::default();
    ray.visit(&world.trees, |id, limit| {
        let (shape, pose) = &world.colliders[id as usize];
        nearest.offer(ray.hit(id, shape, pose, limit), limit)
    });
    assert_eq!(nearest.best(), expected, "{name}: from {from:?} along {along:?}");
    let Some(hit) = expected else { return false };
    let (shape, pose) = &world.colliders[hit.collider as usize];
    let unit = along * (1.0 / along.length());
    let at = pose.inverse_transform((from + unit * hit.distance as f32).to_world());
    let off = project_point(shape, at, true, f32::MAX).expect("a distance").distance;
    assert!(
        off < room(hit.distance as f32),
        "{name}: a hit {off} m off the surface, from {from:?} along {along:?}"
    );
    true
}

fn check_cast(name: &str, world: &World, cast: &ShapeCast, moving: (&Shape, Pose), along: Vector) -> bool {
    let expected = world.nearest_of_all(|id, shape, pose| cast.hit(id, shape, pose, cast.max_distance()));
    let mut nearest = Nearest::default();
    cast.visit(&world.trees, |id, limit| {
        let (shape, pose) = &world.colliders[id as usize];
        nearest.offer(cast.hit(id, shape, pose, limit), limit)
    });
    assert_eq!(nearest.best(), expected, "{name}: {moving:?} along {along:?}");
    let Some(hit) = expected else { return false };
    let (shape, pose) = &world.colliders[hit.collider as usize];
    let unit = along * (1.0 / along.length());
    let gap = |way: f32| {
        let start = WorldPose { position: moving.1.position.to_world(), rotation: moving.1.rotation };
        let then = WorldPose { position: start.position + (unit * way).to_world(), ..start };
        closest(shape, moving.0, &pose.relative(&then), f32::MAX).expect("a distance").distance
    };
    let end = hit.distance as f32;
    if end > 0.0 {
        assert!(gap(end) < room(end), "{name}: {} m apart at {end} m: {moving:?}", gap(end));
        let before = (0..8).map(|k| gap(end * k as f32 / 8.0)).fold(f32::INFINITY, f32::min);
        assert!(before > -DEPTH, "{name}: met before, by {before} m: {moving:?} along {along:?}");
    }
    true
}

#[test]
fn rays_find_what_looking_at_all_colliders_finds() {
    let mut sample = Sample(TestRunner::deterministic());
    for (name, shape) in kinds() {
        let mut hits = 0;
        for _ in 0..rays_per_kind().div_ceil(RAYS_PER_WORLD) {
            let world = World::new(&shape, &mut sample);
            for i in 0..RAYS_PER_WORLD {
                let (from, along) = sample.line(&world);
                let ray = Ray::new(from.to_world(), along.to_world(), Scalar::INFINITY, i % 2 == 0);
                hits += usize::from(check_ray(name, &world, &ray.expect("a ray"), from, along));
            }
        }
        let are_met = !(name == "segment" && crate::math::DIM == 3);
        assert_eq!(hits > 0, are_met, "{name}: rays {}", if are_met { "hit" } else { "hit nothing" });
    }
}

#[test]
fn casts_find_what_looking_at_all_colliders_finds() {
    let mut sample = Sample(TestRunner::deterministic());
    let casts_per_world = RAYS_PER_WORLD / 10;
    for (name, shape) in kinds() {
        let mut hits = 0;
        for _ in 0..rays_per_kind().div_ceil(RAYS_PER_WORLD) {
            let world = World::new(&shape, &mut sample);
            for _ in 0..casts_per_world {
                let (from, along) = sample.line(&world);
                let (moving, turned) = (sample.of(&convex()), sample.of(&pose(0.1)));
                let start = WorldPose { position: from.to_world(), rotation: turned.rotation };
                let config = CastConfig::default();
                let cast = ShapeCast::new(&moving, &start, along.to_world(), Scalar::INFINITY, &config);
                let moving = (&moving, Pose { position: from, rotation: turned.rotation });
                hits += usize::from(check_cast(name, &world, &cast.expect("a cast"), moving, along));
            }
        }
        assert!(hits > 0, "{name}: some casts hit");
    }
}
