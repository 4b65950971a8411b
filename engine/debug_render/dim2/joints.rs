//! Drawing of 2D joints. `dim3` exports the same names.

use bevy_ecs::{
    schedule::{IntoScheduleConfigs, ScheduleConfigs},
    system::ScheduleSystem,
};
use bevy_gizmos::gizmos::Gizmos;
use bevy_math::Vec3;

use crate::{
    debug_render::{
        configuration::PhysicsGizmos,
        joints::{DebugRenderConstraint, DrawnJoint, debug_render_constraint},
    },
    dynamics::joints::{DistanceJoint, FixedJoint, PrismaticJoint, RevoluteJoint},
    math::Vector,
    physics_transform::Rotation,
};

/// The systems that draw each kind of joint.
pub(in crate::debug_render) fn draw_joints() -> ScheduleConfigs<ScheduleSystem> {
    (
        debug_render_constraint::<FixedJoint, 2>,
        debug_render_constraint::<DistanceJoint, 2>,
        debug_render_constraint::<PrismaticJoint, 2>,
        debug_render_constraint::<RevoluteJoint, 2>,
    )
        .into_configs()
}

impl DebugRenderConstraint<2> for RevoluteJoint {
    type Context = ();

    fn debug_render(
        &self,
        positions: [Vector; 2],
        rotations: [Rotation; 2],
        _: &mut (),
        gizmos: &mut Gizmos<PhysicsGizmos>,
        config: &PhysicsGizmos,
    ) {
        let Some(joint) = DrawnJoint::new(self, positions, rotations) else { return };
        joint.draw_anchors(gizmos, config);
        if let Some(color) = config.joint_anchor_color {
            joint.draw_hinge(Vec3::Z, self.angle_limit, color, gizmos);
        }
    }
}
