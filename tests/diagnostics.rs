//! Timers and counters in Bevy's diagnostics.

use avian::{
    collision::CollisionDiagnostics,
    diagnostics::{
        AppDiagnosticsExt, DiagnosticPath, PhysicsDiagnostics, PhysicsEntityDiagnostics,
        PhysicsTotalDiagnostics, ui::PhysicsDiagnosticsUiNode,
    },
    dynamics::solver::SolverDiagnostics,
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_diagnostic::DiagnosticsStore;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use bevy_ui::widget::Text;
use core::time::Duration;

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app
}

fn steps(app: &mut App, count: u32) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(16));
        app.update();
    }
}

fn value(app: &App, path: &DiagnosticPath) -> Option<f64> {
    app.world().resource::<DiagnosticsStore>().get(path)?.value()
}

/// A box with half its side.
fn cube(half: Scalar) -> Collider {
    let mut corners = vec![Vector::ZERO];
    for axis in Vector::AXES {
        corners = corners.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

/// Two boxes on a large one, and one alone.
fn spawn_boxes(app: &mut App) {
    app.world_mut().spawn((RigidBody::Static, cube(10.0), Transform::from_xyz(0.0, -10.0, 0.0)));
    for x in [-1.0, 1.0, 100.0] {
        app.world_mut().spawn((RigidBody::Dynamic, cube(0.5), Transform::from_xyz(x, 0.4, 0.0)));
    }
    app.world_mut().spawn(RigidBody::Kinematic);
}

/// Counts its own resets.
#[derive(Resource, Default)]
struct Shots {
    fired: u32,
    reload: Duration,
}

const FIRED: &DiagnosticPath = &DiagnosticPath::const_new("game/shots_fired");
const RELOAD: &DiagnosticPath = &DiagnosticPath::const_new("game/reload");

impl PhysicsDiagnostics for Shots {
    fn counter_paths(&self) -> Vec<(&'static DiagnosticPath, u32)> {
        vec![(FIRED, self.fired)]
    }

    fn timer_paths(&self) -> Vec<(&'static DiagnosticPath, Duration)> {
        vec![(RELOAD, self.reload)]
    }
}

fn shoot(mut shots: ResMut<Shots>) {
    shots.fired += 3;
    shots.reload += Duration::from_millis(20);
}

#[test]
fn counters_and_timers_of_a_step_are_in_bevys_diagnostics() {
    let mut app = app();
    app.add_plugins(PhysicsDiagnosticsPlugin);
    app.finish();
    spawn_boxes(&mut app);
    steps(&mut app, 5);
    assert_eq!(value(&app, PhysicsEntityDiagnostics::DYNAMIC_BODY_COUNT), Some(3.0));
    assert_eq!(value(&app, PhysicsEntityDiagnostics::KINEMATIC_BODY_COUNT), Some(1.0));
    assert_eq!(value(&app, PhysicsEntityDiagnostics::STATIC_BODY_COUNT), Some(1.0));
    assert_eq!(value(&app, PhysicsEntityDiagnostics::COLLIDER_COUNT), Some(4.0));
    assert_eq!(value(&app, CollisionDiagnostics::CONTACT_COUNT), Some(2.0));
    assert_eq!(value(&app, SolverDiagnostics::CONTACT_CONSTRAINT_COUNT), Some(2.0));
    assert_eq!(value(&app, PhysicsTotalDiagnostics::STEP_NUMBER), Some(5.0));
    let total = value(&app, PhysicsTotalDiagnostics::STEP_TIME).expect("it is measured");
    let parts: f64 = [
        CollisionDiagnostics::NARROW_PHASE,
        SolverDiagnostics::SOLVE_CONSTRAINTS,
        PhysicsTotalDiagnostics::MISCELLANEOUS,
    ]
    .map(|path| value(&app, path).expect("it is measured"))
    .iter()
    .sum();
    assert!(total > 0.0 && parts > 0.0 && parts <= total * 1.001, "{parts} of {total} ms");
    assert_eq!(app.world().resource::<PhysicsTotalDiagnostics>().step_number, 5);
}

#[test]
fn the_plugin_may_be_added_before_those_of_physics() {
    let mut app = App::new();
    app.add_plugins((PhysicsDiagnosticsPlugin, TaskPoolPlugin::default(), TransformPlugin));
    app.add_plugins(PhysicsPlugins::new(Update));
    app.finish();
    spawn_boxes(&mut app);
    steps(&mut app, 3);
    assert_eq!(value(&app, CollisionDiagnostics::CONTACT_COUNT), Some(2.0));
    assert_eq!(value(&app, PhysicsTotalDiagnostics::STEP_NUMBER), Some(3.0));
}

#[test]
fn counters_of_the_app_are_reset_and_written_in_each_step() {
    // Registered before the plugin, after it, and twice.
    for late in [false, true] {
        let mut app = app();
        if late {
            app.add_plugins(PhysicsDiagnosticsPlugin);
        }
        app.register_physics_diagnostics::<Shots>();
        app.register_physics_diagnostics::<Shots>();
        if !late {
            app.add_plugins(PhysicsDiagnosticsPlugin);
        }
        app.add_systems(PhysicsSchedule, shoot.in_set(PhysicsStepSystems::Finalize));
        app.finish();
        steps(&mut app, 4);
        assert_eq!(value(&app, FIRED), Some(3.0), "late: {late}");
        assert_eq!(value(&app, RELOAD), Some(20.0), "late: {late}");
    }
}

#[test]
fn nothing_is_written_without_the_plugin_or_while_physics_is_paused() {
    let mut app = app();
    app.register_physics_diagnostics::<Shots>();
    app.finish();
    steps(&mut app, 2);
    assert!(!app.world().contains_resource::<DiagnosticsStore>());

    let mut app = self::app();
    app.add_plugins(PhysicsDiagnosticsPlugin);
    app.finish();
    steps(&mut app, 2);
    app.world_mut().resource_mut::<Time<Physics>>().pause();
    steps(&mut app, 10);
    assert_eq!(value(&app, PhysicsTotalDiagnostics::STEP_NUMBER), Some(2.0));
}

/// Name and value of each row of the panel.
fn rows(app: &mut App) -> Vec<[String; 2]> {
    let world = app.world_mut();
    let rows: Vec<Vec<Entity>> = world.query::<&Children>().iter(world).map(|row| row.to_vec()).collect();
    let text = |entity: &Entity| world.get::<Text>(*entity).map(|text| text.0.clone());
    let texts = rows.iter().map(|row| row.iter().filter_map(text).collect::<Vec<_>>());
    texts.filter_map(|row| row.try_into().ok()).collect()
}

#[test]
fn the_panel_shows_each_value_while_it_is_enabled() {
    let mut app = app();
    app.add_plugins(PhysicsDiagnosticsUiPlugin);
    app.finish();
    spawn_boxes(&mut app);
    steps(&mut app, 3);
    let shown = rows(&mut app);
    for expected in ["Dynamic bodies", "Contact count", "Total step time", "Miscellaneous"] {
        assert!(shown.iter().any(|[name, _]| name == expected), "{expected}: {shown:?}");
    }
    assert!(shown.contains(&["Colliders".to_string(), "4".to_string()]), "{shown:?}");
    let world = app.world_mut();
    assert_eq!(world.query::<&PhysicsDiagnosticsUiNode>().iter(world).count(), 1);

    world.resource_mut::<PhysicsDiagnosticsUiSettings>().enabled = false;
    steps(&mut app, 1);
    let world = app.world_mut();
    assert_eq!(world.query::<&PhysicsDiagnosticsUiNode>().iter(world).count(), 0);
    assert_eq!(world.query::<&Text>().iter(world).count(), 0);

    // A counter that is registered late gets its row.
    app.register_physics_diagnostics::<Shots>();
    app.world_mut().resource_mut::<PhysicsDiagnosticsUiSettings>().enabled = true;
    steps(&mut app, 2);
    let shown = rows(&mut app);
    assert!(shown.iter().any(|[name, _]| name == "Shots fired"), "{shown:?}");
}

/// Each heading of the panel with the names below it.
fn panel(app: &mut App) -> Vec<(String, Vec<String>)> {
    let world = app.world_mut();
    let panel = world.query_filtered::<&Children, With<PhysicsDiagnosticsUiNode>>().single(world);
    let text = |entity: Entity| world.get::<Text>(entity).map(|text| text.0.clone());
    let mut groups: Vec<(String, Vec<String>)> = Vec::new();
    for line in panel.expect("one panel").iter() {
        match (text(line), world.get::<Children>(line)) {
            (Some(heading), _) => groups.push((heading, vec![])),
            (None, row) => {
                let name = row.and_then(|row| text(row[0])).expect("a row begins with its name");
                groups.last_mut().expect("a heading comes first").1.push(name);
            }
        }
    }
    groups
}

#[test]
fn the_panel_groups_its_rows_under_headings() {
    let mut app = app();
    app.add_plugins((PhysicsDiagnosticsUiPlugin, PhysicsPickingPlugin));
    app.register_physics_diagnostics::<Shots>();
    app.finish();
    steps(&mut app, 2);
    let panel = panel(&mut app);
    let below = |heading: &str| {
        let mut all = panel.iter().filter(|group| group.0 == heading);
        let rows = all.next().map(|group| group.1.clone()).unwrap_or_default();
        assert!(all.next().is_none(), "one heading {heading}: {panel:?}");
        rows
    };
    assert_eq!(below("Collision"), ["Broad phase", "Update contacts", "Contact count"]);
    assert_eq!(below("Collider tree"), ["Optimize", "Update"]);
    assert_eq!(below("Spatial query"), ["Update ray casters", "Update shape casters"]);
    assert_eq!(below("Whole step"), ["Total step time", "Step number", "Miscellaneous"]);
    assert_eq!(below("Picking"), ["Update hits"]);
    assert_eq!(below("Game"), ["Reload", "Shots fired"]);
    assert_eq!(below("Entity count").len(), 5);
    assert!(below("Solver").len() > 10);
    let rows: usize = panel.iter().map(|group| group.1.len()).sum();
    let world = app.world_mut();
    assert_eq!(rows + panel.len() + rows, world.query::<&Text>().iter(world).count());
}
