//! The scale of colliders follows the scale of their transforms.
//!
//! [`ColliderTransform::scale`] is the scale of a collider's transform in the world. It changes only if a
//! transform at or above the collider was changed by the app, so bodies that merely move cost nothing here.

use super::{ScalableCollider, collider_transform::ColliderTransform};
use crate::math::{Scalar, Vector, vector_from_xyz};
use crate::physics_transform::{PhysicsTransformConfig, frame::Frame, sync::parent_frame, tree::Parents};
use crate::scan::Since;
use crate::schedule::OnThisThread;
use bevy_ecs::change_detection::DetectChanges;
use bevy_ecs::entity::EntityHashSet;
use bevy_ecs::entity_disabling::Disabled;
use bevy_ecs::prelude::{Allow, Entity, Local, ParamSet, Query, Ref, Res, With};
use bevy_ecs::system::{SystemChangeTick, SystemParam};
use bevy_log::warn;
use bevy_transform::components::Transform;
use core::ops::DerefMut;

/// Number of subdivisions of a curved shape whose transform is scaled unevenly.
const SUBDIVISIONS: u32 = 10;

/// Smallest and largest factor of a scale. A smaller factor makes a point of a shape of usual size; a larger
/// one exceeds the coordinates that colliders may have.
const MIN_SCALE: Scalar = 1.0e-5;
const MAX_SCALE: Scalar = 1.0e7;

/// Scales with at most this relative difference count as equal.
///
/// A rotation below an uneven scale leaves noise in the scale: an `f32` quaternion has unit length to about
/// 10⁻⁷, and each ancestor multiplies the scale by one such error. 10⁻⁵ has room for a deep hierarchy, and is
/// too small to see: 10 µm per metre. With a smaller value shapes would be rebuilt whenever a parent turns.
/// With a larger value slow growth would be visible as jumps.
const SAME_SCALE: Scalar = 1.0e-5;

/// Whether two scales are equal up to rounding. False if one of them is not finite.
fn is_same(a: Vector, b: Vector) -> bool {
    (a - b).abs().cmple(b.abs() * SAME_SCALE).all()
}

/// The scale without noise between its axes: nearly equal factors become equal in all bits, so that round
/// shapes stay round.
fn without_noise(scale: Vector) -> Vector {
    let mut axes = scale.to_array();
    for i in 1..axes.len() {
        for k in 0..i {
            if (axes[i].abs() - axes[k].abs()).abs() <= axes[k].abs() * SAME_SCALE {
                axes[i] = axes[k].abs().copysign(axes[i]);
                break;
            }
        }
    }
    Vector::from_array(axes)
}

/// Gives a collider the scale of its transform. Returns `false` if no collider can have it: the collider
/// keeps its own scale.
fn fit<C: ScalableCollider>(mut collider: impl DerefMut<Target = C>, scale: Vector) -> bool {
    if !scale.to_array().iter().all(|s| (MIN_SCALE..=MAX_SCALE).contains(&s.abs())) {
        return false;
    }
    if !is_same(scale, collider.scale()) {
        collider.set_scale(without_noise(scale), SUBDIVISIONS);
        // The shape may refuse the scale.
        return is_same(scale, collider.scale());
    }
    true
}

/// Whether colliders follow the scale of transforms.
pub(super) fn scale_is_followed(config: Option<Res<PhysicsTransformConfig>>) -> bool {
    config.is_some_and(|config| config.transform_to_collider_scale)
}

/// Queries for the scale of a new collider.
#[derive(SystemParam)]
pub struct TransformScale<'w, 's> {
    transforms: Query<'w, 's, &'static Transform, Allow<Disabled>>,
    parents: Parents<'w, 's>,
    followers: Query<'w, 's, (), (With<ColliderTransform>, Allow<Disabled>)>,
    config: Option<Res<'w, PhysicsTransformConfig>>,
}

impl TransformScale<'_, '_> {
    /// Gives a collider the scale of its transform, at once. [`update_collider_scale`] follows later changes,
    /// and warns of unsupported scales.
    pub(super) fn apply_to<C: ScalableCollider>(&self, entity: Entity, collider: impl DerefMut<Target = C>) {
        let is_on = self.config.as_ref().is_some_and(|config| config.transform_to_collider_scale);
        if !is_on || !self.followers.contains(entity) {
            return;
        }
        let Ok(transform) = self.transforms.get(entity) else { return };
        let parent = parent_frame(entity, &self.parents, |e| self.transforms.get(e).ok().copied());
        let frame = parent.unwrap_or(Frame::IDENTITY).child(transform);
        fit(collider, vector_from_xyz(frame.scale()));
    }
}

/// The components that the search for changes reads.
type Searched<C> = (Entity, Ref<'static, C>, Ref<'static, ColliderTransform>);

/// Gives colliders the scale of their transforms ([`ColliderTransform::scale`]), if the scale or the
/// collider changed.
///
/// A scale that is almost zero, too large or not finite is reported once, and the collider keeps its last
/// valid scale. Part of [`ColliderBackendPlugin`](super::ColliderBackendPlugin). It runs while
/// [`PhysicsTransformConfig::transform_to_collider_scale`] is on.
pub fn update_collider_scale<C: ScalableCollider>(
    mut colliders: ParamSet<(Query<Searched<C>>, Query<(&mut C, &ColliderTransform)>)>,
    mut reported: Local<EntityHashSet>,
    system: SystemChangeTick,
    _: OnThisThread,
) {
    let mut changed: Vec<Entity> = Vec::new();
    let since = Since::last_run(system);
    let all = colliders.p0();
    if let Ok(tables) = all.contiguous_iter() {
        for (entities, shape, place) in tables {
            let columns = [shape.changed_ticks_slice(), place.changed_ticks_slice()];
            since.rows(columns, |row| changed.push(entities[row]));
        }
    } else {
        // `C` has sparse-set storage.
        let is_new = |(_, shape, place): &(Entity, Ref<C>, Ref<ColliderTransform>)| {
            shape.is_changed() || place.is_changed()
        };
        changed.extend(all.iter().filter(is_new).map(|(entity, ..)| entity));
    }
    let mut all = colliders.p1();
    for entity in changed {
        let Ok((collider, place)) = all.get_mut(entity) else { continue };
        if fit(collider, place.scale) {
            if !reported.is_empty() {
                reported.remove(&entity);
            }
        } else if reported.insert(entity) {
            let scale = place.scale;
            warn!(
                "the scale of {entity} is {scale}, which no collider can have (it is almost zero, too large, or not a number); its \
                 collider keeps the last good scale"
            );
            reported.retain(|entity| all.contains(*entity));
        }
    }
}
