//! Bodies and colliders are spawned, despawned and changed in random order, also by observers. Feature
//! `validate`, which is on in tests, compares all tables with the world in every step.
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

/// Changes per world.
const OPERATIONS: u32 = 1_000;
/// Changes between two steps, on average.
const PER_STEP: u32 = 8;
/// Few enough entities that changes often affect the same one.
const CROWD: usize = 48;
const DT: Duration = Duration::from_millis(16);

/// Equal seeds give equal sequences: Marsaglia's xorshift (2003).
#[derive(Resource, Clone)]
struct Random(u64);

impl Random {
    fn below(&mut self, n: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 32) as usize % n.max(1)
    }

    fn between(&mut self, low: Scalar, high: Scalar) -> Scalar {
        low + (high - low) * self.below(1 << 16) as Scalar / 65_536.0
    }

    fn vector(&mut self, size: Scalar) -> Vector {
        Vector::from_array([(); Vector::AXES.len()].map(|()| self.between(-size, size)))
    }

    fn chance(&mut self, one_in: usize) -> bool {
        self.below(one_in) == 0
    }
}

/// Entities that the random changes select from.
#[derive(Resource, Default)]
struct Crowd(Vec<Entity>);

impl Crowd {
    fn pick(&self, random: &mut Random) -> Option<Entity> {
        (!self.0.is_empty()).then(|| self.0[random.below(self.0.len())])
    }
}

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)))
        .insert_resource(SubstepCount(2));
    app.finish();
    app.cleanup();
    app
}

fn step(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(DT);
    app.update();
}

fn steps(app: &mut App, count: u32) {
    (0..count).for_each(|_| step(app));
}

fn at(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

/// A box with sides of 1 m.
fn block() -> Collider {
    hull(0.5)
}

/// A square or cube by its half side, as a hull.
fn hull(half: Scalar) -> Collider {
    let mut corners = vec![Vector::ZERO];
    for axis in Vector::AXES {
        corners = corners.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

fn floor(app: &mut App) -> Entity {
    app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::Y))).id()
}

fn height(app: &App, entity: Entity) -> Scalar {
    app.world().get::<Position>(entity).expect("a body has a position").y
}

fn is_asleep(app: &App, entity: Entity) -> bool {
    app.world().get::<Sleeping>(entity).is_some()
}

fn any_collider(random: &mut Random) -> Collider {
    let size = random.between(0.2, 0.8);
    match random.below(7) {
        0 | 1 => SharedShape::ball(size).into(),
        2 => Collider::capsule(0.5 * size, size),
        3 => block(),
        4 => hull(0.5 * size),
        5 => Collider::compound(vec![
            (Vector::X * size, Rotation::IDENTITY, Collider::capsule(0.2, 0.3)),
            (Vector::NEG_X * size, Rotation::IDENTITY, block()),
        ]),
        // A shape that the kernel does not have.
        _ => Collider::polyline(vec![Vector::NEG_X, Vector::ZERO, Vector::X + Vector::Y], None),
    }
}

fn any_body(random: &mut Random) -> RigidBody {
    match random.below(5) {
        0 => RigidBody::Static,
        1 => RigidBody::Kinematic,
        _ => RigidBody::Dynamic,
    }
}

fn any_place(random: &mut Random) -> Transform {
    let v = random.vector(3.0).f32();
    let [x, y] = [v.x, v.y];
    Transform::from_xyz(x, y, v.to_array().get(2).copied().unwrap_or(0.0))
}

/// Spawns an entity, and adds it to the crowd.
fn spawn(world: &mut World, random: &mut Random) {
    let place = any_place(random);
    let new = match random.below(6) {
        0..=2 => world.spawn((any_body(random), any_collider(random), place)).id(),
        3 => world.spawn((any_body(random), place)).id(),
        4 => world.spawn((any_collider(random), place)).id(),
        // Added after spawning, as by a prefab.
        _ => world.spawn((any_body(random), any_collider(random), place, Disabled)).id(),
    };
    let parent = world.resource::<Crowd>().pick(random);
    if let Some(parent) = parent.filter(|_| random.chance(3))
        && let Ok(mut new) = world.get_entity_mut(new)
    {
        new.insert(ChildOf(parent));
    }
    world.resource_mut::<Crowd>().0.push(new);
}

/// Inserts a component if it is absent, else removes it.
fn toggle<C: Component + Default>(world: &mut World, entity: Entity) {
    let mut entity = world.entity_mut(entity);
    if entity.contains::<C>() {
        entity.remove::<C>();
    } else {
        entity.insert(C::default());
    }
}

