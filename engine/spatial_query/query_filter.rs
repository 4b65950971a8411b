//! The filter of spatial queries.

use bevy_ecs::{entity::EntityHashSet, prelude::*};
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::collision::collider::{CollisionLayers, LayerMask};

/// Selects the colliders that a spatial query finds: colliders in a layer of the mask, without excluded
/// entities.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// # let player = Entity::PLACEHOLDER;
/// // Layers 0 and 1, but not the player's collider.
/// let filter = SpatialQueryFilter::from_mask(0b11).with_excluded_entities([player]);
/// assert!(!filter.test(player, CollisionLayers::default()));
/// ```
#[derive(Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub struct SpatialQueryFilter {
    /// A collider must be in at least one of these layers. All by default.
    pub mask: LayerMask,
    /// Entities whose colliders are not found. None by default.
    pub excluded_entities: EntityHashSet,
}

impl Default for SpatialQueryFilter {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl SpatialQueryFilter {
    /// Every collider.
    pub const DEFAULT: Self = Self { mask: LayerMask::ALL, excluded_entities: EntityHashSet::new() };

    /// Colliders in one of the given layers.
    pub fn from_mask(mask: impl Into<LayerMask>) -> Self {
        Self { mask: mask.into(), ..Self::DEFAULT }
    }

    /// All colliders except the colliders of the given entities.
    pub fn from_excluded_entities(entities: impl IntoIterator<Item = Entity>) -> Self {
        Self::DEFAULT.with_excluded_entities(entities)
    }

    /// The same filter with other layers.
    pub fn with_mask(mut self, masks: impl Into<LayerMask>) -> Self {
        self.mask = masks.into();
        self
    }

    /// The same filter with other excluded entities.
    pub fn with_excluded_entities(mut self, entities: impl IntoIterator<Item = Entity>) -> Self {
        self.excluded_entities = EntityHashSet::from_iter(entities);
        self
    }

    /// Whether a collider with the given layers is found. A collider whose filters contain no layer is not
    /// found.
    pub fn test(&self, entity: Entity, layers: CollisionLayers) -> bool {
        CollisionLayers::new(LayerMask::ALL, self.mask).interacts_with(layers)
            && !self.excluded_entities.contains(&entity)
    }
}
