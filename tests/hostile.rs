//! Input that makes no sense is refused with an error, mended or quarantined with a warning; it never ends in a
//! panic, and never reaches bodies that have nothing to do with it.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{AsF32, Scalar, Vector},
    parry::shape::SharedShape,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{entity_disabling::Disabled, prelude::*};
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;

use super::dim;

const DT: Duration = Duration::from_nanos(1_000_000_000 / 60);
/// What is no coordinate.
const WRONG: [Scalar; 3] = [Scalar::NAN, Scalar::INFINITY, Scalar::NEG_INFINITY];
/// What is no length, mass or density.
const WRONG_SIZES: [Scalar; 5] = [Scalar::NAN, Scalar::INFINITY, Scalar::NEG_INFINITY, 0.0, -1.0];

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.finish();
    app.cleanup();
    app
}

fn step_by(app: &mut App, dt: Duration) {
    app.world_mut().resource_mut::<Time>().advance_by(dt);
    app.update();
}

fn steps(app: &mut App, count: u32) {
    (0..count).for_each(|_| step_by(app, DT));
}

fn ball() -> Collider {
    SharedShape::ball(0.5).into()
}

fn at(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

fn floor(app: &mut App) -> Entity {
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y))).id()
}

/// A ball that lies on the floor.
fn resting(app: &mut App, x: f32) -> Entity {
    app.world_mut().spawn((RigidBody::Dynamic, ball(), at(x, 0.5))).id()
}

fn position(app: &App, entity: Entity) -> Vector {
    app.world().get::<Position>(entity).expect("a body has a position").0
}

fn is_disabled(app: &App, entity: Entity) -> bool {
    app.world().get::<RigidBodyDisabled>(entity).is_some()
}

/// A floor with a ball at rest on it, which must not notice anything.
struct Witness {
    app: App,
    ball: Entity,
}

impl Witness {
    fn new() -> Self {
        let mut app = app();
        floor(&mut app);
        let ball = resting(&mut app, -20.0);
        Self { app, ball }
    }

    fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        self.app.world_mut().spawn(bundle).id()
    }

    fn insert(&mut self, entity: Entity, bundle: impl Bundle) {
        self.app.world_mut().entity_mut(entity).insert(bundle);
    }

    /// Takes steps, after which the witness lies where it lay, and a body that is put there now falls and
    /// comes to rest, as ever.
    fn is_undisturbed(&mut self) {
        steps(&mut self.app, 30);
        let late = self.spawn((RigidBody::Dynamic, ball(), at(-30.0, 0.7)));
        steps(&mut self.app, 60);
        for (entity, x) in [(self.ball, -20.0), (late, -30.0)] {
            let off = position(&self.app, entity) - (Vector::X * x + Vector::Y * 0.5);
            assert!(off.length() < 0.02, "the witness is off by {off}");
            assert!(!is_disabled(&self.app, entity));
        }
        self.app.world_mut().despawn(late);
    }
}

/// Whether a body is one of those that must not notice anything.
fn is_witness(position: &Position) -> bool {
    position.x < -10.0
}

#[test]
fn a_position_that_is_not_finite_is_put_back_and_its_body_disabled() {
    for wrong in WRONG {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let ill = witness.spawn((body, ball(), at(0.0, 0.5)));
            let neighbour = witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 1.5)));
            steps(&mut witness.app, 5);
            witness.insert(ill, Position(Vector::X * wrong));
            witness.is_undisturbed();
            assert!(is_disabled(&witness.app, ill), "{body:?} at {wrong}");
            assert!(position(&witness.app, ill).length() < 1.0);
            assert!(position(&witness.app, neighbour).is_finite());
            // Mended, it takes part again.
            witness.app.world_mut().entity_mut(ill).remove::<RigidBodyDisabled>();
            witness.insert(ill, (Position(Vector::Y * 3.0), LinearVelocity(Vector::ZERO)));
            steps(&mut witness.app, 10);
            assert_eq!(position(&witness.app, ill).y < 2.9, body.is_dynamic());
        }
    }
}

#[test]
fn a_body_spawned_where_no_place_is_does_not_enter() {
    for wrong in WRONG {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let ill = witness.spawn((body, ball(), Position(Vector::Y * wrong)));
            witness.spawn((body, ball(), Transform::from_xyz(f32::NAN, 0.0, 0.0)));
            witness.is_undisturbed();
            assert!(is_disabled(&witness.app, ill), "{body:?} at {wrong}");
        }
    }
}

