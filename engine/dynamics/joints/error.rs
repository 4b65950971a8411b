//! [`JointError`]: the position error of a joint.

use bevy_ecs::{prelude::*, reflect::ReflectComponent};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::table::Joints;
use crate::{
    dynamics::{solver::substeps::StepSolver, tables::Bodies},
    math::Scalar,
};

/// The error of the joint's locked axes and limits at the end of the last step. Add the component to request
/// it. Beyond Avian.
///
/// Errors of several axes are combined as the root of the sum of squares. Both numbers are zero while the
/// joint is not in the simulation.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn print(joints: Query<(Entity, &JointError)>) {
///     for (joint, error) in joints.iter().filter(|(_, error)| error.length > 0.01) {
///         println!("{joint} is open by {} m", error.length);
///     }
/// }
/// ```
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
pub struct JointError {
    /// The error of positions and distances, in metres.
    pub length: Scalar,
    /// The error of angles, in radians.
    pub angle: Scalar,
}

/// Writes the errors of joints with [`JointError`].
pub(crate) fn store_joint_errors(
    mut errors: Query<(Entity, &mut JointError)>,
    joints: Res<Joints>,
    solver: Res<StepSolver>,
    bodies: Res<Bodies>,
) {
    for (entity, mut error) in &mut errors {
        let held = joints.get(entity).and_then(|record| record.held);
        let gap = held.and_then(|held| solver.kernel.joints.gap(held.id, &bodies.table)).unwrap_or_default();
        error.set_if_neq(JointError { length: Scalar::from(gap.length), angle: Scalar::from(gap.angle) });
    }
}
