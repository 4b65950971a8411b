//! Scenes as plain data, the same for every engine.

use serde::{Deserialize, Serialize};

use crate::chains::Chain;
use crate::world::{Body, Dimension, Joint, Ray};

/// The family of a scene. Tables and plots are per family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Family {
    /// Time per step with many moving bodies.
    Speed,
    /// Time of a batch of queries.
    Queries,
    /// Cost of a world in which few or no bodies move.
    Idle,
    /// Cost of a step of an almost empty world.
    Small,
    /// Time for adding and removing a level.
    Bulk,
    /// Growth of the time with the number of bodies.
    Growth,
    /// How well joints hold.
    Joints,
}

impl Family {
    /// Whether few bodies move: then the cost of having the bodies matters.
    pub fn is_mostly_still(self) -> bool {
        matches!(self, Self::Idle | Self::Small | Self::Bulk)
    }
}

/// What is timed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// Steps of the world.
    Steps,
    /// Batches of rays against a world at rest.
    Raycasts,
    /// The same rays in one call each batch, which threads may share.
    RaycastBatches,
    /// Batches of sweeps of a ball against a world at rest.
    Ballcasts,
    /// Adding all bodies to an empty world, and the step after it.
    Spawn,
    /// Removing all bodies, and the step after it.
    Despawn,
}

/// Features that a scene may need, beyond single bodies of one shape. Engines that lack one do not
/// run the scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// Moving bodies.
    Physics,
    /// Joints.
    Joints,
    /// Rays and shape casts.
    Queries,
    /// Many rays in one call.
    Batches,
    /// Triangle meshes.
    Meshes,
    /// Bodies with several shapes, or with one that is not at the body's origin.
    Children,
}

/// The length of a scene: `settle` steps are not timed, `timed` steps are.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// What is timed.
    pub work: Work,
    /// Number of steps before.
    pub settle: usize,
    /// How many steps or batches are timed.
    pub timed: usize,
}

impl Plan {
    /// Steps, after a few to warm up.
    pub const fn steps(timed: usize) -> Self {
        Self { work: Work::Steps, settle: 5, timed }
    }

    /// Steps, after others that bring the scene to its interesting part.
    pub const fn settled(settle: usize, timed: usize) -> Self {
        Self { work: Work::Steps, settle, timed }
    }

    /// Batches of something other than steps.
    pub const fn batches(work: Work, timed: usize) -> Self {
        Self { work, settle: 2, timed }
    }
}

/// A kinematic body that moves along a path.
#[derive(Clone, Copy, Debug)]
pub struct Drive<D: Dimension> {
    /// The body.
    pub body: usize,
    /// Its position at a time in seconds.
    pub place: fn(f32) -> D::Vec,
}

impl<D: Dimension> Drive<D> {
    /// The velocity that takes the body to its next place in the step that begins after `steps` steps.
    pub fn velocity(&self, steps: usize, dt: f32) -> D::Vec {
        let (now, mut next) = ((self.place)(steps as f32 * dt), (self.place)((steps + 1) as f32 * dt));
        next.as_mut().iter_mut().zip(now.as_ref()).for_each(|(next, now)| *next = (*next - now) / dt);
        next
    }
}

/// A world and how it is run.
#[derive(Clone, Debug)]
pub struct Scene<D: Dimension> {
    /// Description in one line.
    pub about: String,
    /// Gravity in m/s².
    pub gravity: D::Vec,
    /// Whether bodies may fall asleep.
    pub sleeping: bool,
    /// How long it runs.
    pub plan: Plan,
    /// The bodies.
    pub bodies: Vec<Body<D>>,
    /// The joints.
    pub joints: Vec<Joint<D>>,
    /// The rays of queries.
    pub rays: Vec<Ray<D>>,
    /// Radius of the ball that shape casts sweep.
    pub cast_radius: f32,
    /// Dynamic bodies outside of this box at the end have escaped.
    pub bounds: (D::Vec, D::Vec),
    /// The body whose displacement is reported as drift, the top of a pyramid.
    pub watch: Option<usize>,
    /// A body that moves along a path.
    pub drive: Option<Drive<D>>,
    /// A chain that is watched in every step.
    pub chain: Option<Chain>,
}

impl<D: Dimension> Scene<D> {
    /// An empty world with gravity of 10 m/s², in which no body sleeps.
    pub fn new(about: impl Into<String>, plan: Plan) -> Self {
        let (mut gravity, mut low, mut high) = (D::ZERO, D::ZERO, D::ZERO);
        gravity.as_mut()[1] = -10.0;
        low.as_mut().fill(-1.0e4);
        high.as_mut().fill(1.0e4);
        Self {
            about: about.into(),
            gravity,
            sleeping: false,
            plan,
            bodies: Vec::new(),
            joints: Vec::new(),
            rays: Vec::new(),
            cast_radius: 0.0,
            bounds: (low, high),
            watch: None,
            drive: None,
            chain: None,
        }
    }
}

/// A scene in the list.
pub struct Entry<D: Dimension> {
    /// Its name.
    pub name: &'static str,
    /// The family.
    pub family: Family,
    /// Makes it.
    pub build: fn() -> Scene<D>,
}

impl<D: Dimension> Entry<D> {
    /// Whether an engine must have this to run the scene.
    pub fn needs(&self, scene: &Scene<D>, need: Need) -> bool {
        match need {
            Need::Physics => !self.family.is_mostly_still(),
            Need::Joints => !scene.joints.is_empty(),
            Need::Queries => self.family == Family::Queries,
            Need::Batches => scene.plan.work == Work::RaycastBatches,
            Need::Meshes => scene.bodies.iter().flat_map(|b| &b.parts).any(|p| D::is_mesh(&p.shape)),
            Need::Children => scene.bodies.iter().any(|b| b.only_shape().is_none()),
        }
    }
}

/// A dimension that has scenes.
pub trait Scenes: Dimension {
    /// All of them.
    const ALL: &'static [Entry<Self>];
}

/// The scene of that name.
pub fn find<D: Scenes>(name: &str) -> Option<&'static Entry<D>> {
    D::ALL.iter().find(|entry| entry.name == name)
}
