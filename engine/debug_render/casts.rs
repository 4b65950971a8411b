//! Ray casters and shape casters.

use bevy_color::Color;
use bevy_ecs::prelude::*;
use bevy_gizmos::gizmos::Gizmos;

use super::{PhysicsGizmos, draw::unit, gizmos::PhysicsGizmoExt};
use crate::{
    dynamics::solver::PhysicsLengthUnit,
    spatial_query::{RayCaster, RayHits, ShapeCaster, ShapeHits},
};

/// Draws nothing: the replacement of a color that is not set.
const CLEAR: Color = Color::NONE;

/// Draws ray casters that are enabled, with their last hits.
pub(super) fn draw_ray_casters(
    casters: Query<(&RayCaster, &RayHits)>,
    length_unit: Option<Res<PhysicsLengthUnit>>,
    mut gizmos: Gizmos<PhysicsGizmos>,
) {
    let config = gizmos.config_ext;
    let colors = [config.raycast_color, config.raycast_point_color, config.raycast_normal_color];
    if colors.iter().all(Option::is_none) {
        return;
    }
    let [ray_color, point, normal] = colors.map(|color| color.unwrap_or(CLEAR));
    let unit = unit(length_unit.as_deref());
    for (ray, hits) in casters.iter().filter(|(ray, _)| ray.enabled) {
        let (origin, direction) = (ray.global_origin(), ray.global_direction());
        gizmos.draw_raycast(origin, direction, ray.max_distance, hits, ray_color, point, normal, unit);
    }
}

/// Draws shape casters that are enabled, with their last hits.
pub(super) fn draw_shape_casters(
    casters: Query<(&ShapeCaster, &ShapeHits)>,
    length_unit: Option<Res<PhysicsLengthUnit>>,
    mut gizmos: Gizmos<PhysicsGizmos>,
) {
    let config = gizmos.config_ext;
    let colors = [
        config.shapecast_color,
        config.shapecast_shape_color,
        config.shapecast_point_color,
        config.shapecast_normal_color,
    ];
    if colors.iter().all(Option::is_none) {
        return;
    }
    let [ray, shape, point, normal] = colors.map(|color| color.unwrap_or(CLEAR));
    let unit = unit(length_unit.as_deref());
    for (caster, hits) in casters.iter().filter(|(caster, _)| caster.enabled) {
        gizmos.draw_shapecast(
            &caster.shape,
            caster.global_origin(),
            caster.global_shape_rotation(),
            caster.global_direction(),
            caster.max_distance,
            hits,
            ray,
            shape,
            point,
            normal,
            unit,
        );
    }
}
