//! Scenes, and whether they are spawned. `no_scene` stands in without feature `bevy_scene`.

use bevy_ecs::{
    prelude::{Entity, Or, Query, Res, With},
    system::SystemParam,
};
use bevy_world_serialization::{DynamicWorldRoot, WorldAssetRoot, WorldInstance, WorldInstanceSpawner};

/// What spawns a scene below it.
type SpawnsScene = Or<(With<WorldAssetRoot>, With<DynamicWorldRoot>)>;

/// The scenes of the app, which may have none.
#[derive(SystemParam)]
pub(super) struct Scenes<'w, 's> {
    roots: Query<'w, 's, Option<&'static WorldInstance>, SpawnsScene>,
    spawner: Option<Res<'w, WorldInstanceSpawner>>,
}

impl Scenes<'_, '_> {
    /// Whether scenes are known, and waited for.
    pub(super) const ARE_KNOWN: bool = true;

    /// Whether an entity waits for the scene it spawns. Without Bevy's plugin for scenes none does: none would come.
    pub(super) fn is_awaited(&self, entity: Entity) -> bool {
        let (Ok(instance), Some(spawner)) = (self.roots.get(entity), &self.spawner) else { return false };
        !instance.is_some_and(|instance| spawner.instance_is_ready(**instance))
    }
}
