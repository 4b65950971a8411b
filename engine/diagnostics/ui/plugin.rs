//! The plugin of the panel.

use super::{PhysicsDiagnosticsUiSettings, build_panel, update_rows};
use crate::diagnostics::PhysicsDiagnosticsPlugin;
use bevy_app::{App, Plugin, Update};
use bevy_ecs::schedule::IntoScheduleConfigs;

/// Shows the timers and counters of physics in a panel at the top left of the window. Adds
/// [`PhysicsDiagnosticsPlugin`] if it is missing. Set it up with [`PhysicsDiagnosticsUiSettings`].
pub struct PhysicsDiagnosticsUiPlugin;

impl Plugin for PhysicsDiagnosticsUiPlugin {
    fn build(&self, app: &mut App) {
        if !app.is_plugin_added::<PhysicsDiagnosticsPlugin>() {
            app.add_plugins(PhysicsDiagnosticsPlugin);
        }
        app.init_resource::<PhysicsDiagnosticsUiSettings>()
            .add_systems(Update, (build_panel, update_rows).chain());
    }
}
