//! The kernel's own threads. A stage of a step is cut into blocks, a part of them for each member; who is awake and done
//! with its own claims those of others.
#![expect(unsafe_code, reason = "threads borrow what the caller has on its stack")]

#[cfg(test)]
mod tests;

use core::any::Any;
use core::ops::Range;
use core::sync::atomic::{AtomicBool, AtomicU32, AtomicU64, Ordering};
use std::cell::UnsafeCell;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

/// How long a helper looks for work without letting others on its core.
const GREED: Duration = Duration::from_micros(50);

/// How long a helper looks for work before it goes to sleep: longer than what one thread does alone between two
/// stages of a step. Waking it takes a tenth of that, and its core may need as long to wake itself.
const PATIENCE: Duration = Duration::from_micros(500);

/// The caller and its helpers, who run the blocks of one stage at a time.
///
/// Blocks must not depend on the order in which they run, nor on who runs them; then the result does not
/// depend on how many there are in the team.
///
/// Clones share the helpers. While one clone is at work another runs its blocks alone. Helpers end with the
/// last clone.
#[derive(Clone, Debug, Default)]
pub struct Team(Option<Arc<Helpers>>);

/// The threads, which end when this is dropped.
#[derive(Debug)]
struct Helpers {
    board: Arc<Board>,
    threads: Vec<JoinHandle<()>>,
}

/// What caller and helpers share.
#[derive(Debug, Default)]
struct Board {
    /// What each member is told.
    desks: Box<[Desk]>,
    /// How many blocks each member has done in its life, in a line of its own.
    done: Box<[Apart<AtomicU32>]>,
    caller: Apart<Caller>,
    /// Which helpers sleep. Who wakes one says so before it is awake.
    asleep: Vec<AtomicBool>,
    /// How many do not.
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
    /// The blocks that are the member's to claim first, and that nobody has claimed.
    claims: Claims,
    /// The stage. Written only while all blocks of the last one are done, read only by who has claimed a block here
    /// that is not.
    job: UnsafeCell<Option<Job>>,
}

/// Consecutive blocks to be claimed: the first in the upper half, one beyond the last in the lower.
#[derive(Debug, Default)]
struct Claims(AtomicU64);

impl Claims {
    fn put(&self, blocks: Range<u32>) {
        self.0.store(u64::from(blocks.start) << 32 | u64::from(blocks.end), Ordering::Release);
    }

    /// A block that nobody else has or will have: the first for whom they are, the last for others.
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

    /// Lets nobody claim any more. Returns how many blocks were left.
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

impl Team {
    /// A team of `members`, the caller among them: with 1 or 0 there are no threads. Should the system
    /// refuse a thread, the team is smaller.
    pub fn new(members: usize) -> Self {
        let asleep = (1..members).map(|_| AtomicBool::new(true)).collect();
        let desks = (0..members).map(|_| Desk::default()).collect();
        let done = (0..members).map(|_| Apart::default()).collect();
        let board = Arc::new(Board { asleep, desks, done, ..Board::default() });
        let threads: Vec<_> = (1..members)
            .map_while(|member| {
                let board = Arc::clone(&board);
                let name = format!("physics {member}");
                thread::Builder::new().name(name).spawn(move || board.help(member)).ok()
            })
            .collect();
        if threads.is_empty() { Self(None) } else { Self(Some(Arc::new(Helpers { board, threads }))) }
    }

    /// How many there are, the caller among them.
    pub fn members(&self) -> usize {
        1 + self.0.as_ref().map_or(0, |helpers| helpers.threads.len())
    }

    /// Has the helpers that sleep look for work, for a short while. To be called where there is much of it;
    /// without, blocks are run by the caller alone.
    pub fn wake(&self) {
        let Some(helpers) = &self.0 else { return };
        let Board { asleep, awake, rests, .. } = &*helpers.board;
        rests.store(false, Ordering::Relaxed);
        for (asleep, handle) in asleep.iter().zip(&helpers.threads) {
            if asleep.load(Ordering::Relaxed) && asleep.swap(false, Ordering::AcqRel) {
                awake.fetch_add(1, Ordering::Relaxed);
                handle.thread().unpark();
            }
        }
    }

    /// Lets the helpers sleep at once, those of clones too, which are the same: there is no more work for them, and
    /// others may want their cores.
    pub fn rest(&self) {
        if let Some(helpers) = &self.0 {
            helpers.board.rests.store(true, Ordering::Relaxed);
        }
    }

    /// Runs `job(block, member)` for every block below `blocks`, and returns when all are done. Members are
    /// numbered from 0, the caller; no two blocks of one run are run at once with the same member.
    ///
    /// # Panics
    /// If a block does.
    pub fn run(&self, blocks: usize, job: impl Fn(usize, usize) + Sync) {
        let count = u32::try_from(blocks).expect("a block is many bytes of memory");
        let members = self.members() as u64;
        self.run_shares(count, (1..=members).map(|k| (u64::from(count) * k / members) as u32), job);
    }

    /// As [`run`](Self::run) for the blocks below the last of `ends`, where member `k` begins with those from
    /// `ends[k - 1]` to `ends[k]`. Who has none does not take part. Ends that are not one for each member, made for
    /// another team, are left out of account.
    ///
    /// # Panics
    /// If a block does.
    pub fn run_parts(&self, ends: &[u32], job: impl Fn(usize, usize) + Sync) {
        let blocks = ends.last().copied().unwrap_or(0);
        debug_assert!(ends.is_sorted(), "parts follow one another: {ends:?}");
        if ends.len() != self.members() {
            return self.run(blocks as usize, job);
        }
        self.run_shares(blocks, ends.iter().copied(), job);
    }

