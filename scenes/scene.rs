//! The definition of a scene, and helpers to build one.

use avian::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;

use crate::dim;
use crate::numbers::half_turn_parts;

/// Downward gravity of the scenes in m/s², the value that published benchmarks use.
pub const GRAVITY: f32 = 10.0;

/// Default friction.
pub const FRICTION: f32 = 0.6;

/// A world to build, the length of a run, and what to watch.
#[derive(Clone, Copy, Debug)]
pub struct Scene {
    /// Lower case with underscores; the same in both dimensions where the idea is the same.
    pub name: &'static str,
    /// Description of one line.
    pub about: &'static str,
    /// Steps of 1/60 s in a full run.
    pub steps: u32,
    /// Spawns the bodies and sets gravity and friction.
    pub build: fn(&mut World),
    /// The part of the world to show; see also [`Watch::Inside`].
    pub bounds: Bounds,
    /// Direction from the scene towards the viewer. 2D pictures always look along −z.
    pub eye: Vec3,
    /// The definition of drift.
    pub watch: Watch,
}

/// An axis-aligned box in metres; 2D ignores z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds {
    /// The lowest corner.
    pub min: Vec3,
    /// The highest corner.
    pub max: Vec3,
}

impl Bounds {
    /// The box between two corners.
    pub const fn new(min: [f32; 3], max: [f32; 3]) -> Self {
        Self { min: Vec3::from_array(min), max: Vec3::from_array(max) }
    }

    /// Distance of a point outside, zero inside; by the largest single coordinate, without z if `flat`.
    pub fn distance_outside(&self, point: Vec3, flat: bool) -> f32 {
        let out = (self.min - point).max(point - self.max).max(Vec3::ZERO);
        if flat { out.x.max(out.y) } else { out.max_element() }
    }
}

/// The meaning of a run's `drift`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Watch {
    /// Bodies marked [`Watched`] should stay in place: the maximum displacement of one of them.
    Rest,
    /// Bodies should stay within [`Scene::bounds`]: the maximum distance of a dynamic body's centre outside.
    Inside,
}

/// Marks a body that should stay in place: its initial position, in metres.
#[derive(Component, Clone, Copy, Debug)]
pub struct Watched(pub Vec3);

/// Marks a collider that pictures show as glass, because it hides the scene.
#[derive(Component, Clone, Copy, Debug, Default)]
pub struct Glass;

/// Gravity and friction of the scenes. Called first by each scene's function.
pub fn set_conditions(world: &mut World) {
    world.insert_resource(Gravity(dim::upwards(-GRAVITY)));
    world.insert_resource(DefaultFriction(Friction::new(FRICTION)));
}

/// A pose by position alone.
pub fn at(x: f32, y: f32, z: f32) -> Transform {
    Transform::from_xyz(x, y, z)
}

/// A rotation about z, in radians counter-clockwise.
pub fn turned(angle: f32) -> Quat {
    let (sin, cos) = half_turn_parts(angle);
    Quat::from_xyzw(0.0, 0.0, sin, cos)
}

/// A rotation about the upward axis, in radians; 3D only in effect.
pub fn yawed(angle: f32) -> Quat {
    let (sin, cos) = half_turn_parts(angle);
    Quat::from_xyzw(0.0, sin, 0.0, cos)
}

/// Spawns a body with one collider of the scenes' density on it.
pub fn spawn_body(
    world: &mut World,
    kind: RigidBody,
    collider: Collider,
    pose: Transform,
) -> EntityWorldMut<'_> {
    world.spawn((kind, collider, ColliderDensity(dim::DENSITY), pose))
}

/// Spawns a static box by its full side lengths.
pub fn spawn_block(world: &mut World, size: [f32; 3], pose: Transform) -> EntityWorldMut<'_> {
    spawn_body(world, RigidBody::Static, dim::block(size[0], size[1], size[2]), pose)
}
