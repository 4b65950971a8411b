//! A running scene of either dimension behind one interface, for the headless runner and the window.

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
    /// The view for pictures.
    pub view: View,
    /// The meaning of its drift: `moved` or `outside`.
    pub drift: &'static str,
    /// Builds the scene in a world of its own.
    pub start: fn(&'static str) -> Option<Box<dyn Simulation>>,
}

/// A world with a scene in it.
pub trait Simulation {
    /// Advances by one step of physics, through the whole `App`.
    fn step(&mut self);
    /// All colliders at their current poses.
    fn drawables(&mut self) -> Vec<Drawable>;
    /// Counts that are cheap enough for each frame.
    fn counts(&mut self) -> Counts;
    /// Measures for the table.
    fn measures(&mut self) -> Measures;
}

/// Counts of a world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Dynamic and kinematic bodies.
    pub bodies: usize,
    /// Number of contacts in the last step, if the engine reports it.
    pub contacts: Option<u32>,
    /// Sleeping bodies.
    pub asleep: usize,
}

/// Measures of quality.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Measures {
    /// Kinetic and potential energy of the dynamic bodies in joules, the latter from y = 0.
    pub energy: f64,
    /// The drift of the scene, in metres.
    pub drift: f32,
    /// The deepest overlap of two colliders in metres, at least zero.
    pub overlap: f32,
    /// Number of positions that are not finite.
    pub broken: usize,
}

/// Every scene, 2D ones first.
pub fn catalogue() -> Vec<Entry> {
    let mut entries = crate::dim2::entries();
    entries.extend(crate::dim3::entries());
    entries
}

/// The view of a scene with these bounds.
pub fn view(min: Vec3, max: Vec3, eye: Vec3) -> View {
    View { min, max, eye }
}
