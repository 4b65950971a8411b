//! What most examples share: a camera, a light, a floor and a hint on the screen. `hello` is a whole program without it.
//!
//! One idea each: `cargo run -p examples3d --example hello`.

use avian3d::prelude::*;
use bevy::prelude::*;

#[path = "../hint.rs"]
mod hint;

pub use hint::{Hint, Readout};

/// A plugin that adds a camera and a light, and a floor and a hint if wanted.
pub struct Scenery {
    eye: Vec3,
    target: Vec3,
    has_floor: bool,
    hint: Option<&'static str>,
}

impl Scenery {
    /// A camera at `eye` that looks at `target`, and a light.
    pub fn new(eye: Vec3, target: Vec3) -> Self {
        Self { eye, target, has_floor: false, hint: None }
    }

    /// With a floor: a static box of 30 m by 30 m, whose top is at y = 0.
    pub fn with_floor(self) -> Self {
        Self { has_floor: true, ..self }
    }

    /// With a text on the screen: what to look at, and which keys there are.
    pub fn with_hint(self, hint: &'static str) -> Self {
        Self { hint: Some(hint), ..self }
    }
}

impl Plugin for Scenery {
    fn build(&self, app: &mut App) {
        let camera = Transform::from_translation(self.eye).looking_at(self.target, Vec3::Y);
        app.add_systems(Startup, move |mut commands: Commands| {
            commands.spawn((Camera3d::default(), camera));
            commands.spawn((
                DirectionalLight { shadow_maps_enabled: true, ..default() },
                Transform::from_xyz(-3.0, 8.0, 5.0).looking_at(Vec3::ZERO, Vec3::Y),
            ));
        });
        if self.has_floor {
            app.add_systems(Startup, add_floor);
        }
        if let Some(hint) = self.hint {
            app.add_plugins(Hint(hint));
        }
    }
}

fn add_floor(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        RigidBody::Static,
        Collider::cuboid(30.0, 1.0, 30.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
        Mesh3d(meshes.add(Cuboid::new(30.0, 1.0, 30.0))),
        MeshMaterial3d(materials.add(Color::srgb(0.35, 0.4, 0.45))),
    ));
}
