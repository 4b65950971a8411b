//! Queries of two [`Collider`]s at given poses: contacts, nearest points, distance, overlap, time of impact.
//!
//! These queries ignore bodies, layers and margins. [`SpatialQuery`](crate::spatial_query::SpatialQuery)
//! searches the world. The kernel answers for shapes that it supports, parry for the others.
//!
//! ```
//! # use avian::{collision::collider::contact_query, math::*, prelude::*};
//! let capsule = Collider::capsule(0.5, 1.0);
//! let (left, right) = (Vector::ZERO, Vector::X * 3.0);
//! let gap = contact_query::distance(&capsule, left, Rotation::default(), &capsule, right, Rotation::default());
//! assert!((gap.unwrap() - 2.0).abs() < 1.0e-5);
//! ```

use super::{Collider, dim, foreign_manifolds};
use crate::collision::contact_types::{ContactManifold, ContactPoint, PackedFeatureId, SingleContact};
use crate::dynamics::rigid_body::LinearVelocity;
use crate::math::{
    AdjustPrecision, Scalar, Vector, to_f32, vector_from_kernel, vector_to_kernel, world_from_kernel,
};
use crate::parry::query::{self, ShapeCastOptions, Unsupported, details::ShapeCastStatus};
use crate::physics_transform::{Position, Rotation, world_pose};
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use kernel::manifold::{
    CompositeBuffers, FeatureCache, LocalManifold, ManifoldQuery, collide, collide_composite,
};
use kernel::math::{self as k, WorldPose};
use kernel::query::{CastConfig, Closest, cast_shape, closest, overlaps};
use kernel::shape::Shape;

/// A pair of shapes for which parry does not support a query. The kernel supports all queries of its shapes.
pub type UnsupportedShape = Unsupported;

/// How a [`time_of_impact`] was found.
pub type TimeOfImpactStatus = ShapeCastStatus;

/// The nearest points of two colliders.
#[derive(Reflect, Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, PartialEq)]
pub enum ClosestPoints {
    /// The colliders overlap.
    Intersecting,
    /// The nearest points of the first and the second collider, in the world.
    WithinMargin(Vector, Vector),
    /// The colliders are farther apart than the given distance.
    OutsideMargin,
}

/// The place and time at which two moving colliders meet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TimeOfImpact {
    /// The time at which they meet, in seconds.
    pub time_of_impact: Scalar,
    /// The point on the first collider, in its frame.
    pub point1: Vector,
    /// The point on the second collider, in its frame.
    pub point2: Vector,
    /// The outward unit normal of the first collider, in its frame.
    pub normal1: Vector,
    /// The outward unit normal of the second collider, in its frame.
    pub normal2: Vector,
    /// How the time of impact was found.
    pub status: TimeOfImpactStatus,
}

/// Two colliders in the world.
struct Pair<'a> {
    colliders: [&'a Collider; 2],
    poses: [(Position, Rotation); 2],
    world: [WorldPose; 2],
    /// The second collider in the frame of the first.
    relative: k::Pose,
}

