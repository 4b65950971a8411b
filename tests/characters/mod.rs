//! Characters: shapes that slide along what they meet.

mod carried;
mod course;
mod crouch;
mod friends;
mod mover;
mod own;
mod passing;
mod slide;
mod state;
mod walk;

use avian::{
    character_controller::controller::{
        CharacterClimbed, CharacterController, CharacterInput, CharacterState,
    },
    math::*,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, system::RunSystemOnce};
use bevy_time::Time;
use bevy_transform::TransformPlugin;
use core::time::Duration;

pub use super::characters_dim::*;

/// The tick rates of the course, in Hz.
pub const RATES: [u32; 6] = [30, 60, 64, 144, 240, 360];

/// The rates at which a figure is tested: the first one at all, to save time.
pub fn rates(name: &str) -> &'static [u32] {
    if name == "capsule" { &RATES } else { &[30, 144] }
}

/// The distance that shapes keep, in metres.
pub const SKIN: Scalar = 0.01;

pub fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.finish();
    app.cleanup();
    app
}

/// A body that does not move.
pub fn fixed(app: &mut App, shape: Collider, at: Vector, rotation: Rotation) -> Entity {
    app.world_mut().spawn((RigidBody::Static, shape, Position(at), rotation)).id()
}

/// A floor with its top at height 0, 400 m long.
pub fn floor(app: &mut App) -> Entity {
    fixed(app, block(Vector::ONE * 399.0 + Vector::X), Vector::NEG_Y * 199.5, Rotation::IDENTITY)
}

pub fn step(app: &mut App, dt: Duration) {
    app.world_mut().resource_mut::<Time>().advance_by(dt);
    app.update();
}

/// What a system with a mover gives.
pub fn ask<R: Send + Sync + 'static>(
    app: &mut App,
    question: impl Fn(&MoveAndSlide) -> R + Send + Sync + 'static,
) -> R {
    app.world_mut().run_system_once(move |mover: MoveAndSlide| question(&mover)).expect("the system runs")
}

/// A course with a character.
pub struct Course {
    pub app: App,
    pub player: Entity,
    rate: u32,
    ticks: u32,
}

/// A character after a tick.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    pub tick: u32,
    pub position: Vector,
    pub state: CharacterState,
    /// How far it climbed in the tick.
    pub climbed: Scalar,
}

impl Course {
    pub fn new(rate: u32, shape: Collider, at: Vector) -> Self {
        let mut app = app();
        app.insert_resource(Gravity(Vector::NEG_Y * 9.81));
        let player = app.world_mut().spawn((CharacterController::default(), shape, Position(at))).id();
        Self { app, player, rate, ticks: 0 }
    }

    pub fn get<C: Component + Copy>(&self, entity: Entity) -> C {
        *self.app.world().get::<C>(entity).expect("it has one")
    }

    pub fn position(&self) -> Vector {
        self.get::<Position>(self.player).0
    }

    pub fn state(&self) -> CharacterState {
        self.get(self.player)
    }

    pub fn jump(&mut self, speed: Scalar) {
        self.app.world_mut().get_mut::<CharacterInput>(self.player).expect("a character").jump = speed;
    }

    /// Takes one step.
    pub fn tick(&mut self) -> Sample {
        // Whole nanoseconds that do not drift.
        let at = |tick: u32| Duration::from_nanos(u64::from(tick) * 1_000_000_000 / u64::from(self.rate));
        let dt = at(self.ticks + 1) - at(self.ticks);
        step(&mut self.app, dt);
        self.ticks += 1;
        let mut messages = self.app.world_mut().resource_mut::<Messages<CharacterClimbed>>();
        let climbed = messages.drain().map(|event| event.height).sum();
        Sample { tick: self.ticks, position: self.position(), state: self.state(), climbed }
    }

    /// Walks at a velocity for some seconds.
    pub fn walk(&mut self, velocity: Vector, seconds: Scalar) -> Vec<Sample> {
        self.app.world_mut().get_mut::<CharacterInput>(self.player).expect("a character").velocity = velocity;
        (0..(seconds * self.rate as Scalar).round() as u32).map(|_| self.tick()).collect()
    }
}
