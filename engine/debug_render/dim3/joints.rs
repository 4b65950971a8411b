//! Drawing of 3D joints. `dim2` exports the same names.

use bevy_math::{Quat, Vec3};
use core::f32::consts::TAU;

use super::point;
use crate::{
    debug_render::{
        joints::{ARC, DrawnJoint, Pen, drawn_kinds, push_sector},
        lines::Strips,
    },
    dynamics::joints::{AngleLimit, RevoluteJoint, SphericalJoint, WheelJoint},
    math::to_f32,
};

drawn_kinds! {
    /// The systems that draw the joints of this dimension.
    draw_own_joints:
    RevoluteJoint => |joint, drawn, pen| drawn.draw_hinge(point(joint.hinge_axis), joint.angle_limit, pen);
    SphericalJoint => |joint, drawn, pen| drawn.draw_socket(point(joint.twist_axis), joint.swing_limit, pen);
    WheelJoint => |joint, drawn, pen| {
        drawn.draw_slider(point(joint.suspension_axis), joint.suspension_limits, pen);
        drawn.draw_hinge(point(joint.axle), None, pen);
    };
}

impl DrawnJoint {
    /// Draws the twist axes of a ball and its socket, and the cone of swings.
    fn draw_socket(&self, axis: Vec3, swing: Option<AngleLimit>, pen: &mut Pen) {
        let Some(axis) = axis.try_normalize() else { return };
        let size = self.size();
        let (mut socket, mut ball) = (Strips::default(), Strips::default());
        match swing.map(|limit| to_f32(limit.max)) {
            Some(angle) if angle.is_finite() => push_cone(&mut socket, axis, size, angle),
            _ => socket.push([Vec3::ZERO, axis * size]),
        }
        ball.push([Vec3::ZERO, axis * size]);
        pen.draw(&socket, &self.frames[0]);
        pen.draw(&ball, &self.frames[1]);
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
