//! Tests of trees against exhaustive search.

use super::query::Sweep;
use super::*;
use crate::math::{DIM, Vector};
use crate::shape::Aabb;
use crate::thread_pool::ThreadPool;
use proptest::prelude::*;

/// Pseudo-random numbers by splitmix64.
#[derive(Clone)]
pub(super) struct Noise(pub u64);

impl Noise {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        z ^ (z >> 31)
    }
    pub fn below(&mut self, n: usize) -> usize {
        (self.next() % n as u64) as usize
    }
    /// A number x with 0 ≤ x < 1.
    fn unit(&mut self) -> f32 {
        (self.next() >> 40) as f32 / (1u64 << 24) as f32
    }
    pub fn vector(&mut self, low: f32, high: f32) -> Vector {
        Vector::from_array(core::array::from_fn(|_| low + (high - low) * self.unit()))
    }
    /// Integer coordinates, so boxes often touch exactly.
    fn grid(&mut self, n: usize) -> Vector {
        Vector::from_array(core::array::from_fn(|_| self.below(n) as f32))
    }
    fn aabb(&mut self) -> Aabb {
        match self.below(20) {
            0 => Aabb::EVERYTHING,
            1 => Aabb::new(Vector::ONE * f32::NEG_INFINITY, Vector::ONE * f32::INFINITY),
            2 => Aabb::new(Vector::ONE * -f32::MAX, Vector::ONE * f32::MAX),
            3 => Aabb::new(Vector::ONE, Vector::ONE * -1.0),
            4 => Aabb::new(Vector::X * f32::NAN, Vector::ONE * 9.0),
            5 => Aabb::EMPTY,
            6 | 7 => Aabb::new(Vector::ONE * 3.0, Vector::ONE * 4.0),
            8 => {
                let p = self.grid(12);
                Aabb::new(p, p)
            }
            9..12 => {
                let p = self.grid(12);
                Aabb::new(p, p + self.grid(3))
            }
            12 => {
                let p = self.vector(-1.0e6, 1.0e6);
                Aabb::new(p, p + self.vector(0.0, 1.0e5))
            }
            _ => {
                let p = self.vector(0.0, 12.0);
                Aabb::new(p, p + self.vector(0.0, 2.0))
            }
        }
    }
    fn direction(&mut self) -> Vector {
        match self.below(4) {
            0 => Vector::AXES[self.below(DIM)] * if self.below(2) == 0 { 1.0 } else { -1.0 },
            1 => self.grid(3) - Vector::ONE,
            _ => self.vector(-1.0, 1.0),
        }
    }
}

/// A tree and a list of its expected content.
#[derive(Clone, Default)]
struct Twin {
    tree: Tree,
    list: Vec<(ProxyId, u32, Aabb)>,
    next_id: u32,
}

impl Twin {
    fn fresh(&mut self, aabb: Aabb) -> (u32, Aabb) {
        self.next_id += 1;
        (self.next_id, aabb)
    }

    fn pick(&self, noise: &mut Noise) -> Option<usize> {
        (!self.list.is_empty()).then(|| noise.below(self.list.len()))
    }

    fn expected(&self, test: impl Fn(&Aabb) -> bool) -> Vec<u32> {
        let mut ids: Vec<_> = self.list.iter().filter(|(_, _, b)| test(b)).map(|(_, id, _)| *id).collect();
        ids.sort_unstable();
        ids
    }

