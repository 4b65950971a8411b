//! The timer of picking.

use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use core::time::Duration;

use crate::diagnostics::diagnostic_paths;

/// Time for picking in the last frame.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(type_path = false, Resource, Debug, Default)]
pub struct PhysicsPickingDiagnostics {
    /// Time for finding the colliders below all pointers.
    pub update_hits: Duration,
}

crate::type_path::type_path!(PhysicsPickingDiagnostics, "picking");

diagnostic_paths! {
    PhysicsPickingDiagnostics {
        timer UPDATE_HITS: "avian/physics/update_hits" = update_hits,
    }
    reset keep
}

/// Picking runs once per frame, not per step: its time stays until it runs again.
fn keep(_: ResMut<PhysicsPickingDiagnostics>) {}