fn is_below(world: &World, entity: Entity, ancestor: Entity) -> bool {
    let above = |at: &Entity| world.get::<ChildOf>(*at).map(ChildOf::parent);
    core::iter::successors(Some(entity), above).any(|at| at == ancestor)
}

fn change_hierarchy(world: &mut World, entity: Entity, random: &mut Random) {
    let parent = world.resource::<Crowd>().pick(random);
    match parent.filter(|parent| !random.chance(2) && !is_below(world, *parent, entity)) {
        Some(parent) => drop(world.entity_mut(entity).insert(ChildOf(parent))),
        None => drop(world.entity_mut(entity).remove::<ChildOf>()),
    }
}

fn change_setting(world: &mut World, entity: Entity, random: &mut Random) {
    let mut of = world.entity_mut(entity);
    match random.below(10) {
        0 => of.insert(CollisionLayers::new(1 << random.below(3), LayerMask(random.below(8) as u32))),
        1 => of.insert(CollisionLayers::default()),
        2 => of.insert(Friction::new(random.between(0.0, 2.0))),
        3 => of.remove::<Friction>(),
        4 => of.insert(Restitution::new(random.between(0.0, 1.0))),
        5 => of.insert(Mass(random.between(0.1, 10.0) as f32)),
        6 => of.remove::<Mass>(),
        7 => of.insert(LockedAxes::ROTATION_LOCKED),
        8 => of.remove::<LockedAxes>(),
        _ => of.insert(CollisionMargin(random.between(0.0, 0.1))),
    };
}

/// One random change of an entity in the crowd.
fn change(world: &mut World, random: &mut Random) {
    let mut crowd = core::mem::take(&mut world.resource_mut::<Crowd>().0);
    crowd.retain(|e| world.get_entity(*e).is_ok());
    let full = crowd.len() >= CROWD;
    world.resource_mut::<Crowd>().0 = crowd;
    let target = world.resource::<Crowd>().pick(random);
    let Some(entity) = target.filter(|_| full || !random.chance(6)) else {
        spawn(world, random);
        return;
    };
    match random.below(27) {
        0..=1 => drop(world.despawn(entity)),
        2 => drop(world.entity_mut(entity).remove::<RigidBody>()),
        3..=5 => drop(world.entity_mut(entity).insert(any_body(random))),
        6 => drop(world.entity_mut(entity).remove::<Collider>()),
        7..=8 => drop(world.entity_mut(entity).insert(any_collider(random))),
        9 => toggle::<RigidBodyDisabled>(world, entity),
        10 => toggle::<ColliderDisabled>(world, entity),
        11 => toggle::<Disabled>(world, entity),
        12 => toggle::<Sensor>(world, entity),
        13..=15 => toggle::<Sleeping>(world, entity),
        16 => toggle::<SleepingDisabled>(world, entity),
        17 => change_hierarchy(world, entity, random),
        18 => {
            let place = random.vector(3.0);
            world.entity_mut(entity).insert(Position(place));
        }
        19 => {
            let place = any_place(random);
            world.entity_mut(entity).insert(place);
        }
        20 => {
            let velocity = random.vector(5.0);
            world.entity_mut(entity).insert(LinearVelocity(velocity));
        }
        21 => {
            if let Some(mut collider) = world.get_mut::<Collider>(entity) {
                collider.set_shape(SharedShape::ball(random.between(0.2, 0.8)));
            }
        }
        22 => {
            world.entity_mut(entity).remove_with_requires::<RigidBody>();
        }
        23 => {
            world.entity_mut(entity).remove_with_requires::<Collider>();
        }
        24 => drop(world.entity_mut(entity).remove::<CollisionLayers>()),
        _ => change_setting(world, entity, random),
    }
}

/// Lets an observer change something else, sometimes.
fn meddle(mut commands: Commands) {
    commands.queue(|world: &mut World| {
        let mut random = core::mem::replace(&mut *world.resource_mut::<Random>(), Random(77));
        if random.chance(4) {
            change(world, &mut random);
        }
        *world.resource_mut() = random;
    });
}

