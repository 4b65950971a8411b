//! Lines of `PhysicsDebugPlugin`.

use avian3d::prelude::*;
use bevy::{
    gizmos::{GizmoPlugin, config::GizmoConfigStore},
    mesh::MeshPlugin,
    prelude::*,
};

use crate::world::{boxes, time};

/// Measures lines of 5,000 bodies, with all that Bevy does for them before it renders.
pub fn measure() {
    let draw = |app: &mut App| {
        app.add_plugins((AssetPlugin::default(), MeshPlugin, GizmoPlugin, PhysicsDebugPlugin));
    };
    let bevy = |app: &mut App| {
        app.add_plugins((AssetPlugin::default(), MeshPlugin, GizmoPlugin));
    };
    let mut plain = boxes(5_000, bevy, || ());
    let mut drawn = boxes(5_000, draw, || ());
    let mut bounds = boxes(5_000, draw, || ());
    let mut store = bounds.world_mut().resource_mut::<GizmoConfigStore>();
    store.config_mut::<PhysicsGizmos>().1.aabb_color = Some(Color::WHITE);
    let [plain, drawn, bounds] = time([&mut plain, &mut drawn, &mut bounds]);
    println!(
        "drawing of 5,000 bodies: without {plain:.3}, axes and outlines {:+.3}, with boxes {:+.3}",
        drawn - plain,
        bounds - plain
    );
}
