//! Scenes, and whether they are spawned. `no_scene` stands in without feature `bevy_scene`.

use bevy_asset::{AssetServer, LoadState, UntypedAssetId};
use bevy_ecs::{
    prelude::{Entity, Or, Query, Res, With},
    system::SystemParam,
};
use bevy_world_serialization::{DynamicWorldRoot, WorldAssetRoot, WorldInstance, WorldInstanceSpawner};

/// Entities that spawn a scene below them.
type SpawnsScene = Or<(With<WorldAssetRoot>, With<DynamicWorldRoot>)>;

/// The scenes of the app, which may have none.
#[derive(SystemParam)]
pub(super) struct Scenes<'w, 's> {
    roots: Query<'w, 's, Root, SpawnsScene>,
    spawner: Option<Res<'w, WorldInstanceSpawner>>,
    server: Option<Res<'w, AssetServer>>,
}

type Root =
    (Option<&'static WorldInstance>, Option<&'static WorldAssetRoot>, Option<&'static DynamicWorldRoot>);

impl Scenes<'_, '_> {
    /// Whether scenes are known, and waited for.
    pub(super) const ARE_KNOWN: bool = true;

    /// Whether an entity waits for the scene that it spawns. Without Bevy's scene plugin it does not wait,
    /// because no scene would come. It does not wait for a scene that failed to load either; Bevy reports the
    /// failure.
    pub(super) fn is_awaited(&self, entity: Entity) -> bool {
        let (Ok((instance, world, dynamic)), Some(spawner)) = (self.roots.get(entity), &self.spawner) else {
            return false;
        };
        match instance {
            Some(instance) => !spawner.instance_is_ready(**instance),
            None => {
                let roots =
                    [world.map(|root| root.0.id().untyped()), dynamic.map(|root| root.0.id().untyped())];
                !roots.into_iter().flatten().any(|root| self.has_failed(root))
            }
        }
    }

    fn has_failed(&self, asset: UntypedAssetId) -> bool {
        let state = self.server.as_ref().and_then(|server| server.get_load_state(asset));
        matches!(state, Some(LoadState::Failed(_)))
    }
}
