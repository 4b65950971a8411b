//! When steps are taken, and the clocks: pausing, speed, stepping by hand, the order of sets.

use avian::{
    dynamics::{integrator::IntegrationSystems, solver::schedule::SubstepSolverSystems},
    prelude::*,
    schedule::{LastPhysicsTick, StepTimes},
};
use bevy_app::prelude::*;
use bevy_ecs::{
    prelude::*,
    schedule::{LogLevel, MultiThreadedExecutor, ScheduleBuildSettings, ScheduleLabel},
};
use bevy_time::{TimePlugin, TimeUpdateStrategy, prelude::*};
use bevy_transform::{TransformPlugin, TransformSystems, prelude::GlobalTransform};
use core::time::Duration;
use std::thread::ThreadId;

/// The deltas of the steps taken, each as (generic clock, physics clock).
#[derive(Resource, Default)]
struct Steps(Vec<(Duration, Duration)>);

fn note_step(mut steps: ResMut<Steps>, generic: Res<Time>, physics: Res<Time<Physics>>) {
    steps.0.push((generic.delta(), physics.delta()));
}

/// An app whose `Update` hosts physics and whose generic clock only [`tick`] moves.
fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.init_resource::<Steps>();
    app.add_systems(PhysicsSchedule, note_step.in_set(PhysicsStepSystems::First));
    app.finish();
    app.cleanup();
    app
}

fn tick(app: &mut App, millis: u64) {
    app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(millis));
    app.update();
}

fn clock(app: &mut App) -> Mut<'_, Time<Physics>> {
    app.world_mut().resource_mut::<Time<Physics>>()
}

fn steps(app: &App) -> &[(Duration, Duration)] {
    &app.world().resource::<Steps>().0
}

fn millis(count: u64) -> (Duration, Duration) {
    (Duration::from_millis(count), Duration::from_millis(count))
}

#[test]
fn every_run_of_the_host_is_one_step_of_its_delta() {
    let mut app = app();
    tick(&mut app, 10);
    tick(&mut app, 7);
    assert_eq!(steps(&app), [millis(10), millis(7)]);
    assert_eq!(clock(&mut app).elapsed(), Duration::from_millis(17));
}

#[test]
fn the_generic_clock_is_given_back() {
    let mut app = app();
    clock(&mut app).set_relative_speed(0.5);
    tick(&mut app, 10);
    let generic = app.world().resource::<Time>();
    assert_eq!(generic.delta(), Duration::from_millis(10));
    assert_eq!(generic.elapsed(), Duration::from_millis(10));
}

#[test]
fn no_time_is_no_step() {
    let mut app = app();
    app.update();
    tick(&mut app, 0);
    clock(&mut app).set_relative_speed(0.0);
    tick(&mut app, 10);
    assert_eq!(steps(&app), []);
}

#[test]
fn tiny_and_huge_deltas_are_passed_on() {
    let mut app = app();
    for delta in [Duration::from_nanos(1), Duration::from_secs(10), Duration::from_secs(1 << 40)] {
        app.world_mut().resource_mut::<Time>().advance_by(delta);
        app.update();
        assert_eq!(steps(&app).last(), Some(&(delta, delta)));
    }
}

#[test]
fn a_paused_clock_takes_no_step_and_goes_on_afterwards() {
    let mut app = app();
    tick(&mut app, 10);
    clock(&mut app).pause();
    tick(&mut app, 10);
    tick(&mut app, 10);
    assert!(clock(&mut app).is_paused());
    assert_eq!(clock(&mut app).delta(), Duration::ZERO);
    clock(&mut app).unpause();
    tick(&mut app, 5);
    assert_eq!(steps(&app), [millis(10), millis(5)]);
    assert_eq!(clock(&mut app).elapsed(), Duration::from_millis(15));
}

#[test]
fn relative_speed_scales_steps_and_not_their_number() {
    let mut app = app();
    clock(&mut app).set_relative_speed(0.5);
    tick(&mut app, 10);
    clock(&mut app).set_relative_speed(3.0);
    tick(&mut app, 10);
    assert_eq!(steps(&app), [millis(5), millis(30)]);
}

#[test]
fn speeds_that_are_no_ratio_change_nothing() {
    let mut app = app();
    for wrong in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -2.0] {
        clock(&mut app).set_relative_speed(wrong);
        tick(&mut app, 10);
    }
    assert_eq!(steps(&app), [millis(10); 4]);
}

#[test]
fn a_speed_beyond_all_clocks_does_not_panic() {
    let mut app = app();
    clock(&mut app).set_relative_speed_f64(f64::MAX);
    tick(&mut app, 10);
    tick(&mut app, 10);
    // The first step reaches the end of time; there is nothing after it.
    assert_eq!(steps(&app).len(), 1);
    assert_eq!(clock(&mut app).elapsed(), Duration::MAX);
}

