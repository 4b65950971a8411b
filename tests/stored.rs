//! Feature `serialize`: every public type, and a whole world, is read back from a file unchanged, by serde
//! and by reflection.

use avian::{
    PhysicsTypeRegistrationPlugin,
    collision::collider::EnlargedAabb,
    dynamics::{
        integrator::{CustomPositionIntegration, CustomVelocityIntegration, VelocityIntegrationData},
        rigid_body::{
            forces::AccumulatedLocalAcceleration, mass_properties::components::RecomputeMassProperties,
        },
        solver::{
            ContactSoftnessCoefficients, RowWidth, SolverConfig, WorkerCount,
            softness_parameters::{SoftnessCoefficients, SoftnessParameters},
        },
    },
    math::{AsF32, Dir, Scalar, Vector},
    physics_transform::PhysicsTransformConfig,
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{
    entity::{EntityHashMap, SceneEntityMapper},
    prelude::*,
    reflect::{AppTypeRegistry, ReflectComponent, ReflectResource},
    relationship::RelationshipHookMode,
};
use bevy_reflect::{
    PartialReflect, ReflectDeserialize, ReflectSerialize, TypePath, TypeRegistration, TypeRegistry,
    serde::{TypedReflectDeserializer, TypedReflectSerializer},
    std_traits::ReflectDefault,
};
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::{fmt::Debug, time::Duration};
use scenes::dim::{ball, block, spin};
use serde::{Serialize, de::DeserializeOwned, de::DeserializeSeed};

/// Types that are not stored: measurements of a step and the state within it, ticks and ids of a world, and
/// settings of what is shown.
const NOT_STORED: [&str; 24] = [
    "SolverBody",
    "SolverBodyFlags",
    "SolverBodyInertia",
    "InertiaFlags",
    "PreSolveDeltaPosition",
    "PreSolveDeltaRotation",
    "PhysicsGizmos",
    "PhysicsPickingSettings",
    "PhysicsPickable",
    "PhysicsPickingFilter",
    "PhysicsPickingDiagnostics",
    "ContactGizmoScale",
    "DebugRender",
    "PhysicsDiagnosticsUiSettings",
    "PhysicsEntityDiagnostics",
    "PhysicsTotalDiagnostics",
    "CollisionDiagnostics",
    "ColliderTreeDiagnostics",
    "SpatialQueryDiagnostics",
    "SolverDiagnostics",
    "StepTimes",
    "LastPhysicsTick",
    "JointComponentId",
    "Time",
];

fn to_text(value: &impl Serialize) -> String {
    ron::to_string(value).expect("can be stored")
}

/// Stores and reads a value.
#[track_caller]
fn comes_back<T: Serialize + DeserializeOwned + Debug>(value: T) {
    let text = to_text(&value);
    let again: T = ron::from_str(&text).unwrap_or_else(|error| panic!("{error}: {text}"));
    // Floats are printed with enough digits to be unique.
    assert_eq!(format!("{value:?}"), format!("{again:?}"));
    assert_eq!(text, to_text(&again));
}

fn entities<const N: usize>() -> [Entity; N] {
    let mut world = World::new();
    [(); N].map(|()| world.spawn_empty().id())
}

#[test]
fn settings_come_back() {
    comes_back(Gravity(Vector::X * 0.1 - Vector::Y * 3.3));
    comes_back(SubstepCount(9));
    comes_back(NarrowPhaseConfig { contact_tolerance: 0.1, match_contacts: false, ..Default::default() });
    comes_back(NarrowPhaseConfig::default());
    comes_back(*Time::<Physics>::default().with_relative_speed(0.1).context());
    comes_back(Substeps);
    comes_back(PhysicsLengthUnit(0.1));
    comes_back(SolverConfig { warm_start_coefficient: 0.3, restitution_iterations: 3, ..Default::default() });
    comes_back(SoftnessParameters::new(0.7, 33.3));
    comes_back(SoftnessParameters::new(1.0, Scalar::INFINITY));
    comes_back(SoftnessCoefficients { bias: 0.1, mass_scale: 0.2, impulse_scale: 0.3 });
    let softness = ContactSoftnessCoefficients::for_step(&SolverConfig::default(), 0.017, 3);
    let again: ContactSoftnessCoefficients = ron::from_str(&to_text(&softness)).expect("was stored");
    assert!(again == softness);
    comes_back(TimeToSleep(0.7));
    comes_back(DefaultFriction(Friction::new(0.3)));
    comes_back(DefaultRestitution(Restitution::new(0.3)));
    comes_back(PhysicsTransformConfig { propagate_before_physics: false, ..Default::default() });
    comes_back(ColliderTreeOptimization::default());
    comes_back(TreeOptimizationMode::Adaptive { reinsert_threshold: 0.1, partial_rebuild_threshold: 0.7 });
    comes_back((WorkerCount(3), RowWidth::Four, JointSolver::Rigid));
}

#[test]
fn components_come_back() {
    let [body, collider] = entities();
    comes_back((RigidBody::Kinematic, RigidBodyDisabled, Dominance(-3), LockedAxes::ROTATION_LOCKED));
    comes_back((Position(Vector::X * 0.1), Rotation::default() * Rotation::default()));
    comes_back((LinearVelocity(Vector::ONE * 0.3), spin(0.3)));
    comes_back((MaxLinearSpeed(Scalar::INFINITY), MaxAngularSpeed(0.3), GravityScale(-0.1)));
    comes_back((LinearDamping(0.1), AngularDamping(0.2), SpeculativeMargin(0.3), CollisionMargin(0.7)));
    comes_back((CustomPositionIntegration, CustomVelocityIntegration, RecomputeMassProperties));
    comes_back((ConstantForce(Vector::X * 0.1), ConstantTorque(spin(0.3).0), ConstantLocalForce(Vector::Y)));
    comes_back((ConstantLinearAcceleration(Vector::X * 0.1), ConstantAngularAcceleration(spin(0.3).0)));
    comes_back(ConstantLocalLinearAcceleration(Vector::X * 0.1));
    #[allow(clippy::needless_update, reason = "3D has one more field")]
    comes_back(AccumulatedLocalAcceleration { linear: Vector::X * 0.1, ..Default::default() });
    comes_back(VelocityIntegrationData { linear_increment: Vector::X * 0.1, ..Default::default() });
    let friction =
        Friction { dynamic_coefficient: 0.1, static_coefficient: 0.7, combine_rule: CoefficientCombine::Max };
    comes_back((friction, Restitution::new(0.9)));
    comes_back((Sleeping, SleepingDisabled, SleepTimer(0.3), SleepThreshold { linear: 0.1, angular: -1.0 }));
    comes_back(ColliderOf { body });
    comes_back(FixedJoint::new(body, collider).with_anchor(Vector::X * 0.1).with_point_compliance(0.3));
    comes_back(DistanceJoint::new(body, collider).with_limits(0.1, 0.7));
    comes_back(PrismaticJoint::new(body, collider).with_limits(0.1, 0.7).with_motor(LinearMotor::default()));
    comes_back(RevoluteJoint::new(body, collider).with_angle_limits(0.1, 0.7).with_local_anchor2(Vector::Y));
    comes_back(GenericJoint::new(body, collider).with_limits(JointCoordinate::Y, 0.1, 0.7));
    comes_back(WheelJoint::new(body, collider).with_suspension_limits(0.1, 0.7));
    comes_back(GearJoint::new(body, collider).with_ratio(0.3));
    comes_back(RackAndPinionJoint::new(body, collider).with_radius(0.3));
    comes_back(PulleyJoint::new(body, collider, [Vector::X * 0.1, Vector::Y * 0.3]).with_length(0.7));
    comes_back(JointError { length: 0.1, angle: 0.3 });
    comes_back(MouseJoint::new(body).with_max_force(0.3));
    comes_back(JointBreakThreshold::new(0.1, 0.7));
    comes_back((JointDamping { linear: 0.1, angular: 0.3 }, JointForces::new(), JointDisabled));
    comes_back(JointCollisionDisabled);
    let mut world = World::new();
    let listed = world.spawn_empty().id();
    let child = world.spawn(ColliderOf { body: listed }).id();
    world.flush();
    let list = world.get::<RigidBodyColliders>(listed).expect("it has a collider").clone();
    assert_eq!(list.to_vec(), [child]);
    comes_back(list);
    assert_ne!(body, collider);
    comes_back((ColliderMarker, ColliderDisabled, Sensor, ColliderDensity(0.3)));
    comes_back(ColliderTransform { translation: Vector::ONE * 0.1, ..Default::default() });
    comes_back(ColliderAabb::new(Vector::ONE * 0.1, Vector::ONE * 0.3));
    comes_back(EnlargedAabb::default());
    comes_back((CollisionLayers::from_bits(5, 9), LayerMask(7)));
    comes_back((TrimeshFlags::FIX_INTERNAL_EDGES, VhacdParameters::default(), FillMode::SurfaceOnly));
    let named = ColliderConstructorHierarchy::new(ColliderConstructor::TrimeshFromMesh)
        .with_constructor_for_name(
            "a",
            ColliderConstructor::Segment { a: Vector::ZERO, b: Vector::ONE * 0.1 },
        )
        .without_constructor_for_name("a b");
    comes_back(named.config["a"].clone());
    comes_back((named.default_constructor, named.config["a b"].clone()));
    comes_back(MassPropertiesBundle::from_shape(&block(0.3, 0.7, 0.9), 0.1));
    comes_back((
        Mass(0.1),
        AngularInertia::from_shape(&ball(0.3), 0.1),
        CenterOfMass((Vector::ONE * 0.3).f32()),
    ));
    comes_back((ComputedMass::new(0.3), ComputedCenterOfMass(Vector::ONE * 0.1), NoAutoMass));
    comes_back((ComputedAngularInertia::default(), NoAutoAngularInertia, NoAutoCenterOfMass));
    comes_back(ColliderMassProperties::from_shape(&block(0.3, 0.7, 0.9), 0.1));
    let filter = SpatialQueryFilter::from_mask(6).with_excluded_entities([body, collider]);
    comes_back(filter.clone());
    comes_back(RayCaster::new(Vector::ONE * 0.3, Dir::Y).with_max_hits(2).with_query_filter(filter));
    comes_back(RayHits(vec![RayHitData { entity: body, distance: 0.1, normal: Vector::Y }]));
    comes_back(ShapeCastConfig::from_target_distance(0.3).with_max_distance(7.0));
}

#[test]
fn settings_that_would_break_a_clock_are_refused_or_mended() {
    assert!(ron::from_str::<Physics>("(paused: false, relative_speed: 2.0)").is_ok());
    for wrong in ["-1.0", "NaN", "inf"] {
        let text = format!("(paused: false, relative_speed: {wrong})");
        assert!(ron::from_str::<Physics>(&text).is_err(), "{text}");
    }
    for wrong in ["-1.0", "NaN"] {
        let text = format!("(damping_ratio: {wrong}, angular_frequency: {wrong})");
        let softness: SoftnessParameters = ron::from_str(&text).expect("numbers");
        assert_eq!(softness, SoftnessParameters::new(0.0, 0.0));
    }
}

fn stored_by_reflection(value: &dyn PartialReflect, registry: &TypeRegistry) -> String {
    to_text(&TypedReflectSerializer::new(value, registry))
}

fn read_by_reflection(
    text: &str,
    registration: &TypeRegistration,
    registry: &TypeRegistry,
) -> Box<dyn PartialReflect> {
    let mut reader = ron::Deserializer::from_str(text).expect("a value");
    let value = TypedReflectDeserializer::new(registration, registry).deserialize(&mut reader);
    value.unwrap_or_else(|error| panic!("{error}: {text}"))
}

/// The engine's own types of a registry.
fn own_types(registry: &TypeRegistry) -> impl Iterator<Item = &TypeRegistration> {
    let own = |path: &str| path.starts_with("avian2d::") || path.starts_with("avian3d::");
    registry.iter().filter(move |registration| own(registration.type_info().type_path()))
}

#[test]
fn every_reflected_type_comes_back_by_reflection() {
    let mut app = App::empty();
    app.init_resource::<AppTypeRegistry>().add_plugins(PhysicsTypeRegistrationPlugin);
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let (mut count, mut lacking) = (0, Vec::new());
    for registration in own_types(&registry) {
        let name = registration.type_info().type_path_table().short_path();
        if NOT_STORED.contains(&name) {
            continue;
        }
        let stores = registration.data::<ReflectSerialize>().is_some();
        if !stores || registration.data::<ReflectDeserialize>().is_none() {
            lacking.push(name);
        } else if let Some(default) = registration.data::<ReflectDefault>() {
            let value = default.default();
            let text = stored_by_reflection(value.as_partial_reflect(), &registry);
            let again = read_by_reflection(&text, registration, &registry);
            assert_eq!(text, stored_by_reflection(&*again, &registry), "{name}");
            count += 1;
        }
    }
    assert_eq!(lacking, Vec::<&str>::new());
    assert!(count > 40, "{count} types");
}

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)));
    app.register_type::<(Transform, ChildOf)>();
    app.finish();
    app.cleanup();
    app
}

