//! What apps and crates written for Avian 0.7 rely on, beyond names: when plugins and schedules exist, and what counts in
//! which step. `docs/switching.md` lists the points.

use avian::{
    collision::narrow_phase::CollisionEventSystems,
    math::{Dir, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, schedule::IntoScheduleConfigs, system::ScheduleSystem};
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

const STEP: Duration = Duration::from_millis(16);

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)))
        .insert_resource(Gravity::ZERO);
    app
}

fn step(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(STEP);
    app.update();
}

fn point(x: f32) -> Transform {
    Transform::from_xyz(x, 0.0, 0.0)
}

/// A box of a metre.
fn unit_box() -> Collider {
    let corners = (0..1 << Vector::AXES.len()).map(|bits: usize| {
        let side = |axis: usize| if bits >> axis & 1 == 1 { 0.5 } else { -0.5 };
        Vector::AXES.iter().enumerate().map(|(i, axis)| *axis * side(i)).sum()
    });
    Collider::convex_hull(corners.collect()).expect("a box is solid")
}

#[test]
#[expect(deprecated, reason = "former names are what is asked for")]
fn former_names_are_in_the_prelude() {
    fn is<T: 'static>() {}
    is::<OnCollisionStart>();
    is::<OnCollisionEnd>();
    is::<SweptCcdSet>();
    is::<PhysicsSet>();
    is::<PhysicsStepSet>();
    is::<SolverSet>();
    is::<NarrowPhaseSet>();
    // The modules, too.
    is::<dynamics::rigid_body::RigidBody>();
    is::<spatial_query::SpatialQueryFilter>();
    is::<CollisionEventSystems>();
}

#[test]
fn schedules_and_plugins_are_there_as_soon_as_the_group_is_added() {
    let mut app = app();
    assert!(app.get_schedule(PhysicsSchedule).is_some());
    assert!(app.get_schedule_mut(SubstepSchedule).is_some());
    assert!(app.is_plugin_added::<PhysicsSchedulePlugin>());
    assert!(app.is_plugin_added::<IslandPlugin>() && app.is_plugin_added::<IslandSleepingPlugin>());
    assert!(app.is_plugin_added::<PhysicsInterpolationPlugin>());
}

#[test]
fn resources_that_apps_roll_back_are_cloned_and_have_defaults() {
    fn is_rolled_back<R: Resource + Clone + Default>() {}
    is_rolled_back::<ContactGraph>();
}

/// Trees and queries need neither narrow phase nor solver.
#[test]
fn plugins_are_added_one_by_one() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin)).add_plugins((
        PhysicsSchedulePlugin::new(Update),
        PhysicsTransformPlugin::new(Update),
        MassPropertyPlugin::new(Update),
        ColliderHierarchyPlugin,
        ColliderTransformPlugin::new(Update),
        ColliderBackendPlugin::<Collider>::new(Update),
        ColliderTreePlugin::<Collider>::default(),
        BroadPhaseCorePlugin,
        BvhBroadPhasePlugin::<()>::default(),
        SpatialQueryPlugin::new(Update),
    ));
    app.finish();
    app.cleanup();
    let body = app.world_mut().spawn((RigidBody::Kinematic, unit_box(), point(3.0))).id();
    let caster = app.world_mut().spawn((RayCaster::new(Vector::ZERO, Dir::X), point(0.0))).id();
    let distance = |app: &App| {
        let hits = app.world().get::<RayHits>(caster).expect("required by the caster");
        hits.iter().next().map(|hit| (hit.entity, (hit.distance * 100.0).round() as i32))
    };
    step(&mut app);
    step(&mut app);
    assert_eq!(distance(&app), Some((body, 250)));
    *app.world_mut().get_mut::<Transform>(body).expect("it has one") = point(7.0);
    step(&mut app);
    assert_eq!(distance(&app), Some((body, 650)));
}

