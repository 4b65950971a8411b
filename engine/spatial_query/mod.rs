//! Spatial queries: rays, shape casts, nearest points and overlaps.
//!
//! | I want to | use |
//! |---|---|
//! | ask now and then, or with numbers that a system computes | `SpatialQuery` |
//! | cast the same ray every step, from an entity | [`RayCaster`], and [`RayHits`] for the result |
//! | cast the same shape every step | `ShapeCaster`, and `ShapeHits` |
//! | ask of one collider only | methods of `Collider` |
//!
//! [`SpatialQueryFilter`] chooses layers and excludes entities.
//!
//! Queries see the components as they are now, including colliders that were spawned, moved, scaled, disabled
//! or removed since the last step, even while physics is paused. A
//! [`Position`](crate::physics_transform::Position) is current; a `Transform` that was set by hand is read
//! before the next step, or by [`PhysicsTransformHelper`](crate::physics_transform::PhysicsTransformHelper)
//! at once.

#[cfg(feature = "default-collider")]
mod batch;
mod diagnostics;
#[cfg(feature = "default-collider")]
mod frame;
#[cfg(feature = "default-collider")]
mod near_parts;
mod plugin;
mod query_filter;
mod ray_caster;
#[cfg(feature = "default-collider")]
mod recent;
#[cfg(feature = "default-collider")]
mod searches;
#[cfg(feature = "default-collider")]
mod shape_caster;
#[cfg(feature = "default-collider")]
mod system_param;
#[cfg(feature = "default-collider")]
mod traversal;
#[cfg(feature = "default-collider")]
mod update;
#[cfg(feature = "default-collider")]
mod world;

pub use diagnostics::SpatialQueryDiagnostics;
#[cfg(feature = "default-collider")]
pub(crate) use near_parts::NearPart;
pub use plugin::SpatialQueryPlugin;
pub use query_filter::SpatialQueryFilter;
pub use ray_caster::{RayCaster, RayHitData, RayHits};
#[cfg(feature = "default-collider")]
pub use shape_caster::{ShapeCastConfig, ShapeCaster, ShapeHitData, ShapeHits};
#[cfg(feature = "default-collider")]
pub use system_param::{PointProjection, SpatialQuery};

use bevy_ecs::prelude::*;

/// The systems that update casters, once per run of the schedule of [`SpatialQueryPlugin`], after transforms
/// were propagated.
#[derive(SystemSet, Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct SpatialQuerySystems;
