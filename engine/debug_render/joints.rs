//! Joints: lines from bodies to anchors, between anchors, and along and about axes with limits.

use bevy_color::Color;
use bevy_ecs::{
    prelude::*,
    system::{StaticSystemParam, SystemParam, SystemParamItem},
};
use bevy_gizmos::{config::GizmoConfigStore, gizmos::Gizmos};
use bevy_math::{Affine3A, Quat, Vec3};
use bevy_transform::components::GlobalTransform;
use core::f32::consts::TAU;

use super::{
    PhysicsGizmos, dim,
    lines::{Strips, draw_strip},
};
use crate::{
    dynamics::joints::{
        AngleLimit, DistanceJoint, DistanceLimit, EntityConstraint, FixedJoint, GearJoint, GenericJoint,
        JointCoordinate, JointDisabled, MouseJoint, PrismaticJoint, PulleyJoint, RackAndPinionJoint,
        kind::JointKind, space::rotation_of,
    },
    math::{Vector, to_f32},
    physics_transform::{Position, Rotation},
};

/// A constraint that [`PhysicsDebugPlugin`](super::PhysicsDebugPlugin) can draw.
///
/// Add the system [`debug_render_constraint`] for a custom type.
pub trait DebugRenderConstraint<const N: usize>: EntityConstraint<N> {
    /// The data that drawing needs from the world.
    type Context: SystemParam;

    /// Draws the constraint between entities at the given poses.
    fn debug_render(
        &self,
        positions: [Vector; N],
        rotations: [Rotation; N],
        context: &mut SystemParamItem<Self::Context>,
        gizmos: &mut Gizmos<PhysicsGizmos>,
        config: &PhysicsGizmos,
    );
}

/// Draws all enabled constraints of a type whose entities have transforms.
pub fn debug_render_constraint<T: Component + DebugRenderConstraint<N>, const N: usize>(
    bodies: Query<&GlobalTransform>,
    constraints: Query<&T, Without<JointDisabled>>,
    mut gizmos: Gizmos<PhysicsGizmos>,
    store: Res<GizmoConfigStore>,
    mut context: StaticSystemParam<T::Context>,
) {
    let (_, config) = store.config::<PhysicsGizmos>();
    for constraint in &constraints {
        let Ok(transforms) = bodies.get_many(constraint.entities()) else { continue };
        let positions = transforms.map(|transform| Position::from(transform).0);
        let rotations = transforms.map(Rotation::from);
        constraint.debug_render(positions, rotations, &mut context, &mut gizmos, config);
    }
}

/// A joint as it is drawn.
pub(super) struct DrawnJoint {
    /// The origins of the bodies.
    bodies: [Vec3; 2],
    /// The frames of the joint in the world.
    pub(super) frames: [Affine3A; 2],
}

impl DrawnJoint {
    /// A joint between bodies at the given poses. `None` if a number is not finite.
    pub(super) fn new(
        joint: &impl JointKind,
        positions: [Vector; 2],
        rotations: [Rotation; 2],
    ) -> Option<Self> {
        let mut frames = [Affine3A::IDENTITY; 2];
        for (side, frame) in joint.frames().into_iter().enumerate() {
            let (position, rotation) = (positions[side], rotations[side]);
            let local = frame.localized(position, rotation);
            let (anchor, basis) = (local.anchor.local()?, local.basis.local()?);
            frames[side] = dim::frame(position + rotation * anchor, rotation * rotation_of(basis));
        }
        let bodies = positions.map(dim::point);
        let is_finite = frames.iter().all(|f| f.is_finite()) && bodies.iter().all(|b| b.is_finite());
        is_finite.then_some(Self { bodies, frames })
    }

    /// Draws lines from the bodies to their anchors, and between the anchors.
    pub(super) fn draw_anchors(&self, gizmos: &mut Gizmos<PhysicsGizmos>, config: &PhysicsGizmos) {
        let anchors = self.frames.map(|frame| Vec3::from(frame.translation));
        if let Some(color) = config.joint_anchor_color {
            for (body, anchor) in self.bodies.into_iter().zip(anchors) {
                draw_strip([body, anchor], color, gizmos);
            }
        }
        if let Some(color) = config.joint_separation_color {
            draw_strip(anchors, color, gizmos);
        }
    }

    /// The size of marks: half of the longer distance from a body to its anchor.
    pub(super) fn size(&self) -> f32 {
        let arm = |side: usize| self.bodies[side].distance(self.frames[side].translation.into());
        0.5 * arm(0).max(arm(1))
    }

    /// Draws an axis of the first frame between two positions, and marks them if they are limits.
    pub(super) fn draw_slider(&self, axis: Vec3, limits: Option<DistanceLimit>, pen: &mut Pen) {
        let Some(axis) = axis.try_normalize() else { return };
        let (size, mut lines) = (self.size(), Strips::default());
        let (min, max) = limits.map_or((-size, size), |limits| (to_f32(limits.min), to_f32(limits.max)));
        if !(min.is_finite() && max.is_finite()) {
            return;
        }
        lines.push([axis * min, axis * max]);
        if limits.is_some() {
            let mark = dim::spread(axis)[0] * (0.2 * size);
            lines.push([axis * min - mark, axis * min + mark]);
            lines.push([axis * max - mark, axis * max + mark]);
        }
        pen.draw(&lines, &self.frames[0]);
    }