fn steps(app: &mut App, count: u32) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_millis(16));
        app.update();
    }
}

/// An entity in a file: its components by type path, and its collider.
type Line = (Entity, Vec<(String, String)>, Option<String>);

/// A scene of some entities: components by reflection.
fn save(app: &App, entities: &[Entity]) -> String {
    let registry = app.world().resource::<AppTypeRegistry>().read();
    let line = |&entity: &Entity| -> Line {
        let found = app.world().entity(entity);
        let stored = registry.iter().filter_map(|registration| {
            registration.data::<ReflectSerialize>()?;
            let value = registration.data::<ReflectComponent>()?.reflect(found)?;
            let path = registration.type_info().type_path().to_owned();
            // `Children` follows from `ChildOf`, and `RigidBodyColliders` from `ColliderOf`.
            let is_list = path.ends_with("::RigidBodyColliders");
            (!is_list).then(|| (path, stored_by_reflection(value.as_partial_reflect(), &registry)))
        });
        let mut stored: Vec<_> = stored.collect();
        stored.sort();
        (entity, stored, found.get::<Collider>().map(to_text))
    };
    to_text(&entities.iter().map(line).collect::<Vec<_>>())
}

/// Spawns the entities of a file. They get other ids.
fn load(app: &mut App, text: &str) -> Vec<Entity> {
    let lines: Vec<Line> = ron::from_str(text).expect("was stored");
    let registry = app.world().resource::<AppTypeRegistry>().clone();
    let registry = registry.read();
    let mut map = EntityHashMap::default();
    let spawned: Vec<Entity> = lines.iter().map(|_| app.world_mut().spawn_empty().id()).collect();
    map.extend(lines.iter().map(|line| line.0).zip(spawned.iter().copied()));
    SceneEntityMapper::world_scope(&mut map, app.world_mut(), |world, mapper| {
        for ((_, components, collider), &entity) in lines.iter().zip(&spawned) {
            let mut entity = world.entity_mut(entity);
            if let Some(collider) = collider {
                entity.insert(ron::from_str::<Collider>(collider).expect("was stored"));
            }
            for (path, value) in components {
                let registration = registry.get_with_type_path(path).expect("a type of this app");
                let value = read_by_reflection(value, registration, &registry);
                let component = registration.data::<ReflectComponent>().expect("a component");
                let run = RelationshipHookMode::Run;
                component.apply_or_insert_mapped(&mut entity, &*value, &registry, mapper, run);
            }
        }
    });
    spawned
}

