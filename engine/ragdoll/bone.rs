//! [`Bone`]: the parts of a ragdoll, and [`Ragdoll`]: their entities.

use bevy_ecs::prelude::*;

use crate::math::Scalar;

/// A bone of a ragdoll. It faces away from the viewer: in 3D along the negative z axis, with its right arm
/// at positive x.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bone {
    /// The hips.
    Pelvis,
    /// From the waist to the neck.
    Chest,
    /// The head.
    Head,
    /// From the left shoulder to the elbow.
    LeftUpperArm,
    /// From the left elbow to the fingers.
    LeftForearm,
    /// From the right shoulder to the elbow.
    RightUpperArm,
    /// From the right elbow to the fingers.
    RightForearm,
    /// From the left hip to the knee.
    LeftThigh,
    /// From the left knee to the foot.
    LeftShin,
    /// From the right hip to the knee.
    RightThigh,
    /// From the right knee to the foot.
    RightShin,
}

impl Bone {
    /// All bones, parents first.
    pub const ALL: [Self; 11] = [
        Self::Pelvis,
        Self::Chest,
        Self::Head,
        Self::LeftUpperArm,
        Self::LeftForearm,
        Self::RightUpperArm,
        Self::RightForearm,
        Self::LeftThigh,
        Self::LeftShin,
        Self::RightThigh,
        Self::RightShin,
    ];

    /// The bone to which it is joined. None for the pelvis.
    pub const fn parent(self) -> Option<Self> {
        match self {
            Self::Pelvis => None,
            Self::Chest | Self::LeftThigh | Self::RightThigh => Some(Self::Pelvis),
            Self::Head | Self::LeftUpperArm | Self::RightUpperArm => Some(Self::Chest),
            Self::LeftForearm => Some(Self::LeftUpperArm),
            Self::RightForearm => Some(Self::RightUpperArm),
            Self::LeftShin => Some(Self::LeftThigh),
            Self::RightShin => Some(Self::RightThigh),
        }
    }

    /// -1 for bones of the left side, else 1.
    pub(super) const fn side(self) -> Scalar {
        match self {
            Self::LeftUpperArm | Self::LeftForearm | Self::LeftThigh | Self::LeftShin => -1.0,
            _ => 1.0,
        }
    }
}

/// The entities of a ragdoll. A component of its pelvis.
#[derive(Component, Clone, Debug, PartialEq, Eq)]
pub struct Ragdoll {
    pub(super) bones: [Entity; Bone::ALL.len()],
    pub(super) joints: [Option<Entity>; Bone::ALL.len()],
}

impl Ragdoll {
    /// The body of a bone.
    pub const fn bone(&self, bone: Bone) -> Entity {
        self.bones[bone as usize]
    }

    /// The joint between a bone and its parent. The pelvis has none.
    pub const fn joint(&self, bone: Bone) -> Option<Entity> {
        self.joints[bone as usize]
    }

    /// All bodies and joints, to be despawned for example.
    pub fn entities(&self) -> impl Iterator<Item = Entity> + '_ {
        self.joints.iter().flatten().chain(&self.bones).copied()
    }
}