#[test]
fn steps_run_by_hand_are_as_long_as_the_physics_clock_says() {
    let mut app = app();
    clock(&mut app).pause();
    for _ in 0..3 {
        clock(&mut app).advance_by(Duration::from_millis(4));
        app.world_mut().run_schedule(PhysicsSchedule);
    }
    assert!(steps(&app).iter().all(|step| step.1 == Duration::from_millis(4)));
    assert_eq!(steps(&app).len(), 3);
    // They were taken: the host does not repeat them.
    tick(&mut app, 10);
    assert_eq!(steps(&app).len(), 3);
}

#[test]
fn advancing_a_paused_clock_asks_the_host_for_one_step() {
    let mut app = app();
    clock(&mut app).pause();
    clock(&mut app).advance_by(Duration::from_millis(4));
    tick(&mut app, 10);
    tick(&mut app, 10);
    assert_eq!(steps(&app), [millis(4)]);
    assert_eq!(clock(&mut app).elapsed(), Duration::from_millis(4));
    assert_eq!(app.world().resource::<Time>().delta(), Duration::from_millis(10));
}

#[test]
fn the_substep_clock_runs_at_a_fraction_of_the_step() {
    let mut app = app();
    for (count, expected) in [(4, 3), (1, 12), (0, 12)] {
        app.insert_resource(SubstepCount(count));
        tick(&mut app, 12);
        assert_eq!(app.world().resource::<Time<Substeps>>().delta(), Duration::from_millis(expected));
    }
}

/// The substep clock in a system of a substep: delta and elapsed, in milliseconds.
#[derive(Resource, Default)]
struct Seen(Vec<[u128; 4]>);

#[test]
fn issue_the_substep_clock_advanced_once_or_never_in_all_substeps_of_a_step() {
    for watched in [false, true] {
        let mut app = app();
        app.init_resource::<Seen>().insert_resource(SubstepCount(4));
        if watched {
            let note = |substeps: Res<Time<Substeps>>, generic: Res<Time>, mut seen: ResMut<Seen>| {
                let times = [substeps.delta(), substeps.elapsed(), generic.delta(), generic.elapsed()];
                seen.0.push(times.map(|t| t.as_millis()));
            };
            app.add_systems(SubstepSchedule, note.in_set(SubstepSolverSystems::Damping));
        }
        for step in 1..=3 {
            tick(&mut app, 12);
            let clock = app.world().resource::<Time<Substeps>>();
            assert_eq!(clock.elapsed(), Duration::from_millis(12 * step), "watched: {watched}");
            assert_eq!(clock.delta(), Duration::from_millis(3));
        }
        let expected = (1..=12).map(|i| [3, 3 * i, 3, 3 * i]).collect::<Vec<_>>();
        assert_eq!(app.world().resource::<Seen>().0, if watched { expected } else { vec![] });
    }
}

#[test]
fn issue_conditions_on_the_sets_of_a_substep_were_ignored() {
    let mut app = app();
    app.insert_resource(Gravity::ZERO);
    let velocity = LinearVelocity(avian::math::Vector::X);
    let body = app.world_mut().spawn((RigidBody::Dynamic, velocity)).id();
    tick(&mut app, 10);
    let before = *app.world().get::<Position>(body).expect("a body has a position");
    assert!(before.x > 0.0);
    app.configure_sets(SubstepSchedule, IntegrationSystems::Position.run_if(|| false));
    for _ in 0..3 {
        tick(&mut app, 10);
        assert_eq!(app.world().get::<Position>(body), Some(&before), "it is not moved any more");
    }
}

#[test]
fn only_steps_move_the_last_physics_tick() {
    let mut app = app();
    tick(&mut app, 10);
    let after_step = app.world().resource::<LastPhysicsTick>().0;
    clock(&mut app).pause();
    tick(&mut app, 10);
    assert_eq!(app.world().resource::<LastPhysicsTick>().0, after_step);
    clock(&mut app).unpause();
    tick(&mut app, 10);
    let now = app.world_mut().change_tick();
    assert!(app.world().resource::<LastPhysicsTick>().0.is_newer_than(after_step, now));
}

