//! The outlines of colliders. Each is computed once, and again when the collider changes.

use bevy_color::{Color, LinearRgba};
use bevy_ecs::{change_detection::Tick, entity::EntityHashMap, prelude::*};
use bevy_gizmos::gizmos::Gizmos;

use super::{
    DebugRender, PhysicsGizmos,
    draw::{DrawnPose, sleeping_color, sleeps, style},
    lines::Strips,
    meshes::HiddenMeshes,
    outline::outline,
};
use crate::{
    collision::collider::{Collider, ColliderDisabled, collider_hierarchy::ColliderOf},
    dynamics::rigid_body::sleeping::Sleeping,
};

/// The outline of each collider, and the tick at which the collider was as it is there.
#[derive(Default)]
pub(super) struct Outlines(EntityHashMap<(Tick, Strips)>);

/// The number of outlines of colliders that are gone before they are dropped.
const SPARE: usize = 64;

/// Draws the outlines of colliders.
pub(super) fn draw_colliders(
    colliders: Query<
        (Entity, Ref<Collider>, DrawnPose, Option<&ColliderOf>, Option<&DebugRender>),
        Without<ColliderDisabled>,
    >,
    sleeping: Query<(), With<Sleeping>>,
    hidden: HiddenMeshes,
    mut outlines: Local<Outlines>,
    mut gizmos: Gizmos<PhysicsGizmos>,
) {
    let general = style(gizmos.config_ext, None);
    let general_colors = colors(&general);
    let mut drawn = 0;
    for (entity, collider, pose, body, own) in &colliders {
        let colors = own.map_or(general_colors, colors);
        let Some([awake, asleep]) = colors.filter(|_| pose.is_shown(&hidden)) else { continue };
        let color = if sleeps(body, &sleeping) { asleep } else { awake };
        let changed = collider.last_changed();
        let (tick, lines) = outlines.0.entry(entity).or_insert_with(|| (changed, outline(&collider)));
        if *tick != changed {
            (*tick, *lines) = (changed, outline(&collider));
        }
        lines.draw(&pose.frame(), color, &mut gizmos);
        drawn += 1;
    }
    if outlines.0.len() > drawn + SPARE {
        outlines.0.retain(|entity, _| colliders.contains(*entity));
    }
}

/// The colors of a collider: awake and asleep.
fn colors(style: &DebugRender) -> Option<[LinearRgba; 2]> {
    let awake: Color = style.collider_color?;
    Some([awake, sleeping_color(awake, style.sleeping_color_multiplier)].map(LinearRgba::from))
}
