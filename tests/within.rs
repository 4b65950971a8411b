//! Systems of an app within a step, in each of the public sets.

use avian::{
    dynamics::{
        integrator::IntegrationSystems,
        solver::{
            SolverConfig,
            schedule::{SolverSystems, SubstepSolverSystems},
        },
    },
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{component::Mutable, prelude::*, schedule::ScheduleLabel};
use bevy_time::Time;
use bevy_transform::{
    TransformPlugin,
    components::{GlobalTransform, Transform},
};
use core::time::Duration;

const DT: Duration = Duration::from_millis(16);

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)))
        .insert_resource(Gravity::ZERO);
    app
}

fn step(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(DT);
    app.update();
}

/// The body that [`teleport`] moves, and whether it moves it.
#[derive(Resource)]
struct Traveller(Entity, bool);

/// Moves the traveller up by 10 m, and rotates it by a quarter turn.
fn teleport(mut traveller: ResMut<Traveller>, mut poses: Query<(&mut Position, &mut Rotation)>) {
    if core::mem::take(&mut traveller.1) {
        let (mut position, mut rotation) = poses.get_mut(traveller.0).expect("a body has a pose");
        position.0 += Vector::Y * 10.0;
        *rotation = quarter() * *rotation;
    }
}

fn quarter() -> Rotation {
    Rotation::from(bevy_math::Quat::from_rotation_z(core::f32::consts::FRAC_PI_2))
}

/// A system in a set moves a body at 2 m/s up by 10 m. It continues from there, and pushes what is there.
fn goes_on(schedule: impl ScheduleLabel, set: impl SystemSet, body: RigidBody, what: &str) {
    let mut app = app();
    let collider = Collider::capsule(0.2, 0.2);
    let body = app.world_mut().spawn((body, collider.clone(), LinearVelocity(Vector::X * 2.0))).id();
    // In its path after the move, 1 m ahead.
    let struck = (RigidBody::Dynamic, collider, Transform::from_xyz(1.0, 10.0, 0.0));
    let struck = app.world_mut().spawn(struck).id();
    app.insert_resource(Traveller(body, false)).add_systems(schedule, teleport.in_set(set));
    for steps in 1..=60 {
        app.world_mut().resource_mut::<Traveller>().1 = steps == 4;
        step(&mut app);
        if steps < 15 {
            let position = app.world().get::<Position>(body).expect("a body has a position").0;
            let height = if steps < 4 { 0.0 } else { 10.0 };
            let way = 2.0 * Scalar::from(steps as f32) * 0.016;
            let expected = Vector::X * way + Vector::Y * height;
            assert!(
                (position - expected).length() < 1.0e-4,
                "{what}, step {steps}: {position} is not {expected}"
            );
            let rotation = *app.world().get::<Rotation>(body).expect("a body has a rotation");
            let expected = if steps < 4 { Rotation::IDENTITY } else { quarter() };
            assert!((rotation * Vector::X - expected * Vector::X).length() < 1.0e-5, "{what}, step {steps}");
        }
    }
    let speed = app.world().get::<LinearVelocity>(struck).expect("a body has a velocity").x;
    assert!(speed > 0.2, "{what}: what stood there moves at {speed} m/s");
}

#[test]
fn issue_poses_set_within_a_step_were_lost_where_bodies_move() {
    use PhysicsStepSystems::{BroadPhase, Finalize, First, Last, NarrowPhase, Sleeping, Solver};
    for set in [First, BroadPhase, NarrowPhase, Solver, Sleeping, Finalize, Last] {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic] {
            let what = format!("{body:?}, {set:?}");
            goes_on(PhysicsSchedule, set, body, &what);
        }
    }
    for set in [SolverSystems::PrepareJoints, SolverSystems::PreSubstep, SolverSystems::Finalize] {
        goes_on(PhysicsSchedule, set, RigidBody::Dynamic, &format!("{set:?}"));
    }
    goes_on(SubstepSchedule, SubstepSolverSystems::WarmStart, RigidBody::Dynamic, "a substep");
}

#[test]
fn a_pose_written_with_what_it_is_changes_no_bit() {
    let run = |touched: bool| {
        let mut app = app();
        app.insert_resource(Gravity(Vector::Y * -9.81));
        app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
        let place = Transform::from_xyz(0.0, 1.0, 0.0);
        let turning = AngularVelocity::default();
        let body =
            (RigidBody::Dynamic, Collider::capsule(0.2, 0.5), place, turning, LinearVelocity(Vector::X));
        let body = app.world_mut().spawn(body).id();
        if touched {
            let touch = |mut poses: Query<(&mut Position, &mut Rotation)>| {
                for (mut position, mut rotation) in &mut poses {
                    (*position, *rotation) = (*position, *rotation);
                }
            };
            app.add_systems(PhysicsSchedule, touch.in_set(PhysicsStepSystems::NarrowPhase));
        }
        (0..100).for_each(|_| step(&mut app));
        format!("{:?} {:?}", app.world().get::<Position>(body), app.world().get::<Rotation>(body))
    };
    assert_eq!(run(false), run(true));
}

fn read<C: Component>(_: Query<&C>) {}

fn write<C: Component<Mutability = Mutable>>(_: Query<&mut C>) {}

fn see<R: Resource>(_: Option<Res<R>>) {}