#[test]
fn a_velocity_that_is_not_finite_stops_its_body_and_no_other() {
    for wrong in WRONG {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let ill = witness.spawn((body, ball(), at(0.0, 0.5)));
            let neighbour = witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 1.5)));
            steps(&mut witness.app, 5);
            witness.insert(ill, LinearVelocity(Vector::Y * wrong));
            witness.is_undisturbed();
            assert!(is_disabled(&witness.app, ill), "{body:?} with {wrong} m/s");
            assert!(position(&witness.app, ill).is_finite() && position(&witness.app, neighbour).is_finite());
            let velocity = witness.app.world().get::<LinearVelocity>(ill).expect("a body has a velocity");
            assert_eq!(velocity.0, Vector::ZERO);
        }
    }
}

#[test]
fn an_angular_velocity_that_is_not_finite_stops_its_body_and_no_other() {
    for wrong in WRONG {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let late = witness.spawn((body, ball(), at(0.0, 0.5)));
            let early = witness.spawn((body, ball(), at(5.0, 0.5), dim::spin(wrong)));
            steps(&mut witness.app, 5);
            witness.insert(late, dim::spin(wrong));
            witness.is_undisturbed();
            for ill in [late, early] {
                assert!(is_disabled(&witness.app, ill), "{body:?} with {wrong} rad/s");
                assert!(position(&witness.app, ill).is_finite());
            }
        }
    }
}

/// A box whose sides can be told from its corners.
fn block() -> Collider {
    Collider::convex_hull(corners(0.5)).expect("a box is convex")
}

#[test]
fn a_rotation_without_direction_disables_its_body() {
    for wrong in [Scalar::NAN, Scalar::INFINITY, 0.0] {
        for body in [RigidBody::Dynamic, RigidBody::Kinematic, RigidBody::Static] {
            let mut witness = Witness::new();
            let rotation = dim::scaled(wrong);
            let early = witness.spawn((body, block(), at(0.0, 0.5), rotation));
            let late = witness.spawn((body, block(), at(5.0, 0.5)));
            steps(&mut witness.app, 5);
            witness.insert(late, rotation);
            witness.is_undisturbed();
            assert!([early, late].iter().all(|e| is_disabled(&witness.app, *e)), "{body:?} by {wrong}");
            let held = *witness.app.world().get::<Rotation>(late).expect("a body has a rotation");
            assert!((held * Vector::X - Vector::X).length() < 1.0e-3, "it is put back: {held:?}");
        }
    }
}

#[test]
fn a_rotation_of_another_length_is_one_of_unit_length() {
    for length in [0.5, 2.0, 1.0e-9, 1.0e9] {
        let mut witness = Witness::new();
        // Nobody but the blocks on it.
        let apart = CollisionLayers::new(2, 2);
        let table = (RigidBody::Static, block(), dim::scaled(length), Position(Vector::Y * 3.0), apart);
        witness.spawn(table);
        let on_it = witness.spawn((RigidBody::Dynamic, block(), dim::scaled(length), at(0.0, 4.0), apart));
        let body = witness.spawn((RigidBody::Dynamic, block(), dim::scaled(length), at(5.0, 0.5)));
        steps(&mut witness.app, 10);
        witness.insert(body, dim::scaled(length));
        witness.is_undisturbed();
        for (entity, y) in [(on_it, 4.0), (body, 0.5)] {
            assert!(!is_disabled(&witness.app, entity));
            let off = position(&witness.app, entity).y - y;
            assert!(off.abs() < 0.02, "with a length of {length} it is off by {off}");
            // Given once, it does not count as another in every step.
            assert!(witness.app.world().get::<Sleeping>(entity).is_some(), "{length}");
        }
    }
}

#[test]
fn without_the_sync_a_body_with_a_position_alone_is_not_turned() {
    for body in [RigidBody::Dynamic, RigidBody::Static] {
        let mut app = App::new();
        let plugins = PhysicsPlugins::new(Update).build().disable::<PhysicsTransformPlugin>();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, plugins));
        app.finish();
        app.cleanup();
        app.insert_resource(Gravity::ZERO);
        // Who would require them without the plugin?
        let pose = (Position(Vector::Y), Rotation::PLACEHOLDER);
        let block = app.world_mut().spawn((body, block(), pose, Transform::IDENTITY)).id();
        let child = app.world_mut().spawn((ball(), at(0.0, 3.0), ChildOf(block))).id();
        steps(&mut app, 10);
        assert!(!is_disabled(&app, block));
        assert_eq!(position(&app, block), Vector::Y);
        assert_eq!(position(&app, child), Vector::Y * 4.0);
        let aabb = app.world().get::<ColliderAabb>(block).expect("a collider has a box");
        assert!((aabb.max - aabb.min - Vector::ONE).length() < 1.0e-4, "{aabb:?}");
    }
}

