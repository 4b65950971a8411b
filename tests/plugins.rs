//! The plugin group: it builds, applies its configuration, and works without any one of its plugins.

use avian::{
    PhysicsTypeRegistrationPlugin,
    collision::collider::{AabbContext, AnyCollider},
    dynamics::{
        integrator::IntegrationSystems,
        solver::{SolverConfig, joint_graph::JointGraphPlugin},
    },
    math::{Scalar, Vector},
    parry::shape::SharedShape,
    prelude::*,
};
use bevy_app::{PluginGroupBuilder, prelude::*};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel, system::SystemParam};
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

/// A headless app with the plugins of `group`.
fn build(group: impl FnOnce(PluginGroupBuilder) -> PluginGroupBuilder) -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
        .add_plugins(group(PhysicsPlugins::default().build()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 64.0)));
    app.finish();
    app.cleanup();
    app
}

/// The app after ten ticks.
fn run(group: impl FnOnce(PluginGroupBuilder) -> PluginGroupBuilder) -> App {
    let mut app = build(group);
    app.world_mut().spawn(RigidBody::Dynamic);
    for _ in 0..10 {
        app.update();
    }
    app
}

#[test]
fn all_of_it_runs() {
    let app = run(|group| group);
    // The first frame has no delta.
    let elapsed = app.world().resource::<Time<Physics>>().elapsed();
    assert!(elapsed >= Duration::from_millis(9 * 15), "{elapsed:?}");
}

#[test]
fn an_eased_body_is_drawn_between_its_steps() {
    let mut app = run(|group| group);
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_millis(5)))
        .insert_resource(Gravity(Vector::ZERO));
    let mut spawn = |ease: bool| {
        let mut body = app.world_mut().spawn((RigidBody::Dynamic, LinearVelocity(Vector::X)));
        if ease {
            body.insert(TransformInterpolation);
        }
        body.id()
    };
    let (eased, plain) = (spawn(true), spawn(false));
    let mut way = |body: Entity| {
        let mut last = None;
        let steps = (0..40).map(|_| {
            app.update();
            let x = app.world().get::<Transform>(body).map_or(f32::NAN, |t| t.translation.x);
            last.replace(x).map_or(0.005, |last| x - last)
        });
        // The first ticks have no previous state to ease from.
        steps.skip(10).map(|way| (way - 0.005).abs()).fold(0.0, f32::max)
    };
    assert!(way(eased) < 1.0e-4, "{}", way(eased));
    assert!(way(plain) > 4.0e-3, "drawn where the last tick left it: {}", way(plain));
}

#[test]
fn easing_is_left_out_while_there_is_nothing_to_ease() {
    let app = build(|group| group);
    for label in [FixedFirst.intern(), FixedLast.intern(), RunFixedMainLoop.intern()] {
        let systems = |schedule: &Schedule| {
            let systems = schedule.graph().systems.iter();
            systems.filter(|(.., conditions)| conditions.is_empty()).count()
        };
        let own = app.get_schedule(label).map_or(0, systems);
        // Bevy runs the fixed loop in it.
        assert_eq!(own, usize::from(label == RunFixedMainLoop.intern()), "{label:?}");
    }
}

/// The state of a few bodies after three seconds: a ball that falls on a floor from 2 m, a body held at a
/// height, one with a maximum speed of 1 m/s, one that drifts at 1 m/s without gravity, and one with its
/// collider a metre above it, on a child.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Seen {
    ball: Scalar,
    mass: Scalar,
    asleep: bool,
    /// The top of the ball's box, relative to the ball.
    top: Scalar,
    /// The ball's `Transform`, relative to its `Position`.
    drawn: Scalar,
    held: Scalar,
    limited: Scalar,
    drifted: Scalar,
    /// The child's collider on its body, if it belongs to it.
    child: Option<Scalar>,
}

