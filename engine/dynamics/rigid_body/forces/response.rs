//! The response of a body to forces and torques, by its mass, inertia and locked axes.

use kernel::math::{AxisLocks, InvInertia};

use crate::{
    dynamics::rigid_body::{
        LockedAxes,
        mass_properties::components::{ComputedAngularInertia, ComputedMass},
    },
    math::{
        AngularVector, Scalar, Vector, angular_from_kernel, angular_to_kernel, inv_inertia_to_kernel,
        vector_from_kernel,
    },
    physics_transform::{Rotation, unit_rotation},
};

/// The inverse mass of a body, and its inverse inertia in world axes. Locked axes have an infinite
/// mass or inertia.
pub(super) struct Response {
    inverse_mass: Scalar,
    inverse_inertia: InvInertia,
    locks: AxisLocks,
}

impl Response {
    pub(super) fn new(
        mass: &ComputedMass,
        inertia: &ComputedAngularInertia,
        rotation: &Rotation,
        locks: Option<&LockedAxes>,
    ) -> Self {
        let locks = locks.map_or(AxisLocks::NONE, |locks| locks.to_kernel());
        let local = inv_inertia_to_kernel(inertia.inverse());
        let inverse_inertia = local.rotated(unit_rotation(rotation)).locked(locks);
        Self { inverse_mass: mass.inverse(), inverse_inertia, locks }
    }

    /// The acceleration of the centre of mass by a force, or its change of velocity by an impulse.
    pub(super) fn linear(&self, force: Vector) -> Vector {
        self.free_linear(force * self.inverse_mass)
    }

    /// The angular acceleration by a torque, or the change of angular velocity by an angular impulse.
    pub(super) fn angular(&self, torque: AngularVector) -> AngularVector {
        angular_from_kernel(self.inverse_inertia.apply(angular_to_kernel(torque)))
    }

    /// The component of a vector along free axes.
    pub(super) fn free_linear(&self, acceleration: Vector) -> Vector {
        if !self.locks.is_translation_held() {
            return acceleration;
        }
        acceleration * vector_from_kernel(self.locks.translation_factors())
    }

    /// The component of an angular acceleration about free axes.
    pub(super) fn free_angular(&self, acceleration: AngularVector) -> AngularVector {
        acceleration * angular_from_kernel(self.locks.rotation_factors())
    }

    /// The force that gives the centre of mass an acceleration. Zero for an infinite mass.
    pub(super) fn force_of(&self, acceleration: Vector) -> Vector {
        if self.inverse_mass > 0.0 { acceleration / self.inverse_mass } else { Vector::ZERO }
    }
}
