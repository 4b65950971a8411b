//! Explosions by hand: a query finds what is in a sphere, and each body gets an impulse. Look at the hut: bodies near the charge
//! fly far, those at the rim are only pushed. Space lets the charge explode, the arrow keys move it, Enter builds a new hut.
//!
//! `cargo run --release -p examples3d --example explosion`

use avian3d::prelude::*;
use bevy::{input::common_conditions::input_just_pressed, prelude::*};
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
Bodies near the charge fly far, those at the rim of its sphere are only pushed.
Space: explode. Arrow keys: move the charge. Enter: build a new hut.";

/// Radius of the sphere in metres.
const RADIUS: f32 = 4.0;
/// Impulse of a body at the charge, in N·s: 14 m/s for a brick. It falls to zero at the rim.
const BLAST: f32 = 3.0;
/// Side of a brick in metres.
const BRICK: f32 = 0.6;

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    let scenery =
        Scenery::new(Vec3::new(-8.0, 7.0, 12.0), Vec3::new(0.0, 1.0, 0.0)).with_floor().with_hint(HINT);
    app.add_plugins((PhysicsPlugins::default(), scenery))
        .insert_resource(Charge { place: Vec3::new(0.0, 0.5, 0.0), glow: 0.0 })
        .add_systems(Startup, build)
        .add_systems(Update, (move_charge, explode.run_if(input_just_pressed(KeyCode::Space)), draw).chain())
        .add_systems(Update, (clear, build).chain().run_if(input_just_pressed(KeyCode::Enter)));
}

/// Where the charge is, and what is left of its flash, from 1 to 0.
#[derive(Resource)]
struct Charge {
    place: Vec3,
    glow: f32,
}

#[derive(Component)]
pub(crate) struct Brick;

fn explode(queries: SpatialQuery, mut bodies: Query<(&Collider, Forces)>, mut charge: ResMut<Charge>) {
    charge.glow = 1.0;
    let sphere = Collider::sphere(RADIUS);
    let found =
        queries.shape_intersections(&sphere, charge.place, Quat::IDENTITY, &SpatialQueryFilter::default());
    for entity in found {
        let Ok((collider, mut body)) = bodies.get_mut(entity) else { continue };
        // Pressed where it is nearest to the charge, so that it spins.
        let (nearest, _) = collider.project_point(*body.position(), *body.rotation(), charge.place, true);
        let away = (body.position().0 - charge.place).normalize_or(Vec3::Y);
        let nearness = (1.0 - nearest.distance(charge.place) / RADIUS).max(0.0);
        body.apply_linear_impulse_at_point(away * BLAST * nearness, nearest);
    }
}

fn move_charge(keys: Res<ButtonInput<KeyCode>>, time: Res<Time>, mut charge: ResMut<Charge>) {
    let way = |more, less| f32::from(keys.pressed(more)) - f32::from(keys.pressed(less));
    let x = way(KeyCode::ArrowRight, KeyCode::ArrowLeft);
    let z = way(KeyCode::ArrowDown, KeyCode::ArrowUp);
    charge.place += Vec3::new(x, 0.0, z) * 4.0 * time.delta_secs();
    charge.glow = (charge.glow - 2.0 * time.delta_secs()).max(0.0);
}

fn draw(charge: Res<Charge>, mut gizmos: Gizmos) {
    gizmos.sphere(charge.place, 0.2, Color::srgb(1.0, 0.2, 0.1));
    gizmos.circle(
        Isometry3d::new(charge.place.with_y(0.02), Quat::from_rotation_x(core::f32::consts::FRAC_PI_2)),
        RADIUS,
        Color::srgb(0.6, 0.2, 0.1),
    );
    if charge.glow > 0.0 {
        gizmos.sphere(charge.place, RADIUS * (1.0 - charge.glow), Color::srgb(1.0, 0.8, 0.3));
    }
}

fn clear(mut commands: Commands, bricks: Query<Entity, With<Brick>>) {
    bricks.iter().for_each(|brick| commands.entity(brick).despawn());
}

/// A hut of four walls without a roof.
fn build(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let mesh = meshes.add(Cuboid::from_length(BRICK));
    let shades = [0.0, 0.1].map(|light| materials.add(Color::srgb(0.7 + light, 0.45 + light, 0.3)));
    for (x, y, z) in (0..7 * 7 * 5).map(|i| (i % 7, i / 49, i / 7 % 7)) {
        if x % 6 != 0 && z % 6 != 0 {
            continue;
        }
        commands.spawn((
            Brick,
            RigidBody::Dynamic,
            Collider::cuboid(BRICK, BRICK, BRICK),
            Transform::from_translation(BRICK * Vec3::new(x as f32 - 3.0, y as f32 + 0.5, z as f32 - 3.0)),
            Mesh3d(mesh.clone()),
            MeshMaterial3d(shades[(x + y + z) % 2].clone()),
        ));
    }
}
