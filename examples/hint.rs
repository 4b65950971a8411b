//! Text on the screen: what to look at, which keys there are, and numbers of an example.

use bevy::prelude::*;

/// A plugin that shows a text in the upper left corner, and a [`Readout`] below it.
pub struct Hint(pub &'static str);

/// Marks the [`Text`] below the hint. It is empty until an example writes to it.
#[derive(Component)]
pub struct Readout;

impl Plugin for Hint {
    fn build(&self, app: &mut App) {
        let hint = self.0;
        app.add_systems(Startup, move |mut commands: Commands| _ = commands.spawn(panel(hint)));
    }
}

fn panel(hint: &str) -> impl Bundle {
    let font = TextFont::from_font_size(16.0);
    let node = Node {
        position_type: PositionType::Absolute,
        flex_direction: FlexDirection::Column,
        padding: UiRect::all(px(8)),
        max_width: percent(100),
        ..default()
    };
    let lines = children![
        (Text::new(hint), font.clone(), Pickable::IGNORE),
        (Text::default(), font, TextColor(Color::srgb(1.0, 0.85, 0.4)), Readout, Pickable::IGNORE),
    ];
    (node, BackgroundColor(Color::srgba(0.0, 0.0, 0.0, 0.6)), Pickable::IGNORE, lines)
}
