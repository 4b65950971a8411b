//! [`ContactManifold`] in 3D: up to four points. `dim2.rs` exports the same names.

use kernel::math as k;

use super::point::ContactPoint;
use crate::math::{AdjustPrecision, Scalar, Vector, Vector2};

/// The number of points that a manifold needs.
const ENOUGH: usize = 4;

/// The contact points of two convex shapes with one normal.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactManifold {
    /// The points.
    pub points: Vec<ContactPoint>,
    /// The unit normal in the world, from the first collider to the second.
    pub normal: Vector,
    /// The mixed friction coefficient.
    pub friction: Scalar,
    /// The mixed coefficient of restitution.
    pub restitution: Scalar,
    /// The velocity of the second surface relative to the first that friction drives the bodies to, in the
    /// world, m/s, as on a conveyor belt. 0 unless [`CollisionHooks`](crate::prelude::CollisionHooks) set it.
    pub tangent_velocity: Vector,
}

impl ContactManifold {
    /// A manifold without friction and restitution.
    pub fn new(points: impl IntoIterator<Item = ContactPoint>, normal: Vector) -> Self {
        Self {
            points: points.into_iter().collect(),
            normal,
            friction: 0.0,
            restitution: 0.0,
            tangent_velocity: Vector::ZERO,
        }
    }

    /// Keeps at most four points: the deepest point, and the points that span the largest area with it.
    pub fn prune_points(&mut self) {
        if self.points.len() <= ENOUGH {
            return;
        }
        let mut left = core::mem::take(&mut self.points);
        let mut take = |left: &mut Vec<ContactPoint>, value: &dyn Fn(&ContactPoint) -> Scalar| {
            let mut best = 0;
            for (i, point) in left.iter().enumerate() {
                if value(point) > value(&left[best]) {
                    best = i;
                }
            }
            let point = left.swap_remove(best);
            self.points.push(point);
            point.anchor1
        };
        let a = take(&mut left, &|p| p.penetration);
        let b = take(&mut left, &|p| p.anchor1.distance_squared(a));
        let area = |p: &ContactPoint| (p.anchor1 - a).cross(p.anchor1 - b).dot(self.normal);
        let c = take(&mut left, &|p| area(p).abs());
        // The last point is on the other side of the edge of the triangle that it is farthest from.
        let side = (c - a).cross(c - b).dot(self.normal).signum();
        take(&mut left, &|p| -side * area(p));
    }
}

/// An impulse along both tangents of a normal.
pub(super) fn tangent_impulse(normal: k::Vector, impulse: k::Vector) -> Vector2 {
    let k::Tangent { x, y } = k::TangentFrame::new(normal).project(impulse);
    Vector2::new(x.adjust_precision(), y.adjust_precision())
}

impl ContactManifold {
    /// The velocity of the second surface relative to the first that friction drives the bodies to.
    pub(super) fn surface_velocity(&self) -> Vector {
        self.tangent_velocity
    }

    pub(super) fn set_surface_velocity(&mut self, velocity: Vector) {
        self.tangent_velocity = velocity;
    }
}
