//! Doors hinged at their edge. Bodies turn about their centre of mass, so a door needs more than an angular velocity. Look at the
//! hinges, the white posts, and at the balls that the doors sweep away. From the left: a door that follows its animated
//! `Transform`, one whose centre of mass is at its hinge, and one that hangs on a joint: balls push it open.
//!
//! `cargo run --release -p examples3d --example hinged_door`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// Width, height and thickness of a door in metres.
const SIZE: Vec3 = Vec3::new(2.0, 2.4, 0.15);
/// How far a door opens to each side, in radians.
const RANGE: f32 = 1.4;
/// Turns of the swing in rad/s.
const PACE: f32 = 1.5;

/// On the screen.
const HINT: &str = "\
Doors that turn about their edge: by Transform, by center of mass, and by a joint that balls push open.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(0.0, 7.0, 11.0), Vec3::new(0.0, 0.5, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), scenery))
        .add_systems(Startup, setup)
        .add_systems(Update, animate)
        .add_systems(FixedUpdate, (swing, drop_balls))
        .run();
}

/// A door whose `Transform` is animated.
#[derive(Component)]
struct Animated;

/// A door whose angular velocity is set.
#[derive(Component)]
struct Driven;

/// The pictures of what is spawned.
#[derive(Resource)]
struct Looks {
    ball: Mesh3d,
    red: MeshMaterial3d<StandardMaterial>,
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let panel = Mesh3d(meshes.add(Cuboid::from_size(SIZE)));
    let post = Mesh3d(meshes.add(Cuboid::new(0.2, 3.0, 0.2)));
    let wood = MeshMaterial3d(materials.add(Color::srgb(0.6, 0.45, 0.3)));
    let white = MeshMaterial3d(materials.add(Color::srgb(0.9, 0.9, 0.9)));
    let red = MeshMaterial3d(materials.add(Color::srgb(0.8, 0.3, 0.25)));
    commands.insert_resource(Looks { ball: Mesh3d(meshes.add(Sphere::new(0.25))), red });

    let hinge = |x: f32| Transform::from_xyz(x, 1.3, 0.0);
    for x in [-5.0, -0.5, 4.0] {
        commands.spawn((hinge(x), post.clone(), white.clone()));
    }
    // The origin of these doors is the hinge. The panel, with mesh and collider, is a child beside it.
    let beside = (
        Collider::cuboid(SIZE.x, SIZE.y, SIZE.z),
        Transform::from_xyz(SIZE.x * 0.5, 0.0, 0.0),
        panel.clone(),
        wood.clone(),
    );
    commands
        .spawn((Animated, RigidBody::Kinematic, FollowTransform, hinge(-5.0), Visibility::default()))
        .with_child(beside.clone());
    let at_the_hinge = (CenterOfMass::ZERO, NoAutoCenterOfMass);
    commands
        .spawn((Driven, RigidBody::Kinematic, at_the_hinge, hinge(-0.5), Visibility::default()))
        .with_child(beside.clone());

    // The origin of this one is its middle. A joint holds its edge.
    let post = commands.spawn((RigidBody::Static, hinge(4.0))).id();
    let door = commands
        .spawn((
            RigidBody::Dynamic,
            Collider::cuboid(SIZE.x, SIZE.y, SIZE.z),
            Transform::from_xyz(4.0 + SIZE.x * 0.5, 1.3, 0.0),
            panel,
            wood,
        ))
        .id();
    commands.spawn((
        RevoluteJoint::new(post, door)
            .with_local_anchor2(Vec3::NEG_X * SIZE.x * 0.5)
            .with_hinge_axis(Vec3::Y)
            .with_angle_limits(-RANGE, RANGE),
        JointDamping { linear: 0.0, angular: 0.5 },
    ));
}

/// The first door: an animation as any other.
fn animate(time: Res<Time>, mut doors: Query<&mut Transform, With<Animated>>) {
    for mut door in &mut doors {
        door.rotation = Quat::from_rotation_y(RANGE * (PACE * time.elapsed_secs()).sin());
    }
}

/// The second door: the rate at which the same angle changes.
fn swing(time: Res<Time>, mut doors: Query<&mut AngularVelocity, With<Driven>>) {
    for mut door in &mut doors {
        door.y = RANGE * PACE * (PACE * time.elapsed_secs()).cos();
    }
}

/// Throws a ball at each door, every second and a half.
fn drop_balls(time: Res<Time>, looks: Res<Looks>, mut next: Local<f32>, mut commands: Commands) {
    if time.elapsed_secs() < *next {
        return;
    }
    *next += 1.5;
    for x in [-4.0, 0.5, 5.0] {
        commands.spawn((
            RigidBody::Dynamic,
            Collider::sphere(0.25),
            LinearVelocity(Vec3::NEG_Z * 6.0),
            Transform::from_xyz(x + 0.2 * time.elapsed_secs().sin(), 1.5, 6.0),
            looks.ball.clone(),
            looks.red.clone(),
        ));
    }
}
