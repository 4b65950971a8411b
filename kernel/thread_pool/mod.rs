//! The kernel's thread pool. A stage of a step is divided into blocks, and each worker has a queue with a
//! range of them. Workers that finish their queue claim blocks from the queues of others.
//!
//! # The protocol
//!
//! A *job* is one closure and its blocks. *Workers* are the calling thread, number 0, and the threads of the
//! pool. They share these words (`state.rs`), and only the named threads write them:
//!
//! - `busy`: a caller runs a job. Written by the caller that changes it from false to true, until that caller
//!   stores false.
//! - `queue.job`: the closure, as a pointer. Written by the caller that runs the job.
//! - `queue.blocks`: unclaimed blocks, the first and one beyond the last. The caller fills it while it is
//!   empty, all workers claim from it, and a caller that panics drains it.
//! - `finished[w]`: number of blocks that worker w has finished in its life. Written by worker w.
//! - `issued`: the sum of all `finished` after the last job. Written by the caller that runs the job.
//! - `parked[t]`: thread t waits for a wake-up. Thread t stores true, the thread that wakes it swaps it to
//!   false.
//! - `awake`: number of threads that were woken. A waking thread adds 1, the woken thread subtracts 1.
//! - `stop_spinning`: threads must park at once, and no job wakes them. Written by callers.
//! - `quit`: threads must end. Written by [`Drop`].
//!
//! **States of a thread.** *Parked*: `parked[t]` is true. *Awake*: it looks for blocks until it has found
//! none for some time or `stop_spinning` is set. *Ended*: it has read `quit`.
//!
//! **One caller.** `busy` changes from false to true by a compare-exchange with Acquire and back by a store
//! with Release: a caller sees all writes of the previous caller, and two callers never issue jobs at once. A
//! caller that finds the pool busy runs its blocks alone.
//!
//! **A block has one runner.** Both ends of a queue's unclaimed blocks are one 64-bit word, and a claim is a
//! compare-exchange on it: of two claims of one block the second fails. The word may change to another value
//! and back in between, even by another job. This is harmless, since its content is true when the exchange
//! succeeds.
//!
//! **A runner sees its job.** The caller writes `queue.job`, then stores `queue.blocks` with Release. Claims
//! are exchanged with Acquire. They are read-modify-writes, so a claim after other claims still belongs to
//! the release sequence of that store, and the claimer sees the job and all earlier writes of the caller.
//!
//! **The caller sees every block.** A worker adds to `finished[w]` by a store with Release after its block,
//! also if the block panics. The caller loads all counts with Acquire until their sum is `issued` plus the
//! job's blocks. No count falls, and the sum never exceeds the number of issued blocks. So an old value can
//! only make the sum too small, and when the sum fits, all blocks are finished and their writes are seen.
//!
//! **The closure outlives its use.** It is on the caller's stack, and a thread calls it only for a block that
//! the thread has claimed and not yet counted. The caller does not return or unwind before the counts fit:
//! the wait is the destructor of a value that lives from before blocks are issued. If a block of the caller
//! panics, the destructor first drains the queues, then waits for the remaining blocks. So between two jobs
//! no queue has blocks and no thread reads `job`, and the next caller may write it. A panic in a pool thread
//! is caught, kept, and thrown again by the caller.
//!
//! **No wake-up is lost.** To wake a thread is to swap `parked[t]` from true to false and then to unpark the
//! thread. The thread parks only after it has read true, and reads again whenever park returns. Either it
//! reads false and does not park, or the swap comes after its read. Then the unpark comes after the read,
//! too: it ends the park, or makes the next park return at once. A wake-up of a thread that is about to store
//! true finds it awake and does nothing. The thread may then park while there is work, and the others run its
//! blocks, since a caller waits for blocks and not for threads. [`Drop`] stores `quit` and unparks: by the
//! same argument each thread reads it.
//!
//! **Relaxed.** `awake`, `stop_spinning` and the first load of `parked[t]` only decide whether sharing or
//! looking for blocks is worthwhile. `awake` is raised before the swap that lets the thread lower it.
//! `issued` is only used by the caller that runs the job.
//!
//! `tools/model-check.sh` checks all of this with loom for two and three workers (`model.rs`), and runs the
//! tests under ThreadSanitizer if it is available.

#[cfg(all(loom, test))]
mod model;
mod state;
mod sync;
#[cfg(all(not(loom), test))]
mod tests;

use core::sync::atomic::{AtomicU64, Ordering};
use state::State;
use std::sync::{Arc, OnceLock, PoisonError};
use sync::{Builder, JoinHandle, Mutex};

/// A thread pool: the calling thread and the pool's threads run the blocks of one job at a time.
///
/// Blocks must not depend on the order in which they run, nor on the worker that runs them. Then the result
/// does not depend on the number of workers.
///
/// Clones share the threads. While one clone runs a job, another runs its blocks alone. The threads end with
/// the last clone.
#[derive(Clone, Debug, Default)]
pub struct ThreadPool(Option<Arc<Threads>>);

/// Returns the time in nanoseconds since a fixed moment. The kernel has no clock of its own.
pub type Clock = fn() -> u64;

/// The threads of a pool. They end when this value is dropped.
#[derive(Debug)]
struct Threads {
    state: Arc<State>,
    handles: Vec<JoinHandle<()>>,
    /// The clock if the time of shared jobs is measured, followed by the measured time.
    clock: OnceLock<Clock>,
    shared: AtomicU64,
}

