//! The atomics and threads of the pool: the standard library's, or loom's in the model, which tries all
//! interleavings and all values that a load may return.
#![expect(unsafe_code, reason = "several threads read and write a cell, one after the other")]

#[cfg(all(loom, test))]
pub(super) use modelled::*;
#[cfg(not(all(loom, test)))]
pub(super) use real::*;

/// The next action of a thread without a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Idle {
    /// Look for a block at once.
    Spin,
    /// Check whether threads must park, and if not, look again.
    Check,
    /// Park.
    Park,
}

#[cfg(not(all(loom, test)))]
mod real {
    use super::Idle;
    pub(in crate::thread_pool) use core::sync::atomic::{AtomicBool, AtomicU32, AtomicU64};
    use std::cell::UnsafeCell;
    pub(in crate::thread_pool) use std::sync::{Mutex, MutexGuard};
    pub(in crate::thread_pool) use std::thread::{Builder, JoinHandle, park};
    use std::time::{Duration, Instant};

    /// An idle thread spins for this time before it starts to yield its core. A longer time takes cores from
    /// other programs, a shorter time delays the next stage.
    const SPIN_TIME: Duration = Duration::from_micros(50);

    /// An idle thread parks after this time. It is longer than the single-threaded work between two stages of
    /// a step: with 50 µs steps took up to 40 % longer, since waking a thread takes 35 to 140 µs.
    const PARK_TIMEOUT: Duration = Duration::from_micros(500);

    /// A value that several threads read and write.
    #[derive(Debug, Default)]
    pub(in crate::thread_pool) struct SharedCell<T>(UnsafeCell<T>);

    impl<T: Copy> SharedCell<T> {
        /// # Safety
        /// No other thread writes the cell meanwhile.
        #[inline]
        pub(in crate::thread_pool) unsafe fn read(&self) -> T {
            // SAFETY: by the contract.
            unsafe { *self.0.get() }
        }

        /// # Safety
        /// No other thread reads or writes the cell meanwhile.
        #[inline]
        pub(in crate::thread_pool) unsafe fn write(&self, value: T) {
            // SAFETY: by the contract.
            unsafe { *self.0.get() = value };
        }
    }

    /// Waits for a moment in a loop. `rounds` counts its rounds.
    #[inline]
    pub(in crate::thread_pool) fn pause(rounds: u32) {
        // The thread that runs the last block may have lost its core.
        if rounds.is_multiple_of(1 << 10) { std::thread::yield_now() } else { core::hint::spin_loop() }
    }

    /// Measures for how long a thread has had no block.
    #[derive(Default)]
    pub(in crate::thread_pool) struct IdleTimer {
        since: Option<Instant>,
        rounds: u32,
    }

    impl IdleTimer {
        /// The thread had a block.
        #[inline]
        pub(in crate::thread_pool) fn reset(&mut self) {
            self.since = None;
        }

        /// The thread found no block.
        #[inline]
        pub(in crate::thread_pool) fn tick(&mut self) -> Idle {
            self.rounds = self.rounds.wrapping_add(1);
            core::hint::spin_loop();
            if !self.rounds.is_multiple_of(64) {
                return Idle::Spin;
            }
            let now = Instant::now();
            let idle = now - *self.since.get_or_insert(now);
            if idle > PARK_TIMEOUT {
                return Idle::Park;
            }
            if idle > SPIN_TIME {
                std::thread::yield_now();
            }
            Idle::Check
        }
    }
}

#[cfg(all(loom, test))]
mod modelled {
    use super::Idle;
    pub(in crate::thread_pool) use loom::sync::atomic::{AtomicBool, AtomicU32, AtomicU64};
    pub(in crate::thread_pool) use loom::sync::{Mutex, MutexGuard};
    pub(in crate::thread_pool) use loom::thread::{Builder, JoinHandle, park};

    /// A value that several threads read and write. Loom panics if two conflicting accesses are not ordered.
    #[derive(Debug, Default)]
    pub(in crate::thread_pool) struct SharedCell<T>(loom::cell::UnsafeCell<T>);

    impl<T: Copy> SharedCell<T> {
        /// # Safety
        /// No other thread writes the cell meanwhile.
        pub(in crate::thread_pool) unsafe fn read(&self) -> T {
            // SAFETY: by the contract.
            self.0.with(|value| unsafe { *value })
        }

        /// # Safety
        /// No other thread reads or writes the cell meanwhile.
        pub(in crate::thread_pool) unsafe fn write(&self, new: T) {
            // SAFETY: by the contract.
            self.0.with_mut(|value| unsafe { *value = new });
        }
    }

    pub(in crate::thread_pool) fn pause(_: u32) {
        loom::thread::yield_now();
    }

    /// A thread parks after three rounds without a block, since time is not modelled.
    #[derive(Default)]
    pub(in crate::thread_pool) struct IdleTimer(u32);

    impl IdleTimer {
        pub(in crate::thread_pool) fn reset(&mut self) {
            self.0 = 0;
        }

        pub(in crate::thread_pool) fn tick(&mut self) -> Idle {
            self.0 += 1;
            loom::thread::yield_now();
            match self.0 {
                1 => Idle::Spin,
                2 => Idle::Check,
                _ => Idle::Park,
            }
        }
    }
}
