//! Shapes: their boxes, support points, masses, and ray hits.
//!
//! Shapes are in `f32`, in their own frame. They are convex, or [composites](Composite) of convex parts. All
//! other shapes are [`Shape::Foreign`] in the tables, and get their manifolds from a
//! [`ManifoldSource`](crate::contact::ManifoldSource).

mod aabb;
mod adjacency;
mod composite;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod part_tree;
mod primitives;
mod results;
mod surface;

pub use aabb::Aabb;
pub use adjacency::NO_FACET;
pub use composite::{Composite, Part};
pub use dim::*;
pub use part_tree::PartTree;
pub use primitives::{Ball, Capsule, Cuboid, HalfSpace, Segment, Triangle};
pub use results::{RayHit, ShapeError};
pub use surface::Surface;

use crate::math::{Pose, Vector, WorldPose};
use std::sync::Arc;

/// A shape.
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
    /// An ellipse in 2D; a cylinder, cone or frustum in 3D.
    Curved(Curved),
    /// A line segment without thickness.
    Segment(Segment),
    /// The half of space behind a plane through the origin.
    HalfSpace(HalfSpace),
    /// A surface of triangles (3D) or segments (2D), or several solids as one shape.
    Composite(Arc<Composite<Self>>),
    /// A shape of the embedder, which provides its box and its manifolds.
    Foreign(Foreign),
}

/// The box of a shape whose geometry only the embedder knows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foreign {
    /// The box around the shape in its own frame.
    pub aabb: Aabb,
}

impl From<Segment> for Shape {
    fn from(segment: Segment) -> Self {
        Self::Segment(segment)
    }
}

impl From<Triangle> for Shape {
    fn from(triangle: Triangle) -> Self {
        Self::Triangle(triangle)
    }
}

impl Shape {
    /// A surface as a shape.
    pub fn surface(surface: Surface) -> Self {
        let solid = surface.solid().map(|hull| {
            let solids = vec![(Pose::IDENTITY, Self::Hull(Arc::new(hull)))];
            Composite::of_solids(solids, |pose, solid| solid.local_box(pose))
        });
        Self::Composite(Arc::new(Composite::of_surface(surface, solid)))
    }

