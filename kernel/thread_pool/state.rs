//! The state that the workers of a pool share: how blocks are issued, claimed and counted. The module above
//! proves it.
#![expect(unsafe_code, reason = "threads borrow a closure from the caller's stack")]

use super::sync::*;
use core::any::Any;
use core::ops::Range;
use core::sync::atomic::Ordering;
use std::sync::PoisonError;

/// The state that the workers of a pool share.
#[derive(Debug, Default)]
pub(super) struct State {
    /// One queue per worker: its unclaimed blocks and the job they belong to.
    queues: Box<[WorkerQueue]>,
    /// The number of blocks that each worker has finished in its life.
    finished: Box<[CachePadded<AtomicU32>]>,
    caller: CachePadded<Caller>,
    /// Whether each thread is parked. The waking thread clears the flag before it unparks the thread.
    parked: Box<[AtomicBool]>,
    /// The number of threads that are awake or about to be woken.
    awake: AtomicU32,
    /// Whether threads without a block park at once, and no job wakes them.
    stop_spinning: AtomicBool,
    /// The payload of the first block that panicked in a thread.
    panic: CachePadded<Mutex<Option<Box<dyn Any + Send>>>>,
    quit: AtomicBool,
}

/// The values that the caller writes with every job.
#[derive(Debug, Default)]
struct Caller {
    /// Whether a clone of the pool runs a job.
    busy: AtomicBool,
    /// The sum of `finished` after all jobs so far.
    issued: AtomicU32,
}

/// A value in its own cache lines. Processors fetch pairs of lines, hence 128 bytes.
#[derive(Debug, Default)]
#[repr(align(128))]
struct CachePadded<T>(T);

/// The blocks of one worker, in their own cache lines. Other workers read them only when their own queue is
/// empty.
#[derive(Debug, Default)]
#[repr(align(128))]
struct WorkerQueue {
    /// Unclaimed blocks.
    blocks: BlockRange,
    /// The job. The caller writes it only while no block is unfinished; a worker reads it only while its
    /// claimed block is unfinished.
    job: SharedCell<Option<Job>>,
}

/// Consecutive unclaimed blocks: the first block in the upper half, one beyond the last block in the lower
/// half.
#[derive(Debug, Default)]
struct BlockRange(AtomicU64);

impl BlockRange {
    fn fill(&self, blocks: Range<u32>) {
        self.0.store(u64::from(blocks.start) << 32 | u64::from(blocks.end), Ordering::Release);
    }

    /// Claims one block exclusively: the owner of the queue takes the first block, other workers take the
    /// last.
    #[inline]
    fn claim(&self, is_own: bool) -> Option<u32> {
        let mut range = self.0.load(Ordering::Acquire);
        loop {
            let (start, end) = ((range >> 32) as u32, range as u32);
            if start >= end {
                return None;
            }
            let (block, rest) = if is_own { (start, range + (1 << 32)) } else { (end - 1, range - 1) };
            // On success the queue contains the range that was read, even if the range belongs to another job
            // by now.
            match self.0.compare_exchange_weak(range, rest, Ordering::AcqRel, Ordering::Acquire) {
                Ok(_) => return Some(block),
                Err(now) => range = now,
            }
        }
    }

    /// Removes all unclaimed blocks. Returns their number.
    fn drain(&self) -> u32 {
        let range = self.0.swap(0, Ordering::AcqRel);
        (range as u32).saturating_sub((range >> 32) as u32)
    }
}

/// A closure on the caller's stack.
#[derive(Clone, Copy, Debug)]
struct Job {
    data: *const (),
    /// # Safety
    /// The first argument must be `data`, and the closure must be alive.
    run: unsafe fn(*const (), u32, usize),
}

// SAFETY: claims restrict the access to `job` as its comment says, and the closure that it points to is
// `Sync`.
unsafe impl Sync for State {}
// SAFETY: as above. Raw pointers carry no thread affinity; the caller keeps the closure alive until all
// blocks finish.
unsafe impl Send for State {}

impl State {
    /// The state of a pool of `workers`, including the caller. All threads are parked.
    pub(super) fn new(workers: usize) -> Self {
        Self {
            parked: (1..workers).map(|_| AtomicBool::new(true)).collect(),
            queues: (0..workers).map(|_| WorkerQueue::default()).collect(),
            finished: (0..workers).map(|_| CachePadded::default()).collect(),
            stop_spinning: AtomicBool::new(true),
            ..Self::default()
        }
    }

