//! Prints nanoseconds per manifold: `cargo test --release -- --ignored --nocapture nanoseconds`.

use super::collide;
use super::tests::v;
use crate::manifold::{FeatureCache, LocalManifold};
use crate::math::{Pose, Rot, Vector};
use crate::shape::{Capsule, Cuboid, Hull, Shape};
use std::sync::Arc;
use std::time::Instant;

const RUNS: usize = 101;
const REPEATS: usize = 10;

fn icosahedron() -> Shape {
    let g = 0.5 * (1.0 + 5.0f32.sqrt());
    let mut points = Vec::new();
    for (a, b) in [(1.0, g), (1.0, -g), (-1.0, g), (-1.0, -g)] {
        points.extend([v(0.0, a, b), v(a, b, 0.0), v(b, 0.0, a)].map(|p| p * 0.3));
    }
    Shape::Hull(Arc::new(Hull::convex_hull_of(&points).expect("an icosahedron")))
}

/// The fastest and the middle of many short runs, in ns per pair: a busy machine only adds.
fn measure(name: &str, a: &Shape, b: &Shape, poses: &[Pose], cached: bool) {
    let mut caches = vec![FeatureCache::NONE; poses.len()];
    let mut times = Vec::new();
    let (mut points, mut sum) = (0, 0.0);
    for _ in 0..RUNS {
        let start = Instant::now();
        for _ in 0..REPEATS {
            for (pose, cache) in poses.iter().zip(&mut caches) {
                if !cached {
                    *cache = FeatureCache::NONE;
                }
                let mut out = LocalManifold::default();
                collide(a, b, std::hint::black_box(pose), 0.02, cache, &mut out);
                points += out.count;
                sum += std::hint::black_box(&out).points[0].separation;
            }
        }
        times.push(start.elapsed().as_secs_f64() * 1e9 / (REPEATS * poses.len()) as f64);
    }
    times.sort_by(f64::total_cmp);
    let mean = points as f64 / (RUNS * REPEATS * poses.len()) as f64;
    println!("{name}: {:.0} ns, middle {:.0} ({mean:.2} points, {sum:.1})", times[0], times[RUNS / 2]);
}

#[test]
#[ignore = "a measurement, not a test"]
fn nanoseconds_per_pair() {
    let cube = Shape::Cuboid(Cuboid { half: v(0.5, 0.5, 0.5) });
    let hull_cube = Shape::Hull(Arc::new(Hull::cuboid(v(0.5, 0.5, 0.5)).expect("positive")));
    let capsule = Shape::Capsule(Capsule { a: v(-0.3, 0.0, 0.0), b: v(0.3, 0.0, 0.0), radius: 0.2 });
    let ball = icosahedron();
    let turn = |axis: Vector, angle: f32| Rot::from_axis_angle(axis, angle);
    let angle = |i: usize| 0.002 * (i % 7) as f32;
    let stacked: Vec<Pose> = (0..64)
        .map(|i| Pose::new(v(0.2, 0.998, 0.005 * i as f32), turn(Vector::X, angle(i) * 0.2)))
        .collect();
    let twisted: Vec<Pose> =
        (0..64).map(|i| Pose::new(v(0.1, 0.998, 0.0), turn(Vector::Y, 0.1 * i as f32))).collect();
    let diagonal = |i: usize| v((i % 7) as f32 - 3.0, (i % 5) as f32 - 2.0, (i % 3) as f32 + 0.5);
    let loose: Vec<Pose> = (0..64)
        .map(|i| {
            let axis = diagonal(i) * (1.0 / diagonal(i).length());
            Pose::new(axis * 1.1, turn(axis.any_orthonormal(), 0.37 * i as f32))
        })
        .collect();
    let touching: Vec<Pose> = loose.iter().map(|p| Pose::new(p.position * 0.9, p.rotation)).collect();
    for (name, poses) in [("stacked", &stacked), ("twisted", &twisted), ("loose", &loose)] {
        for cached in [false, true] {
            let how = if cached { "cached" } else { "fresh" };
            measure(&format!("box–box {name}, {how}"), &cube, &cube, poses, cached);
            measure(&format!("hull box–hull box {name}, {how}"), &hull_cube, &hull_cube, poses, cached);
        }
    }
    for cached in [false, true] {
        let how = if cached { "cached" } else { "fresh" };
        measure(&format!("icosahedron pair, {how}"), &ball, &ball, &touching, cached);
        measure(&format!("box–icosahedron, {how}"), &cube, &ball, &touching, cached);
        measure(&format!("box–capsule, {how}"), &cube, &capsule, &touching, cached);
    }
}
