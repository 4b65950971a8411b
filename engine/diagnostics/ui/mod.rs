//! A panel that shows the timers and counters of physics in the window.

mod plugin;

pub use plugin::PhysicsDiagnosticsUiPlugin;

use super::{DiagnosticPath, registry::Registered};
use bevy_color::Color;
use bevy_diagnostic::{Diagnostic, DiagnosticsStore};
use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};
use bevy_text::{FontSize, TextColor, TextFont};
use bevy_ui::{
    AlignItems, BackgroundColor, FlexDirection, GlobalZIndex, JustifyContent, Node, PositionType, UiRect,
    Val, widget::Text,
};

/// Settings of [`PhysicsDiagnosticsUiPlugin`].
#[derive(Resource, Debug, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct PhysicsDiagnosticsUiSettings {
    /// Whether the panel is shown. Default: `true`.
    pub enabled: bool,
    /// Whether times are smoothed over the last steps. If false, times of the last step are shown. Default:
    /// `true`.
    pub show_average_times: bool,
}

impl Default for PhysicsDiagnosticsUiSettings {
    fn default() -> Self {
        Self { enabled: true, show_average_times: true }
    }
}

/// The root of the panel. Change its `Node` to place it elsewhere.
#[derive(Component)]
pub struct PhysicsDiagnosticsUiNode;

/// The text with the value of one timer or counter.
#[derive(Component)]
struct Value(&'static DiagnosticPath);

/// Number of rows of the panel.
#[derive(Component)]
struct Rows(usize);

/// Spawns the panel, and rebuilds it when more timers and counters are registered. Despawns the panel when it
/// is disabled.
fn build_panel(
    settings: Res<PhysicsDiagnosticsUiSettings>,
    registered: Res<Registered>,
    panels: Query<(Entity, &Rows), With<PhysicsDiagnosticsUiNode>>,
    mut commands: Commands,
) {
    let paths = &registered.paths;
    let mut is_shown = false;
    for (panel, rows) in &panels {
        is_shown = settings.enabled && rows.0 == paths.len();
        if !is_shown {
            commands.entity(panel).despawn();
        }
    }
    if is_shown || !settings.enabled || paths.is_empty() {
        return;
    }
    let panel = Node {
        position_type: PositionType::Absolute,
        top: Val::Px(5.0),
        left: Val::Px(5.0),
        width: Val::Px(260.0),
        padding: UiRect::all(Val::Px(8.0)),
        flex_direction: FlexDirection::Column,
        ..Node::default()
    };
    let background = BackgroundColor(Color::srgba(0.05, 0.05, 0.05, 0.8));
    commands
        .spawn((PhysicsDiagnosticsUiNode, Rows(paths.len()), panel, background, GlobalZIndex(1000)))
        .with_children(|panel| {
            for (heading, paths) in groups(paths) {
                let title = (text(heading, 12.0, HEADING), Node { margin: MARGIN, ..Node::default() });
                panel.spawn(title);
                for path in paths {
                    let row = Node {
                        justify_content: JustifyContent::SpaceBetween,
                        align_items: AlignItems::Center,
                        ..Node::default()
                    };
                    panel.spawn(row).with_children(|row| {
                        row.spawn(text(name(path), 11.0, Color::WHITE));
                        row.spawn((text(String::new(), 11.0, Color::WHITE), Value(path)));
                    });
                }
            }
        });
}

/// The color of headings.
const HEADING: Color = Color::srgb(1.0, 0.8, 0.4);
/// The space around headings.
const MARGIN: UiRect = UiRect::new(Val::ZERO, Val::ZERO, Val::Px(5.0), Val::Px(1.0));

/// A small text of a size in pixels.
fn text(text: String, size: f32, color: Color) -> impl Bundle {
    (Text(text), TextFont { font_size: FontSize::Px(size), ..TextFont::default() }, TextColor(color))
}

/// The paths grouped by heading, in the order in which the headings were registered.
fn groups(paths: &[&'static DiagnosticPath]) -> Vec<(String, Vec<&'static DiagnosticPath>)> {
    let mut groups: Vec<(String, Vec<_>)> = Vec::new();
    for &path in paths {
        let heading = heading(path);
        match groups.iter_mut().find(|group| group.0 == heading) {
            Some(group) => group.1.push(path),
            None => groups.push((heading, vec![path])),
        }
    }
    groups
}

/// The heading above a path: its folder in words, without the engine's name.
fn heading(path: &DiagnosticPath) -> String {
    let parts: Vec<&str> = path.components().collect();
    match &parts[..parts.len().saturating_sub(1)] {
        ["avian"] => "Whole step".into(),
        // The path is Avian's. Only picking uses this folder.
        ["avian", "physics"] => "Picking".into(),
        ["avian", folders @ ..] | folders => words(&folders.join(", ")),
    }
}

/// The last part of a path, in words.
fn name(path: &DiagnosticPath) -> String {
    words(path.components().last().unwrap_or_default())
}

/// An identifier in words, the first with a capital letter.
fn words(identifier: &str) -> String {
    let words = identifier.replace('_', " ");
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

fn update_rows(
    settings: Res<PhysicsDiagnosticsUiSettings>,
    store: Res<DiagnosticsStore>,
    mut values: Query<(&Value, &mut Text)>,
) {
    for (value, mut text) in &mut values {
        let new = store.get(value.0).map(|diagnostic| shown(diagnostic, settings.show_average_times));
        let new = new.unwrap_or_default();
        if text.0 != new {
            text.0 = new;
        }
    }
}

/// The displayed value of a diagnostic: times with two digits, counters unchanged.
fn shown(diagnostic: &Diagnostic, is_smoothed: bool) -> String {
    if diagnostic.suffix.is_empty() {
        return diagnostic.value().map(|value| format!("{value:.0}")).unwrap_or_default();
    }
    let value = if is_smoothed { diagnostic.smoothed() } else { diagnostic.value() };
    value.map(|value| format!("{value:.2} {}", diagnostic.suffix)).unwrap_or_default()
}
