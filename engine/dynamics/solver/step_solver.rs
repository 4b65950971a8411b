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

/// The engine's own systems in the substep schedule. While the schedule contains no other systems and no run
/// conditions, one kernel call per substep replaces it.
#[derive(Resource, Clone, Debug, Default)]
pub(crate) struct OwnSubstepSystems {
    /// Whether this schedule integrates bodies, and whether it solves contacts.
    pub(crate) integrates: bool,
    pub(crate) solves: bool,
    systems: Vec<TypeId>,
}

impl OwnSubstepSystems {
    /// Records an added system.
    pub(crate) fn note<M>(&mut self, system: impl IntoSystem<(), (), M>) {
        self.systems.push(system.system_type_id());
    }

    /// Whether a schedule contains exactly these systems, without run conditions. False for a schedule that
    /// was already built, because its conditions cannot be read. Running the schedule gives the same bits.
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
