//! Components of rigid bodies: type, velocities, limits, damping, locks and surface.

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod facet_materials;
pub mod forces;
mod locked_axes;
pub mod mass_properties;
mod physics_material;
pub mod sleeping;
mod world_query;

pub use dim::AngularVelocity;
pub use facet_materials::{FacetMaterial, FacetMaterials};
pub use locked_axes::LockedAxes;
pub use physics_material::{CoefficientCombine, DefaultFriction, DefaultRestitution, Friction, Restitution};
pub use world_query::{
    RigidBodyQuery, RigidBodyQueryItem, RigidBodyQueryReadOnly, RigidBodyQueryReadOnlyItem,
};

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use derive_more::From;

use self::forces::{AccumulatedLocalAcceleration, PushedVelocity};
use self::mass_properties::components::{
    ComputedAngularInertia, ComputedCenterOfMass, ComputedMass, RecomputeMassProperties,
};
use crate::dynamics::ids::BodyId;
use crate::dynamics::integrator::VelocityIntegrationData;
use crate::math::{Scalar, Vector};
use crate::physics_transform::{Position, Rotation};

/// Makes an entity a rigid body of a given type.
///
/// The component is immutable: to change the type, insert another `RigidBody`. The engine observes these
/// insertions and does not need to scan all bodies. Contacts, joints, velocities and all other state survive
/// the change.
///
/// A dynamic body needs mass: from colliders on itself or its descendants (see
/// [`ColliderDensity`](mass_properties::components::ColliderDensity)), or from
/// [`Mass`](mass_properties::components::Mass) and its siblings. A body without mass falls, but contacts do
/// not move it; the engine warns once.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn spawn(mut commands: Commands) {
///     // A body that falls, with a known mass and no shape.
///     commands.spawn((RigidBody::Dynamic, Mass(2.0), LinearVelocity::ZERO));
///     // One that is scenery.
///     commands.spawn(RigidBody::Static);
/// }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
#[require(
    Position::PLACEHOLDER,
    Rotation::PLACEHOLDER,
    LinearVelocity,
    AngularVelocity,
    ComputedMass,
    ComputedAngularInertia,
    ComputedCenterOfMass,
    RecomputeMassProperties,
    AccumulatedLocalAcceleration,
    VelocityIntegrationData,
    PushedVelocity,
    BodyId
)]
#[component(immutable)]
pub enum RigidBody {
    /// Moved by forces, contacts and joints.
    #[default]
    Dynamic,
    /// Does not move. An app may teleport it, but on its way it pushes nothing.
    Static,
    /// Moved only by its velocity, as if it had infinite mass: it pushes dynamic bodies, but nothing pushes
    /// it.
    Kinematic,
}

impl RigidBody {
    /// Whether forces, contacts and joints move the body.
    pub fn is_dynamic(&self) -> bool {
        *self == Self::Dynamic
    }

    /// Whether the body never moves by itself.
    pub fn is_static(&self) -> bool {
        *self == Self::Static
    }

    /// Whether only its velocity moves the body.
    pub fn is_kinematic(&self) -> bool {
        *self == Self::Kinematic
    }
}

/// Removes a body from the simulation: it does not move by itself, its colliders touch nothing, its joints
/// have no effect, and bodies resting on it wake. Its components keep their values. Spatial queries still
/// find its colliders.
///
/// A disabled body below another entity in the hierarchy keeps its `Transform` and moves with that entity:
/// this is a way to carry a body.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn freeze(mut commands: Commands, bodies: Query<Entity, With<RigidBody>>) {
///     for body in &bodies {
///         commands.entity(body).insert(RigidBodyDisabled);
///     }
/// }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default)]
#[reflect(Component, Debug, Default)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct RigidBodyDisabled;

/// The velocity of a body's centre of mass, in m/s along the world's axes.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// #[derive(Component)]
/// struct Rocket;
///
/// fn launch(mut rockets: Query<&mut LinearVelocity, With<Rocket>>) {
///     for mut velocity in &mut rockets {
///         // Writing the velocity wakes a body that sleeps.
///         velocity.0 = Vector::Y * 20.0;
///     }
/// }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct LinearVelocity(pub Vector);

