//! The plugin that draws.

use bevy_app::{App, Plugin, PostUpdate};
use bevy_asset::Assets;
use bevy_camera::visibility::VisibilitySystems;
use bevy_ecs::prelude::*;
use bevy_gizmos::{AppGizmoBuilder, GizmoAsset};
use bevy_transform::TransformSystems;

use super::{
    PhysicsGizmos,
    contacts::draw_contacts,
    dim,
    draw::{draw_aabbs, draw_axes, draw_islands, draw_trees, is_enabled},
    joints::draw_joints,
    meshes::hide_meshes,
};
use crate::{collision::contact_types::views::ContactViews, schedule::PhysicsSystems};

/// Draws bodies, colliders, joints, contacts and queries as lines, according to [`PhysicsGizmos`], at the end
/// of each frame.
///
/// It runs in [`PostUpdate`], after transforms are propagated and after physics if physics runs there, so
/// that lines match the meshes of the frame. Entities that the app hides are not drawn. Without a window it
/// draws nothing and does no harm.
///
/// Apps with Bevy's default features draw gizmos. Apps that choose features need Bevy's `bevy_gizmos_render`.
///
/// ```
/// # use avian::prelude::*;
/// # use bevy_app::prelude::*;
/// fn build(app: &mut App) {
///     app.add_plugins((PhysicsPlugins::default(), PhysicsDebugPlugin));
/// }
/// ```
#[derive(Default)]
pub struct PhysicsDebugPlugin;

impl Plugin for PhysicsDebugPlugin {
    fn build(&self, app: &mut App) {
        // Bevy's own plugin replaces these; without it the group still empties its buffers.
        app.init_resource::<Assets<GizmoAsset>>()
            .init_gizmo_group::<PhysicsGizmos>()
            .add_systems(
                PostUpdate,
                (
                    draw_axes,
                    draw_aabbs,
                    draw_islands,
                    draw_trees,
                    draw_contacts.run_if(resource_exists::<ContactViews>),
                )
                    .in_set(Drawing),
            )
            .add_systems(PostUpdate, (draw_joints(), dim::joints::draw_own_joints()).in_set(Drawing))
            .add_systems(PostUpdate, hide_meshes.before(VisibilitySystems::VisibilityPropagate))
            .configure_sets(
                PostUpdate,
                Drawing
                    .run_if(is_enabled)
                    .after(TransformSystems::Propagate)
                    .after(VisibilitySystems::VisibilityPropagate)
                    .after(PhysicsSystems::Last),
            );
        #[cfg(feature = "default-collider")]
        app.add_systems(
            PostUpdate,
            (
                super::colliders::draw_colliders,
                super::casts::draw_ray_casters,
                super::casts::draw_shape_casters,
            )
                .in_set(Drawing),
        );
    }
}

/// The systems that draw.
#[derive(SystemSet, Clone, Debug, PartialEq, Eq, Hash)]
struct Drawing;
