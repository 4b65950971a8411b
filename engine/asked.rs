//! A flag that the first reader of optional data sets. The data is computed only while the flag is set.

use core::sync::atomic::{AtomicBool, Ordering};
use std::sync::Arc;

/// Whether data was ever requested. Clones share the flag, which is never cleared.
#[derive(Clone, Debug, Default)]
pub(crate) struct Asked(Arc<AtomicBool>);

impl Asked {
    pub(crate) fn note(&self) {
        // Readers share the cache line as long as no thread writes.
        if !self.is_set() {
            self.0.store(true, Ordering::Relaxed);
        }
    }

    pub(crate) fn is_set(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}
