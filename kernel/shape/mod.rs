//! Shapes: their boxes, support points, masses, and ray hits.
//!
//! Shapes are convex, in `f32`, in a frame of their own. All other shapes are [`Shape::Foreign`] in the tables, and get their
//! manifolds from a [`ManifoldSource`](crate::contact::ManifoldSource).

mod aabb;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod primitives;
mod results;

pub use aabb::Aabb;
pub use dim::*;
pub use primitives::{Ball, Capsule, Cuboid, HalfSpace, Segment, Triangle};
pub use results::{RayHit, ShapeError};

use crate::math::{Vector, WorldPose};
use std::sync::Arc;

/// A convex shape.
#[derive(Clone, Debug)]
pub enum Shape {
    /// A circle or sphere.
    Ball(Ball),
    /// A segment with a radius.
    Capsule(Capsule),
    /// A rectangle or box.
    Cuboid(Cuboid),
    /// A convex polygon or polyhedron.
    Hull(Arc<Hull>),
    /// A triangle: solid in 2D, a two-sided surface in 3D.
    Triangle(Triangle),
    /// A line segment without thickness.
    Segment(Segment),
    /// The half of space behind a plane through the origin.
    HalfSpace(HalfSpace),
    /// A shape of the embedder, which provides its box and its manifolds.
    Foreign(Foreign),
}

/// The box of a shape whose geometry only the embedder knows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foreign {
    /// The box around the shape in its own frame.
    pub aabb: Aabb,
}

impl Shape {
    /// The box around the shape at a world pose, rounded outward to `f32`. Half-spaces give an
    /// infinite box.
    pub fn aabb(&self, pose: &WorldPose) -> Aabb {
        self.local_aabb(pose.rotation).at(pose.position)
    }