/// Adds a system for each component, and one for each resource, to a set.
fn add_all(app: &mut App, schedule: impl ScheduleLabel + Clone, set: impl SystemSet + Clone, writes: bool) {
    macro_rules! components {
        ($($component:ty),* $(,)?) => {$(
            if writes {
                app.add_systems(schedule.clone(), write::<$component>.in_set(set.clone()));
            } else {
                app.add_systems(schedule.clone(), read::<$component>.in_set(set.clone()));
            }
        )*};
    }
    components!(
        Position,
        Rotation,
        LinearVelocity,
        AngularVelocity,
        ColliderAabb,
        Collider,
        Friction,
        Restitution,
        CollisionMargin,
        SpeculativeMargin,
        ColliderDensity,
        ColliderTransform,
        Mass,
        AngularInertia,
        CenterOfMass,
        ComputedMass,
        ComputedAngularInertia,
        ComputedCenterOfMass,
        GravityScale,
        LinearDamping,
        AngularDamping,
        MaxLinearSpeed,
        MaxAngularSpeed,
        LockedAxes,
        Dominance,
        SleepThreshold,
        SleepTimer,
        Transform,
        GlobalTransform,
    );
    if !writes {
        app.add_systems(
            schedule,
            (
                read::<RigidBody>,
                read::<CollisionLayers>,
                read::<Sleeping>,
                read::<ColliderOf>,
                read::<RigidBodyColliders>,
                see::<Gravity>,
                see::<Time<Physics>>,
                see::<SubstepCount>,
                see::<SolverConfig>,
                see::<NarrowPhaseConfig>,
                see::<PhysicsLengthUnit>,
            )
                .in_set(set),
        );
    }
}

#[test]
fn issue_systems_of_the_app_made_the_step_fail_as_ambiguous() {
    use PhysicsStepSystems::{BroadPhase, Finalize, First, Last, NarrowPhase, Sleeping, Solver};
    for writes in [false, true] {
        let mut app = app();
        for set in [First, BroadPhase, NarrowPhase, Solver, Sleeping, Finalize, Last] {
            add_all(&mut app, PhysicsSchedule, set, writes);
        }
        add_all(&mut app, SubstepSchedule, IntegrationSystems::Velocity, writes);
        add_all(&mut app, SubstepSchedule, SubstepSolverSystems::SolveConstraints, writes);
        add_all(&mut app, SubstepSchedule, SubstepSolverSystems::Damping, writes);
        let body = (RigidBody::Dynamic, Collider::capsule(0.2, 0.5), LinearVelocity(Vector::X));
        let body = app.world_mut().spawn(body).id();
        (0..10).for_each(|_| step(&mut app));
        assert!(app.world().get::<Position>(body).is_some_and(|position| position.x > 0.1));
    }
}

/// The `GlobalTransform` of an entity within a step.
#[derive(Resource)]
struct Seen(Entity, Vec<GlobalTransform>);

fn note(mut seen: ResMut<Seen>, globals: Query<&GlobalTransform>) {
    let global = *globals.get(seen.0).expect("it has one");
    seen.1.push(global);
}

#[test]
fn issue_global_transforms_were_a_tick_behind_within_physics() {
    for plugged in [false, true] {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), PhysicsPlugins::new(Update)))
            .insert_resource(Gravity::ZERO);
        if plugged {
            app.add_plugins(TransformPlugin);
        }
        let root = app.world_mut().spawn(Transform::from_xyz(1.0, 0.0, 0.0)).id();
        let cart = app.world_mut().spawn((Transform::from_xyz(0.0, 1.0, 0.0), ChildOf(root))).id();
        let body = (RigidBody::Kinematic, Collider::capsule(0.2, 0.5), Transform::default(), ChildOf(cart));
        let body = app.world_mut().spawn(body).id();
        let picture = app.world_mut().spawn((Transform::default(), ChildOf(root))).id();
        app.insert_resource(Seen(body, Vec::new()))
            .add_systems(PhysicsSchedule, note.in_set(PhysicsStepSystems::First));
        for x in 1..5 {
            let mut transform = app.world_mut().get_mut::<Transform>(root).expect("it has one");
            transform.translation.x = x as f32;
            step(&mut app);
        }
        let mut transform = app.world_mut().get_mut::<Transform>(body).expect("it has one");
        transform.translation.x = 7.0;
        step(&mut app);
        // From now on it moves by itself, twice a frame.
        app.world_mut().entity_mut(body).insert(LinearVelocity(Vector::X));
        for _ in 0..2 {
            app.world_mut().resource_mut::<Time>().advance_by(DT);
            app.world_mut().run_schedule(Update);
        }
        let seen: Vec<f32> = app.world().resource::<Seen>().1.iter().map(|g| g.translation().x).collect();
        let expected = [1.0, 2.0, 3.0, 4.0, 11.0, 11.0, 11.016];
        assert!(
            seen.len() == 7 && seen.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1.0e-5),
            "{seen:?}"
        );
        assert!(app.world().resource::<Seen>().1.iter().all(|g| g.translation().y == 1.0));
        // Entities without physics are left to Bevy.
        let picture = app.world().get::<GlobalTransform>(picture).expect("it has one").translation().x;
        assert_eq!(picture, if plugged { 4.0 } else { 0.0 });
    }
}
