//! The state of bodies within a step, as components for systems of the app: [`SolverBody`] and
//! [`SolverBodyInertia`].
//!
//! The solver keeps awake bodies in rows of the kernel. If a system of the app queries one of these
//! components, awake dynamic and kinematic bodies have both from
//! [`PrepareSolverBodies`](super::schedule::SolverSystems::PrepareSolverBodies) on. They are written before
//! and read after systems in [`SubstepSchedule`](super::schedule::SubstepSchedule) and in
//! [`PreSubstep`](super::schedule::SolverSystems::PreSubstep) to
//! [`PostSubstep`](super::schedule::SolverSystems::PostSubstep): the solver continues from the values that a
//! system writes. In apps without these systems no body has the components, and they cost nothing.
//!
//! ```
//! # use avian::{dynamics::solver::{schedule::SubstepSolverSystems, solver_body::SolverBody}, math::Vector, prelude::*};
//! # use bevy_app::App;
//! # use bevy_ecs::prelude::*;
//! # use bevy_time::Time;
//! # let mut app = App::new();
//! /// A wind of 3 m/s from the left, in each substep.
//! fn blow(mut bodies: Query<&mut SolverBody>, time: Res<Time>) {
//!     for mut body in &mut bodies {
//!         let push = (Vector::X * 3.0 - body.linear_velocity) * 0.5;
//!         body.linear_velocity += push * time.delta_secs().adjust_precision();
//!     }
//! }
//! # use avian::math::AdjustPrecision;
//! app.add_systems(SubstepSchedule, blow.before(SubstepSolverSystems::WarmStart));
//! ```

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod inertia;
pub(crate) mod lend;
mod plugin;
#[cfg(feature = "3d")]
mod turned;

pub use inertia::{InertiaFlags, SolverBodyInertia};
pub use plugin::SolverBodyPlugin;

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
use kernel::solver::BodyRow;

use crate::{
    dynamics::rigid_body::LockedAxes,
    math::{
        AngularVector, NO_SPIN, Vector, angular_from_kernel, angular_to_kernel, vector_from_kernel,
        vector_to_kernel,
    },
    physics_transform::Rotation,
};

/// Velocity and displacement of an awake body within a step; see the [module](self).
///
/// Static and sleeping bodies do not have this component. Computations use [`SolverBody::DUMMY`] for them, a
/// body at rest.
///
/// Poses are given as displacements since the start of the step, which are exact even far from the origin.
/// Changing them moves the body at the end of the step. A kinematic body has the velocity of its components
/// again in the next step. A body with values that are not finite is moved back, stopped and disabled with a
/// warning.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(Component, Debug, Default)]
pub struct SolverBody {
    /// The velocity of the centre of mass, in m/s along the world's axes.
    pub linear_velocity: Vector,
    /// The angular velocity, in rad/s, in 3D along the world's axes.
    pub angular_velocity: AngularVector,
    /// The displacement of the centre of mass since the start of the step, in m along the world's axes.
    pub delta_position: Vector,
    /// The rotation since the start of the step. The body's rotation is `delta_rotation * rotation`, where
    /// `rotation` is its [`Rotation`] at the start of the step.
    pub delta_rotation: Rotation,
    /// Properties of the body in this step. Changes have no effect.
    pub flags: SolverBodyFlags,
}

impl SolverBody {
    /// The state of an immovable body.
    pub const DUMMY: Self = Self {
        linear_velocity: Vector::ZERO,
        angular_velocity: NO_SPIN,
        delta_position: Vector::ZERO,
        delta_rotation: Rotation::IDENTITY,
        flags: SolverBodyFlags::empty(),
    };

    /// The velocity in m/s of a point of the body. The point is relative to the centre of mass, along the
    /// world's axes.
    pub fn velocity_at_point(&self, point: Vector) -> Vector {
        let spin = angular_to_kernel(self.angular_velocity);
        self.linear_velocity + vector_from_kernel(spin.cross(vector_to_kernel(point)))
    }

