//! Timers and counters of physics, as resources and as Bevy diagnostics.
//!
//! Each part of the engine has a resource with its timers and counters of the last step:
//! [`CollisionDiagnostics`], [`SolverDiagnostics`], [`ColliderTreeDiagnostics`], [`SpatialQueryDiagnostics`].
//! These resources always exist.
//!
//! With feature `bevy_diagnostic`, `PhysicsDiagnosticsPlugin` writes them to Bevy's `DiagnosticsStore` after
//! each step, together with the total step time and entity counts. With Bevy's feature `trace` every part of
//! a step is a span, because each part is a system of [`PhysicsSchedule`](crate::schedule::PhysicsSchedule).
//! With feature `diagnostic_ui`, `PhysicsDiagnosticsUiPlugin` shows them in the window.
//!
//! ```
//! # use avian::{diagnostics::AppDiagnosticsExt, prelude::*};
//! # use bevy_app::App;
//! # use bevy_ecs::prelude::*;
//! # use avian::diagnostics::{DiagnosticPath, PhysicsDiagnostics};
//! /// Counters of a game that stand beside those of physics.
//! #[derive(Resource, Default)]
//! struct Shots {
//!     fired: u32,
//! }
//!
//! const FIRED: &DiagnosticPath = &DiagnosticPath::const_new("game/shots_fired");
//!
//! impl PhysicsDiagnostics for Shots {
//!     fn counter_paths(&self) -> Vec<(&'static DiagnosticPath, u32)> {
//!         vec![(FIRED, self.fired)]
//!     }
//! }
//!
//! # let mut app = App::new();
//! # app.add_plugins(PhysicsPlugins::default());
//! app.register_physics_diagnostics::<Shots>();
//! ```
//!
//! [`CollisionDiagnostics`]: crate::collision::CollisionDiagnostics
//! [`SolverDiagnostics`]: crate::dynamics::solver::SolverDiagnostics
//! [`ColliderTreeDiagnostics`]: crate::collider_tree::ColliderTreeDiagnostics
//! [`SpatialQueryDiagnostics`]: crate::spatial_query::SpatialQueryDiagnostics

#[cfg(feature = "bevy_diagnostic")]
mod entity_counters;
mod paths;
#[cfg(feature = "bevy_diagnostic")]
mod plugin;
mod registry;
#[cfg(feature = "bevy_diagnostic")]
mod total;
#[cfg(feature = "diagnostic_ui")]
pub mod ui;

pub use bevy_diagnostic::DiagnosticPath;
#[cfg(feature = "bevy_diagnostic")]
pub use entity_counters::{PhysicsEntityDiagnostics, PhysicsEntityDiagnosticsPlugin};
pub(crate) use paths::diagnostic_paths;
#[cfg(feature = "bevy_diagnostic")]
pub use plugin::PhysicsDiagnosticsPlugin;
pub use registry::{AppDiagnosticsExt, PhysicsDiagnostics, PhysicsDiagnosticsSystems};
pub(crate) use registry::{Within, list};
#[cfg(feature = "bevy_diagnostic")]
pub use total::{PhysicsTotalDiagnostics, PhysicsTotalDiagnosticsPlugin};
