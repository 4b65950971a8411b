//! What the team is made of: the standard library's atomics and threads, or loom's in its model, which tries out how
//! they may interleave and what each load may see.
#![expect(unsafe_code, reason = "a slot is read and written by several threads, one after the other")]

#[cfg(not(all(loom, test)))]
pub(super) use real::*;
#[cfg(all(loom, test))]
pub(super) use tried::*;

/// What a helper without work does next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Next {
    /// Look at once.
    Look,
    /// See whether it is to stop, and if not, look again.
    Ask,
    /// Stop.
    Stop,
}

#[cfg(not(all(loom, test)))]
mod real {
    use super::Next;
    pub(in crate::team) use core::sync::atomic::{AtomicBool, AtomicU32, AtomicU64};
    use std::cell::UnsafeCell;
    pub(in crate::team) use std::sync::{Mutex, MutexGuard};
    pub(in crate::team) use std::thread::{Builder, JoinHandle, park};
    use std::time::{Duration, Instant};

    /// How long a helper looks for work without letting others on its core.
    const GREED: Duration = Duration::from_micros(50);

    /// How long a helper looks for work before it goes to sleep: longer than what one thread does alone between two
    /// stages of a step. Waking it takes a tenth of that, and its core may need as long to wake itself.
    const PATIENCE: Duration = Duration::from_micros(500);

    /// A value that several threads read and write.
    #[derive(Debug, Default)]
    pub(in crate::team) struct Slot<T>(UnsafeCell<T>);

    impl<T: Copy> Slot<T> {
        /// # Safety
        /// No other thread writes it meanwhile.
        #[inline]
        pub(in crate::team) unsafe fn read(&self) -> T {
            // SAFETY: by the contract.
            unsafe { *self.0.get() }
        }

        /// # Safety
        /// No other thread reads or writes it meanwhile.
        #[inline]
        pub(in crate::team) unsafe fn write(&self, value: T) {
            // SAFETY: by the contract.
            unsafe { *self.0.get() = value };
        }
    }

    /// Lets the core do something else for a moment: `looks` is how often the thread has looked in vain.
    #[inline]
    pub(in crate::team) fn pause(looks: u32) {
        // Who has the last block may have lost its core.
        if looks.is_multiple_of(1 << 10) { std::thread::yield_now() } else { core::hint::spin_loop() }
    }

    /// How long a helper has had no work.
    #[derive(Default)]
    pub(in crate::team) struct Idle {
        since: Option<Instant>,
        looks: u32,
    }

    impl Idle {
        /// It had some.
        #[inline]
        pub(in crate::team) fn end(&mut self) {
            self.since = None;
        }

        /// It looked in vain.
        #[inline]
        pub(in crate::team) fn look(&mut self) -> Next {
            self.looks = self.looks.wrapping_add(1);
            core::hint::spin_loop();
            if !self.looks.is_multiple_of(64) {
                return Next::Look;
            }
            let now = Instant::now();
            let idle = now - *self.since.get_or_insert(now);
            if idle > PATIENCE {
                return Next::Stop;
            }
            if idle > GREED {
                std::thread::yield_now();
            }
            Next::Ask
        }
    }
}

#[cfg(all(loom, test))]
mod tried {
    use super::Next;
    pub(in crate::team) use loom::sync::atomic::{AtomicBool, AtomicU32, AtomicU64};
    pub(in crate::team) use loom::sync::{Mutex, MutexGuard};
    pub(in crate::team) use loom::thread::{Builder, JoinHandle, park};

    /// A value that several threads read and write. Loom panics if two that may not be at once are not ordered.
    #[derive(Debug, Default)]
    pub(in crate::team) struct Slot<T>(loom::cell::UnsafeCell<T>);

    impl<T: Copy> Slot<T> {
        /// # Safety
        /// No other thread writes it meanwhile.
        pub(in crate::team) unsafe fn read(&self) -> T {
            // SAFETY: by the contract.
            self.0.with(|value| unsafe { *value })
        }

        /// # Safety
        /// No other thread reads or writes it meanwhile.
        pub(in crate::team) unsafe fn write(&self, new: T) {
            // SAFETY: by the contract.
            self.0.with_mut(|value| unsafe { *value = new });
        }
    }

    pub(in crate::team) fn pause(_: u32) {
        loom::thread::yield_now();
    }

    /// A helper looks in vain three times before it stops: time is not what is tried.
    #[derive(Default)]
    pub(in crate::team) struct Idle(u32);

    impl Idle {
        pub(in crate::team) fn end(&mut self) {
            self.0 = 0;
        }

        pub(in crate::team) fn look(&mut self) -> Next {
            self.0 += 1;
            loom::thread::yield_now();
            match self.0 {
                1 => Next::Look,
                2 => Next::Ask,
                _ => Next::Stop,
            }
        }
    }
}
