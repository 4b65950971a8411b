//! Snippets of Avian's announcements, in an app.

use avian::{math::Scalar, parry::shape::TypedShape, prelude::*};
use bevy_app::{App, PluginGroup, Startup, TaskPoolPlugin};
use bevy_ecs::prelude::*;
use bevy_time::TimePlugin;
use bevy_transform::TransformPlugin;

use super::mission_dim::{BALL, CUBE};

#[test]
fn an_app_with_the_default_plugins_runs_a_body_with_a_velocity() {
    fn setup(mut commands: Commands) {
        commands.spawn((RigidBody::Dynamic, BALL(0.5), LinearVelocity(avian::math::Vector::X)));
    }
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()))
        .add_systems(Startup, setup)
        .insert_resource(bevy_time::TimeUpdateStrategy::ManualDuration(core::time::Duration::from_secs_f64(
            1.0 / 64.0,
        )));
    app.finish();
    app.cleanup();
    for _ in 0..65 {
        app.update();
    }
    let world = app.world_mut();
    let mut bodies = world.query_filtered::<(&Position, &LinearVelocity), With<RigidBody>>();
    let (position, velocity) = bodies.single(world).expect("the one body");
    assert!((position.x - 1.0).abs() < 0.05, "{position:?}");
    assert!((velocity.y + 9.81).abs() < 0.3, "{velocity:?}");
}

#[test]
fn the_length_unit_is_set_with_the_plugins() {
    let app = scenes::headless_app_with(1.0 / 60.0, 6, PhysicsPlugins::default().with_length_unit(10.0));
    assert_eq!(app.world().resource::<PhysicsLengthUnit>().0, 10.0);
    // It is a resource of its own: the last one inserted counts.
    let group = PhysicsPlugins::default().with_length_unit(10.0).build();
    let mut app = scenes::headless_app_with(1.0 / 60.0, 6, group);
    app.insert_resource(PhysicsLengthUnit(20.0));
    app.update();
    assert_eq!(app.world().resource::<PhysicsLengthUnit>().0, 20.0);
}

#[test]
fn separation_follows_from_the_deltas_of_both_bodies() {
    // The formula of the announcement. Its second `delta_position2` is an error, body 1 is meant.
    use avian::math::Vector;
    let (position1, position2) = (Vector::Y * 0.25, Vector::Y * 1.5);
    let (anchor1, anchor2) = (Vector::Y * 0.5, Vector::Y * -0.5);
    let normal = Vector::Y;
    let (delta_position1, delta_position2) = (Vector::Y * 0.125, Vector::Y * -0.0625);
    let (delta_rotation1, delta_rotation2) = (Rotation::default(), Rotation::default());
    let initial_separation = (position2 + anchor2 - position1 - anchor1).dot(normal);

    let delta_anchor1 = delta_rotation1 * anchor1 - anchor1;
    let delta_anchor2 = delta_rotation2 * anchor2 - anchor2;
    let delta_separation = (delta_position2 + delta_anchor2 - delta_position1 - delta_anchor1).dot(normal);
    let separation = initial_separation + delta_separation;

    let moved = (position2 + delta_position2 + delta_rotation2 * anchor2)
        - (position1 + delta_position1 + delta_rotation1 * anchor1);
    assert_eq!(separation, moved.dot(normal));
}

#[test]
fn capsules_take_a_radius_and_then_a_length() {
    let collider = Collider::capsule(0.5, 2.0);
    let TypedShape::Capsule(capsule) = collider.shape().as_typed_shape() else { panic!("a capsule") };
    assert_eq!((capsule.radius, capsule.segment.length()), (0.5, 2.0));
}

#[test]
fn half_spaces_are_called_half_spaces() {
    let collider = Collider::half_space(avian::math::Vector::Y);
    assert!(matches!(collider.shape().as_typed_shape(), TypedShape::HalfSpace(_)));
}

#[test]
fn a_speculative_margin_is_a_component() {
    let mut world = World::new();
    let entity = world.spawn((RigidBody::Dynamic, Collider::capsule(0.5, 2.0), SpeculativeMargin(2.0))).id();
    assert_eq!(world.get::<SpeculativeMargin>(entity).map(|m| m.0), Some(2.0));
}

#[test]
fn components_default_as_documented() {
    assert_eq!(GravityScale::default().0, 1.0);
    assert_eq!((LinearDamping::default().0, AngularDamping::default().0), (0.0, 0.0));
    assert_eq!(
        (MaxLinearSpeed::default().0, MaxAngularSpeed::default().0),
        (Scalar::INFINITY, Scalar::INFINITY)
    );
    assert_eq!(ColliderDensity::default().0, 1.0);
    assert_eq!(Dominance::default().0, 0);
    assert_eq!(TimeToSleep::default().0, 0.5);
    let threshold = SleepThreshold::default();
    assert_eq!((threshold.linear, threshold.angular), (0.15, 0.15));
    let layers = CollisionLayers::default();
    assert_eq!((layers.memberships.0, layers.filters.0), (1, u32::MAX));
    let friction = DefaultFriction::default().0;
    assert_eq!((friction.dynamic_coefficient, friction.static_coefficient), (0.5, 0.5));
    assert_eq!(friction.combine_rule, CoefficientCombine::Average);
    let restitution = DefaultRestitution::default().0;
    assert_eq!((restitution.coefficient, restitution.combine_rule), (0.0, CoefficientCombine::Average));
    assert!(RigidBody::default().is_dynamic());
    let extent = Collider::default().shape().compute_local_aabb().extents();
    assert_eq!(extent, CUBE(0.5).shape().compute_local_aabb().extents());
}

#[test]
fn neither_friction_nor_restitution_nor_events_are_put_on_bodies() {
    let mut app = scenes::headless_app(1.0 / 60.0, 4);
    let body = app.world_mut().spawn((RigidBody::Dynamic, Collider::default())).id();
    app.update();
    let body = app.world().entity(body);
    assert!(!body.contains::<Friction>() && !body.contains::<Restitution>() && !body.contains::<Sensor>());
}

#[test]
fn the_higher_rule_of_two_wins() {
    use CoefficientCombine::{Average, GeometricMean, Max, Min, Multiply};
    let order = [Average, GeometricMean, Min, Multiply, Max];
    let values: [Scalar; 5] = [0.45, (0.2 as Scalar * 0.7).sqrt(), 0.2, 0.2 * 0.7, 0.7];
    for (i, one) in order.iter().enumerate() {
        for (j, two) in order.iter().enumerate() {
            let a = Friction::new(0.2).with_combine_rule(*one);
            let b = Friction::new(0.7).with_combine_rule(*two);
            let got = a.combine(b).dynamic_coefficient;
            assert!((got - values[i.max(j)]).abs() < 1e-6, "{one:?} and {two:?} give {got}");
        }
    }
}
