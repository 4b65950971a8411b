//! The solver: its [configuration](SolverConfig), its [schedule] and its plugins.

pub mod islands;
pub mod joint_graph;
pub mod schedule;
pub mod softness_parameters;
pub mod solver_body;

pub(crate) mod config;
pub(crate) mod diagnostics;
pub(crate) mod gather;
mod plugin;
pub(crate) mod scatter;
pub(crate) mod substeps;
pub(crate) mod workers;

pub use config::{ContactSoftnessCoefficients, PhysicsLengthUnit, SolverConfig};
pub use diagnostics::SolverDiagnostics;
pub use plugin::{SolverPlugin, SolverPlugins};
pub use workers::{RowWidth, WorkerCount};