/// The box of a collider.
fn aabb(app: &App, entity: Entity) -> ColliderAabb {
    *app.world().get(entity).expect("a collider has a box")
}

#[test]
fn a_collider_whose_place_is_not_finite_takes_no_part_until_it_is() {
    for wrong in WRONG {
        let mut witness = Witness::new();
        let alone = witness.spawn((ball(), Position(Vector::X * wrong), Sensor));
        let moved = witness.spawn((ball(), at(3.0, 3.0), Sensor));
        let body = witness.spawn((RigidBody::Kinematic, LinearVelocity(Vector::Y), at(0.0, 9.0)));
        let child = witness.spawn((ball(), Transform::IDENTITY, ChildOf(body)));
        steps(&mut witness.app, 2);
        let offset = Transform::from_xyz(wrong as f32, 0.0, 0.0);
        witness.insert(moved, Position(Vector::X * wrong));
        witness.insert(child, offset);
        witness.is_undisturbed();
        for collider in [moved, child] {
            let aabb = aabb(&witness.app, collider);
            assert!(aabb.min.is_finite() && aabb.max.is_finite(), "{aabb:?} at {wrong}");
        }
        witness.insert(alone, Position(Vector::X * 7.0));
        witness.insert(moved, Position(Vector::X * 8.0));
        witness.insert(child, at(9.0, 0.0));
        witness.is_undisturbed();
        for (collider, x) in [(alone, 7.0), (moved, 8.0), (child, 9.0)] {
            let aabb = aabb(&witness.app, collider);
            assert!((aabb.min.x - x + 0.5).abs() < 0.01, "{aabb:?} should be about {x}");
        }
    }
}

#[test]
fn a_sleeping_body_with_a_velocity_of_nan_is_quarantined() {
    let mut witness = Witness::new();
    let ill = resting(&mut witness.app, 0.0);
    steps(&mut witness.app, 120);
    assert!(witness.app.world().get::<Sleeping>(ill).is_some());
    witness.insert(ill, LinearVelocity(Vector::splat(Scalar::NAN)));
    witness.is_undisturbed();
    assert!(is_disabled(&witness.app, ill));
}

#[test]
fn speeds_and_distances_near_the_limits_of_floats_stay_with_their_body() {
    for huge in [1.0e12, 1.0e19, 1.0e30, 3.0e38] {
        let mut witness = Witness::new();
        witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 0.5), LinearVelocity(Vector::X * huge)));
        witness.spawn((RigidBody::Kinematic, ball(), at(3.0, 0.5), LinearVelocity(Vector::NEG_Y * huge)));
        witness.spawn((RigidBody::Dynamic, ball(), Position(Vector::X * huge)));
        witness.spawn((RigidBody::Dynamic, ball(), Position(Vector::NEG_X * huge)));
        witness.is_undisturbed();
    }
}

#[test]
fn sizes_that_are_none_make_colliders_that_can_be_lived_with() {
    for wrong in WRONG_SIZES {
        let mut witness = Witness::new();
        // What is infinitely large becomes very large, and would rightly push everybody.
        let apart = CollisionLayers::new(2, 2);
        let shapes = [
            Collider::capsule(wrong, 1.0),
            Collider::capsule(0.5, wrong),
            Collider::capsule_endpoints(0.5, Vector::splat(wrong), Vector::X),
            Collider::segment(Vector::splat(wrong), Vector::X),
            Collider::polyline(vec![Vector::splat(wrong), Vector::X, Vector::splat(wrong)], None),
            Collider::polyline(vec![], None),
        ];
        for (i, shape) in shapes.into_iter().enumerate() {
            witness.spawn((RigidBody::Dynamic, shape, at(4.0 * i as f32, 1.0), apart));
        }
        // Past the constructors, straight from parry.
        witness.spawn((RigidBody::Dynamic, Collider::from(SharedShape::ball(wrong)), at(40.0, 1.0), apart));
        witness.is_undisturbed();
    }
}