fn watch(group: PluginGroupBuilder) -> Seen {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, group));
    app.finish();
    app.cleanup();
    // With all three, including entities that are only read.
    let at = |x: f32, y: f32| {
        let position = Vector::X * x as Scalar + Vector::Y * y as Scalar;
        (Transform::from_xyz(x, y, 0.0), Position(position), Rotation::IDENTITY)
    };
    let world = app.world_mut();
    world.spawn((RigidBody::Static, Collider::half_space(Vector::Y), at(0.0, 0.0)));
    let ball: Collider = SharedShape::ball(0.5).into();
    let falling = world.spawn((RigidBody::Dynamic, ball.clone(), at(0.0, 2.5))).id();
    let held = world.spawn((RigidBody::Dynamic, LockedAxes::TRANSLATION_LOCKED, at(5.0, 2.0))).id();
    let limited = world.spawn((RigidBody::Dynamic, MaxLinearSpeed(1.0), at(10.0, 9.0))).id();
    let drifting = (RigidBody::Dynamic, GravityScale(0.0), LinearVelocity(Vector::X), at(15.0, 5.0));
    let drifting = world.spawn(drifting).id();
    let parent = world.spawn((RigidBody::Dynamic, at(20.0, 3.0))).id();
    let child = world.spawn((ball, Transform::from_xyz(0.0, 1.0, 0.0), ChildOf(parent))).id();
    for _ in 0..180 {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 60.0));
        app.update();
    }
    let world = app.world();
    let position = |entity: Entity| world.get::<Position>(entity).map_or(Vector::NAN, |p| p.0);
    let limited = world.get::<LinearVelocity>(limited).map_or(Scalar::NAN, |v| v.length());
    Seen {
        ball: position(falling).y,
        mass: world.get::<ComputedMass>(falling).map_or(Scalar::NAN, |m| m.value()),
        asleep: world.get::<Sleeping>(falling).is_some(),
        top: world.get::<ColliderAabb>(falling).map_or(Scalar::NAN, |b| b.max.y) - position(falling).y,
        drawn: world.get::<Transform>(falling).map_or(f32::NAN, |t| t.translation.y) as Scalar
            - position(falling).y,
        held: position(held).y,
        limited,
        drifted: position(drifting).x - 15.0,
        child: world
            .get::<ColliderOf>(child)
            .filter(|of| of.body == parent)
            .and(world.get::<ColliderTransform>(child))
            .map(|place| place.translation.y),
    }
}

/// Watches the group without each of a list of plugins.
macro_rules! without {
    ($($test:ident: $plugin:ty => $($is:expr),+;)*) => {
        $(
            #[test]
            fn $test() {
                let seen = watch(PhysicsPlugins::new(Update).build().disable::<$plugin>());
                for is in [$($is as fn(&Seen) -> bool),+] {
                    assert!(is(&seen), "{seen:?}");
                }
            }
        )*
    };
}

without! {
    without_type_registration: PhysicsTypeRegistrationPlugin => moves, rests, is_attached;
    without_mass_properties: MassPropertyPlugin => moves, falls_through, is_massless, is_attached;
    without_forces: ForcePlugin => moves, rests, is_attached;
    without_collider_hierarchy: ColliderHierarchyPlugin => moves, falls_through, is_detached;
    without_collider_transform: ColliderTransformPlugin => moves, falls_through, is_detached;
    without_collider_constructors: ColliderConstructorPlugin => moves, rests, is_attached;
    without_collider_cache: ColliderCachePlugin => moves, rests, is_attached;
    without_collider_backend: ColliderBackendPlugin<Collider> => moves, falls_through, is_massless, is_attached;
    without_collider_tree: ColliderTreePlugin<Collider> => moves, falls_through, is_attached, has_no_box;
    without_narrow_phase: NarrowPhasePlugin<Collider> => moves, falls_through, is_attached;
    without_solver_body: SolverBodyPlugin => stands_still, is_attached;
    without_solver_schedule: SolverSchedulePlugin => stands_still, is_attached;
    without_integrator: IntegratorPlugin => stands_still, is_attached;
    without_solver: SolverPlugin => moves, falls_through, is_attached;
    without_islands: IslandPlugin => moves, lies_awake, is_attached;
    without_sleeping: IslandSleepingPlugin => moves, lies_awake, is_attached;
    without_broad_phase_stages: BroadPhaseCorePlugin => moves, rests, is_attached;
    without_broad_phase: BvhBroadPhasePlugin => moves, falls_through, is_attached;
    without_transforms: PhysicsTransformPlugin => moves_unseen, rests, is_attached;
    without_interpolation: PhysicsInterpolationPlugin => moves, rests, is_attached;
    without_length_unit_check: LengthUnitCheckPlugin => moves, rests, is_attached;
    without_sweeps: CcdPlugin => moves, rests, is_attached;
    without_casters: SpatialQueryPlugin => moves, rests, is_attached;
    without_joints: JointPlugin => moves, rests, is_attached;
    without_joint_graph: JointGraphPlugin<FixedJoint> => moves, rests, is_attached;
}

