//! Conveyor belts by collision hooks. Look at the boxes: each belt is a static body, and carries them at the speed of its
//! arrow, round and round. Where they pass from one belt to the next, friction turns them.
//!
//! `cargo run --release -p examples3d --example conveyor_belt`

use avian3d::prelude::*;
use bevy::{ecs::system::SystemParam, prelude::*};
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "Each belt is static, and carries boxes at the speed of its arrow.";

fn main() {
    let scenery = Scenery::new(Vec3::new(0.0, 9.0, 10.0), Vec3::ZERO).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, scenery))
        .add_plugins(PhysicsPlugins::default().with_collision_hooks::<Belts>())
        .add_systems(Startup, setup)
        .add_systems(Update, draw_arrows)
        .run();
}

/// The velocity of a belt's surface in its own frame, in m/s.
#[derive(Component)]
struct Belt(Vec3);

#[derive(SystemParam)]
struct Belts<'w, 's> {
    belts: Query<'w, 's, (&'static Belt, &'static GlobalTransform)>,
}

impl CollisionHooks for Belts<'_, '_> {
    fn modify_contacts(&self, contacts: &mut ContactPair, _: &mut Commands) -> bool {
        let velocity = |entity| {
            self.belts.get(entity).map_or(Vec3::ZERO, |(belt, transform)| transform.rotation() * belt.0)
        };
        // The second surface moves with the first, and the first against the second.
        let tangent_velocity = velocity(contacts.collider1) - velocity(contacts.collider2);
        for manifold in &mut contacts.manifolds {
            manifold.tangent_velocity = tangent_velocity;
        }
        true
    }
}

fn draw_arrows(belts: Query<(&Belt, &GlobalTransform)>, mut gizmos: Gizmos) {
    for (belt, transform) in &belts {
        let middle = transform.translation() + Vec3::Y * 0.3;
        gizmos.arrow(middle, middle + transform.rotation() * belt.0 * 0.5, Color::srgb(1.0, 0.8, 0.2));
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let size = Vec3::new(6.0, 0.4, 2.0);
    let belt = meshes.add(Cuboid::from_size(size));
    let gray = materials.add(Color::srgb(0.25, 0.25, 0.3));
    for i in 0..4 {
        let turn = Quat::from_rotation_y(core::f32::consts::FRAC_PI_2 * i as f32);
        commands.spawn((
            Belt(Vec3::X * 2.0),
            ActiveCollisionHooks::MODIFY_CONTACTS,
            RigidBody::Static,
            Collider::cuboid(size.x, size.y, size.z),
            Friction::new(0.8),
            Transform::from_translation(turn * Vec3::new(-1.0, 0.4, 3.0)).with_rotation(turn),
            Mesh3d(belt.clone()),
            MeshMaterial3d(gray.clone()),
        ));
    }
    let cube = meshes.add(Cuboid::from_length(0.6));
    for i in 0..12 {
        let at = Vec3::new(-3.0 + 0.9 * (i % 6) as f32, 1.5 + 1.0 * (i / 6) as f32, 3.0);
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(0.6, 0.6, 0.6),
            Transform::from_translation(at),
            Mesh3d(cube.clone()),
            MeshMaterial3d(materials.add(Color::hsl(30.0 * i as f32, 0.6, 0.6))),
        ));
    }
}
