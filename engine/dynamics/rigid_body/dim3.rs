//! Body components of 3D. `dim2.rs` exports the same names.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use super::{LockedAxes, mass_properties::components::ComputedAngularInertia};
use crate::{
    math::{Vector, inv_inertia_from_kernel, inv_inertia_to_kernel},
    physics_transform::Rotation,
};

/// Angular velocity of a body, in rad/s about each of the world's axes, right-handed.
///
/// Dynamic and kinematic bodies rotate about their centre of mass, not about their origin. To turn a
/// kinematic door about its edge, put the origin at the hinge, the collider beside it on a child, and the
/// centre of mass at the origin. With [`FollowTransform`](crate::physics_transform::FollowTransform) the app
/// rotates the `Transform`, and the engine sets both velocities. A dynamic door needs a
/// [`RevoluteJoint`](crate::dynamics::joints::RevoluteJoint). The example `hinged_door` shows all three.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// fn setup(mut commands: Commands) {
///     let hinge = (CenterOfMass::ZERO, NoAutoCenterOfMass);
///     commands
///         .spawn((RigidBody::Kinematic, hinge, Transform::from_xyz(3.0, 0.0, 0.0), AngularVelocity(Vector::Y)))
///         .with_child((Collider::capsule(0.1, 1.0), Transform::from_xyz(1.0, 0.0, 0.0)));
/// }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct AngularVelocity(pub Vector);

crate::type_path::type_path!(AngularVelocity, "dynamics::rigid_body");

impl AngularVelocity {
    /// No rotation.
    pub const ZERO: AngularVelocity = AngularVelocity(Vector::ZERO);
}

/// The angular inertia in world axes, infinite about locked axes.
pub(super) fn world_inertia(
    inertia: ComputedAngularInertia,
    rotation: &Rotation,
    locks: LockedAxes,
) -> ComputedAngularInertia {
    let world = inertia.rotated(rotation.0);
    let locks = locks.to_kernel();
    if locks.rotation() == 0 {
        return world;
    }
    let inverse = inv_inertia_to_kernel(world.inverse()).locked(locks);
    ComputedAngularInertia::from_inverse_tensor(inv_inertia_from_kernel(inverse))
}
