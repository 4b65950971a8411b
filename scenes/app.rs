//! An `App` without a window in which one update is one step of physics.

use core::time::Duration;

use avian::prelude::*;
use bevy_app::{App, Plugins, TaskPoolPlugin};
use bevy_time::{Fixed, Time, TimePlugin, TimeUpdateStrategy, Virtual};
use bevy_transform::TransformPlugin;

/// Seconds per step that the scenes are measured with.
pub const DT: f64 = 1.0 / 60.0;

/// Substeps per step that the scenes are measured with.
pub const SUBSTEPS: u32 = 4;

/// An `App` with the physics plugins and nothing else, ready to be stepped: each [`step`] is one step of
/// `dt` seconds.
pub fn headless_app(dt: f64, substeps: u32) -> App {
    headless_app_with(dt, substeps, PhysicsPlugins::default())
}

/// Like [`headless_app`], with other plugins (usually the physics plugins, changed, and what a test
/// adds to them).
pub fn headless_app_with<M>(dt: f64, substeps: u32, plugins: impl Plugins<M>) -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin));
    app.insert_resource(Time::<Fixed>::from_duration(Duration::from_secs_f64(dt)));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    app.add_plugins(plugins);
    app.insert_resource(SubstepCount(substeps));
    // Bevy cuts an update off at 250 ms, which would swallow steps longer than that.
    let longest = Duration::from_secs_f64(dt.max(0.25));
    app.world_mut().resource_mut::<Time<Virtual>>().set_max_delta(longest);
    app.finish();
    app.cleanup();
    // Bevy's clock starts with an update in which no time passes.
    app.update();
    app
}

/// One step of physics.
pub fn step(app: &mut App) {
    app.update();
}