#[test]
fn components_bring_what_they_require_and_apps_add_to_it() {
    let mut app = app();
    app.register_required_components::<Collider, CollisionEventsEnabled>();
    let world = app.world_mut();
    let ray = world.spawn(RayCaster::default()).id();
    let shape = world.spawn(ShapeCaster::default()).id();
    let body = world.spawn((RigidBody::Dynamic, unit_box())).id();
    let other = world.spawn((RigidBody::Static, unit_box(), point(0.9))).id();
    assert!(world.entity(ray).contains::<RayHits>() && world.entity(shape).contains::<ShapeHits>());
    assert!(world.entity(body).contains::<CollisionEventsEnabled>());
    step(&mut app);
    let begun: Vec<_> = app.world_mut().resource_mut::<Messages<CollisionStart>>().drain().collect();
    assert_eq!(begun.len(), 1);
    let pair = [begun[0].collider1, begun[0].collider2];
    assert!(pair == [body, other] || pair == [other, body], "{pair:?}");
}

/// How far a body moves in the step in which a system gives it a velocity of 1 m/s.
fn moved_in_the_same_step<M>(system: impl IntoScheduleConfigs<ScheduleSystem, M>) -> avian::math::Scalar {
    let mut app = app();
    app.add_systems(PhysicsSchedule, system);
    app.finish();
    app.cleanup();
    let body = app.world_mut().spawn((RigidBody::Dynamic, unit_box())).id();
    step(&mut app);
    app.world().get::<Position>(body).expect("bodies have one").dot(Vector::X)
}

fn push(mut bodies: Query<&mut LinearVelocity>) {
    bodies.iter_mut().for_each(|mut velocity| velocity.0 = Vector::X);
}

#[test]
fn velocities_written_before_the_solver_count_in_the_same_step() {
    let moved = [
        moved_in_the_same_step(push.before(PhysicsStepSystems::First)),
        moved_in_the_same_step(push.in_set(NarrowPhaseSystems::Last)),
        moved_in_the_same_step(
            push.after(PhysicsStepSystems::NarrowPhase).before(PhysicsStepSystems::Solver),
        ),
    ];
    for moved in moved {
        assert!((moved - 0.016).abs() < 1.0e-6, "{moved}");
    }
}

#[test]
fn a_pose_written_before_the_first_set_counts_in_the_same_step() {
    let place = |mut bodies: Query<&mut Position>| {
        bodies.iter_mut().for_each(|mut position| position.0 = Vector::X * 2.0);
    };
    let moved = moved_in_the_same_step(place.before(PhysicsStepSystems::First));
    assert!((moved - 2.0).abs() < 1.0e-6, "{moved}");
}

#[derive(Resource, Default)]
struct Runs(u32);

/// Sets of the step are sets of `PhysicsSchedule` only. In another schedule they order nothing, and the system runs.
#[test]
fn a_set_of_the_step_does_no_harm_in_another_schedule() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs(1) / 64))
        .init_resource::<Runs>()
        .add_systems(FixedUpdate, (|mut runs: ResMut<Runs>| runs.0 += 1).in_set(PhysicsStepSystems::First));
    app.finish();
    app.cleanup();
    (0..5).for_each(|_| app.update());
    assert_eq!(app.world().resource::<Runs>().0, 4, "the first frame has no delta");
}

/// The schedule of [`PhysicsPlugins::new`] is that of the casters.
#[test]
fn casters_are_updated_in_the_schedule_of_the_group() {
    let mut app = app();
    app.add_systems(
        Update,
        (|casters: Query<&RayHits>, mut runs: ResMut<Runs>| runs.0 = casters.iter().flatten().count() as u32)
            .after(SpatialQuerySystems),
    );
    app.init_resource::<Runs>();
    app.world_mut().spawn((RigidBody::Static, unit_box(), point(3.0)));
    app.world_mut().spawn((RayCaster::new(Vector::ZERO, Dir::X), point(0.0)));
    step(&mut app);
    step(&mut app);
    assert_eq!(app.world().resource::<Runs>().0, 1);
}