/// As games do for speed, and crates for networking that keep poses and sleep to themselves.
#[test]
fn without_many_of_them_at_once_bodies_move_and_touch() {
    let group = PhysicsPlugins::new(Update).build();
    let group = group.disable::<PhysicsTransformPlugin>().disable::<PhysicsInterpolationPlugin>();
    let group = group.disable::<IslandPlugin>().disable::<IslandSleepingPlugin>();
    let group = group.disable::<ForcePlugin>().disable::<ColliderCachePlugin>();
    let seen = watch(group.disable::<CcdPlugin>().disable::<SpatialQueryPlugin>());
    assert!(moves_unseen(&seen) && lies_awake(&seen) && is_attached(&seen), "{seen:?}");
}

#[test]
fn without_type_registration_nothing_reflects() {
    let knows_substeps = |app: &App| {
        let registry = app.world().get_resource::<AppTypeRegistry>();
        registry.is_some_and(|r| r.read().contains(std::any::TypeId::of::<SubstepCount>()))
    };
    assert!(knows_substeps(&run(|group| group)));
    assert!(!knows_substeps(&run(|group| group.disable::<PhysicsTypeRegistrationPlugin>())));
}

#[test]
fn with_all_of_them_everything_happens() {
    let seen = watch(PhysicsPlugins::new(Update).build());
    assert!(moves(&seen) && rests(&seen) && is_attached(&seen), "{seen:?}");
}

/// Bodies drift, are locked and limited, and are drawn at their positions.
fn moves(seen: &Seen) -> bool {
    go(seen) && seen.drawn.abs() < 1.0e-3
}

/// They do, but are drawn at their initial positions.
fn moves_unseen(seen: &Seen) -> bool {
    go(seen) && (seen.drawn - 2.0).abs() < 0.02
}

fn go(seen: &Seen) -> bool {
    (seen.drifted - 3.0).abs() < 1.0e-3 && seen.held == 2.0 && (seen.limited - 1.0).abs() < 1.0e-3
}

/// No body moves.
fn stands_still(seen: &Seen) -> bool {
    (seen.ball, seen.drifted, seen.limited) == (2.5, 0.0, 0.0)
}

/// The ball lies on the floor, inside of its box, and has mass.
fn lies(seen: &Seen) -> bool {
    (seen.ball - 0.5).abs() < 0.02 && (seen.top - 0.5).abs() < 1.0e-3 && !is_massless(seen)
}

fn rests(seen: &Seen) -> bool {
    lies(seen) && seen.asleep
}

fn lies_awake(seen: &Seen) -> bool {
    lies(seen) && !seen.asleep
}

/// The ball falls as if there were no floor.
fn falls_through(seen: &Seen) -> bool {
    seen.ball < -40.0 && !seen.asleep
}

fn is_massless(seen: &Seen) -> bool {
    seen.mass == 0.0
}

fn has_no_box(seen: &Seen) -> bool {
    seen.top == Scalar::NEG_INFINITY
}

/// The child's collider has no body.
fn is_detached(seen: &Seen) -> bool {
    seen.child.is_none()
}

/// The child's collider belongs to its parent, a metre above it.
fn is_attached(seen: &Seen) -> bool {
    seen.child == Some(1.0)
}

#[test]
fn without_schedule_no_step_is_taken() {
    #[derive(Resource)]
    struct Stepped;

    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
        .add_plugins(PhysicsPlugins::default().build().disable::<PhysicsSchedulePlugin>())
        .add_systems(PhysicsSchedule, |mut commands: Commands| {
            commands.insert_resource(Stepped);
        })
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 64.0)));
    app.update();
    app.update();
    assert!(!app.world().contains_resource::<Stepped>());
}

#[test]
fn defaults_are_those_of_the_documentation() {
    let app = run(|group| group);
    let world = app.world();
    assert_eq!(world.resource::<SubstepCount>().0, 6);
    assert_eq!(world.resource::<PhysicsLengthUnit>().0, 1.0);
    assert_eq!(world.resource::<Gravity>().0, avian::math::Vector::Y * -9.81);
    assert_eq!(
        *world.resource::<NarrowPhaseConfig>(),
        NarrowPhaseConfig {
            default_speculative_margin: Scalar::MAX,
            contact_tolerance: 0.005,
            match_contacts: true
        }
    );
    assert_eq!(
        *world.resource::<SolverConfig>(),
        SolverConfig {
            contact_damping_ratio: 10.0,
            contact_frequency_factor: 1.5,
            max_overlap_solve_speed: 4.0,
            warm_start_coefficient: 1.0,
            restitution_threshold: 1.0,
            restitution_iterations: 1,
        }
    );
}

