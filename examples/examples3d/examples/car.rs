//! A car on four rays. Look at the wheels: each is a ray down to the ground with a spring and a damper, and pushes at the chassis
//! where the ray hits. Tires hold up to the load that they bear. W and S or up and down drive, A and D or left and right steer,
//! space brakes.
//!
//! `cargo run --release -p examples3d --example car`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::{Readout, Scenery};

/// On the screen.
const HINT: &str = "\
Each wheel is a ray to the ground with a spring and a damper. Tires slip when the force exceeds their load.
Up, Down or W, S: drive. Left, Right or A, D: steer. Space: brake.";

/// Of the chassis, in metres.
const SIZE: Vec3 = Vec3::new(1.6, 0.5, 3.6);
/// Half the distances of the wheels across and along, in metres.
const AXLES: (f32, f32) = (0.9, 1.3);
/// Radius of a wheel, and length of a spring without load, in metres.
const WHEEL: (f32, f32) = (0.4, 0.5);
/// Of a spring in N/m, of a damper in N·s/m. With a quarter of 864 kg it oscillates at 1.5 Hz, and stops soon.
const SUSPENSION: (f32, f32) = (20_000.0, 2500.0);
/// Accelerations of motor and brakes in m/s².
const DRIVE: (f32, f32) = (5.0, 9.0);
/// Largest angle of the front wheels in radians.
const STEERING: f32 = 0.5;
/// Side of the ground in metres.
const GROUND: f32 = 120.0;

fn main() {
    App::new().add_plugins((DefaultPlugins, plugin)).run();
}

pub(crate) fn plugin(app: &mut App) {
    let scenery = Scenery::new(Vec3::new(0.0, 6.0, 12.0), Vec3::ZERO).with_hint(HINT);
    app.add_plugins((PhysicsPlugins::default(), scenery))
        .add_systems(Startup, (build_ground, build_car))
        .add_systems(Update, (read_keys, follow))
        .add_systems(FixedUpdate, drive);
}

/// What the keys ask for, each from -1 to 1.
#[derive(Component, Default)]
pub(crate) struct Car {
    throttle: f32,
    steering: f32,
    brake: f32,
}

/// Where the spring begins, in the frame of the car.
#[derive(Component)]
struct Wheel(Vec3);

fn read_keys(keys: Res<ButtonInput<KeyCode>>, time: Res<Time>, mut car: Single<&mut Car>) {
    let pressed = |arrow, letter| f32::from(keys.any_pressed([arrow, letter]));
    car.throttle = pressed(KeyCode::ArrowUp, KeyCode::KeyW) - pressed(KeyCode::ArrowDown, KeyCode::KeyS);
    car.brake = f32::from(keys.pressed(KeyCode::Space));
    // The wheel turns in a third of a second.
    let wanted = pressed(KeyCode::ArrowLeft, KeyCode::KeyA) - pressed(KeyCode::ArrowRight, KeyCode::KeyD);
    let most = 3.0 * time.delta_secs();
    car.steering += (wanted - car.steering).clamp(-most, most);
}

fn drive(
    queries: SpatialQuery,
    mut car: Single<(Entity, &Car, &ComputedMass, &Children, Forces)>,
    mut wheels: Query<(&Wheel, &mut Transform)>,
    time: Res<Time>,
) {
    let (entity, car, mass, children, body) = &mut *car;
    let filter = SpatialQueryFilter::from_excluded_entities([*entity]);
    let (turn, (radius, length)) = (*body.rotation(), WHEEL);
    let up = turn * Vec3::Y;
    let mut wheels = wheels.iter_many_mut(children.iter());
    while let Some((Wheel(place), mut transform)) = wheels.fetch_next() {
        let is_front = place.z < 0.0;
        let steering = Quat::from_rotation_y(if is_front { STEERING * car.steering } else { 0.0 });
        let top = body.position().0 + turn * *place;
        let down = Dir3::new(-up).unwrap_or(Dir3::NEG_Y);
        let hit = queries.cast_ray(top, down, length + radius, true, &filter);
        let reach = hit.map_or(length + radius, |hit| hit.distance);
        (transform.translation, transform.rotation) = (*place - Vec3::Y * (reach - radius), steering);
        let Some(hit) = hit else { continue };

        let contact = top - up * hit.distance;
        let velocity = body.velocity_at_point(contact);
        let (stiffness, damping) = SUSPENSION;
        let load = (stiffness * (length + radius - reach) - damping * velocity.dot(up)).max(0.0);
        // What a quarter of the car needs to change its speed within this step.
        let stop = 0.25 * mass.value() / time.delta_secs();
        let forward = (turn * steering * Vec3::NEG_Z).reject_from(hit.normal).normalize_or_zero();
        let side = forward.cross(hit.normal);
        let speed = velocity.dot(forward);
        let quarter = 0.25 * mass.value();
        let most = quarter * DRIVE.1 * car.brake.max(0.05);
        let motor = quarter * DRIVE.0 * car.throttle - (speed * stop).clamp(-most, most);
        // Half, so that four wheels together do not stop more than there is.
        let grip = -0.5 * stop * velocity.dot(side);
        let tire = (forward * motor + side * grip).clamp_length_max(load);
        body.apply_force_at_point(up * load + tire, contact);
    }
}