#[test]
fn a_scale_that_is_none_is_ignored_or_tiny() {
    for wrong in WRONG_SIZES {
        let mut witness = Witness::new();
        let shapes = [(0.0, ball()), (3.0, block()), (6.0, Collider::capsule(0.2, 0.3))];
        let scaled = shapes.map(|(x, shape)| witness.spawn((RigidBody::Dynamic, shape, at(x, 1.0))));
        steps(&mut witness.app, 30);
        for body in scaled {
            let mut collider = witness.app.world_mut().get_mut::<Collider>(body).expect("a collider");
            collider.set_scale(Vector::splat(wrong), 8);
        }
        witness.is_undisturbed();
        for body in scaled {
            assert!(!is_disabled(&witness.app, body) && position(&witness.app, body).is_finite(), "{wrong}");
        }
    }
}

#[test]
fn meshes_of_nothing_can_be_lived_with() {
    let (zero, nan) = (Vector::ZERO, Vector::splat(Scalar::NAN));
    // In a line, in one point, at no place, out of range, none at all.
    let line: Vec<Vector> = (0..3).map(|i| Vector::X * i as Scalar).collect();
    let meshes = [
        (line, vec![[0, 1, 2]]),
        (vec![zero; 3], vec![[0, 1, 2], [2, 1, 0]]),
        (vec![zero, Vector::X, nan], vec![[0, 1, 2]]),
        (vec![zero, Vector::X, Vector::Y], vec![[0, 1, 2], [0, 1, 7], [u32::MAX; 3]]),
        (vec![], vec![]),
        (vec![], vec![[0, 1, 2]]),
    ];
    for (vertices, indices) in meshes {
        for flags in [TrimeshFlags::empty(), TrimeshFlags::FIX_INTERNAL_EDGES, TrimeshFlags::all()] {
            let mut witness = Witness::new();
            for (i, body) in [RigidBody::Static, RigidBody::Dynamic].into_iter().enumerate() {
                let x = 5.0 * i as f32;
                let mesh = Collider::trimesh_with_config(vertices.clone(), indices.clone(), flags);
                let mesh = witness.spawn((body, mesh, at(x, 1.0)));
                let above = witness.spawn((RigidBody::Dynamic, block(), at(x + 0.3, 2.0)));
                steps(&mut witness.app, 30);
                let given = format!("{vertices:?} {indices:?} {flags:?}");
                assert!(position(&witness.app, mesh).is_finite(), "{given}");
                assert!(
                    position(&witness.app, above).is_finite() && !is_disabled(&witness.app, above),
                    "{given}"
                );
            }
            witness.is_undisturbed();
        }
    }
}

#[test]
fn boxes_written_by_the_app_are_not_believed() {
    for (min, max) in
        [(Vector::X, Vector::NEG_X), (Vector::NAN, Vector::NAN), (Vector::NEG_INFINITY, Vector::INFINITY)]
    {
        for body in [RigidBody::Dynamic, RigidBody::Static] {
            let mut witness = Witness::new();
            let ill = witness.spawn((body, ball(), at(0.0, 0.5), ColliderAabb::from_min_max(min, max)));
            steps(&mut witness.app, 5);
            witness.insert(ill, ColliderAabb::from_min_max(min, max));
            let on_it =
                witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 1.6), LockedAxes::ROTATION_LOCKED));
            witness.is_undisturbed();
            assert!(position(&witness.app, on_it).is_finite() && !is_disabled(&witness.app, ill));
        }
    }
}

#[test]
fn hulls_that_span_nothing_are_refused() {
    let nan = Vector::splat(Scalar::NAN);
    let in_a_line = (0..5).map(|i| Vector::X * i as Scalar).collect();
    for points in [
        vec![],
        vec![Vector::ZERO],
        vec![Vector::ZERO, Vector::X],
        vec![Vector::X; 10],
        vec![nan; 10],
        vec![Vector::ZERO, Vector::X, Vector::Y, nan],
        in_a_line,
    ] {
        assert!(Collider::convex_hull(points.clone()).is_none(), "{points:?}");
    }
}

