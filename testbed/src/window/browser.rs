//! The list of scenes at the left, and the numbers of the one that runs.

use bevy::prelude::*;

use super::stage::Stage;

const TEXT: Color = Color::srgb(0.15, 0.16, 0.2);
const PANEL: Color = Color::srgba(1.0, 1.0, 1.0, 0.82);
const PLAIN: Color = Color::srgba(0.0, 0.0, 0.0, 0.0);
const HOVERED: Color = Color::srgb(0.88, 0.90, 0.94);
const CHOSEN: Color = Color::srgb(0.72, 0.80, 0.92);
const KEYS: &str = "up, down: scene   r: again\nspace: pause   s: one step\ndrag, wheel: camera   home";

/// A line of the list: the number of its scene.
#[derive(Component)]
pub struct Line(usize);

/// The text with the numbers.
#[derive(Component)]
pub struct Numbers;

/// Builds the panel.
pub fn spawn(mut commands: Commands, stage: NonSend<Stage>) {
    let panel = Node {
        position_type: PositionType::Absolute,
        left: px(8),
        top: px(8),
        width: px(236),
        flex_direction: FlexDirection::Column,
        padding: px(8).all(),
        ..default()
    };
    let text = |words: String| (Text(words), TextFont::from_font_size(14.0), TextColor(TEXT));
    commands.spawn((panel, BackgroundColor(PANEL))).with_children(|panel| {
        for (i, entry) in stage.entries.iter().enumerate() {
            let row = Node { padding: UiRect::axes(px(6), px(2)), ..default() };
            panel.spawn((Button, Line(i), row, BackgroundColor(PLAIN))).with_child(text(format!(
                "{}D  {}",
                entry.dimension,
                entry.name.replace('_', " ")
            )));
        }
        panel.spawn((text(String::new()), Numbers, Node { margin: px(8).top(), ..default() }));
        let margin = Node { margin: px(8).top(), ..default() };
        panel.spawn((
            Text(KEYS.into()),
            TextFont::from_font_size(12.0),
            TextColor(TEXT.with_alpha(0.7)),
            margin,
        ));
    });
}

/// Keys for choosing, pausing, stepping, starting again.
pub fn read_keys(mut stage: NonSendMut<Stage>, keys: Res<ButtonInput<KeyCode>>) {
    let (chosen, count) = (stage.chosen, stage.entries.len());
    if keys.just_pressed(KeyCode::ArrowDown) {
        stage.choose(chosen + 1);
    }
    if keys.just_pressed(KeyCode::ArrowUp) {
        stage.choose(chosen + count - 1);
    }
    if keys.any_just_pressed([KeyCode::Enter, KeyCode::KeyR]) {
        stage.choose(chosen);
    }
    if keys.just_pressed(KeyCode::Space) {
        stage.paused = !stage.paused;
    }
    if keys.just_pressed(KeyCode::KeyS) {
        stage.single = true;
    }
}

/// A click on a line chooses its scene.
pub fn read_clicks(mut stage: NonSendMut<Stage>, lines: Query<(&Interaction, &Line), Changed<Interaction>>) {
    for (interaction, line) in &lines {
        if *interaction == Interaction::Pressed {
            stage.choose(line.0);
        }
    }
}

/// Writes bodies, contacts and times below the list.
pub fn show_numbers(mut stage: NonSendMut<Stage>, mut numbers: Single<&mut Text, With<Numbers>>) {
    let counts = stage.counts();
    let contacts = counts.contacts.map_or("-".to_owned(), |n| n.to_string());
    let words = format!(
        "bodies    {}\nasleep    {}\ncontacts  {contacts}\nstep      {}\nms/step   {:.2}{}",
        counts.bodies,
        counts.asleep,
        stage.steps,
        stage.median_ms(),
        if stage.paused { "\npaused" } else { "" },
    );
    if numbers.0 != words {
        numbers.0 = words;
    }
}

/// Colours the lines of the list.
pub fn mark_chosen(stage: NonSend<Stage>, mut lines: Query<(&Line, &Interaction, &mut BackgroundColor)>) {
    for (line, interaction, mut background) in &mut lines {
        let color = match interaction {
            _ if line.0 == stage.chosen => CHOSEN,
            Interaction::None => PLAIN,
            _ => HOVERED,
        };
        background.set_if_neq(BackgroundColor(color));
    }
}
