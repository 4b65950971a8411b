//! Changes in `Update` have the same effect as changes in the tick, at any frame rate and while
//! time is paused.
//!
//! Every change is made once in `Update`, between two ticks, and once in the tick, before physics. All bodies
//! must have the same bits after every step, and other bits than without the change.

use avian::{
    dynamics::integrator::{CustomPositionIntegration, CustomVelocityIntegration},
    math::{AsF32, Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{
    entity_disabling::Disabled,
    prelude::*,
    schedule::{Schedules, SingleThreadedExecutor},
};
use bevy_time::{TimePlugin, TimeUpdateStrategy, prelude::*};
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use scenes::dim::{ball, block, spin};

/// Number of steps before the change, and in total. The mover lands after about 25.
const BEFORE: usize = 12;
const STEPS: usize = 60;
/// Number of frames of a pause, before and after the change.
const PAUSE: usize = 12;

/// The entities of the scene.
#[derive(Resource, Clone, Copy)]
struct Actors {
    /// A box that is thrown at the other bodies.
    mover: Entity,
    /// A child of the mover, with a collider.
    part: Entity,
    /// A ball at rest in the mover's path.
    other: Entity,
    /// A kinematic ball that moves towards the mover.
    flyer: Entity,
    /// A box at rest that falls asleep.
    idle: Entity,
}

/// The bits of all bodies after each step.
#[derive(Resource, Default)]
struct Trace(Vec<Vec<u64>>);

/// A change within a tick: after how many steps, and the change.
#[derive(Resource)]
struct InTick(usize, Change);

/// A change in `Update`.
#[derive(Resource)]
struct InUpdate(Change);

/// Number of steps before the change.
#[derive(Resource)]
struct Made(usize);

type Change = fn(&mut World, Actors);

fn nothing(_: &mut World, _: Actors) {}

/// A change of the world, and the preparation of the world for it.
struct Case {
    name: &'static str,
    prepare: Change,
    change: Change,
    /// Whether bodies without a [`SpeculativeMargin`] have an unlimited one.
    predicts: bool,
}

const fn case(name: &'static str, prepare: Change, change: Change) -> Case {
    Case { name, prepare, change, predicts: true }
}

/// Inserted, changed in place, and removed.
macro_rules! life {
    ($who:ident, $type:ident, $first:expr, $second:expr) => {
        [
            case(concat!("insert ", stringify!($type)), nothing, |world, at| {
                world.entity_mut(at.$who).insert($first);
            }),
            case(
                concat!("change ", stringify!($type)),
                |world, at| {
                    world.entity_mut(at.$who).insert($first);
                },
                |world, at| {
                    *world.entity_mut(at.$who).get_mut::<$type>().expect("inserted before") = $second;
                },
            ),
            case(
                concat!("remove ", stringify!($type)),
                |world, at| {
                    world.entity_mut(at.$who).insert($first);
                },
                |world, at| {
                    world.entity_mut(at.$who).remove::<$type>();
                },
            ),
        ]
    };
}

/// A marker: inserted and removed, with the components it affects.
macro_rules! marker {
    ($who:ident, $type:ident) => {
        marker!($who, $type, ())
    };
    ($who:ident, $type:ident, $with:expr) => {
        [
            case(
                concat!("insert ", stringify!($type)),
                |world, at| {
                    world.entity_mut(at.$who).insert($with);
                },
                |world, at| {
                    world.entity_mut(at.$who).insert($type);
                },
            ),
            case(
                concat!("remove ", stringify!($type)),
                |world, at| {
                    world.entity_mut(at.$who).insert(($type, $with));
                },
                |world, at| {
                    world.entity_mut(at.$who).remove::<$type>();
                },
            ),
        ]
    };
}

fn at(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

fn to_the_right(speed: Scalar) -> LinearVelocity {
    LinearVelocity(Vector::X * speed)
}

fn spawn_scene(world: &mut World) -> Actors {
    world.spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
    let moving = (to_the_right(6.0), spin(1.0));
    let mover = world.spawn((RigidBody::Dynamic, block(1.0, 1.0, 1.0), at(-2.0, 1.2), moving)).id();
    let part = (ball(0.3), ColliderDensity(4.0), at(0.5, 0.2), ChildOf(mover));
    let part = world.spawn(part).id();
    let other = world.spawn((RigidBody::Dynamic, ball(0.5), at(0.0, 0.5))).id();
    world.spawn((RigidBody::Dynamic, block(0.6, 0.6, 0.6), at(1.5, 0.3)));
    let flyer = (RigidBody::Kinematic, ball(0.5), at(2.0, 1.1), to_the_right(-1.0));
    let flyer = world.spawn(flyer).id();
    let idle = world.spawn((RigidBody::Dynamic, block(0.5, 0.5, 0.5), at(9.0, 0.25))).id();
    Actors { mover, part, other, flyer, idle }
}

fn record(
    mut trace: ResMut<Trace>,
    bodies: Query<(Entity, &Position, &Rotation, &LinearVelocity, Has<Sleeping>)>,
) {
    let mut rows: Vec<_> = bodies.iter().collect();
    rows.sort_by_key(|row| row.0);
    let mut bits = Vec::new();
    for (entity, position, rotation, velocity, sleeps) in rows {
        let turned = *rotation * Vector::X;
        bits.push(entity.to_bits() << 1 | u64::from(sleeps));
        bits.extend([position.0, turned, velocity.0].iter().flat_map(|v| v.to_array().map(bits_of)));
    }
    trace.0.push(bits);
}

fn bits_of(value: Scalar) -> u64 {
    f64::from(value).to_bits()
}

fn change_in_tick(world: &mut World) {
    let InTick(after, change) = *world.resource::<InTick>();
    if world.resource::<Trace>().0.len() == after {
        change(world, *world.resource::<Actors>());
    }
}

fn change_in_update(world: &mut World) {
    if let Some(InUpdate(change)) = world.remove_resource::<InUpdate>() {
        world.insert_resource(Made(world.resource::<Trace>().0.len()));
        change(world, *world.resource::<Actors>());
    }
}

/// An app in which physics runs where it does by default, at 64 ticks a second.
fn app(frames_per_second: u32, case: &Case) -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()))
        .insert_resource(Time::<Fixed>::from_hz(64.0))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs(1) / frames_per_second))
        .insert_resource(SubstepCount(2))
        .insert_resource(TimeToSleep(0.4))
        .insert_resource(InTick(usize::MAX, nothing))
        .init_resource::<Trace>()
        .add_systems(PhysicsSchedule, record.in_set(PhysicsStepSystems::Last))
        .add_systems(FixedPreUpdate, change_in_tick)
        .add_systems(Update, change_in_update);
    app.finish();
    app.cleanup();
    // Handing systems of nearly empty schedules between threads would take most of the time.
    for (_, schedule) in app.world_mut().resource_mut::<Schedules>().iter_mut() {
        schedule.set_executor(SingleThreadedExecutor::new());
    }
    let actors = spawn_scene(app.world_mut());
    app.insert_resource(actors);
    if !case.predicts {
        app.world_mut().resource_mut::<NarrowPhaseConfig>().default_speculative_margin = 0.0;
    }
    (case.prepare)(app.world_mut(), actors);
    app
}

