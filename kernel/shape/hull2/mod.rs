//! The convex polygon, sharp or rounded, with any number of vertices.

mod mass;
pub(super) mod outline;
#[cfg(test)]
mod tests;
pub(super) mod wide;

use super::MassProperties;
use crate::math::{Rot, Vector, max, min};
use crate::shape::primitives::{Stretch, checked_length, direction_or, hit_of_stretch};
use crate::shape::{Aabb, Capsule, RayHit, ShapeError};
use mass::mass_of_rounded_polygon;
use outline::{
    cast_ray_polygon, edges, least_depth, merge_distance, monotone_chain, simplified, turns_left_once,
};
use smallvec::SmallVec;
use wide::{cross, length, sub, wide};

/// A convex polygon, sharp or rounded: all points within [`radius`](Self::radius) of its core.
///
/// The vertices go round counter-clockwise, without duplicates and without vertices on the line of their
/// neighbours. Edge `i` leads from vertex `i` to the next vertex and has normal `i`.
#[derive(Clone, Debug, PartialEq)]
pub struct Hull {
    /// The vertices, then the normals. Up to eight of each are inline.
    points: SmallVec<[Vector; 16]>,
    radius: f32,
    aabb: Aabb,
    mass: MassProperties,
}

impl Hull {
    /// The polygon with the given outline, rounded by `radius` metres (0 leaves it sharp).
    ///
    /// The outline may have either orientation. Duplicate points, and points on the line of their neighbours,
    /// within 1e-6 of the size, are dropped.
    ///
    /// # Errors
    /// `NotFinite` for a number that is not finite, `Negative` for a negative radius, `Degenerate` if less
    /// than a triangle remains, `NotConvex` if the outline turns both ways or winds more than once.
    pub fn from_convex(vertices: &[Vector], radius: f32) -> Result<Self, ShapeError> {
        let radius = check(vertices, radius)?;
        let mut outline = vertices.to_vec();
        let origin = outline.first().copied().map(wide).ok_or(ShapeError::Degenerate)?;
        let area: f64 = edges(&outline).map(|(p, q)| cross(sub(wide(p), origin), sub(wide(q), origin))).sum();
        if area < 0.0 {
            outline.reverse();
        }
        let outline = simplified(outline, merge_distance(vertices))?;
        if turns_left_once(&outline) { Ok(Self::build(outline, radius)) } else { Err(ShapeError::NotConvex) }
    }

    /// The convex hull of any points, rounded by `radius` metres (0 leaves it sharp).
    ///
    /// # Errors
    /// `NotFinite` for a number that is not finite, `Negative` for a negative radius, `Degenerate` if all
    /// points lie on one line within 1e-6 of their extent.
    pub fn convex_hull_of(points: &[Vector], radius: f32) -> Result<Self, ShapeError> {
        let radius = check(points, radius)?;
        let tolerance = merge_distance(points);
        let outline = simplified(monotone_chain(points), tolerance)?;
        if turns_left_once(&outline) { Ok(Self::build(outline, radius)) } else { Err(ShapeError::Degenerate) }
    }

    /// The convex hull of points, if it has an area.
    pub fn around(points: &[Vector]) -> Option<Self> {
        Self::convex_hull_of(points, 0.0).ok()
    }