    /// Runs so many blocks, of which each member begins with those up to an end.
    fn run_shares(&self, blocks: u32, ends: impl Iterator<Item = u32>, job: impl Fn(usize, usize) + Sync) {
        let board = self.0.as_ref().map(|helpers| &*helpers.board);
        let alone = || (0..blocks as usize).for_each(|block| job(block, 0));
        match board {
            Some(board) if blocks > 1 && board.awake.load(Ordering::Relaxed) > 0 && board.begin() => {
                let ours = Ours(board);
                board.share(blocks, ends, &|block, member| job(block as usize, member));
                let panic = board.panic().take();
                drop(ours);
                if let Some(panic) = panic {
                    std::panic::resume_unwind(panic);
                }
            }
            _ => alone(),
        }
    }
}

impl Team {
    /// Runs `job` for each of some items; which member gets which is left to chance.
    ///
    /// # Panics
    /// If a job or the iterator does.
    pub fn each<I: Iterator + Send>(&self, items: I, job: impl Fn(I::Item) + Sync) {
        let items = Mutex::new(items);
        let next = || items.lock().unwrap_or_else(PoisonError::into_inner).next();
        self.run(self.members(), |_, _| {
            while let Some(item) = next() {
                job(item);
            }
        });
    }
}

impl Drop for Helpers {
    fn drop(&mut self) {
        self.board.quit.store(true, Ordering::SeqCst);
        for handle in self.threads.drain(..) {
            handle.thread().unpark();
            // A helper panics only within a block, and there it is caught.
            let _ = handle.join();
        }
    }
}

impl Board {
    fn panic(&self) -> MutexGuard<'_, Option<Box<dyn Any + Send>>> {
        self.panic.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes the board, unless a clone of the team or a job that runs jobs has it.
    fn begin(&self) -> bool {
        self.caller.0.busy.compare_exchange(false, true, Ordering::Acquire, Ordering::Relaxed).is_ok()
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
                // What nobody has claimed when the caller panics is nobody's.
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
            // SAFETY: all blocks of the last job are done, and nobody can have claimed one here of this.
            unsafe { *desk.job.get() = Some(posted) };
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
            // Who has the last block may have lost its core.
            if looks.is_multiple_of(1 << 10) { thread::yield_now() } else { core::hint::spin_loop() }
        }
    }

    /// A block of the member's own part that nobody else has or will have. Members begin with the same part in every
    /// run: what runs over the same data one after another finds it in the cache of its core.
    #[inline]
    fn claim_own(&self, member: usize) -> Option<(u32, &Desk)> {
        let desk = &self.desks[member];
        desk.claims.take(true).map(|block| (block, desk))
    }

    /// A block of another member's part that nobody else has or will have.
    #[inline]
    fn claim_others(&self, member: usize) -> Option<(u32, &Desk)> {
        let (before, from) = self.desks.split_at(member);
        let others = from[1..].iter().chain(before);
        others.filter_map(|desk| desk.claims.take(false).map(|block| (block, desk))).next()
    }

    /// What a helper does with its life.
    fn help(&self, member: usize) {
        let asleep = &self.asleep[member - 1];
        while !self.quit.load(Ordering::Acquire) {
            // Awake by chance or by a call that is over: only what is said counts.
            if asleep.load(Ordering::Acquire) {
                thread::park();
                continue;
            }
            self.work(member);
            self.awake.fetch_sub(1, Ordering::Relaxed);
            asleep.store(true, Ordering::Release);
        }
    }

    /// Claims and runs blocks until there have been none for some time.
    fn work(&self, member: usize) {
        let mut idle_since = None;
        let mut looks = 0u32;
        loop {
            // Others' parts are looked at after one's own only: else their lines were gone whenever they look.
            let mut next = self.claim_own(member);
            while let Some((block, desk)) = next {
                self.run_block(block, desk, member);
                idle_since = None;
                next = self.claim_own(member).or_else(|| self.claim_others(member));
            }
            looks = looks.wrapping_add(1);
            if looks.is_multiple_of(64) {
                let now = Instant::now();
                let is_over = self.rests.load(Ordering::Relaxed) || self.quit.load(Ordering::Relaxed);
                let idle = now - *idle_since.get_or_insert(now);
                if is_over || idle > PATIENCE {
                    return;
                }
                if idle > GREED {
                    thread::yield_now();
                }
            }
            core::hint::spin_loop();
        }
    }
}

impl Board {
    /// Runs a block that a helper has claimed at a desk.
    fn run_block(&self, block: u32, desk: &Desk, member: usize) {
        let _done = Done(self, member);
        // SAFETY: it has a block from there that is not done: nobody writes the job, and its closure is there.
        let Some(job) = (unsafe { *desk.job.get() }) else { return };
        // SAFETY: as above.
        let run = || unsafe { (job.run)(job.data, block, member) };
        if let Err(panic) = std::panic::catch_unwind(core::panic::AssertUnwindSafe(run)) {
            // Dropping another could panic again, out of the block.
            core::mem::forget(self.panic().replace(panic));
        }
    }
}

/// Gives the board back when the job ends, however it does.
struct Ours<'a>(&'a Board);

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
