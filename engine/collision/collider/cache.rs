//! Colliders made from meshes, kept for other entities with the same mesh.

use bevy_app::{App, Plugin, Update};
use bevy_asset::{AssetEvent, AssetId};
use bevy_ecs::{
    change_detection::Tick,
    message::{MessageReader, Messages},
    prelude::{IntoScheduleConfigs, ResMut, Resource, resource_exists},
    system::SystemChangeTick,
};
use bevy_mesh::Mesh;
use bevy_platform::collections::HashMap;

use super::{
    Collider,
    constructor::{ColliderConstructor, ConstructorSystems},
};

/// Keeps the colliders that [`ColliderConstructor`]s make from meshes, so that entities with the same mesh
/// and the same constructor share one shape.
///
/// A collider is forgotten when its mesh is changed or removed. Without assets in the app, the plugin
/// does nothing.
#[derive(Default)]
pub struct ColliderCachePlugin;

impl Plugin for ColliderCachePlugin {
    fn build(&self, app: &mut App) {
        app.init_resource::<ColliderCache>().add_systems(
            Update,
            forget_changed_meshes
                .run_if(resource_exists::<Messages<AssetEvent<Mesh>>>)
                .before(ConstructorSystems),
        );
    }
}

/// Colliders by their mesh.
///
/// Bevy reports changes of assets at the end of a frame. In a frame in which assets changed, older colliders
/// are not used: their mesh may have changed.
#[derive(Resource, Default)]
pub(crate) struct ColliderCache {
    colliders: HashMap<AssetId<Mesh>, Vec<Kept>>,
    /// Number of rounds begun.
    round: u64,
    /// The first round whose colliders may be used.
    trusted: u64,
    /// Changes up to this tick have been reported.
    told: Tick,
}

/// A collider with the constructor that made it.
struct Kept {
    constructor: ColliderConstructor,
    collider: Collider,
    round: u64,
}

impl ColliderCache {
    /// Whether a change of meshes has not been reported yet.
    pub(crate) fn is_untold(&self, changed: Tick, now: Tick) -> bool {
        changed.is_newer_than(self.told, now)
    }

    /// Begins a round of constructors. `is_changed` tells whether a mesh may have changed without a report so
    /// far.
    pub(crate) fn begin(&mut self, is_changed: bool) {
        self.round += 1;
        self.trusted = if is_changed { self.round } else { 0 };
    }

    /// The collider that an equal constructor made from a mesh.
    pub(crate) fn get(&self, mesh: AssetId<Mesh>, constructor: &ColliderConstructor) -> Option<Collider> {
        let kept = self.colliders.get(&mesh)?.iter();
        let mut usable = kept.filter(|kept| kept.round >= self.trusted && kept.constructor == *constructor);
        usable.next().map(|kept| kept.collider.clone())
    }

    /// Keeps a collider that was made in this round.
    pub(crate) fn insert(&mut self, mesh: AssetId<Mesh>, constructor: &ColliderConstructor, made: &Collider) {
        let of_mesh = self.colliders.entry(mesh).or_default();
        // Colliders of untrusted rounds are dropped, and made again when needed. A constructor with NaN
        // equals none.
        of_mesh.retain(|kept| kept.round >= self.trusted && kept.constructor != *constructor);
        if of_mesh.len() < MOST_OF_MESH {
            let (constructor, collider) = (constructor.clone(), made.clone());
            of_mesh.push(Kept { constructor, collider, round: self.round });
        }
    }
}

/// Maximum number of constructors kept per mesh. Others make their collider each time. One or two are usual.
const MOST_OF_MESH: usize = 16;

/// Forgets the colliders of meshes that are changed or gone.
fn forget_changed_meshes(
    mut events: MessageReader<AssetEvent<Mesh>>,
    mut cache: ResMut<ColliderCache>,
    system: SystemChangeTick,
) {
    // Bevy sends events at the end of a frame: these events report changes before the end of the last frame.
    cache.told = system.last_run();
    for event in events.read() {
        if let AssetEvent::Modified { id } | AssetEvent::Removed { id } | AssetEvent::Unused { id } = event {
            cache.colliders.remove(id);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_collider_of_a_former_round_is_not_used_while_meshes_change() {
        let (mesh, constructor) = (AssetId::<Mesh>::invalid(), ColliderConstructor::ConvexHullFromMesh);
        let mut cache = ColliderCache::default();
        cache.begin(true);
        assert!(cache.get(mesh, &constructor).is_none());
        cache.insert(mesh, &constructor, &Collider::capsule(0.5, 1.0));
        assert!(cache.get(mesh, &constructor).is_some(), "made in this round");
        assert!(cache.get(mesh, &ColliderConstructor::TrimeshFromMesh).is_none(), "made otherwise");
        cache.begin(false);
        assert!(cache.get(mesh, &constructor).is_some(), "nothing changed");
        cache.begin(true);
        assert!(cache.get(mesh, &constructor).is_none(), "it may be of the mesh as it was");
        cache.insert(mesh, &constructor, &Collider::capsule(0.7, 1.0));
        assert_eq!(cache.colliders[&mesh].len(), 1, "it took the place of the former one");
    }

    #[test]
    fn a_constructor_with_nan_does_not_fill_the_memory() {
        let mesh = AssetId::<Mesh>::invalid();
        let mut cache = ColliderCache::default();
        cache.begin(false);
        let fill_mode = super::super::FillMode::SurfaceOnly;
        let constructor =
            ColliderConstructor::VoxelizedTrimeshFromMesh { voxel_size: crate::math::Scalar::NAN, fill_mode };
        for _ in 0..100 {
            cache.insert(mesh, &constructor, &Collider::default());
        }
        assert!(cache.colliders[&mesh].len() <= MOST_OF_MESH);
    }
}
