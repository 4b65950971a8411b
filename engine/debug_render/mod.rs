//! Drawing of bodies, colliders, joints, contacts and queries as lines, with feature `debug-plugin`.
//!
//! [`PhysicsDebugPlugin`] draws according to [`PhysicsGizmos`]. [`DebugRender`] on an entity replaces these
//! settings. [`PhysicsGizmoExt`] offers the same lines to systems of the app.

#[cfg(feature = "default-collider")]
mod casts;
#[cfg(feature = "default-collider")]
mod colliders;
mod configuration;
mod contacts;
#[cfg(feature = "default-collider")]
mod curves;
#[cfg_attr(feature = "2d", path = "dim2/mod.rs")]
#[cfg_attr(feature = "3d", path = "dim3/mod.rs")]
mod dim;
mod draw;
mod gizmos;
mod joints;
mod lines;
mod meshes;
#[cfg(feature = "default-collider")]
mod outline;
mod plugin;
#[cfg(all(test, feature = "default-collider"))]
mod tests;
#[cfg(feature = "default-collider")]
mod voxels;

pub use configuration::{ContactGizmoScale, DebugRender, PhysicsGizmos};
pub use gizmos::PhysicsGizmoExt;
pub use joints::{DebugRenderConstraint, debug_render_constraint};
pub use plugin::PhysicsDebugPlugin;