    /// Whether another shape is known to be the same. Hulls are compared by reference. Foreign shapes are never known to be the
    /// same.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Ball(a), Self::Ball(b)) => a == b,
            (Self::Capsule(a), Self::Capsule(b)) => a == b,
            (Self::Cuboid(a), Self::Cuboid(b)) => a == b,
            (Self::Hull(a), Self::Hull(b)) => Arc::ptr_eq(a, b),
            (Self::Triangle(a), Self::Triangle(b)) => a == b,
            (Self::Segment(a), Self::Segment(b)) => a == b,
            (Self::HalfSpace(a), Self::HalfSpace(b)) => a == b,
            _ => false,
        }
    }

    /// Prefetches the geometry that the shape shares with others.
    #[inline(always)]
    pub(crate) fn prefetch(&self) {
        if let Self::Hull(hull) = self {
            crate::data::prefetch(core::slice::from_ref(&**hull), 0);
        }
    }

    /// The box around the shape in its own frame turned by `rotation`, about the frame's origin.
    pub fn local_aabb(&self, rotation: crate::math::Rot) -> Aabb {
        match self {
            Self::Ball(s) => s.local_aabb(),
            Self::Capsule(s) => s.local_aabb(rotation),
            Self::Cuboid(s) => s.local_aabb(rotation),
            Self::Hull(s) => Aabb::around(s.vertices().iter().map(|v| rotation.rotate(*v))).grown(s.radius()),
            Self::Triangle(s) => Aabb::around([s.a, s.b, s.c].map(|v| rotation.rotate(v))),
            Self::Segment(s) => Aabb::around([s.a, s.b].map(|v| rotation.rotate(v))),
            Self::HalfSpace(_) => Aabb::EVERYTHING,
            Self::Foreign(s) => s.aabb.rotated(rotation),
        }
    }

    /// The point of the shape farthest along `direction` (any length), radius included. `None` for
    /// half-spaces and foreign shapes.
    pub fn support(&self, direction: Vector) -> Option<Vector> {
        Some(match self {
            Self::Ball(s) => s.support(direction),
            Self::Capsule(s) => s.support(direction),
            Self::Cuboid(s) => s.support(direction),
            Self::Hull(s) => s.support(direction),
            Self::Triangle(s) => s.support(direction),
            Self::Segment(s) => s.support(direction),
            Self::HalfSpace(_) | Self::Foreign(_) => return None,
        })
    }

    /// The distance from `center` to the farthest point of the shape, in metres: how far a point of
    /// the shape moves, per radian, when it turns about `center`. Zero for half-spaces.
    pub fn extent(&self, center: Vector) -> f32 {
        let farthest = |points: &[Vector]| {
            points.iter().map(|p| (*p - center).length_squared()).fold(0.0, crate::math::max).sqrt()
        };
        match self {
            Self::Ball(s) => center.length() + s.radius,
            Self::Capsule(s) => farthest(&[s.a, s.b]) + s.radius,
            Self::Cuboid(s) => (center.abs() + s.half).length(),
            Self::Hull(s) => farthest(s.vertices()) + s.radius(),
            Self::Triangle(s) => farthest(&[s.a, s.b, s.c]),
            Self::Segment(s) => farthest(&[s.a, s.b]),
            Self::HalfSpace(_) => 0.0,
            Self::Foreign(s) => farthest(&s.aabb.corners()),
        }
    }

    /// The largest distance at which a normal of the surface passes a point of the shape's frame, in metres; 0 for half-spaces.
    pub fn arm(&self, center: Vector) -> f32 {
        let farthest = self.extent(center) - self.radius();
        match self {
            // A normal at the distance a passes a face at √(r² − a²) from there.
            Self::Cuboid(s) => {
                let inside = crate::math::max((s.half - center.abs()).min_element(), 0.0);
                crate::math::max(farthest * farthest - inside * inside, 0.0).sqrt()
            }
            _ => farthest,
        }
    }

    /// A large ball within the shape: its centre and its radius, 0 for what has no inside.
    pub fn core(&self) -> (Vector, f32) {
        match self {
            Self::Ball(s) => (Vector::ZERO, s.radius),
            Self::Capsule(s) => ((s.a + s.b) * 0.5, s.radius),
            Self::Cuboid(s) => (Vector::ZERO, s.half.min_element()),
            Self::Hull(s) => s.core(),
            Self::Triangle(s) => core_of_triangle(s),
            Self::Segment(s) => ((s.a + s.b) * 0.5, 0.0),
            Self::HalfSpace(_) => (Vector::ZERO, f32::MAX),
            // What is within the box is not known.
            Self::Foreign(s) => (s.aabb.center(), 0.5 * s.aabb.half().min_element()),
        }
    }

    /// The radius around the shape's core (a point, a segment or a polygon), in metres. Zero for sharp and foreign shapes.
    pub fn radius(&self) -> f32 {
        match self {
            Self::Ball(s) => s.radius,
            Self::Capsule(s) => s.radius,
            Self::Hull(s) => s.radius(),
            Self::Cuboid(_)
            | Self::Triangle(_)
            | Self::Segment(_)
            | Self::HalfSpace(_)
            | Self::Foreign(_) => 0.0,
        }
    }

    /// The first hit of a ray from `origin` along the unit vector `direction` on the shape within
    /// `max_distance`, all in the shape's frame.
    ///
    /// A ray that starts inside hits at distance 0 with a zero normal if `solid`, else the boundary
    /// from within. Surfaces without an inside (3D triangles, segments) are hit from both sides;
    /// segments in 3D and foreign shapes are never hit.
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        match self {
            Self::Ball(s) => s.cast_ray(origin, direction, max_distance, solid),
            Self::Capsule(s) => s.cast_ray(origin, direction, max_distance, solid),
            Self::Cuboid(s) => s.cast_ray(origin, direction, max_distance, solid),
            Self::Hull(s) => s.cast_ray(origin, direction, max_distance, solid),
            Self::Triangle(s) => cast_ray_triangle(s, origin, direction, max_distance, solid),
            Self::Segment(s) => cast_ray_segment(s, origin, direction, max_distance),
            Self::HalfSpace(s) => s.cast_ray(origin, direction, max_distance, solid),
            Self::Foreign(_) => None,
        }
    }

    /// Mass, centre of mass and inertia at a uniform density in kg/m² or kg/m³. Zero for shapes
    /// without an inside, for half-spaces, and for foreign shapes.
    pub fn mass_properties(&self, density: f32) -> MassProperties {
        let unit = match self {
            Self::Ball(s) => mass_of_ball(s),
            Self::Capsule(s) => mass_of_capsule(s),
            Self::Cuboid(s) => mass_of_cuboid(s),
            Self::Hull(s) => s.unit_mass(),
            Self::Triangle(s) => mass_of_triangle(s),
            Self::Segment(_) | Self::HalfSpace(_) | Self::Foreign(_) => MassProperties::ZERO,
        };
        unit.scaled(density)
    }
}