/// Runs frames until a number of steps was taken.
fn run_to(app: &mut App, count: usize) {
    while app.world().resource::<Trace>().0.len() < count {
        app.update();
    }
}

/// Runs to the end. Returns the record.
fn finish(mut app: App) -> Vec<Vec<u64>> {
    run_to(&mut app, STEPS);
    let mut trace = core::mem::take(&mut app.world_mut().resource_mut::<Trace>().0);
    trace.truncate(STEPS);
    trace
}

fn in_tick(case: &Case, after: usize) -> Vec<Vec<u64>> {
    let mut app = app(64, case);
    app.insert_resource(InTick(after, case.change));
    finish(app)
}

/// The frames around the change.
#[derive(Clone, Copy, Debug)]
enum Frames {
    /// Frames per second. The change is made some frames later than possible.
    Running(u32, usize),
    /// `Time<Physics>` is paused.
    PhysicsPaused,
    /// `Time<Virtual>` is paused.
    AllPaused,
}

const FRAMES: [Frames; 6] = [
    Frames::Running(30, 0),
    Frames::Running(60, 0),
    Frames::Running(144, 0),
    Frames::Running(144, 1),
    Frames::PhysicsPaused,
    Frames::AllPaused,
];

/// The trace with the change in `Update`, and the number of steps before it.
fn in_update(case: &Case, frames: Frames) -> (usize, Vec<Vec<u64>>) {
    let rate = if let Frames::Running(rate, _) = frames { rate } else { 144 };
    let mut app = app(rate, case);
    run_to(&mut app, BEFORE);
    let around = match frames {
        Frames::Running(_, late) => {
            (0..late).for_each(|_| app.update());
            0
        }
        Frames::PhysicsPaused => {
            app.world_mut().resource_mut::<Time<Physics>>().pause();
            PAUSE
        }
        Frames::AllPaused => {
            app.world_mut().resource_mut::<Time<Virtual>>().pause();
            PAUSE
        }
    };
    (0..around).for_each(|_| app.update());
    app.insert_resource(InUpdate(case.change));
    (0..=around).for_each(|_| app.update());
    app.world_mut().resource_mut::<Time<Physics>>().unpause();
    app.world_mut().resource_mut::<Time<Virtual>>().unpause();
    let made = app.world().resource::<Made>().0;
    (made, finish(app))
}

