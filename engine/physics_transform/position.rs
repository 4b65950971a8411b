//! The world position of a body or collider.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::{
    component::Component,
    entity::{ComponentCloneCtx, Entity, EntityHashMap, SourceComponent},
    reflect::ReflectComponent,
    resource::Resource,
    world::World,
};
use bevy_math::curve::{FunctionCurve, Interval, easing::Ease};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bevy_transform::components::GlobalTransform;
use derive_more::From;

use crate::math::{Scalar, Vector, vector_from_xyz};

/// The world position of a rigid body or collider, in metres.
///
/// The simulation reads and writes this component and [`Rotation`](super::Rotation); `Transform` is
/// synchronised with them. To move an entity, set either the position or the `Transform`; if both were set
/// since the last step, the position takes precedence. A collider on a child of a body gets its position from
/// the body and from its
/// [`ColliderTransform`](crate::collision::collider::collider_transform::ColliderTransform).
///
/// A clone of an entity has the same pose, unless the app sets another `Transform` or position before the
/// next step.
///
/// A nested body (a body that is a child of another) moves independently: the simulated motion of its parent
/// does not change its position.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn back_to_start(mut bodies: Query<(&mut Position, &mut LinearVelocity)>) {
///     for (mut position, mut velocity) in &mut bodies {
///         if position.y < -100.0 {
///             position.0 = Vector::Y * 2.0;
///             velocity.0 = Vector::ZERO;
///         }
///     }
/// }
/// ```
#[derive(Reflect, Clone, Copy, Component, Debug, Default, Deref, DerefMut, PartialEq, From)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
#[component(clone_behavior = Custom(clone_position))]
pub struct Position(pub Vector);

crate::type_path::type_path!(Position, "physics_transform::transform");

/// The original of each clone that has no [`Position`] yet.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct Originals(pub(super) EntityHashMap<Entity>);

/// Clones the position, and records that the app did not set it.
fn clone_position(source: &SourceComponent, context: &mut ComponentCloneCtx) {
    let Some(&position) = source.read::<Position>() else { return };
    let (original, clone) = (context.source(), context.target());
    context.queue_deferred(move |world: &mut World, _| {
        if let Some(mut originals) = world.get_resource_mut::<Originals>() {
            originals.0.insert(clone, original);
        }
    });
    context.write_target_component(position);
}

impl Position {
    /// Placeholder that is replaced by the position of the `Transform` when the entity gets its body or
    /// collider.
    pub const PLACEHOLDER: Self = Self(Vector::MAX);

    /// The position at a point, in metres.
    pub fn new(position: Vector) -> Self {
        Self(position)
    }
}

impl From<GlobalTransform> for Position {
    fn from(transform: GlobalTransform) -> Self {
        Self::from(&transform)
    }
}

impl From<&GlobalTransform> for Position {
    fn from(transform: &GlobalTransform) -> Self {
        let [x, y, z] = transform.translation().to_array();
        Self(vector_from_xyz([f64::from(x), f64::from(y), f64::from(z)]))
    }
}

impl Ease for Position {
    fn interpolating_curve_unbounded(start: Self, end: Self) -> impl bevy_math::Curve<Self> {
        FunctionCurve::new(Interval::EVERYWHERE, move |t: f32| {
            Self(start.0 + (end.0 - start.0) * Scalar::from(t))
        })
    }
}
