//! Joints in an app: their life cycle in every order, what they do to bodies, and where they are listed.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

mod breaking;
mod coupled;
mod generic;
mod graph;
mod life;
mod motors;
mod mouse;
mod physics;
mod ragdoll;
mod random;
mod solver;
mod wheel;

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_math::Quat;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

use super::joints_dim::{angle_of, dim_wheel, rod, spin_of};

/// The length of a step, in s.
pub const DT: Scalar = 1.0 / 64.0;
/// Gravity downwards, in m/s².
pub const G: Scalar = 10.0;

/// An app that is stepped by hand, at 64 Hz in 8 substeps.
pub struct Rig {
    pub app: App,
}

impl Rig {
    pub fn new() -> Self {
        Self::with(PhysicsPlugins::new(Update).build())
    }

    pub fn with(plugins: bevy_app::PluginGroupBuilder) -> Self {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, plugins));
        app.insert_resource(Gravity(Vector::Y * -G)).insert_resource(SubstepCount(8));
        app.finish();
        app.cleanup();
        Self { app }
    }

    pub fn weightless() -> Self {
        let mut rig = Self::new();
        rig.app.insert_resource(Gravity::ZERO);
        rig
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

    /// A static body at a point.
    pub fn post(&mut self, x: Scalar, y: Scalar) -> Entity {
        self.spawn((RigidBody::Static, at(x, y)))
    }

    /// A body of 2 kg without a collider that has a moment of inertia of 0.5 kg·m², at a point.
    pub fn rod(&mut self, x: Scalar, y: Scalar) -> Entity {
        self.spawn((rod(), at(x, y)))
    }

    pub fn step(&mut self) {
        self.app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 64.0));
        self.app.update();
    }

    pub fn steps(&mut self, count: u32) {
        (0..count).for_each(|_| self.step());
    }

    pub fn get<C: Component>(&self, entity: Entity) -> &C {
        self.app.world().get::<C>(entity).expect("it has the component")
    }

    pub fn place(&self, entity: Entity) -> Vector {
        self.get::<Position>(entity).0
    }

    pub fn angle(&self, entity: Entity) -> Scalar {
        angle_of(*self.get::<Rotation>(entity))
    }

    /// The angular velocity about z.
    pub fn spin(&self, entity: Entity) -> Scalar {
        spin_of(*self.get::<AngularVelocity>(entity))
    }

    /// Whether a joint acts on its bodies: whether it has forces.
    pub fn acts(&self, joint: Entity) -> bool {
        let forces = self.get::<JointForces>(joint);
        forces.force().length() > 1e-3
    }

    pub fn sleeps(&self, entity: Entity) -> bool {
        self.app.world().get::<Sleeping>(entity).is_some()
    }
}

/// The mass of a [`Rig::rod`], in kg.
pub const MASS: Scalar = 2.0;
/// Its moment of inertia, in kg·m².
pub const INERTIA: Scalar = 0.5;

/// A point in the plane.
pub fn at(x: Scalar, y: Scalar) -> (Transform, Position) {
    let position = Vector::X * x + Vector::Y * y;
    (Transform::from_xyz(x as f32, y as f32, 0.0), Position(position))
}

/// A turn about z.
pub fn turned(angle: Scalar) -> Rotation {
    Rotation::from(Quat::from_rotation_z(angle as f32))
}

/// A point in the plane.
pub fn xy(x: Scalar, y: Scalar) -> Vector {
    Vector::X * x + Vector::Y * y
}
