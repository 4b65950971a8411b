//! [`ConstraintBody`]: a body as a constraint of the app sees it.

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
/// Points of the body are given by their arms: the vectors from the centre of mass, in m along the world's
/// axes. Impulses on bodies that are not dynamic have no effect.
#[derive(Debug)]
pub struct ConstraintBody<'a>(pub(super) &'a mut CustomBody);

impl ConstraintBody<'_> {
    /// The centre of mass now, in m.
    pub fn center(&self) -> Vector {
        world_from_kernel(self.0.center + self.0.shift.to_world())
    }

    /// The rotation now.
    pub fn rotation(&self) -> Rotation {
        Rotation::from_kernel(self.0.turn.mul(self.0.rotation))
    }

    /// The arm now of a point that is given in the body's frame, in m.
    pub fn arm_of(&self, local_point: Vector) -> Vector {
        let arm = self.0.rotation.rotate(vector_to_kernel(local_point) - self.0.local_center);
        vector_from_kernel(self.0.turn.rotate(arm))
    }

    /// The vector now from a point of the first body to one of the second, given by their arms now. Exact
    /// also far from the origin.
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

    /// The velocity in m/s of the point at an arm.
    pub fn velocity_at(&self, arm: Vector) -> Vector {
        vector_from_kernel(self.0.velocity_at(vector_to_kernel(arm)))
    }

    /// Applies an impulse in N·s at an arm.
    pub fn apply_impulse(&mut self, impulse: Vector, arm: Vector) {
        self.0.push(vector_to_kernel(impulse), vector_to_kernel(arm));
    }

    /// Applies an angular impulse in N·m·s.
    pub fn apply_angular_impulse(&mut self, impulse: AngularVector) {
        self.0.twist(angular_to_kernel(impulse));
    }

    /// The inverse mass along each of the world's axes, in 1/kg: zero along locked ones, and for bodies that
    /// are not dynamic.
    pub fn inverse_mass(&self) -> Vector {
        vector_from_kernel(self.0.inv_mass)
    }

    /// The inverse angular inertia in 1/(kg·m²), in 3D about the world's axes: zero about locked ones, and
    /// for bodies that are not dynamic.
    pub fn inverse_angular_inertia(&self) -> SymmetricTensor {
        inv_inertia_from_kernel(self.0.inv_inertia)
    }

    /// The velocity along a unit vector of the point at an arm, per impulse along it, in 1/kg.
    pub fn inverse_mass_along(&self, direction: Vector, arm: Vector) -> Scalar {
        Scalar::from(self.0.inv_mass_along(vector_to_kernel(direction), vector_to_kernel(arm)))
    }
}