    /// One random change.
    fn change(&mut self, kind: u8, noise: &mut Noise) {
        let aabb = noise.aabb();
        let stored = tree::admitted(aabb);
        match kind {
            0..30 if self.list.len() < 400 => {
                let (id, _) = self.fresh(aabb);
                self.list.push((self.tree.insert(id, aabb), id, stored));
            }
            0..60 => {
                if let Some(i) = self.pick(noise) {
                    self.tree.remove(self.list.swap_remove(i).0);
                }
            }
            60..80 => {
                if let Some(i) = self.pick(noise) {
                    self.tree.set(self.list[i].0, aabb);
                    self.list[i].2 = stored;
                }
            }
            110..140 => {
                if let Some(i) = self.pick(noise) {
                    // Mostly near the old place, as bodies move.
                    let near = self.list[i].2.swept(noise.vector(-0.5, 0.5));
                    let aabb = if noise.below(8) == 0 { aabb } else { near };
                    self.tree.enlarge(self.list[i].0, aabb);
                    self.list[i].2 = tree::admitted(aabb);
                }
            }
            80..110 => {
                let all_at_once = noise.below(2) == 0;
                for _ in 0..noise.below(20) {
                    let Some(i) = self.pick(noise) else { break };
                    let aabb = self.list[i].2.swept(noise.vector(-0.5, 0.5));
                    if !all_at_once {
                        self.tree.place(self.list[i].0, aabb);
                    }
                    self.list[i].2 = tree::admitted(aabb);
                }
                if all_at_once {
                    let of_id = |id| self.list.iter().find(|e| e.1 == id).unwrap().2;
                    self.tree.fit(&of_id, &ThreadPool::default());
                } else {
                    self.tree.refit();
                }
            }
            140..143 => self.tree.rebuild_full(),
            143..146 => {
                let more: Vec<_> = (0..noise.below(30)).map(|_| self.fresh(noise.aabb())).collect();
                let mut proxies = Vec::new();
                self.tree.insert_many(&more, &mut proxies);
                assert_eq!(proxies.len(), more.len());
                self.list.extend(
                    more.iter().zip(proxies).map(|((id, b), proxy)| (proxy, *id, tree::admitted(*b))),
                );
            }
            146 if noise.below(10) == 0 => {
                self.tree.clear();
                self.list.clear();
            }
            _ => {
                let sorted = self.tree.rebuild_partial();
                assert!(sorted <= self.list.len());
                assert_eq!(self.tree.rebuild_partial(), 0, "nothing is left to rebuild");
            }
        }
    }

    /// One random query of both the tree and the list.
    fn ask(&self, noise: &mut Noise) {
        match noise.below(5) {
            0 => {
                let aabb = noise.aabb();
                let mut found = Vec::new();
                assert!(self.tree.query(&aabb, |id| {
                    found.push(id);
                    true
                }));
                found.sort_unstable();
                assert_eq!(found, self.expected(|b| b.overlaps(&aabb)), "query of {aabb:?}");
            }
            1 => {
                let point = if noise.below(2) == 0 { noise.grid(14) } else { noise.vector(-1.0, 14.0) };
                let mut found = Vec::new();
                self.tree.query_point(point, |id| {
                    found.push(id);
                    true
                });
                found.sort_unstable();
                assert_eq!(found, self.expected(|b| b.contains(&Aabb::new(point, point))), "at {point:?}");
            }
            2 => self.ask_nearest(noise),
            _ => self.ask_cast(noise),
        }
        if let Some(i) = self.pick(noise) {
            let (proxy, id, aabb) = self.list[i];
            assert_eq!((self.tree.id(proxy), self.tree.aabb(proxy)), (id, aabb));
        }
        assert_eq!(self.tree.len(), self.list.len());
    }

    fn ask_nearest(&self, noise: &mut Noise) {
        let point = noise.vector(-5.0, 17.0);
        let squared = |b: &Aabb| {
            let gap = (b.min - point).max(point - b.max).max(Vector::ZERO);
            gap.length_squared()
        };
        let expected = self.list.iter().map(|(_, _, b)| squared(b)).fold(f32::MAX, f32::min);
        let mut best = f32::MAX;
        self.tree.query_nearest(point, f32::INFINITY, |id, limit| {
            assert_eq!(limit, best);
            let (_, _, b) = self.list.iter().find(|e| e.1 == id).unwrap();
            best = best.min(squared(b));
            best
        });
        assert_eq!(best, expected);
    }

