//! How long trees take: `cargo bench -p avian_kernel3d --bench trees`.

use crate::kernel;
use kernel::bvh::{FoundPairs, Mover, Movers, PairMask, ProxyId, Tree, TreeKind, Trees};
use kernel::data::PairSet;
use kernel::math::{DIM, Vector};
use kernel::shape::Aabb;
use kernel::thread_pool::ThreadPool;
use std::time::Instant;

/// Pseudo-random numbers by splitmix64.
struct Noise(u64);

impl Noise {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }

    fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }

    fn vector(&mut self, low: f32, high: f32) -> Vector {
        let mut unit = || (self.next() >> 40) as f32 / (1u64 << 24) as f32;
        Vector::from_array(core::array::from_fn(|_| low + (high - low) * unit()))
    }
}

/// Prints the fastest of many short rounds per item, some of which run undisturbed on a busy machine.
fn time<T>(what: &str, count: usize, mut f: impl FnMut() -> T) -> T {
    let (mut best, mut result) = (f64::INFINITY, None);
    for _ in 0..40 {
        let start = Instant::now();
        result = Some(f());
        best = best.min(start.elapsed().as_secs_f64());
    }
    println!("{what:<32} {:9.3} ms {:9.1} ns each", best * 1e3, best * 1e9 / count as f64);
    result.expect("at least one round")
}

pub fn main() {
    const N: usize = 100_000;
    let mut noise = Noise(42);
    // About the density of a pile: each box touches a few others.
    let side = if DIM == 2 { 316.0 } else { 46.4 };
    let leaves: Vec<_> = (0..N as u32)
        .map(|id| {
            let p = noise.vector(0.0, side);
            (id, Aabb::new(p, p + noise.vector(0.5, 1.5)))
        })
        .collect();
    println!("{DIM}D, {N} boxes");
    let grown = time("insert one by one", N, || {
        let mut tree = Tree::new();
        leaves.iter().for_each(|(id, b)| {
            tree.insert(*id, *b);
        });
        tree
    });
    let mut tree = Tree::new();
    time("build", N, || tree.build(&leaves));
    time("rebuild_full", N, || tree.rebuild_full());
    println!("heights: grown {}, built {}", grown.height(), tree.height());
    for (name, tree) in [("grown", &grown), ("built", &tree)] {
        measure_queries(name, tree, &leaves, side, &mut noise);
    }
    // A small world, which fits the first-level cache.
    let few = &leaves[..2_000];
    let small = side * if DIM == 2 { 0.141 } else { 0.271 };
    let few: Vec<_> = few
        .iter()
        .map(|(id, b)| {
            let p = b.min * (small / side);
            (*id, Aabb::new(p, p + (b.max - b.min)))
        })
        .collect();
    tree.build(&few);
    measure_queries("2,000", &tree, &few, small, &mut noise);
    measure_steps(&leaves, side, &mut noise);
}

fn measure_queries(name: &str, tree: &Tree, leaves: &[(u32, Aabb)], side: f32, noise: &mut Noise) {
    const N: usize = 5_000;
    let boxes: Vec<_> = (0..N)
        .map(|_| {
            let p = noise.vector(0.0, side);
            Aabb::new(p, p + Vector::ONE)
        })
        .collect();
    let found = time(&format!("{name}: query small boxes"), N, || {
        let mut found = 0u64;
        for b in &boxes {
            tree.query(b, |_| {
                found += 1;
                true
            });
        }
        found
    });
    println!("    {:.2} found per query", found as f64 / N as f64);
    let rays: Vec<_> = (0..N).map(|_| (noise.vector(0.0, side), noise.vector(-1.0, 1.0))).collect();
    let (found, sum) = time(&format!("{name}: closest box along rays"), N, || {
        let (mut found, mut sum) = (0u64, 0.0);
        for (origin, direction) in &rays {
            let inverse = Vector::from_array(direction.to_array().map(|d| 1.0 / d));
            let mut best = 50.0;
            tree.cast_ray(*origin, *direction, best, |id, limit| {
                found += 1;
                let at = leaves[id as usize].1.ray_entry(*origin, inverse, limit);
                best = at.filter(|at| *at > 0.0).unwrap_or(limit);
                best
            });
            sum += f64::from(best);
        }
        (found, sum)
    });
    println!("    {:.2} visited per ray ({sum:.0})", found as f64 / N as f64);
}

/// A twentieth of all boxes moves a little each step, scattered or in one region.
fn measure_steps(leaves: &[(u32, Aabb)], side: f32, noise: &mut Noise) {
    const STEPS: usize = 40;
    const MOVED: usize = 5_000;
    const KIND: TreeKind = TreeKind::Dynamic;
    let mut trees = Trees::default();
    let mut boxes: Vec<_> = leaves.iter().map(|l| l.1).collect();
    for together in [false, true] {
        trees[KIND].build(leaves);
        let mut ids: Vec<u32> = (0..leaves.len() as u32).collect();
        ids.sort_by(|a, b| boxes[*a as usize].min.x.total_cmp(&boxes[*b as usize].min.x));
        if !together {
            (0..ids.len()).for_each(|i| ids.swap(i, noise.below(leaves.len())));
        }
        let (mut movers, mut search, mut known) = (Movers::default(), FoundPairs::default(), PairSet::new());
        let (mut best, mut items, mut found) = ([f64::INFINITY; 3], 0, 0);
        for step in 0..STEPS {
            movers.clear();
            let start = Instant::now();
            for &id in &ids[..MOVED] {
                let b = &mut boxes[id as usize];
                let shift = Vector::X * (0.1 * (b.min.x / side - 0.5)) + Vector::Y * 0.1;
                *b = Aabb::new(b.min + shift, b.max + shift);
                trees[KIND].enlarge(ProxyId(id), *b);
                movers.insert(Mover { id, kind: KIND, mask: PairMask::solid(KIND), aabb: *b });
            }
            let enlarged = Instant::now();
            items += trees[KIND].rebuild_partial();
            let rebuilt = Instant::now();
            search.find(&trees, &movers, &known, &ThreadPool::default());
            let pairs = search.pairs();
            let ends = [start, enlarged, rebuilt, Instant::now()];
            if step > 0 {
                (0..3).for_each(|i| best[i] = best[i].min((ends[i + 1] - ends[i]).as_secs_f64()));
                found += pairs.len();
            }
            pairs.iter().for_each(|(a, b)| {
                known.insert(*a, *b, 0);
            });
        }
        println!(
            "{MOVED} moving, {}: enlarge {:.3} ms, rebuild_partial {:.3} ms ({} items), pairs {:.3} ms ({} new)",
            if together { "together" } else { "scattered" },
            best[0] * 1e3,
            best[1] * 1e3,
            items / STEPS,
            best[2] * 1e3,
            found / (STEPS - 1),
        );
    }
}
