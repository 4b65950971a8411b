//! [`RigidBodyQuery`]: the components of a body, in one query.

use bevy_ecs::{prelude::*, query::QueryData};

use super::{
    AngularVelocity, Dominance, Friction, LinearVelocity, LockedAxes, Restitution, RigidBody,
    dim::world_inertia,
    mass_properties::components::{ComputedAngularInertia, ComputedCenterOfMass, ComputedMass},
    sleeping::Sleeping,
};
use crate::{
    collision::collider::Sensor,
    math::{Vector, angular_to_kernel, vector_from_kernel, vector_to_kernel},
    physics_transform::{Position, Rotation},
};

/// Query data with the components that most computations with bodies need.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn stop(mut bodies: Query<RigidBodyQuery>) {
///     for mut body in &mut bodies {
///         if body.rb.is_dynamic() && body.position.y < -100.0 {
///             body.linear_velocity.0 = Vector::ZERO;
///         }
///     }
/// }
/// ```
#[derive(QueryData)]
#[query_data(mutable)]
pub struct RigidBodyQuery {
    /// The entity.
    pub entity: Entity,
    /// The type of the body.
    pub rb: Ref<'static, RigidBody>,
    /// The position.
    pub position: &'static mut Position,
    /// The rotation.
    pub rotation: &'static mut Rotation,
    /// The velocity of the centre of mass.
    pub linear_velocity: &'static mut LinearVelocity,
    /// The angular velocity.
    pub angular_velocity: &'static mut AngularVelocity,
    /// The mass.
    pub mass: &'static mut ComputedMass,
    /// The angular inertia in the body's frame.
    pub angular_inertia: &'static mut ComputedAngularInertia,
    /// The centre of mass in the body's frame.
    pub center_of_mass: &'static mut ComputedCenterOfMass,
    /// The friction of the body, if it has its own.
    pub friction: Option<&'static Friction>,
    /// The restitution of the body, if it has its own.
    pub restitution: Option<&'static Restitution>,
    /// The locked axes, if any.
    pub locked_axes: Option<&'static LockedAxes>,
    /// The dominance, if it is set.
    pub dominance: Option<&'static Dominance>,
    /// Whether the body sleeps.
    pub is_sleeping: Has<Sleeping>,
    /// Whether the collider on the body's entity is a sensor.
    pub is_sensor: Has<Sensor>,
}

/// The methods of both query items.
macro_rules! body_methods {
    () => {
        /// The velocity in m/s of a point of the body. The point is relative to the centre of mass, along the
        /// world's axes.
        pub fn velocity_at_point(&self, point: Vector) -> Vector {
            let spin = angular_to_kernel(self.angular_velocity.0);
            self.linear_velocity.0 + vector_from_kernel(spin.cross(vector_to_kernel(point)))
        }

        /// The inverse mass along each of the world's axes, in 1/kg: zero along locked axes, and for bodies
        /// that are not dynamic.
        pub fn effective_inverse_mass(&self) -> Vector {
            if !self.rb.is_dynamic() {
                return Vector::ZERO;
            }
            let locks = self.locked_axes.copied().unwrap_or_default().to_kernel();
            vector_from_kernel(locks.translation_factors()) * self.mass.inverse()
        }

        /// The angular inertia in the body's frame, infinite for bodies that are not dynamic.
        pub fn angular_inertia(&self) -> ComputedAngularInertia {
            if self.rb.is_dynamic() { *self.angular_inertia } else { ComputedAngularInertia::INFINITY }
        }

        /// The angular inertia about the world's axes: infinite about locked axes, and for bodies that
        /// are not dynamic.
        pub fn effective_global_angular_inertia(&self) -> ComputedAngularInertia {
            if !self.rb.is_dynamic() {
                return ComputedAngularInertia::INFINITY;
            }
            let locks = self.locked_axes.copied().unwrap_or_default();
            world_inertia(*self.angular_inertia, &self.rotation, locks)
        }

        /// The dominance of the body. Bodies that are not dynamic have a higher dominance than all dynamic
        /// ones.
        pub fn dominance(&self) -> i16 {
            if self.rb.is_dynamic() {
                self.dominance.map_or(0, |dominance| i16::from(dominance.0))
            } else {
                i16::from(i8::MAX) + 1
            }
        }
    };
}

impl RigidBodyQueryItem<'_, '_> {
    body_methods!();
}

impl RigidBodyQueryReadOnlyItem<'_, '_> {
    /// The mass, infinite for bodies that are not dynamic.
    pub fn mass(&self) -> ComputedMass {
        if self.rb.is_dynamic() { *self.mass } else { ComputedMass::INFINITY }
    }

    body_methods!();
}