impl<'a> Pair<'a> {
    /// `None` if a pose is not finite.
    fn new(
        (collider1, position1, rotation1): (&'a Collider, impl Into<Position>, impl Into<Rotation>),
        (collider2, position2, rotation2): (&'a Collider, impl Into<Position>, impl Into<Rotation>),
    ) -> Option<Self> {
        let poses = [(position1.into(), rotation1.into()), (position2.into(), rotation2.into())];
        let is_finite =
            |(position, rotation): &(Position, Rotation)| dim::pose(position.0, *rotation).is_finite();
        let world = poses.map(|(position, rotation)| world_pose(&position, &rotation));
        let relative = world[0].relative(&world[1]);
        poses.iter().all(is_finite).then_some(Self {
            colliders: [collider1, collider2],
            poses,
            world,
            relative,
        })
    }

    /// Both shapes, if the kernel supports them.
    fn native(&self) -> Option<[&'a Shape; 2]> {
        let shapes = self.colliders.map(Collider::native);
        let is_foreign = |shape: &&Shape| matches!(shape, Shape::Foreign(_));
        (!shapes.iter().any(is_foreign)).then_some(shapes)
    }

    /// The poses and shapes in parry's types.
    fn parry(&self) -> [(crate::parry::math::Pose, &'a dyn crate::parry::shape::Shape); 2] {
        [0, 1].map(|i| {
            let (position, rotation) = self.poses[i];
            (dim::pose(position.0, rotation), &**self.colliders[i].shape_scaled())
        })
    }

    /// Transforms a point of the first collider's frame to the world.
    fn to_world(&self, point: k::Vector) -> Vector {
        world_from_kernel(self.world[0].transform(point))
    }

    /// The nearest points up to a distance, by the kernel.
    fn closest(&self, [a, b]: [&Shape; 2], max_distance: Scalar) -> Option<Closest> {
        let limit = to_f32(max_distance);
        closest(a, b, &self.relative, if limit < f32::MAX { limit } else { f32::MAX })
    }
}

/// A distance that parry accepts: 0 for a negative distance and NaN.
fn usable_distance(distance: Scalar) -> Scalar {
    if distance > 0.0 { distance.min(LONGEST) } else { 0.0 }
}

/// The longest distance passed to parry, in metres: the square of a longer one overflows.
const LONGEST: Scalar = 1.0e15;

/// The deepest point of contact, or the nearest points if the colliders are no farther apart than
/// `prediction_distance` metres.
///
/// `None` if they are farther apart, or if a number is not finite.
///
/// # Errors
///
/// If neither the kernel nor parry supports the shapes.
pub fn contact(
    collider1: &Collider,
    position1: impl Into<Position>,
    rotation1: impl Into<Rotation>,
    collider2: &Collider,
    position2: impl Into<Position>,
    rotation2: impl Into<Rotation>,
    prediction_distance: Scalar,
) -> Result<Option<SingleContact>, UnsupportedShape> {
    let pair = Pair::new((collider1, position1, rotation1), (collider2, position2, rotation2));
    let Some(pair) = pair else { return Ok(None) };
    if let Some(shapes) = pair.native() {
        return Ok(pair.closest(shapes, prediction_distance).map(|found| {
            let [point1, point2] = found.points;
            let back = |v: k::Vector| pair.relative.rotation.inverse_rotate(v);
            SingleContact::new(
                vector_from_kernel(point1),
                vector_from_kernel(pair.relative.inverse_transform(point2)),
                vector_from_kernel(found.normal),
                vector_from_kernel(back(-found.normal)),
                -found.distance.adjust_precision(),
            )
        }));
    }
    let [(pose1, shape1), (pose2, shape2)] = pair.parry();
    let found = query::contact(&pose1, shape1, &pose2, shape2, usable_distance(prediction_distance))?;
    Ok(found.map(|found| {
        SingleContact::new(
            pose1.inverse_transform_point(found.point1),
            pose2.inverse_transform_point(found.point2),
            pose1.rotation.inverse() * found.normal1,
            pose2.rotation.inverse() * found.normal2,
            -found.dist,
        )
    }))
}

/// Replaces `manifolds` by the contact manifolds of two colliders, with points up to `prediction_distance`
/// metres apart.
///
/// Anchors are relative to the given positions, in world axes. There are no manifolds if a number is not
/// finite.
#[expect(clippy::too_many_arguments, reason = "as in Avian")]
pub fn contact_manifolds(
    collider1: &Collider,
    position1: impl Into<Position>,
    rotation1: impl Into<Rotation>,
    collider2: &Collider,
    position2: impl Into<Position>,
    rotation2: impl Into<Rotation>,
    prediction_distance: Scalar,
    manifolds: &mut Vec<ContactManifold>,
) {
    manifolds.clear();
    let pair = Pair::new((collider1, position1, rotation1), (collider2, position2, rotation2));
    let Some(pair) = pair.filter(|_| prediction_distance >= 0.0) else { return };
    let prediction = to_f32(usable_distance(prediction_distance));
    let mut found = Vec::new();
    match pair.native() {
        Some([a, b]) if matches!(a, Shape::Composite(_)) || matches!(b, Shape::Composite(_)) => {
            let query = ManifoldQuery::up_to(prediction);
            collide_composite(a, b, &pair.relative, query, &mut CompositeBuffers::default(), &mut found);
        }
        Some([a, b]) => {
            let mut local = LocalManifold::default();
            collide(a, b, &pair.relative, prediction, &mut FeatureCache::NONE.clone(), &mut local);
            found.push(local);
        }
        None => {
            foreign_manifolds(collider1, collider2, &pair.relative, prediction, &mut found);
        }
    }
    let [from1, from2] = pair.poses.map(|(position, _)| position.0);
    for local in found.iter().filter(|local| local.count > 0) {
        let points = local.points().iter().map(|p| {
            let point = pair.to_world(p.point);
            ContactPoint::new(point - from1, point - from2, point, -p.separation.adjust_precision())
                .with_feature_ids(PackedFeatureId(p.feature), PackedFeatureId::UNKNOWN)
        });
        let normal = vector_from_kernel(pair.world[0].rotation.rotate(local.normal));
        manifolds.push(ContactManifold::new(points, normal));
    }
}

/// The nearest points of two colliders that are no farther apart than `max_distance` metres. If a number is
/// not finite, the colliders count as farther apart.
///
/// # Errors
///
/// If neither the kernel nor parry supports the shapes.
pub fn closest_points(
    collider1: &Collider,
    position1: impl Into<Position>,
    rotation1: impl Into<Rotation>,
    collider2: &Collider,
    position2: impl Into<Position>,
    rotation2: impl Into<Rotation>,
    max_distance: Scalar,
) -> Result<ClosestPoints, UnsupportedShape> {
    let pair = Pair::new((collider1, position1, rotation1), (collider2, position2, rotation2));
    let Some(pair) = pair else { return Ok(ClosestPoints::OutsideMargin) };
    if let Some(shapes) = pair.native() {
        return Ok(match pair.closest(shapes, max_distance.max(0.0)) {
            Some(found) if found.distance <= 0.0 => ClosestPoints::Intersecting,
            Some(found) if found.distance.adjust_precision() <= max_distance => {
                let [point1, point2] = found.points.map(|point| pair.to_world(point));
                ClosestPoints::WithinMargin(point1, point2)
            }
            _ => ClosestPoints::OutsideMargin,
        });
    }
    let [(pose1, shape1), (pose2, shape2)] = pair.parry();
    Ok(match query::closest_points(&pose1, shape1, &pose2, shape2, usable_distance(max_distance))? {
        query::ClosestPoints::Intersecting => ClosestPoints::Intersecting,
        query::ClosestPoints::WithinMargin(point1, point2) => ClosestPoints::WithinMargin(point1, point2),
        query::ClosestPoints::Disjoint => ClosestPoints::OutsideMargin,
    })
}

/// The distance between two colliders in metres: 0 if they touch or overlap, infinite if a number is not
/// finite.
///
/// # Errors
///
/// If neither the kernel nor parry supports the shapes.
pub fn distance(
    collider1: &Collider,
    position1: impl Into<Position>,
    rotation1: impl Into<Rotation>,
    collider2: &Collider,
    position2: impl Into<Position>,
    rotation2: impl Into<Rotation>,
) -> Result<Scalar, UnsupportedShape> {
    let pair = Pair::new((collider1, position1, rotation1), (collider2, position2, rotation2));
    let Some(pair) = pair else { return Ok(Scalar::INFINITY) };
    if let Some(shapes) = pair.native() {
        let found = pair.closest(shapes, Scalar::INFINITY);
        return Ok(found.map_or(Scalar::INFINITY, |found| found.distance.max(0.0).adjust_precision()));
    }
    let [(pose1, shape1), (pose2, shape2)] = pair.parry();
    query::distance(&pose1, shape1, &pose2, shape2)
}

/// Whether two colliders touch or overlap. False if a number is not finite.
///
/// # Errors
///
/// If neither the kernel nor parry supports the shapes.
pub fn intersection_test(
    collider1: &Collider,
    position1: impl Into<Position>,
    rotation1: impl Into<Rotation>,
    collider2: &Collider,
    position2: impl Into<Position>,
    rotation2: impl Into<Rotation>,
) -> Result<bool, UnsupportedShape> {
    let pair = Pair::new((collider1, position1, rotation1), (collider2, position2, rotation2));
    let Some(pair) = pair else { return Ok(false) };
    if let Some([a, b]) = pair.native() {
        return Ok(overlaps(a, b, &pair.relative));
    }
    let [(pose1, shape1), (pose2, shape2)] = pair.parry();
    query::intersection_test(&pose1, shape1, &pose2, shape2)
}

/// The first time at which two colliders touch, up to `max_time_of_impact` seconds. They move at constant
/// velocities, in m/s, and do not rotate.
///
/// `None` if they do not touch within that time, or if a number is not finite.
///
/// # Errors
///
/// If neither the kernel nor parry supports the shapes.
#[expect(clippy::too_many_arguments, reason = "as in Avian")]
pub fn time_of_impact(
    collider1: &Collider,
    position1: impl Into<Position>,
    rotation1: impl Into<Rotation>,
    velocity1: impl Into<LinearVelocity>,
    collider2: &Collider,
    position2: impl Into<Position>,
    rotation2: impl Into<Rotation>,
    velocity2: impl Into<LinearVelocity>,
    max_time_of_impact: Scalar,
) -> Result<Option<TimeOfImpact>, UnsupportedShape> {
    let pair = Pair::new((collider1, position1, rotation1), (collider2, position2, rotation2));
    let (velocity1, velocity2) = (velocity1.into().0, velocity2.into().0);
    let motion = velocity2 - velocity1;
    let is_usable = motion.is_finite() && max_time_of_impact >= 0.0;
    let Some(pair) = pair.filter(|_| is_usable) else { return Ok(None) };
    if let Some(shapes) = pair.native() {
        return Ok(native_impact(&pair, shapes, motion, max_time_of_impact));
    }
    let [(pose1, shape1), (pose2, shape2)] = pair.parry();
    let max_time_of_impact = usable_distance(max_time_of_impact);
    let options = ShapeCastOptions { max_time_of_impact, ..ShapeCastOptions::default() };
    let found = query::cast_shapes(&pose1, velocity1, shape1, &pose2, velocity2, shape2, options)?;
    Ok(found.map(|found| TimeOfImpact {
        time_of_impact: found.time_of_impact,
        point1: found.witness1,
        point2: found.witness2,
        normal1: found.normal1,
        normal2: found.normal2,
        status: found.status,
    }))
}

/// Casts the second shape along the relative motion, in the frame of the first.
fn native_impact(
    pair: &Pair,
    [a, b]: [&Shape; 2],
    motion: Vector,
    max_time_of_impact: Scalar,
) -> Option<TimeOfImpact> {
    let speed = motion.length();
    let moves = speed > 0.0;
    let direction = if moves { vector_to_kernel(motion / speed) } else { k::Vector::ZERO };
    let direction = pair.world[0].rotation.inverse_rotate(direction);
    let (hit, overlap) = if moves {
        let way = to_f32(speed * max_time_of_impact);
        let hit = cast_shape(a, b, &pair.relative, direction, way, &CastConfig::default())?;
        (hit.distance, hit.distance <= 0.0)
    } else {
        overlaps(a, b, &pair.relative).then_some((0.0, true))?
    };
    let mut then = pair.relative;
    then.position += direction * hit;
    let touch = closest(a, b, &then, f32::MAX)?;
    let back = then.rotation.inverse_rotate(-touch.normal);
    Some(TimeOfImpact {
        time_of_impact: if moves { hit.adjust_precision() / speed } else { 0.0 },
        point1: vector_from_kernel(touch.points[0]),
        point2: vector_from_kernel(then.inverse_transform(touch.points[1])),
        normal1: vector_from_kernel(touch.normal),
        normal2: vector_from_kernel(back),
        status: if overlap {
            TimeOfImpactStatus::PenetratingOrWithinTargetDist
        } else {
            TimeOfImpactStatus::Converged
        },
    })
}
