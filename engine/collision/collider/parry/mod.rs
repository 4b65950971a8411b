//! [`Collider`], the default collider: a shape of parry with a scale.
//!
//! `constructors`, `shapes2` and `shapes3` make colliders. `from_constructor` and `from_mesh` make colliders
//! described by data and by meshes. `native` converts shapes for the kernel. `manifold` computes contacts of
//! shapes that the kernel does not support.

mod any_collider;
mod cells;
mod composite;
mod constructors;
pub mod contact_query;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod error;
mod from_constructor;
#[cfg(feature = "collider-from-mesh")]
mod from_mesh;
mod handedness;
mod input;
mod manifold;
mod native;
mod native_composite;
mod params;
mod parts;
mod queries;
mod scaled;
#[cfg_attr(feature = "2d", path = "shapes2/mod.rs")]
#[cfg_attr(feature = "3d", path = "shapes3/mod.rs")]
mod shapes;
mod spatial;
#[cfg(feature = "serialize")]
mod stored;
mod strict;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tests_strict;

pub use error::ColliderError;
pub use params::{FillMode, TrimeshFlags, VhacdParameters};
#[allow(unused_imports, reason = "3D has no shapes of its own")]
pub use shapes::*;

/// Replaces Bevy's meshes in builds without feature `collider-from-mesh`: there are none.
#[cfg(not(feature = "collider-from-mesh"))]
mod mesh_type {
    pub(crate) enum Mesh {}
}

pub(crate) use manifold::{foreign_ball_manifolds, foreign_manifolds};
pub(crate) use spatial::{ForeignCast, cast_foreign, overlaps_foreign};

use super::{ColliderAabb, ColliderMarker, CollisionLayers, EnlargedAabb, IntoCollider};
use crate::dynamics::ids::ColliderId;
use crate::dynamics::rigid_body::mass_properties::components::{ColliderDensity, ColliderMassProperties};
use crate::math::Vector;
use crate::parry::shape::SharedShape;
use bevy_ecs::prelude::Component;
#[cfg(feature = "serialize")]
use bevy_ecs::reflect::ReflectComponent;
#[cfg(feature = "collider-from-mesh")]
use bevy_mesh as mesh_type;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use native::native_shape;
use std::sync::OnceLock;

/// Why a mesh collider could not be made.
pub type TrimeshBuilderError = crate::parry::shape::TriMeshBuilderError;

/// The shape of a body for collisions and spatial queries.
///
/// On an entity with a `RigidBody` it is the collider of that body. On a descendant it belongs to the nearest
/// body above. Without a body it only answers queries and detects contacts. Cheap to clone: the shape is
/// shared.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn setup(mut commands: Commands) {
///     commands.spawn((RigidBody::Static, Collider::capsule(0.5, 2.0)));
///     commands.spawn((RigidBody::Dynamic, Collider::compound(vec![
///         (Position::default(), Rotation::default(), Collider::capsule(0.5, 2.0)),
///     ])));
/// }
/// ```
///
/// Constructors without a `Result` or `Option` never fail: they repair invalid values (NaN, negative or zero
/// sizes, indices out of range), with one warning per constructor. Sizes become positive and at least 10 µm.
/// If nothing is left, the collider is a ball of that size. Each of them has a twin whose name starts with
/// `try_`, which returns a [`ColliderError`] instead.
///
/// With feature `serialize` a collider is stored as the definition of its shape and its scale, and is read
/// back with the same bits. A definition that makes no shape is an error. Custom shape types cannot be
/// stored. With this feature Bevy's world files (`DynamicWorldBuilder`) contain colliders, like all other
/// components: see the example `save_and_load`.
///
/// Parry's shapes are available in their own types: `Collider::from(SharedShape)` accepts any of them, and
/// [`shape_scaled`](Self::shape_scaled) returns the shape that the engine uses.
#[derive(Clone, Component, Debug, Reflect)]
#[reflect(opaque, Clone, Debug, Default)]
// Without serde, Bevy leaves colliders out of world files.
#[cfg_attr(feature = "serialize", reflect(Component, Serialize, Deserialize))]
#[require(
    ColliderMarker,
    ColliderAabb,
    CollisionLayers,
    EnlargedAabb,
    ColliderDensity,
    ColliderMassProperties,
    ColliderId
)]
pub struct Collider {
    /// The shape without scale.
    shape: SharedShape,
    scale: Vector,
    /// Number of subdivisions of a curved shape that is scaled unevenly.
    detail: u32,
    /// Empty after `shape` was borrowed mutably, until the scaled shape is next needed.
    scaled: OnceLock<Scaled>,
}

/// The scaled shape.
#[derive(Clone, Debug)]
struct Scaled {
    shape: SharedShape,
    /// The scaled shape in the kernel's format.
    native: kernel::shape::Shape,
}

impl Scaled {
    fn new(shape: SharedShape) -> Self {
        let shape = usable(shape);
        Self { native: native_shape(&shape), shape }
    }

    /// The shape with a scale. `None` if no shape has this scale.
    fn by(shape: &SharedShape, scale: Vector, subdivisions: u32) -> Option<Self> {
        scaled::scaled(shape, scale, subdivisions).map(Self::new)
    }
}