/// A pile of bodies of all kinds that has fallen for a while.
pub fn pile(app: &mut App, steps_before: u32) -> Vec<Entity> {
    app.world_mut().insert_resource(Gravity(-Vector::Y * 10.0));
    let mut all = vec![app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y))).id()];
    for (i, shape) in shapes().into_iter().enumerate() {
        let at = Transform::from_xyz((i % 4) as f32 * 1.1, 1.0 + (i / 4) as f32 * 1.3, 0.0);
        let surface = (Friction::new(0.1 + 0.1 * (i % 7) as Scalar), GravityScale(0.9));
        let body = app.world_mut().spawn((RigidBody::Dynamic, shape, at, surface, spin(1.0))).id();
        all.push(body);
        if i % 3 == 0 {
            let part = (ball(0.2), Transform::from_xyz(0.3, 0.3, 0.0), ChildOf(body), ColliderDensity(0.5));
            all.push(app.world_mut().spawn(part).id());
        }
    }
    steps(app, steps_before);
    all
}

/// Shapes that can lie in a pile.
fn shapes() -> Vec<Collider> {
    let corner = |x: Scalar, y: Scalar| {
        let mut corner = Vector::ZERO;
        (corner.x, corner.y) = (x, y);
        corner
    };
    let mut corners = vec![corner(0.5, 0.1), corner(-0.4, 0.2), corner(0.1, 0.6), corner(-0.1, -0.4)];
    corners.extend(Vector::AXES.map(|axis| axis * 0.45));
    let mut long = block(0.6, 0.6, 0.6);
    long.set_scale(Vector::ONE + Vector::X * 0.5, 8);
    let mut oval = ball(0.4);
    oval.set_scale(Vector::ONE + Vector::X * 0.3, 6);
    let both = vec![
        (Vector::X * 0.3, Rotation::default(), ball(0.3)),
        (-Vector::X * 0.3, Rotation::default(), ball(0.2)),
    ];
    let one = vec![
        block(0.7, 0.5, 0.6),
        ball(0.4),
        Collider::capsule(0.2, 0.5),
        Collider::convex_hull(corners).expect("a hull"),
        long,
        oval,
        Collider::compound(both),
    ];
    let again = one.clone();
    one.into_iter().chain(again).collect()
}