    /// The lines along the edges: normals and distances from the origin.
    pub fn planes(&self) -> impl Iterator<Item = (Vector, f32)> + '_ {
        self.normals().iter().zip(self.vertices()).map(|(normal, vertex)| (*normal, normal.dot(*vertex)))
    }

    fn build(vertices: Vec<Vector>, radius: f32) -> Self {
        let normals = edges(&vertices).map(|(p, q)| {
            let e = sub(wide(q), wide(p));
            let l = length(e);
            Vector::from_array([(e[1] / l) as f32, (-e[0] / l) as f32])
        });
        let points = vertices.iter().copied().chain(normals).collect();
        let aabb = Aabb::around(vertices.iter().copied()).grown(radius);
        let mass = mass_of_rounded_polygon(&vertices, f64::from(radius));
        Self { points, radius, aabb, mass }
    }

    /// The corners of the core, counter-clockwise; at least three.
    #[inline]
    pub fn vertices(&self) -> &[Vector] {
        &self.points[..self.points.len() / 2]
    }

    /// The outward unit normals: `normals()[i]` is the normal of the edge from vertex `i` to the next.
    #[inline]
    pub fn normals(&self) -> &[Vector] {
        &self.points[self.points.len() / 2..]
    }

    /// The radius around the core, in metres; 0 for a sharp polygon.
    #[inline]
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The box around the polygon turned by `rotation`, radius included.
    pub fn local_aabb(&self, rotation: Rot) -> Aabb {
        Aabb::around(self.vertices().iter().map(|v| rotation.rotate(*v))).grown(self.radius)
    }

    /// The box around the polygon in its own frame, radius included.
    #[inline]
    pub fn bounds(&self) -> Aabb {
        self.aabb
    }

    /// The largest ball around the centroid within the polygon: its centre and radius.
    pub fn core(&self) -> (Vector, f32) {
        let center = self.mass.center;
        (center, least_depth(center, self.vertices(), self.normals()) + self.radius)
    }

    /// Whether a point is in the core, at least `depth` of the edge's normal below each edge.
    pub fn contains(&self, point: Vector, depth: impl Fn(Vector) -> f32) -> bool {
        let mut edges = self.normals().iter().zip(self.vertices());
        edges.all(|(normal, vertex)| (point - *vertex).dot(*normal) <= -depth(*normal))
    }

    /// The point farthest along `direction` (any length), radius included.
    pub fn support(&self, direction: Vector) -> Vector {
        let vertices = self.vertices();
        let mut best = (vertices[0], vertices[0].dot(direction));
        for v in &vertices[1..] {
            let height = v.dot(direction);
            if height > best.1 {
                best = (*v, height);
            }
        }
        if self.radius > 0.0 { best.0 + direction_or(direction, Vector::X) * self.radius } else { best.0 }
    }

    /// The hit of a ray along the unit vector `direction`; see `Shape::cast_ray`.
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        if self.radius == 0.0 {
            return cast_ray_polygon(self.vertices(), self.normals(), origin, direction, max_distance, solid);
        }
        // The boundary of a rounded polygon is the boundary of the capsules around its edges.
        let mut whole: Option<Stretch> = None;
        let (mut first, mut last) = (None, None);
        for (a, b) in edges(self.vertices()) {
            let capsule = Capsule { a, b, radius: self.radius };
            let Some((enter, exit)) = capsule.stretch(origin, direction) else { continue };
            let (low, high) = whole.unwrap_or((f32::INFINITY, f32::NEG_INFINITY));
            if enter < low {
                first = Some(capsule);
            }
            if exit > high {
                last = Some(capsule);
            }
            whole = Some((min(enter, low), max(exit, high)));
        }
        hit_of_stretch(whole?, max_distance, solid, |entering, t| {
            let outward = if entering { -direction } else { direction };
            let capsule = if entering { first } else { last };
            capsule.map_or(outward, |c| c.normal_at(origin + direction * t, outward))
        })
    }

    /// A circle around the shape: its centre and its radius in metres.
    pub(crate) fn ball_around(&self) -> (Vector, f32) {
        (self.aabb.center(), self.aabb.half().length())
    }

    /// The area, the centroid, and the polar moment of the area about the centroid.
    #[inline]
    pub fn unit_mass(&self) -> MassProperties {
        self.mass
    }
}

/// The radius, if all numbers are valid.
fn check(points: &[Vector], radius: f32) -> Result<f32, ShapeError> {
    if points.iter().all(|p| p.is_finite()) { checked_length(radius) } else { Err(ShapeError::NotFinite) }
}