impl<T: IntoCollider<Collider>> From<T> for Collider {
    fn from(value: T) -> Self {
        value.collider()
    }
}

impl From<SharedShape> for Collider {
    fn from(shape: SharedShape) -> Self {
        let shape = usable(shape);
        // Scaled at once, so that clones share the result.
        let scaled = Scaled { native: native_shape(&shape), shape: shape.clone() };
        Self { shape, scale: Vector::ONE, detail: DEFAULT_SUBDIVISIONS, scaled: OnceLock::from(scaled) }
    }
}

impl Default for Collider {
    /// A square or cube with sides of 0.5 m.
    fn default() -> Self {
        dim::default_shape().into()
    }
}

impl Collider {
    /// The shape without scale.
    pub fn shape(&self) -> &SharedShape {
        &self.shape
    }

    /// The shape without scale, to be changed. The scale is kept.
    pub fn shape_mut(&mut self) -> &mut SharedShape {
        self.scaled.take();
        &mut self.shape
    }

    /// The shape with the scale applied. This shape collides.
    pub fn shape_scaled(&self) -> &SharedShape {
        &self.scaled().shape
    }

    /// The scaled shape in the kernel's format.
    pub(crate) fn native(&self) -> &kernel::shape::Shape {
        &self.scaled().native
    }

    fn scaled(&self) -> &Scaled {
        self.scaled.get_or_init(|| {
            Scaled::by(&self.shape, self.scale, self.detail).unwrap_or_else(|| {
                self.warn_unscalable(self.scale);
                Scaled::new(self.shape.clone())
            })
        })
    }

    /// Replaces the shape, and keeps the scale.
    pub fn set_shape(&mut self, shape: SharedShape) {
        *self.shape_mut() = shape;
    }

    /// The scale along each axis.
    pub fn scale(&self) -> Vector {
        self.scale
    }

    /// Sets the scale along each axis. A negative scale mirrors the shape.
    ///
    /// On an entity with a `Transform`, the scale of its `GlobalTransform` replaces this scale before the
    /// next step, unless [`PhysicsTransformConfig::transform_to_collider_scale`] is off.
    ///
    /// A curved shape with an uneven scale becomes a convex hull, with about `num_subdivisions` points per
    /// quarter turn. Rounded edges stay round, with a radius that follows the smallest scale. A rotated part
    /// of a compound with an uneven scale keeps its angles: shapes cannot be sheared.
    ///
    /// A scale that is not finite is ignored with a warning. An axis with a scale of almost zero
    /// keeps 1/100,000 of its length. If a shape cannot be scaled, a warning is given and the
    /// collider keeps its scale.
    ///
    /// [`PhysicsTransformConfig::transform_to_collider_scale`]:
    ///     crate::physics_transform::PhysicsTransformConfig::transform_to_collider_scale
    pub fn set_scale(&mut self, scale: Vector, num_subdivisions: u32) {
        if !scale.is_finite() {
            bevy_log::warn_once!("a collider's scale of {scale} is not finite; it keeps its scale");
            return;
        }
        let scale = Vector::from_array(
            scale
                .to_array()
                .map(|s| if s.abs() < input::MIN_LENGTH { input::MIN_LENGTH.copysign(s) } else { s }),
        );
        if self.try_set_scale(scale, num_subdivisions).is_err() {
            self.warn_unscalable(scale);
        }
    }

    /// Sets the scale along each axis as [`set_scale`](Self::set_scale) does, or keeps it and
    /// returns an error.
    ///
    /// # Errors
    ///
    /// [`InvalidScale`](ColliderError::InvalidScale) if the scale is not finite or an axis has less than
    /// 1/100,000; [`UnscalableShape`](ColliderError::UnscalableShape).
    pub fn try_set_scale(&mut self, scale: Vector, num_subdivisions: u32) -> Result<(), ColliderError> {
        if !(scale.is_finite() && scale.abs().min_element() >= input::MIN_LENGTH) {
            return Err(ColliderError::InvalidScale);
        }
        if scale != self.scale || self.scaled.get().is_none() {
            let scaled = Scaled::by(&self.shape, scale, num_subdivisions);
            self.scaled = scaled.ok_or(ColliderError::UnscalableShape)?.into();
            self.scale = scale;
            self.detail = num_subdivisions;
        }
        Ok(())
    }

    fn warn_unscalable(&self, scale: Vector) {
        let kind = self.shape.shape_type();
        bevy_log::warn_once!("a collider of type {kind:?} cannot be scaled by {scale}");
    }
}

/// The shape, if its extent is finite (parry's own constructors accept any number). Otherwise a tiny ball,
/// with one warning.
fn usable(shape: SharedShape) -> SharedShape {
    if has_extent(&shape) {
        return shape;
    }
    bevy_log::warn_once!("a shape of type {:?} has no finite extent; it becomes a point", shape.shape_type());
    SharedShape::ball(input::MIN_LENGTH)
}

/// Whether the box of a shape is finite and not inverted.
fn has_extent(shape: &SharedShape) -> bool {
    let aabb = shape.compute_local_aabb();
    let (low, high) = (aabb.mins, aabb.maxs);
    low.is_finite() && high.is_finite() && low.cmple(high).all()
}

/// Number of subdivisions of curved shapes before a scale is set.
const DEFAULT_SUBDIVISIONS: u32 = 10;
