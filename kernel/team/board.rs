//! What caller and helpers of a team share: how blocks are posted, claimed and counted. The module above says why it holds.
#![expect(unsafe_code, reason = "threads borrow what the caller has on its stack")]

use super::sync::*;
use core::any::Any;
use core::ops::Range;
use core::sync::atomic::Ordering;
use std::sync::PoisonError;

/// What caller and helpers share.
#[derive(Debug, Default)]
pub(super) struct Board {
    /// One desk per member: its unclaimed blocks and the job they belong to.
    desks: Box<[Desk]>,
    /// How many blocks each member has done in its life, in a line of its own.
    done: Box<[Apart<AtomicU32>]>,
    caller: Apart<Caller>,
    /// Whether each helper sleeps. The waking thread clears the flag before it unparks the helper.
    asleep: Box<[AtomicBool]>,
    /// Number of helpers that are awake or about to be woken.
    awake: AtomicU32,
    /// Whether helpers are to sleep without looking for more work.
    rests: AtomicBool,
    /// What the first block that panicked in a helper said.
    panic: Apart<Mutex<Option<Box<dyn Any + Send>>>>,
    quit: AtomicBool,
}

/// What the caller writes with every stage.
#[derive(Debug, Default)]
struct Caller {
    /// Whether some clone of the team is at work.
    busy: AtomicBool,
    /// What the counts of blocks done sum up to when all so far are.
    posted: AtomicU32,
}

/// In cache lines of its own: processors fetch two at a time.
#[derive(Debug, Default)]
#[repr(align(128))]
struct Apart<T>(T);

/// Where a member learns what there is to do: it looks at one cache line, and at others' only when that has no more.
#[derive(Debug, Default)]
#[repr(align(128))]
struct Desk {
    /// Unclaimed blocks of this member's part.
    claims: Claims,
    /// The job. The caller writes it only while no block is unfinished; a member reads it only while its claimed block is
    /// unfinished.
    job: Slot<Option<Job>>,
}

/// Consecutive blocks to be claimed: the first in the upper half, one beyond the last in the lower.
#[derive(Debug, Default)]
struct Claims(AtomicU64);

impl Claims {
    fn put(&self, blocks: Range<u32>) {
        self.0.store(u64::from(blocks.start) << 32 | u64::from(blocks.end), Ordering::Release);
    }

    /// Claims one block exclusively: the owner of the part takes the first, other members take the last.
    #[inline]
    fn take(&self, is_own: bool) -> Option<u32> {
        let mut claims = self.0.load(Ordering::Acquire);
        loop {
            let (start, end) = ((claims >> 32) as u32, claims as u32);
            if start >= end {
                return None;
            }
            let (block, rest) = if is_own { (start, claims + (1 << 32)) } else { (end - 1, claims - 1) };
            // If it succeeds the board is as it was seen, were it another job's by now.
            match self.0.compare_exchange_weak(claims, rest, Ordering::AcqRel, Ordering::Acquire) {
                Ok(_) => return Some(block),
                Err(now) => claims = now,
            }
        }
    }

    /// Withdraws all unclaimed blocks. Returns their number.
    fn close(&self) -> u32 {
        let claims = self.0.swap(0, Ordering::AcqRel);
        (claims as u32).saturating_sub((claims >> 32) as u32)
    }
}

/// A closure on the caller's stack.
#[derive(Clone, Copy, Debug)]
struct Job {
    data: *const (),
    /// # Safety
    /// The first argument must be `data`, and the closure must still be there.
    run: unsafe fn(*const (), u32, usize),
}

// SAFETY: `job` is only accessed as its comment says, which the claims see to; what it points to is `Sync`.
unsafe impl Sync for Board {}
// SAFETY: as above; the pointers in `job` are of no thread.
unsafe impl Send for Board {}

