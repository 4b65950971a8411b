//! The plugin group: it builds, configures what it says, and does without any one of its plugins.

use avian::{PhysicsTypeRegistrationPlugin, dynamics::solver::SolverConfig, math::Scalar, prelude::*};
use bevy_app::{PluginGroupBuilder, prelude::*};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use core::time::Duration;

/// A headless app with the plugins of `group` that ran for ten ticks.
fn run(group: impl FnOnce(PluginGroupBuilder) -> PluginGroupBuilder) -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
        .add_plugins(group(PhysicsPlugins::default().build()))
        .insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 64.0)));
    app.finish();
    app.cleanup();
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
    let elapsed = app.world().resource::<bevy_time::Time<Physics>>().elapsed();
    assert!(elapsed >= Duration::from_millis(9 * 15), "{elapsed:?}");
}

/// Runs the group without each of a list of plugins.
macro_rules! runs_without {
    ($($test:ident: $plugin:ty),* $(,)?) => {
        $(
            #[test]
            fn $test() {
                let app = run(|group| group.disable::<$plugin>());
                assert!(!app.is_plugin_added::<$plugin>());
            }
        )*
    };
}

runs_without! {
    without_type_registration: PhysicsTypeRegistrationPlugin,
    without_mass_properties: MassPropertyPlugin,
    without_collider_hierarchy: ColliderHierarchyPlugin,
    without_collider_transform: ColliderTransformPlugin,
    without_collider_backend: ColliderBackendPlugin<Collider>,
    without_collider_tree: ColliderTreePlugin<Collider>,
    without_narrow_phase: NarrowPhasePlugin<Collider>,
    without_solver_body: SolverBodyPlugin,
    without_solver_schedule: SolverSchedulePlugin,
    without_integrator: IntegratorPlugin,
    without_solver: SolverPlugin,
    without_islands: IslandPlugin,
    without_sleeping: IslandSleepingPlugin,
    without_broad_phase_stages: BroadPhaseCorePlugin,
    without_broad_phase: BvhBroadPhasePlugin,
    without_transforms: PhysicsTransformPlugin,
    without_interpolation: PhysicsInterpolationPlugin,
}

#[test]
fn without_schedule_no_step_is_taken() {
    #[derive(bevy_ecs::resource::Resource)]
    struct Stepped;

    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin))
        .add_plugins(PhysicsPlugins::default().build().disable::<PhysicsSchedulePlugin>())
        .add_systems(PhysicsSchedule, |mut commands: bevy_ecs::system::Commands| {
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
