//! The collider traits of [`Collider`].

use super::{Collider, contact_query, dim};
use crate::{
    collision::{
        collider::{AabbContext, AnyCollider, ColliderAabb, ContactManifoldContext, ScalableCollider},
        contact_types::ContactManifold,
    },
    math::{Scalar, Vector},
    physics_transform::Rotation,
};

impl AnyCollider for Collider {
    type Context = ();

    fn aabb_with_context(
        &self,
        position: Vector,
        rotation: impl Into<Rotation>,
        _: AabbContext<()>,
    ) -> ColliderAabb {
        let aabb = self.shape_scaled().compute_aabb(&dim::pose(position, rotation.into()));
        ColliderAabb::from_min_max(aabb.mins, aabb.maxs)
    }

    fn contact_manifolds_with_context(
        &self,
        other: &Self,
        position1: Vector,
        rotation1: impl Into<Rotation>,
        position2: Vector,
        rotation2: impl Into<Rotation>,
        prediction_distance: Scalar,
        manifolds: &mut Vec<ContactManifold>,
        _: ContactManifoldContext<()>,
    ) {
        contact_query::contact_manifolds(
            self,
            position1,
            rotation1,
            other,
            position2,
            rotation2,
            prediction_distance,
            manifolds,
        );
    }
}

impl ScalableCollider for Collider {
    fn scale(&self) -> Vector {
        self.scale()
    }

    fn set_scale(&mut self, scale: Vector, detail: u32) {
        self.set_scale(scale, detail);
    }
}
