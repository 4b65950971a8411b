//! The kernel's own threads. A stage of a step is cut into blocks, a part of them for each member; members that are awake and
//! have finished their own part claim blocks of others.
//!
//! # The protocol
//!
//! A *job* is one closure and its blocks. Members are the caller, 0, and the helpers, each of which has a desk on the
//! board (`board.rs`). The words of the board, and the only threads that write them:
//!
//! | word | says | written by |
//! |---|---|---|
//! | `busy` | some caller has the board | the caller that changes it from false to true, until it stores false |
//! | `desk.job` | the closure, as a pointer | the caller that has the board |
//! | `desk.claims` | blocks that no member has claimed: first, and one beyond the last | the caller that has the board fills it when it is empty, all members take from it, a caller that panics empties it |
//! | `done[m]` | how many blocks member m has finished in its life | member m |
//! | `posted` | the sum of all `done` after the last job | the caller that has the board |
//! | `asleep[h]` | helper h waits for a call | helper h stores true, who wakes it swaps it to false |
//! | `awake` | how many helpers are called | who wakes one adds 1, the helper subtracts 1 |
//! | `rests`, `quit` | helpers are to stop looking, to end | callers, [`Drop`] |
//!
//! **States of a helper.** *Asleep*: `asleep[h]` is true, and it parks. *Awake*: it looks for blocks until it has found none
//! for some time or `rests` is set. *Ended*: it saw `quit`.
//!
//! **One caller.** `busy` changes from false to true by a compare-exchange with Acquire and back by a store with Release: a
//! caller sees all that the one before wrote, and two never post at once. Who does not get the board runs its blocks alone.
//!
//! **A block has one runner.** Both ends of a desk's unclaimed blocks are one 64-bit word, and a claim is a compare-exchange on
//! it: of two claims of one block the second fails. That the word may have gone to another value and back in between, even by
//! another job, does no harm: what it says is true when the exchange succeeds.
//!
//! **A runner sees its job.** The caller writes `desk.job`, then stores `desk.claims` with Release. Claims are exchanged with
//! Acquire; they are read-modify-writes, so a claim after other claims still belongs to the release sequence of that store,
//! and the claimer sees the job and all that the caller wrote before it.
//!
//! **The caller sees every block.** A member adds to `done[m]` with a store with Release after its block, also if it panics.
//! The caller loads all of them with Acquire until they sum up to `posted` and the job's blocks. No `done` falls, and their sum
//! never exceeds what was posted; so an old value can only make the sum too small, and when it fits all blocks are
//! finished, and what they wrote is seen.
//!
//! **When the closure dies.** It is on the caller's stack, and a helper calls it only for a block that it has claimed and not
//! yet counted. The caller does not return, nor unwind, before the counts fit: the wait is the destructor of a value that lives
//! when blocks are posted. If a block of the caller panics, the destructor first empties the desks, and waits for the rest. So
//! between two jobs no desk has blocks and no helper reads `job`, and the next caller may write it. A panic in a helper is
//! caught, kept, and thrown again by the caller.
//!
//! **No call is lost.** To wake a helper is to swap `asleep[h]` from true to false and then to unpark it. The helper parks only
//! after it has read true, and reads again whenever park returns. Either it reads false and does not park, or the swap comes
//! after its read, and then so does the unpark: it ends the park, or makes the next one return at once. A call to a helper that is
//! just about to store true finds it awake and does nothing; then it may sleep while there is work, and the others run its part,
//! since nothing waits for a member, only for blocks. [`Drop`] stores `quit` and unparks: by the same argument each helper reads
//! it.
//!
//! **Relaxed.** `awake`, `rests` and the first look at `asleep[h]` only decide whether it is worth sharing or looking.
//! 1 is added to `awake` before the swap that lets the helper subtract it. `posted` is only used by who has the board.
//!
//! `tools/model-check.sh` has loom try all this with two and three members (`model.rs`), and runs the tests under
//! ThreadSanitizer where there is one.

mod board;
#[cfg(all(loom, test))]
mod model;
mod sync;
#[cfg(all(not(loom), test))]
mod tests;

use board::Board;
use core::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, OnceLock, PoisonError};
use sync::{Builder, JoinHandle, Mutex};

/// The caller and its helpers, who run the blocks of one stage at a time.
///
/// Blocks must not depend on the order in which they run, nor on who runs them; then the result does not
/// depend on how many there are in the team.
///
/// Clones share the helpers. While one clone is at work another runs its blocks alone. Helpers end with the
/// last clone.
#[derive(Clone, Debug, Default)]
pub struct Team(Option<Arc<Helpers>>);

