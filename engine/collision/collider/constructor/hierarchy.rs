//! Settings for the colliders of all descendants of an entity.

use bevy_ecs::{prelude::Component, reflect::ReflectComponent};
use bevy_platform::collections::HashMap;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::ColliderConstructor;
use crate::{
    collision::collider::CollisionLayers, dynamics::rigid_body::mass_properties::components::ColliderDensity,
};

/// Makes colliders on all descendants of an entity, for example on the nodes of a level from a glTF file. The
/// entity itself gets none.
///
/// Each descendant gets the constructor set for its `Name`, or the default [`ColliderConstructor`]. It gets
/// none if
///
/// - there is no constructor for it, by `None` as default or by
///   [`without_constructor_for_name`](Self::without_constructor_for_name),
/// - the constructor needs a mesh and the descendant has none,
/// - it has a collider or a constructor already, and its name is not in [`config`](Self::config).
///
/// If the name of a descendant is in the config, its layers and density are replaced by the configured ones.
/// Otherwise they are set only if the descendant has none of its own.
///
/// The component is processed in `Update`. If its entity or a descendant spawns a scene (`WorldAssetRoot` or
/// `DynamicWorldRoot`), it waits until the scene is spawned. This needs feature `bevy_scene`; without the
/// feature it waits until the entity has children, and warns once. When all colliders are inserted, the
/// component is removed and [`ColliderConstructorHierarchyReady`](super::ColliderConstructorHierarchyReady)
/// is triggered. Descendants spawned later get no colliders. If the component is removed earlier, there is no
/// event, and descendants keep constructors that they already have.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_ecs::prelude::*;
/// fn setup(mut commands: Commands) {
///     let ball = ColliderConstructor::Capsule { radius: 0.5, height: 0.1 };
///     commands.spawn((
///         RigidBody::Static,
///         ColliderConstructorHierarchy::new(None)
///             .with_constructor_for_name("Lamp", ball)
///             .with_density_for_name("Lamp", 0.5),
///         children![Name::new("Lamp"), Name::new("Cable")],
///     ));
/// }
/// ```
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct ColliderConstructorHierarchy {
    /// The default constructor. With `None` only descendants whose name is in the config get colliders.
    pub default_constructor: Option<ColliderConstructor>,
    /// The layers of descendants whose name has no layers in the config.
    pub default_layers: CollisionLayers,
    /// The density of descendants whose name has no density in the config. Default 1.
    pub default_density: ColliderDensity,
    /// Settings by `Name`. `None` for no collider.
    pub config: HashMap<String, Option<ColliderConstructorHierarchyConfig>>,
}

crate::type_path::type_path!(ColliderConstructorHierarchy, "collision::collider::constructor");

/// Settings for descendants with one name. `None` takes the default of the
/// [hierarchy](ColliderConstructorHierarchy).
#[derive(Clone, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[reflect(type_path = false, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
pub struct ColliderConstructorHierarchyConfig {
    /// The constructor of the collider.
    pub constructor: Option<ColliderConstructor>,
    /// Its layers.
    pub layers: Option<CollisionLayers>,
    /// Its density.
    pub density: Option<ColliderDensity>,
}

crate::type_path::type_path!(ColliderConstructorHierarchyConfig, "collision::collider::constructor");

impl ColliderConstructorHierarchy {
    /// A hierarchy with a default constructor, or with `None`.
    pub fn new(default_constructor: impl Into<Option<ColliderConstructor>>) -> Self {
        Self { default_constructor: default_constructor.into(), ..Self::default() }
    }

    /// Sets the default layers. [`CollisionLayers::DEFAULT`] by default.
    pub fn with_default_layers(self, layers: CollisionLayers) -> Self {
        Self { default_layers: layers, ..self }
    }

    /// Sets the default density, in kg/m³ (in 2D kg/m²).
    pub fn with_default_density(self, density: impl Into<ColliderDensity>) -> Self {
        Self { default_density: density.into(), ..self }
    }

    /// Sets the constructor for descendants with a name.
    pub fn with_constructor_for_name(mut self, name: &str, constructor: ColliderConstructor) -> Self {
        self.config_of(name).constructor = Some(constructor);
        self
    }

    /// Sets the layers for descendants with a name.
    pub fn with_layers_for_name(mut self, name: &str, layers: CollisionLayers) -> Self {
        self.config_of(name).layers = Some(layers);
        self
    }

    /// Sets the density for descendants with a name, in kg/m³ (in 2D kg/m²).
    pub fn with_density_for_name(mut self, name: &str, density: impl Into<ColliderDensity>) -> Self {
        self.config_of(name).density = Some(density.into());
        self
    }

    /// Makes no collider on descendants with a name.
    pub fn without_constructor_for_name(mut self, name: &str) -> Self {
        self.config.insert(name.to_owned(), None);
        self
    }

    fn config_of(&mut self, name: &str) -> &mut ColliderConstructorHierarchyConfig {
        self.config.entry(name.to_owned()).or_default().get_or_insert_default()
    }
}

/// The settings for one descendant.
pub(super) struct Choice<'a> {
    pub constructor: &'a ColliderConstructor,
    /// Whether the name is in the config.
    pub is_named: bool,
    pub layers: CollisionLayers,
    pub density: ColliderDensity,
}

impl ColliderConstructorHierarchy {
    /// The settings for a descendant with or without a name; `None` for no collider.
    pub(super) fn choice(&self, name: Option<&str>) -> Option<Choice<'_>> {
        let unnamed = ColliderConstructorHierarchyConfig::default();
        let named = name.and_then(|name| self.config.get(name));
        let (config, is_named) = match named {
            Some(None) => return None,
            Some(Some(config)) => (config, true),
            None => (&unnamed, false),
        };
        let own = named.and_then(|config| config.as_ref()?.constructor.as_ref());
        Some(Choice {
            constructor: own.or(self.default_constructor.as_ref())?,
            is_named,
            layers: config.layers.unwrap_or(self.default_layers),
            density: config.density.unwrap_or(self.default_density),
        })
    }
}
