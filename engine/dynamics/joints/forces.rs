//! Writes the forces of joints to [`JointForces`], and finds the joints that break.

use bevy_ecs::prelude::*;

use super::{
    breaking::{JointBreakThreshold, JointBroken},
    settings::JointForces,
    table::Joints,
};
use crate::{
    dynamics::solver::substeps::StepSolver,
    math::{Scalar, angular_from_kernel, vector_from_kernel},
};

/// Writes the forces of the last substep to the entities that ask for them.
pub(crate) fn store_joint_forces(
    mut forces: Query<(Entity, &mut JointForces, Option<&JointBreakThreshold>)>,
    mut joints: ResMut<Joints>,
    solver: Res<StepSolver>,
) {
    for (entity, mut forces, threshold) in &mut forces {
        let mut now = JointForces::new();
        let held = joints.get(entity).and_then(|record| Some((record.held?, record.bodies)));
        if let Some((held, [body1, body2])) = held {
            let reaction = solver.kernel.joints.reaction(held.id);
            now.set_force(vector_from_kernel(reaction.force));
            now.set_torque(angular_from_kernel(reaction.torque));
            now.set_motor_force(Scalar::from(held.motor.map_or(0.0, |motor| reaction.motors[motor])));
            if threshold.is_some_and(|threshold| threshold.is_exceeded_by(&now)) {
                let (force, torque) = (now.force(), now.torque());
                joints.broken.push(JointBroken { joint: entity, body1, body2, force, torque });
            }
        }
        forces.set_if_neq(now);
    }
}
