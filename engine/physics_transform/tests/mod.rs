//! Synchronisation of poses and transforms in headless apps. The tests replace the solver.

mod tree;

use bevy_app::{App, Update};
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};
use bevy_math::{Quat, Vec3};
use bevy_transform::components::Transform;
use proptest::prelude::*;

use super::{
    ApplyPosToTransform, PhysicsTransformConfig, PhysicsTransformHelper, PhysicsTransformPlugin, Position,
    Rotation,
    frame::{Frame, read_pose, same_rotation, same_translation, write_pose},
    tree::TransformTree,
};
use crate::{
    collision::collider::{
        ColliderMarker,
        collider_hierarchy::{ColliderHierarchyPlugin, ColliderOf, RigidBodyColliders},
        collider_transform::{ColliderTransform, ColliderTransformPlugin},
    },
    dynamics::rigid_body::RigidBody,
    math::{Scalar, Vector},
    schedule::PhysicsSystems,
};

/// Poses that the test's solver writes in the next step.
#[derive(Resource, Default)]
struct Moves(Vec<(Entity, Vector, Option<Rotation>)>);

fn solve(mut moves: ResMut<Moves>, mut poses: Query<(&mut Position, &mut Rotation)>) {
    for (entity, to, turn) in moves.0.drain(..) {
        let (mut position, mut rotation) = poses.get_mut(entity).unwrap();
        position.0 = to;
        if let Some(turn) = turn {
            *rotation = turn;
        }
    }
}

fn app() -> App {
    let mut app = App::new();
    app.configure_sets(
        Update,
        (PhysicsSystems::Prepare, PhysicsSystems::StepSimulation, PhysicsSystems::Writeback).chain(),
    )
    .init_resource::<Moves>()
    .add_systems(Update, solve.in_set(PhysicsSystems::StepSimulation))
    .add_plugins((
        PhysicsTransformPlugin::new(Update.intern()),
        ColliderHierarchyPlugin,
        ColliderTransformPlugin::new(Update.intern()),
    ));
    app
}

/// The point with x, y, and z = 0 in 3D.
fn at(x: Scalar, y: Scalar) -> Vector {
    crate::math::vector_from_xyz([f64::from(x as f32), f64::from(y as f32), 0.0])
}

/// The rotation about z by an angle in radians.
fn turn(angle: f32) -> Rotation {
    Rotation::from(Quat::from_rotation_z(angle))
}

