//! A capsule without gravity that slides along all it meets, by `MoveAndSlide` alone. WASD or the arrow keys steer it, Q and E
//! turn the wall in the middle. Look at the corners, and at the list of what it touches.
//!
//! `cargo run --release -p examples3d --example move_and_slide_3d`

use avian3d::prelude::*;
use bevy::{ecs::entity::EntityHashSet, prelude::*};
use examples3d::{Readout, Scenery};

/// On the screen.
const HINT: &str = "Steer: WASD or arrows. Turn the bar: Q, E.\n\
    Push into walls and corners: it slides, and stops without shaking.";

/// In m/s.
const SPEED: f32 = 5.0;

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    let scenery = Scenery::new(Vec3::new(0.0, 14.0, 9.0), Vec3::ZERO).with_floor().with_hint(HINT);
    app.add_plugins((PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .add_systems(Update, (steer, show_touched))
        .add_systems(FixedUpdate, (turn_bar, slide));
}

/// The velocity that is wanted, and what was touched.
#[derive(Component, Default)]
pub(crate) struct Glider {
    pub(crate) velocity: Vec3,
    pub(crate) touched: EntityHashSet,
}

#[derive(Component)]
pub(crate) struct Bar;

fn steer(keys: Res<ButtonInput<KeyCode>>, mut gliders: Query<&mut Glider>) {
    let held = |pair: [KeyCode; 2]| f32::from(keys.any_pressed(pair));
    let x = held([KeyCode::KeyD, KeyCode::ArrowRight]) - held([KeyCode::KeyA, KeyCode::ArrowLeft]);
    let y = held([KeyCode::KeyW, KeyCode::ArrowUp]) - held([KeyCode::KeyS, KeyCode::ArrowDown]);
    for mut glider in &mut gliders {
        glider.velocity = Vec3::new(x, 0.0, -y).clamp_length_max(1.0) * SPEED;
    }
}

fn turn_bar(keys: Res<ButtonInput<KeyCode>>, mut bars: Query<&mut AngularVelocity, With<Bar>>) {
    let turn = f32::from(keys.pressed(KeyCode::KeyQ)) - f32::from(keys.pressed(KeyCode::KeyE));
    for mut spin in &mut bars {
        spin.0 = Vec3::Y * turn;
    }
}

fn slide(
    mut gliders: Query<(Entity, &mut Glider, &Collider, &mut Transform)>,
    mover: MoveAndSlide,
    time: Res<Time>,
) {
    for (entity, mut glider, shape, mut transform) in &mut gliders {
        let mut touched = EntityHashSet::default();
        let moved = mover.move_and_slide(
            shape,
            transform.translation,
            transform.rotation,
            glider.velocity,
            time.delta(),
            &MoveAndSlideConfig::default(),
            &SpatialQueryFilter::from_excluded_entities([entity]),
            |hit| {
                touched.insert(hit.entity);
                MoveAndSlideHitResponse::Accept
            },
        );
        transform.translation = moved.position;
        glider.touched = touched;
    }
}

fn show_touched(gliders: Query<&Glider>, names: Query<&Name>, mut readout: Single<&mut Text, With<Readout>>) {
    for glider in &gliders {
        let mut touched: Vec<&str> =
            glider.touched.iter().filter_map(|entity| names.get(*entity).ok()).map(Name::as_str).collect();
        touched.sort_unstable();
        readout.0 = format!("touches: {}", touched.join(", "));
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let [grey, blue, amber] = [[0.5, 0.55, 0.6], [0.3, 0.5, 0.8], [0.9, 0.6, 0.2]]
        .map(|c| materials.add(Color::srgb_from_array(c)));
    commands.spawn((
        Glider::default(),
        RigidBody::Kinematic,
        Collider::capsule(0.4, 1.0),
        Transform::from_xyz(-4.0, 1.0, 0.0),
        TransformInterpolation,
        Mesh3d(meshes.add(Capsule3d::new(0.4, 1.0))),
        MeshMaterial3d(blue),
    ));
    let mut block = |name: &'static str, size: Vec3, place: Transform| {
        (
            Name::new(name),
            Collider::cuboid(size.x, size.y, size.z),
            place,
            Mesh3d(meshes.add(Cuboid::from_size(size))),
        )
    };
    let sides = [
        ("left", Vec3::new(0.5, 2.0, 10.0), Vec3::new(-9.0, 1.0, 0.0)),
        ("right", Vec3::new(0.5, 2.0, 10.0), Vec3::new(9.0, 1.0, 0.0)),
        ("back", Vec3::new(18.0, 2.0, 0.5), Vec3::new(0.0, 1.0, -5.0)),
        ("front", Vec3::new(18.0, 2.0, 0.5), Vec3::new(0.0, 1.0, 5.0)),
        ("block", Vec3::new(2.0, 2.0, 2.0), Vec3::new(5.0, 1.0, 2.0)),
    ];
    for (name, size, place) in sides {
        let wall = block(name, size, Transform::from_translation(place));
        commands.spawn((RigidBody::Static, wall, MeshMaterial3d(grey.clone())));
    }
    let wedge = Transform::from_xyz(6.0, 1.0, -3.5).with_rotation(Quat::from_rotation_y(0.6));
    let wedge = block("wedge", Vec3::new(5.0, 2.0, 0.5), wedge);
    commands.spawn((RigidBody::Static, wedge, MeshMaterial3d(grey)));
    let bar = block("bar", Vec3::new(5.0, 2.0, 0.6), Transform::from_xyz(0.0, 1.0, 0.0));
    commands.spawn((Bar, RigidBody::Kinematic, bar, MeshMaterial3d(amber)));
}
