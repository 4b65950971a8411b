//! The division of constraints among workers.

use super::input::RowInput;
use crate::graph::ColorGraph;

/// Minimum number of constraints per worker for which workers share a stage. With fewer, the stage is over
/// before another core begins.
const WORTH_SHARING: usize = 256;

/// The work estimate samples one in this many bodies.
const SAMPLE: usize = 16;

/// Assigns constraints of shared stages to workers: each worker solves the constraints of the bodies in its
/// range of rows.
///
/// A body then mostly stays with one worker, and in the cache of its core, through all sweeps of a step.
/// Otherwise another core would often have written it last, and loading it would take longer than solving
/// the constraint. Results do not depend on the division.
#[derive(Clone, Debug)]
pub(super) struct Partition {
    workers: usize,
    /// Minimum number of constraints per worker for which workers share a stage.
    pub(super) worth: usize,
    first_dynamic: u32,
    /// The first row of each worker except worker 0, ascending.
    bounds: Vec<u32>,
}

impl Default for Partition {
    fn default() -> Self {
        Self { workers: 1, worth: WORTH_SHARING, first_dynamic: 0, bounds: Vec::new() }
    }
}

impl Partition {
    /// Divides the rows of dynamic bodies so that workers get about the same number of constraints.
    pub(super) fn divide(
        &mut self,
        workers: usize,
        first_dynamic: u32,
        input: &RowInput,
        colors: &ColorGraph,
    ) {
        debug_assert!(workers > 0, "the caller is a worker");
        (self.workers, self.first_dynamic) = (workers, first_dynamic);
        self.bounds.clear();
        if workers == 1 {
            return;
        }
        // Each body also costs an integration.
        let work = |id: u32| u64::from(1 + colors.colors_of(id).count_ones());
        let sample = || input.bodies.awake_dynamic().step_by(SAMPLE);
        let all = sample().map(work).sum::<u64>();
        let mut before = 0;
        for id in sample() {
            let row = input.row_of(id);
            while (self.bounds.len() as u64 + 1) * all <= before * workers as u64 {
                self.bounds.push(row);
            }
            before += work(id);
        }
    }

    /// The number of parts of a stage.
    pub(super) fn parts(&self, constraints: usize) -> usize {
        (constraints / self.worth.max(1)).clamp(1, self.workers)
    }

    /// The part of a constraint between two body rows. If the rows belong to two workers, the id decides.
    #[inline(always)]
    pub(super) fn part(&self, [a, b]: [u32; 2], id: u32, parts: usize) -> usize {
        debug_assert!(parts <= self.workers, "{parts} parts for {} workers", self.workers);
        let row = match (a >= self.first_dynamic, b >= self.first_dynamic) {
            (false, false) => return 0,
            (true, false) => a,
            (false, true) => b,
            (true, true) => [a, b][id as usize % 2],
        };
        let worker = self.bounds.iter().filter(|bound| **bound <= row).count();
        worker * parts / self.workers
    }

    /// The part whose first block a worker begins with; `None` for the second worker of a part, if there
    /// are fewer parts than workers.
    pub(super) fn of_worker(&self, worker: usize, parts: usize) -> Option<usize> {
        debug_assert!(worker < self.workers, "worker {worker} of {}", self.workers);
        let part = worker * parts / self.workers;
        (worker == 0 || part > (worker - 1) * parts / self.workers).then_some(part)
    }

    /// The number of workers.
    pub(super) fn workers(&self) -> usize {
        self.workers
    }
}
