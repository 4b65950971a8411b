//! What apps and crates written for Avian 0.7 rely on, beyond names: when plugins and schedules exist, and
//! what counts in which step. `docs/switching.md` lists the points.

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
    is_rolled_back::<avian::dynamics::solver::joint_graph::JointGraph>();
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
fn moved_in_the_same_step<M>(
    kind: RigidBody,
    system: impl IntoScheduleConfigs<ScheduleSystem, M>,
) -> avian::math::Scalar {
    let mut app = app();
    app.add_systems(PhysicsSchedule, system);
    app.finish();
    app.cleanup();
    let body = app.world_mut().spawn((kind, unit_box())).id();
    step(&mut app);
    app.world().get::<Position>(body).expect("bodies have one").dot(Vector::X)
}

fn push(mut bodies: Query<&mut LinearVelocity>) {
    bodies.iter_mut().for_each(|mut velocity| velocity.0 = Vector::X);
}

/// A kinematic body rests when the step begins.
#[test]
fn velocities_written_before_the_solver_count_in_the_same_step() {
    for kind in [RigidBody::Dynamic, RigidBody::Kinematic] {
        let between = push.after(PhysicsStepSystems::NarrowPhase).before(PhysicsStepSystems::Solver);
        let moved = [
            moved_in_the_same_step(kind, push.before(PhysicsStepSystems::First)),
            moved_in_the_same_step(kind, push.in_set(NarrowPhaseSystems::Last)),
            moved_in_the_same_step(kind, between),
        ];
        assert!(moved.iter().all(|moved| (moved - 0.016).abs() < 1.0e-6), "{kind:?}: {moved:?}");
    }
}

/// What stands on such a platform is carried, asleep or not.
#[test]
fn a_platform_that_is_pushed_within_each_step_carries_what_sleeps_on_it() {
    #[derive(Resource, Default)]
    struct Speed(Vector);
    let mut app = app();
    app.insert_resource(Gravity(Vector::Y * -9.81)).init_resource::<Speed>();
    let drive = |speed: Res<Speed>, mut bodies: Query<(&RigidBody, &mut LinearVelocity)>| {
        for (kind, mut velocity) in &mut bodies {
            if kind.is_kinematic() {
                velocity.0 = speed.0;
            }
        }
    };
    let stop = |mut bodies: Query<(&RigidBody, &mut LinearVelocity)>| {
        for (kind, mut velocity) in &mut bodies {
            if kind.is_kinematic() {
                velocity.0 = Vector::ZERO;
            }
        }
    };
    app.add_systems(PhysicsSchedule, drive.in_set(NarrowPhaseSystems::Last));
    app.add_systems(PhysicsSchedule, stop.in_set(PhysicsStepSystems::Last));
    let platform = app.world_mut().spawn((RigidBody::Kinematic, unit_box())).id();
    let rider = (RigidBody::Dynamic, unit_box(), Transform::from_xyz(0.0, 1.0, 0.0));
    let rider = app.world_mut().spawn(rider).id();
    (0..120).for_each(|_| step(&mut app));
    assert!(app.world().entity(rider).contains::<Sleeping>());
    app.world_mut().resource_mut::<Speed>().0 = Vector::X * 0.5;
    (0..125).for_each(|_| step(&mut app));
    let x = |body: Entity| app.world().get::<Position>(body).expect("bodies have one").dot(Vector::X);
    assert!((x(platform) - 1.0).abs() < 1.0e-4, "the platform is at {}", x(platform));
    // Friction takes v² / (2 μ g) = 26 mm to bring it to the platform's speed.
    assert!((x(rider) - 0.9745).abs() < 0.003, "the rider is at {}", x(rider));
}

#[test]
fn a_pose_written_before_the_first_set_counts_in_the_same_step() {
    let place = |mut bodies: Query<&mut Position>| {
        bodies.iter_mut().for_each(|mut position| position.0 = Vector::X * 2.0);
    };
    let moved = moved_in_the_same_step(RigidBody::Dynamic, place.before(PhysicsStepSystems::First));
    assert!((moved - 2.0).abs() < 1.0e-6, "{moved}");
}

#[test]
fn forces_before_the_first_set_count_in_the_same_step() {
    fn accelerate(mut bodies: Query<Forces>) {
        bodies.iter_mut().for_each(|mut forces| forces.apply_linear_acceleration(Vector::X * 60.0));
    }
    let moved = moved_in_the_same_step(RigidBody::Dynamic, accelerate.before(PhysicsStepSystems::First));
    // a t²/2, and a little more, as velocities change at the start of each substep.
    assert!(moved > 0.5 * 60.0 * 0.016 * 0.016 && moved < 60.0 * 0.016 * 0.016, "{moved}");
}

#[test]
fn a_transform_written_before_physics_counts_in_the_same_step() {
    let mut app = app();
    let shift = |mut bodies: Query<&mut Transform, With<RigidBody>>| {
        bodies.iter_mut().for_each(|mut transform| transform.translation.x += 2.0);
    };
    app.add_systems(Update, shift.before(PhysicsSystems::First));
    let body = app.world_mut().spawn((RigidBody::Dynamic, unit_box())).id();
    for expected in [2.0, 4.0] {
        step(&mut app);
        let x = app.world().get::<Position>(body).expect("bodies have one").dot(Vector::X);
        assert!((x - expected).abs() < 1.0e-6, "{x}, not {expected}");
    }
}

#[derive(Resource, Default)]
struct Runs(u32);

/// Sets of the step are sets of `PhysicsSchedule` only. In another schedule they order nothing, and
/// the system runs.
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

#[test]
fn what_the_prelude_has_is_at_its_path_too() {
    use avian::{
        collision::{
            collider::constructor::{ColliderConstructor, ColliderConstructorHierarchy},
            contact_types::ContactGraph,
            hooks::CollisionHooks,
        },
        debug_render::{DebugRender, PhysicsDebugPlugin, PhysicsGizmoExt, PhysicsGizmos},
        dynamics::rigid_body::sleeping::{SleepThreshold, Sleeping, SleepingDisabled, TimeToSleep},
        schedule::PhysicsTime,
    };
    fn named<T>() {}
    named::<(ContactGraph, ColliderConstructor, ColliderConstructorHierarchy)>();
    named::<(DebugRender, PhysicsDebugPlugin, PhysicsGizmos)>();
    named::<(SleepThreshold, Sleeping, SleepingDisabled, TimeToSleep)>();
    fn draws<G: PhysicsGizmoExt>() {}
    let _ = draws::<bevy_gizmos::prelude::Gizmos<'static, 'static, PhysicsGizmos>>;
    fn is_clock<C: PhysicsTime>() {}
    is_clock::<Time<Physics>>();
    // Hooks only read.
    fn reads<P: bevy_ecs::system::ReadOnlySystemParam>() {}
    fn hooks_read<H: CollisionHooks>() {
        reads::<H>();
    }
    hooks_read::<()>();
}