/// The awake, free dynamic bodies without a collider, and how fast they are.
fn free_bodies(app: &mut App) -> Vec<(Entity, Scalar)> {
    let world = app.world_mut();
    let mut query = world.query_filtered::<(Entity, &RigidBody, &LinearVelocity, Option<&LockedAxes>), (
        Without<RigidBodyDisabled>,
        Without<Sleeping>,
        Without<RigidBodyColliders>,
        // The changes may have removed these components.
        With<Position>,
        With<Rotation>,
    )>();
    query
        .iter(world)
        .filter(|(_, body, _, locks)| body.is_dynamic() && locks.is_none())
        .map(|(e, _, velocity, _)| (e, velocity.y))
        .collect()
}

fn check(app: &mut App, falling: &[(Entity, Scalar)], step: u32) {
    let now = free_bodies(app);
    let expected = 9.81 * DT.as_secs_f64() as Scalar;
    for (entity, before) in falling {
        if let Some((_, after)) = now.iter().find(|(e, _)| e == entity) {
            let gained = before - after;
            assert!((gained - expected).abs() < 1e-4, "{entity} fell by {gained} m/s in step {step}");
        }
    }
    let world = app.world_mut();
    let mut all = world.query::<(Entity, &Position, Option<&Rotation>, Option<&LinearVelocity>)>();
    for (entity, position, rotation, velocity) in all.iter(world) {
        assert!(position.is_finite(), "{entity} is at {position:?} in step {step}");
        assert!(rotation.is_none_or(|r| r.is_finite()), "{entity} is turned by {rotation:?} in step {step}");
        assert!(velocity.is_none_or(|v| v.is_finite()), "{entity} moves at {velocity:?} in step {step}");
    }
}

/// Worlds per run, and with `AVIAN_LONG_TESTS=1`. Many combinations of components occur, so that a long-lived
/// world gets slow.
const WORLDS: [u32; 2] = [10, 25];

fn run(seed: u64, observers: bool) {
    let is_long = std::env::var_os("AVIAN_LONG_TESTS").is_some();
    let mut random = Random(seed);
    (0..WORLDS[usize::from(is_long)]).for_each(|_| run_world(&mut random, observers));
}

fn run_world(random: &mut Random, observers: bool) {
    let mut app = app();
    let seed = random.0.rotate_left(17);
    app.init_resource::<Crowd>().insert_resource(Random(seed)).insert_resource(TimeToSleep(0.05));
    floor(&mut app);
    if observers {
        app.add_observer(|_: On<Add, Sleeping>, commands: Commands| meddle(commands))
            .add_observer(|_: On<Remove, Sleeping>, commands: Commands| meddle(commands))
            .add_observer(|_: On<Add, RigidBody>, commands: Commands| meddle(commands))
            .add_observer(|_: On<Remove, Collider>, commands: Commands| meddle(commands));
    }
    for number in 0..OPERATIONS / PER_STEP {
        for _ in 0..PER_STEP {
            change(app.world_mut(), random);
        }
        // An observer may change a velocity after integration.
        let falling = if observers { Vec::new() } else { free_bodies(&mut app) };
        step(&mut app);
        check(&mut app, &falling, number);
    }
}

#[test]
fn any_order_of_changes_leaves_tables_and_world_agreeing_1() {
    run(0x9E37_79B9_7F4A_7C15, false);
}

#[test]
fn any_order_of_changes_leaves_tables_and_world_agreeing_2() {
    run(0xD1B5_4A32_D192_ED03, false);
}

#[test]
fn any_order_of_changes_in_observers_leaves_tables_and_world_agreeing_1() {
    run(0x2545_F491_4F6C_DD1D, true);
}

#[test]
fn any_order_of_changes_in_observers_leaves_tables_and_world_agreeing_2() {
    run(0x8CB9_2BA7_2F3D_8DD7, true);
}

#[test]
fn issue_what_woke_a_body_just_fallen_asleep_was_undone() {
    let mut app = app();
    let support = app.world_mut().spawn((RigidBody::Static, block(), at(0.0, 0.0))).id();
    let body = app.world_mut().spawn((RigidBody::Dynamic, block(), at(0.0, 1.0))).id();
    while !is_asleep(&app, body) {
        step(&mut app);
    }
    app.world_mut().despawn(support);
    steps(&mut app, 60);
    assert!(height(&app, body) < -1.0 && !is_asleep(&app, body));
}

#[test]
fn issue_a_shape_changed_in_place_was_not_noticed() {
    let mut app = app();
    floor(&mut app);
    let body =
        app.world_mut().spawn((RigidBody::Dynamic, Collider::from(SharedShape::ball(0.5)), at(0.0, 0.5)));
    let body = body.id();
    steps(&mut app, 100);
    assert!(is_asleep(&app, body));
    app.world_mut().get_mut::<Collider>(body).expect("just spawned").set_shape(SharedShape::ball(1.0));
    steps(&mut app, 100);
    assert!((height(&app, body) - 1.0).abs() < 0.02, "{}", height(&app, body));
}

