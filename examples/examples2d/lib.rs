//! What most examples share: a camera, a floor and a hint on the screen. `hello` is a whole program without it.
//!
//! One idea each: `cargo run -p examples2d --example hello`.

use avian2d::prelude::*;
use bevy::prelude::*;

#[path = "../hint.rs"]
mod hint;

pub use hint::{Hint, Readout};

/// A plugin that adds a camera, and a floor and a hint if wanted. Sizes are in metres; the camera shows 50 pixels for
/// each.
#[derive(Default)]
pub struct Scenery {
    has_floor: bool,
    hint: Option<&'static str>,
}

impl Scenery {
    /// With a floor: a static box 24 m wide, whose top is at y = 0.
    pub fn with_floor() -> Self {
        Self { has_floor: true, ..default() }
    }

    /// With a text on the screen: what to look at, and which keys there are.
    pub fn with_hint(self, hint: &'static str) -> Self {
        Self { hint: Some(hint), ..self }
    }
}

impl Plugin for Scenery {
    fn build(&self, app: &mut App) {
        app.add_systems(Startup, add_camera);
        if self.has_floor {
            app.add_systems(Startup, add_floor);
        }
        if let Some(hint) = self.hint {
            app.add_plugins(Hint(hint));
        }
    }
}

fn add_camera(mut commands: Commands) {
    commands.spawn((
        Camera2d,
        Projection::Orthographic(OrthographicProjection {
            scale: 1.0 / 50.0,
            ..OrthographicProjection::default_2d()
        }),
        Transform::from_xyz(0.0, 5.0, 0.0),
    ));
}

fn add_floor(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    commands.spawn((
        RigidBody::Static,
        Collider::rectangle(24.0, 1.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
        Mesh2d(meshes.add(Rectangle::new(24.0, 1.0))),
        MeshMaterial2d(materials.add(Color::srgb(0.35, 0.4, 0.45))),
    ));
}
