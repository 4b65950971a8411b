//! Writes timers and counters to Bevy's diagnostics.

use super::{PhysicsEntityDiagnosticsPlugin, PhysicsTotalDiagnosticsPlugin, registry::registered};
use bevy_app::{App, Plugin};

/// Writes the timers and counters of physics to Bevy's
/// [`DiagnosticsStore`](bevy_diagnostic::DiagnosticsStore) after each step. Adds
/// [`PhysicsTotalDiagnosticsPlugin`] and [`PhysicsEntityDiagnosticsPlugin`].
///
/// To log them, add Bevy's `LogDiagnosticsPlugin`; to show them in the window, `PhysicsDiagnosticsUiPlugin`.
pub struct PhysicsDiagnosticsPlugin;

impl Plugin for PhysicsDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        let mut registered = registered(app);
        registered.writers.are_added = true;
        let writers = core::mem::take(&mut registered.writers.list);
        writers.into_iter().for_each(|add| add(app));
        if !app.is_plugin_added::<PhysicsTotalDiagnosticsPlugin>() {
            app.add_plugins(PhysicsTotalDiagnosticsPlugin);
        }
        if !app.is_plugin_added::<PhysicsEntityDiagnosticsPlugin>() {
            app.add_plugins(PhysicsEntityDiagnosticsPlugin);
        }
    }
}
