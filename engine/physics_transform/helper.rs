//! A system parameter that updates the pose of one entity from its `Transform` immediately.

use bevy_ecs::{
    entity::EntityNotSpawnedError,
    prelude::*,
    system::{
        SystemParam,
        lifetimeless::{Read, Write},
    },
};
use bevy_transform::{
    components::{GlobalTransform, Transform},
    helper::{ComputeGlobalTransformError, TransformHelper},
};
use thiserror::Error;

use super::{Position, Rotation, frame::read_pose, sync::parent_frame, tree::Parents};

/// Computes current global transforms, and writes them to [`Position`] and [`Rotation`] without waiting for
/// the next step. Useful after teleports, before spatial queries.
#[derive(SystemParam)]
pub struct PhysicsTransformHelper<'w, 's> {
    /// Computes global transforms through the hierarchy.
    pub transform_helper: TransformHelper<'w, 's>,
    /// The poses.
    pub query: Query<'w, 's, (Write<Position>, Write<Rotation>)>,
    transforms: Query<'w, 's, Read<Transform>>,
    parents: Parents<'w, 's>,
}

impl PhysicsTransformHelper<'_, '_> {
    /// The global transform of an entity, from its `Transform` and its ancestors' transforms.
    pub fn compute_global_transform(
        &self,
        entity: Entity,
    ) -> Result<GlobalTransform, ComputeGlobalTransformError> {
        self.transform_helper.compute_global_transform(entity)
    }

    /// Sets the pose of an entity from its `Transform` and its ancestors' transforms, and returns the pose.
    pub fn update_physics_transform(
        &mut self,
        entity: Entity,
    ) -> Result<(Mut<'_, Position>, Mut<'_, Rotation>), UpdatePhysicsTransformError> {
        // Bevy's helper checks that all ancestors exist.
        self.transform_helper.compute_global_transform(entity)?;
        let missing = UpdatePhysicsTransformError::MissingTransform(entity);
        let Ok(transform) = self.transforms.get(entity) else { return Err(missing) };
        let parent = parent_frame(entity, &self.parents, |e| self.transforms.get(e).ok().copied());
        let (read, turned) = read_pose(parent.as_ref(), transform);
        let Ok((mut position, mut rotation)) = self.query.get_mut(entity) else { return Err(missing) };
        position.set_if_neq(Position(read));
        if let Some(turned) = turned {
            rotation.set_if_neq(turned);
        }
        Ok((position, rotation))
    }
}

/// The reason why a pose could not be updated.
#[derive(Debug, Error)]
pub enum UpdatePhysicsTransformError {
    /// A component is missing.
    #[error(
        "The entity {0:?} or one of its ancestors is missing either the `Transform`, `Position`, or `Rotation` component"
    )]
    MissingTransform(Entity),
    /// The entity does not exist.
    #[error("{0}")]
    NoSuchEntity(EntityNotSpawnedError),
    /// An ancestor does not exist.
    #[error("{0}")]
    MalformedHierarchy(EntityNotSpawnedError),
}

impl From<ComputeGlobalTransformError> for UpdatePhysicsTransformError {
    fn from(error: ComputeGlobalTransformError) -> Self {
        match error {
            ComputeGlobalTransformError::MissingTransform(entity) => Self::MissingTransform(entity),
            ComputeGlobalTransformError::NoSuchEntity(error) => Self::NoSuchEntity(error),
            ComputeGlobalTransformError::MalformedHierarchy(error) => Self::MalformedHierarchy(error),
        }
    }
}
