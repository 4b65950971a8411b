//! Whether anything ever asked for data that is made only then.

use core::sync::atomic::{AtomicBool, Ordering};

/// Set by the first reader, for good.
#[derive(Debug, Default)]
pub(crate) struct Asked(AtomicBool);

impl Asked {
    pub(crate) fn note(&self) {
        // Readers share the cache line as long as none writes.
        if !self.is_set() {
            self.0.store(true, Ordering::Relaxed);
        }
    }

    pub(crate) fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

impl Clone for Asked {
    fn clone(&self) -> Self {
        Self(AtomicBool::new(self.is_set()))
    }
}
