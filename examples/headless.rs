//! Runs examples without a window or a renderer, one tick of 1/64 s per frame.

use std::time::Duration;

use bevy::{
    input::{
        ButtonState,
        keyboard::{Key, KeyboardInput},
    },
    log::LogPlugin,
    prelude::*,
    render::{
        RenderPlugin,
        pipelined_rendering::PipelinedRenderingPlugin,
        settings::{RenderCreation, WgpuSettings},
    },
    time::TimeUpdateStrategy,
    window::ExitCondition,
    winit::WinitPlugin,
};

/// The example after its first frame.
pub fn start(example: fn(&mut App)) -> App {
    let window = WindowPlugin { primary_window: None, exit_condition: ExitCondition::DontExit, ..default() };
    let settings = WgpuSettings { backends: None, ..default() };
    let render = RenderPlugin { render_creation: RenderCreation::Automatic(Box::new(settings)), ..default() };
    let mut app = App::new();
    app.add_plugins(
        DefaultPlugins
            .set(window)
            .set(render)
            .disable::<LogPlugin>()
            .disable::<WinitPlugin>()
            .disable::<PipelinedRenderingPlugin>(),
    )
    .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs(1) / 64))
    .add_plugins(example);
    app.finish();
    app.cleanup();
    app.update();
    app
}

/// Runs for some seconds.
pub fn run(app: &mut App, seconds: f32) {
    (0..(64.0 * seconds).round() as usize).for_each(|_| app.update());
}

/// Presses or releases a key, before the next frame.
pub fn key(app: &mut App, key_code: KeyCode, state: ButtonState) {
    app.world_mut().write_message(KeyboardInput {
        key_code,
        logical_key: Key::Dead(None),
        state,
        text: None,
        repeat: false,
        window: Entity::PLACEHOLDER,
    });
}

/// Holds a key for some seconds.
pub fn hold(app: &mut App, key_code: KeyCode, seconds: f32) {
    key(app, key_code, ButtonState::Pressed);
    run(app, seconds);
    key(app, key_code, ButtonState::Released);
}