/// The kinds of frames for which the motion differs from that with the change in the tick.
fn check(cases: &[Case]) {
    let mut wrong = Vec::new();
    for case in cases {
        let unchanged = finish(app(64, case));
        let mut in_ticks: [Option<Vec<Vec<u64>>>; STEPS] = [const { None }; STEPS];
        for frames in FRAMES {
            let (made, trace) = in_update(case, frames);
            let expected = in_ticks[made].get_or_insert_with(|| in_tick(case, made));
            assert!(*expected != unchanged, "the scene does not show: {}", case.name);
            if let Some(step) = (0..STEPS).find(|&i| trace[i] != expected[i]) {
                wrong.push(format!("{}, {frames:?}: step {step}, changed after {made}", case.name));
            }
        }
    }
    assert!(wrong.is_empty(), "{} differ:\n{}", wrong.len(), wrong.join("\n"));
}

#[test]
fn surfaces_and_margins_count_at_any_frame_rate() {
    check(&life!(mover, Friction, Friction::new(0.05), Friction::new(0.9)));
    check(&life!(mover, Restitution, Restitution::new(0.8), Restitution::new(0.3)));
    check(&life!(other, CollisionMargin, CollisionMargin(0.2), CollisionMargin(0.1)));
    // The larger of two margins counts: without the component there should be none.
    let margins = life!(mover, SpeculativeMargin, SpeculativeMargin(1.0), SpeculativeMargin(0.0));
    check(&margins.map(|case| Case { predicts: false, ..case }));
}

#[test]
fn colliders_count_at_any_frame_rate() {
    check(&marker!(part, Sensor));
    check(&marker!(other, Sensor));
    check(&marker!(other, ColliderDisabled));
    check(&[
        case("insert CollisionLayers", nothing, |world, at| {
            world.entity_mut(at.other).insert(CollisionLayers::from_bits(2, 2));
        }),
        case(
            "remove CollisionLayers",
            |world, at| {
                world.entity_mut(at.other).insert(CollisionLayers::from_bits(2, 2));
            },
            |world, at| {
                world.entity_mut(at.other).remove::<CollisionLayers>();
            },
        ),
    ]);
    check(&life!(other, Collider, block(1.0, 1.0, 1.0), block(1.0, 0.6, 1.0))[..2]);
    check(&life!(part, ColliderDensity, ColliderDensity(9.0), ColliderDensity(1.0))[..2]);
    check(&[
        case("despawn a collider", nothing, |world, at| {
            world.entity_mut(at.part).despawn();
        }),
        case("detach a collider", nothing, |world, at| {
            world.entity_mut(at.part).remove::<ChildOf>();
        }),
        case("move a collider on its body", nothing, |world, at| {
            world.get_mut::<Transform>(at.part).expect("it has one").translation.y += 0.5;
        }),
    ]);
}