/// Tells the time in nanoseconds since some moment. The kernel has no clock of its own.
pub type Clock = fn() -> u64;

/// The threads, which end when this is dropped.
#[derive(Debug)]
struct Helpers {
    board: Arc<Board>,
    threads: Vec<JoinHandle<()>>,
    /// Tells the time if that of shared runs is counted, and what it has come to.
    clock: OnceLock<Clock>,
    shared: AtomicU64,
}

impl Team {
    /// A team of `members`, the caller among them: with 1 or 0 there are no threads. Should the system
    /// refuse a thread, the team is smaller.
    pub fn new(members: usize) -> Self {
        let board = Arc::new(Board::new(members));
        let threads: Vec<_> = (1..members)
            .map_while(|member| {
                let board = Arc::clone(&board);
                let name = format!("physics {member}");
                Builder::new().name(name).spawn(move || board.help(member)).ok()
            })
            .collect();
        if threads.is_empty() {
            return Self(None);
        }
        let (clock, shared) = (OnceLock::new(), AtomicU64::new(0));
        Self(Some(Arc::new(Helpers { board, threads, clock, shared })))
    }

    /// How many there are, the caller among them.
    pub fn members(&self) -> usize {
        1 + self.0.as_ref().map_or(0, |helpers| helpers.threads.len())
    }

    /// Has the helpers that sleep look for work, for a short while. To be called where there is much of it;
    /// without, blocks are run by the caller alone.
    pub fn wake(&self) {
        let Some(helpers) = &self.0 else { return };
        helpers.board.resume();
        for (helper, handle) in helpers.threads.iter().enumerate() {
            if helpers.board.rouse(helper) {
                handle.thread().unpark();
            }
        }
    }

    /// Lets the helpers sleep at once, those of clones too, which are the same: there is no more work for them, and
    /// others may want their cores.
    pub fn rest(&self) {
        if let Some(helpers) = &self.0 {
            helpers.board.rest();
        }
    }

    /// Has the time of shared runs counted from now on, for measurements: it costs two looks at a clock a run.
    pub fn count_shared_time(&self, clock: Clock) {
        if let Some(helpers) = &self.0 {
            helpers.clock.get_or_init(|| clock);
        }
    }

    /// For how many nanoseconds callers have run blocks together with helpers since that is counted. The rest of their time is one
    /// thread's, however many members there are.
    pub fn shared_time(&self) -> u64 {
        self.0.as_ref().map_or(0, |helpers| helpers.shared.load(Ordering::Relaxed))
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
        let shared = board.filter(|board| blocks > 1 && board.is_anyone_awake()).and_then(Board::begin);
        match shared {
            Some(ours) => {
                let timed = self.0.as_ref().and_then(|helpers| Some((helpers, helpers.clock.get()?)));
                let timed = timed.map(|(helpers, clock)| (helpers, clock, clock()));
                ours.share(blocks, ends, &|block, member| job(block as usize, member));
                if let Some((helpers, clock, start)) = timed {
                    helpers.shared.fetch_add(clock().saturating_sub(start), Ordering::Relaxed);
                }
            }
            None => (0..blocks as usize).for_each(|block| job(block, 0)),
        }
    }
}

impl Team {
    /// Runs `job` for each of some items; which member gets which is left to chance.
    ///
    /// # Panics
    /// If a job or the iterator does.
    pub fn each<I: Iterator + Send>(&self, items: I, job: impl Fn(I::Item) + Sync) {
        self.each_into(&mut vec![(); self.members()], items, |(), item| job(item));
    }

    /// As [`each`](Self::each), where each member has a result of its own to add to, of the first as many of `results` as
    /// there are members. What is in which is left to chance.
    ///
    /// # Panics
    /// If a job or the iterator does.
    pub fn each_into<I: Iterator + Send, R: Default + Send>(
        &self,
        results: &mut Vec<R>,
        items: I,
        job: impl Fn(&mut R, I::Item) + Sync,
    ) {
        results.resize_with(results.len().max(self.members()), R::default);
        let (items, results) = (Mutex::new(items), Mutex::new(results.iter_mut()));
        self.run(self.members(), |_, _| {
            let Some(result) = locked(&results).next() else { return };
            loop {
                let item = locked(&items).next();
                let Some(item) = item else { return };
                job(result, item);
            }
        });
    }
}

/// What a mutex guards, also after a panic of another thread.
fn locked<T>(mutex: &Mutex<T>) -> sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Drop for Helpers {
    fn drop(&mut self) {
        self.board.quit();
        for handle in self.threads.drain(..) {
            handle.thread().unpark();
            // A helper panics only within a block, and there it is caught.
            let _ = handle.join();
        }
    }
}
