//! One of each joint. From the left: a board welded to a post, a weight on a rope, a lift that goes up and down between its limits, a
//! wheel that spins, and a flap that a motor holds at an angle. Lines show anchors, axes and limits.
//!
//! `cargo run --release -p examples2d --example joint_motors`

use avian2d::prelude::*;
use bevy::prelude::*;
use examples2d::Scenery;

/// The joint of the lift.
#[derive(Component)]
struct Lift;

/// On the screen.
const HINT: &str = "\
From the left: a weld, a rope, a lift between limits, a wheel with a motor, a flap held by a motor.";

fn main() {
    App::new()
        .add_plugins((
            DefaultPlugins,
            PhysicsPlugins::default(),
            PhysicsDebugPlugin,
            Scenery::default().with_hint(HINT),
        ))
        .add_systems(Startup, setup)
        .add_systems(FixedUpdate, call_lift)
        .run();
}

/// Spawns boxes.
struct Workshop<'a, 'w, 's> {
    commands: &'a mut Commands<'w, 's>,
    meshes: &'a mut Assets<Mesh>,
    material: Handle<ColorMaterial>,
}

impl Workshop<'_, '_, '_> {
    fn post(&mut self, x: f32) -> Entity {
        self.commands.spawn((RigidBody::Static, Transform::from_xyz(x, 6.0, 0.0))).id()
    }

    fn block(&mut self, x: f32, y: f32, size: Vec2) -> Entity {
        let block = (
            RigidBody::Dynamic,
            Collider::rectangle(size.x, size.y),
            Transform::from_xyz(x, y, 0.0),
            Mesh2d(self.meshes.add(Rectangle::from_size(size))),
            MeshMaterial2d(self.material.clone()),
        );
        self.commands.spawn(block).id()
    }
}

fn setup(
    mut commands: Commands,
    mut meshes: ResMut<Assets<Mesh>>,
    mut materials: ResMut<Assets<ColorMaterial>>,
) {
    let material = materials.add(Color::srgb(0.3, 0.5, 0.7));
    let mut shop = Workshop { commands: &mut commands, meshes: &mut meshes, material };

    let (post, board) = (shop.post(-9.0), shop.block(-8.0, 6.0, Vec2::new(2.0, 0.3)));
    shop.commands.spawn(FixedJoint::new(post, board).with_anchor(Vec2::new(-9.0, 6.0)));

    let (post, weight) = (shop.post(-5.0), shop.block(-3.5, 6.0, Vec2::splat(0.8)));
    shop.commands.spawn((
        DistanceJoint::new(post, weight).with_local_anchor2(Vec2::Y * 0.4).with_max_distance(2.5),
        JointDamping { linear: 0.1, angular: 0.5 },
    ));

    let (post, cabin) = (shop.post(-1.0), shop.block(-1.0, 6.0, Vec2::new(1.2, 0.8)));
    let spring = MotorModel::SpringDamper { frequency: 1.5, damping_ratio: 1.0 };
    let lift = PrismaticJoint::new(post, cabin).with_slider_axis(Vec2::Y).with_limits(-3.0, 2.0);
    shop.commands.spawn((lift.with_motor(LinearMotor::new(spring).with_max_force(100.0)), Lift));

    let (post, wheel) = (shop.post(3.0), shop.block(3.0, 6.0, Vec2::splat(1.4)));
    // It wants a velocity only.
    let model = MotorModel::AccelerationBased { stiffness: 0.0, damping: 5.0 };
    let motor = AngularMotor::new(model).with_target_velocity(4.0).with_max_torque(20.0);
    shop.commands.spawn(RevoluteJoint::new(post, wheel).with_motor(motor));

    let (post, flap) = (shop.post(7.0), shop.block(8.0, 6.0, Vec2::new(2.0, 0.3)));
    let motor = AngularMotor::default().with_target_position(0.6).with_max_torque(50.0);
    let flap = RevoluteJoint::new(post, flap).with_local_anchor2(Vec2::NEG_X).with_angle_limits(-1.0, 1.0);
    shop.commands.spawn(flap.with_motor(motor));
}

/// Sends the lift to the other end every three seconds.
fn call_lift(time: Res<Time>, mut lifts: Query<&mut PrismaticJoint, With<Lift>>) {
    let is_up = time.elapsed_secs() % 6.0 < 3.0;
    for mut lift in &mut lifts {
        lift.motor.target_position = if is_up { 3.0 } else { -4.0 };
    }
}
