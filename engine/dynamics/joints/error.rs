//! [`JointError`]: how far a joint is off.

use bevy_ecs::{prelude::*, reflect::ReflectComponent};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::table::Joints;
use crate::{
    dynamics::{solver::substeps::StepSolver, tables::Bodies},
    math::Scalar,
};

/// How far the locked axes and limits of the joint are off at the end of the last step. Add the component to
/// have it written. Beyond Avian.
///
/// Of several axes it is the root of the sum of squares. Both numbers are zero while the joint takes no part
/// in the simulation.
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
    /// Of positions and distances, in metres.
    pub length: Scalar,
    /// Of angles, in radians.
    pub angle: Scalar,
}

/// Writes the errors of the joints that ask for them.
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