    fn ask_cast(&self, noise: &mut Noise) {
        let half = if noise.below(2) == 0 { Vector::ZERO } else { noise.vector(0.0, 1.0) };
        let origin = if noise.below(2) == 0 { noise.grid(14) } else { noise.vector(-5.0, 17.0) };
        let (direction, reach) = (noise.direction(), [3.0, 20.0, f32::MAX][noise.below(3)]);
        let sweep = Sweep::new(half, origin, direction);
        let (mut found, mut nearest) = (Vec::new(), f32::INFINITY);
        self.tree.cast_box(half, origin, direction, reach, |id, limit| {
            assert_eq!(limit, reach);
            found.push(id);
            limit
        });
        found.sort_unstable();
        assert_eq!(
            found,
            self.expected(|b| sweep.entry(b, reach) <= reach),
            "from {origin:?} along {direction:?}"
        );
        // Compares with slightly smaller and larger boxes in double precision: a hit of the smaller box must
        // be found, a miss of the larger box must not be found.
        for (_, id, b) in &self.list {
            let hit = found.binary_search(id).is_ok();
            let far = if direction == Vector::ZERO { 1.0 } else { reach };
            assert!(hit || !met(b, half, origin, direction, far, -1.0e-3), "{b:?} is met but not found");
            assert!(!hit || met(b, half, origin, direction, far, 1.0e-3), "{b:?} is missed but found");
        }
        // Finds the closest hit by shrinking the limit.
        let entries = self.list.iter().map(|(_, id, b)| (*id, sweep.entry(b, reach)));
        let expected = entries.clone().filter(|e| !e.1.is_nan()).map(|e| e.1).fold(f32::INFINITY, f32::min);
        self.tree.cast_box(half, origin, direction, reach, |id, limit| {
            let (_, at) = entries.clone().find(|e| e.0 == id).unwrap();
            assert!(at <= limit, "beyond the limit");
            nearest = nearest.min(at);
            nearest
        });
        assert_eq!(nearest, expected);
    }
}

/// Whether the swept box meets a box grown by `hair` times their size. Clips the parameter interval in `f64`.
fn met(b: &Aabb, half: Vector, origin: Vector, direction: Vector, reach: f32, hair: f64) -> bool {
    let (mut enter, mut exit) = (0.0f64, f64::from(reach) * (1.0 + hair.signum() * 1.0e-6));
    for i in 0..DIM {
        let [lo, hi, h, o, d] = [b.min, b.max, half, origin, direction].map(|v| f64::from(v.to_array()[i]));
        if lo > hi {
            return false;
        }
        let grow = h + hair * (1.0 + lo.abs().max(hi.abs()).min(1.0e9));
        let (lo, hi) = (lo - grow - o, hi + grow - o);
        if lo > hi {
            return false;
        }
        if d == 0.0 {
            if lo > 0.0 || hi < 0.0 {
                return false;
            }
        } else {
            enter = enter.max((lo / d).min(hi / d));
            exit = exit.min((lo / d).max(hi / d));
        }
    }
    enter <= exit
}

/// The known pairs. `is_plain` recognizes some of them.
struct Where<F>(F);

