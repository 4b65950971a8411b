//! The filter of cameras for picking, and the entities that can be picked.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_picking::Pickable;
use bevy_reflect::prelude::*;
use bevy_transform::components::GlobalTransform;

use crate::{collision::collider::LayerMask, spatial_query::SpatialQueryFilter};

/// Marks cameras and entities with colliders for picking. Needed only if
/// [`PhysicsPickingSettings::require_markers`](super::PhysicsPickingSettings::require_markers) is set.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(type_path = false, Component, Debug, Default)]
pub struct PhysicsPickable;

crate::type_path::type_path!(PhysicsPickable, "picking");

/// The filter of the colliders that a camera picks. Without it all are picked.
#[derive(Component, Clone, Debug, Default, Reflect)]
#[reflect(type_path = false, Component, Debug, Default)]
pub struct PhysicsPickingFilter(pub SpatialQueryFilter);

crate::type_path::type_path!(PhysicsPickingFilter, "picking");

impl PhysicsPickingFilter {
    /// Colliders in one of the given layers.
    pub fn from_mask(mask: impl Into<LayerMask>) -> Self {
        Self(SpatialQueryFilter::from_mask(mask))
    }

    /// All colliders except the colliders of the given entities.
    pub fn from_excluded_entities(entities: impl IntoIterator<Item = Entity>) -> Self {
        Self(SpatialQueryFilter::from_excluded_entities(entities))
    }

    /// The same filter with other layers.
    pub fn with_mask(self, masks: impl Into<LayerMask>) -> Self {
        Self(self.0.with_mask(masks))
    }

    /// The same filter with other excluded entities.
    pub fn with_excluded_entities(self, entities: impl IntoIterator<Item = Entity>) -> Self {
        Self(self.0.with_excluded_entities(entities))
    }
}

/// Query for the picking state of entities with colliders.
#[derive(SystemParam)]
pub struct PickingTargets<'w, 's> {
    pub(super) states:
        Query<'w, 's, (Option<&'static Pickable>, Has<PhysicsPickable>, Option<&'static GlobalTransform>)>,
}

impl PickingTargets<'_, '_> {
    /// Whether a pointer can hit an entity: it is hoverable or hides lower entities, and it has a marker if
    /// markers are required.
    pub(super) fn is_met(&self, entity: Entity, require_markers: bool) -> bool {
        self.states.get(entity).is_ok_and(|(pickable, marked, _)| {
            pickable.is_none_or(|p| p.is_hoverable || p.should_block_lower) && (marked || !require_markers)
        })
    }
}
