//! A running scene behind one interface, whichever dimension it is of: what the headless runner and the window share.

use bevy_math::Vec3;

use crate::draw::{Drawable, View};

/// A scene that can be started.
#[derive(Clone, Copy)]
pub struct Entry {
    /// Two or three.
    pub dimension: u32,
    /// The scene's name, the same in both dimensions.
    pub name: &'static str,
    /// One line about it.
    pub about: &'static str,
    /// Steps of a full run.
    pub steps: u32,
    /// What to show.
    pub view: View,
    /// What its drift is: `moved` or `outside`.
    pub drift: &'static str,
    /// Builds the scene in a world of its own.
    pub start: fn(&'static str) -> Option<Box<dyn Simulation>>,
}

/// A world with a scene in it.
pub trait Simulation {
    /// Advances by one step of physics, through the whole `App`.
    fn step(&mut self);
    /// All colliders as they stand.
    fn drawables(&mut self) -> Vec<Drawable>;
    /// The numbers that are cheap enough for each frame.
    fn counts(&mut self) -> Counts;
    /// The numbers for the table.
    fn measures(&mut self) -> Measures;
}

/// How much there is.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Dynamic and kinematic bodies.
    pub bodies: usize,
    /// Pairs of colliders in the last step that touch or are near, if the engine tells.
    pub contacts: Option<u32>,
    /// Sleeping bodies.
    pub asleep: usize,
}

/// How well it goes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// Kinetic and potential energy of the dynamic bodies in joules, the latter from y = 0.
    pub energy: f64,
    /// What the scene watches, in metres.
    pub drift: f32,
    /// The deepest overlap of two colliders in metres, at least zero.
    pub overlap: f32,
    /// Positions that are no numbers.
    pub broken: usize,
}

/// Every scene, those of the plane first.
pub fn catalogue() -> Vec<Entry> {
    let mut entries = crate::dim2::entries();
    entries.extend(crate::dim3::entries());
    entries
}

/// The view of a scene with these bounds.
pub fn view(min: Vec3, max: Vec3, eye: Vec3) -> View {
    View { min, max, eye }
}
