//! The thread pool of a step.

use bevy_ecs::prelude::*;
use kernel::thread_pool::ThreadPool;

/// Minimum number of active contacts for which threads are woken before a step: waking one takes as long as some hundred
/// contacts.
const MANY_CONTACTS: usize = 1024;

/// The thread pool, and the [`WorkerCount`](crate::dynamics::solver::workers::WorkerCount) it was made for.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Threads {
    pub(crate) pool: ThreadPool,
    setting: Option<usize>,
}

impl Threads {
    /// Wakes the threads if there are many contacts. `workers` returns the number of workers that `setting` stands for. It
    /// is called only when the setting changed, since it asks the operating system.
    pub(crate) fn wake(&mut self, contacts: usize, setting: usize, workers: impl FnOnce() -> usize) {
        let many = contacts >= MANY_CONTACTS;
        // There is no pool before there are many contacts for the first time.
        if self.setting != Some(setting) && (many || self.setting.is_some()) {
            *self = Self { pool: ThreadPool::new(workers()), setting: Some(setting) };
        }
        if many {
            self.pool.wake();
        }
    }
}