fn place(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

fn position(app: &App, entity: Entity) -> Vector {
    app.world().get::<Position>(entity).unwrap().0
}

fn rotation(app: &App, entity: Entity) -> Rotation {
    *app.world().get::<Rotation>(entity).unwrap()
}

fn transform(app: &App, entity: Entity) -> Transform {
    *app.world().get::<Transform>(entity).unwrap()
}

fn set<C: Component<Mutability = bevy_ecs::component::Mutable>>(app: &mut App, entity: Entity, value: C) {
    *app.world_mut().get_mut::<C>(entity).unwrap() = value;
}

fn move_body(app: &mut App, entity: Entity, to: Vector, turn: Option<Rotation>) {
    app.world_mut().resource_mut::<Moves>().0.push((entity, to, turn));
}

fn step(app: &mut App) {
    app.update();
    app.world().resource::<TransformTree>().check(app.world());
}

fn bits(v: Vector) -> Vec<u64> {
    v.to_array().iter().map(|&c| f64::from(c).to_bits()).collect()
}

fn turn_bits(r: Rotation) -> Vec<u64> {
    let t = r.to_f64();
    [t.x, t.y, t.z, t.w].iter().map(|c| c.to_bits()).collect()
}

#[track_caller]
fn assert_at(app: &App, entity: Entity, expected: Vector) {
    let found = position(app, entity);
    assert!(found.distance(expected) < 1e-5, "{found} instead of {expected}");
}

#[track_caller]
fn assert_turned(app: &App, entity: Entity, expected: f32) {
    let angle = rotation(app, entity).angle_between(turn(expected));
    assert!(angle.abs() < 1e-3, "{angle} away");
}

/// Checks that Bevy's global transform of an entity is at `position`.
#[track_caller]
fn assert_shown_at(app: &mut App, entity: Entity) {
    let shown = app
        .world_mut()
        .run_system_cached_with(
            |In(entity): In<Entity>, helper: bevy_transform::helper::TransformHelper| {
                helper.compute_global_transform(entity).unwrap()
            },
            entity,
        )
        .unwrap();
    let (shown_at, shown_turn) = (Position::from(&shown).0, Rotation::from(&shown));
    let (p, r) = (position(app, entity), rotation(app, entity));
    assert!(shown_at.distance(p) < 1e-4 * (1.0 + p.length()), "{shown_at} shown for {p}");
    assert!(shown_turn.angle_between(r).abs() < 2e-3, "{shown_turn:?} shown for {r:?}");
}

#[test]
fn a_transform_initialises_the_pose_at_once_and_by_bits() {
    let mut app = app();
    let at_spawn = place(0.1, 0.7).with_rotation(Quat::from_rotation_z(1.1));
    let body = app.world_mut().spawn((RigidBody::Dynamic, at_spawn)).id();
    assert_eq!(position(&app, body), at(0.1f32 as Scalar, 0.7f32 as Scalar));
    let (p, r) = (bits(position(&app, body)), turn_bits(rotation(&app, body)));
    for _ in 0..3 {
        step(&mut app);
        assert_eq!((bits(position(&app, body)), turn_bits(rotation(&app, body))), (p.clone(), r.clone()));
        assert_eq!(transform(&app, body), at_spawn);
        // Writing the same value is not a change.
        let same = transform(&app, body);
        set(&mut app, body, same);
    }
}

#[test]
fn a_given_position_beats_the_transform_and_is_written() {
    let mut app = app();
    let there = place(9.0, 9.0).with_scale(Vec3::splat(3.0)).with_rotation(Quat::from_rotation_z(0.5));
    let body = app.world_mut().spawn((RigidBody::Dynamic, Position(at(1.0, 2.0)), there)).id();
    step(&mut app);
    assert_eq!(position(&app, body), at(1.0, 2.0));
    assert_turned(&app, body, 0.5);
    assert_eq!(transform(&app, body).translation, Vec3::new(1.0, 2.0, 0.0));
    assert_eq!(transform(&app, body).scale, Vec3::splat(3.0));
    // An entity without a transform gets one.
    let bare = app.world_mut().spawn((RigidBody::Static, Position(at(5.0, 0.0)))).id();
    step(&mut app);
    assert_eq!(transform(&app, bare).translation, Vec3::new(5.0, 0.0, 0.0));
}

#[test]
fn simulated_motion_is_written_once_and_only_where_it_happened() {
    let mut app = app();
    let bodies: Vec<Entity> =
        (0..5).map(|i| app.world_mut().spawn((RigidBody::Dynamic, place(i as f32, 0.0))).id()).collect();
    step(&mut app);
    step(&mut app);
    let tick = |app: &App, e: Entity| app.world().entity(e).get_ref::<Transform>().unwrap().last_changed();
    let before: Vec<_> = bodies.iter().map(|&b| tick(&app, b)).collect();
    let far: Scalar = 0.1 + 1.0 / 3.0;
    move_body(&mut app, bodies[2], at(far, 4.0), Some(turn(0.3)));
    step(&mut app);
    for (i, &body) in bodies.iter().enumerate() {
        assert_eq!(tick(&app, body) != before[i], i == 2, "body {i}");
    }
    let held = (bits(position(&app, bodies[2])), turn_bits(rotation(&app, bodies[2])));
    for _ in 0..3 {
        let same = transform(&app, bodies[2]);
        set(&mut app, bodies[2], same);
        step(&mut app);
        assert_eq!((bits(position(&app, bodies[2])), turn_bits(rotation(&app, bodies[2]))), held);
    }
    assert_shown_at(&mut app, bodies[2]);
}

#[test]
fn teleports_by_transform_and_by_position_in_one_frame() {
    let mut app = app();
    let [a, b, c] =
        [0.0, 10.0, 20.0].map(|x| app.world_mut().spawn((RigidBody::Dynamic, place(x, 0.0))).id());
    step(&mut app);
    set(&mut app, a, place(1.0, 1.0));
    set(&mut app, b, Position(at(12.0, 1.0)));
    set(&mut app, c, place(-5.0, -5.0).with_rotation(Quat::from_rotation_z(0.4)));
    set(&mut app, c, Position(at(22.0, 1.0)));
    step(&mut app);
    assert_eq!(position(&app, a), at(1.0, 1.0));
    assert_eq!(transform(&app, b).translation, Vec3::new(12.0, 1.0, 0.0));
    assert_eq!(position(&app, c), at(22.0, 1.0));
    assert_eq!(transform(&app, c).translation, Vec3::new(22.0, 1.0, 0.0));
    assert_turned(&app, c, 0.4);
}

#[test]
fn moving_only_the_translation_keeps_the_rotation_bits() {
    let mut app = app();
    let body = app.world_mut().spawn((RigidBody::Dynamic, place(0.0, 0.0))).id();
    move_body(&mut app, body, at(1.0, 1.0), Some(turn(0.123_456_7)));
    step(&mut app);
    let held = turn_bits(rotation(&app, body));
    let moved = transform(&app, body).with_translation(Vec3::new(7.0, 8.0, 0.0));
    set(&mut app, body, moved);
    step(&mut app);
    assert_eq!(turn_bits(rotation(&app, body)), held);
    assert_eq!(position(&app, body), at(7.0, 8.0));
}

#[test]
fn a_body_below_a_scaled_and_turned_parent() {
    let mut app = app();
    let quarter = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
    let parent =
        app.world_mut().spawn(place(10.0, 0.0).with_rotation(quarter).with_scale(Vec3::splat(2.0))).id();
    let body = app.world_mut().spawn((RigidBody::Dynamic, place(3.0, 0.0), ChildOf(parent))).id();
    step(&mut app);
    assert_at(&app, body, at(10.0, 6.0));
    assert_turned(&app, body, core::f32::consts::FRAC_PI_2);
    move_body(&mut app, body, at(10.0, 2.0), Some(turn(0.2)));
    step(&mut app);
    assert!(transform(&app, body).translation.distance(Vec3::X) < 1e-6);
    assert_shown_at(&mut app, body);
    // Moving the parent moves the body.
    let parent_at = place(0.0, 0.0).with_rotation(quarter).with_scale(Vec3::splat(2.0));
    set(&mut app, parent, parent_at);
    step(&mut app);
    assert_at(&app, body, at(0.0, 2.0));
    assert_turned(&app, body, 0.2);
    // Marking the transform as changed does not.
    let held = (bits(position(&app, body)), turn_bits(rotation(&app, body)));
    set(&mut app, parent, parent_at);
    step(&mut app);
    assert_eq!((bits(position(&app, body)), turn_bits(rotation(&app, body))), held);
}

#[test]
fn nested_bodies_move_independently_in_the_simulation_and_together_by_transform() {
    let mut app = app();
    let outer = app.world_mut().spawn((RigidBody::Dynamic, place(1.0, 0.0))).id();
    let inner = app.world_mut().spawn((RigidBody::Dynamic, place(1.0, 0.0), ChildOf(outer))).id();
    let innermost = app.world_mut().spawn((RigidBody::Dynamic, place(0.0, 1.0), ChildOf(inner))).id();
    step(&mut app);
    assert_at(&app, innermost, at(2.0, 1.0));
    let held = bits(position(&app, inner));
    move_body(&mut app, outer, at(5.0, 5.0), Some(turn(0.7)));
    move_body(&mut app, innermost, at(-1.0, -1.0), None);
    step(&mut app);
    assert_eq!(bits(position(&app, inner)), held);
    for body in [outer, inner, innermost] {
        assert_shown_at(&mut app, body);
    }
    step(&mut app);
    assert_eq!(bits(position(&app, inner)), held, "reading back perturbs");
    // The app moves the outer body: all bodies follow.
    let shifted = transform(&app, outer).with_translation(Vec3::new(6.0, 5.0, 0.0));
    set(&mut app, outer, shifted);
    step(&mut app);
    assert_at(&app, inner, at(3.0, 0.0));
    assert_at(&app, innermost, at(0.0, -1.0));
    // The app sets the position of the outer body: the others stay.
    set(&mut app, outer, Position(at(0.0, 0.0)));
    step(&mut app);
    assert_at(&app, inner, at(3.0, 0.0));
    assert_shown_at(&mut app, inner);
}

#[test]
fn a_new_body_below_a_body_that_was_placed_by_position() {
    let mut app = app();
    let child = app.world_mut().spawn((RigidBody::Dynamic, place(1.0, 0.0))).id();
    let parent = app.world_mut().spawn((RigidBody::Dynamic, Position(at(5.0, 0.0)))).id();
    app.world_mut().entity_mut(parent).add_child(child);
    step(&mut app);
    assert_at(&app, child, at(6.0, 0.0));
    assert_shown_at(&mut app, child);
}

#[test]
fn colliders_without_a_body_follow_their_transforms_and_are_not_written() {
    let mut app = app();
    let parent = app.world_mut().spawn(place(1.0, 0.0)).id();
    let collider = app.world_mut().spawn((ColliderMarker, place(1.0, 0.0), ChildOf(parent))).id();
    step(&mut app);
    assert_at(&app, collider, at(2.0, 0.0));
    assert!(app.world().get::<ColliderOf>(collider).is_none());
    set(&mut app, parent, place(4.0, 0.0));
    step(&mut app);
    assert_at(&app, collider, at(5.0, 0.0));
    set(&mut app, collider, Position(at(0.0, 0.0)));
    step(&mut app);
    assert_eq!(transform(&app, collider).translation, Vec3::X);
    app.world_mut().entity_mut(collider).insert(ApplyPosToTransform);
    set(&mut app, collider, Position(at(0.0, 1.0)));
    step(&mut app);
    assert_eq!(transform(&app, collider).translation, Vec3::new(-4.0, 1.0, 0.0));
}

#[test]
fn child_colliders_follow_their_body() {
    let mut app = app();
    let body = app.world_mut().spawn((RigidBody::Dynamic, ColliderMarker, place(1.0, 0.0))).id();
    let middle = app.world_mut().spawn((place(1.0, 0.0), ChildOf(body))).id();
    let deep = app
        .world_mut()
        .spawn((ColliderMarker, place(1.0, 0.0).with_rotation(Quat::from_rotation_z(0.5)), ChildOf(middle)))
        .id();
    step(&mut app);
    assert_eq!(app.world().get::<ColliderOf>(deep).unwrap().body, body);
    assert_eq!(app.world().get::<ColliderOf>(body).unwrap().body, body);
    assert_eq!(app.world().get::<RigidBodyColliders>(body).unwrap().len(), 2);
    assert_at(&app, deep, at(3.0, 0.0));
    assert_turned(&app, deep, 0.5);
    let quarter = turn(core::f32::consts::FRAC_PI_2);
    move_body(&mut app, body, at(0.0, 0.0), Some(quarter));
    step(&mut app);
    assert_at(&app, deep, at(0.0, 2.0));
    assert_eq!(transform(&app, deep).translation, Vec3::X, "its own transform is the user's");
    // An intermediate transform changes.
    set(&mut app, middle, place(3.0, 0.0).with_scale(Vec3::splat(2.0)));
    step(&mut app);
    let offset = *app.world().get::<ColliderTransform>(deep).unwrap();
    assert!(offset.translation.distance(at(5.0, 0.0)) < 1e-6);
    assert_eq!(offset.scale, Vector::splat(2.0));
    assert_at(&app, deep, at(0.0, 5.0));
    // A teleport of the body is detected before the step.
    set(&mut app, body, Position(at(10.0, 0.0)));
    app.add_systems(
        Update,
        (move |poses: Query<&Position>| {
            assert!(poses.get(deep).unwrap().distance(at(10.0, 5.0)) < 1e-5);
        })
        .in_set(PhysicsSystems::StepSimulation),
    );
    step(&mut app);
}

#[test]
fn the_bodys_scale_is_in_the_offset() {
    let mut app = app();
    let level = app.world_mut().spawn(Transform::from_scale(Vec3::splat(0.5))).id();
    let body = app
        .world_mut()
        .spawn((RigidBody::Static, place(2.0, 0.0).with_scale(Vec3::splat(4.0)), ChildOf(level)))
        .id();
    let child = app.world_mut().spawn((ColliderMarker, place(1.0, 0.0), ChildOf(body))).id();
    step(&mut app);
    let offset = *app.world().get::<ColliderTransform>(child).unwrap();
    assert_eq!((offset.translation, offset.scale), (at(2.0, 0.0), Vector::splat(2.0)));
    assert_at(&app, child, at(3.0, 0.0));
    set(&mut app, level, Transform::from_scale(Vec3::splat(1.0)));
    step(&mut app);
    assert_eq!(app.world().get::<ColliderTransform>(child).unwrap().scale, Vector::splat(4.0));
    assert_at(&app, child, at(6.0, 0.0));
}

#[test]
fn what_is_switched_off_stays_off() {
    let mut app = app();
    app.insert_resource(PhysicsTransformConfig { position_to_transform: false, ..Default::default() });
    let body = app.world_mut().spawn((RigidBody::Dynamic, Position(at(1.0, 0.0)))).id();
    move_body(&mut app, body, at(2.0, 0.0), None);
    step(&mut app);
    assert_eq!(transform(&app, body), Transform::IDENTITY);
    app.insert_resource(PhysicsTransformConfig { transform_to_position: false, ..Default::default() });
    set(&mut app, body, place(9.0, 0.0));
    step(&mut app);
    assert_eq!(position(&app, body), at(2.0, 0.0));
}

#[test]
fn the_helper_syncs_without_a_step() {
    let mut app = app();
    let parent = app.world_mut().spawn(place(1.0, 0.0)).id();
    let body = app.world_mut().spawn((RigidBody::Dynamic, ChildOf(parent))).id();
    step(&mut app);
    set(&mut app, parent, place(3.0, 0.0));
    app.world_mut()
        .run_system_cached_with(
            |In((body, missing)): In<(Entity, Entity)>, mut helper: PhysicsTransformHelper| {
                assert!(helper.update_physics_transform(missing).is_err());
                let (position, _) = helper.update_physics_transform(body).unwrap();
                assert_eq!(position.0, at(3.0, 0.0));
            },
            (body, parent),
        )
        .unwrap();
}

/// A chain of transforms: translations, rotations about z, and scales.
fn chains() -> impl Strategy<Value = Vec<Transform>> {
    let scale = prop_oneof![0.3f32..3.0, -3.0f32..-0.3, Just(1.0f32)];
    let link = ((-50.0f32..50.0, -50.0f32..50.0), -7.0f32..7.0, (scale.clone(), scale)).prop_map(
        |((x, y), angle, (sx, sy))| {
            place(x, y).with_rotation(Quat::from_rotation_z(angle)).with_scale(Vec3::new(sx, sy, 1.0))
        },
    );
    prop::collection::vec(link, 1..4)
}

proptest! {
    #[test]
    fn frames_place_points_as_bevy_does(chain in chains(), leaf in chains()) {
        let frame = chain.iter().fold(Frame::IDENTITY, |frame, t| frame.child(t));
        let global = chain.iter().fold(bevy_transform::components::GlobalTransform::IDENTITY, |g, t| g * *t);
        let ours = read_pose(Some(&frame), &leaf[0]).0;
        let theirs = Position::from(global * leaf[0]).0;
        prop_assert!(ours.distance(theirs) < 1e-4 * (1.0 + theirs.length()), "{} {}", ours, theirs);
    }

    #[test]
    fn what_is_written_reads_back(chain in chains(), leaf in chains(), to in (-50.0f32..50.0, -50.0f32..50.0), angle in -3.0f32..3.0) {
        let frame = chain.iter().fold(Frame::IDENTITY, |frame, t| frame.child(t));
        let (p, r) = (at(to.0 as Scalar, to.1 as Scalar), turn(angle));
        let written = write_pose(Some(&frame), &leaf[0], p, r);
        let (read, turned) = read_pose(Some(&frame), &written);
        prop_assert!(read.distance(p) < 2e-3);
        prop_assert!(turned.unwrap().angle_between(r).abs() < 2e-3);
        prop_assert_eq!(written.scale, leaf[0].scale);
        // Writing again changes nothing: a body at rest never counts as changed.
        let again = write_pose(Some(&frame), &written, p, r);
        prop_assert!(same_translation(&again, &written) && same_rotation(&again, &written));
    }
}