#[test]
fn masses_count_at_any_frame_rate() {
    check(&life!(mover, Mass, Mass(20.0), Mass(0.1)));
    check(&life!(
        mover,
        AngularInertia,
        AngularInertia::from_shape(&block(1.0, 1.0, 1.0), 30.0),
        AngularInertia::from_shape(&block(1.0, 1.0, 1.0), 0.2)
    ));
    check(&life!(
        mover,
        CenterOfMass,
        CenterOfMass((Vector::X * 0.2).f32()),
        CenterOfMass((Vector::Y * 0.2).f32())
    ));
    check(&marker!(mover, NoAutoMass, Mass(20.0)));
    check(&marker!(mover, NoAutoAngularInertia, AngularInertia::from_shape(&block(1.0, 1.0, 1.0), 9.0)));
    check(&marker!(mover, NoAutoCenterOfMass, CenterOfMass((Vector::X * 0.2).f32())));
}

#[test]
fn motion_counts_at_any_frame_rate() {
    check(&life!(mover, GravityScale, GravityScale(0.5), GravityScale(-0.5)));
    check(&life!(mover, LinearDamping, LinearDamping(1.0), LinearDamping(3.0)));
    check(&life!(mover, AngularDamping, AngularDamping(1.0), AngularDamping(3.0)));
    check(&life!(mover, MaxLinearSpeed, MaxLinearSpeed(2.0), MaxLinearSpeed(4.0)));
    check(&life!(mover, MaxAngularSpeed, MaxAngularSpeed(0.2), MaxAngularSpeed(0.5)));
    check(&life!(mover, LockedAxes, LockedAxes::ROTATION_LOCKED, LockedAxes::TRANSLATION_LOCKED));
    check(&life!(mover, Dominance, Dominance(1), Dominance(-1)));
    check(&marker!(mover, CustomVelocityIntegration));
    check(&marker!(mover, CustomPositionIntegration));
    check(&life!(mover, LinearVelocity, to_the_right(2.0), to_the_right(-2.0))[..2]);
    check(&life!(flyer, LinearVelocity, to_the_right(-2.0), to_the_right(-3.0))[..2]);
    check(&life!(idle, LinearVelocity, to_the_right(2.0), to_the_right(-2.0))[..2]);
    check(&life!(mover, AngularVelocity, spin(2.0), spin(-2.0))[..2]);
}

#[test]
fn bodies_and_their_places_count_at_any_frame_rate() {
    check(&marker!(mover, RigidBodyDisabled));
    check(&marker!(other, Disabled));
    check(&marker!(mover, Sleeping)[..1]);
    check(&marker!(idle, Sleeping)[1..]);
    check(&marker!(idle, SleepingDisabled));
    check(&life!(
        idle,
        SleepThreshold,
        SleepThreshold { linear: -1.0, angular: -1.0 },
        SleepThreshold::default()
    ));
    check(&life!(other, Position, Position(Vector::Y * 2.0), Position(Vector::Y * 3.0))[..2]);
    check(&life!(other, Transform, at(0.5, 0.7), at(0.0, 3.0))[..2]);
    check(&life!(idle, Transform, at(9.0, 2.0), at(9.0, 3.0))[..2]);
    check(&[
        case("make static", nothing, |world, at| {
            world.entity_mut(at.other).insert(RigidBody::Static);
        }),
        case("make kinematic", nothing, |world, at| {
            world.entity_mut(at.mover).insert(RigidBody::Kinematic);
        }),
        case("make dynamic", nothing, |world, at| {
            world.entity_mut(at.flyer).insert(RigidBody::Dynamic);
        }),
        case("remove RigidBody", nothing, |world, at| {
            world.entity_mut(at.other).remove::<RigidBody>();
        }),
        case("despawn a body", nothing, |world, at| {
            world.entity_mut(at.other).despawn();
        }),
    ]);
}
