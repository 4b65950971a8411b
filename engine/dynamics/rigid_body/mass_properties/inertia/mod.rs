//! Sums of mass properties: parts of a body, each with mass, centre and inertia.
//!
//! Computed in `f64`: if parts are far from their common centre, large terms of the parallel axis theorem
//! cancel. glam's `f64` types give the same results on every machine, its `f32` quaternions and matrices do
//! not. (`bevy_heavy`'s sum is not used: it diagonalises by an arc cosine and with an absolute tolerance.)

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod frame;

pub(super) use dim::Inertia;
pub(super) use frame::{PartFrame, Vector64};

use dim::{mass_properties, narrow_vector, widen_vector};
use frame::{narrow, sanitize};

use super::components::{AngularInertia, CenterOfMass, ComputedMass, Mass};
use crate::math::{AdjustPrecision, MassProperties, Scalar, VectorF32};

/// The mass properties of a part of a body.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// Mass, in kg.
    pub(super) mass: f64,
    /// Centre of mass, in metres.
    pub(super) center: Vector64,
    /// Inertia about the centre of mass, in kg·m².
    pub(super) inertia: Inertia,
}

impl Part {
    /// No mass.
    pub(super) const ZERO: Self = Self { mass: 0.0, center: Vector64::ZERO, inertia: Inertia::ZERO };

    /// The mass properties of a collider.
    pub(super) fn from_collider(properties: &MassProperties) -> Self {
        Self {
            mass: sanitize(properties.mass),
            center: sanitize_center(properties.center_of_mass),
            inertia: Inertia::from_properties(properties),
        }
    }

    /// Replaces the collider's properties by the entity's own components. A mass without an inertia scales
    /// the collider's inertia.
    pub(super) fn overridden(
        mut self,
        mass: Option<&Mass>,
        inertia: Option<&AngularInertia>,
        center: Option<&CenterOfMass>,
    ) -> Self {
        if let Some(mass) = mass {
            let mass = sanitize(mass.0);
            if self.mass > 0.0 {
                self.inertia = self.inertia.scaled(mass / self.mass);
            }
            self.mass = mass;
        }
        if let Some(inertia) = inertia {
            self.inertia = Inertia::from_component(inertia);
        }
        if let Some(center) = center {
            self.center = sanitize_center(center.0);
        }
        self
    }

    /// The part in the outer frame, for a part given in `frame`.
    pub(super) fn moved(self, frame: &PartFrame) -> Self {
        Self {
            mass: self.mass,
            center: frame.translation + frame.rotation * self.center,
            inertia: self.inertia.rotated(frame.rotation),
        }
    }

    /// The total of several parts: the sum of masses, the mean of centres weighted by mass, and the sum of
    /// inertias about the common centre by the parallel axis theorem. If no part has mass, the centre is the
    /// first part's.
    pub(super) fn sum(parts: &[Part]) -> Self {
        let [first, rest @ ..] = parts else {
            return Self::ZERO;
        };
        if rest.is_empty() {
            return *first;
        }
        let mass: f64 = parts.iter().map(|part| part.mass).sum();
        let center = if mass > 0.0 {
            parts.iter().map(|part| part.center * (part.mass / mass)).sum()
        } else {
            first.center
        };
        let inertia = parts
            .iter()
            .map(|part| part.inertia.shifted(part.mass, part.center - center))
            .fold(Inertia::ZERO, |total, inertia| total.plus(inertia));
        Self { mass, center, inertia }
    }

    /// The mass for the solver. Infinite if zero or beyond the range of `f32`.
    pub(super) fn computed_mass(&self) -> ComputedMass {
        if self.mass > 0.0 && self.mass < f64::from(f32::MAX) {
            ComputedMass::new(self.mass as Scalar)
        } else {
            ComputedMass::INFINITY
        }
    }

    /// Converted to the public type, in `f32`.
    pub(super) fn to_properties(self) -> MassProperties {
        mass_properties(narrow(self.mass), narrow_vector(self.center), self.inertia)
    }
}

/// The centre of mass in the public precision.
pub(super) fn computed_center(center: Vector64) -> super::components::ComputedCenterOfMass {
    super::components::ComputedCenterOfMass(center.adjust_precision())
}

/// A finite centre. NaN and infinity become the origin.
fn sanitize_center(center: VectorF32) -> Vector64 {
    if center.is_finite() { widen_vector(center) } else { Vector64::ZERO }
}
