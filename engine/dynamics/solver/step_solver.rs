//! The kernel's solver as a resource, and the engine's own systems in the substeps.

use bevy_ecs::prelude::*;
use core::any::TypeId;
use kernel::solver::{Solver, SubstepParams};

/// The kernel's solver, and the parameters of this step.
#[derive(Resource, Clone)]
pub(crate) struct StepSolver {
    pub(crate) kernel: Solver,
    pub(crate) params: SubstepParams,
    pub(crate) substeps: u32,
}

impl Default for StepSolver {
    fn default() -> Self {
        // The parameters are computed anew in each step.
        Self { kernel: Solver::default(), params: SubstepParams::new(1.0 / 60.0, 6), substeps: 1 }
    }
}

/// The engine's own systems in the schedule of the substeps. While the schedule holds no others and has no
/// run conditions, one call of the kernel per substep replaces it.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct OwnSubstepSystems {
    /// Whether bodies are integrated in this schedule, and whether contacts are solved.
    pub(crate) integrates: bool,
    pub(crate) solves: bool,
    systems: Vec<TypeId>,
}

impl OwnSubstepSystems {
    /// Records a system that is added.
    pub(crate) fn note<M>(&mut self, system: impl IntoSystem<(), (), M>) {
        self.systems.push(system.system_type_id());
    }

    /// Whether a schedule holds exactly these systems, without run conditions. False for a schedule that was
    /// built already, since its conditions cannot be read: running the schedule gives the same bits.
    pub(crate) fn are_all_of(&self, schedule: &Schedule) -> bool {
        if schedule.systems().is_ok() {
            return false;
        }
        let graph = schedule.graph();
        graph.systems.len() == self.systems.len()
            && graph.systems.iter().all(|(_, system, conditions)| {
                conditions.is_empty() && self.systems.contains(&system.system_type())
            })
            && graph.system_sets.iter().all(|(.., conditions)| conditions.is_empty())
    }
}
