//! Prints nanoseconds per manifold and per contact: `cargo bench -p avian_kernel3d`, with part of a pair's
//! name behind `--` only for such pairs.
//!
//! A pair is *fresh* without state from earlier steps, *cached* if it moved slightly since its last manifold.
//! Each run processes a thousand pairs with different shapes and poses, so that branches are not predictable.
//! Figures are those of the fastest of many runs, since other load only adds time.

#[path = "mod.rs"]
mod measure;

use crate::kernel;
use kernel::manifold::{FeatureCache, LocalManifold, collide};
use measure::pairs::{Lie, Pair};
use measure::{Contacts, KINDS, MIXED, PREDICTION, pairs};
use std::hint::black_box;
use std::time::Instant;

const RUNS: usize = 200;
const PAIRS: usize = 1024;

/// The fastest of many runs, in ns per item.
fn fastest(count: usize, mut run: impl FnMut()) -> f64 {
    let times = (0..RUNS).map(|_| {
        let start = Instant::now();
        run();
        start.elapsed().as_secs_f64()
    });
    times.fold(f64::INFINITY, f64::min) * 1.0e9 / count as f64
}

/// The time for a manifold of the pairs, fresh or cached.
fn manifolds(pairs: &[Pair], cached: bool) -> f64 {
    fastest(pairs.len(), || {
        for pair in pairs {
            let mut cache = if cached { pair.cache } else { FeatureCache::NONE };
            let mut out = LocalManifold::default();
            let [a, b] = &pair.shapes;
            collide(a, b, &pair.poses[usize::from(cached)], PREDICTION, &mut cache, &mut out);
            black_box((&out, &cache));
        }
    })
}

/// The time for updating contacts.
fn updates(pairs: &[Pair], recycle: bool) -> f64 {
    let mut all = Contacts::of(pairs);
    all.update(true);
    all.nudge();
    fastest(pairs.len(), || all.update(recycle))
}

pub fn main() {
    let wanted = std::env::args().skip(1).find(|a| !a.starts_with('-')).unwrap_or_default();
    println!("{:16}{:>17}{:>17}{:>17}{:>17}", "ns a manifold", "stacked", "turned", "loose", "mixed");
    for (name, a, b) in KINDS.iter().filter(|kind| kind.0.contains(&wanted)) {
        print!("{name:16}");
        for lies in [&[Lie::Stacked][..], &[Lie::Turned], &[Lie::Loose], &MIXED] {
            let pairs = pairs(PAIRS, lies, &mut |dice| [a(dice), b(dice)]);
            print!("{:>9.0} /{:>6.0}", manifolds(&pairs, false), manifolds(&pairs, true));
        }
        println!();
    }
    println!("(fresh / cached)\n\n{:16}{:>10}{:>10}", "ns a contact", "recycled", "computed");
    for (name, a, b) in KINDS.iter().filter(|kind| kind.0.contains(&wanted)) {
        for count in [256, 8192] {
            let pairs = pairs(count, &MIXED, &mut |dice| [a(dice), b(dice)]);
            let name = format!("{count} {name}");
            println!("{name:16}{:>10.1}{:>10.1}", updates(&pairs, true), updates(&pairs, false));
        }
    }
}