#[test]
fn the_host_may_be_any_schedule_and_is_fixed_by_default() {
    #[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
    struct Rollback;

    for (plugins, host, others) in [
        (PhysicsPlugins::default(), FixedPostUpdate.intern(), [Update.intern(), FixedUpdate.intern()]),
        (PhysicsPlugins::new(Rollback), Rollback.intern(), [FixedPostUpdate.intern(), PostUpdate.intern()]),
    ] {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, plugins)).init_resource::<Steps>();
        app.init_schedule(Update).init_schedule(FixedUpdate).init_schedule(FixedPostUpdate);
        app.add_systems(PhysicsSchedule, note_step.in_set(PhysicsStepSystems::First));
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(10));
        for other in others {
            app.world_mut().run_schedule(other);
        }
        assert_eq!(steps(&app).len(), 0);
        app.world_mut().run_schedule(host);
        assert_eq!(steps(&app).len(), 1);
    }
}

#[test]
fn the_fixed_host_runs_on_one_thread_unless_the_app_sets_another_executor() {
    #[derive(Resource)]
    struct RanOn(Option<ThreadId>);
    let ran_on = |is_parallel: bool| {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()));
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(20)));
        app.insert_resource(RanOn(None));
        app.add_systems(FixedPostUpdate, |mut ran: ResMut<RanOn>| ran.0 = Some(std::thread::current().id()));
        if is_parallel {
            app.edit_schedule(FixedPostUpdate, |schedule| {
                schedule.set_executor(MultiThreadedExecutor::new());
            });
        }
        app.finish();
        app.cleanup();
        (0..3).for_each(|_| app.update());
        app.world().resource::<RanOn>().0.expect("it ran")
    };
    assert_eq!(ran_on(false), std::thread::current().id());
    assert_ne!(ran_on(true), std::thread::current().id());
}

/// Adds a system to each set of a list that records the set. Returns the expected record.
fn note_sets<S: SystemSet + Clone>(
    app: &mut App,
    schedule: impl ScheduleLabel + Clone,
    sets: &[S],
) -> Vec<String> {
    app.init_resource::<Order>();
    for set in sets.iter().cloned() {
        let name = format!("{set:?}");
        app.add_systems(
            schedule.clone(),
            (move |mut order: ResMut<Order>| order.0.push(name.clone())).in_set(set),
        );
    }
    sets.iter().map(|set| format!("{set:?}")).collect()
}

#[derive(Resource, Default)]
struct Order(Vec<String>);

#[test]
fn the_stages_of_the_host_are_in_order_and_before_transforms_are_propagated() {
    let mut app = app();
    let mut expected = note_sets(
        &mut app,
        Update,
        &[
            PhysicsSystems::First,
            PhysicsSystems::Prepare,
            PhysicsSystems::StepSimulation,
            PhysicsSystems::Writeback,
            PhysicsSystems::Last,
        ],
    );
    expected.extend(note_sets(&mut app, Update, &[TransformSystems::Propagate]));
    expected.extend(note_sets(&mut app, Update, &[SpatialQuerySystems]));
    app.configure_sets(Update, PhysicsSystems::First.ambiguous_with(PhysicsSystems::Last));
    tick(&mut app, 10);
    assert_eq!(app.world().resource::<Order>().0, expected);
}

#[test]
fn the_stages_of_a_step_are_in_order() {
    let mut app = app();
    let mut expected = note_sets(&mut app, PhysicsSchedule, &[PhysicsStepSystems::First]);
    expected.extend(note_sets(
        &mut app,
        PhysicsSchedule,
        &[BroadPhaseSystems::First, BroadPhaseSystems::CollectCollisions, BroadPhaseSystems::Last],
    ));
    expected.extend(note_sets(
        &mut app,
        PhysicsSchedule,
        &[NarrowPhaseSystems::First, NarrowPhaseSystems::Update, NarrowPhaseSystems::Last],
    ));
    expected.extend(note_sets(
        &mut app,
        PhysicsSchedule,
        &[
            SolverSystems::PrepareSolverBodies,
            SolverSystems::PrepareJoints,
            SolverSystems::PrepareContactConstraints,
            SolverSystems::PreSubstep,
        ],
    ));
    // `SolverSystems::Substep` is exclusive: the substeps run in it.
    app.insert_resource(SubstepCount(1));
    expected.extend(note_sets(&mut app, SubstepSchedule, &[SubstepSolverSystems::SolveConstraints]));
    expected.extend(note_sets(
        &mut app,
        PhysicsSchedule,
        &[
            SolverSystems::PostSubstep,
            SolverSystems::Restitution,
            SolverSystems::Finalize,
            SolverSystems::StoreContactImpulses,
        ],
    ));
    expected.extend(note_sets(
        &mut app,
        PhysicsSchedule,
        &[PhysicsStepSystems::Sleeping, PhysicsStepSystems::Finalize, PhysicsStepSystems::Last],
    ));
    // An unordered pair of these systems would be an ambiguity, which is an error here.
    tick(&mut app, 10);
    assert_eq!(app.world().resource::<Order>().0, expected);
}

