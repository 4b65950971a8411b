//! World poses of casters.

use bevy_ecs::{hierarchy::ChildOf, prelude::*, system::SystemParam};
use bevy_transform::components::{GlobalTransform, Transform};

use crate::{
    collision::collider::collider_hierarchy::ColliderOf,
    dynamics::rigid_body::RigidBody,
    math::{AdjustPrecision, AsF32, Dir, Vector, VectorF32},
    physics_transform::{Position, Rotation},
};

/// Maximum number of ancestors that are visited. A deeper hierarchy is cut off there.
const MAX_DEPTH: usize = 256;

/// The frame of a caster in the world. It does not scale lengths.
#[derive(Clone, Copy, Debug)]
pub(super) struct CasterFrame {
    pub(super) position: Vector,
    pub(super) rotation: Rotation,
}

impl CasterFrame {
    pub(super) fn point(&self, point: Vector) -> Vector {
        self.position + self.rotation * point
    }

    /// The direction rotated to the world. If the rotation is invalid, the direction is unchanged.
    pub(super) fn direction(&self, direction: Dir) -> Dir {
        let turned = self.rotation * VectorF32::from(direction).adjust_precision();
        Dir::new(turned.f32()).unwrap_or(direction)
    }
}

/// Poses of casters: `Position` and `Rotation` of an entity if it has them, otherwise its `Transform` applied
/// to the pose of its parent.
#[derive(SystemParam)]
pub(super) struct Frames<'w, 's> {
    poses: Query<'w, 's, (&'static Position, &'static Rotation)>,
    transforms: Query<'w, 's, &'static Transform>,
    globals: Query<'w, 's, &'static GlobalTransform>,
    parents: Query<'w, 's, &'static ChildOf>,
    bodies: Query<'w, 's, (), With<RigidBody>>,
    owners: Query<'w, 's, &'static ColliderOf>,
}

impl Frames<'_, '_> {
    /// The frame of an entity.
    pub(super) fn of(&self, entity: Entity) -> CasterFrame {
        let mut below = Transform::IDENTITY;
        let mut at = entity;
        for _ in 0..MAX_DEPTH {
            let pose = self.poses.get(at).ok().filter(|(position, _)| **position != Position::PLACEHOLDER);
            if let Some((position, rotation)) = pose {
                let scale = self.globals.get(at).map_or(Transform::IDENTITY.scale, GlobalTransform::scale);
                // The scale applies only to descendants: it does not move the entity's own origin.
                let below = Transform { translation: below.translation * scale, ..below };
                let (offset, turn) = local(&below);
                return CasterFrame { position: position.0 + *rotation * offset, rotation: *rotation * turn };
            }
            if let Ok(transform) = self.transforms.get(at) {
                below = *transform * below;
            }
            let Ok(parent) = self.parents.get(at) else { break };
            at = parent.parent();
        }
        let (position, rotation) = local(&below);
        CasterFrame { position, rotation }
    }

    /// The body that an entity belongs to: the entity itself, the body of its collider, or the nearest body
    /// above.
    pub(super) fn body_of(&self, entity: Entity) -> Option<Entity> {
        let mut at = entity;
        for _ in 0..MAX_DEPTH {
            if self.bodies.contains(at) {
                return Some(at);
            }
            if let Ok(of) = self.owners.get(at) {
                return Some(of.body);
            }
            at = self.parents.get(at).ok()?.parent();
        }
        None
    }
}

fn local(transform: &Transform) -> (Vector, Rotation) {
    let place = Position::from(GlobalTransform::from(Transform::from_translation(transform.translation)));
    let turn = Rotation::from(Transform::from_rotation(transform.rotation));
    (place.0, turn)
}
