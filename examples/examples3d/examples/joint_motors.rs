//! One of each joint. From the left: a board welded to a post, a weight on a rope, a lift that goes up and down between its limits, a
//! wheel that spins, a door that a motor opens and closes, and an arm that hangs in a socket. Lines show anchors, axes and limits.
//!
//! `cargo run --release -p examples3d --example joint_motors`

use avian3d::prelude::*;
use bevy::prelude::*;
use examples3d::Scenery;

/// The joint of the lift.
#[derive(Component)]
struct Lift;

/// The joint of the door.
#[derive(Component)]
struct Door;

/// On the screen.
const HINT: &str = "\
From the left: a weld, a rope, a lift between limits, a wheel and a door with motors, an arm in a socket.";

fn main() {
    let scenery =
        Scenery::new(Vec3::new(0.0, 6.0, 17.0), Vec3::new(0.0, 3.0, 0.0)).with_floor().with_hint(HINT);
    App::new()
        .add_plugins((DefaultPlugins, PhysicsPlugins::default(), PhysicsDebugPlugin, scenery))
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, (call_lift, open_door))
        .run();
}

/// Spawns posts and boxes.
struct Workshop<'a, 'w, 's> {
    commands: &'a mut Commands<'w, 's>,
    meshes: &'a mut Assets<Mesh>,
    material: Handle<StandardMaterial>,
}

impl Workshop<'_, '_, '_> {
    fn post(&mut self, x: f32) -> Entity {
        self.commands.spawn((RigidBody::Static, Transform::from_xyz(x, 4.0, 0.0))).id()
    }

    fn block(&mut self, at: Vec3, size: Vec3) -> Entity {
        let block = (
            RigidBody::Dynamic,
            Collider::cuboid(size.x, size.y, size.z),
            Transform::from_translation(at),
            Mesh3d(self.meshes.add(Cuboid::from_size(size))),
            MeshMaterial3d(self.material.clone()),
        );
        self.commands.spawn(block).id()
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<StandardMaterial>>,
) {
    let material = materials.add(Color::srgb(0.3, 0.5, 0.7));
    let mut shop = Workshop { commands: &mut commands, meshes: &mut meshes, material };

    let (post, board) = (shop.post(-9.0), shop.block(Vec3::new(-8.0, 4.0, 0.0), Vec3::new(2.0, 0.3, 0.8)));
    shop.commands.spawn(FixedJoint::new(post, board).with_anchor(Vec3::new(-9.0, 4.0, 0.0)));

    let (post, weight) = (shop.post(-5.5), shop.block(Vec3::new(-4.0, 4.0, 0.0), Vec3::splat(0.8)));
    shop.commands.spawn((
        DistanceJoint::new(post, weight).with_local_anchor2(Vec3::Y * 0.4).with_max_distance(2.0),
        JointDamping { linear: 0.1, angular: 0.5 },
    ));

    let (post, cabin) = (shop.post(-2.0), shop.block(Vec3::new(-2.0, 4.0, 0.0), Vec3::new(1.2, 0.8, 1.2)));
    let spring = MotorModel::SpringDamper { frequency: 1.5, damping_ratio: 1.0 };
    let lift = PrismaticJoint::new(post, cabin).with_slider_axis(Vec3::Y).with_limits(-2.5, 2.0);
    shop.commands.spawn((lift.with_motor(LinearMotor::new(spring).with_max_force(100.0)), Lift));

    let (post, wheel) = (shop.post(1.5), shop.block(Vec3::new(1.5, 4.0, 0.0), Vec3::new(1.4, 1.4, 0.4)));
    // It wants a velocity only.
    let model = MotorModel::AccelerationBased { stiffness: 0.0, damping: 5.0 };
    let motor = AngularMotor::new(model).with_target_velocity(4.0).with_max_torque(20.0);
    shop.commands.spawn(RevoluteJoint::new(post, wheel).with_motor(motor));

    let (post, door) = (shop.post(4.5), shop.block(Vec3::new(5.5, 4.0, 0.0), Vec3::new(2.0, 3.0, 0.2)));
    let hinge = RevoluteJoint::new(post, door).with_local_anchor2(Vec3::NEG_X).with_hinge_axis(Vec3::Y);
    let motor = AngularMotor::new(spring).with_max_torque(50.0);
    shop.commands.spawn((hinge.with_angle_limits(-1.5, 1.5).with_motor(motor), Door));

    let (post, arm) = (shop.post(9.0), shop.block(Vec3::new(9.0, 5.0, 0.0), Vec3::new(0.3, 2.0, 0.3)));
    let socket = SphericalJoint::new(post, arm).with_local_anchor2(Vec3::NEG_Y);
    shop.commands.spawn(socket.with_swing_limits(0.0, 0.8).with_twist_limits(-0.5, 0.5));
}

/// Sends the lift to the other end every three seconds.
fn call_lift(time: Res<Time>, mut lifts: Query<&mut PrismaticJoint, With<Lift>>) {
    let is_up = time.elapsed_secs() % 6.0 < 3.0;
    for mut lift in &mut lifts {
        lift.motor.target_position = if is_up { 3.0 } else { -3.0 };
    }
}

/// Opens and closes the door.
fn open_door(time: Res<Time>, mut doors: Query<&mut RevoluteJoint, With<Door>>) {
    for mut door in &mut doors {
        door.motor.target_position = (0.5 * time.elapsed_secs()).sin();
    }
}
