//! A world with a witness that must stay unaffected, and helpers to add bodies and read their state.

use avian::{
    math::{Scalar, Vector},
    parry::shape::SharedShape,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

const DT: Duration = Duration::from_nanos(1_000_000_000 / 60);
/// Invalid coordinates.
pub const WRONG: [Scalar; 3] = [Scalar::NAN, Scalar::INFINITY, Scalar::NEG_INFINITY];
/// Invalid lengths, masses and densities.
pub const WRONG_SIZES: [Scalar; 5] = [Scalar::NAN, Scalar::INFINITY, Scalar::NEG_INFINITY, 0.0, -1.0];

pub fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.finish();
    app.cleanup();
    app
}

pub fn step_by(app: &mut App, dt: Duration) {
    app.world_mut().resource_mut::<Time>().advance_by(dt);
    app.update();
}

pub fn steps(app: &mut App, count: u32) {
    (0..count).for_each(|_| step_by(app, DT));
}

pub fn ball() -> Collider {
    SharedShape::ball(0.5).into()
}

/// A box with three different sides.
pub fn block() -> Collider {
    Collider::convex_hull(corners(0.5)).expect("a box is convex")
}

/// The corners of a square or cube by its half side.
pub fn corners(half: Scalar) -> Vec<Vector> {
    let double = |found: Vec<Vector>, axis: Vector| {
        found.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect()
    };
    Vector::AXES.into_iter().fold(vec![Vector::ZERO], double)
}

pub fn at(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

pub fn floor(app: &mut App) -> Entity {
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y))).id()
}

/// A ball on the floor.
pub fn resting(app: &mut App, x: f32) -> Entity {
    app.world_mut().spawn((RigidBody::Dynamic, ball(), at(x, 0.5))).id()
}

pub fn position(app: &App, entity: Entity) -> Vector {
    app.world().get::<Position>(entity).expect("a body has a position").0
}

pub fn is_disabled(app: &App, entity: Entity) -> bool {
    app.world().get::<RigidBodyDisabled>(entity).is_some()
}

/// A floor with a ball at rest on it, which must stay unaffected.
pub struct Witness {
    pub app: App,
    pub ball: Entity,
}

impl Witness {
    pub fn new() -> Self {
        let mut app = app();
        floor(&mut app);
        let ball = resting(&mut app, -20.0);
        Self { app, ball }
    }

    pub fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        self.app.world_mut().spawn(bundle).id()
    }

    pub fn insert(&mut self, entity: Entity, bundle: impl Bundle) {
        self.app.world_mut().entity_mut(entity).insert(bundle);
    }

    /// Takes steps. Then the witness is at its place, and a new body falls and comes to rest.
    pub fn is_undisturbed(&mut self) {
        steps(&mut self.app, 30);
        let late = self.spawn((RigidBody::Dynamic, ball(), at(-30.0, 0.7)));
        steps(&mut self.app, 60);
        for (entity, x) in [(self.ball, -20.0), (late, -30.0)] {
            let off = position(&self.app, entity) - (Vector::X * x + Vector::Y * 0.5);
            assert!(off.length() < 0.02, "the witness is off by {off}");
            assert!(!is_disabled(&self.app, entity));
        }
        self.app.world_mut().despawn(late);
    }
}

/// Whether a body is a witness.
pub fn is_witness(position: &Position) -> bool {
    position.x < -10.0
}