    /// Reverts [`stop_spinning`](Self::stop_spinning).
    pub(super) fn resume(&self) {
        self.stop_spinning.store(false, Ordering::Relaxed);
    }

    /// Marks a thread, counted from 0, as not parked. Returns whether it was parked; the caller must then
    /// unpark it.
    pub(super) fn clear_parked(&self, thread: usize) -> bool {
        let parked = &self.parked[thread];
        if !parked.load(Ordering::Relaxed) {
            return false;
        }
        // Incremented before the swap, which lets the thread subtract, so the count never falls below 0.
        self.awake.fetch_add(1, Ordering::Relaxed);
        let was_parked = parked.swap(false, Ordering::AcqRel);
        if !was_parked {
            self.awake.fetch_sub(1, Ordering::Relaxed);
        }
        was_parked
    }

    /// Lets threads park as soon as they have no block.
    pub(super) fn stop_spinning(&self) {
        self.stop_spinning.store(true, Ordering::Relaxed);
    }

    /// Whether threads look for blocks and were not told to stop.
    pub(super) fn is_working(&self) -> bool {
        !self.stop_spinning.load(Ordering::Relaxed)
    }

    /// Lets threads return. The caller must unpark them.
    pub(super) fn quit(&self) {
        self.quit.store(true, Ordering::Release);
    }

    /// Whether a thread may be available to share blocks with.
    pub(super) fn is_any_awake(&self) -> bool {
        self.awake.load(Ordering::Relaxed) > 0
    }

