//! Shapes that move along a line in the world.

use super::cast::{CastConfig, cast_shape};
use super::hits::Hit;
use super::near::Line;
use super::ray::approach;
use crate::bvh::Trees;
use crate::math::{Pose, Rot, Scalar, Vector, WorldPose, WorldVector, max, wide_position, world_position};
use crate::shape::Shape;

/// A shape that moves along a line in the world, without turning.
#[derive(Clone, Copy, Debug)]
pub struct ShapeCast<'a> {
    shape: &'a Shape,
    rotation: Rot,
    /// The line that the position of the shape's frame moves along.
    line: Line,
    /// The centre of the shape's box relative to its frame's position, and half its size, in world axes.
    center: Vector,
    half: Vector,
    max_distance: Scalar,
    config: CastConfig,
}

/// The hit of a shape that was cast on a collider.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeCastHit {
    /// The collider.
    pub collider: u32,
    /// The distance moved until the hit, in metres.
    pub distance: Scalar,
    /// The nearest points at the hit, on the collider and on the shape, in the world.
    pub points: [WorldVector; 2],
    /// The outward unit normal of the collider.
    pub normal: Vector,
}

impl Hit for ShapeCastHit {
    fn distance(&self) -> Scalar {
        self.distance
    }

    fn collider(&self) -> u32 {
        self.collider
    }
}

impl<'a> ShapeCast<'a> {
    /// A shape that moves from a pose along `direction`, of any length, for `max_distance` metres, which may
    /// be infinite.
    ///
    /// `None` if a number is not finite, the direction is zero, or the distance negative or NaN: such a cast
    /// hits nothing.
    pub fn new(
        shape: &'a Shape,
        pose: &WorldPose,
        direction: WorldVector,
        max_distance: Scalar,
        config: &CastConfig,
    ) -> Option<Self> {
        let line = Line::new(pose.position, direction)?;
        let max_distance = if max_distance > Scalar::MAX { Scalar::MAX } else { max_distance };
        let aabb = shape.local_aabb(pose.rotation);
        let valid = pose.rotation.is_finite() && config.target_distance.is_finite() && max_distance >= 0.0;
        (valid && aabb.is_valid()).then(|| Self {
            shape,
            rotation: pose.rotation,
            line,
            center: aabb.center(),
            half: aabb.half(),
            max_distance,
            config: *config,
        })
    }

    /// The length of the cast in metres.
    pub fn max_distance(&self) -> Scalar {
        self.max_distance
    }

    /// Calls `visit` with the colliders whose boxes the shape's box comes close to, nearer branches first,
    /// and the current limit. `visit` returns the new limit: the distance of a hit to find only nearer hits,
    /// negative to stop.
    pub fn visit(&self, trees: &Trees, visit: impl FnMut(u32, Scalar) -> Scalar) {
        let room = max(self.config.target_distance, 0.0);
        let center = Line { origin: self.line.origin + self.center.widen(), ..self.line };
        let half = self.half * (1.0 + 4.0 * f32::EPSILON) + self.center.abs() * f32::EPSILON;
        center.visit(trees, half + Vector::ONE * room, self.max_distance, visit);
    }

    /// The first hit on a collider's shape at a pose, within `limit` metres. Foreign shapes are never hit.
    pub fn hit(&self, collider: u32, shape: &Shape, pose: &WorldPose, limit: Scalar) -> Option<ShapeCastHit> {
        let offset = self.line.origin - wide_position(pose.position);
        let along = self.line.direction;
        let room = 1.001 * f64::from(self.half.length() + max(self.config.target_distance, 0.0));
        let before = approach(shape, pose.rotation, offset + self.center.widen(), along, room)?;
        let rotation: Rot<f64> = pose.rotation.widen();
        let direction = rotation.inverse_rotate(along);
        let turn = pose.rotation.inverse().mul(self.rotation);
        let start = Pose::new(rotation.inverse_rotate(offset + along * before).narrow(), turn);
        let rest = f64::from(limit) - before;
        if !(rest >= 0.0) || !start.position.is_finite() {
            return None;
        }
        let reach = (rest as f32).next_up();
        let reach = if reach < f32::MAX { reach } else { f32::MAX };
        let hit = cast_shape(shape, self.shape, &start, direction.narrow(), reach, &self.config)?;
        let distance = (before + f64::from(hit.distance)) as Scalar;
        let to_world =
            |point: Vector| world_position(wide_position(pose.position) + rotation.rotate(point.widen()));
        (distance <= limit && distance.is_finite()).then(|| ShapeCastHit {
            collider,
            distance,
            points: hit.points.map(to_world),
            normal: pose.rotation.rotate(hit.normal),
        })
    }
}
