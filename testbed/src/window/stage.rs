//! The running scene, and its speed.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

use bevy::prelude::*;

use crate::draw::Drawable;
use crate::sim::{Counts, Entry, Simulation};

/// Seconds of one step of the scenes.
const STEP: f32 = 1.0 / 60.0;
/// Maximum number of steps per frame. If more are due, the scene runs slower than real time.
const MOST_STEPS: u32 = 2;

/// The scenes, and the chosen one running.
pub struct Stage {
    /// All scenes.
    pub entries: Vec<Entry>,
    /// The index of the running scene.
    pub chosen: usize,
    /// Number of steps.
    pub steps: u32,
    /// Whether it is paused.
    pub paused: bool,
    /// Whether one step is requested while paused.
    pub single: bool,
    /// Number of starts of scenes.
    pub generation: u32,
    /// Milliseconds of the latest steps.
    times: VecDeque<f64>,
    simulation: Option<Box<dyn Simulation>>,
    owed: f32,
}

impl Stage {
    /// A stage with the first scene on it.
    pub fn new(entries: Vec<Entry>) -> Self {
        let mut stage = Self {
            entries,
            chosen: 0,
            steps: 0,
            paused: false,
            single: false,
            generation: 0,
            times: VecDeque::new(),
            simulation: None,
            owed: 0.0,
        };
        stage.choose(0);
        stage
    }

    /// Starts a scene. The index wraps around.
    pub fn choose(&mut self, index: usize) {
        self.chosen = index % self.entries.len().max(1);
        self.simulation = self.entries.get(self.chosen).and_then(|entry| (entry.start)(entry.name));
        self.steps = 0;
        self.owed = 0.0;
        self.times.clear();
        self.generation += 1;
    }

    /// The running scene.
    pub fn entry(&self) -> Option<&Entry> {
        self.entries.get(self.chosen)
    }

    /// Counts of the running scene.
    pub fn counts(&mut self) -> Counts {
        self.simulation.as_mut().map(|simulation| simulation.counts()).unwrap_or_default()
    }

    /// The colliders of the running scene.
    pub fn drawables(&mut self) -> Vec<Drawable> {
        self.simulation.as_mut().map(|simulation| simulation.drawables()).unwrap_or_default()
    }

    /// The median of the latest steps in milliseconds, zero before the first.
    pub fn median_ms(&self) -> f64 {
        let mut times: Vec<f64> = self.times.iter().copied().collect();
        times.sort_by(f64::total_cmp);
        times.get(times.len() / 2).copied().unwrap_or(0.0)
    }

    fn step(&mut self) {
        let Some(simulation) = &mut self.simulation else { return };
        let start = Instant::now();
        simulation.step();
        self.times.push_back(start.elapsed().as_secs_f64() * 1e3);
        if self.times.len() > 60 {
            self.times.pop_front();
        }
        self.steps += 1;
    }
}

/// Takes the steps that are due since the last frame.
pub fn advance(mut stage: NonSendMut<Stage>, time: Res<Time<Real>>) {
    if stage.paused {
        stage.owed = 0.0;
        if std::mem::take(&mut stage.single) {
            stage.step();
        }
        return;
    }
    stage.single = false;
    stage.owed += time.delta().min(Duration::from_millis(250)).as_secs_f32();
    let mut steps = 0;
    while stage.owed >= STEP && steps < MOST_STEPS {
        stage.owed -= STEP;
        stage.step();
        steps += 1;
    }
    stage.owed = stage.owed.min(STEP);
}
