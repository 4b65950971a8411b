//! 3D snippets of Avian's announcements. `mission_dim2.rs` has those of 2D.

use avian::{math::Vector, parry::shape::TypedShape, prelude::*};
use bevy_math::{Quat, Vec3, primitives as shapes};

/// A ball of a radius.
pub const BALL: fn(f32) -> Collider = Collider::sphere;
/// A cube of a side.
pub const CUBE: fn(f32) -> Collider = |side| Collider::cuboid(side, side, side);

#[test]
fn two_turns_of_45_degrees_turn_x_to_y() {
    let rotation = Rotation(Quat::from_rotation_z(core::f32::consts::FRAC_PI_4));
    assert!((rotation * rotation * Vec3::X - Vec3::Y).length() < 1e-6);
}

#[test]
fn cylinders_and_cones_take_a_radius_and_then_a_height() {
    let cylinder = Collider::cylinder(0.5, 2.0);
    let TypedShape::Cylinder(shape) = cylinder.shape().as_typed_shape() else { panic!("a cylinder") };
    assert_eq!((shape.radius, shape.half_height), (0.5, 1.0));
    let cone = Collider::cone(0.5, 2.0);
    let TypedShape::Cone(shape) = cone.shape().as_typed_shape() else { panic!("a cone") };
    assert_eq!((shape.radius, shape.half_height), (0.5, 1.0));
}

#[test]
fn every_primitive_is_a_collider() {
    let same = |a: Collider, b: Collider| {
        let bounds = |c: &Collider| c.shape().compute_local_aabb();
        let (a, b) = (bounds(&a), bounds(&b));
        assert!((a.mins - b.mins).length() < 1e-6 && (a.maxs - b.maxs).length() < 1e-6, "{a:?} is not {b:?}");
    };
    same(shapes::Sphere::new(0.5).into(), Collider::sphere(0.5));
    same(shapes::Cuboid::new(1.0, 2.0, 3.0).into(), Collider::cuboid(1.0, 2.0, 3.0));
    same(shapes::Capsule3d::new(0.3, 1.0).into(), Collider::capsule(0.3, 1.0));
    same(shapes::Cylinder::new(0.5, 2.0).into(), Collider::cylinder(0.5, 2.0));
    same(shapes::Cone { radius: 0.5, height: 2.0 }.into(), Collider::cone(0.5, 2.0));
    let (a, b, c) = (Vec3::ZERO, Vec3::X, Vec3::Y);
    same(shapes::Triangle3d::new(a, b, c).into(), Collider::triangle(a, b, c));
    same(shapes::Segment3d::new(a, b).into(), Collider::segment(a, b));
    let bounds = Collider::from(shapes::Tetrahedron::default()).shape().compute_local_aabb();
    assert!((bounds.maxs - Vector::splat(0.5)).length() < 1e-5, "{bounds:?}");
}

/// The snippets verbatim, except that items used from outside are public.
mod as_written {
    pub mod plugins {
        use avian3d::prelude::*;
        use bevy::prelude::*;

        pub fn main() {
            App::new().add_plugins((DefaultPlugins, PhysicsPlugins::default())).run();
        }
    }

    pub mod spawning {
        use avian3d::prelude::*;
        use bevy::prelude::*;

        pub fn setup(mut commands: Commands) {
            commands.spawn((RigidBody::Dynamic, Collider::sphere(0.5), LinearVelocity(Vec3::X)));
        }
    }

    pub mod speculative_margin {
        use avian3d::prelude::*;
        use bevy::prelude::*;

        pub fn setup(mut commands: Commands) {
            // Spawn a rigid body with a maximum bound for the speculative margin.
            commands.spawn((RigidBody::Dynamic, Collider::capsule(0.5, 2.0), SpeculativeMargin(2.0)));
        }
    }
}

#[test]
fn its_snippets_run_as_written() {
    // An app without a window is not closed by a user, so it exits after its first frame.
    bevy::app::TerminalCtrlCHandlerPlugin::gracefully_exit();
    as_written::plugins::main();

    use bevy::prelude::*;
    let mut app = App::new();
    app.add_plugins((DefaultPlugins, PhysicsPlugins::default()))
        .add_systems(Startup, (as_written::spawning::setup, as_written::speculative_margin::setup))
        .insert_resource(bevy::time::TimeUpdateStrategy::FixedTimesteps(1));
    app.finish();
    app.cleanup();
    for _ in 0..64 {
        app.update();
    }
    let world = app.world_mut();
    let mut bodies = world.query::<(&Collider, &Transform, &LinearVelocity)>();
    let mut seen: Vec<(f32, f32, f32)> =
        bodies.iter(world).map(|(_, at, v)| (at.translation.x, v.x, at.translation.y)).collect();
    seen.sort_by(|a, b| a.0.total_cmp(&b.0));
    // They overlap from the start and separate; together they move like the one that was pushed.
    assert_eq!(seen.len(), 2);
    assert!(seen.iter().all(|s| (-5.5..-4.0).contains(&s.2)), "they fell: {seen:?}");
    assert!(seen[1].0 > 0.5, "one was sent along x: {seen:?}");
}
