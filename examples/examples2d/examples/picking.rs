//! Boxes to drag by a mouse joint, seen in perspective. Press on a box and move the pointer: the box follows, and pushes the others.
//! The camera looks at the plane from the side.
//!
//! `cargo run --release -p examples2d --example picking`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Hint;

/// On the screen.
const HINT: &str = "Drag the boxes with the mouse.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsPickingPlugin, Hint(HINT)))
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, follow)
        .add_observer(grab)
        .add_observer(let_go)
        .run();
}

/// A joint that pulls a body to the pointer.
#[derive(Component)]
struct Held {
    camera: Entity,
}

fn grab(press: On<Pointer<Press>>, bodies: Query<&RigidBody>, mut commands: Commands) {
    if let Ok(RigidBody::Dynamic) = bodies.get(press.entity)
        && let Some(point) = press.hit.position
    {
        // By the point that was pressed, with 50 times the weight of a box at most.
        let joint = MouseJoint::new(press.entity).with_anchor(point.truncate()).with_max_force(500.0);
        commands.spawn((joint, Transform::from_translation(point), Held { camera: press.hit.camera }));
    }
}

fn let_go(_: On<Pointer<Release>>, held: Query<Entity, With<Held>>, mut commands: Commands) {
    for joint in &held {
        commands.entity(joint).despawn();
    }
}

/// Moves the joint's entity, to which it pulls.
fn follow(
    window: Single<&Window>,
    cameras: Query<(&Camera, &GlobalTransform)>,
    mut held: Query<(&Held, &mut Transform)>,
) {
    let Some(cursor) = window.cursor_position() else { return };
    for (held, mut target) in &mut held {
        let Ok((camera, pose)) = cameras.get(held.camera) else { continue };
        let Ok(ray) = camera.viewport_to_world(pose, cursor) else { continue };
        if let Some(distance) = ray.intersect_plane(Vec3::ZERO, InfinitePlane3d::new(Vec3::Z)) {
            target.translation = ray.get_point(distance);
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    commands.spawn((
        Camera2d,
        Projection::Perspective(PerspectiveProjection::default()),
        Transform::from_xyz(8.0, 6.0, 20.0).looking_at(Vec3::Y * 3.0, Vec3::Y),
    ));
    let (floor, square) = (meshes.add(Rectangle::new(30.0, 1.0)), meshes.add(Rectangle::new(1.0, 1.0)));
    commands.spawn((
        RigidBody::Static,
        Collider::rectangle(30.0, 1.0),
        Transform::from_xyz(0.0, -0.5, 0.0),
        Mesh2d(floor),
        MeshMaterial2d(materials.add(Color::srgb(0.35, 0.4, 0.45))),
    ));
    for i in 0..21 {
        let hue = 360.0 * i as f32 / 21.0;
        commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(1.0, 1.0),
            Mass(1.0),
            Transform::from_xyz((i % 7) as f32 * 1.2 - 3.6, 0.5 + (i / 7) as f32, 0.0),
            Mesh2d(square.clone()),
            MeshMaterial2d(materials.add(Color::hsl(hue, 0.6, 0.6))),
        ));
    }
}
