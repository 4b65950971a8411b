//! Forces, torques, impulses and accelerations.

mod applied;
mod closed_forms;
mod queries;
mod timing;
mod waking;

use avian::{
    dynamics::{
        integrator::VelocityIntegrationData,
        rigid_body::forces::{AccumulatedLocalAcceleration, ForcesItem, ForcesReadOnly},
    },
    math::{AsF32, Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};
use bevy_math::Quat;
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::{TransformPlugin, components::Transform};
use core::{fmt::Debug, ops::Sub, time::Duration};

use super::forces_dim::{Angular, about_z, body, z_of};

/// The length of a step, of which the clock has no rounding error.
pub const DT: Scalar = 1.0 / 64.0;
/// The length of a substep.
pub const H: Scalar = DT / 4.0;

/// An app without gravity that is stepped by hand, at 64 Hz in 4 substeps.
pub struct Lab {
    pub app: App,
}

impl Lab {
    pub fn new() -> Self {
        Self::with(PhysicsPlugins::new(Update).build())
    }

    pub fn with(plugins: bevy_app::PluginGroupBuilder) -> Self {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, plugins));
        app.insert_resource(Gravity::ZERO).insert_resource(SubstepCount(4));
        app.finish();
        app.cleanup();
        Self { app }
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

    /// Applies forces to a body, between two steps.
    pub fn apply(&mut self, entity: Entity, apply: impl FnOnce(&mut ForcesItem)) {
        let world = self.app.world_mut();
        let mut query = world.query::<Forces>();
        apply(&mut query.get_mut(world, entity).expect("a body has forces"));
    }

    pub fn step(&mut self) {
        self.app.world_mut().resource_mut::<Time>().advance_by(Duration::from_nanos(15_625_000));
        self.app.update();
    }

    pub fn steps(&mut self, count: usize) {
        (0..count).for_each(|_| self.step());
    }

    #[track_caller]
    pub fn get<C: Component + Clone>(&self, entity: Entity) -> C {
        self.app.world().get::<C>(entity).expect("the entity has the component").clone()
    }

    pub fn at(&self, entity: Entity) -> Vector {
        self.get::<Position>(entity).0
    }

    pub fn velocity(&self, entity: Entity) -> Vector {
        self.get::<LinearVelocity>(entity).0
    }

    pub fn spin(&self, entity: Entity) -> Angular {
        self.get::<AngularVelocity>(entity).0
    }

    pub fn sleeps(&self, entity: Entity) -> bool {
        self.app.world().get::<Sleeping>(entity).is_some()
    }

    pub fn pause(&mut self, paused: bool) {
        let mut clock = self.app.world_mut().resource_mut::<Time<Physics>>();
        if paused { clock.pause() } else { clock.unpause() }
    }

    /// A box of 1 m and 1 kg, asleep on a floor, in gravity of 10 m/s².
    pub fn sleeper(&mut self) -> Entity {
        self.app.insert_resource(Gravity(Vector::Y * -10.0));
        self.spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
        let sleeper = self.spawn((
            RigidBody::Dynamic,
            cube(),
            Mass(1.0),
            Friction::new(0.5),
            Transform::from_xyz(0.0, 0.5, 0.0),
        ));
        self.steps(100);
        assert!(self.sleeps(sleeper), "a box at rest sleeps");
        sleeper
    }
}

/// A box of 1 m.
pub fn cube() -> Collider {
    let mut corners = vec![Vector::ZERO];
    for axis in Vector::AXES {
        corners = corners.iter().flat_map(|c| [*c - axis * 0.5, *c + axis * 0.5]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

/// The length of a vector or number.
pub trait Length {
    fn size(self) -> Scalar;
}

impl Length for Vector {
    fn size(self) -> Scalar {
        self.length()
    }
}

impl Length for Scalar {
    fn size(self) -> Scalar {
        self.abs()
    }
}

#[track_caller]
pub fn near<V: Copy + Debug + Sub<Output = V> + Length>(got: V, want: V, tolerance: Scalar, what: &str) {
    let error = (got - want).size();
    assert!(error <= tolerance, "{what}: {got:?} is not {want:?}, off by {error}");
}

pub fn turned(angle: f32) -> Rotation {
    Rotation::from(Quat::from_rotation_z(angle))
}

pub trait Plane {
    fn new_xy(x: Scalar, y: Scalar) -> Vector;
}

impl Plane for Vector {
    fn new_xy(x: Scalar, y: Scalar) -> Vector {
        Vector::X * x + Vector::Y * y
    }
}

/// Applies one of everything.
pub fn apply_all(forces: &mut impl RigidBodyForces, push: Vector, turn: Angular) {
    let point = forces.position().0 + Vector::ONE;
    forces.apply_force(push);
    forces.apply_force_at_point(push, point);
    forces.apply_local_force(push);
    forces.apply_torque(turn);
    forces.apply_linear_impulse(push);
    forces.apply_linear_impulse_at_point(push, point);
    forces.apply_local_linear_impulse(push);
    forces.apply_angular_impulse(turn);
    forces.apply_linear_acceleration(push);
    forces.apply_linear_acceleration_at_point(push, point);
    forces.apply_local_linear_acceleration(push);
    forces.apply_angular_acceleration(turn);
}
