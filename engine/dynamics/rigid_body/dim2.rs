//! Body components of 2D. `dim3.rs` exports the same names.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use super::{LockedAxes, mass_properties::components::ComputedAngularInertia};
use crate::{math::Scalar, physics_transform::Rotation};

/// Angular velocity of a body, in rad/s, counter-clockwise.
///
/// Dynamic and kinematic bodies rotate about their centre of mass, not about their origin. To turn a
/// kinematic door about its edge, put the origin at the hinge, the collider beside it on a child, and the
/// centre of mass at the origin. With [`FollowTransform`](crate::physics_transform::FollowTransform) the app
/// rotates the `Transform`, and the engine sets both velocities. A dynamic door needs a
/// [`RevoluteJoint`](crate::dynamics::joints::RevoluteJoint). The example `hinged_door` shows all three.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// fn setup(mut commands: Commands) {
///     let hinge = (CenterOfMass::ZERO, NoAutoCenterOfMass);
///     commands
///         .spawn((RigidBody::Kinematic, hinge, Transform::from_xyz(3.0, 0.0, 0.0), AngularVelocity(1.0)))
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
pub struct AngularVelocity(pub Scalar);

crate::type_path::type_path!(AngularVelocity, "dynamics::rigid_body");

impl AngularVelocity {
    /// No rotation.
    pub const ZERO: AngularVelocity = AngularVelocity(0.0);
}

/// The angular inertia in world axes, infinite if rotation is locked.
pub(super) fn world_inertia(
    inertia: ComputedAngularInertia,
    _rotation: &Rotation,
    locks: LockedAxes,
) -> ComputedAngularInertia {
    if locks.is_rotation_locked() { ComputedAngularInertia::INFINITY } else { inertia }
}
