//! A backend for Bevy's picking: pointers hover, press and drag colliders.
//!
//! Add [`PhysicsPickingPlugin`], and observe `Pointer` events on entities with colliders. An entity with
//! [`Pickable::IGNORE`] is skipped. An entity whose [`Pickable`] does not block lower entities lets the next
//! one be picked too.
//!
//! | I want to | use |
//! |---|---|
//! | pick only marked entities | [`PhysicsPickingSettings::require_markers`] and [`PhysicsPickable`] |
//! | choose layers, or exclude entities, per camera | [`PhysicsPickingFilter`] |
//! | know where a collider was picked | `position`, `normal` and `depth` of Bevy's [`HitData`](bevy_picking::backend::HitData), in metres |
//!
//! In 2D the ray of the pointer is followed to the plane of the bodies, so that cameras may be in perspective
//! or rotated. Overlapping colliders are picked by the z of their `GlobalTransform`, nearest to the camera
//! first. The normal is absent.
//!
//! In 3D a ray that starts inside a collider hits its boundary from within: a camera in a large sensor also
//! picks colliders in the sensor.
//!
//! ```
//! # use avian::prelude::*;
//! # use bevy_app::prelude::*;
//! fn build(app: &mut App) {
//!     // An app with Bevy's default features has `DefaultPickingPlugins` from `DefaultPlugins`.
//!     app.add_plugins((PhysicsPlugins::default(), PhysicsPickingPlugin));
//! }
//! ```

mod diagnostics;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod plugin;
mod targets;

pub use diagnostics::PhysicsPickingDiagnostics;
pub use dim::PhysicsPickingSettings;
pub use plugin::{PhysicsPickingPlugin, update_hits};
pub use targets::{PhysicsPickable, PhysicsPickingFilter, PickingTargets};

#[cfg(doc)]
use bevy_picking::Pickable;
