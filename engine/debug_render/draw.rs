//! Axes, bounding boxes, islands and collider trees.

use bevy_camera::visibility::InheritedVisibility;
use bevy_color::{Color, Hsla};
use bevy_ecs::{prelude::*, query::QueryData};
use bevy_gizmos::{config::GizmoConfigStore, gizmos::Gizmos};
use bevy_math::{Affine3A, Mat3, Quat, Vec3, Vec3A};
use bevy_transform::components::GlobalTransform;
use kernel::{
    bvh::TreeKind,
    math::{DIM, Vector as KernelVector},
};

use super::{
    DebugRender, PhysicsGizmos,
    dim::{self, drawn_frame, edges, frame},
    lines::{Strips, draw_strip},
    meshes::HiddenMeshes,
};
use crate::{
    collision::collider::{
        ColliderAabb, ColliderDisabled,
        collider_hierarchy::{ColliderOf, RigidBodyColliders},
        collider_transform::ColliderTransform,
    },
    dynamics::{
        rigid_body::{
            RigidBody, RigidBodyDisabled, mass_properties::components::ComputedCenterOfMass,
            sleeping::Sleeping,
        },
        solver::PhysicsLengthUnit,
        tables::{Bodies, Colliders, PhysicsIslands},
    },
    math::Scalar,
    physics_transform::{Position, Rotation},
};

/// Whether anything is drawn.
pub(super) fn is_enabled(store: Option<Res<GizmoConfigStore>>) -> bool {
    store.is_some_and(|store| store.get_config::<PhysicsGizmos>().is_some_and(|(config, _)| config.enabled))
}

/// The pose at which an entity is drawn: its `GlobalTransform` like its meshes, or its physics pose if it has
/// no transform.
#[derive(QueryData)]
pub(super) struct DrawnPose {
    entity: Entity,
    visibility: Option<&'static InheritedVisibility>,
    transform: Option<&'static GlobalTransform>,
    place: Option<&'static ColliderTransform>,
    position: &'static Position,
    rotation: &'static Rotation,
}

impl DrawnPoseItem<'_, '_> {
    /// Whether the entity is visible, or hidden only because lines replace its mesh.
    pub(super) fn is_shown(&self, hidden: &HiddenMeshes) -> bool {
        self.visibility.is_none_or(|visibility| visibility.get()) || hidden.hide(self.entity)
    }

    pub(super) fn frame(&self) -> Affine3A {
        match self.transform {
            Some(transform) => drawn_frame(transform, drawn_rotation(transform, self.place)),
            None => frame(self.position.0, *self.rotation),
        }
    }
}

/// The rotation at which an entity is drawn. Bevy's decomposition of a mirrored transform puts the mirror at
/// the x axis, and the rest into the rotation. Colliders have the mirror at the axis of the negative scale.
fn drawn_rotation(transform: &GlobalTransform, place: Option<&ColliderTransform>) -> Quat {
    let scale = place.map_or(Vec3::ONE, |place| dim::point(place.scale));
    if scale.cmpge(Vec3::ZERO).all() {
        return transform.rotation();
    }
    let axes = transform.affine().matrix3;
    let along = |axis: Vec3A, sign: f32| (Vec3::from(axis) * 1.0_f32.copysign(sign)).try_normalize();
    let x = along(axes.x_axis, scale.x);
    let y = x.and_then(|x| along(axes.y_axis.reject_from(x.into()), scale.y));
    match (x, y) {
        (Some(x), Some(y)) => Quat::from_mat3(&Mat3::from_cols(x, y, x.cross(y))),
        _ => transform.rotation(),
    }
}

/// The drawing style of an entity.
pub(super) fn style(gizmos: &PhysicsGizmos, own: Option<&DebugRender>) -> DebugRender {
    own.copied().unwrap_or(DebugRender {
        axis_lengths: gizmos.axis_lengths,
        aabb_color: gizmos.aabb_color,
        collider_color: gizmos.collider_color,
        sleeping_color_multiplier: gizmos.sleeping_color_multiplier,
        hide_mesh: gizmos.hide_meshes,
    })
}

/// The color while a body sleeps.
pub(super) fn sleeping_color(color: Color, factors: Option<[f32; 4]>) -> Color {
    let Some([hue, saturation, lightness, alpha]) = factors else { return color };
    let c = Hsla::from(color);
    Hsla::new(c.hue * hue, c.saturation * saturation, c.lightness * lightness, c.alpha * alpha).into()
}

