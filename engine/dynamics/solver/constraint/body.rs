//! [`ConstraintBody`]: a body in the interface of constraints.

use kernel::solver::CustomBody;

use crate::{
    math::{
        AngularVector, Scalar, SymmetricTensor, Vector, angular_from_kernel, angular_to_kernel,
        inv_inertia_from_kernel, vector_from_kernel, vector_to_kernel, world_from_kernel,
    },
    physics_transform::Rotation,
};

/// One of the two bodies of a [`Constraint`](super::Constraint).
///
/// A point of the body is given by its arm: the vector from the centre of mass to the point, in m along the
/// world's axes. Impulses on bodies that are not dynamic have no effect.
#[derive(Debug)]
pub struct ConstraintBody<'a>(pub(super) &'a mut CustomBody);

impl ConstraintBody<'_> {
    /// The current centre of mass, in m.
    pub fn center(&self) -> Vector {
        world_from_kernel(self.0.center + self.0.shift.to_world())
    }

    /// The current rotation.
    pub fn rotation(&self) -> Rotation {
        Rotation::from_kernel(self.0.turn.mul(self.0.rotation))
    }

    /// The current arm of a point given in the body's frame, in m.
    pub fn arm_of(&self, local_point: Vector) -> Vector {
        let arm = self.0.rotation.rotate(vector_to_kernel(local_point) - self.0.local_center);
        vector_from_kernel(self.0.turn.rotate(arm))
    }

    /// The current vector from a point of the first body to a point of the second, given by their current
    /// arms. Exact even far from the origin.
    pub fn offset(bodies: &[Self; 2], arms: [Vector; 2]) -> Vector {
        let [a, b] = bodies.each_ref().map(|body| &*body.0);
        let offset = (b.center - a.center).to_local() + (b.shift - a.shift);
        vector_from_kernel(offset) + arms[1] - arms[0]
    }

    /// The velocity of the centre of mass, in m/s.
    pub fn linear_velocity(&self) -> Vector {
        vector_from_kernel(self.0.linear)
    }

    /// The angular velocity, in rad/s, in 3D along the world's axes.
    pub fn angular_velocity(&self) -> AngularVector {
        angular_from_kernel(self.0.angular)
    }

    /// The velocity in m/s of the point with this arm.
    pub fn velocity_at(&self, arm: Vector) -> Vector {
        vector_from_kernel(self.0.velocity_at(vector_to_kernel(arm)))
    }

    /// Applies an impulse in N·s at the point with this arm.
    pub fn apply_impulse(&mut self, impulse: Vector, arm: Vector) {
        self.0.push(vector_to_kernel(impulse), vector_to_kernel(arm));
    }

    /// Applies an angular impulse in N·m·s.
    pub fn apply_angular_impulse(&mut self, impulse: AngularVector) {
        self.0.twist(angular_to_kernel(impulse));
    }

    /// The inverse mass along each of the world's axes, in 1/kg: zero along locked axes, and for bodies that
    /// are not dynamic.
    pub fn inverse_mass(&self) -> Vector {
        vector_from_kernel(self.0.inv_mass)
    }

    /// The inverse angular inertia in 1/(kg·m²), in 3D about the world's axes: zero about locked axes, and
    /// for bodies that are not dynamic.
    pub fn inverse_angular_inertia(&self) -> SymmetricTensor {
        inv_inertia_from_kernel(self.0.inv_inertia)
    }

    /// The inverse effective mass, in 1/kg, of the point with this arm along a unit direction: its velocity
    /// along the direction per impulse along it.
    pub fn inverse_mass_along(&self, direction: Vector, arm: Vector) -> Scalar {
        Scalar::from(self.0.inv_mass_along(vector_to_kernel(direction), vector_to_kernel(arm)))
    }
}
