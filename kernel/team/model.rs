//! The team under loom, which runs each model with the threads interleaved in every way, up to a number of preemptions, and
//! lets loads see every value that they may. It finds what is not ordered: cells, deadlocks, loops without end.

#![expect(unsafe_code, reason = "cells whose use loom checks")]

use super::Team;
use super::sync::Slot;
use loom::{cell::UnsafeCell, model::Builder};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;

/// Tries a model with up to so many preemptions: most mistakes show with two.
fn model(preemptions: usize, f: impl Fn() + Sync + Send + 'static) {
    let mut builder = Builder::new();
    builder.preemption_bound = Some(preemptions);
    builder.max_branches = 20_000;
    builder.check(f);
}

/// What blocks write, each its own, without any order of their own making.
#[derive(Default)]
struct Cells([UnsafeCell<u32>; 3]);

// SAFETY: loom panics where two threads use a cell at once.
unsafe impl Sync for Cells {}

impl Cells {
    fn add(&self, block: usize) {
        // SAFETY: as above.
        self.0[block].with_mut(|count| unsafe { *count += 1 });
    }

    /// What the caller sees when a job is over.
    fn are(&self, wanted: &[u32]) {
        for (cell, wanted) in self.0.iter().zip(wanted) {
            // SAFETY: as above.
            cell.with(|count| assert_eq!(unsafe { *count }, *wanted));
        }
    }
}

/// Every block is run once, whoever claims it, and the caller sees what it did. The cells die with each job.
#[test]
fn blocks_run_once_and_are_seen() {
    model(3, || {
        let team = Team::new(2);
        team.wake();
        for blocks in [3, 2] {
            let cells = Cells::default();
            team.run(blocks, |block, _| cells.add(block));
            cells.are(&[1, 1, u32::from(blocks == 3)]);
        }
    });
}

/// With two helpers, who also claim from each other.
#[test]
fn helpers_claim_from_each_other() {
    model(2, || {
        let team = Team::new(3);
        team.wake();
        let cells = Cells::default();
        // All blocks are the first helper's to begin with.
        team.run_parts(&[0, 3, 3], |block, _| cells.add(block));
        cells.are(&[1, 1, 1]);
    });
}

/// A helper that was roused works and falls asleep again, and can be roused again: no call is lost between its last look and
/// its sleep. Were one, the helper would count as awake for ever.
#[test]
fn no_call_is_lost() {
    model(3, || {
        let team = Team::new(2);
        for _ in 0..2 {
            team.wake();
            let board = &team.0.as_ref().expect("it has a helper").board;
            while board.is_anyone_awake() {
                loom::thread::yield_now();
            }
        }
    });
}

/// Helpers end with the team, whether they sleep, work, or are about to do either.
#[test]
fn helpers_end_with_the_team() {
    for calls in 0..3 {
        model(3, move || {
            let team = Team::new(2);
            (0..calls).for_each(|_| team.wake());
            if calls == 2 {
                team.rest();
            }
        });
    }
}

/// A block that panics counts as done, whoever has it: the caller hears of it, when nobody runs the job any more.
#[test]
fn a_panic_reaches_the_caller() {
    model(2, || {
        let team = Team::new(2);
        team.wake();
        let cells = Cells::default();
        let result = catch_unwind(AssertUnwindSafe(|| {
            team.run(2, |block, _| {
                cells.add(block);
                if block == 1 {
                    resume_unwind(Box::new("on purpose"));
                }
            });
        }));
        assert_eq!(result.unwrap_err().downcast_ref::<&str>(), Some(&"on purpose"));
        cells.are(&[1, 1]);
        let cells = Cells::default();
        team.run(2, |block, _| cells.add(block));
        cells.are(&[1, 1]);
    });
}

/// Two callers share helpers: who comes second runs its blocks alone.
#[test]
fn clones_do_not_mix() {
    model(2, || {
        let team = Team::new(2);
        team.wake();
        let clone = team.clone();
        let run = |team: &Team| {
            let cells = Cells::default();
            team.run(2, |block, _| cells.add(block));
            cells.are(&[1, 1]);
        };
        let other = loom::thread::spawn(move || run(&clone));
        run(&team);
        other.join().expect("it did not panic");
    });
}

/// That loom would find a slot that is written while another thread reads it: the model is not blind.
#[test]
#[should_panic(expected = "Causality violation")]
fn a_race_is_found() {
    model(2, || {
        let slot = Arc::new(Slot::<Option<u32>>::default());
        let theirs = Shared(Arc::clone(&slot));
        let other = loom::thread::spawn(move || theirs.write());
        // SAFETY: it is not, which is the point.
        let _ = unsafe { slot.read() };
        let _ = other.join();
    });
}

/// A slot that another thread has.
struct Shared(Arc<Slot<Option<u32>>>);

impl Shared {
    fn write(self) {
        // SAFETY: it is not, which is the point.
        unsafe { self.0.write(Some(1)) };
    }
}
