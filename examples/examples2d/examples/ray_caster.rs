//! A ray and a cast disc turn with a kinematic body. Look at the red ray: it stops at the first box, and an arrow shows
//! the normal there. The blue disc is drawn where it first touches something. The boxes fall, and are hit where they
//! are.
//!
//! `cargo run --release -p examples2d --example ray_caster`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// On the screen.
const HINT: &str = "\
The red ray stops at the first box. The blue disc stops where it first touches something.";

fn main() {
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), Scenery::with_floor().with_hint(HINT)))
        .add_systems(Startup, setup)
        .add_systems(Update, (draw_ray, draw_disc))
        .run();
}

const RADIUS: f32 = 0.4;

fn draw_ray(rays: Query<(&RayCaster, &RayHits)>, mut gizmos: Gizmos) {
    for (ray, hits) in &rays {
        let end = hits.first().map_or(20.0, |hit| hit.distance);
        gizmos.line_2d(ray.global_origin(), ray.get_global_point(end), Color::srgb(1.0, 0.2, 0.2));
        if let Some(hit) = hits.first() {
            let at = ray.get_global_point(hit.distance);
            gizmos.arrow_2d(at, at + hit.normal, Color::srgb(1.0, 0.8, 0.2));
        }
    }
}

fn draw_disc(discs: Query<(&ShapeCaster, &ShapeHits)>, mut gizmos: Gizmos) {
    for (disc, hits) in &discs {
        let way = hits.first().map_or(20.0, |hit| hit.distance);
        let at = disc.global_origin() + *disc.global_direction() * way;
        gizmos.line_2d(disc.global_origin(), at, Color::srgb(0.3, 0.5, 1.0));
        gizmos.circle_2d(at, RADIUS, Color::srgb(0.3, 0.5, 1.0));
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let disc = ShapeCaster::new(Collider::circle(RADIUS), Vec2::ZERO, 0.0, Dir2::NEG_X).with_max_hits(1);
    commands.spawn((
        RigidBody::Kinematic,
        AngularVelocity(0.5),
        Transform::from_xyz(0.0, 3.0, 0.0),
        RayCaster::new(Vec2::ZERO, Dir2::X).with_max_hits(1),
        disc,
    ));
    let square = meshes.add(Rectangle::new(0.8, 0.8));
    let color = materials.add(Color::srgb(0.9, 0.6, 0.2));
    for i in 0..24 {
        let angle = core::f32::consts::TAU * i as f32 / 24.0;
        commands.spawn((
            RigidBody::Dynamic,
            Collider::rectangle(0.8, 0.8),
            GravityScale(0.05),
            Transform::from_xyz(5.0 * angle.cos(), 3.0 + 5.0 * angle.sin(), 0.0),
            Mesh2d(square.clone()),
            MeshMaterial2d(color.clone()),
        ));
    }
}
