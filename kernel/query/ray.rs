//! Rays in the world.

use super::hits::Hit;
use super::near::Line;
use crate::bvh::Trees;
use crate::math::{Rot, Scalar, Vector, WorldPose, WorldVector, wide_position};
use crate::shape::Shape;

/// Rays that begin farther than this from a shape, in metres, are cast from a nearer point, since `f32` is
/// too coarse there.
const FAR: f64 = 8.0;

/// Added to balls around shapes, in metres: the lateral error by rounding to `f32` of rays that are not cast
/// from a nearer point.
const LEAST_ROOM: f64 = 1.0e-5;

/// A ray in the world.
#[derive(Clone, Copy, Debug)]
pub struct Ray {
    line: Line,
    max_distance: Scalar,
    solid: bool,
}

/// The hit of a ray on a collider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayCastHit {
    /// The collider.
    pub collider: u32,
    /// The distance along the ray, in metres.
    pub distance: Scalar,
    /// The outward unit normal; zero if the ray begins inside a solid.
    pub normal: Vector,
}

impl Hit for RayCastHit {
    fn distance(&self) -> Scalar {
        self.distance
    }

    fn collider(&self) -> u32 {
        self.collider
    }
}

impl Ray {
    /// The ray from `origin` along `direction`, of any length, up to `max_distance` metres, which may be
    /// infinite.
    ///
    /// A ray that begins inside a shape hits it at distance 0 if `solid`, otherwise it hits the boundary from
    /// within.
    ///
    /// `None` if origin or direction is not finite, the direction is zero, or the distance negative or NaN:
    /// such a ray hits nothing.
    pub fn new(
        origin: WorldVector,
        direction: WorldVector,
        max_distance: Scalar,
        solid: bool,
    ) -> Option<Self> {
        let line = Line::new(origin, direction)?;
        let max_distance = if max_distance > Scalar::MAX { Scalar::MAX } else { max_distance };
        (max_distance >= 0.0).then_some(Self { line, max_distance, solid })
    }

    /// The length of the ray in metres.
    pub fn max_distance(&self) -> Scalar {
        self.max_distance
    }

    /// Calls `visit` with the colliders whose boxes the ray meets, nearer branches first, and the current
    /// limit. `visit` returns the new limit: the distance of a hit to find only nearer hits, negative to
    /// stop.
    pub fn visit(&self, trees: &Trees, visit: impl FnMut(u32, Scalar) -> Scalar) {
        self.line.visit(trees, Vector::ZERO, self.max_distance, visit);
    }

    /// The first hit of a collider's shape at a pose, within `limit` metres. Foreign shapes are never hit.
    pub fn hit(&self, collider: u32, shape: &Shape, pose: &WorldPose, limit: Scalar) -> Option<RayCastHit> {
        let offset = self.line.origin - wide_position(pose.position);
        let approach = approach(shape, pose.rotation, offset, self.line.direction, 0.0)?;
        let before = if offset.length_squared() > FAR * FAR { approach } else { 0.0 };
        let rotation: Rot<f64> = pose.rotation.widen();
        let origin = rotation.inverse_rotate(offset + self.line.direction * before);
        let direction = rotation.inverse_rotate(self.line.direction);
        let from = origin.narrow();
        let rest = f64::from(limit) - before;
        if !(rest >= 0.0) || !from.is_finite() {
            return None;
        }
        // The end of the ray is decided in full precision.
        let reach = (rest as f32).next_up();
        let hit = shape.cast_ray(
            from,
            direction.narrow(),
            if reach < f32::MAX { reach } else { f32::MAX },
            self.solid,
        )?;
        let distance = (before + f64::from(hit.distance)) as Scalar;
        let normal = pose.rotation.rotate(hit.normal);
        (distance <= limit && distance.is_finite() && normal.is_finite()).then_some(RayCastHit {
            collider,
            distance,
            normal,
        })
    }
}

/// The distance along a line until it is within `room` metres of the ball around a shape, or less, in metres.
/// `None` if the line passes the ball. `offset` is from the shape's position to the origin of the line, in
/// world axes.
pub(super) fn approach(
    shape: &Shape,
    rotation: Rot,
    offset: Vector<f64>,
    direction: Vector<f64>,
    room: f64,
) -> Option<f64> {
    let (center, radius) = shape.ball_around();
    let to_center = rotation.rotate(center).widen() - offset;
    let radius =
        1.001 * f64::from(radius) + 1.0e-6 * f64::from(center.abs().max_element()) + LEAST_ROOM + room;
    let nearest = to_center.dot(direction);
    let aside = to_center - direction * nearest;
    if aside.length_squared() > radius * radius || nearest + radius < 0.0 {
        return None;
    }
    let way = nearest - radius;
    Some(if way > 0.0 && radius < 1.0e9 { way } else { 0.0 })
}
