//! Conversion of motors, springs and limits to the kernel's types.

use kernel::solver::{Drive, Give, Spring};

use super::motor::MotorModel;
use crate::math::{Scalar, to_f32};

/// The kernel's softness of a limit with a compliance.
pub(super) fn give(compliance: Scalar) -> Give {
    match to_f32(compliance) {
        0.0 => Give::Rigid,
        compliance => Give::Compliance(compliance),
    }
}

/// The kernel's drive for a motor or a spring. `None` if it has no effect.
pub(super) fn law(model: MotorModel) -> Option<Drive> {
    Some(match model {
        // Without a frequency there is neither stiffness nor damping.
        MotorModel::SpringDamper { frequency: 0.0, .. } => return None,
        MotorModel::SpringDamper { frequency, damping_ratio } => {
            Drive::Spring(Spring { frequency: to_f32(frequency), damping_ratio: to_f32(damping_ratio) })
        }
        MotorModel::ForceBased { stiffness, damping } => {
            Drive::Force { stiffness: to_f32(stiffness), damping: to_f32(damping) }
        }
        MotorModel::AccelerationBased { stiffness, damping } => {
            Drive::Acceleration { stiffness: to_f32(stiffness), damping: to_f32(damping) }
        }
    })
}

/// Maximum effort of a motor. [`Scalar::MAX`] is no maximum.
pub(super) fn effort(max: Scalar) -> f32 {
    match to_f32(max) {
        f32::MAX => f32::INFINITY,
        max => max,
    }
}