impl<F: Fn(u32, u32) -> bool + Sync> Known for Where<F> {
    fn is_plain(&self, a: u32, b: u32) -> bool {
        a.is_multiple_of(2) && (self.0)(a, b)
    }
    fn prefetch(&self, _: u32, _: u32) {}
    fn contains(&self, a: u32, b: u32) -> bool {
        (self.0)(a, b)
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, max_shrink_iters: 200, ..Default::default() })]

    #[test]
    fn a_tree_answers_as_a_list_through_long_histories(
        ops in prop::collection::vec((0..150u8, any::<u64>()), 12_000),
    ) {
        let mut twin = Twin::default();
        for (step, (kind, seed)) in ops.into_iter().enumerate() {
            let mut noise = Noise(seed);
            twin.change(kind, &mut noise);
            if step % 4 == 0 {
                twin.tree.validate();
                twin.ask(&mut noise);
            }
        }
        while let Some((proxy, ..)) = twin.list.pop() {
            twin.tree.remove(proxy);
            twin.tree.validate();
        }
        prop_assert!(twin.tree.is_empty() && twin.tree.height() == 0);
    }

    #[test]
    fn a_history_gives_the_same_tree_each_time(seed in any::<u64>()) {
        let run = || {
            let (mut noise, mut twin) = (Noise(seed), Twin::default());
            for _ in 0..2_000 {
                let kind = noise.below(150) as u8;
                twin.change(kind, &mut noise);
            }
            format!("{:?}", twin.tree)
        };
        prop_assert_eq!(run(), run());
    }

    #[test]
    fn a_ray_towards_a_point_of_a_box_meets_the_box(seed in any::<u64>()) {
        let mut noise = Noise(seed);
        let mut tree = Tree::new();
        for _ in 0..2_000 {
            let p = noise.vector(-100.0, 100.0);
            let size = noise.vector(0.0, 1.0) * (noise.below(2) as f32);
            tree.build(&[(7, Aabb::new(p, p + size))]);
            let target = Vector::from_array(core::array::from_fn(|i| {
                p.to_array()[i] + size.to_array()[i] * [0.0, 0.5, 1.0][noise.below(3)]
            }));
            let origin = noise.vector(-100.0, 100.0);
            let mut hits = 0;
            tree.cast_ray(origin, target - origin, 1.0 + 1.0e-6, |_, limit| { hits += 1; limit });
            prop_assert_eq!(hits, 1, "{:?} from {:?} to {:?}", tree.bounds(), origin, target);
        }
    }

    #[test]
    fn pairs_are_those_of_a_search_of_all(
        seed in any::<u64>(), count in 0..400u32, kinds in 1..=4usize, still in 1..6usize
    ) {
        // With more kinds and fewer movers, more pairs are found by queries than by walks.
        const KINDS: [TreeKind; 4] =
            [TreeKind::Dynamic, TreeKind::Static, TreeKind::Kinematic, TreeKind::Standalone];
        let mut noise = Noise(seed);
        let mut trees = Trees::default();
        let mut all = Vec::new();
        let mut movers = Movers::default();
        for id in 0..count {
            let kind = KINDS[noise.below(kinds)];
            let mask = if noise.below(3) == 0 { PairMask::ALL } else { PairMask::solid(kind) };
            let mask = if noise.below(20) == 0 { PairMask::NONE } else { mask };
            let proxy = trees[kind].insert(id, noise.aabb());
            let mover = Mover { id, kind, mask, aabb: trees[kind].aabb(proxy) };
            let moved = noise.below(still) == 0;
            all.push((mover, moved));
        }
        // Movers are inserted in an order unrelated to their ids.
        for k in 0..all.len() {
            let (mover, moved) = all[(k * 7919 + 13) % all.len()];
            if moved {
                movers.insert(mover);
            }
        }
        let listed: Vec<u32> = movers.list().iter().map(|m| m.id).collect();
        let is_known = |a: u32, b: u32| (a * 31 + b * 17).is_multiple_of(5);
        let mut expected = Vec::new();
        for (a, _) in &all {
            for (b, _) in all.iter().filter(|(b, _)| b.id > a.id) {
                let asks = |x: &Mover, y: &Mover| movers.contains(x.id) && x.mask.contains(y.kind);
                if a.aabb.overlaps(&b.aabb) && (asks(a, b) || asks(b, a)) && !is_known(a.id, b.id) {
                    expected.push((a.id, b.id));
                }
            }
        }
        let mut found = FoundPairs::default();
        for pool in [ThreadPool::default(), ThreadPool::new(3)] {
            pool.wake();
            found.find(&trees, &movers, &Where(is_known), &pool);
            prop_assert_eq!(found.pairs(), &expected);
        }
        movers.clear();
        prop_assert!(listed.iter().all(|id| !movers.contains(*id)) && movers.list().is_empty());
    }
}

