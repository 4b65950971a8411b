//! [`JointSolver`]: the method that solves joints.

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::solver as k;

/// The method that solves the joints of the app. It may change at any time. Beyond Avian.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_app::App;
/// # use bevy_transform::TransformPlugin;
/// // A game of cranes.
/// App::new().add_plugins((TransformPlugin, PhysicsPlugins::default())).insert_resource(JointSolver::Rigid);
/// ```
#[derive(Resource, Reflect, Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Resource, Debug, Default, PartialEq)]
pub enum JointSolver {
    /// Joints that form trees of three and more (chains, bridges, ragdolls) are solved directly, tree by
    /// tree. All others are solved one by one. Trees bear loads of 1,000 times their own mass.
    #[default]
    Auto,
    /// All joints are solved one by one. Joints open where heavy bodies hang on light ones.
    Rows,
    /// Trees are solved directly and without softness, from one joint on: for cranes and machines, which bend
    /// by less than a millimetre. Light bodies that swing fast and hold heavy ones may gain energy.
    Rigid,
}

impl From<JointSolver> for k::JointSolver {
    fn from(solver: JointSolver) -> Self {
        match solver {
            JointSolver::Auto => Self::Auto,
            JointSolver::Rows => Self::Rows,
            JointSolver::Rigid => Self::Rigid,
        }
    }
}
