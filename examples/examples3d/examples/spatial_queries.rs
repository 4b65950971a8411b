//! Queries around a turning arm. Look at the red ray: it ends at the first box or ball it hits, with the normal there.
//! The blue ball is cast from the arm's end downwards, and drawn where it would land. What is within 1 m of the white
//! point is lit up.
//!
//! `cargo run --release -p examples3d --example spatial_queries`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// On the screen.
const HINT: &str = "\
The red ray ends at what it hits. The blue ball is drawn where it would land.
What is in the white ball is lit.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(0.0, 6.0, 11.0), Vec3::new(0.0, 0.5, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .add_systems(Update, (draw_casters, light_up))
        .run();
}

const RADIUS: f32 = 0.3;

fn draw_casters(
    rays: Query<(&RayCaster, &RayHits)>,
    shapes: Query<(&ShapeCaster, &ShapeHits)>,
    mut gizmos: Gizmos,
) {
    for (ray, hits) in &rays {
        let end = hits.first().map_or(20.0, |hit| hit.distance);
        gizmos.line(ray.global_origin(), ray.get_global_point(end), Color::srgb(1.0, 0.2, 0.2));
        if let Some(hit) = hits.first() {
            let at = ray.get_global_point(hit.distance);
            gizmos.arrow(at, at + hit.normal * 0.7, Color::srgb(1.0, 0.8, 0.2));
        }
    }
    for (shape, hits) in &shapes {
        let way = hits.first().map_or(0.0, |hit| hit.distance);
        let at = shape.global_origin() + *shape.global_direction() * way;
        gizmos.line(shape.global_origin(), at, Color::srgb(0.3, 0.5, 1.0));
        gizmos.sphere(at, RADIUS, Color::srgb(0.3, 0.5, 1.0));
    }
}

/// Asks for all colliders that a ball overlaps, in a system of the app.
fn light_up(
    queries: SpatialQuery,
    arms: Query<&ShapeCaster>,
    bodies: Query<&MeshMaterial3d<StandardMaterial>, With<RigidBody>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
    mut gizmos: Gizmos,
) {
    let Ok(arm) = arms.single() else { return };
    let center = arm.global_origin().with_y(0.5);
    gizmos.sphere(center, 1.0, Color::WHITE);
    let ball = Collider::sphere(1.0);
    let found =
        queries.shape_intersections(&ball, center, Quat::IDENTITY, &SpatialQueryFilter::from_mask(0b10));
    for material in &bodies {
        if let Some(mut material) = materials.get_mut(&material.0) {
            material.emissive = LinearRgba::BLACK;
        }
    }
    for material in bodies.iter_many(found) {
        if let Some(mut material) = materials.get_mut(&material.0) {
            material.emissive = LinearRgba::rgb(0.5, 0.5, 0.0);
        }
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    commands.spawn((
        RigidBody::Kinematic,
        AngularVelocity(Vec3::Y * 0.5),
        Transform::from_xyz(0.0, 0.6, 0.0),
        RayCaster::new(Vec3::X * 0.2, Dir3::X).with_max_hits(1),
        ShapeCaster::new(Collider::sphere(RADIUS), Vec3::new(0.0, 3.0, 3.0), Quat::IDENTITY, Dir3::NEG_Y)
            .with_max_hits(1),
    ));
    let layers = CollisionLayers::new(0b10, LayerMask::ALL);
    for i in 0..12 {
        let angle = core::f32::consts::TAU * i as f32 / 12.0;
        let place = Vec3::new(angle.cos(), 0.0, angle.sin()) * if i % 2 == 0 { 3.0 } else { 4.5 };
        let material = MeshMaterial3d(materials.add(Color::hsl(30.0 * i as f32, 0.5, 0.6)));
        let (mesh, collider) = match i % 3 {
            0 => (meshes.add(Sphere::new(0.5)), Collider::sphere(0.5)),
            _ => (meshes.add(Cuboid::from_length(1.0)), Collider::cuboid(1.0, 1.0, 1.0)),
        };
        let place = Transform::from_translation(place + Vec3::Y * 0.5);
        commands.spawn((RigidBody::Dynamic, layers, collider, place, Mesh3d(mesh), material));
    }
}