impl Board {
    /// A board for so many, the caller among them. All helpers sleep.
    pub(super) fn new(members: usize) -> Self {
        Self {
            asleep: (1..members).map(|_| AtomicBool::new(true)).collect(),
            desks: (0..members).map(|_| Desk::default()).collect(),
            done: (0..members).map(|_| Apart::default()).collect(),
            ..Self::default()
        }
    }

    /// Takes back that helpers are to rest.
    pub(super) fn resume(&self) {
        self.rests.store(false, Ordering::Relaxed);
    }

    /// Says that a helper, from 0, sleeps no more. Returns whether it did: then it is to be unparked.
    pub(super) fn rouse(&self, helper: usize) -> bool {
        let asleep = &self.asleep[helper];
        if !asleep.load(Ordering::Relaxed) {
            return false;
        }
        // Before the helper may know, so that the count never falls below 0.
        self.awake.fetch_add(1, Ordering::Relaxed);
        let slept = asleep.swap(false, Ordering::AcqRel);
        if !slept {
            self.awake.fetch_sub(1, Ordering::Relaxed);
        }
        slept
    }

    /// Has helpers sleep without looking for more work.
    pub(super) fn rest(&self) {
        self.rests.store(true, Ordering::Relaxed);
    }

    /// Has helpers return. They are to be unparked.
    pub(super) fn quit(&self) {
        self.quit.store(true, Ordering::Release);
    }

    /// Whether there may be somebody to share with.
    pub(super) fn is_anyone_awake(&self) -> bool {
        self.awake.load(Ordering::Relaxed) > 0
    }

    fn panic(&self) -> MutexGuard<'_, Option<Box<dyn Any + Send>>> {
        self.panic.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the board, unless a clone of the team or a job that runs jobs has it.
    pub(super) fn begin(&self) -> Option<Ours<'_>> {
        let busy = &self.caller.0.busy;
        busy.compare_exchange(false, true, Ordering::Acquire, Ordering::Relaxed).ok().map(|_| Ours(self))
    }

    /// Puts a job up, takes part in it, and waits for its end.
    fn share<F: Fn(u32, usize) + Sync>(&self, blocks: u32, ends: impl Iterator<Item = u32>, job: &F) {
        unsafe fn run<F: Fn(u32, usize)>(data: *const (), block: u32, member: usize) {
            // SAFETY: `data` is the `F` that it was made from (see `Job::run`).
            unsafe { (*data.cast::<F>())(block, member) }
        }
        /// Waits, also when the caller's own block panics: helpers may be using its stack.
        struct Wait<'a>(&'a Board, u32);
        impl Drop for Wait<'_> {
            fn drop(&mut self) {
                let Self(board, blocks) = self;
                // Unclaimed blocks are not run after the caller panicked.
                let left = board.desks.iter().map(|desk| desk.claims.close()).sum::<u32>();
                let posted = &board.caller.0.posted;
                let all = posted.load(Ordering::Relaxed).wrapping_add(*blocks - left);
                board.wait_for(all);
                posted.store(all, Ordering::Relaxed);
            }
        }
        let posted = Job { data: core::ptr::from_ref(job).cast(), run: run::<F> };
        let _wait = Wait(self, blocks);
        let mut start = 0;
        for (desk, end) in self.desks.iter().zip(ends) {
            let end = end.clamp(start, blocks);
            // SAFETY: all blocks of the last job are done, and no block of this job can be claimed here yet.
            unsafe { desk.job.write(Some(posted)) };
            desk.claims.put(start..end);
            start = end;
        }
        while let Some((block, _)) = self.claim_own(0).or_else(|| self.claim_others(0)) {
            // Done or not, the block counts: whoever waits must not wait for ever.
            let _done = Done(self, 0);
            job(block, 0);
        }
    }

    /// Waits until the counts of blocks done sum up to this.
    fn wait_for(&self, posted: u32) {
        let mut looks = 0u32;
        while self.done.iter().fold(0, |sum: u32, done| sum.wrapping_add(done.0.load(Ordering::Acquire)))
            != posted
        {
            looks = looks.wrapping_add(1);
            pause(looks);
        }
    }

    /// Claims a block of the member's own part. Members begin with the same part in every
    /// run: what runs over the same data one after another finds it in the cache of its core.
    #[inline]
    fn claim_own(&self, member: usize) -> Option<(u32, &Desk)> {
        let desk = &self.desks[member];
        desk.claims.take(true).map(|block| (block, desk))
    }

    /// Claims a block of another member's part.
    #[inline]
    fn claim_others(&self, member: usize) -> Option<(u32, &Desk)> {
        let (before, from) = self.desks.split_at(member);
        let others = from[1..].iter().chain(before);
        others.filter_map(|desk| desk.claims.take(false).map(|block| (block, desk))).next()
    }

    /// What a helper does with its life.
    pub(super) fn help(&self, member: usize) {
        let asleep = &self.asleep[member - 1];
        while !self.quit.load(Ordering::Acquire) {
            // Awake by chance or by a call that is over: only what is said counts.
            if asleep.load(Ordering::Acquire) {
                park();
                continue;
            }
            self.work(member);
            self.awake.fetch_sub(1, Ordering::Relaxed);
            asleep.store(true, Ordering::Release);
        }
    }

    /// Claims and runs blocks until there have been none for some time.
    fn work(&self, member: usize) {
        let mut idle = Idle::default();
        loop {
            // Others' parts are looked at after one's own only: else their lines were gone whenever they look.
            let mut next = self.claim_own(member);
            while let Some((block, desk)) = next {
                self.run_block(block, desk, member);
                idle.end();
                next = self.claim_own(member).or_else(|| self.claim_others(member));
            }
            match idle.look() {
                Next::Look => {}
                Next::Ask if !self.is_over() => {}
                _ => return,
            }
        }
    }

    /// Whether helpers are to stop looking for work.
    fn is_over(&self) -> bool {
        self.rests.load(Ordering::Relaxed) || self.quit.load(Ordering::Relaxed)
    }
}

