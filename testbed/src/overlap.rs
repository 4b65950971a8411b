//! The deepest overlap in a world, measured by parry, which shares no code with the engine's own contacts.
//! Compiled once per dimension.

use bevy_ecs::entity::Entity;

use super::avian::parry::bounding_volume::{Aabb, BoundingVolume};
use super::avian::parry::math::Pose;
use super::avian::parry::query;
use super::avian::parry::shape::SharedShape;

/// A collider to measure.
pub struct Body {
    body: Entity,
    dynamic: bool,
    shape: SharedShape,
    pose: Pose,
    bounds: Aabb,
}

impl Body {
    /// A collider of the given body, at a pose in the world.
    pub fn new(body: Entity, dynamic: bool, shape: SharedShape, pose: Pose) -> Self {
        let bounds = shape.compute_aabb(&pose);
        Self { body, dynamic, shape, pose, bounds }
    }

    fn may_overlap(&self, other: &Self) -> bool {
        (self.dynamic || other.dynamic) && self.body != other.body && self.bounds.intersects(&other.bounds)
    }
}

/// The deepest overlap of two colliders of different bodies, one of them dynamic, in metres. Zero if there is
/// none. Pairs that parry does not support are skipped.
pub fn deepest_overlap(mut parts: Vec<Body>) -> f32 {
    parts.retain(|part| part.bounds.mins.is_finite() && part.bounds.maxs.is_finite());
    parts.sort_by(|a, b| a.bounds.mins.x.total_cmp(&b.bounds.mins.x));
    let mut deepest: f32 = 0.0;
    // Boxes in the order of their left sides: those that start before a box ends are its candidates.
    for (i, part) in parts.iter().enumerate() {
        for other in parts[i + 1..].iter().take_while(|other| other.bounds.mins.x <= part.bounds.maxs.x) {
            if part.may_overlap(other)
                && let Ok(Some(contact)) =
                    query::contact(&part.pose, &*part.shape, &other.pose, &*other.shape, 0.0)
            {
                deepest = deepest.max(-contact.dist);
            }
        }
    }
    deepest
}
