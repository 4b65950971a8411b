//! The solver: its [configuration](SolverConfig), its [schedule] and its plugins.

pub mod constraint;
pub mod islands;
pub mod joint_graph;
pub mod schedule;
pub mod softness_parameters;
pub mod solver_body;
#[cfg(feature = "xpbd_joints")]
pub mod xpbd;

pub(crate) mod config;
pub(crate) mod diagnostics;
pub(crate) mod follow;
pub(crate) mod gather;
#[cfg(feature = "default-collider")]
mod length_unit;
mod plugin;
pub(crate) mod scatter;
pub(crate) mod step_solver;
pub(crate) mod substeps;
pub(crate) mod workers;

pub use config::{ContactSoftnessCoefficients, PhysicsLengthUnit, SolverConfig};
pub use diagnostics::SolverDiagnostics;
#[cfg(feature = "default-collider")]
pub use plugin::LengthUnitCheckPlugin;
pub use plugin::{SolverPlugin, SolverPlugins};
pub use workers::{RowWidth, WorkerCount};
