//! The outlines of colliders. Each outline is computed once, and again when its collider changes.

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
    collision::collider::{Collider, ColliderDisabled, Sensor, collider_hierarchy::ColliderOf},
    dynamics::rigid_body::{RigidBody, sleeping::Sleeping},
};

/// The outline of each collider, and the tick of the last change that the outline includes.
#[derive(Default)]
pub(super) struct Outlines(EntityHashMap<(Tick, Strips)>);

/// Maximum number of outlines of removed colliders that are kept.
const SPARE: usize = 64;

/// Draws the outlines of colliders.
pub(super) fn draw_colliders(
    colliders: Query<
        (Entity, Ref<Collider>, DrawnPose, Option<&ColliderOf>, Has<Sensor>, Option<&DebugRender>),
        Without<ColliderDisabled>,
    >,
    bodies: Query<&RigidBody>,
    sleeping: Query<(), With<Sleeping>>,
    hidden: HiddenMeshes,
    mut outlines: Local<Outlines>,
    mut gizmos: Gizmos<PhysicsGizmos>,
) {
    let general =
        Kind::ALL.map(|kind| colors(&style(gizmos.config_ext, None), kind.color(gizmos.config_ext)));
    let mut drawn = 0;
    for (entity, collider, pose, body, is_sensor, own) in &colliders {
        let kind = Kind::of(is_sensor, body.and_then(|of| bodies.get(of.body).ok()));
        let colors = own.map_or(general[kind as usize], |own| colors(own, own.collider_color));
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

/// The kinds of colliders with a separate color.
#[derive(Clone, Copy)]
enum Kind {
    Dynamic,
    Kinematic,
    /// Includes colliders without a body.
    Static,
    Sensor,
}

impl Kind {
    const ALL: [Self; 4] = [Self::Dynamic, Self::Kinematic, Self::Static, Self::Sensor];

    fn of(is_sensor: bool, body: Option<&RigidBody>) -> Self {
        match body {
            _ if is_sensor => Self::Sensor,
            Some(RigidBody::Dynamic) => Self::Dynamic,
            Some(RigidBody::Kinematic) => Self::Kinematic,
            Some(RigidBody::Static) | None => Self::Static,
        }
    }

    /// The color of the kind. If the color of all colliders is `None`, no kind is drawn.
    fn color(self, gizmos: &PhysicsGizmos) -> Option<Color> {
        let own = match self {
            Self::Dynamic => None,
            Self::Kinematic => gizmos.kinematic_color,
            Self::Static => gizmos.static_color,
            Self::Sensor => gizmos.sensor_color,
        };
        gizmos.collider_color.map(|general| own.unwrap_or(general))
    }
}

/// The colors of a collider: awake and asleep.
fn colors(style: &DebugRender, color: Option<Color>) -> Option<[LinearRgba; 2]> {
    let awake = color?;
    Some([awake, sleeping_color(awake, style.sleeping_color_multiplier)].map(LinearRgba::from))
}
