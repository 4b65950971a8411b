//! Drawing of 3D joints. `dim2` exports the same names.

use bevy_color::Color;
use bevy_ecs::{
    schedule::{IntoScheduleConfigs, ScheduleConfigs},
    system::ScheduleSystem,
};
use bevy_gizmos::gizmos::Gizmos;
use bevy_math::{Quat, Vec3};
use core::f32::consts::TAU;

use super::point;
use crate::{
    debug_render::{
        configuration::PhysicsGizmos,
        joints::{ARC, DebugRenderConstraint, DrawnJoint, debug_render_constraint, push_sector},
        lines::Strips,
    },
    dynamics::joints::{
        AngleLimit, DistanceJoint, FixedJoint, PrismaticJoint, RevoluteJoint, SphericalJoint,
    },
    math::{Vector, to_f32},
    physics_transform::Rotation,
};

/// The systems that draw each kind of joint.
pub(in crate::debug_render) fn draw_joints() -> ScheduleConfigs<ScheduleSystem> {
    (
        debug_render_constraint::<FixedJoint, 2>,
        debug_render_constraint::<DistanceJoint, 2>,
        debug_render_constraint::<PrismaticJoint, 2>,
        debug_render_constraint::<RevoluteJoint, 2>,
        debug_render_constraint::<SphericalJoint, 2>,
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
            joint.draw_hinge(point(self.hinge_axis), self.angle_limit, color, gizmos);
        }
    }
}

impl DebugRenderConstraint<2> for SphericalJoint {
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
            joint.draw_socket(point(self.twist_axis), self.swing_limit, color, gizmos);
        }
    }
}

impl DrawnJoint {
    /// Draws the twist axes of a ball and its socket, and the cone of swings.
    fn draw_socket(
        &self,
        axis: Vec3,
        swing: Option<AngleLimit>,
        color: Color,
        gizmos: &mut Gizmos<PhysicsGizmos>,
    ) {
        let Some(axis) = axis.try_normalize() else { return };
        let size = self.size();
        let (mut socket, mut ball) = (Strips::default(), Strips::default());
        match swing.map(|limit| to_f32(limit.max)) {
            Some(angle) if angle.is_finite() => push_cone(&mut socket, axis, size, angle),
            _ => socket.push([Vec3::ZERO, axis * size]),
        }
        ball.push([Vec3::ZERO, axis * size]);
        socket.draw(&self.frames[0], color.into(), gizmos);
        ball.draw(&self.frames[1], color.into(), gizmos);
    }
}

/// Adds the cone about an axis with half an opening angle, as a circle and two sectors.
fn push_cone(lines: &mut Strips, axis: Vec3, size: f32, angle: f32) {
    let (a, b) = axis.any_orthonormal_pair();
    push_sector(lines, a, axis * size, -angle, angle);
    push_sector(lines, b, axis * size, -angle, angle);
    let edge = Quat::from_axis_angle(a, angle) * axis * size;
    lines.push((0..=ARC).map(|i| Quat::from_axis_angle(axis, TAU * i as f32 / ARC as f32) * edge));
}
