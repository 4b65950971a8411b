//! [`HumanRagdoll`]: a human made of capsules connected by joints. Beyond Avian.
//!
//! Eleven bones: pelvis, chest, head, and two for each arm and leg. The joints have human limits, and
//! neighbouring bones do not collide. With a drive, motors hold the bones in a pose, up to a maximum torque:
//! [`RagdollJoints`] sets the pose in any frame.
//!
//! ```
//! # use avian::prelude::*;
//! # use bevy_ecs::prelude::*;
//! # use bevy_transform::components::Transform;
//! fn spawn(mut commands: Commands) {
//!     // The pose is that of the hips, a metre above the floor. Arms and legs hang down.
//!     let ragdoll = HumanRagdoll::default().spawn(&mut commands, Transform::from_xyz(0.0, 1.0, 0.0));
//!     commands.entity(ragdoll.bone(Bone::Chest)).insert(CollisionEventsEnabled);
//! }
//! ```

mod bone;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod plan;

pub use bone::{Bone, Ragdoll};
pub use dim::RagdollJoints;

use bevy_ecs::{name::Name, prelude::*};
use bevy_log::warn;
use bevy_transform::components::Transform;

use crate::{
    collision::collider::Collider,
    dynamics::{
        joints::{AngularMotor, JointCollisionDisabled, JointDamping},
        rigid_body::{RigidBody, mass_properties::components::ColliderDensity},
    },
    math::{Scalar, to_f32},
};
use dim::Place;

/// Settings for spawning a ragdoll.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HumanRagdoll {
    /// From foot to crown, in metres. 1.8 by default.
    pub height: Scalar,
    /// The mass of all bones, in kg. 75 by default.
    pub mass: Scalar,
    /// The rate at which joints lose velocity, in 1/s. 10 by default. With a smaller rate limbs swing for
    /// long, and heaps sleep late or never.
    pub damping: Scalar,
    /// The motor of each joint, if there is one. Its targets are ignored: all joints are driven to the pose
    /// at spawning until [`RagdollJoints`] sets another one. None by default.
    pub drive: Option<AngularMotor>,
}

impl Default for HumanRagdoll {
    fn default() -> Self {
        Self { height: 1.8, mass: 75.0, damping: 10.0, drive: None }
    }
}

impl HumanRagdoll {
    /// Sets the height, in metres.
    pub const fn with_height(mut self, height: Scalar) -> Self {
        self.height = height;
        self
    }

    /// Sets the mass of all bones, in kg.
    pub const fn with_mass(mut self, mass: Scalar) -> Self {
        self.mass = mass;
        self
    }

    /// Drives all joints with a motor.
    pub const fn with_drive(mut self, motor: AngularMotor) -> Self {
        self.drive = Some(motor);
        self
    }

    /// Spawns the bones, each a dynamic body with a capsule, and their joints. The pose is the pose of the
    /// hips; its scale is ignored. The pelvis gets the [`Ragdoll`] component.
    ///
    /// A height or a mass that is not positive and finite becomes the default, with a warning.
    pub fn spawn(&self, commands: &mut Commands, pose: Transform) -> Ragdoll {
        let wanted = self.checked();
        let pose = pose.with_scale(bevy_math::Vec3::ONE);
        let bones = Bone::ALL.map(|bone| wanted.spawn_bone(bone, commands, pose));
        let joints = Bone::ALL.map(|bone| {
            let parent = bone.parent()?;
            let anchors = [parent, bone].map(|of| {
                let plan = plan::plan(of);
                dim::vector(plan.relative_to_center(plan::plan(bone).joint), wanted.height)
            });
            let place = Place { bodies: [parent, bone].map(|bone| bones[bone as usize]), anchors };
            let joint = dim::spawn_joint(commands, bone, place, wanted.drive);
            let damping = JointDamping { linear: 0.0, angular: wanted.damping };
            commands.entity(joint).insert((
                damping,
                JointCollisionDisabled,
                Name::new(format!("{bone:?} joint")),
            ));
            Some(joint)
        });
        let ragdoll = Ragdoll { bones, joints };
        commands.entity(ragdoll.bone(Bone::Pelvis)).insert(ragdoll.clone());
        ragdoll
    }

    fn checked(&self) -> Self {
        let default = Self::default();
        let positive = |value: Scalar, default: Scalar, name: &str| {
            if value > 0.0 && value.is_finite() {
                return value;
            }
            warn!("a ragdoll's {name} of {value} is not positive and finite, {default} is used instead");
            default
        };
        Self {
            height: positive(self.height, default.height, "height"),
            mass: positive(self.mass, default.mass, "mass"),
            ..*self
        }
    }

    fn spawn_bone(&self, bone: Bone, commands: &mut Commands, pose: Transform) -> Entity {
        let plan = plan::plan(bone);
        let [from, to] =
            [plan.from, plan.to].map(|end| dim::vector(plan.relative_to_center(end), self.height));
        let collider = Collider::capsule_endpoints(plan.radius * self.height, from, to);
        let density = ColliderDensity(to_f32(self.mass * plan.mass) / dim::volume(&collider));
        let place = Transform::from_translation(dim::point(plan.center(), self.height));
        commands
            .spawn((RigidBody::Dynamic, collider, density, pose * place, Name::new(format!("{bone:?}"))))
            .id()
    }
}
