//! The interface of an engine.

use serde::{Deserialize, Serialize};

use crate::{
    dim2::D2,
    dim3::D3,
    scene::Need,
    world::{Body, Dimension, Joint, Ray, State},
};

/// The length of a step in seconds.
pub const DT: f32 = 1.0 / 60.0;
/// Number of substeps per step, in every engine.
pub const SUBSTEPS: u32 = 4;

/// Settings of every engine; all others are in the scene.
#[derive(Clone, Copy, Debug)]
pub struct Settings {
    /// Maximum number of threads.
    pub threads: usize,
    /// Whether bodies may fall asleep.
    pub sleeping: bool,
    /// Whether clocks are added between the stages. They cost a little.
    pub stages: bool,
}

/// The share that a stage belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Share {
    /// The simulation's.
    Kernel,
    /// The copying between components and simulation, and looking for what the app changed.
    Ecs,
    /// Bevy's, around the physics.
    Bevy,
    /// The engine's own timer. It overlaps with other stages and is not part of a sum.
    Own,
}

/// The name of the time in which several threads worked on a step.
pub const SHARED: &str = "shared";

/// The time of a part of the last step.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Stage {
    /// The name of the part.
    pub name: String,
    /// The share it belongs to.
    pub share: Share,
    /// In milliseconds.
    pub ms: f64,
}

impl Stage {
    /// A timer of the engine's own.
    pub fn own(name: &str, ms: f64) -> Self {
        Self { name: name.to_owned(), share: Share::Own, ms }
    }
}

/// One engine's world. Bodies are numbered in the order they are added.
pub trait Engine<D: Dimension> {
    /// Features that this build does not support. Their methods are never called.
    fn lacks(&self) -> &'static [Need] {
        &[Need::Batches]
    }
    /// Adds a body with all its shapes.
    fn add_body(&mut self, body: &Body<D>);
    /// Adds a joint between bodies that were added before.
    fn add_joint(&mut self, _joint: &Joint<D>) {
        unreachable!("an engine without joints is given none");
    }
    /// Called once, after the initial bodies are added and before the first step.
    fn ready(&mut self) {}
    /// Sets the velocity of a kinematic body.
    fn push(&mut self, body: usize, vel: D::Vec);
    /// Takes all bodies out of the world, one after the other.
    fn clear(&mut self);
    /// Steps the world once.
    fn step(&mut self);
    /// The poses of the bodies, in the order they were added.
    fn states(&mut self, out: &mut Vec<State<D>>);
    /// How many dynamic bodies are awake.
    fn awake(&mut self) -> usize;
    /// The distance to the closest hit of each ray, or infinity.
    fn raycast(&mut self, _rays: &[Ray<D>], _out: &mut Vec<f32>) {
        unreachable!("an engine without queries is given none");
    }
    /// As [`raycast`](Self::raycast), by one call for all rays.
    fn raycast_batch(&mut self, _rays: &[Ray<D>], _out: &mut Vec<f32>) {
        unreachable!("an engine without batches is given none");
    }
    /// The distance that a ball of a radius moves along each ray, or infinity.
    fn ballcast(&mut self, _radius: f32, _rays: &[Ray<D>], _out: &mut Vec<f32>) {
        unreachable!("an engine without queries is given none");
    }
    /// The parts of the last step, in order.
    fn stages(&mut self) -> Vec<Stage> {
        Vec::new()
    }
}

/// Makes a world with that gravity.
pub type Make<D> = fn(gravity: <D as Dimension>::Vec, settings: &Settings) -> Box<dyn Engine<D>>;

/// The engines that one binary carries, by name.
pub struct Engines {
    /// In two dimensions.
    pub d2: &'static [(&'static str, Make<D2>)],
    /// In three dimensions.
    pub d3: &'static [(&'static str, Make<D3>)],
}
