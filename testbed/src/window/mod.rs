//! The scene browser: a window with a list of scenes, the chosen one running in it.
//!
//! The window's `App` has no physics. The chosen scene runs in an `App` of its own, as in the headless tour,
//! and its colliders are copied into meshes each frame; so one window shows both dimensions.

mod browser;
mod camera;
mod meshes;
mod stage;

use std::process::ExitCode;

use bevy::prelude::*;

use crate::{child, sim::Entry};
use stage::Stage;

/// Opens the window and stays until it is closed.
pub fn run(entries: Vec<Entry>) -> ExitCode {
    let window = Window { title: "Physics testbed".into(), resolution: (1280, 800).into(), ..default() };
    let exit = App::new()
        .add_plugins(DefaultPlugins.set(WindowPlugin { primary_window: Some(window), ..default() }))
        .insert_resource(ClearColor(Color::srgb(0.955, 0.955, 0.94)))
        .insert_resource(GlobalAmbientLight { brightness: 500.0, ..default() })
        .insert_non_send(Stage::new(entries))
        .init_resource::<camera::Orbit>()
        .init_resource::<meshes::Library>()
        .add_systems(Startup, (browser::spawn, camera::spawn))
        .add_systems(
            Update,
            (
                browser::read_keys,
                browser::read_clicks,
                stage::advance,
                meshes::show,
                camera::read_mouse,
                camera::place,
                browser::show_numbers,
                browser::mark_chosen,
                say_drawn,
            )
                .chain(),
        )
        .run();
    match exit {
        AppExit::Success => ExitCode::SUCCESS,
        AppExit::Error(code) => ExitCode::from(code.get()),
    }
}

/// Reports to the waiting process that the window has drawn. Rendering is a frame behind, and opens the
/// surface in its first frame: at the third frame, the first has been drawn.
fn say_drawn(mut frame: Local<u32>) {
    *frame = frame.saturating_add(1);
    if *frame == 3 {
        child::say_drawn();
    }
}
