//! Every block runs once, on any worker.

use super::ThreadPool;
use core::sync::atomic::{AtomicU32, AtomicUsize, Ordering};

fn counts(pool: &ThreadPool, blocks: usize) -> Vec<u32> {
    let counts: Vec<AtomicU32> = (0..blocks).map(|_| AtomicU32::new(0)).collect();
    pool.run(blocks, |block, worker| {
        assert!(worker < pool.workers());
        counts[block].fetch_add(1, Ordering::Relaxed);
    });
    counts.into_iter().map(AtomicU32::into_inner).collect()
}

#[test]
fn every_block_runs_once() {
    for workers in [0, 1, 2, 3, 8] {
        let pool = ThreadPool::new(workers);
        assert_eq!(pool.workers(), workers.max(1));
        for round in 0..200 {
            match round % 3 {
                0 => pool.wake(),
                1 => pool.rest(),
                _ => {}
            }
            for blocks in [0, 1, 2, 3, 17, 200] {
                assert_eq!(counts(&pool, blocks), vec![1; blocks], "{workers} workers");
            }
        }
    }
}

#[test]
fn every_block_runs_once_wherever_parts_end() {
    for workers in [1, 2, 3, 8] {
        let pool = ThreadPool::new(workers);
        for round in 0..600u32 {
            if round % 50 == 0 {
                pool.wake();
            }
            // Some parts are empty, and now and then all parts except the first.
            let mut ends: Vec<u32> = (1..=workers as u32).map(|k| (round * k * 7) % 23).collect();
            ends.sort_unstable();
            if round % 5 == 0 {
                let last = ends[workers - 1];
                ends.fill(last);
            }
            let blocks = ends[workers - 1] as usize;
            let counts: Vec<AtomicU32> = (0..blocks).map(|_| AtomicU32::new(0)).collect();
            pool.run_parts(&ends, |block, worker| {
                assert!(worker < workers);
                counts[block].fetch_add(1, Ordering::Relaxed);
            });
            assert!(counts.iter().all(|count| count.load(Ordering::Relaxed) == 1), "{ends:?}");
        }
    }
}

#[test]
fn parts_made_for_another_pool_are_run() {
    for ends in [&[][..], &[0], &[5], &[1, 2, 3], &[0, 0, 9]] {
        let runs = AtomicU32::new(0);
        let pool = ThreadPool::new(2);
        pool.wake();
        pool.run_parts(ends, |_, _| _ = runs.fetch_add(1, Ordering::Relaxed));
        assert_eq!(runs.into_inner(), ends.last().copied().unwrap_or(0));
    }
}

#[test]
fn jobs_in_quick_succession_do_not_mix() {
    let pool = ThreadPool::new(3);
    let mut values = vec![0usize; 64];
    for round in 0..20_000 {
        if round % 64 == 0 {
            pool.wake();
        }
        let cells: Vec<AtomicUsize> = values.iter().map(|v| AtomicUsize::new(*v)).collect();
        pool.run(8, |block, _| {
            for cell in &cells[block * 8..][..8] {
                cell.fetch_add(block + round, Ordering::Relaxed);
            }
        });
        values = cells.into_iter().map(AtomicUsize::into_inner).collect();
    }
    let rounds: usize = (0..20_000).sum();
    for (i, v) in values.into_iter().enumerate() {
        assert_eq!(v, rounds + 20_000 * (i / 8));
    }
}

#[test]
fn no_worker_runs_two_blocks_at_once() {
    let pool = ThreadPool::new(4);
    let inside: Vec<AtomicU32> = (0..4).map(|_| AtomicU32::new(0)).collect();
    for _ in 0..200 {
        pool.wake();
        pool.run(64, |_, worker| {
            assert_eq!(inside[worker].fetch_add(1, Ordering::SeqCst), 0);
            std::hint::black_box((0..100).sum::<u32>());
            inside[worker].fetch_sub(1, Ordering::SeqCst);
        });
    }
}

#[test]
fn clones_and_jobs_within_jobs_run_alone() {
    let pool = ThreadPool::new(2);
    pool.wake();
    let total = AtomicU32::new(0);
    pool.run(4, |_, _| {
        pool.run(5, |_, _| {
            total.fetch_add(1, Ordering::Relaxed);
        });
    });
    assert_eq!(total.load(Ordering::Relaxed), 20);
    let copy = pool.clone();
    std::thread::scope(|scope| {
        scope.spawn(|| (0..500).for_each(|_| assert_eq!(counts(&copy, 16), [1; 16])));
        (0..500).for_each(|_| assert_eq!(counts(&pool, 16), [1; 16]));
    });
}

#[test]
fn a_panic_reaches_the_caller_and_the_pool_goes_on() {
    for workers in [1, 2, 4] {
        let pool = ThreadPool::new(workers);
        for round in 0..50 {
            pool.wake();
            let result = std::panic::catch_unwind(std::panic::AssertUnwindSafe(|| {
                pool.run(16, |block, _| assert!(block != round % 16, "on purpose"));
            }));
            let said = result.unwrap_err();
            assert_eq!(said.downcast_ref::<&str>(), Some(&"on purpose"));
            assert_eq!(counts(&pool, 16), [1; 16]);
        }
    }
}

#[test]
fn threads_join_a_job_that_has_begun() {
    let pool = ThreadPool::new(2);
    let by: [AtomicU32; 2] = Default::default();
    for _ in 0..1000 {
        pool.wake();
        // Some milliseconds of work in one job.
        pool.run(20, |_, worker| {
            by[worker].fetch_add(1, Ordering::Relaxed);
            (0..30_000u32).for_each(|i| _ = std::hint::black_box(i));
        });
        if by[1].load(Ordering::Relaxed) > 0 {
            return;
        }
    }
    panic!("no thread joined: {by:?}");
}
