//! How long each part of a step took.

use bevy_ecs::prelude::*;
use bevy_platform::time::Instant;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;
use kernel::thread_pool::ThreadPool;
use std::sync::OnceLock;

/// How long each part of the last step took, in the order in which they ran: from `Prepare`, where transforms are
/// read, through the stages of [`PhysicsSchedule`](super::PhysicsSchedule), to `Writeback`, where they are written.
///
/// What the app's own systems do between two parts counts for the later one. The parts that only stand between the
/// ECS and the engine's own tables are `DrainLifecycle`, `ReadAwake`, `Gather`, `Scatter` and `MirrorSleep`, besides
/// `Prepare` and `Writeback`; `FinishBodies`, before `Scatter`, is the kernel's. The names are for people to read: they may change.
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
    counts_shared: bool,
    /// Of the last step, and the sum of all before.
    shared: [Duration; 2],
}

impl StepTimes {
    /// The parts and their times.
    pub fn parts(&self) -> impl Iterator<Item = (&'static str, Duration)> + '_ {
        self.parts.iter().copied()
    }

    /// The time of all parts.
    pub fn total(&self) -> Duration {
        self.parts.iter().map(|(_, time)| *time).sum()
    }

    /// Has [`shared`](Self::shared) counted from the next step on.
    pub fn count_shared(&mut self) {
        self.counts_shared = true;
    }

    /// For how long the last step was worked on by several threads. The rest of it one thread did alone: it takes as long
    /// on any number of cores. Zero unless [counted](Self::count_shared), which costs a little.
    pub fn shared(&self) -> Duration {
        self.shared[0]
    }

    /// Records for how long jobs were shared with threads.
    pub(crate) fn note_shared(&mut self, pool: &ThreadPool) {
        if self.counts_shared {
            pool.count_shared_time(nanoseconds);
            let sum = Duration::from_nanos(pool.shared_time());
            self.shared = [sum.saturating_sub(self.shared[1]), sum];
        }
    }

    /// The next part begins now.
    pub(crate) fn begin(&mut self) {
        self.last = Some(Instant::now());
    }

    /// What happened since the last part ended was this one.
    pub(crate) fn end(&mut self, part: &'static str) {
        let now = Instant::now();
        let Some(last) = self.last.replace(now) else { return };
        match self.parts.iter_mut().find(|(name, _)| *name == part) {
            Some((_, time)) => *time = now - last,
            None => self.parts.push((part, now - last)),
        }
    }
}

/// Since it was first asked.
fn nanoseconds() -> u64 {
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_nanos() as u64
}
