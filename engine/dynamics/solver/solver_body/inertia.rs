//! [`SolverBodyInertia`]: the mass properties of a body for constraints.

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;

use super::dim::locked_inertia;
use crate::{
    dynamics::rigid_body::LockedAxes,
    math::{NO_INERTIA, Scalar, SymmetricTensor, Vector, vector_from_kernel},
};

/// The dominance of bodies that are not dynamic: above all dynamic bodies.
const ABOVE_ALL: i16 = i8::MAX as i16 + 1;

/// Inverse mass and inertia of a body within a step, including locked axes; see the [module](super).
#[derive(Component, Clone, Debug, Reflect)]
#[reflect(Component, Debug, Default)]
#[reflect(type_path = false)]
pub struct SolverBodyInertia {
    inv_mass: Vector,
    pub(super) inv_inertia: SymmetricTensor,
    dominance: i16,
    flags: InertiaFlags,
}

crate::type_path::type_path!(SolverBodyInertia, "dynamics::solver::solver_body");

impl Default for SolverBodyInertia {
    fn default() -> Self {
        Self::DUMMY
    }
}

impl SolverBodyInertia {
    /// The inertia of an immovable body.
    pub const DUMMY: Self = Self {
        inv_mass: Vector::ZERO,
        inv_inertia: NO_INERTIA,
        dominance: ABOVE_ALL,
        flags: InertiaFlags::STATIC,
    };

    /// The inertia from inverse mass in 1/kg and inverse angular inertia in 1/(kg·m²), in 3D about the
    /// world's axes. Bodies that are not dynamic have infinite mass and inertia, and the highest dominance.
    pub fn new(
        inv_mass: Scalar,
        inv_inertia: SymmetricTensor,
        locked_axes: LockedAxes,
        dominance: i8,
        is_dynamic: bool,
    ) -> Self {
        let locks = locked_axes.to_kernel();
        let mut inertia = Self::DUMMY;
        if is_dynamic {
            inertia.inv_mass = vector_from_kernel(locks.translation_factors()) * inv_mass;
            inertia.inv_inertia = locked_inertia(inv_inertia, locks);
            inertia.dominance = i16::from(dominance);
        }
        inertia.flags = InertiaFlags(u16::from(locks.0));
        inertia.update_flags();
        inertia
    }

    /// Sets the flags of infinite mass and inertia.
    pub(super) fn update_flags(&mut self) {
        self.flags.set(InertiaFlags::INFINITE_MASS, self.inv_mass == Vector::ZERO);
        self.flags.set(InertiaFlags::INFINITE_ANGULAR_INERTIA, self.inv_inertia == NO_INERTIA);
    }

    /// The inverse mass along each of the world's axes, in 1/kg: zero along locked axes.
    pub fn effective_inv_mass(&self) -> Vector {
        self.inv_mass
    }

    /// The inverse angular inertia in 1/(kg·m²), in 3D about the world's axes: zero about locked axes.
    pub fn effective_inv_angular_inertia(&self) -> SymmetricTensor {
        self.inv_inertia
    }

    /// The [`Dominance`](crate::dynamics::rigid_body::Dominance). Bodies that are not dynamic have one more
    /// than the highest value.
    pub fn dominance(&self) -> i16 {
        self.dominance
    }

    /// Locked axes, and flags of infinite mass and inertia.
    pub fn flags(&self) -> InertiaFlags {
        self.flags
    }
}

/// Locked axes as in [`LockedAxes`], and flags of infinite mass and inertia.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[reflect(Debug, Default, PartialEq)]
#[reflect(type_path = false)]
#[repr(transparent)]
pub struct InertiaFlags(u16);

crate::type_path::type_path!(InertiaFlags, "dynamics::solver::solver_body");

bitflags::bitflags! {
    impl InertiaFlags: u16 {
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
        /// No impulse changes the linear velocity.
        const INFINITE_MASS = 1 << 6;
        /// No impulse changes the angular velocity.
        const INFINITE_ANGULAR_INERTIA = 1 << 7;
        /// No impulse changes any velocity.
        const STATIC = Self::INFINITE_MASS.bits() | Self::INFINITE_ANGULAR_INERTIA.bits();
    }
}

impl InertiaFlags {
    /// The locked axes.
    pub fn locked_axes(&self) -> LockedAxes {
        LockedAxes::from_bits(self.0 as u8 & Self::ALL_LOCKED.0 as u8)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dynamics::rigid_body::mass_properties::components::ComputedAngularInertia;

    #[test]
    fn locked_axes_have_infinite_mass() {
        let inverse = ComputedAngularInertia::default().inverse();
        let free = SolverBodyInertia::new(0.5, inverse, LockedAxes::new(), 3, true);
        assert_eq!((free.effective_inv_mass(), free.dominance()), (Vector::splat(0.5), 3));
        let locks = LockedAxes::new().lock_translation_y();
        let rail = SolverBodyInertia::new(0.5, inverse, locks, 0, true);
        assert_eq!(rail.effective_inv_mass() * Vector::Y, Vector::ZERO);
        assert_eq!(rail.flags().locked_axes(), locks);
        assert!(!rail.flags().contains(InertiaFlags::INFINITE_MASS));
        let upright = SolverBodyInertia::new(0.5, inverse, LockedAxes::ROTATION_LOCKED, 0, true);
        assert_eq!(upright.effective_inv_angular_inertia(), NO_INERTIA);
        assert!(upright.flags().contains(InertiaFlags::INFINITE_ANGULAR_INERTIA));
        let lift = SolverBodyInertia::new(0.5, inverse, LockedAxes::new(), 3, false);
        assert_eq!((lift.flags(), lift.dominance()), (InertiaFlags::STATIC, 128));
    }
}
