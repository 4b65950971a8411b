//! What a scene is: plain data, so that every engine gets the same one.

use serde::{Deserialize, Serialize};

use crate::world::{Body, Dimension, Joint, Ray};

/// What a scene is to show. Tables and plots are per family.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize, Deserialize)]
pub enum Family {
    /// How long a step takes in which much moves.
    Speed,
    /// How long a batch of queries takes.
    Queries,
    /// What a world costs in which little or nothing moves.
    Idle,
    /// What a step costs with hardly anything in it.
    Small,
    /// How long adding and removing a whole level takes.
    Bulk,
    /// How the time grows with the number of bodies.
    Growth,
}

impl Family {
    /// Whether hardly anything moves: what it costs to have the bodies at all is then worth knowing.
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
    /// Batches of sweeps of a ball against a world at rest.
    Ballcasts,
    /// Adding all bodies to an empty world, and the step that takes them in.
    Spawn,
    /// Removing all bodies, and the step that lets them go.
    Despawn,
}

/// What a scene may ask for beyond single bodies of one shape. An engine's build may lack some of it and is then
/// not given the scenes that need it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Need {
    /// That anything moves at all.
    Physics,
    /// Joints.
    Joints,
    /// Rays and shape casts.
    Queries,
    /// Triangle meshes.
    Meshes,
    /// Bodies with several shapes, or with one that is not at the body's origin.
    Children,
}

/// How long a scene runs: `settle` steps are not timed, `timed` are.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// What is timed.
    pub work: Work,
    /// How many steps come before.
    pub settle: usize,
    /// How many steps or batches are timed.
    pub timed: usize,
}

impl Plan {
    /// Steps, after a few to warm up.
    pub const fn steps(timed: usize) -> Self {
        Self { work: Work::Steps, settle: 5, timed }
    }

    /// Steps, after some in which the scene comes to where it is interesting.
    pub const fn settled(settle: usize, timed: usize) -> Self {
        Self { work: Work::Steps, settle, timed }
    }

    /// Batches of something else.
    pub const fn batches(work: Work, timed: usize) -> Self {
        Self { work, settle: 2, timed }
    }
}

/// A kinematic body that is sent somewhere else in every step.
#[derive(Clone, Copy, Debug)]
pub struct Drive<D: Dimension> {
    /// The body.
    pub body: usize,
    /// Where it is at a time in seconds.
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

/// A world and what is done with it.
#[derive(Clone, Debug)]
pub struct Scene<D: Dimension> {
    /// What is to be seen in it, in one line.
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
    /// What queries look along.
    pub rays: Vec<Ray<D>>,
    /// Radius of the ball that shape casts sweep.
    pub cast_radius: f32,
    /// Dynamic bodies that end outside of this box have escaped.
    pub bounds: (D::Vec, D::Vec),
    /// The body whose displacement is reported as drift, the top of a pyramid.
    pub watch: Option<usize>,
    /// A body that is sent somewhere in every step.
    pub drive: Option<Drive<D>>,
}

impl<D: Dimension> Scene<D> {
    /// A world with nothing in it, in which gravity is 10 m/s² and nothing falls asleep.
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
        }
    }
}

/// A scene in the list.
pub struct Entry<D: Dimension> {
    /// Its name.
    pub name: &'static str,
    /// What it is to show.
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
