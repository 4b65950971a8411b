//! A small laboratory: an app that is stepped by hand, with helpers to add bodies and read their state.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;
use scenes::{headless_app, headless_app_with, scene::at};

use super::dim;

/// Downward gravity in m/s².
pub const G: Scalar = 10.0;

/// An app and the length of its steps.
pub struct Lab {
    pub app: App,
    pub dt: f64,
}

impl Lab {
    /// Steps of 1/60 s in 4 substeps, gravity of [`G`] downwards.
    pub fn new() -> Self {
        Self::with_steps(1.0 / 60.0, 4)
    }

    pub fn with_steps(dt: f64, substeps: u32) -> Self {
        Self::of(headless_app(dt, substeps), dt)
    }

    /// Like [`Lab::new`], where a metre is `unit` long.
    pub fn with_unit(unit: Scalar) -> Self {
        let dt = 1.0 / 60.0;
        Self::of(headless_app_with(dt, 4, PhysicsPlugins::default().with_length_unit(unit)), dt)
    }

    fn of(mut app: App, dt: f64) -> Self {
        app.insert_resource(Gravity(Vector::Y * -G));
        Self { app, dt }
    }

    pub fn weightless() -> Self {
        let mut lab = Self::new();
        lab.gravity(Vector::ZERO);
        lab
    }

    pub fn gravity(&mut self, gravity: Vector) {
        self.app.insert_resource(Gravity(gravity));
    }

    /// Default friction and restitution.
    pub fn surfaces(&mut self, friction: Scalar, restitution: Scalar) {
        self.app.insert_resource(DefaultFriction(Friction::new(friction)));
        self.app.insert_resource(DefaultRestitution(Restitution::new(restitution)));
    }

    pub fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        self.app.world_mut().spawn(bundle).id()
    }

    pub fn insert(&mut self, entity: Entity, bundle: impl Bundle) {
        self.app.world_mut().entity_mut(entity).insert(bundle);
    }

    pub fn remove<B: Bundle>(&mut self, entity: Entity) {
        self.app.world_mut().entity_mut(entity).remove::<B>();
    }

    pub fn despawn(&mut self, entity: Entity) {
        self.app.world_mut().entity_mut(entity).despawn();
    }

    /// A wide static block whose top is y = 0.
    pub fn floor(&mut self) -> Entity {
        self.spawn((RigidBody::Static, dim::sized_block(400.0, 20.0, 400.0), at(0.0, -10.0, 0.0)))
    }

    /// A dynamic box of the given size.
    pub fn block(&mut self, size: [f32; 3], pose: Transform) -> Entity {
        let [x, y, z] = size;
        self.spawn((RigidBody::Dynamic, dim::sized_block(x, y, z), pose))
    }

    /// A dynamic unit box.
    pub fn unit_box(&mut self, pose: Transform) -> Entity {
        self.block([1.0; 3], pose)
    }

    /// A dynamic ball.
    pub fn ball(&mut self, radius: f32, pose: Transform) -> Entity {
        self.spawn((RigidBody::Dynamic, scenes::dim::ball(radius), pose))
    }

    /// Takes `count` steps.
    pub fn steps(&mut self, count: usize) {
        for _ in 0..count {
            scenes::step(&mut self.app);
        }
    }

    /// Takes the steps of a duration.
    pub fn seconds(&mut self, seconds: f64) {
        self.steps((seconds / self.dt).round() as usize);
    }

    #[track_caller]
    pub fn get<C: Component + Clone>(&self, entity: Entity) -> C {
        self.app.world().get::<C>(entity).expect("the entity has the component").clone()
    }

    pub fn has<C: Component>(&self, entity: Entity) -> bool {
        self.app.world().get::<C>(entity).is_some()
    }

    pub fn at(&self, entity: Entity) -> Vector {
        self.get::<Position>(entity).0
    }

    pub fn velocity(&self, entity: Entity) -> Vector {
        self.get::<LinearVelocity>(entity).0
    }

    /// The angular velocity about z.
    pub fn spin(&self, entity: Entity) -> Scalar {
        dim::spin_of(self.get(entity))
    }

    /// The y component of the body's own y axis: 1 upright, 0 on its side.
    pub fn uprightness(&self, entity: Entity) -> Scalar {
        (self.get::<Rotation>(entity) * Vector::Y).y
    }

    /// The bits of all positions, rotations and velocities, in the order of `bodies`.
    pub fn bits(&self, bodies: &[Entity]) -> Vec<u32> {
        let mut bits = Vec::new();
        for &body in bodies {
            bits.extend(self.at(body).to_array().map(Scalar::to_bits));
            bits.extend(dim::rotation_bits(self.get(body)));
            bits.extend(self.velocity(body).to_array().map(Scalar::to_bits));
        }
        bits
    }
}

/// Fails unless `got` is `want` within the fraction `tolerance` of it.
#[track_caller]
pub fn assert_close(got: Scalar, want: Scalar, tolerance: Scalar, what: &str) {
    let error = (got - want).abs() / want.abs();
    assert!(error <= tolerance, "{what}: {got} is not {want}, off by {:.3} %", 100.0 * error);
}