#[test]
fn masses_that_are_none_leave_the_others_alone() {
    for wrong in WRONG_SIZES {
        let mut witness = Witness::new();
        let bodies = [
            witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 0.6), Mass(wrong as f32))),
            witness.spawn((RigidBody::Dynamic, ball(), at(2.0, 0.6), ColliderDensity(wrong as f32))),
            witness.spawn((RigidBody::Dynamic, ball(), at(4.0, 0.6), GravityScale(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(6.0, 0.6), LinearDamping(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(8.0, 0.6), AngularDamping(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(10.0, 0.6), MaxLinearSpeed(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(12.0, 0.6), MaxAngularSpeed(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(14.0, 0.6), Friction::new(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(16.0, 0.6), Restitution::new(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(18.0, 0.6), CollisionMargin(wrong.min(1.0)))),
            witness.spawn((RigidBody::Dynamic, ball(), at(20.0, 0.6), SpeculativeMargin(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(22.0, 0.6), dim::inertia(wrong as f32))),
            witness.spawn((
                RigidBody::Dynamic,
                ball(),
                at(26.0, 0.6),
                CenterOfMass(Vector::splat(wrong).f32()),
            )),
            witness.spawn((
                RigidBody::Dynamic,
                ball(),
                at(30.0, 0.6),
                SleepThreshold { linear: wrong as f32, angular: wrong as f32 },
            )),
        ];
        witness.is_undisturbed();
        for (i, body) in bodies.into_iter().enumerate() {
            assert!(!is_disabled(&witness.app, body), "body {i} with {wrong}");
            assert!(position(&witness.app, body).is_finite(), "body {i} with {wrong}");
        }
    }
}

#[test]
fn damping_of_nan_is_no_damping() {
    let mut app = app();
    let plain = app.world_mut().spawn((RigidBody::Dynamic, at(0.0, 0.0))).id();
    let damped = (LinearDamping(Scalar::NAN), AngularDamping(Scalar::NAN));
    let damped = app.world_mut().spawn((RigidBody::Dynamic, at(0.0, 0.0), damped)).id();
    steps(&mut app, 30);
    assert!(!is_disabled(&app, damped));
    assert_eq!(position(&app, plain), position(&app, damped));
}

#[test]
fn friction_without_bounds_sticks() {
    for mu in [Scalar::INFINITY, Scalar::MAX, 1.0e30] {
        let mut app = app();
        let friction = Friction::new(mu).with_combine_rule(CoefficientCombine::Multiply);
        app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::X + Vector::Y), friction));
        let block = Collider::convex_hull(corners(0.5)).expect("a box is convex");
        let body = (RigidBody::Dynamic, block, friction, LockedAxes::ROTATION_LOCKED);
        let body = app.world_mut().spawn((body, at(0.5, 0.5))).id();
        steps(&mut app, 60);
        let moved = position(&app, body) - (Vector::X + Vector::Y) * 0.5;
        assert!(moved.length() < 0.05, "with friction {mu} it moved by {moved}");
    }
}

/// The corners of a square or cube by half its side.
fn corners(half: Scalar) -> Vec<Vector> {
    let double = |found: Vec<Vector>, axis: Vector| {
        found.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect()
    };
    Vector::AXES.into_iter().fold(vec![Vector::ZERO], double)
}

#[test]
fn a_dynamic_body_without_mass_falls() {
    let mut app = app();
    let body = app.world_mut().spawn(RigidBody::Dynamic).id();
    steps(&mut app, 60);
    assert!(position(&app, body).y < -4.0);
}

#[test]
fn locked_axes_hold_a_body_with_its_centre_of_mass_far_off() {
    let mut app = app();
    floor(&mut app);
    let compound = |x: Scalar| Collider::compound(vec![(Vector::X * x, Rotation::IDENTITY, ball())]);
    let body = (RigidBody::Dynamic, compound(3.0), LockedAxes::ALL_LOCKED, at(0.0, 0.3));
    let held = app.world_mut().spawn(body).id();
    let body = (RigidBody::Dynamic, compound(3.0), LockedAxes::ROTATION_LOCKED, at(10.0, 0.7));
    let upright = app.world_mut().spawn(body).id();
    steps(&mut app, 120);
    assert_eq!(position(&app, held), Vector::Y * 0.3 as Scalar);
    let at_rest = position(&app, upright);
    assert!((at_rest - Vector::X * 10.0 - Vector::Y * 0.5).length() < 0.02, "{at_rest}");
    let rotation = app.world().get::<Rotation>(upright).expect("a body has a rotation");
    assert_eq!(*rotation, Rotation::IDENTITY);
}

#[test]
fn gravity_that_is_not_finite_is_none() {
    for wrong in WRONG {
        let mut witness = Witness::new();
        witness.app.insert_resource(Gravity(Vector::Y * wrong));
        let free = witness.spawn((RigidBody::Dynamic, at(0.0, 5.0)));
        steps(&mut witness.app, 10);
        assert_eq!(position(&witness.app, free), Vector::Y * 5.0);
        witness.app.insert_resource(Gravity::default());
        witness.is_undisturbed();
    }
}

#[test]
fn a_length_unit_that_is_no_length_counts_as_one() {
    for wrong in WRONG_SIZES {
        let mut witness = Witness::new();
        witness.app.insert_resource(PhysicsLengthUnit(wrong));
        witness.is_undisturbed();
    }
}

#[test]
fn settings_that_are_none_are_survived() {
    use avian::dynamics::solver::SolverConfig;
    for wrong in WRONG_SIZES {
        let mut witness = Witness::new();
        witness.app.insert_resource(SolverConfig {
            contact_damping_ratio: wrong,
            contact_frequency_factor: wrong,
            max_overlap_solve_speed: wrong,
            warm_start_coefficient: wrong,
            restitution_threshold: wrong,
            restitution_iterations: 0,
        });
        let narrow = NarrowPhaseConfig {
            default_speculative_margin: wrong,
            contact_tolerance: wrong,
            match_contacts: false,
        };
        witness.app.insert_resource(narrow).insert_resource(TimeToSleep(wrong as f32));
        let falling = witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 1.0)));
        steps(&mut witness.app, 60);
        assert!(!is_disabled(&witness.app, falling) && position(&witness.app, falling).is_finite());
    }
}