    fn panic(&self) -> MutexGuard<'_, Option<Box<dyn Any + Send>>> {
        self.panic.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reserves the pool for a job, unless a clone, or an outer job, has reserved it.
    pub(super) fn try_begin(&self) -> Option<JobGuard<'_>> {
        let busy = &self.caller.0.busy;
        busy.compare_exchange(false, true, Ordering::Acquire, Ordering::Relaxed).ok().map(|_| JobGuard(self))
    }

    /// Issues a job, takes part in it, and waits for its end.
    fn run_job<F: Fn(u32, usize) + Sync>(&self, blocks: u32, ends: impl Iterator<Item = u32>, job: &F) {
        unsafe fn run<F: Fn(u32, usize)>(data: *const (), block: u32, worker: usize) {
            // SAFETY: `data` is the `F` that it was made from (see `Job::run`).
            unsafe { (*data.cast::<F>())(block, worker) }
        }
        /// Waits on drop, also if the caller's own block panics: threads may be using its stack.
        struct Wait<'a>(&'a State, u32);
        impl Drop for Wait<'_> {
            fn drop(&mut self) {
                let Self(state, blocks) = self;
                // After a panic of the caller, unclaimed blocks are not run.
                let left = state.queues.iter().map(|queue| queue.blocks.drain()).sum::<u32>();
                let issued = &state.caller.0.issued;
                let all = issued.load(Ordering::Relaxed).wrapping_add(*blocks - left);
                state.wait_for(all);
                issued.store(all, Ordering::Relaxed);
            }
        }
        let erased = Job { data: core::ptr::from_ref(job).cast(), run: run::<F> };
        let _wait = Wait(self, blocks);
        let mut start = 0;
        for (queue, end) in self.queues.iter().zip(ends) {
            let end = end.clamp(start, blocks);
            // SAFETY: all blocks of the last job are finished, and no block of this job can be claimed here
            // yet.
            unsafe { queue.job.write(Some(erased)) };
            queue.blocks.fill(start..end);
            start = end;
        }
        while let Some((block, _)) = self.claim_own(0).or_else(|| self.claim_others(0)) {
            // The block counts also if it panics, so the wait ends.
            let _count = CountFinished(self, 0);
            job(block, 0);
        }
    }

    /// Waits until the sum of all finished blocks is `issued`.
    fn wait_for(&self, issued: u32) {
        let mut rounds = 0u32;
        let sum =
            |sum: u32, count: &CachePadded<AtomicU32>| sum.wrapping_add(count.0.load(Ordering::Acquire));
        while self.finished.iter().fold(0, sum) != issued {
            rounds = rounds.wrapping_add(1);
            pause(rounds);
        }
    }

    /// Claims a block of the worker's own queue. Workers begin with the same part in every job, so data of
    /// the previous job is still in the cache of their core.
    #[inline]
    fn claim_own(&self, worker: usize) -> Option<(u32, &WorkerQueue)> {
        let queue = &self.queues[worker];
        queue.blocks.claim(true).map(|block| (block, queue))
    }

    /// Claims a block of another worker's queue.
    #[inline]
    fn claim_others(&self, worker: usize) -> Option<(u32, &WorkerQueue)> {
        let (before, from) = self.queues.split_at(worker);
        let others = from[1..].iter().chain(before);
        others.filter_map(|queue| queue.blocks.claim(false).map(|block| (block, queue))).next()
    }

    /// The main function of a pool thread.
    pub(super) fn run_thread(&self, worker: usize) {
        let parked = &self.parked[worker - 1];
        while !self.quit.load(Ordering::Acquire) {
            // `park` may return without a reason or for an old wake-up: only the flag counts.
            if parked.load(Ordering::Acquire) {
                park();
                continue;
            }
            self.work(worker);
            self.awake.fetch_sub(1, Ordering::Relaxed);
            parked.store(true, Ordering::Release);
        }
    }

    /// Claims and runs blocks until none were found for some time.
    fn work(&self, worker: usize) {
        let mut idle = IdleTimer::default();
        loop {
            // A worker reads other queues only after it has run blocks of its own: idle threads that poll
            // other queues would slow down their owners.
            let mut next = self.claim_own(worker);
            while let Some((block, queue)) = next {
                self.run_block(block, queue, worker);
                idle.reset();
                next = self.claim_own(worker).or_else(|| self.claim_others(worker));
            }
            match idle.tick() {
                Idle::Spin => {}
                Idle::Check if !self.is_over() => {}
                Idle::Check | Idle::Park => return,
            }
        }
    }

    /// Whether threads must stop looking for blocks.
    fn is_over(&self) -> bool {
        self.stop_spinning.load(Ordering::Relaxed) || self.quit.load(Ordering::Relaxed)
    }

    /// Runs a block that a thread has claimed from a queue.
    fn run_block(&self, block: u32, queue: &WorkerQueue, worker: usize) {
        let _count = CountFinished(self, worker);
        // SAFETY: the worker's claimed block is unfinished, so the caller does not write the job and keeps
        // its closure alive.
        let Some(job) = (unsafe { queue.job.read() }) else { return };
        // SAFETY: as above.
        let run = || unsafe { (job.run)(job.data, block, worker) };
        if let Err(panic) = std::panic::catch_unwind(core::panic::AssertUnwindSafe(run)) {
            // Dropping an earlier payload could panic again, outside of a block.
            core::mem::forget(self.panic().replace(panic));
        }
    }
}

/// Reserves the pool for one job, until it is dropped.
pub(super) struct JobGuard<'a>(&'a State);

impl JobGuard<'_> {
    /// Runs the blocks below `blocks`, where the queue of each worker gets the blocks up to its end. Returns
    /// when all are finished.
    ///
    /// # Panics
    /// If a block panics.
    pub(super) fn run(
        self,
        blocks: u32,
        ends: impl Iterator<Item = u32>,
        job: &(impl Fn(u32, usize) + Sync),
    ) {
        self.0.run_job(blocks, ends, job);
        let panic = self.0.panic().take();
        drop(self);
        if let Some(panic) = panic {
            std::panic::resume_unwind(panic);
        }
    }
}

impl Drop for JobGuard<'_> {
    fn drop(&mut self) {
        // If a block of the caller panicked, its payload is thrown, and payloads of threads are forgotten.
        core::mem::forget(self.0.panic().take());
        self.0.caller.0.busy.store(false, Ordering::Release);
    }
}

/// Counts a block as finished on drop, also during a panic.
struct CountFinished<'a>(&'a State, usize);

impl Drop for CountFinished<'_> {
    fn drop(&mut self) {
        // Only this worker writes its count.
        let finished = &self.0.finished[self.1].0;
        finished.store(finished.load(Ordering::Relaxed).wrapping_add(1), Ordering::Release);
    }
}
