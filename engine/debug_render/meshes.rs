//! Hiding of meshes.

use bevy_camera::visibility::Visibility;
use bevy_ecs::{hierarchy::ChildOf, prelude::*, system::SystemParam};
use bevy_gizmos::config::GizmoConfigStore;
use bevy_mesh::{Mesh2d, Mesh3d};

use super::{DebugRender, PhysicsGizmos};
use crate::{collision::collider::ColliderMarker, dynamics::rigid_body::RigidBody};

/// The visibility of a mesh before it was hidden.
#[derive(Component)]
pub(super) struct Hidden(Visibility);

/// Distinguishes meshes that debug rendering hides from meshes that the app hides.
#[derive(SystemParam)]
pub(super) struct HiddenMeshes<'w, 's> {
    hidden: Query<'w, 's, &'static Hidden>,
    parents: Query<'w, 's, &'static ChildOf>,
}

impl HiddenMeshes<'_, '_> {
    /// Whether debug rendering hides an entity or an ancestor that the app does not hide.
    pub(super) fn hide(&self, entity: Entity) -> bool {
        let mut line = core::iter::once(entity).chain(self.parents.iter_ancestors(entity));
        line.any(|entity| self.hidden.get(entity).is_ok_and(|hidden| hidden.0 != Visibility::Hidden))
    }
}

/// A mesh of a body or collider.
type OfPhysics = (Or<(With<Mesh2d>, With<Mesh3d>)>, Or<(With<RigidBody>, With<ColliderMarker>)>);

/// Hides and shows meshes according to the settings. A mesh that the app has made visible since stays
/// visible.
pub(super) fn hide_meshes(
    mut meshes: Query<(Entity, &mut Visibility, Option<&DebugRender>, Option<&Hidden>), OfPhysics>,
    store: Option<Res<GizmoConfigStore>>,
    mut commands: Commands,
) {
    let group = store.as_ref().and_then(|store| store.get_config::<PhysicsGizmos>());
    let is_enabled = group.is_some_and(|(config, _)| config.enabled);
    let hides_all = group.is_some_and(|(_, gizmos)| gizmos.hide_meshes);
    for (entity, mut visibility, own, hidden) in &mut meshes {
        let hides = is_enabled && own.map_or(hides_all, |own| own.hide_mesh);
        match hidden {
            None if hides => {
                commands.entity(entity).insert(Hidden(*visibility));
                *visibility = Visibility::Hidden;
            }
            Some(hidden) if !hides => {
                if *visibility == Visibility::Hidden {
                    *visibility = hidden.0;
                }
                commands.entity(entity).remove::<Hidden>();
            }
            _ => {}
        }
    }
}
