//! The clock, and the results of a run.

use std::time::Instant;

use serde::{Deserialize, Serialize};

use crate::{
    chains::Strain,
    engine::{Share, Stage},
    scene::Family,
};

/// The final state of the world, measured in the same way for every engine.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Quality {
    /// How many bodies are dynamic.
    pub dynamic: usize,
    /// How many of them are awake.
    pub awake: usize,
    /// How many bodies have a NaN or something infinite in their state.
    pub not_finite: usize,
    /// How many dynamic bodies are outside of the scene's bounds.
    pub escaped: usize,
    /// Scenes with bullets only: how many of them went through something static in any step.
    pub passed: Option<usize>,
    /// The fastest dynamic body, in m/s.
    pub max_speed: f32,
    /// The mean speed of dynamic bodies, in m/s.
    pub mean_speed: f32,
    /// The deepest overlap of two shapes, in metres.
    pub max_overlap: f32,
    /// The mean depth of what overlaps, in metres.
    pub mean_overlap: f32,
    /// How many pairs of shapes overlap.
    pub overlaps: usize,
    /// The largest distance of a joint's two anchors, in metres.
    pub max_joint_error: f32,
    /// Chains only: what they did in all steps of a second run without a clock.
    #[serde(default)]
    pub strain: Option<Strain>,
    /// How far the watched body is from where it started, in metres.
    pub drift: Option<f32>,
    /// Queries only: the number of hits.
    pub hits: Option<usize>,
    /// Queries only: the mean distance of hits, in metres.
    pub mean_hit: Option<f64>,
}

/// The result of one run of one scene on one engine.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Report {
    /// The engine.
    pub engine: String,
    /// 2 or 3.
    pub dim: u32,
    /// The scene.
    pub scene: String,
    /// The family.
    pub family: Family,
    /// How many threads the engine had.
    pub threads: usize,
    /// How many bodies the scene has.
    pub bodies: usize,
    /// How many steps or batches were timed.
    pub timed: usize,
    /// Queries per batch; 0 where steps were timed.
    pub batch: usize,
    /// How long it took to make the world, in milliseconds.
    pub setup_ms: f64,
    /// Mean time of a step or batch, in milliseconds.
    pub mean: f64,
    /// The median.
    pub median: f64,
    /// The 95th percentile.
    pub p95: f64,
    /// The longest.
    pub max: f64,
    /// The parts of a step, on average. Empty unless asked for.
    pub stages: Vec<Stage>,
    /// The final state.
    pub quality: Quality,
    /// Share of one core that other processes used meanwhile, which the parent fills in.
    #[serde(default)]
    pub foreign: f64,
    /// Peak memory of the process up to the end of the timed part, in MiB.
    pub peak_mb: f64,
}

/// Times of steps, in milliseconds.
#[derive(Default)]
pub struct Clock(Vec<f64>);

/// Statistics of times.
pub struct Times {
    /// Mean.
    pub mean: f64,
    /// Median.
    pub median: f64,
    /// 95th percentile.
    pub p95: f64,
    /// Longest.
    pub max: f64,
}

/// How long something takes, in milliseconds.
pub fn time_of(work: impl FnOnce()) -> f64 {
    let start = Instant::now();
    work();
    start.elapsed().as_secs_f64() * 1e3
}

impl Clock {
    /// Does something and notes how long it took.
    pub fn time(&mut self, work: impl FnOnce()) {
        self.note(time_of(work));
    }

    /// Notes a time in milliseconds.
    pub fn note(&mut self, ms: f64) {
        self.0.push(ms);
    }

    /// The statistics.
    pub fn times(mut self) -> Times {
        self.0.sort_by(f64::total_cmp);
        let count = self.0.len().max(1);
        let at = |q: f64| self.0.get(((count as f64 - 1.0) * q).round() as usize).copied().unwrap_or(0.0);
        Times {
            mean: self.0.iter().sum::<f64>() / count as f64,
            median: at(0.5),
            p95: at(0.95),
            max: at(1.0),
        }
    }
}

/// Sums the stages over the timed steps, in the order they were first reported.
#[derive(Default)]
pub struct StageSums {
    stages: Vec<Stage>,
    steps: usize,
}

impl StageSums {
    /// Adds those of one step.
    pub fn add(&mut self, step: Vec<Stage>) {
        self.steps += 1;
        for stage in step {
            match self.stages.iter_mut().find(|s| s.name == stage.name && s.share == stage.share) {
                Some(sum) => sum.ms += stage.ms,
                None => self.stages.push(stage),
            }
        }
    }

    /// The mean of each.
    pub fn means(mut self) -> Vec<Stage> {
        let steps = self.steps.max(1) as f64;
        self.stages.iter_mut().for_each(|s| s.ms /= steps);
        self.stages
    }
}

/// The time of all stages of one share.
pub fn sum_of(stages: &[Stage], share: Share) -> f64 {
    stages.iter().filter(|s| s.share == share).map(|s| s.ms).sum()
}

/// The median of some numbers, NaN for none.
pub fn middle(mut numbers: Vec<f64>) -> f64 {
    numbers.sort_by(f64::total_cmp);
    match numbers.len() {
        0 => f64::NAN,
        n if n % 2 == 1 => numbers[n / 2],
        n => 0.5 * (numbers[n / 2 - 1] + numbers[n / 2]),
    }
}
