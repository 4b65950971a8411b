//! Colliders described by data: [`ColliderConstructor`] for one entity, [`ColliderConstructorHierarchy`] for
//! all descendants of an entity, and the events sent when they are done.
//!
//! `dim2` and `dim3` have the constructors, `hierarchy` their settings for descendants. `systems` makes the
//! colliders, with access to meshes by `mesh` and to scenes by `scene`. Both have a stand-in for builds
//! without the feature.

#[cfg_attr(feature = "2d", path = "dim2/mod.rs")]
#[cfg_attr(feature = "3d", path = "dim3/mod.rs")]
mod dim;
mod events;
mod hierarchy;
mod made;
#[cfg_attr(not(feature = "collider-from-mesh"), path = "no_mesh.rs")]
mod mesh;
mod plugin;
#[cfg_attr(not(feature = "bevy_scene"), path = "no_scene.rs")]
mod scene;
mod set;
mod systems;
#[cfg(test)]
mod tests;

pub use dim::*;
pub use events::{ColliderConstructorHierarchyReady, ColliderConstructorReady};
pub use hierarchy::{ColliderConstructorHierarchy, ColliderConstructorHierarchyConfig};
pub use plugin::ColliderConstructorPlugin;

pub(crate) use dim::register_types;
#[cfg(feature = "collider-from-mesh")]
pub(crate) use set::ConstructorSystems;

use crate::physics_transform::{Position, Rotation};

impl ColliderConstructor {
    /// A compound of constructors at relative poses.
    pub fn compound<P, R>(shapes: Vec<(P, R, ColliderConstructor)>) -> Self
    where
        P: Into<Position>,
        R: Into<Rotation>,
    {
        Self::Compound(shapes.into_iter().map(|(p, r, shape)| (p.into(), r.into(), shape)).collect())
    }
}
