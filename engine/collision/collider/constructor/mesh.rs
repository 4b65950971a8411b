//! Meshes of entities, and whether they are loaded. `no_mesh` stands in without feature `collider-from-mesh`.

use bevy_asset::{AssetId, AssetServer, Assets, LoadState};
use bevy_ecs::{
    change_detection::DetectChanges,
    prelude::{Entity, Query, Res, ResMut},
    system::{SystemChangeTick, SystemParam},
};
use bevy_mesh::Mesh;

use super::{ColliderConstructor, dim::MeshComponent, made::Made};
use crate::collision::collider::{Collider, cache::ColliderCache};

/// The meshes of the app, which may have none: headless apps run without assets.
#[derive(SystemParam)]
pub(super) struct Meshes<'w, 's> {
    components: Query<'w, 's, &'static MeshComponent>,
    assets: Option<Res<'w, Assets<Mesh>>>,
    server: Option<Res<'w, AssetServer>>,
    cache: Option<ResMut<'w, ColliderCache>>,
    ticks: SystemChangeTick,
}

impl Meshes<'_, '_> {
    /// Begins a round of constructors.
    pub(super) fn begin(&mut self) {
        let changed = self.assets.as_ref().map(|assets| assets.last_changed());
        if let Some(cache) = &mut self.cache {
            let is_changed = changed.is_some_and(|changed| cache.is_untold(changed, self.ticks.this_run()));
            cache.begin(is_changed);
        }
    }

    /// Whether an entity lacks the mesh that a constructor needs.
    pub(super) fn lacks(&self, entity: Entity, constructor: &ColliderConstructor) -> bool {
        constructor.requires_mesh() && !self.components.contains(entity)
    }

    /// The collider of a constructor, once the mesh is loaded if it needs one.
    pub(super) fn make(&mut self, entity: Entity, constructor: &ColliderConstructor) -> Made {
        if !constructor.requires_mesh() {
            return Collider::from_constructor(constructor, None).into();
        }
        let Ok(component) = self.components.get(entity) else {
            return Made::Lacks("has no mesh: it waits for a `Mesh3d` (in 2D `Mesh2d`) on the same entity");
        };
        let id = component.id();
        let Some(assets) = &self.assets else {
            return Made::Never("the app has no meshes: add `AssetPlugin` and `MeshPlugin`".into());
        };
        let Some(mesh) = assets.get(id) else { return self.without_asset(id) };
        if let Some(collider) = self.cache.as_ref().and_then(|cache| cache.get(id, constructor)) {
            return Made::Collider(collider);
        }
        let made = Collider::from_constructor(constructor, Some(mesh));
        if let (Some(cache), Ok(collider)) = (&mut self.cache, &made) {
            cache.insert(id, constructor, collider);
        }
        made.into()
    }

    /// The outcome of a constructor whose mesh is not loaded.
    fn without_asset(&self, id: AssetId<Mesh>) -> Made {
        match self.server.as_ref().and_then(|server| server.get_load_state(id)) {
            Some(LoadState::Failed(_)) => Made::Never("its mesh failed to load".into()),
            Some(_) => Made::Later,
            None => Made::Lacks(
                "has a mesh that is not in `Assets<Mesh>` and is not being loaded: it waits for it",
            ),
        }
    }
}
