//! [`ContactPoint`]: one point of a manifold.

use super::feature_id::PackedFeatureId;
use crate::math::{Scalar, TangentVector, Vector};

/// One point of a [`ContactManifold`](super::ContactManifold).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactPoint {
    /// From the first body's centre of mass to the point, in world axes, in metres.
    pub anchor1: Vector,
    /// From the second body's centre of mass to the point, in world axes, in metres.
    pub anchor2: Vector,
    /// The point in the world, midway between both surfaces. Until the next step it moves with
    /// the first body.
    pub point: Vector,
    /// How deep the surfaces overlap, in metres; negative if they are apart.
    pub penetration: Scalar,
    /// The impulse along the normal over the whole step, N·s. The impulse under a resting body is its weight
    /// times the length of the step.
    ///
    /// Impulses are summed over the substeps while a collider has
    /// [`CollisionEventsEnabled`](crate::prelude::CollisionEventsEnabled),
    /// [`CollidingEntities`](crate::prelude::CollidingEntities) or hooks that change contacts, and from the
    /// step after a system first asked [`Collisions`](crate::prelude::Collisions). Without sums this is the
    /// impulse of the last substep times the number of substeps.
    pub normal_impulse: Scalar,
    /// The separation speed of the surfaces along the normal, m/s; negative if they approach. Before the
    /// solver it is the impact speed, after the solver the remaining speed.
    pub normal_speed: Scalar,
    /// The normal impulse that the next step starts from, N·s.
    pub warm_start_normal_impulse: Scalar,
    /// The share of this point in the friction impulse that the next step starts from, along the tangent (2D)
    /// or both tangents (3D), N·s.
    pub warm_start_tangent_impulse: TangentVector,
    /// The feature of the first shape.
    pub feature_id1: PackedFeatureId,
    /// The feature of the second shape.
    pub feature_id2: PackedFeatureId,
}

impl ContactPoint {
    /// A point without impulses and features.
    pub fn new(anchor1: Vector, anchor2: Vector, world_point: Vector, penetration: Scalar) -> Self {
        Self {
            anchor1,
            anchor2,
            point: world_point,
            penetration,
            normal_impulse: 0.0,
            normal_speed: 0.0,
            warm_start_normal_impulse: 0.0,
            warm_start_tangent_impulse: Default::default(),
            feature_id1: PackedFeatureId::UNKNOWN,
            feature_id2: PackedFeatureId::UNKNOWN,
        }
    }

    /// Sets both features.
    pub fn with_feature_ids(mut self, id1: PackedFeatureId, id2: PackedFeatureId) -> Self {
        self.feature_id1 = id1;
        self.feature_id2 = id2;
        self
    }

    /// Swaps the two sides.
    pub fn flip(&mut self) {
        core::mem::swap(&mut self.anchor1, &mut self.anchor2);
        core::mem::swap(&mut self.feature_id1, &mut self.feature_id2);
    }

    /// The point with swapped sides.
    pub fn flipped(&self) -> Self {
        let mut flipped = *self;
        flipped.flip();
        flipped
    }
}