impl Board {
    /// Runs a block that a helper has claimed at a desk.
    fn run_block(&self, block: u32, desk: &Desk, member: usize) {
        let _done = Done(self, member);
        // SAFETY: the member's claimed block is unfinished, so the caller does not write the job and keeps its closure alive.
        let Some(job) = (unsafe { desk.job.read() }) else { return };
        // SAFETY: as above.
        let run = || unsafe { (job.run)(job.data, block, member) };
        if let Err(panic) = std::panic::catch_unwind(core::panic::AssertUnwindSafe(run)) {
            // Dropping another could panic again, out of the block.
            core::mem::forget(self.panic().replace(panic));
        }
    }
}

/// The board, which is given back when the job ends, however it does.
pub(super) struct Ours<'a>(&'a Board);

impl Ours<'_> {
    /// Runs so many blocks, of which each member begins with those up to an end, and returns when all are done.
    ///
    /// # Panics
    /// If a block does.
    pub(super) fn share(
        self,
        blocks: u32,
        ends: impl Iterator<Item = u32>,
        job: &(impl Fn(u32, usize) + Sync),
    ) {
        self.0.share(blocks, ends, job);
        let panic = self.0.panic().take();
        drop(self);
        if let Some(panic) = panic {
            std::panic::resume_unwind(panic);
        }
    }
}

impl Drop for Ours<'_> {
    fn drop(&mut self) {
        // If the caller's own block panicked, that is what is told.
        core::mem::forget(self.0.panic().take());
        self.0.caller.0.busy.store(false, Ordering::Release);
    }
}

/// Counts a block as done when it ends, however it does.
struct Done<'a>(&'a Board, usize);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        // Nobody else writes it.
        let done = &self.0.done[self.1].0;
        done.store(done.load(Ordering::Relaxed).wrapping_add(1), Ordering::Release);
    }
}