    /// Convex solids at poses as one shape.
    ///
    /// # Errors
    /// If there is no solid, or a solid is not convex, unbounded, or unknown to the kernel.
    pub fn compound(solids: Vec<(Pose, Self)>) -> Result<Self, ShapeError> {
        let is_solid = |s: &Self| !matches!(s, Self::HalfSpace(_) | Self::Composite(_) | Self::Foreign(_));
        if solids.is_empty() {
            return Err(ShapeError::Degenerate);
        }
        if !solids.iter().all(|(_, solid)| is_solid(solid)) {
            return Err(ShapeError::NotConvex);
        }
        if !solids.iter().all(|(pose, _)| pose.position.is_finite() && pose.rotation.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        Ok(Self::Composite(Arc::new(Composite::of_solids(solids, |pose, solid| solid.local_box(pose)))))
    }

    /// The box around the shape at a pose, in that pose's outer frame.
    pub fn local_box(&self, pose: &Pose) -> Aabb {
        let turned = self.local_aabb(pose.rotation);
        Aabb { min: turned.min + pose.position, max: turned.max + pose.position }
    }

    /// The box around the shape at a world pose, rounded outward to `f32`. Half-spaces give an infinite box.
    pub fn aabb(&self, pose: &WorldPose) -> Aabb {
        self.local_aabb(pose.rotation).at(pose.position)
    }

    /// Whether another shape is known to be equal. Hulls and composites are compared by reference. Foreign
    /// shapes are never known to be equal.
    pub fn is_same(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Ball(a), Self::Ball(b)) => a == b,
            (Self::Capsule(a), Self::Capsule(b)) => a == b,
            (Self::Cuboid(a), Self::Cuboid(b)) => a == b,
            (Self::Hull(a), Self::Hull(b)) => Arc::ptr_eq(a, b),
            (Self::Triangle(a), Self::Triangle(b)) => a == b,
            (Self::Segment(a), Self::Segment(b)) => a == b,
            (Self::Curved(a), Self::Curved(b)) => a == b,
            (Self::HalfSpace(a), Self::HalfSpace(b)) => a == b,
            (Self::Composite(a), Self::Composite(b)) => Arc::ptr_eq(a, b),
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
            Self::Hull(s) => s.local_aabb(rotation),
            Self::Triangle(s) => Aabb::around([s.a, s.b, s.c].map(|v| rotation.rotate(v))),
            Self::Segment(s) => Aabb::around([s.a, s.b].map(|v| rotation.rotate(v))),
            Self::Curved(s) => s.local_aabb(rotation),
            Self::HalfSpace(_) => Aabb::EVERYTHING,
            Self::Composite(s) => composite_box(s, rotation),
            Self::Foreign(s) => s.aabb.rotated(rotation),
        }
    }

    /// A ball around the shape: its centre and its radius in metres. Very large for unbounded shapes.
    pub(crate) fn ball_around(&self) -> (Vector, f32) {
        let around = |a: Vector, b: Vector, radius: f32| ((a + b) * 0.5, 0.5 * (b - a).length() + radius);
        let around_box = |aabb: Aabb| (aabb.center(), aabb.half().length());
        match self {
            Self::Ball(s) => (Vector::ZERO, s.radius),
            Self::Capsule(s) => around(s.a, s.b, s.radius),
            Self::Cuboid(s) => (Vector::ZERO, s.half.length()),
            Self::Hull(s) => s.ball_around(),
            Self::Segment(s) => around(s.a, s.b, 0.0),
            Self::Composite(s) => around_box(s.tree().bounds()),
            Self::Foreign(s) => around_box(s.aabb),
            Self::Triangle(_) | Self::Curved(_) | Self::HalfSpace(_) => {
                around_box(self.local_aabb(crate::math::Rot::IDENTITY))
            }
        }
    }

    /// The point of the shape farthest along `direction` (any length), radius included. `None` for
    /// half-spaces, composites and foreign shapes.
    pub fn support(&self, direction: Vector) -> Option<Vector> {
        Some(match self {
            Self::Ball(s) => s.support(direction),
            Self::Capsule(s) => s.support(direction),
            Self::Cuboid(s) => s.support(direction),
            Self::Hull(s) => s.support(direction),
            Self::Triangle(s) => s.support(direction),
            Self::Segment(s) => s.support(direction),
            Self::Curved(s) => s.support(direction),
            Self::HalfSpace(_) | Self::Composite(_) | Self::Foreign(_) => return None,
        })
    }

    /// The distance from `center` to the farthest point of the shape, in metres. It bounds the displacement
    /// of a point of the shape per radian when the shape turns about `center`. Zero for half-spaces.
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
            Self::Curved(s) => s.extent(center),
            Self::HalfSpace(_) => 0.0,
            Self::Composite(s) => match s.surface() {
                Some(surface) => farthest(surface.vertices()),
                None => s.solids().iter().fold(0.0, |most, (pose, solid)| {
                    crate::math::max(most, solid.extent(pose.inverse_transform(center)))
                }),
            },
            Self::Foreign(s) => farthest(&s.aabb.corners()),
        }
    }

    /// Maximum distance between a normal of the surface and a point of the shape's frame, in metres; 0 for
    /// half-spaces.
    pub fn arm(&self, center: Vector) -> f32 {
        let farthest = self.extent(center) - self.radius();
        match self {
            // A normal of a face at the distance a from the point passes the point at √(r² − a²) at most.
            Self::Cuboid(s) => {
                let inside = crate::math::max((s.half - center.abs()).min_element(), 0.0);
                crate::math::max(farthest * farthest - inside * inside, 0.0).sqrt()
            }
            _ => farthest,
        }
    }

    /// A large ball within the shape: its centre and its radius, which is 0 for shapes without an inside.
    pub fn core(&self) -> (Vector, f32) {
        match self {
            Self::Ball(s) => (Vector::ZERO, s.radius),
            Self::Capsule(s) => ((s.a + s.b) * 0.5, s.radius),
            Self::Cuboid(s) => (Vector::ZERO, s.half.min_element()),
            Self::Hull(s) => s.core(),
            Self::Triangle(s) => core_of_triangle(s),
            Self::Curved(s) => s.core(),
            Self::Segment(s) => ((s.a + s.b) * 0.5, 0.0),
            Self::HalfSpace(_) => (Vector::ZERO, f32::MAX),
            Self::Composite(s) => core_of_composite(s),
            // The embedder's geometry inside the box is unknown.
            Self::Foreign(s) => (s.aabb.center(), 0.5 * s.aabb.half().min_element()),
        }
    }

    /// The radius around the shape's core (a point, a segment or a polygon), in metres. Zero for sharp,
    /// curved, composite and foreign shapes.
    pub fn radius(&self) -> f32 {
        match self {
            Self::Ball(s) => s.radius,
            Self::Capsule(s) => s.radius,
            Self::Hull(s) => s.radius(),
            Self::Cuboid(_)
            | Self::Triangle(_)
            | Self::Segment(_)
            | Self::Curved(_)
            | Self::HalfSpace(_)
            | Self::Composite(_)
            | Self::Foreign(_) => 0.0,
        }
    }

    /// The first hit of a ray from `origin` along the unit vector `direction` on the shape within
    /// `max_distance`, all in the shape's frame.
    ///
    /// A ray that starts inside hits at distance 0 with a zero normal if `solid`, otherwise it hits the
    /// boundary from within. Surfaces without an inside (3D triangles, segments) are hit from both sides;
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
            Self::Curved(s) => s.cast_ray(origin, direction, max_distance, solid),
            Self::HalfSpace(s) => s.cast_ray(origin, direction, max_distance, solid),
            Self::Composite(s) => cast_ray_composite(s, origin, direction, max_distance, solid),
            Self::Foreign(_) => None,
        }
    }

    /// Mass, centre of mass and inertia at a uniform density in kg/m² or kg/m³. Zero for shapes without an
    /// inside, for half-spaces, and for foreign shapes. Overlapping parts of a compound count twice.
    pub fn mass_properties(&self, density: f32) -> MassProperties {
        let unit = match self {
            Self::Ball(s) => mass_of_ball(s),
            Self::Capsule(s) => mass_of_capsule(s),
            Self::Cuboid(s) => mass_of_cuboid(s),
            Self::Hull(s) => s.unit_mass(),
            Self::Triangle(s) => mass_of_triangle(s),
            Self::Composite(s) => {
                mass_of_compound(s.solids().iter().map(|(p, s)| (p, s.mass_properties(1.0))))
            }
            Self::Curved(s) => s.unit_mass(),
            Self::Segment(_) | Self::HalfSpace(_) | Self::Foreign(_) => MassProperties::ZERO,
        };
        unit.scaled(density)
    }
}