    /// Draws the axis of a hinge, the range of its angle, and a line at its angle.
    pub(super) fn draw_hinge(&self, axis: Vec3, limits: Option<AngleLimit>, pen: &mut Pen) {
        let Some(axis) = axis.try_normalize() else { return };
        let size = self.size();
        let zero = axis.any_orthonormal_vector() * size;
        let (mut range, mut pointer) = (Strips::default(), Strips::default());
        range.push([axis * (-0.5 * size), axis * (0.5 * size)]);
        if let Some(limits) = limits {
            let (min, max) = (to_f32(limits.min), to_f32(limits.max));
            push_sector(&mut range, axis, zero, min, max);
        }
        pointer.push([Vec3::ZERO, zero]);
        pen.draw(&range, &self.frames[0]);
        pen.draw(&pointer, &self.frames[1]);
    }
}

/// Draws lines in the color of anchors.
pub(super) struct Pen<'a, 'w, 's> {
    color: Color,
    gizmos: &'a mut Gizmos<'w, 's, PhysicsGizmos>,
}

impl Pen<'_, '_, '_> {
    /// Draws lines in a frame.
    pub(super) fn draw(&mut self, lines: &Strips, frame: &Affine3A) {
        lines.draw(frame, self.color.into(), self.gizmos);
    }

    /// Draws a line in the world, if it is finite.
    fn line(&mut self, ends: [Vec3; 2]) {
        if ends.iter().all(|end| end.is_finite()) {
            draw_strip(ends, self.color, self.gizmos);
        }
    }
}

/// Adds an arc about an axis from the angles `min` to `max`, at most a full turn, and the lines from the
/// centre to its ends.
pub(super) fn push_sector(lines: &mut Strips, axis: Vec3, zero: Vec3, min: f32, max: f32) {
    let span = (max - min).min(TAU);
    if !(min.is_finite() && span >= 0.0) {
        return;
    }
    let points = (0..=ARC).map(|i| {
        let angle = min + span * i as f32 / ARC as f32;
        Quat::from_axis_angle(axis, angle) * zero
    });
    lines.push_closed(core::iter::once(Vec3::ZERO).chain(points));
}

/// The number of lines of an arc.
pub(super) const ARC: u32 = 24;

/// Draws a joint of the engine: its anchors, and its free axes and limits by `draw`.
pub(super) fn draw_kind(
    joint: &impl JointKind,
    (positions, rotations): ([Vector; 2], [Rotation; 2]),
    gizmos: &mut Gizmos<PhysicsGizmos>,
    config: &PhysicsGizmos,
    draw: impl FnOnce(&DrawnJoint, &mut Pen),
) {
    let Some(drawn) = DrawnJoint::new(joint, positions, rotations) else { return };
    // Coupled bodies are not held at a point.
    if joint.coupling().is_none() {
        drawn.draw_anchors(gizmos, config);
    }
    if let Some(color) = config.joint_anchor_color {
        draw(&drawn, &mut Pen { color, gizmos });
    }
}

/// Implements drawing for kinds of joints, and lists their systems. Each kind comes with an expression that
/// draws its axes and limits.
macro_rules! drawn_kinds {
    ($(#[$doc:meta])* $list:ident: $($joint:ident => |$self:ident, $drawn:pat_param, $pen:pat_param| $draw:expr;)+) => {
        $(#[$doc])*
        pub(in crate::debug_render) fn $list() -> bevy_ecs::schedule::ScheduleConfigs<bevy_ecs::system::ScheduleSystem> {
            use bevy_ecs::schedule::IntoScheduleConfigs;
            ($($crate::debug_render::joints::debug_render_constraint::<$joint, 2>,)+).into_configs()
        }

        $(impl $crate::debug_render::joints::DebugRenderConstraint<2> for $joint {
            type Context = ();

            fn debug_render(
                &self,
                positions: [$crate::math::Vector; 2],
                rotations: [$crate::physics_transform::Rotation; 2],
                _: &mut (),
                gizmos: &mut bevy_gizmos::gizmos::Gizmos<$crate::debug_render::PhysicsGizmos>,
                config: &$crate::debug_render::PhysicsGizmos,
            ) {
                let $self = self;
                let draw = |$drawn: &$crate::debug_render::joints::DrawnJoint,
                            $pen: &mut $crate::debug_render::joints::Pen| $draw;
                $crate::debug_render::joints::draw_kind(self, (positions, rotations), gizmos, config, draw);
            }
        })+
    };
}

pub(super) use drawn_kinds;

drawn_kinds! {
    /// The systems that draw the joints of both dimensions.
    draw_joints:
    FixedJoint => |_joint, _, _| {};
    DistanceJoint => |_joint, _, _| {};
    MouseJoint => |_joint, _, _| {};
    PrismaticJoint => |joint, drawn, pen| drawn.draw_slider(dim::point(joint.slider_axis), joint.limits, pen);
    PulleyJoint => |joint, drawn, pen| {
        for (anchor, pulley) in drawn.frames.iter().zip(joint.pulleys) {
            pen.line([anchor.translation.into(), dim::point(pulley)]);
        }
        pen.line(joint.pulleys.map(dim::point));
    };
    GearJoint => |_joint, drawn, pen| pen.line(drawn.bodies);
    RackAndPinionJoint => |_joint, drawn, pen| pen.line(drawn.bodies);
    GenericJoint => |joint, drawn, pen| draw_axes(joint, drawn, pen);
}

/// Draws the axes of a joint that are not locked.
fn draw_axes(joint: &GenericJoint, drawn: &DrawnJoint, pen: &mut Pen) {
    for coordinate in JointCoordinate::ALL {
        let axis = joint.axis(coordinate);
        if axis.is_locked() {
            continue;
        }
        let direction = dim::direction(coordinate);
        if JointCoordinate::TRANSLATIONS.contains(&coordinate) {
            drawn.draw_slider(direction, axis.limits.map(DistanceLimit::from), pen);
        } else {
            drawn.draw_hinge(direction, axis.limits.map(AngleLimit::from), pen);
        }
    }
}
