//! The tour without a window: every scene run, measured, drawn.

mod progress;
mod run;
mod table;

pub use run::tour;
