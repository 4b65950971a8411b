//! A flag that the first reader sets of data that is computed only for readers.

use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;

/// Whether anything ever asked. Clones share the flag, which is never cleared.
#[derive(Clone, Debug, Default)]
pub(crate) struct Asked(Arc<AtomicBool>);

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
