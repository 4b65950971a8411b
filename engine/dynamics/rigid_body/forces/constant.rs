//! Forces and accelerations that act as long as the entity has their component.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::{
    math::{AngularVector, Vector},
    type_path::type_path,
};

/// A constant force on a dynamic body at its centre of mass, in N along the world's axes.
///
/// Inserting, changing or removing the component wakes the body. A body with an unchanged force may fall
/// asleep.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// # fn setup(mut commands: Commands) {
/// // Rises at 2 m/s² without gravity.
/// commands.spawn((RigidBody::Dynamic, Mass(5.0), ConstantForce(Vector::Y * 10.0)));
/// # }
/// ```
#[derive(Component, Reflect, Clone, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ConstantForce(pub Vector);

type_path!(ConstantForce, "dynamics::rigid_body::forces");

/// A constant torque on a dynamic body, in N·m about the world's axes. See [`ConstantForce`].
#[derive(Component, Reflect, Clone, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ConstantTorque(pub AngularVector);

type_path!(ConstantTorque, "dynamics::rigid_body::forces");

/// A constant force on a dynamic body at its centre of mass, in N along the body's own axes. It rotates with
/// the body. See [`ConstantForce`].
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// # fn setup(mut commands: Commands) {
/// // A rocket that flies where its nose points.
/// commands.spawn((RigidBody::Dynamic, Mass(100.0), ConstantLocalForce(Vector::Y * 2500.0)));
/// # }
/// ```
#[derive(Component, Reflect, Clone, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ConstantLocalForce(pub Vector);

type_path!(ConstantLocalForce, "dynamics::rigid_body::forces");

/// A constant acceleration of a dynamic body, in m/s² along the world's axes, independent of the mass. See
/// [`ConstantForce`].
#[derive(Component, Reflect, Clone, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ConstantLinearAcceleration(pub Vector);

type_path!(ConstantLinearAcceleration, "dynamics::rigid_body::forces");

/// A constant angular acceleration of a dynamic body, in rad/s² about the world's axes, independent of the
/// inertia. See [`ConstantForce`].
#[derive(Component, Reflect, Clone, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ConstantAngularAcceleration(pub AngularVector);

type_path!(ConstantAngularAcceleration, "dynamics::rigid_body::forces");

/// A constant acceleration of a dynamic body, in m/s² along the body's own axes, independent of the mass. It
/// rotates with the body. See [`ConstantForce`].
#[derive(Component, Reflect, Clone, Debug, Default, Deref, DerefMut, PartialEq)]
#[reflect(type_path = false, Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct ConstantLocalLinearAcceleration(pub Vector);

type_path!(ConstantLocalLinearAcceleration, "dynamics::rigid_body::forces");