#[test]
fn a_step_of_no_time_changes_nothing() {
    let mut witness = Witness::new();
    let falling = witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 3.0)));
    let overlapping = witness.spawn((RigidBody::Dynamic, ball(), at(5.0, 0.2)));
    steps(&mut witness.app, 1);
    let before = [falling, overlapping, witness.ball].map(|e| position(&witness.app, e));
    witness.app.world_mut().resource_mut::<Time<Physics>>().advance_by(Duration::ZERO);
    for _ in 0..3 {
        witness.app.world_mut().run_schedule(PhysicsSchedule);
    }
    let after = [falling, overlapping, witness.ball].map(|e| position(&witness.app, e));
    assert_eq!(before, after);
    witness.is_undisturbed();
}

#[test]
fn steps_of_ten_seconds_and_of_a_nanosecond_leave_everybody_finite() {
    for dt in [Duration::from_secs(10), Duration::from_nanos(1), Duration::from_secs(100_000)] {
        let mut app = app();
        floor(&mut app);
        let bodies: Vec<Entity> = (0..10).map(|i| resting(&mut app, 0.4 * i as f32)).collect();
        (0..20).for_each(|_| step_by(&mut app, dt));
        assert!(bodies.iter().all(|e| position(&app, *e).is_finite()), "steps of {dt:?}");
        let late = resting(&mut app, -30.0);
        steps(&mut app, 60);
        assert!((position(&app, late).y - 0.5).abs() < 0.02, "after steps of {dt:?}");
    }
}

#[test]
fn no_substeps_count_as_one_and_a_thousand_are_taken() {
    for count in [0, 1, 1000] {
        let mut witness = Witness::new();
        witness.app.insert_resource(SubstepCount(count));
        witness.is_undisturbed();
    }
}

#[test]
fn ten_thousand_colliders_on_one_body_come_and_go() {
    let mut witness = Witness::new();
    let body = witness.spawn((RigidBody::Dynamic, at(0.0, 1.0)));
    for i in 0..10_000 {
        let place = at(0.3 * (i % 100) as f32, 0.3 * (i / 100) as f32);
        witness.spawn((ball(), place, ChildOf(body)));
    }
    steps(&mut witness.app, 50);
    assert!((position(&witness.app, body).y - 0.5).abs() < 0.05);
    witness.insert(body, RigidBody::Static);
    steps(&mut witness.app, 2);
    witness.app.world_mut().despawn(body);
    witness.is_undisturbed();
}

/// Pulls the rug in mid-contact in one way.
type Change = fn(&mut EntityWorldMut);

