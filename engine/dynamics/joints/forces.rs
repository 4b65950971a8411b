//! Writes the forces of joints to [`JointForces`], and breaks joints.

use bevy_ecs::{message::Messages, prelude::*};

use super::{
    breaking::{JointBreakThreshold, JointBroken},
    settings::{JointDisabled, JointForces},
    table::{Held, Joints},
};
use crate::{
    dynamics::solver::substeps::StepSolver,
    math::{Scalar, angular_from_kernel, vector_from_kernel},
};

/// Writes the forces of the last substep to entities with [`JointForces`].
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
            let motor_force = match held {
                Held { coupling: Some(_), .. } => solver.kernel.joints.coupling_force(held.id),
                Held { motor: Some(motor), .. } => reaction.motors[motor],
                _ => reaction.orientation.length(),
            };
            now.set_motor_force(Scalar::from(motor_force));
            if threshold.is_some_and(|threshold| threshold.is_exceeded_by(&now)) {
                let (force, torque) = (now.force(), now.torque());
                joints.broken.push(JointBroken { joint: entity, body1, body2, force, torque });
            }
        }
        forces.set_if_neq(now);
    }
}

/// Disables joints that broke in the step, and sends the events.
pub(crate) fn send_broken(world: &mut World) {
    if world.resource::<Joints>().broken.is_empty() {
        return;
    }
    let mut broken = core::mem::take(&mut world.resource_mut::<Joints>().broken);
    // A system of the app may have despawned the joint.
    broken.retain(|event| world.get_entity(event.joint).is_ok());
    for event in &broken {
        world.entity_mut(event.joint).insert(JointDisabled);
    }
    if let Some(mut messages) = world.get_resource_mut::<Messages<JointBroken>>() {
        messages.write_batch(broken.iter().copied());
    }
    for event in broken {
        if world.get_entity(event.joint).is_ok() {
            world.trigger(event);
            // Applies the observer's commands before the next observer runs.
            world.flush();
        }
    }
}