impl LinearVelocity {
    /// No velocity.
    pub const ZERO: LinearVelocity = LinearVelocity(Vector::ZERO);
}

/// Maximum linear speed of a body, in m/s. The direction is kept. Infinite by default.
#[derive(Component, Reflect, Clone, Copy, Debug, Deref, DerefMut, PartialEq, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct MaxLinearSpeed(pub Scalar);

impl Default for MaxLinearSpeed {
    fn default() -> Self {
        Self(Scalar::INFINITY)
    }
}

/// Maximum angular speed of a body, in rad/s. The axis is kept. Infinite by default.
#[derive(Component, Reflect, Clone, Copy, Debug, Deref, DerefMut, PartialEq, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct MaxAngularSpeed(pub Scalar);

impl Default for MaxAngularSpeed {
    fn default() -> Self {
        Self(Scalar::INFINITY)
    }
}

/// Factor of gravity for a body: 1 by default, 0 for none, negative for upwards.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # fn setup(mut commands: Commands) {
/// // A balloon that rises at half the acceleration at which others fall.
/// commands.spawn((RigidBody::Dynamic, Collider::capsule(0.3, 0.1), GravityScale(-0.5)));
/// # }
/// ```
#[derive(Component, Reflect, Clone, Copy, Debug, Deref, DerefMut, PartialEq, PartialOrd, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct GravityScale(pub Scalar);

impl Default for GravityScale {
    fn default() -> Self {
        Self(1.0)
    }
}

/// Damping of linear velocity: the rate `c` in `dv/dt = −c v`, in 1/s. 0 by default.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, PartialOrd, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct LinearDamping(pub Scalar);

/// Damping of angular velocity: the rate `c` in `dω/dt = −c ω`, in 1/s. 0 by default.
#[derive(Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, PartialEq, PartialOrd, From)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct AngularDamping(pub Scalar);

/// Dominance in contacts between dynamic bodies: the body with the higher value acts as if it had infinite
/// mass. Bodies with equal dominance push each other by their masses. 0 by default. Static and kinematic
/// bodies dominate all dynamic ones.
#[derive(
    Component, Reflect, Clone, Copy, Debug, Default, Deref, DerefMut, From, PartialEq, Eq, PartialOrd, Ord,
)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct Dominance(pub i8);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_comes_with_all_it_needs() {
        let mut world = World::new();
        let body = world.spawn(RigidBody::default()).id();
        let body = world.entity(body);
        assert!(body.get::<RigidBody>().expect("just inserted").is_dynamic());
        assert_eq!(body.get::<Position>(), Some(&Position::PLACEHOLDER));
        assert_eq!(body.get::<LinearVelocity>(), Some(&LinearVelocity::ZERO));
        assert_eq!(body.get::<AngularVelocity>(), Some(&AngularVelocity::ZERO));
        assert!(body.get::<ComputedMass>().expect("required").is_infinite());
        assert!(body.contains::<RecomputeMassProperties>());
        assert!(body.contains::<AccumulatedLocalAcceleration>());
    }

    #[test]
    fn inserting_another_type_asks_for_the_mass_again() {
        let mut world = World::new();
        let body = world.spawn(RigidBody::Static).id();
        world.entity_mut(body).remove::<RecomputeMassProperties>();
        world.entity_mut(body).insert(RigidBody::Dynamic);
        assert!(world.entity(body).contains::<RecomputeMassProperties>());
    }

    #[test]
    fn defaults_change_nothing() {
        assert_eq!(GravityScale::default().0, 1.0);
        assert_eq!(MaxLinearSpeed::default().0, Scalar::INFINITY);
        assert_eq!(MaxAngularSpeed::default().0, Scalar::INFINITY);
        assert_eq!((LinearDamping::default().0, AngularDamping::default().0), (0.0, 0.0));
        assert_eq!(Dominance::default().0, 0);
    }
}