#[test]
fn a_tree_fitted_by_workers_is_the_same_to_the_bit() {
    let mut noise = Noise(5);
    let mut boxes: Vec<_> = (0..3_000).map(|id| (id, noise.aabb())).collect();
    let mut tree = Tree::new();
    tree.build(&boxes);
    boxes.iter_mut().for_each(|b| b.1 = noise.aabb());
    let fitted = |pool: &ThreadPool| {
        pool.wake();
        let mut tree = tree.clone();
        tree.fit(&|id| boxes[id as usize].1, pool);
        tree.validate();
        (0..3_000).for_each(|i| assert_eq!(tree.aabb(ProxyId(i)), tree::admitted(boxes[i as usize].1)));
        (tree.bounds(), tree.cost().to_bits())
    };
    assert_eq!(fitted(&ThreadPool::new(3)), fitted(&ThreadPool::default()));
}

#[test]
fn empty_and_single_trees_answer() {
    let mut tree = Tree::default();
    let any = Aabb::EVERYTHING;
    assert!(tree.is_empty() && tree.height() == 0 && tree.bounds() == Aabb::EMPTY);
    assert!(tree.query(&any, |_| panic!("nothing is there")));
    tree.cast_ray(Vector::ZERO, Vector::X, f32::INFINITY, |_, _| panic!("nothing is there"));
    assert_eq!(tree.rebuild_partial(), 0);
    tree.rebuild_full();
    tree.fit(&|_| panic!("nothing is there"), &ThreadPool::default());
    tree.build(&[]);
    tree.validate();

    let unit = Aabb::new(Vector::ZERO, Vector::ONE);
    let proxy = tree.insert(5, unit);
    assert_eq!((tree.len(), tree.height(), tree.bounds()), (1, 0, unit));
    assert!(!tree.query(&unit, |id| id != 5), "stopped by the callback");
    tree.enlarge(proxy, unit.grown(1.0));
    assert_eq!(tree.aabb(proxy), unit.grown(1.0));
    tree.fit(&|_| unit.grown(2.0), &ThreadPool::default());
    assert_eq!(tree.aabb(proxy), unit.grown(2.0));
    tree.set(proxy, unit);
    tree.rebuild_full();
    tree.validate();
    assert_eq!(tree.bounds(), unit);
    tree.remove(proxy);
    tree.validate();
    assert!(!tree.is_live(proxy));
}

#[test]
#[cfg_attr(debug_assertions, should_panic(expected = "names no leaf"))]
fn a_stale_proxy_is_caught_or_ignored() {
    let mut tree = Tree::new();
    let unit = Aabb::new(Vector::ZERO, Vector::ONE);
    let proxies = [tree.insert(1, unit), tree.insert(2, unit)];
    tree.remove(proxies[0]);
    tree.remove(proxies[0]);
    tree.enlarge(proxies[0], unit);
    tree.set(ProxyId(77), unit);
    assert_eq!((tree.id(proxies[0]), tree.aabb(proxies[0])), (u32::MAX, Aabb::EMPTY));
    tree.validate();
    assert_eq!(tree.len(), 1);
}

#[test]
fn rays_that_are_not_numbers_meet_nothing() {
    let mut tree = Tree::new();
    tree.insert(1, Aabb::EVERYTHING);
    tree.insert(2, Aabb::EMPTY);
    for bad in [f32::NAN, f32::INFINITY] {
        tree.cast_ray(Vector::X * bad, Vector::X, 1.0, |_, _| panic!("origin"));
        tree.cast_ray(Vector::ZERO, Vector::X * bad, 1.0, |_, _| panic!("direction"));
        tree.cast_box(Vector::X * bad, Vector::ZERO, Vector::X, 1.0, |_, _| panic!("size"));
        tree.query_nearest(Vector::X * bad, 1.0, |_, _| panic!("point"));
    }
    for reach in [f32::NAN, -1.0] {
        tree.cast_ray(Vector::ZERO, Vector::X, reach, |_, _| panic!("reach"));
    }
    tree.cast_ray(Vector::ZERO, Vector::X, f32::INFINITY, |id, limit| {
        assert_eq!(id, 1);
        limit
    });
    tree.query_nearest(Vector::ZERO, f32::INFINITY, |id, limit| {
        assert_eq!(id, 1);
        limit
    });
}

