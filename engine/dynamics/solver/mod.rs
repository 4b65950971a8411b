//! The solver of contacts: its [configuration](SolverConfig), its [schedule] and the plugins that make it up.

pub mod islands;
pub mod schedule;
pub mod softness_parameters;
pub mod solver_body;

pub(crate) mod config;
mod diagnostics;
pub(crate) mod gather;
pub(crate) mod scatter;
pub(crate) mod substeps;

pub use diagnostics::SolverDiagnostics;
pub(crate) use substeps::StepSolver;

pub use config::{ContactSoftnessCoefficients, PhysicsLengthUnit, SolverConfig, SolverPlugin};

use bevy_app::{PluginGroup, PluginGroupBuilder};

use crate::{dynamics::integrator::IntegratorPlugin, math::Scalar};
use islands::{IslandPlugin, IslandSleepingPlugin};
use schedule::SolverSchedulePlugin;
use solver_body::SolverBodyPlugin;

/// The plugins of the solver; part of [`PhysicsPlugins`](crate::PhysicsPlugins).
///
/// | Plugin | Gives |
/// | --- | --- |
/// | [`SolverBodyPlugin`] | the bodies the solver works on |
/// | [`SolverSchedulePlugin`] | the stages of the solver and the substeps |
/// | [`IntegratorPlugin`] | gravity, the motion of bodies |
/// | [`SolverPlugin`] | contacts |
/// | [`IslandPlugin`] | which bodies rest on which |
/// | [`IslandSleepingPlugin`] | sleep |
#[derive(Debug, Default)]
pub struct SolverPlugins {
    length_unit: Option<Scalar>,
}

impl SolverPlugins {
    /// The plugins with a [`PhysicsLengthUnit`] of `unit`.
    pub fn new_with_length_unit(unit: Scalar) -> Self {
        Self { length_unit: Some(unit) }
    }
}

impl PluginGroup for SolverPlugins {
    fn build(self) -> PluginGroupBuilder {
        PluginGroupBuilder::start::<Self>()
            .add(SolverBodyPlugin)
            .add(SolverSchedulePlugin)
            .add(IntegratorPlugin::default())
            .add(self.length_unit.map_or_else(SolverPlugin::default, SolverPlugin::new_with_length_unit))
            .add(IslandPlugin)
            .add(IslandSleepingPlugin)
    }
}