#[test]
fn issue_a_collider_moved_on_its_body_was_not_noticed() {
    let mut app = app();
    floor(&mut app);
    let body = app.world_mut().spawn((RigidBody::Dynamic, at(0.0, 0.5), LockedAxes::ROTATION_LOCKED)).id();
    let collider = app.world_mut().spawn((block(), at(0.0, 0.0), ChildOf(body))).id();
    steps(&mut app, 100);
    assert!((height(&app, body) - 0.5).abs() < 0.02);
    app.world_mut().entity_mut(collider).insert(at(0.0, -0.5));
    steps(&mut app, 100);
    assert!((height(&app, body) - 1.0).abs() < 0.02, "{}", height(&app, body));
}

#[test]
fn issue_what_was_spawned_disabled_never_took_part() {
    let mut app = app();
    let body = app.world_mut().spawn((RigidBody::Dynamic, block(), at(1.0, 2.0), Disabled)).id();
    steps(&mut app, 10);
    assert_eq!(height(&app, body), 2.0);
    app.world_mut().entity_mut(body).remove::<Disabled>();
    steps(&mut app, 30);
    assert!(height(&app, body) < 1.5);
}

/// Searches for changed components do not see disabled entities, so changes made then have to be
/// found afterwards.
#[test]
fn issue_what_moved_while_disabled_came_back_where_it_had_been() {
    let mut app = app();
    app.insert_resource(Gravity(Vector::ZERO));
    let arm = app.world_mut().spawn(at(0.0, 0.0)).id();
    let mut spawn = |bundle: (RigidBody, Collider, Transform)| app.world_mut().spawn(bundle).id();
    let [moved, posed, below] = [0.0, 10.0, 20.0].map(|x| spawn((RigidBody::Kinematic, block(), at(x, 0.0))));
    let child = app.world_mut().spawn((block(), at(1.0, 0.0), ChildOf(moved))).id();
    app.world_mut().entity_mut(below).insert(ChildOf(arm));
    steps(&mut app, 3);
    let all = [moved, posed, child, arm];
    all.iter().for_each(|entity| _ = app.world_mut().entity_mut(*entity).insert(Disabled));
    steps(&mut app, 3);
    app.world_mut().entity_mut(moved).insert(at(0.0, 5.0).with_scale(bevy_math::Vec3::splat(2.0)));
    app.world_mut().get_mut::<Transform>(child).expect("it has one").translation.y = 1.0;
    app.world_mut().get_mut::<Transform>(arm).expect("it has one").translation.y = 7.0;
    app.world_mut().get_mut::<Transform>(posed).expect("it has one").translation.y = 1.0;
    steps(&mut app, 3);
    app.world_mut().get_mut::<Position>(posed).expect("it has one").y = 6.0;
    steps(&mut app, 3);
    all.iter().for_each(|entity| _ = app.world_mut().entity_mut(*entity).remove::<Disabled>());
    steps(&mut app, 3);
    let height = |entity: Entity| app.world().get::<Position>(entity).expect("it has one").y;
    assert_eq!([moved, posed, child, below].map(height), [5.0, 6.0, 7.0, 7.0]);
    let scale = |entity: Entity| app.world().get::<Collider>(entity).expect("it has one").scale();
    assert_eq!([moved, child].map(scale), [Vector::splat(2.0); 2]);
    assert_eq!(app.world().get::<Transform>(posed).expect("it has one").translation.y, 6.0);
}

#[test]
fn issue_a_body_without_a_position_haunted_the_tables() {
    let mut app = app();
    let body = app.world_mut().spawn((RigidBody::Dynamic, block(), at(0.0, 0.0))).id();
    steps(&mut app, 5);
    app.world_mut().entity_mut(body).remove::<Position>();
    steps(&mut app, 5);
    app.world_mut().entity_mut(body).insert(Position(Vector::Y * 2.0));
    steps(&mut app, 60);
    assert!(height(&app, body) < 0.0);
}

#[test]
fn issue_a_collider_without_layers_went_through_everything() {
    let mut app = app();
    floor(&mut app);
    let body = app.world_mut().spawn((RigidBody::Dynamic, block(), at(0.0, 0.6))).id();
    app.world_mut().entity_mut(body).remove::<CollisionLayers>();
    steps(&mut app, 60);
    assert!((height(&app, body) - 0.5).abs() < 0.02);
}

