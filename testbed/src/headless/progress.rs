//! A progress bar on standard error: redrawn in place on a terminal, one line per scene elsewhere.

use std::io::{self, IsTerminal, Write};
use std::time::{Duration, Instant};

const WIDTH: usize = 30;
const PAUSE: Duration = Duration::from_millis(100);

/// Shows the progress of the tour.
pub struct Progress {
    scenes: usize,
    done: usize,
    terminal: bool,
    shown: Option<Instant>,
}

impl Progress {
    /// For a tour of a number of scenes.
    pub fn new(scenes: usize) -> Self {
        Self { scenes, done: 0, terminal: io::stderr().is_terminal(), shown: None }
    }

    /// Records the finished steps of the scene. Draws at most ten times a second.
    pub fn step(&mut self, name: &str, step: u32, steps: u32) {
        let due = self.shown.is_none_or(|last| last.elapsed() >= PAUSE);
        if self.terminal && due {
            self.shown = Some(Instant::now());
            self.draw(name, step, steps);
        }
    }

    /// Records that the scene is finished.
    pub fn finish(&mut self, name: &str, steps: u32) {
        self.done += 1;
        if self.terminal {
            // Overwrites the bar, so that lines of other output do not run into it.
            write(&format!("\r{:width$}\r", "", width = WIDTH + 60));
        } else {
            write(&format!("[{}/{}] {name}, {steps} steps\n", self.done, self.scenes));
        }
    }

    fn draw(&self, name: &str, step: u32, steps: u32) {
        let share = f64::from(step) / f64::from(steps.max(1));
        let whole = (self.done as f64 + share) / self.scenes.max(1) as f64;
        let full = ((whole * WIDTH as f64) as usize).min(WIDTH);
        let bar = "#".repeat(full) + &"-".repeat(WIDTH - full);
        write(&format!("\r[{bar}] {:3.0} %  {:<40}", 100.0 * whole, format!("{name} {step}/{steps}")));
    }
}

/// Errors are ignored: a closed standard error does not stop the tour.
fn write(text: &str) {
    let mut out = io::stderr().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
}
