//! [`ContactManifold`] in 2D: up to two points. `dim3.rs` exports the same names.

use arrayvec::ArrayVec;
use kernel::math as k;

use super::point::ContactPoint;
use crate::math::{AdjustPrecision, Scalar, Vector};

/// The contact points of two convex shapes with one normal.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactManifold {
    /// The points.
    pub points: ArrayVec<ContactPoint, 2>,
    /// The unit normal in the world, from the first collider to the second.
    pub normal: Vector,
    /// The mixed friction coefficient.
    pub friction: Scalar,
    /// The mixed coefficient of restitution.
    pub restitution: Scalar,
    /// The speed of the second surface relative to the first that friction drives the bodies to, m/s, as on a
    /// conveyor belt. It is along the tangent, which is the normal turned clockwise. 0 unless
    /// [`CollisionHooks`](crate::prelude::CollisionHooks) set it.
    pub tangent_speed: Scalar,
}

impl ContactManifold {
    /// A manifold without friction and restitution. Points after the second are dropped.
    pub fn new(points: impl IntoIterator<Item = ContactPoint>, normal: Vector) -> Self {
        Self {
            points: points.into_iter().take(2).collect(),
            normal,
            friction: 0.0,
            restitution: 0.0,
            tangent_speed: 0.0,
        }
    }
}

/// An impulse along the tangent of a normal.
pub(super) fn tangent_impulse(normal: k::Vector, impulse: k::Vector) -> Scalar {
    k::TangentFrame::new(normal).project(impulse).x.adjust_precision()
}

/// The tangent along which surface speed is measured: it points right if the normal points up.
fn tangent(normal: Vector) -> Vector {
    Vector::new(normal.y, -normal.x)
}

impl ContactManifold {
    /// The velocity of the second surface relative to the first that friction drives the bodies to.
    pub(super) fn surface_velocity(&self) -> Vector {
        tangent(self.normal) * self.tangent_speed
    }

    pub(super) fn set_surface_velocity(&mut self, velocity: Vector) {
        self.tangent_speed = tangent(self.normal).dot(velocity);
    }
}