/// The largest of the balls within the solids. The volume inside a surface is unknown; a surface counts as a
/// shape that fills its box.
fn core_of_composite(composite: &Composite<Shape>) -> (Vector, f32) {
    let bounds = composite.tree().bounds();
    let unknown = (bounds.center(), 0.5 * bounds.half().min_element());
    let cores = composite.solids().iter().map(|(pose, solid)| {
        let (center, radius) = solid.core();
        (pose.transform(center), radius)
    });
    cores.reduce(|best, next| if next.1 > best.1 { next } else { best }).unwrap_or(unknown)
}

/// The box around a composite shape turned by `rotation` about its frame's origin.
fn composite_box(composite: &Composite<Shape>, rotation: crate::math::Rot) -> Aabb {
    /// The boxes of up to this number of parts are joined. With more parts the box of all parts is turned,
    /// which is faster but larger.
    const FEW: usize = 32;
    let bounds = composite.tree().bounds();
    if rotation == crate::math::Rot::IDENTITY {
        return bounds;
    }
    let turned = bounds.rotated(rotation);
    if composite.len() > FEW {
        return turned;
    }
    let around = Pose::new(Vector::ZERO, rotation);
    let parts = (0..composite.len() as u32).fold(Aabb::EMPTY, |all, part| {
        let part = match composite.part(part) {
            Part::Facet(facet) => Shape::from(facet).local_box(&around),
            Part::Solid(pose, solid) => solid.local_box(&around.then(pose)),
        };
        all.union(&part)
    });
    parts.intersection(&turned)
}

/// The first hit of a ray on any part; of equally near parts, on the first part.
fn cast_ray_composite(
    composite: &Composite<Shape>,
    origin: Vector,
    direction: Vector,
    max_distance: f32,
    solid: bool,
) -> Option<RayHit> {
    let ray = FacetRay::new(origin, direction);
    let mut best: Option<(RayHit, u32)> = None;
    composite.tree().cast_ray(origin, direction, max_distance, |part, limit| {
        let hit = match composite.part(part) {
            Part::Facet(facet) => ray.hit(&facet, limit),
            Part::Solid(pose, shape) => {
                let (from, along) = (pose.inverse_transform(origin), pose.rotation.inverse_rotate(direction));
                let hit = shape.cast_ray(from, along, limit, solid);
                hit.map(|hit| RayHit { normal: pose.rotation.rotate(hit.normal), ..hit })
            }
        };
        let Some(hit) = hit else { return limit };
        if best.is_none_or(|(b, of)| hit.distance < b.distance || hit.distance == b.distance && part < of) {
            best = Some((hit, part));
        }
        crate::math::min(limit, hit.distance)
    });
    best.map(|(hit, _)| hit)
}