impl ThreadPool {
    /// A pool of `workers`, including the caller: with 1 or 0 there are no threads. If the system refuses a
    /// thread, the pool is smaller.
    pub fn new(workers: usize) -> Self {
        let state = Arc::new(State::new(workers));
        let handles: Vec<_> = (1..workers)
            .map_while(|worker| {
                let state = Arc::clone(&state);
                let name = format!("physics {worker}");
                Builder::new().name(name).spawn(move || state.run_thread(worker)).ok()
            })
            .collect();
        if handles.is_empty() {
            return Self(None);
        }
        let (clock, shared) = (OnceLock::new(), AtomicU64::new(0));
        Self(Some(Arc::new(Threads { state, handles, clock, shared })))
    }

    /// The number of workers, including the caller.
    pub fn workers(&self) -> usize {
        1 + self.0.as_ref().map_or(0, |threads| threads.handles.len())
    }

    /// Wakes the threads, which then look for work for a short while. If all have parked, the next job wakes
    /// them again, until [`rest`](Self::rest) is called: call it at the end of a step. Call `wake` before
    /// much work; without it the caller runs its blocks alone.
    pub fn wake(&self) {
        let Some(threads) = &self.0 else { return };
        threads.state.resume();
        for (thread, handle) in threads.handles.iter().enumerate() {
            if threads.state.clear_parked(thread) {
                handle.thread().unpark();
            }
        }
    }

    /// Parks the threads, which clones share, as soon as they have no block: other programs may need their
    /// cores.
    pub fn rest(&self) {
        if let Some(threads) = &self.0 {
            threads.state.stop_spinning();
        }
    }

    /// Measures the time of shared jobs from now on. Each job then costs two calls of the clock.
    pub fn count_shared_time(&self, clock: Clock) {
        if let Some(threads) = &self.0 {
            threads.clock.get_or_init(|| clock);
        }
    }

    /// The nanoseconds in which callers shared jobs with threads, since the measurement began. All other time
    /// is spent in one thread, with any number of workers.
    pub fn shared_time(&self) -> u64 {
        self.0.as_ref().map_or(0, |threads| threads.shared.load(Ordering::Relaxed))
    }

    /// Runs `job(block, worker)` for every block below `blocks`, and returns when all are finished. The
    /// caller is worker 0. A worker runs one block at a time.
    ///
    /// # Panics
    /// If a block panics.
    pub fn run(&self, blocks: usize, job: impl Fn(usize, usize) + Sync) {
        let count = u32::try_from(blocks).expect("a block is many bytes of memory");
        let workers = self.workers() as u64;
        self.run_shares(count, (1..=workers).map(|k| (u64::from(count) * k / workers) as u32), job);
    }

    /// As [`run`](Self::run) for the blocks below the last of `ends`, where the queue of worker `k` gets the
    /// blocks from `ends[k - 1]` to `ends[k]`. Workers with an empty queue do not take part. `ends` whose
    /// length is not the number of workers belong to another pool and are ignored.
    ///
    /// # Panics
    /// If a block panics.
    pub fn run_parts(&self, ends: &[u32], job: impl Fn(usize, usize) + Sync) {
        let blocks = ends.last().copied().unwrap_or(0);
        debug_assert!(ends.is_sorted(), "parts follow one another: {ends:?}");
        if ends.len() != self.workers() {
            return self.run(blocks as usize, job);
        }
        self.run_shares(blocks, ends.iter().copied(), job);
    }

    /// Runs the blocks below `blocks`. The queue of each worker gets the blocks up to its end.
    fn run_shares(&self, blocks: u32, ends: impl Iterator<Item = u32>, job: impl Fn(usize, usize) + Sync) {
        let state = self.0.as_ref().filter(|_| blocks > 1).map(|threads| &*threads.state);
        // All threads have parked if a single-threaded stage took long.
        if state.is_some_and(|state| state.is_working() && !state.is_any_awake()) {
            self.wake();
        }
        let shared = state.filter(|state| state.is_any_awake()).and_then(State::try_begin);
        match shared {
            Some(guard) => {
                let timed = self.0.as_ref().and_then(|threads| Some((threads, threads.clock.get()?)));
                let timed = timed.map(|(threads, clock)| (threads, clock, clock()));
                guard.run(blocks, ends, &|block, worker| job(block as usize, worker));
                if let Some((threads, clock, start)) = timed {
                    threads.shared.fetch_add(clock().saturating_sub(start), Ordering::Relaxed);
                }
            }
            None => (0..blocks as usize).for_each(|block| job(block, 0)),
        }
    }
}

impl ThreadPool {
    /// Runs `job` for each of some items. The worker of each item is not determined.
    ///
    /// # Panics
    /// If a job or the iterator panics.
    pub fn each<I: Iterator + Send>(&self, items: I, job: impl Fn(I::Item) + Sync) {
        self.each_into(&mut vec![(); self.workers()], items, |(), item| job(item));
    }

    /// As [`each`](Self::each), where each worker adds to its own result. `results` is extended to the number
    /// of workers; their order is not determined.
    ///
    /// # Panics
    /// If a job or the iterator panics.
    pub fn each_into<I: Iterator + Send, R: Default + Send>(
        &self,
        results: &mut Vec<R>,
        items: I,
        job: impl Fn(&mut R, I::Item) + Sync,
    ) {
        results.resize_with(results.len().max(self.workers()), R::default);
        let (items, results) = (Mutex::new(items), Mutex::new(results.iter_mut()));
        self.run(self.workers(), |_, _| {
            let Some(result) = locked(&results).next() else { return };
            loop {
                let item = locked(&items).next();
                let Some(item) = item else { return };
                job(result, item);
            }
        });
    }
}

/// The value that a mutex guards, also after another thread panicked.
fn locked<T>(mutex: &Mutex<T>) -> sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Drop for Threads {
    fn drop(&mut self) {
        self.state.quit();
        for handle in self.handles.drain(..) {
            handle.thread().unpark();
            // A thread panics only within a block, and that panic is caught.
            let _ = handle.join();
        }
    }
}
