//! 2D parts of the tests of forces. `dim3.rs` has those of 3D.

use avian::{math::Scalar, prelude::*};
use bevy_ecs::prelude::*;

/// An angular velocity or torque.
pub type Angular = Scalar;

/// About z.
pub fn about_z(w: Scalar) -> Angular {
    w
}

/// The component about z.
pub fn z_of(w: Angular) -> Scalar {
    w
}

/// A body with a mass in kg and a moment of inertia in kg·m², without a collider.
pub fn body(mass: f32, inertia: f32) -> impl Bundle {
    (RigidBody::Dynamic, Mass(mass), AngularInertia(inertia))
}

#[test]
fn constant_forces_are_made_of_components() {
    assert_eq!(ConstantForce::new(1.0, 2.0).0, avian::math::Vector::new(1.0, 2.0));
    assert_eq!(ConstantLocalForce::new(1.0, 2.0).0, avian::math::Vector::new(1.0, 2.0));
    assert_eq!(ConstantLinearAcceleration::new(1.0, 2.0).0, avian::math::Vector::new(1.0, 2.0));
    assert_eq!(ConstantLocalLinearAcceleration::new(1.0, 2.0).0, avian::math::Vector::new(1.0, 2.0));
}
