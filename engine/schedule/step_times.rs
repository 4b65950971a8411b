//! Timers of the parts of a step.

use bevy_ecs::prelude::*;
use bevy_platform::time::Instant;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;
use kernel::thread_pool::ThreadPool;
use std::sync::OnceLock;

use crate::asked::Asked;

/// Time of each part of the last step, in the order in which they ran: from `Prepare`, which reads
/// transforms, through the stages of [`PhysicsSchedule`](super::PhysicsSchedule), to `Writeback`, which
/// writes transforms.
///
/// Empty until [`parts`](Self::parts) or [`total`](Self::total) is first called on the resource or a clone.
/// From then on every step fills it. Reading the clocks takes a tenth of a small world's step.
///
/// The time of the app's systems between two parts is included in the later part. `DrainLifecycle`,
/// `ReadAwake`, `Gather`, `Scatter`, `WriteTransforms` and `MirrorSleep`, and also `Prepare` and `Writeback`,
/// only copy between components and the engine's tables. The names are for display, and may change.
///
/// ```
/// # use avian::schedule::StepTimes;
/// # use bevy_ecs::prelude::*;
/// fn print(times: Res<StepTimes>) {
///     for (part, time) in times.parts() {
///         println!("{part}: {:.3} ms", time.as_secs_f64() * 1e3);
///     }
/// }
/// ```
#[derive(Resource, Reflect, Clone, Debug, Default)]
#[reflect(Resource, Debug, Default)]
pub struct StepTimes {
    parts: Vec<(&'static str, Duration)>,
    #[reflect(ignore)]
    last: Option<Instant>,
    /// The expected index of the next part, if parts run as in the last step.
    #[reflect(ignore)]
    next: usize,
    #[reflect(ignore)]
    asked: Asked,
    counts_shared: bool,
    /// The shared time of the last step, and of all earlier steps.
    shared: [Duration; 2],
}

impl StepTimes {
    /// The parts and their times.
    pub fn parts(&self) -> impl Iterator<Item = (&'static str, Duration)> + '_ {
        self.asked.note();
        self.parts.iter().copied()
    }

    /// The time of all parts.
    pub fn total(&self) -> Duration {
        self.parts().map(|(_, time)| time).sum()
    }

    /// Measures [`shared`](Self::shared) from the next step on.
    pub fn count_shared(&mut self) {
        self.counts_shared = true;
    }

    /// Time of the last step in which several threads worked. The rest is the work of one thread, and takes
    /// the same time on any number of cores. Zero unless [measured](Self::count_shared), which costs a
    /// little.
    pub fn shared(&self) -> Duration {
        self.shared[0]
    }

    /// Records the time in which jobs were shared with threads.
    pub(crate) fn note_shared(&mut self, pool: &ThreadPool) {
        if self.counts_shared {
            pool.count_shared_time(nanoseconds);
            let sum = Duration::from_nanos(pool.shared_time());
            self.shared = [sum.saturating_sub(self.shared[1]), sum];
        }
    }

    /// Whether times were ever read.
    pub(crate) fn are_read(&self) -> bool {
        self.asked.is_set()
    }

    /// Begins the first part of a step.
    pub(crate) fn begin(&mut self) {
        (self.last, self.next) = (self.are_read().then(Instant::now), 0);
    }

    /// Ends a part. Its time is the time since the end of the previous part.
    pub(crate) fn end(&mut self, part: &'static str) {
        if !self.are_read() {
            return;
        }
        let now = Instant::now();
        let Some(last) = self.last.replace(now) else { return };
        let is_part = |(name, _): &(&str, Duration)| *name == part;
        let place = match self.parts.get(self.next) {
            Some(expected) if is_part(expected) => Some(self.next),
            _ => self.parts.iter().position(is_part),
        };
        let place = place.unwrap_or_else(|| {
            self.parts.insert(self.next, (part, Duration::ZERO));
            self.next
        });
        self.parts[place].1 = now - last;
        self.next = place + 1;
    }
}

/// Nanoseconds since the first call.
fn nanoseconds() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64
}
