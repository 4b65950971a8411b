//! Writes the forces of joints to [`JointForces`].

use bevy_ecs::prelude::*;

use super::{settings::JointForces, table::Joints};
use crate::{
    dynamics::solver::substeps::StepSolver,
    math::{Scalar, angular_from_kernel, vector_from_kernel},
};

/// Writes the forces of the last substep to the entities that ask for them.
pub(crate) fn store_joint_forces(
    mut forces: Query<(Entity, &mut JointForces)>,
    joints: Res<Joints>,
    solver: Res<StepSolver>,
) {
    for (entity, mut forces) in &mut forces {
        let mut now = JointForces::new();
        if let Some(held) = joints.get(entity).and_then(|record| record.held) {
            let reaction = solver.kernel.joints.reaction(held.id);
            now.set_force(vector_from_kernel(reaction.force));
            now.set_torque(angular_from_kernel(reaction.torque));
            now.set_motor_force(Scalar::from(held.motor.map_or(0.0, |motor| reaction.motors[motor])));
        }
        forces.set_if_neq(now);
    }
}