#[test]
fn the_length_unit_is_what_the_group_was_told() {
    fn unit(plugins: PhysicsPlugins, existing: Option<Scalar>) -> Scalar {
        let mut app = App::new();
        if let Some(unit) = existing {
            app.insert_resource(PhysicsLengthUnit(unit));
        }
        app.add_plugins((TransformPlugin, plugins));
        app.world().resource::<PhysicsLengthUnit>().0
    }

    assert_eq!(unit(PhysicsPlugins::default(), None), 1.0);
    assert_eq!(unit(PhysicsPlugins::default(), Some(50.0)), 50.0);
    assert_eq!(unit(PhysicsPlugins::default().with_length_unit(100.0), Some(50.0)), 100.0);
    for wrong in [0.0, -3.0, Scalar::NAN, Scalar::INFINITY] {
        assert_eq!(unit(PhysicsPlugins::default().with_length_unit(wrong), None), 1.0);
    }
}

/// A collider type of the app.
#[derive(Component)]
pub(crate) struct Marble(pub(crate) Collider);

impl AnyCollider for Marble {
    type Context = ();

    fn aabb_with_context(
        &self,
        position: Vector,
        rotation: impl Into<Rotation>,
        _: AabbContext<()>,
    ) -> ColliderAabb {
        self.0.aabb(position, rotation)
    }

    fn contact_manifolds_with_context(
        &self,
        other: &Self,
        position1: Vector,
        rotation1: impl Into<Rotation>,
        position2: Vector,
        rotation2: impl Into<Rotation>,
        prediction_distance: Scalar,
        manifolds: &mut Vec<ContactManifold>,
        _: ContactManifoldContext<()>,
    ) {
        let (a, b) = (&self.0, &other.0);
        a.contact_manifolds(b, position1, rotation1, position2, rotation2, prediction_distance, manifolds);
    }
}

impl ScalableCollider for Marble {
    fn scale(&self) -> Vector {
        self.0.scale()
    }

    fn set_scale(&mut self, scale: Vector, detail: u32) {
        self.0.set_scale(scale, detail);
    }
}

/// Collision hooks of the app.
#[derive(SystemParam)]
struct Hooks<'w, 's> {
    _bodies: Query<'w, 's, &'static RigidBody>,
}

impl CollisionHooks for Hooks<'_, '_> {}

#[test]
fn plugins_for_a_second_collider_type_leave_the_first_as_it_was() {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update))).add_plugins((
        ColliderBackendPlugin::<Marble>::new(Update),
        ColliderTreePlugin::<Marble>::default(),
        NarrowPhasePlugin::<Marble>::default(),
        NarrowPhasePlugin::<Collider, Hooks>::new(PhysicsSchedule, false),
        BvhBroadPhasePlugin::<Hooks>::default(),
    ));
    app.finish();
    app.cleanup();
    let ball = || Collider::from(SharedShape::ball(0.5));
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
    let body = app.world_mut().spawn((RigidBody::Dynamic, ball(), Transform::from_xyz(0.0, 1.0, 0.0))).id();
    let own = app.world_mut().spawn((RigidBody::Dynamic, Marble(ball()))).id();
    for _ in 0..120 {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 60.0));
        app.update();
    }
    let height = |entity: Entity| app.world().get::<Position>(entity).expect("a body has a position").y;
    assert!((height(body) - 0.5).abs() < 0.02);
    let mass = |entity: Entity| app.world().get::<ComputedMass>(entity).expect("a body has a mass").value();
    assert_eq!(mass(own), mass(body));
}

#[derive(bevy_ecs::schedule::ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct Motion;

#[test]
fn integration_happens_where_the_app_runs_it() {
    let fall = |group: PluginGroupBuilder, runs_motion: bool| {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, group));
        if runs_motion {
            let run = |world: &mut World| world.run_schedule(Motion);
            app.add_systems(SubstepSchedule, run.in_set(IntegrationSystems::Velocity));
        }
        app.finish();
        app.cleanup();
        let body = app.world_mut().spawn(RigidBody::Dynamic).id();
        for _ in 0..30 {
            app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 60.0));
            app.update();
        }
        app.world().get::<Position>(body).expect("a body has a position").y
    };
    let group = || PhysicsPlugins::new(Update).build();
    let own = || group().set(IntegratorPlugin::new(Motion));
    assert_eq!(fall(own(), false), 0.0, "nobody runs it");
    let fallen = fall(group(), false);
    assert!(fallen < -1.0);
    assert_eq!(fall(own(), true), fallen);
}
