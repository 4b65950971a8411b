//! The pool under loom. Loom runs each model with all interleavings up to a number of preemptions, and lets
//! loads return every value that they may return. It finds unordered accesses to cells, deadlocks, and
//! endless loops.

#![expect(unsafe_code, reason = "cells whose use loom checks")]

use super::ThreadPool;
use super::sync::SharedCell;
use loom::{cell::UnsafeCell, model::Builder};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;

/// Checks a model with up to a number of preemptions. Most mistakes show with two preemptions.
fn model(preemptions: usize, f: impl Fn() + Sync + Send + 'static) {
    let mut builder = Builder::new();
    builder.preemption_bound = Some(preemptions);
    builder.max_branches = 20_000;
    builder.check(f);
}

/// Cells that blocks write, each block its own cell, without any synchronisation.
#[derive(Default)]
struct Cells([UnsafeCell<u32>; 3]);

// SAFETY: loom panics where two threads use a cell at once.
unsafe impl Sync for Cells {}

impl Cells {
    fn add(&self, block: usize) {
        // SAFETY: as above.
        self.0[block].with_mut(|count| unsafe { *count += 1 });
    }

    /// Asserts the values that the caller sees after a job.
    fn are(&self, wanted: &[u32]) {
        for (cell, wanted) in self.0.iter().zip(wanted) {
            // SAFETY: as above.
            cell.with(|count| assert_eq!(unsafe { *count }, *wanted));
        }
    }
}

/// Every block runs once, and the caller sees its writes. The cells are dropped after each job.
#[test]
fn blocks_run_once_and_are_seen() {
    model(3, || {
        let pool = ThreadPool::new(2);
        pool.wake();
        for blocks in [3, 2] {
            let cells = Cells::default();
            pool.run(blocks, |block, _| cells.add(block));
            cells.are(&[1, 1, u32::from(blocks == 3)]);
        }
    });
}

/// Two threads also claim blocks from each other.
#[test]
fn threads_claim_from_each_other() {
    model(2, || {
        let pool = ThreadPool::new(3);
        pool.wake();
        let cells = Cells::default();
        // All blocks start in the queue of the first thread.
        pool.run_parts(&[0, 3, 3], |block, _| cells.add(block));
        cells.are(&[1, 1, 1]);
    });
}

/// A woken thread parks again, and can be woken again: no wake-up is lost between its last round and its
/// parking. After a lost wake-up the thread would count as awake for ever.
#[test]
fn no_wake_up_is_lost() {
    model(3, || {
        let pool = ThreadPool::new(2);
        for _ in 0..2 {
            pool.wake();
            let state = &pool.0.as_ref().expect("it has a thread").state;
            while state.is_any_awake() {
                loom::thread::yield_now();
            }
        }
    });
}

/// Threads end with the pool, whether they are parked, work, or are about to park or work.
#[test]
fn threads_end_with_the_pool() {
    for calls in 0..3 {
        model(3, move || {
            let pool = ThreadPool::new(2);
            (0..calls).for_each(|_| pool.wake());
            if calls == 2 {
                pool.rest();
            }
        });
    }
}

/// A block that panics counts as finished. The caller gets the panic after all threads have left the job.
#[test]
fn a_panic_reaches_the_caller() {
    model(2, || {
        let pool = ThreadPool::new(2);
        pool.wake();
        let cells = Cells::default();
        let result = catch_unwind(AssertUnwindSafe(|| {
            pool.run(2, |block, _| {
                cells.add(block);
                if block == 1 {
                    resume_unwind(Box::new("on purpose"));
                }
            });
        }));
        assert_eq!(result.unwrap_err().downcast_ref::<&str>(), Some(&"on purpose"));
        cells.are(&[1, 1]);
        let cells = Cells::default();
        pool.run(2, |block, _| cells.add(block));
        cells.are(&[1, 1]);
    });
}

/// Two callers share the threads. The second caller runs its blocks alone.
#[test]
fn clones_do_not_mix() {
    model(2, || {
        let pool = ThreadPool::new(2);
        pool.wake();
        let clone = pool.clone();
        let run = |pool: &ThreadPool| {
            let cells = Cells::default();
            pool.run(2, |block, _| cells.add(block));
            cells.are(&[1, 1]);
        };
        let other = loom::thread::spawn(move || run(&clone));
        run(&pool);
        other.join().expect("it did not panic");
    });
}

/// Loom finds a cell that is written while another thread reads it.
#[test]
#[should_panic(expected = "Causality violation")]
fn a_race_is_found() {
    model(2, || {
        let cell = Arc::new(SharedCell::<Option<u32>>::default());
        let theirs = Shared(Arc::clone(&cell));
        let other = loom::thread::spawn(move || theirs.write());
        // SAFETY: it is unsafe on purpose.
        let _ = unsafe { cell.read() };
        let _ = other.join();
    });
}

/// A cell that another thread shares.
struct Shared(Arc<SharedCell<Option<u32>>>);

impl Shared {
    fn write(self) {
        // SAFETY: it is unsafe on purpose.
        unsafe { self.0.write(Some(1)) };
    }
}