#[test]
fn issue_a_sensor_made_of_a_solid_collider_found_no_new_partners() {
    let mut app = app();
    // Without bodies, so that they form no pair.
    app.world_mut().spawn((block(), at(0.0, 0.0)));
    let wall = app.world_mut().spawn((block(), at(0.5, 0.0))).id();
    steps(&mut app, 5);
    assert_eq!(app.world().resource::<avian::collision::CollisionDiagnostics>().contact_count, 0);
    app.world_mut().entity_mut(wall).insert(Sensor);
    steps(&mut app, 2);
    assert_eq!(app.world().resource::<avian::collision::CollisionDiagnostics>().contact_count, 1);
}

#[test]
fn issue_a_rotation_that_came_after_the_position_was_never_initialised() {
    let mut app = app();
    let body = app.world_mut().spawn(Position(Vector::Y)).id();
    step(&mut app);
    app.world_mut().entity_mut(body).insert((RigidBody::Dynamic, block()));
    step(&mut app);
    let rotation = *app.world().get::<Rotation>(body).expect("required");
    assert_eq!(rotation, Rotation::IDENTITY);
    assert!(height(&app, body) < 1.0);
}

#[test]
fn a_shape_changed_in_place_takes_effect() {
    let mut app = app();
    floor(&mut app);
    let body = app.world_mut().spawn((RigidBody::Dynamic, block(), at(0.0, 0.5))).id();
    steps(&mut app, 90);
    assert!(is_asleep(&app, body));
    let mass = app.world().get::<ComputedMass>(body).expect("a body has a mass").value();
    let mut collider = app.world_mut().get_mut::<Collider>(body).expect("it has a collider");
    *collider.shape_mut() = SharedShape::ball(2.0);
    steps(&mut app, 120);
    assert!((height(&app, body) - 2.0).abs() < 0.02, "it lies at {}", height(&app, body));
    let grown = app.world().get::<ComputedMass>(body).expect("a body has a mass").value();
    assert!(grown > 4.0 * mass, "{grown} kg, {mass} kg before");
    let shown = app.world().get::<ColliderAabb>(body).expect("it has a box");
    assert!((shown.size().x - 4.0).abs() < 0.01);
}

#[test]
fn commands_put_to_sleep_and_wake_whole_islands() {
    use bevy_ecs::system::Command;

    let mut app = app();
    floor(&mut app);
    let [low, high] =
        [0.5, 1.5].map(|y| app.world_mut().spawn((RigidBody::Dynamic, block(), at(0.0, y))).id());
    let aside = app.world_mut().spawn((RigidBody::Dynamic, block(), at(5.0, 0.5))).id();
    steps(&mut app, 10);
    SleepBody(high).apply(app.world_mut()).expect("it is a body");
    step(&mut app);
    assert_eq!([low, high, aside].map(|e| is_asleep(&app, e)), [true, true, false]);
    WakeBody(low).apply(app.world_mut()).expect("it is a body");
    step(&mut app);
    assert_eq!([low, high, aside].map(|e| is_asleep(&app, e)), [false; 3]);

    // A body that is woken while awake stays awake for another half second.
    steps(&mut app, 20);
    WakeBody(low).apply(app.world_mut()).expect("it is a body");
    steps(&mut app, 20);
    assert_eq!([low, high, aside].map(|e| is_asleep(&app, e)), [false, false, true]);

    let stranger = app.world_mut().spawn_empty().id();
    assert!(SleepBody(stranger).apply(app.world_mut()).is_err());
    app.world_mut().despawn(stranger);
    assert!(WakeBody(stranger).apply(app.world_mut()).is_err());
}

#[test]
fn a_kinematic_body_stopped_and_set_off_at_the_same_speed_moves_again() {
    let mut app = app();
    let speed = LinearVelocity(Vector::X);
    let platform = app.world_mut().spawn((RigidBody::Kinematic, block(), speed)).id();
    let x = |app: &App| app.world().get::<Position>(platform).expect("a body has a position").x;
    steps(&mut app, 10);
    app.world_mut().entity_mut(platform).insert(LinearVelocity::ZERO);
    steps(&mut app, 10);
    let stopped = x(&app);
    app.world_mut().entity_mut(platform).insert(speed);
    steps(&mut app, 10);
    assert!((x(&app) - stopped - 10.0 * DT.as_secs_f64() as Scalar).abs() < 1.0e-4);
}