#[test]
fn negative_stops_a_cast() {
    let leaves: Vec<_> = (0..10)
        .map(|k| (k, Aabb::new(Vector::X * k as f32, Vector::X * (k as f32 - 0.5) + Vector::ONE)))
        .collect();
    let mut tree = Tree::new();
    tree.build(&leaves);
    let mut order = Vec::new();
    tree.cast_ray(Vector::X * -1.0, Vector::X, 100.0, |id, limit| {
        order.push(id);
        if id == 3 { -1.0 } else { limit }
    });
    assert_eq!(order, [0, 1, 2, 3], "disjoint boxes on a line are met in order");
}

/// Sets of boxes that are difficult for builders.
fn hard_sets(n: usize) -> Vec<(&'static str, Vec<Aabb>)> {
    let cube = |c: f32, h: f32| Aabb::new(Vector::ONE * (c - h), Vector::ONE * (c + h));
    vec![
        ("equal", vec![cube(1.0, 0.5); n]),
        ("concentric", (0..n).map(|k| cube(0.0, k as f32)).collect()),
        ("everything", vec![Aabb::EVERYTHING; n]),
        ("empty", vec![Aabb::EMPTY; n]),
        ("row", (0..n).map(|k| Aabb::new(Vector::X * k as f32, Vector::X * (k as f32 + 1.0))).collect()),
        ("nested from a corner", (0..n).map(|k| Aabb::new(Vector::ZERO, Vector::ONE * k as f32)).collect()),
        (
            "geometric",
            (0..n)
                .map(|k| cube((k % 200) as f32, 0.0))
                .map(|b| {
                    // Centres at powers of two: each split by bins separates only the last few.
                    let p = Vector::ONE * f32::from_bits((b.min.x as u32 + 20) << 23);
                    Aabb::new(p, p)
                })
                .collect(),
        ),
        ("huge", (0..n).map(|k| cube(0.0, f32::MAX / (1 + k % 7) as f32)).collect()),
    ]
}

#[test]
fn hard_sets_make_shallow_trees() {
    for (name, boxes) in hard_sets(5_000) {
        let leaves: Vec<_> = (0..).zip(boxes).collect();
        let mut built = Tree::new();
        built.build(&leaves);
        built.validate();
        let mut grown = Tree::new();
        let proxies: Vec<_> = leaves.iter().map(|(id, b)| grown.insert(*id, *b)).collect();
        grown.validate();
        for tree in [&built, &grown] {
            assert!(tree.height() <= 72, "{name}: height {}", tree.height());
            let mut found = 0;
            tree.query(&Aabb::EVERYTHING, |_| {
                found += 1;
                true
            });
            let expected = leaves.iter().filter(|l| l.1.overlaps(&Aabb::EVERYTHING)).count();
            assert_eq!(found, expected, "{name}");
        }
        proxies.into_iter().for_each(|p| grown.remove(p));
        grown.validate();
    }
}

#[test]
fn two_hundred_thousand_leaves_build() {
    for (name, boxes) in hard_sets(200_000) {
        let leaves: Vec<_> = (0..).zip(boxes).collect();
        let mut tree = Tree::new();
        tree.build(&leaves);
        assert_eq!(tree.len(), leaves.len(), "{name}");
        assert!(tree.height() <= 72, "{name}");
    }
}

#[test]
fn a_partial_rebuild_costs_what_moved() {
    let mut noise = Noise(1);
    let mut tree = Tree::new();
    let leaves: Vec<_> = (0..20_000)
        .map(|id| {
            let p = noise.vector(0.0, 100.0);
            (id, Aabb::new(p, p + Vector::ONE))
        })
        .collect();
    tree.build(&leaves);
    for k in 0..50 {
        tree.enlarge(ProxyId(k * 400), leaves[k as usize * 400].1.grown(0.1));
    }
    let sorted = tree.rebuild_partial();
    // Each moved leaf opens at most one branch per level, and each opened branch adds at most one item.
    assert!((50..=50 * tree.height() + 50).contains(&sorted), "{sorted} items sorted");
    tree.validate();
}
