//! The thread pool of a step.

use bevy_ecs::prelude::*;
use kernel::thread_pool::ThreadPool;

/// Minimum number of active contacts for which threads are woken before a step. Waking a thread takes as long
/// as some hundred contacts.
const MANY_CONTACTS: usize = 1024;

/// Minimum number of colliders that left their boxes for which waking threads pays off: the threads search
/// their pairs and sweep their bodies.
const MANY_MOVERS: usize = 256;

/// Minimum number of characters for which threads are woken. Planning a character takes 10 to 50 µs.
const MANY_CHARACTERS: usize = 64;

/// The thread pool, and the [`WorkerCount`](crate::dynamics::solver::workers::WorkerCount) for which it was
/// created.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Threads {
    pub(crate) pool: ThreadPool,
    setting: Option<usize>,
    /// Number of colliders in the last search for pairs.
    movers: usize,
}

impl Threads {
    /// Wakes the threads if there are many contacts, or the last search for pairs had many colliders.
    pub(crate) fn wake(&mut self, contacts: usize, setting: usize, workers: impl FnOnce() -> usize) {
        self.wake_if(contacts >= MANY_CONTACTS || self.movers >= MANY_MOVERS, setting, workers);
    }

    /// Wakes the threads if many characters will be moved.
    pub(crate) fn wake_for_characters(
        &mut self,
        characters: usize,
        setting: usize,
        workers: impl FnOnce() -> usize,
    ) {
        self.wake_if(characters >= MANY_CHARACTERS, setting, workers);
    }

    /// Wakes the threads if there is much work. `workers` returns the number of workers for `setting`. It is
    /// called only when the setting changed, because it asks the operating system.
    fn wake_if(&mut self, many: bool, setting: usize, workers: impl FnOnce() -> usize) {
        // The pool is created when there is much work for the first time.
        if self.setting != Some(setting) && (many || self.setting.is_some()) {
            *self = Self { pool: ThreadPool::new(workers()), setting: Some(setting), movers: self.movers };
        }
        if many {
            self.pool.wake();
        }
    }

    /// Wakes the threads if the next search for pairs has many colliders.
    pub(crate) fn wake_for_pairs(&mut self, movers: usize) {
        self.movers = movers;
        if movers >= MANY_MOVERS {
            self.pool.wake();
        }
    }
}
