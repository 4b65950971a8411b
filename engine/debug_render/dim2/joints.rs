//! Drawing of 2D joints. `dim3` exports the same names.

use bevy_math::Vec3;

use super::point;
use crate::{
    debug_render::joints::drawn_kinds,
    dynamics::joints::{RevoluteJoint, WheelJoint},
};

drawn_kinds! {
    /// The systems that draw the joints of this dimension.
    draw_own_joints:
    RevoluteJoint => |joint, drawn, pen| drawn.draw_hinge(Vec3::Z, joint.angle_limit, pen);
    WheelJoint => |joint, drawn, pen| {
        drawn.draw_slider(point(joint.suspension_axis), joint.suspension_limits, pen);
        drawn.draw_hinge(Vec3::Z, None, pen);
    };
}
