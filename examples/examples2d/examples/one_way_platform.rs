//! Platforms that can be jumped through from below, by collision hooks. Look at the ball: it rises through the platforms
//! and lands on them. Left and right or A and D move it, space or up jumps, and down lets it fall through.
//!
//! `cargo run --release -p examples2d --example one_way_platform`

use avian2d::prelude::*;
use bevy::{ecs::system::SystemParam, prelude::*};
use examples2d::Scenery;
use std::collections::HashSet;

/// On the screen.
const HINT: &str = "The ball rises through the platforms and lands on them.
Left, Right or A, D: walk. Space or Up: jump. Down or S: fall through.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, Scenery::with_floor().with_hint(HINT)))
        .add_plugins(PhysicsPlugins::default().with_collision_hooks::<OneWay>())
        .add_systems(Startup, setup)
        .add_systems(Update, control)
        .run();
}

/// A platform, with the colliders that are passing through it.
#[derive(Component, Default)]
struct Platform(HashSet<Entity>);

#[derive(Component, Default)]
struct Player {
    falls_through: bool,
}

#[derive(SystemParam)]
struct OneWay<'w, 's> {
    platforms: Query<'w, 's, (&'static Platform, &'static GlobalTransform)>,
    players: Query<'w, 's, &'static Player>,
}

impl CollisionHooks for OneWay<'_, '_> {
    fn modify_contacts(&self, contacts: &mut ContactPair, commands: &mut Commands) -> bool {
        let [first, second] = [contacts.collider1, contacts.collider2];
        let (entity, other, sign) = if self.platforms.contains(first) {
            (first, second, 1.0)
        } else if self.platforms.contains(second) {
            (second, first, -1.0)
        } else {
            return true;
        };
        let Ok((platform, transform)) = self.platforms.get(entity) else { return true };
        let up = transform.up().truncate() * sign;
        let falls = self.players.get(other).is_ok_and(|player| player.falls_through);
        let is_inside = contacts.manifolds.iter().flat_map(|m| &m.points).any(|p| p.penetration > 0.01);
        let is_passing = platform.0.contains(&other) && is_inside;
        let comes_from_above = contacts.manifolds.iter().all(|m| m.normal.dot(up) > 0.5);
        let passes = falls || is_passing || !comes_from_above;
        if passes != platform.0.contains(&other) {
            // Hooks only read. What they find is kept by a command.
            commands.queue(move |world: &mut World| {
                if let Some(mut platform) = world.get_mut::<Platform>(entity) {
                    if passes {
                        platform.0.insert(other);
                    } else {
                        platform.0.remove(&other);
                    }
                }
            });
        }
        !passes
    }
}

fn control(
    keys: Res<ButtonInput<KeyCode>>,
    mut players: Query<(Entity, &mut Player, &mut LinearVelocity)>,
    collisions: Collisions,
) {
    for (entity, mut player, mut velocity) in &mut players {
        player.falls_through = keys.any_pressed([KeyCode::ArrowDown, KeyCode::KeyS]);
        let right = f32::from(keys.any_pressed([KeyCode::ArrowRight, KeyCode::KeyD]));
        let left = f32::from(keys.any_pressed([KeyCode::ArrowLeft, KeyCode::KeyA]));
        velocity.x = 5.0 * (right - left);
        let stands = collisions.collisions_with(entity).next().is_some();
        if keys.any_just_pressed([KeyCode::Space, KeyCode::ArrowUp, KeyCode::KeyW]) && stands {
            velocity.y = 9.0;
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    commands.spawn((
        Player::default(),
        RigidBody::Dynamic,
        Collider::circle(0.4),
        LockedAxes::ROTATION_LOCKED,
        LinearVelocity(Vec2::new(0.0, 9.0)),
        SleepingDisabled,
        Transform::from_xyz(0.0, 0.5, 0.0),
        Mesh2d(meshes.add(Circle::new(0.4))),
        MeshMaterial2d(materials.add(Color::srgb(0.9, 0.5, 0.3))),
    ));
    let bar = meshes.add(Rectangle::new(4.0, 0.3));
    let blue = materials.add(Color::srgb(0.3, 0.5, 0.8));
    for i in 0..4 {
        commands.spawn((
            Platform::default(),
            ActiveCollisionHooks::MODIFY_CONTACTS,
            RigidBody::Static,
            Collider::rectangle(4.0, 0.3),
            Transform::from_xyz(if i % 2 == 0 { 0.0 } else { 3.0 }, 2.5 + 2.2 * i as f32, 0.0),
            Mesh2d(bar.clone()),
            MeshMaterial2d(blue.clone()),
        ));
    }
}
