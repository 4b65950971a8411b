//! Whether colliders touch. A contact has points earlier: from 2 cm before the surfaces meet, or if they may
//! meet in this step, because the solver stops the bodies there.
//!
//! Colliders start to touch in the step in which a point gets an impulse or their surfaces meet. They touch
//! until the contact has no points. So a body that rattles on the ground touches it all the time.

use kernel::{
    contact::{Contact, ContactFlags, ContactTable, Manifold, ManifoldPoint},
    table::{BodyTable, NONE, Velocity},
};

use crate::dynamics::solver::config::PhysicsLengthUnit;

/// Maximum distance at which surfaces have met, in metres times the length unit. It exceeds the rounding
/// errors of a body that rests on a surface without a force, and is too small to see.
const GAP: f32 = 1.0e-4;

/// Maximum distance at which surfaces have met, in units of length of the app.
pub(crate) fn touching_gap(unit: &PhysicsLengthUnit) -> f32 {
    GAP * unit.metres()
}

/// The end of a step.
pub(crate) struct StepEnd<'a> {
    pub(crate) bodies: &'a BodyTable,
    pub(crate) contacts: &'a ContactTable,
    /// Maximum distance at which surfaces have met.
    pub(crate) gap: f32,
    /// The length of the step.
    pub(crate) dt: f32,
}

impl StepEnd<'_> {
    /// Whether the surfaces of a contact with points have met.
    pub(crate) fn touches(&self, id: u32) -> bool {
        let contact = self.contacts.get(id);
        let mut manifolds = core::iter::once(&contact.manifold).chain(self.contacts.extra_of(contact));
        manifolds.any(|manifold| manifold.points().iter().any(|point| self.meets(contact, manifold, point)))
    }

    fn meets(&self, contact: &Contact, manifold: &Manifold, point: &ManifoldPoint) -> bool {
        // A sensor has points only where surfaces meet in the step.
        let is_sensor = contact.flags.has(ContactFlags::SENSOR);
        if is_sensor || point.impulse > 0.0 || point.total_impulse > 0.0 || point.separation <= self.gap {
            return true;
        }
        // Other points that meet get an impulse from the solver.
        contact.is_inert() && point.separation + self.way_apart(contact, manifold, point) <= self.gap
    }

    /// The distance by which the surfaces of a contact without response separated at a point in the step.
    fn way_apart(&self, contact: &Contact, manifold: &Manifold, point: &ManifoldPoint) -> f32 {
        let velocity = |side: usize| match contact.bodies[side] {
            NONE => Velocity::default(),
            body => self.bodies.velocities[body as usize],
        };
        let [a, b] = [velocity(0), velocity(1)];
        let arm = match contact.bodies {
            [_, NONE] | [NONE, _] => point.anchor,
            [a, b] => {
                let [a, b] = [a, b].map(|body| self.bodies.poses[body as usize].center);
                point.anchor - (b - a).to_local()
            }
        };
        let parting = b.linear + b.angular.cross(arm) - a.linear - a.angular.cross(point.anchor);
        manifold.normal.dot(parting) * self.dt
    }
}
