//! Contact points and normals.

use bevy_ecs::prelude::*;
use bevy_gizmos::gizmos::Gizmos;
use bevy_time::Time;

use super::{
    ContactGizmoScale, PhysicsGizmos,
    draw::unit,
    gizmos::{PhysicsGizmoExt, draw_cross},
};
use crate::{
    collision::contact_types::Collisions, dynamics::solver::PhysicsLengthUnit, math::Scalar,
    schedule::Physics,
};

/// Draws contact points as crosses, and contact normals as arrows from the first collider to the second.
pub(super) fn draw_contacts(
    collisions: Collisions,
    time: Res<Time<Physics>>,
    length_unit: Option<Res<PhysicsLengthUnit>>,
    mut last_step: Local<Scalar>,
    mut gizmos: Gizmos<PhysicsGizmos>,
) {
    let config = gizmos.config_ext;
    let step = time.delta_secs_f64() as Scalar;
    if step > 0.0 {
        *last_step = step;
    }
    if config.contact_point_color.is_none() && config.contact_normal_color.is_none() {
        return;
    }
    let unit = unit(length_unit.as_deref());
    for pair in collisions.iter() {
        for manifold in &pair.manifolds {
            for contact in &manifold.points {
                if let Some(color) = config.contact_point_color {
                    draw_cross(contact.point, 0.05 * unit, color, &mut gizmos);
                }
                let Some(color) = config.contact_normal_color else { continue };
                let length = match config.contact_normal_scale {
                    ContactGizmoScale::Constant(length) => length,
                    ContactGizmoScale::Scaled(_) if *last_step <= 0.0 => 0.0,
                    ContactGizmoScale::Scaled(scale) => {
                        let length = scale * contact.normal_impulse / *last_step;
                        config.max_contact_normal_length.map_or(length, |most| length.min(most))
                    }
                };
                let tip = contact.point + manifold.normal * (length * unit);
                gizmos.draw_arrow(contact.point, tip, (0.1 * unit).min(length * unit * 0.3), color);
            }
        }
    }
}
