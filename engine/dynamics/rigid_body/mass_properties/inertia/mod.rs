//! The arithmetic of mass: parts of a body, each with mass, centre and inertia, added up.
//!
//! In `f64` throughout: where parts lie far off their common centre the parallel axis theorem cancels large
//! terms, and glam's `f64` types compute alike on every machine, which its `f32` quaternions and matrices do
//! not. (Why not `bevy_heavy`'s sum: it diagonalises, by an arc cosine and with an absolute tolerance.)

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod frame;

pub(super) use dim::Inertia;
pub(super) use frame::{Frame, Vector64};

use dim::{mass_properties, narrow_vector, widen_vector};
use frame::{narrow, sanitize};

use super::components::{AngularInertia, CenterOfMass, ComputedMass, Mass};
use crate::math::{AdjustPrecision, MassProperties, Scalar, VectorF32};

/// A share of a body's mass.
#[derive(Clone, Copy, Debug)]
pub(super) struct Part {
    /// In kg.
    pub(super) mass: f64,
    /// The centre of mass in metres.
    pub(super) center: Vector64,
    /// About the centre of mass, in kg·m².
    pub(super) inertia: Inertia,
}

impl Part {
    /// Weighs nothing.
    pub(super) const ZERO: Self = Self { mass: 0.0, center: Vector64::ZERO, inertia: Inertia::ZERO };

    /// What a collider contributes.
    pub(super) fn from_collider(properties: &MassProperties) -> Self {
        Self {
            mass: sanitize(properties.mass),
            center: sanitize_center(properties.center_of_mass),
            inertia: Inertia::from_properties(properties),
        }
    }

    /// Lets an entity's own components replace what its collider contributes. A mass alone scales the
    /// collider's inertia.
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

    /// The same part seen from the frame in which its own lies at `frame`.
    pub(super) fn moved(self, frame: &Frame) -> Self {
        Self {
            mass: self.mass,
            center: frame.translation + frame.rotation * self.center,
            inertia: self.inertia.rotated(frame.rotation),
        }
    }

    /// The total of some parts: masses added, centres averaged by mass, inertias moved to the common centre by
    /// the parallel axis theorem. The centre of parts without mass is that of the first.
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

    /// The mass for the solver; infinite for none, and for what `f32` cannot hold.
    pub(super) fn computed_mass(&self) -> ComputedMass {
        if self.mass > 0.0 && self.mass < f64::from(f32::MAX) {
            ComputedMass::new(self.mass as Scalar)
        } else {
            ComputedMass::INFINITY
        }
    }

    /// As the public functions give it, in `f32`.
    pub(super) fn to_properties(self) -> MassProperties {
        mass_properties(narrow(self.mass), narrow_vector(self.center), self.inertia)
    }
}

/// The centre of mass in the public precision.
pub(super) fn computed_center(center: Vector64) -> super::components::ComputedCenterOfMass {
    super::components::ComputedCenterOfMass(center.adjust_precision())
}

/// A centre that is a place: the origin for what is none.
fn sanitize_center(center: VectorF32) -> Vector64 {
    if center.is_finite() { widen_vector(center) } else { Vector64::ZERO }
}
