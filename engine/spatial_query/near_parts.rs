//! The convex parts of all colliders near a shape, each with its nearest points.

use bevy_ecs::prelude::*;
use kernel::query::visit_closest;

use super::{
    SpatialQuery, SpatialQueryFilter, searches::is_foreign, system_param::pose_of, traversal::Candidate,
};
use crate::{
    collision::collider::{Collider, contact_query},
    math::{AdjustPrecision, RotationValue, Scalar, Vector, to_f32, vector_from_kernel, world_from_kernel},
    physics_transform::world_pose,
};

/// The nearest points of a shape and a convex part of a collider.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearPart {
    /// The collider.
    pub(crate) entity: Entity,
    /// The nearest points in the world: on the collider, and on the shape.
    pub(crate) points: [Vector; 2],
    /// The unit normal from the collider to the shape.
    pub(crate) normal: Vector,
    /// The distance in metres, negative where they overlap.
    pub(crate) distance: Scalar,
}

impl SpatialQuery<'_, '_> {
    /// All convex parts within `reach` metres of a shape, of the colliders for which the predicate is true.
    /// They are in the order in which colliders entered the simulation. There are none if the pose is not
    /// finite.
    pub(crate) fn near_parts(
        &self,
        shape: &Collider,
        (position, rotation): (Vector, RotationValue),
        reach: Scalar,
        filter: &SpatialQueryFilter,
        predicate: &dyn Fn(Entity) -> bool,
    ) -> Vec<NearPart> {
        let pose = pose_of(position, rotation);
        let at = world_pose(&pose.0, &pose.1);
        let limit = to_f32(reach);
        if !(at.position.is_finite_world() && at.rotation.is_finite() && limit.is_finite()) {
            return Vec::new();
        }
        let recent = self.recent();
        let search = self.search(&recent, filter);
        let native = shape.native();
        let mut found: Vec<(u32, NearPart)> = Vec::new();
        let aabb = native.aabb(&at).grown(limit.max(0.0));
        search.scene().touching(&aabb, |candidate: &Candidate| {
            if !search.passes(candidate) || !predicate(candidate.entity) {
                return false;
            }
            let Candidate { entity, order, .. } = *candidate;
            if is_foreign(candidate.shape) || is_foreign(native) {
                let part = search.component(candidate).and_then(|collider| {
                    let (own, turn) = candidate.components();
                    let contact =
                        contact_query::contact(collider, own, turn, shape, pose.0, pose.1, reach).ok()??;
                    let points =
                        [own.0 + turn * contact.local_point1, pose.0.0 + pose.1 * contact.local_point2];
                    let normal = turn * contact.local_normal1;
                    Some(NearPart { entity, points, normal, distance: -contact.penetration })
                });
                found.extend(part.map(|part| (order, part)));
                return false;
            }
            visit_closest(candidate.shape, native, &candidate.pose.relative(&at), limit, &mut |closest| {
                let points = closest.points.map(|p| world_from_kernel(candidate.pose.transform(p)));
                let normal = vector_from_kernel(candidate.pose.rotation.rotate(closest.normal));
                let distance = closest.distance.adjust_precision();
                found.push((order, NearPart { entity, points, normal, distance }));
            });
            false
        });
        found.retain(|(_, part)| part.normal != Vector::ZERO && part.distance.is_finite());
        found.sort_by_key(|(order, _)| *order);
        found.into_iter().map(|(_, part)| part).collect()
    }
}