const CHANGES: [(&str, Change); 12] = [
    ("disables its body", |e| _ = e.insert(RigidBodyDisabled)),
    ("disables its collider", |e| _ = e.insert(ColliderDisabled)),
    ("disables it", |e| _ = e.insert(Disabled)),
    ("makes it dynamic", |e| _ = e.insert(RigidBody::Dynamic)),
    ("makes it kinematic", |e| _ = e.insert(RigidBody::Kinematic)),
    ("removes its body", |e| _ = e.remove::<RigidBody>()),
    ("removes its collider", |e| _ = e.remove::<Collider>()),
    ("makes it a sensor", |e| _ = e.insert(Sensor)),
    ("gives it other layers", |e| _ = e.insert(CollisionLayers::NONE)),
    ("moves it", |e| _ = e.insert(Position(Vector::X * 50.0))),
    ("moves its transform", |e| _ = e.insert(Transform::from_xyz(50.0, 0.0, 0.0))),
    ("gives it another shape", |e| _ = e.insert(Collider::capsule(0.1, 0.1))),
];

/// What holds a sleeping ball up goes, changes or moves: the ball must fall.
#[test]
fn whatever_happens_to_its_support_a_sleeping_body_falls() {
    for (name, change) in CHANGES {
        let mut app = app();
        let block = Collider::convex_hull(corners(1.0)).expect("a box is convex");
        let support = app.world_mut().spawn((RigidBody::Static, block, at(0.0, 0.0))).id();
        let ball = app.world_mut().spawn((RigidBody::Dynamic, ball(), at(0.0, 1.5))).id();
        steps(&mut app, 120);
        assert!(app.world().get::<Sleeping>(ball).is_some(), "{name}: it sleeps first");
        let before = position(&app, ball).y;
        change(&mut app.world_mut().entity_mut(support));
        steps(&mut app, 120);
        let fell = before - position(&app, ball).y;
        assert_eq!(fell > 0.5, name != "makes it kinematic", "{name}: it fell by {fell}");
    }
    let mut app = app();
    let support = floor(&mut app);
    let ball = resting(&mut app, 0.0);
    steps(&mut app, 120);
    app.world_mut().despawn(support);
    steps(&mut app, 60);
    assert!(position(&app, ball).y < -1.0);
}

/// The same, from inside the observers of sleep, to the very body that falls asleep or wakes.
#[test]
fn observers_of_sleep_may_do_anything_to_the_sleeper() {
    for (_, change) in CHANGES.into_iter().chain([("", despawn as Change)]) {
        let mut witness = Witness::new();
        for i in 0..6 {
            resting(&mut witness.app, 0.99 * i as f32);
        }
        let meddle = move |entity: Entity, mut commands: Commands| {
            commands.queue(move |world: &mut World| {
                if let Ok(mut entity) = world.get_entity_mut(entity)
                    && !entity.get::<Position>().is_some_and(is_witness)
                {
                    change(&mut entity);
                }
            });
        };
        witness
            .app
            .add_observer(move |on: On<Add, Sleeping>, commands: Commands| meddle(on.entity, commands));
        witness
            .app
            .add_observer(move |on: On<Remove, Sleeping>, commands: Commands| meddle(on.entity, commands));
        steps(&mut witness.app, 120);
        witness.app.insert_resource(Gravity(Vector::NEG_Y * 10.0));
        witness.is_undisturbed();
    }
}

fn despawn(entity: &mut EntityWorldMut) {
    let id = entity.id();
    entity.world_scope(|world| world.despawn(id));
}

#[test]
fn whoever_sleeps_first_may_despawn_all_other_sleepers() {
    let mut witness = Witness::new();
    for i in 0..6 {
        resting(&mut witness.app, 0.99 * i as f32);
    }
    let despawn_others =
        |on: On<Add, Sleeping>, bodies: Query<(Entity, &RigidBody, &Position)>, mut commands: Commands| {
            for (entity, body, position) in &bodies {
                if body.is_dynamic() && entity != on.entity && !is_witness(position) {
                    commands.entity(entity).try_despawn();
                }
            }
        };
    witness.app.add_observer(despawn_others);
    witness.is_undisturbed();
}

#[test]
fn two_simulations_in_one_process_do_not_meet() {
    let (mut one, mut other) = (Witness::new(), Witness::new());
    let stray = other.spawn((RigidBody::Dynamic, ball(), at(-20.0, 3.0)));
    one.is_undisturbed();
    steps(&mut other.app, 20);
    other.app.world_mut().despawn(stray);
    one.is_undisturbed();
}
