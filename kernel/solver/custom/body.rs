//! One of the two bodies of a custom constraint.

use crate::math::{Angular, InvInertia, Rot, Vector, WorldVector};

/// The state of a body that a custom constraint reads and writes.
#[derive(Clone, Copy, Debug)]
pub struct CustomBody {
    /// Velocity of the centre of mass, m/s.
    pub linear: Vector,
    /// Angular velocity, rad/s.
    pub angular: Angular,
    /// Displacement of the centre of mass since the start of the step, m.
    pub shift: Vector,
    /// Rotation since the start of the step.
    pub turn: Rot,
    /// Centre of mass at the start of the step, m.
    pub center: WorldVector,
    /// Rotation at the start of the step.
    pub rotation: Rot,
    /// Centre of mass in the body's frame, m.
    pub local_center: Vector,
    /// Inverse mass along each axis, 1/kg. Zero for bodies that are not dynamic.
    pub inv_mass: Vector,
    /// Inverse inertia in world axes, 1/(kg·m²).
    pub inv_inertia: InvInertia,
}

impl CustomBody {
    /// Velocity of the point at `arm` from the centre of mass, m/s.
    pub fn velocity_at(&self, arm: Vector) -> Vector {
        self.linear + self.angular.cross(arm)
    }

    /// Velocity per impulse, 1/kg, along a unit vector at `arm` from the centre of mass.
    pub fn inv_mass_along(&self, direction: Vector, arm: Vector) -> f32 {
        let moment = arm.cross(direction);
        direction.dot(self.inv_mass.scale(direction)) + moment.dot(self.inv_inertia.apply(moment))
    }

    /// Applies an impulse, N·s, at `arm` from the centre of mass.
    pub fn push(&mut self, impulse: Vector, arm: Vector) {
        self.linear += self.inv_mass.scale(impulse);
        self.twist(arm.cross(impulse));
    }

    /// Applies an angular impulse, N·m·s.
    pub fn twist(&mut self, impulse: Angular) {
        self.angular += self.inv_inertia.apply(impulse);
    }
}