#[test]
fn the_stages_of_a_substep_are_in_order() {
    let mut app = app();
    let mut expected = note_sets(&mut app, SubstepSchedule, &[IntegrationSystems::Velocity]);
    expected.extend(note_sets(
        &mut app,
        SubstepSchedule,
        &[SubstepSolverSystems::WarmStart, SubstepSolverSystems::SolveConstraints],
    ));
    expected.extend(note_sets(&mut app, SubstepSchedule, &[IntegrationSystems::Position]));
    expected.extend(note_sets(
        &mut app,
        SubstepSchedule,
        &[SubstepSolverSystems::Relax, SubstepSolverSystems::Damping],
    ));
    app.world_mut().resource_mut::<Order>().0.clear();
    app.world_mut().run_schedule(SubstepSchedule);
    assert_eq!(app.world().resource::<Order>().0, expected);
}

#[test]
fn the_systems_of_the_engine_are_unambiguous_in_host_step_and_substep() {
    let mut app = app();
    app.edit_schedule(Update, |schedule| {
        schedule.set_build_settings(ScheduleBuildSettings {
            ambiguity_detection: LogLevel::Error,
            ..Default::default()
        });
    });
    app.world_mut().spawn((RigidBody::Dynamic, GlobalTransform::default()));
    app.world_mut().schedule_scope(Update, |world, schedule| schedule.initialize(world).expect("host"));
    app.world_mut().schedule_scope(PhysicsSchedule, |world, schedule| {
        schedule.initialize(world).expect("step");
    });
    app.world_mut().schedule_scope(SubstepSchedule, |world, schedule| {
        schedule.initialize(world).expect("substep");
    });
    tick(&mut app, 10);
    assert_eq!(steps(&app).len(), 1);
}

#[test]
fn an_ambiguous_order_of_systems_in_a_step_or_substep_is_an_error() {
    fn write(_: ResMut<Steps>) {}
    fn also_write(_: ResMut<Steps>) {}

    for schedule in [PhysicsSchedule.intern(), SubstepSchedule.intern()] {
        let mut app = app();
        app.add_systems(schedule, (write, also_write));
        app.world_mut().schedule_scope(schedule, |world, schedule| {
            assert!(schedule.initialize(world).is_err(), "{:?}", schedule.label());
        });
    }
}

fn are_in_order(parts: &[(&str, Duration)]) -> bool {
    let place = |name: &str| parts.iter().position(|(part, _)| *part == name);
    let order =
        ["Prepare", "DrainLifecycle", "Gather", "Substeps", "Scatter", "Refit", "Writeback"].map(place);
    order.iter().all(Option::is_some) && order.is_sorted()
}

#[test]
fn parts_are_in_order_when_first_read_while_paused_by_a_clone() {
    let mut app = app();
    app.world_mut().spawn((RigidBody::Dynamic, Collider::default()));
    let read = |app: &App| app.world().resource::<StepTimes>().clone().parts().collect::<Vec<_>>();
    tick(&mut app, 10);
    clock(&mut app).pause();
    assert_eq!(read(&app), []);
    tick(&mut app, 10);
    clock(&mut app).unpause();
    tick(&mut app, 10);
    assert!(are_in_order(&read(&app)), "{:?}", read(&app));
}

#[test]
fn parts_of_steps_by_hand_are_timed() {
    let mut app = app();
    app.world_mut().spawn((RigidBody::Dynamic, Collider::default()));
    app.world().resource::<StepTimes>().total();
    for _ in 0..2 {
        clock(&mut app).advance_by(Duration::from_millis(10));
        app.world_mut().run_schedule(PhysicsSchedule);
    }
    let times = app.world().resource::<StepTimes>();
    assert!(times.parts().any(|(part, time)| part == "Substeps" && time > Duration::ZERO), "{times:?}");
}

#[test]
fn the_parts_of_a_step_are_timed_in_their_order() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(20)));
    app.finish();
    let mut step = || {
        app.world_mut().spawn((RigidBody::Dynamic, Collider::default()));
        app.update();
    };
    (0..3).for_each(|_| step());
    assert_eq!(app.world().resource::<StepTimes>().parts().count(), 0, "nobody asked before");
    (0..3).for_each(|_| app.update());
    let times = app.world().resource::<StepTimes>().clone();
    let parts: Vec<_> = times.parts().collect();
    assert!(are_in_order(&parts), "{parts:?}");
    assert_eq!(times.total(), parts.iter().map(|(_, time)| *time).sum());
    assert!(times.total() > Duration::ZERO && times.total() < Duration::from_secs(1));
    for _ in 0..3 {
        app.update();
    }
    assert_eq!(app.world().resource::<StepTimes>().parts().count(), parts.len(), "they do not pile up");
}
