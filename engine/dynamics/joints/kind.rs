//! The kinds of joints, and their conversion to joints of the kernel.
//!
//! The kernel has one joint: two frames, and for each coordinate of the second frame relative to the first
//! whether it is free, limited or driven. A kind is a choice of these settings. If a kind has an axis, its
//! frames are rotated to make their x axis this axis.

use bevy_ecs::{
    change_detection::Mut,
    component::{Component, Mutable},
    entity::{Entity, MapEntities},
};
use kernel::{
    math::{Angular, Rot},
    solver::{Axis, JointDef, Motor, OrientationMotor},
};

use super::{
    coupling::Coupling,
    frame::JointFrame,
    laws::{effort, give, law},
    limits::{AngleLimit, DistanceLimit},
    motor::{AngularMotor, AxisMotor, LinearMotor, MotorModel},
    settings::JointDamping,
    space::rotation_of,
};
use crate::math::{Scalar, to_f32, vector_to_kernel};

/// A constraint between entities.
pub trait EntityConstraint<const ENTITY_COUNT: usize>: MapEntities {
    /// The constrained entities.
    fn entities(&self) -> [Entity; ENTITY_COUNT];
}

/// A kind of joint of the engine.
pub(crate) trait JointKind {
    /// The coordinate that the joint's motor drives.
    fn motor(&self) -> Option<usize> {
        None
    }

    /// The coupling, if this kind is a coupling and not a joint of two frames.
    fn coupling(&self) -> Option<Coupling> {
        None
    }

    /// The frames on both bodies.
    fn frames(&self) -> [JointFrame; 2];

    /// Replaces the frames.
    fn set_frames(&mut self, frames: [JointFrame; 2]);

    /// The rotation from the kernel's axes to the joint's.
    fn turn(&self) -> Rot {
        Rot::IDENTITY
    }

    /// Sets the kernel's axis for each coordinate.
    fn set_axes(&self, def: JointDef) -> JointDef;
}

/// An operation to run for each kind of joint.
pub(crate) trait KindVisitor {
    /// Runs the operation for one kind.
    fn visit<J: JointKind + EntityConstraint<2> + Component<Mutability = Mutable>>(&mut self);
}

/// A joint's component, of any kind.
pub(crate) trait JointMut {
    /// The entities of its bodies.
    fn bodies(&self) -> [Entity; 2];

    /// The joint.
    fn kind(&self) -> &dyn JointKind;

    /// Replaces the joint's frames and marks the component as changed.
    fn set_frames(&mut self, frames: [JointFrame; 2]);
}

impl<J: JointKind + EntityConstraint<2> + Component> JointMut for Mut<'_, J> {
    fn bodies(&self) -> [Entity; 2] {
        self.entities()
    }

    fn kind(&self) -> &dyn JointKind {
        &**self
    }

    fn set_frames(&mut self, frames: [JointFrame; 2]) {
        JointKind::set_frames(&mut **self, frames);
    }
}

/// Implements the traits of joints for a type with `body1` and `body2`.
macro_rules! between_two_bodies {
    ($joint:ident) => {
        impl EntityConstraint<2> for $joint {
            fn entities(&self) -> [Entity; 2] {
                [self.body1, self.body2]
            }
        }

        impl MapEntities for $joint {
            fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
                self.body1 = mapper.get_mapped(self.body1);
                self.body2 = mapper.get_mapped(self.body2);
            }
        }
    };
}

pub(super) use between_two_bodies;

/// Implements the frame methods of [`JointKind`] for a type with `frame1` and `frame2`.
macro_rules! own_frames {
    () => {
        fn frames(&self) -> [JointFrame; 2] {
            [self.frame1, self.frame2]
        }

        fn set_frames(&mut self, frames: [JointFrame; 2]) {
            [self.frame1, self.frame2] = frames;
        }
    };
}

pub(super) use own_frames;

/// The kernel's joint between the bodies with these ids, for a kind with local frames. `None` if a frame is
/// global.
pub(crate) fn definition(
    joint: &(impl JointKind + ?Sized),
    bodies: [u32; 2],
    damping: Option<&JointDamping>,
) -> Option<JointDef> {
    let turn = joint.turn();
    let mut def = JointDef::free(bodies, Default::default());
    for (frame, local) in def.frames.iter_mut().zip(joint.frames()) {
        frame.anchor = vector_to_kernel(local.anchor.local()?);
        frame.basis = rotation_of(local.basis.local()?).to_kernel().admitted().mul(turn);
    }
    if let Some(damping) = damping {
        def.damping = [to_f32(damping.linear), to_f32(damping.angular)];
    }
    Some(joint.set_axes(def))
}

/// A locked coordinate with a compliance, in m/N or rad/(N·m).
pub(super) fn locked(compliance: Scalar) -> Axis {
    Axis::LOCKED.with_give(give(compliance))
}

/// A coordinate with limits, if any.
pub(super) fn limited(limits: Option<impl Into<[f32; 2]>>, compliance: Scalar) -> Axis {
    limits.map_or(Axis::FREE, |limits| {
        let [min, max] = limits.into();
        Axis::limited(min, max).with_give(give(compliance))
    })
}

impl From<DistanceLimit> for [f32; 2] {
    fn from(limit: DistanceLimit) -> Self {
        [to_f32(limit.min), to_f32(limit.max)]
    }
}

impl From<AngleLimit> for [f32; 2] {
    fn from(limit: AngleLimit) -> Self {
        [to_f32(limit.min), to_f32(limit.max)]
    }
}

/// The kernel's motor for an [`AngularMotor`].
pub(super) fn angular_motor(motor: &AngularMotor) -> Option<Motor> {
    kernel_motor(
        motor.enabled,
        [motor.target_velocity, motor.target_position, motor.max_torque],
        motor.motor_model,
    )
}

/// The kernel's motor for a [`LinearMotor`].
pub(super) fn linear_motor(motor: &LinearMotor) -> Option<Motor> {
    kernel_motor(
        motor.enabled,
        [motor.target_velocity, motor.target_position, motor.max_force],
        motor.motor_model,
    )
}

/// The kernel's motor for an [`AxisMotor`].
pub(super) fn axis_motor(motor: &AxisMotor) -> Option<Motor> {
    kernel_motor(
        motor.enabled,
        [motor.target_velocity, motor.target_position, motor.max_effort],
        motor.motor_model,
    )
}

/// The kernel's motor that turns the second frame to the first, with a maximum torque.
pub(super) fn orientation_motor(model: MotorModel, max_torque: Scalar) -> Option<OrientationMotor> {
    Some(OrientationMotor {
        target_rotation: Rot::IDENTITY,
        target_velocity: Angular::ZERO,
        max_torque: effort(max_torque),
        drive: law(model)?,
    })
}

fn kernel_motor(enabled: bool, [velocity, position, max]: [Scalar; 3], model: MotorModel) -> Option<Motor> {
    let drive = law(model)?;
    enabled.then_some(Motor {
        target_velocity: to_f32(velocity),
        target_position: to_f32(position),
        max_force: effort(max),
        drive,
    })
}