/// The camera stays behind the car.
fn follow(
    car: Single<(&Transform, &LinearVelocity), With<Car>>,
    mut camera: Single<&mut Transform, (With<Camera3d>, Without<Car>)>,
    mut readout: Single<&mut Text, With<Readout>>,
    time: Res<Time>,
) {
    let (car, velocity) = *car;
    let behind = car.rotation * Vec3::Z;
    let place = car.translation + behind.with_y(0.0).normalize_or(Vec3::Z) * 9.0 + Vec3::Y * 4.0;
    let share = 1.0 - (-4.0 * time.delta_secs()).exp();
    camera.translation = camera.translation.lerp(place, share);
    camera.look_at(car.translation + Vec3::Y, Vec3::Y);
    readout.0 = format!("{:.0} km/h", 3.6 * velocity.length());
}

/// Height of the ground: hills that begin some metres from the start.
fn height(x: f32, z: f32) -> f32 {
    let far = ((x.hypot(z) - 10.0) / 20.0).clamp(0.0, 1.0);
    far * (1.5 + 1.5 * (0.17 * x).sin() * (0.13 * z).cos() + 0.2 * (0.6 * x + 0.4 * z).sin())
}

fn build_ground(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    // As many points along each side for the collider as for the mesh.
    let count = 121u16;
    let at = |i: u16| GROUND * (f32::from(i) / f32::from(count - 1) - 0.5);
    let heights = (0..count).map(|i| (0..count).map(|j| height(at(i), at(j))).collect()).collect();
    let plane = Plane3d::default().mesh().size(GROUND, GROUND).subdivisions(u32::from(count) - 2);
    let mut mesh = plane.build();
    if let Some(bevy::mesh::VertexAttributeValues::Float32x3(points)) =
        mesh.attribute_mut(Mesh::ATTRIBUTE_POSITION)
    {
        points.iter_mut().for_each(|point| point[1] = height(point[0], point[2]));
    }
    commands.spawn((
        RigidBody::Static,
        Collider::heightfield(heights, Vec3::new(GROUND, 1.0, GROUND)),
        Mesh3d(meshes.add(mesh.with_computed_smooth_normals())),
        MeshMaterial3d(materials.add(Color::srgb(0.35, 0.5, 0.35))),
    ));
    let (cube, amber) = (meshes.add(Cuboid::default()), materials.add(Color::srgb(0.9, 0.6, 0.2)));
    for (x, y) in (0..12).map(|i| (i % 4, i / 4)) {
        commands.spawn((
            RigidBody::Dynamic,
            Collider::cuboid(1.0, 1.0, 1.0),
            ColliderDensity(10.0),
            Transform::from_xyz(1.1 * x as f32 + 4.0, 0.5 + y as f32, -8.0),
            Mesh3d(cube.clone()),
            MeshMaterial3d(amber.clone()),
        ));
    }
}

fn build_car(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let (radius, _) = WHEEL;
    let tire = meshes.add(Mesh::from(Cylinder::new(radius, 0.3)).rotated_by(Quat::from_rotation_z(1.57)));
    let black = materials.add(Color::srgb(0.1, 0.1, 0.1));
    let mut car = commands.spawn((
        Car::default(),
        RigidBody::Dynamic,
        Collider::cuboid(SIZE.x, SIZE.y, SIZE.z),
        ColliderDensity(300.0),
        // Heavy at the bottom, so that it slips before it tips over.
        (CenterOfMass(Vec3::new(0.0, -0.3, 0.0)), NoAutoCenterOfMass),
        LinearDamping(0.1),
        SleepingDisabled,
        TransformInterpolation,
        Transform::from_xyz(0.0, 1.0, 0.0),
        Mesh3d(meshes.add(Cuboid::from_size(SIZE))),
        MeshMaterial3d(materials.add(Color::srgb(0.8, 0.25, 0.2))),
    ));
    let (x, z) = AXLES;
    for place in [(-x, -z), (x, -z), (-x, z), (x, z)].map(|(x, z)| Vec3::new(x, 0.0, z)) {
        car.with_child((
            Wheel(place),
            Mesh3d(tire.clone()),
            MeshMaterial3d(black.clone()),
            Transform::default(),
        ));
    }
}