/// Whether the body of a collider sleeps.
pub(super) fn sleeps(body: Option<&ColliderOf>, sleeping: &Query<(), With<Sleeping>>) -> bool {
    body.is_some_and(|of| sleeping.contains(of.body))
}

/// The length unit, 1 if there is none.
pub(super) fn unit(unit: Option<&PhysicsLengthUnit>) -> Scalar {
    unit.map_or(1.0, |unit| unit.0)
}

/// Draws the axes of bodies at their centres of mass.
pub(super) fn draw_axes(
    bodies: Query<
        (DrawnPose, Option<&ComputedCenterOfMass>, Has<Sleeping>, Option<&DebugRender>),
        (With<RigidBody>, Without<RigidBodyDisabled>),
    >,
    length_unit: Option<Res<PhysicsLengthUnit>>,
    hidden: HiddenMeshes,
    mut gizmos: Gizmos<PhysicsGizmos>,
) {
    let unit = unit(length_unit.as_deref());
    for (pose, center, sleeps, own) in &bodies {
        let style = style(gizmos.config_ext, own);
        let Some(lengths) = style.axis_lengths.filter(|_| pose.is_shown(&hidden)) else { continue };
        let (frame, center) = (pose.frame(), dim::point(center.copied().unwrap_or_default().0));
        for (axis, color) in dim::axes(lengths * unit) {
            let color = if sleeps { sleeping_color(color, style.sleeping_color_multiplier) } else { color };
            let mut line = Strips::default();
            line.push([center, center + axis]);
            line.draw(&frame, color.into(), &mut gizmos);
        }
    }
}

/// Draws the bounding boxes of colliders.
pub(super) fn draw_aabbs(
    colliders: Query<(&ColliderAabb, Option<&ColliderOf>, Option<&DebugRender>), Without<ColliderDisabled>>,
    sleeping: Query<(), With<Sleeping>>,
    mut gizmos: Gizmos<PhysicsGizmos>,
) {
    for (aabb, body, own) in &colliders {
        let style = style(gizmos.config_ext, own);
        let Some(mut color) = style.aabb_color else { continue };
        if sleeps(body, &sleeping) {
            color = sleeping_color(color, style.sleeping_color_multiplier);
        }
        draw_box(dim::point(aabb.min), dim::point(aabb.max), color, &mut gizmos);
    }
}

/// Draws a box around each island.
pub(super) fn draw_islands(
    islands: Option<Res<PhysicsIslands>>,
    bodies: Option<Res<Bodies>>,
    owners: Query<&RigidBodyColliders>,
    boxes: Query<&ColliderAabb, Without<ColliderDisabled>>,
    mut gizmos: Gizmos<PhysicsGizmos>,
) {
    let config = gizmos.config_ext;
    let (Some(color), Some(islands), Some(bodies)) = (config.island_color, islands, bodies) else { return };
    for island in islands.0.islands() {
        let entities = islands.0.bodies(island).iter().map(|body| bodies.entities[*body as usize]);
        let around = entities
            .filter_map(|entity| owners.get(entity).ok())
            .flat_map(|colliders| boxes.iter_many(colliders.iter()))
            .map(|aabb| (dim::point(aabb.min), dim::point(aabb.max)))
            .reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
        let Some((min, max)) = around else { continue };
        let asleep = islands.0.is_asleep(island);
        let color = if asleep { sleeping_color(color, config.sleeping_color_multiplier) } else { color };
        draw_box(min, max, color, &mut gizmos);
    }
}

/// Draws the boxes of the collider trees.
pub(super) fn draw_trees(colliders: Option<Res<Colliders>>, mut gizmos: Gizmos<PhysicsGizmos>) {
    let (Some(color), Some(colliders)) = (gizmos.config_ext.collider_tree_color, colliders) else { return };
    for aabb in TreeKind::ALL.into_iter().flat_map(|kind| colliders.trees.trees[kind].boxes()) {
        let [min, max] = [aabb.min, aabb.max].map(corner);
        draw_box(min, max, color, &mut gizmos);
    }
}

/// A corner of a box of the kernel.
fn corner(v: KernelVector) -> Vec3 {
    let mut corner = [0.0; 3];
    corner[..DIM].copy_from_slice(&v.to_array());
    Vec3::from_array(corner)
}

fn draw_box(min: Vec3, max: Vec3, color: Color, gizmos: &mut Gizmos<PhysicsGizmos>) {
    if min.is_finite() && max.is_finite() && min.cmple(max).all() {
        draw_strip(edges(min, max), color, gizmos);
    }
}