pub fn bits(app: &App, entities: &[Entity]) -> Vec<String> {
    let of = |&entity: &Entity| {
        let entity = app.world().entity(entity);
        let pose = (entity.get::<Position>(), entity.get::<Rotation>());
        let motion = (entity.get::<LinearVelocity>(), entity.get::<AngularVelocity>());
        format!("{pose:?} {motion:?} {:?}", entity.get::<ComputedMass>())
    };
    entities.iter().map(of).collect()
}

#[test]
fn a_world_whose_colliders_came_from_a_file_has_the_same_bits() {
    let run = |stored: bool| {
        let mut app = app();
        let all = pile(&mut app, 0);
        if stored {
            for &entity in &all {
                let text = to_text(app.world().get::<Collider>(entity).expect("all are colliders"));
                let again: Collider = ron::from_str(&text).expect("was stored");
                app.world_mut().entity_mut(entity).insert(again);
            }
        }
        steps(&mut app, 150);
        bits(&app, &all)
    };
    assert_eq!(run(false), run(true));
}

#[test]
fn a_world_comes_back_from_a_file() {
    let mut first = app();
    let all = pile(&mut first, 40);
    let text = save(&first, &all);
    let expected = bits(&first, &all);

    let mut end = None;
    for _ in 0..2 {
        let mut again = app();
        again.world_mut().insert_resource(Gravity(-Vector::Y * 10.0));
        // Entities have other ids here.
        (0..5).for_each(|_| _ = again.world_mut().spawn_empty());
        let loaded = load(&mut again, &text);
        assert_eq!(bits(&again, &loaded), expected);
        for (&old, &new) in all.iter().zip(&loaded) {
            let body =
                |app: &App, entity: Entity| app.world().get::<ColliderOf>(entity).expect("all have one").body;
            let place = |list: &[Entity], entity: Entity| list.iter().position(|e| *e == entity);
            assert_eq!(place(&all, body(&first, old)), place(&loaded, body(&again, new)));
        }
        steps(&mut again, 100);
        let moved = bits(&again, &loaded);
        assert!(moved != expected);
        assert_eq!(*end.get_or_insert(moved.clone()), moved);
        let lowest = loaded.iter().map(|e| again.world().get::<Position>(*e).expect("a place").y);
        assert!(lowest.fold(Scalar::MAX, Scalar::min) > -0.1, "none fell through the floor");
    }
    let registry = first.world().resource::<AppTypeRegistry>().read();
    let gravity = registry.get_with_type_path(Gravity::type_path()).expect("registered");
    assert!(gravity.data::<ReflectResource>().is_some() && gravity.data::<ReflectSerialize>().is_some());
}