    /// Whether the gyroscopic torque changes the body's rotation axis. Never in 2D.
    pub fn is_gyroscopic(&self) -> bool {
        self.flags.contains(SolverBodyFlags::GYROSCOPIC_MOTION)
    }

    /// The state of a row.
    fn of_row(row: &BodyRow, flags: SolverBodyFlags) -> Self {
        let ((v, w), (way, turn)) = (row.velocity(), row.delta());
        Self {
            linear_velocity: vector_from_kernel(v),
            angular_velocity: angular_from_kernel(w),
            delta_position: vector_from_kernel(way),
            delta_rotation: Rotation::from_kernel(turn),
            flags,
        }
    }

    /// Whether this is the state of a row.
    fn is_of_row(&self, row: &BodyRow) -> bool {
        let other = Self::of_row(row, self.flags);
        self.linear_velocity == other.linear_velocity
            && self.angular_velocity == other.angular_velocity
            && self.delta_position == other.delta_position
            && self.delta_rotation == other.delta_rotation
    }

    /// The row with this state. Rotations are normalised.
    fn to_row(&self) -> BodyRow {
        let v = vector_to_kernel(self.linear_velocity);
        let mut row = BodyRow::new(v, angular_to_kernel(self.angular_velocity));
        row.set_delta(vector_to_kernel(self.delta_position), self.delta_rotation.to_kernel().admitted());
        row
    }
}

/// Properties of a body in a step: locked axes as in [`LockedAxes`], and two flags.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Debug, Default, PartialEq)]
#[repr(transparent)]
pub struct SolverBodyFlags(u32);

bitflags::bitflags! {
    impl SolverBodyFlags: u32 {
        /// No translation along the x axis.
        const TRANSLATION_X_LOCKED = 0b100_000;
        /// No translation along the y axis.
        const TRANSLATION_Y_LOCKED = 0b010_000;
        /// No translation along the z axis.
        const TRANSLATION_Z_LOCKED = 0b001_000;
        /// No rotation about the x axis.
        const ROTATION_X_LOCKED = 0b000_100;
        /// No rotation about the y axis.
        const ROTATION_Y_LOCKED = 0b000_010;
        /// No rotation about the z axis.
        const ROTATION_Z_LOCKED = 0b000_001;
        /// No translation.
        const TRANSLATION_LOCKED = 0b111_000;
        /// No rotation.
        const ROTATION_LOCKED = 0b000_111;
        /// Neither translation nor rotation.
        const ALL_LOCKED = 0b111_111;
        /// The body is kinematic, not dynamic.
        const IS_KINEMATIC = 1 << 6;
        /// The gyroscopic torque changes the body's rotation axis.
        const GYROSCOPIC_MOTION = 1 << 7;
    }
}

impl SolverBodyFlags {
    /// The locked axes.
    pub fn locked_axes(&self) -> LockedAxes {
        LockedAxes::from_bits(self.0 as u8 & Self::ALL_LOCKED.0 as u8)
    }

    /// Whether forces move the body.
    pub fn is_dynamic(&self) -> bool {
        !self.is_kinematic()
    }

    /// Whether only its velocity moves the body.
    pub fn is_kinematic(&self) -> bool {
        self.contains(Self::IS_KINEMATIC)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_gives_back_what_it_got() {
        let turn = Rotation::from(bevy_math::Quat::from_rotation_z(0.3));
        let body =
            SolverBody { linear_velocity: Vector::splat(1.5), delta_rotation: turn, ..SolverBody::DUMMY };
        let flags = SolverBodyFlags::IS_KINEMATIC | SolverBodyFlags::ROTATION_LOCKED;
        let back = SolverBody::of_row(&body.to_row(), flags);
        assert_eq!(back.linear_velocity, body.linear_velocity);
        assert_eq!(back.to_row().delta(), body.to_row().delta());
        assert!(back.flags.is_kinematic() && !back.is_gyroscopic());
        assert_eq!(back.flags.locked_axes(), LockedAxes::ROTATION_LOCKED);
        assert_eq!(SolverBody::DUMMY.velocity_at_point(Vector::X), Vector::ZERO);
    }
}
