//! [`GenericJoint`]: a joint with settings for each axis.

use bevy_ecs::{
    component::Component,
    entity::{Entity, EntityMapper, MapEntities},
    reflect::{ReflectComponent, ReflectMapEntities},
};
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::solver::JointDef;

use super::{
    axis::JointAxis,
    frame::{JointAnchor, JointBasis, JointFrame, frame_methods},
    kind::{EntityConstraint, JointKind, between_two_bodies, own_frames},
    motor::{AxisMotor, MotorModel},
    space::{COORDINATES, Isometry, JointCoordinate, Rot},
};
use crate::math::{Scalar, Vector};

/// Constrains two bodies by independent settings for each axis: free, locked, limited, sprung or driven. All
/// axes are free by default. Beyond Avian.
///
/// Every other joint of two frames is a special case. Coordinates are positions and angles of the second
/// frame relative to the first: [`JointCoordinate`].
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn mount(mut commands: Commands, frame: Entity, engine: Entity) {
///     // It gives way a little along all axes, and by at most 2 cm along y.
///     let mount = GenericJoint::new(frame, engine)
///         .with_anchor(Vector::Y)
///         .with_locked(JointCoordinate::ALL)
///         .with_axis(JointCoordinate::Y, JointAxis::limited(-0.02, 0.02));
///     commands.spawn(mount);
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, MapEntities, PartialEq)]
#[component(map_entities)]
pub struct GenericJoint {
    /// The first body.
    pub body1: Entity,
    /// The second body.
    pub body2: Entity,
    /// The frame on the first body.
    pub frame1: JointFrame,
    /// The frame on the second body.
    pub frame2: JointFrame,
    /// The axes, in the order of [`JointCoordinate`].
    pub axes: [JointAxis; COORDINATES],
}

impl GenericJoint {
    /// A joint with all axes free.
    pub const fn new(body1: Entity, body2: Entity) -> Self {
        Self {
            body1,
            body2,
            frame1: JointFrame::IDENTITY,
            frame2: JointFrame::IDENTITY,
            axes: [JointAxis::FREE; COORDINATES],
        }
    }

    /// An axis.
    pub const fn axis(&self, coordinate: JointCoordinate) -> &JointAxis {
        &self.axes[coordinate as usize]
    }

    /// An axis, to be changed.
    pub const fn axis_mut(&mut self, coordinate: JointCoordinate) -> &mut JointAxis {
        &mut self.axes[coordinate as usize]
    }

    /// Sets an axis.
    pub const fn with_axis(mut self, coordinate: JointCoordinate, axis: JointAxis) -> Self {
        self.axes[coordinate as usize] = axis;
        self
    }

    /// Locks axes.
    pub fn with_locked(mut self, coordinates: impl IntoIterator<Item = JointCoordinate>) -> Self {
        coordinates.into_iter().for_each(|coordinate| *self.axis_mut(coordinate) = JointAxis::LOCKED);
        self
    }

    /// Sets the minimum and maximum value of an axis, in m or rad.
    pub const fn with_limits(mut self, coordinate: JointCoordinate, min: Scalar, max: Scalar) -> Self {
        self.axis_mut(coordinate).limits = Some([min, max]);
        self
    }

    /// Sets the compliance of the limits of an axis, in m/N or rad/(N·m).
    pub const fn with_compliance(mut self, coordinate: JointCoordinate, compliance: Scalar) -> Self {
        *self.axis_mut(coordinate) = self.axis(coordinate).with_compliance(compliance);
        self
    }

    /// Adds a spring with rest position `rest` to an axis, in m or rad.
    pub const fn with_spring(mut self, coordinate: JointCoordinate, rest: Scalar, model: MotorModel) -> Self {
        *self.axis_mut(coordinate) = self.axis(coordinate).with_spring(rest, model);
        self
    }

    /// Sets the motor of an axis: a [`LinearMotor`](super::LinearMotor), an
    /// [`AngularMotor`](super::AngularMotor) or an [`AxisMotor`].
    pub fn with_motor(mut self, coordinate: JointCoordinate, motor: impl Into<AxisMotor>) -> Self {
        self.axis_mut(coordinate).motor = motor.into();
        self
    }
}

frame_methods!(GenericJoint);
between_two_bodies!(GenericJoint);

impl JointKind for GenericJoint {
    own_frames!();

    /// The first axis with a motor.
    fn motor(&self) -> Option<usize> {
        self.axes.iter().position(|axis| axis.motor.enabled)
    }

    fn set_axes(&self, mut def: JointDef) -> JointDef {
        for (place, axis) in def.axes.iter_mut().zip(self.axes) {
            *place = axis.to_kernel();
        }
        def
    }
}
