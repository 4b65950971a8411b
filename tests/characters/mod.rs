//! Characters: shapes that slide along what they meet.

mod carried;
mod course;
mod crouch;
mod crowds;
mod friends;
mod mover;
mod own;
mod passing;
mod planets;
mod slide;
mod state;
mod tight;
mod walk;

use avian::{
    character_controller::controller::{
        CharacterClimbed, CharacterController, CharacterInput, CharacterState,
    },
    math::*,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{
    prelude::*,
    schedule::{Schedules, SingleThreadedExecutor},
    system::RunSystemOnce,
};
use bevy_time::Time;
use bevy_transform::TransformPlugin;
use core::time::Duration;

pub use super::characters_dim::*;

/// The tick rates of the course, in Hz.
const RATES: [u32; 6] = [30, 60, 64, 144, 240, 360];

/// Some rates, to save time; with `AVIAN_LONG_TESTS=1` every rate.
pub fn some(rates: &'static [u32]) -> &'static [u32] {
    if std::env::var_os("AVIAN_LONG_TESTS").is_some() { &RATES } else { rates }
}

/// The rates of most tests: a low one, the default and a high one, or every rate.
pub fn usual() -> impl Iterator<Item = u32> {
    some(&[30, 64, 144]).iter().copied()
}

/// The rates at which a figure is tested: the capsule at three, the others at two.
pub fn rates(name: &str) -> &'static [u32] {
    some(if name == "capsule" { &[30, 64, 144] } else { &[30, 144] })
}

/// Each figure in each of some cases.
pub fn each<C: Copy>(cases: &[C]) -> Vec<(&'static str, C, Collider)> {
    let with = |case: &C| {
        let case = *case;
        figures().into_iter().map(move |(name, shape)| (name, case, shape))
    };
    cases.iter().flat_map(with).collect()
}

/// The distance that shapes keep, in metres.
pub const SKIN: Scalar = 0.01;

pub fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.finish();
    app.cleanup();
    stay_on_one_thread(&mut app);
    app
}

/// Handing systems of nearly empty schedules between threads would take most of the time.
pub fn stay_on_one_thread(app: &mut App) {
    for (_, schedule) in app.world_mut().resource_mut::<Schedules>().iter_mut() {
        schedule.set_executor(SingleThreadedExecutor::new());
    }
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

/// A course with one character, or several side by side.
pub struct Course {
    pub app: App,
    /// The first character.
    pub player: Entity,
    pub players: Vec<Entity>,
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

/// The layers of a lane: what is in it meets what is in the same lane, and what has no layers.
pub fn lane(index: usize) -> CollisionLayers {
    let own = 2 << index;
    CollisionLayers::new(LayerMask(own), LayerMask(own | 1))
}

/// All figures, side by side at a place.
pub fn all_at(rate: u32, at: Vector) -> Course {
    Course::side_by_side(rate, figures().into_iter().map(|(_, shape)| (shape, at)))
}

impl Course {
    pub fn new(rate: u32, shape: Collider, at: Vector) -> Self {
        Self::side_by_side(rate, [(shape, at)])
    }

    /// Up to 31 characters in one world, each in a lane of its own.
    pub fn side_by_side(rate: u32, starts: impl IntoIterator<Item = (Collider, Vector)>) -> Self {
        let mut app = app();
        app.insert_resource(Gravity(Vector::NEG_Y * 9.81));
        let spawn = |(i, (shape, at))| {
            app.world_mut().spawn((CharacterController::default(), shape, Position(at), lane(i))).id()
        };
        let players: Vec<Entity> = starts.into_iter().enumerate().map(spawn).collect();
        Self { app, player: players[0], players, rate, ticks: 0 }
    }

    /// A body that does not move, in the lane of a character.
    pub fn fix_in_lane(&mut self, index: usize, shape: Collider, at: Vector, rotation: Rotation) -> Entity {
        let body = fixed(&mut self.app, shape, at, rotation);
        self.app.world_mut().entity_mut(body).insert(lane(index));
        body
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

    /// Puts a character elsewhere.
    pub fn put(&mut self, index: usize, at: Vector) {
        self.app.world_mut().entity_mut(self.players[index]).insert(Position(at));
    }

    /// Lets all characters jump.
    pub fn jump(&mut self, speed: Scalar) {
        for &player in &self.players {
            self.app.world_mut().get_mut::<CharacterInput>(player).expect("a character").jump = speed;
        }
    }

    /// Takes one step. Returns what became of the first character.
    pub fn tick(&mut self) -> Sample {
        self.tick_all()[0]
    }

    /// Takes one step. Returns what became of each character.
    pub fn tick_all(&mut self) -> Vec<Sample> {
        // Whole nanoseconds that do not drift.
        let at = |tick: u32| Duration::from_nanos(u64::from(tick) * 1_000_000_000 / u64::from(self.rate));
        let dt = at(self.ticks + 1) - at(self.ticks);
        step(&mut self.app, dt);
        self.ticks += 1;
        let steps: Vec<CharacterClimbed> =
            self.app.world_mut().resource_mut::<Messages<CharacterClimbed>>().drain().collect();
        let sample = |&player: &Entity| {
            let own = steps.iter().filter(|step| step.character == player);
            let climbed = own.map(|step| step.height).sum();
            let position = self.get::<Position>(player).0;
            Sample { tick: self.ticks, position, state: self.get(player), climbed }
        };
        self.players.iter().map(sample).collect()
    }

    /// Walks at a velocity for some seconds. Returns the path of the first character.
    pub fn walk(&mut self, velocity: Vector, seconds: Scalar) -> Vec<Sample> {
        self.walk_all(|_| velocity, seconds).swap_remove(0)
    }

    /// Walks for some seconds, each character at a velocity of its own. Returns their paths.
    pub fn walk_all(&mut self, velocity: impl Fn(usize) -> Vector, seconds: Scalar) -> Vec<Vec<Sample>> {
        for (i, &player) in self.players.iter().enumerate() {
            let mut input = self.app.world_mut().get_mut::<CharacterInput>(player).expect("a character");
            input.velocity = velocity(i);
        }
        let mut paths = vec![Vec::new(); self.players.len()];
        for _ in 0..(seconds * self.rate as Scalar).round() as u32 {
            let samples = self.tick_all();
            paths.iter_mut().zip(samples).for_each(|(path, sample)| path.push(sample));
        }
        paths
    }
}
