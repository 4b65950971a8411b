//! Collision hooks as apps write them.

use super::hooks_dim::set_surface_velocity;
use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};

fn app<H: CollisionHooks + 'static>() -> App
where
    for<'w, 's> bevy_ecs::system::SystemParamItem<'w, 's, H>: CollisionHooks,
{
    let mut app = App::new();
    app.add_plugins((
        TaskPoolPlugin::default(),
        TransformPlugin,
        PhysicsPlugins::new(Update).with_collision_hooks::<H>(),
    ));
    app.insert_resource(Gravity(Vector::NEG_Y * 10.0));
    app
}

fn steps(app: &mut App, count: u32) {
    for _ in 0..count {
        app.world_mut().resource_mut::<Time>().advance_by(Duration::from_secs_f64(1.0 / 64.0));
        app.update();
    }
}

/// A box with the given half extents; all but the first two axes are as long as the first.
fn slab(x: Scalar, y: Scalar) -> Collider {
    let mut corners = vec![Vector::ZERO];
    for (i, axis) in Vector::AXES.into_iter().enumerate() {
        let half = if i == 1 { y } else { x };
        corners = corners.iter().flat_map(|c| [*c - axis * half, *c + axis * half]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

fn spawn_floor(app: &mut App) -> Entity {
    app.world_mut().spawn((RigidBody::Static, slab(20.0, 1.0), Transform::from_xyz(0.0, -1.0, 0.0))).id()
}

fn spawn_box(app: &mut App, x: f32, y: f32) -> Entity {
    app.world_mut().spawn((RigidBody::Dynamic, slab(0.5, 0.5), Transform::from_xyz(x, y, 0.0))).id()
}

fn position(app: &App, entity: Entity) -> Vector {
    app.world().get::<Position>(entity).unwrap().0
}

/// Entities that others fall through.
#[derive(Component)]
struct Ghost;

#[derive(SystemParam)]
struct Ghosts<'w, 's> {
    ghosts: Query<'w, 's, (), With<Ghost>>,
    asked: Res<'w, Asked>,
}

#[derive(Resource, Default)]
struct Asked(AtomicU32);

impl CollisionHooks for Ghosts<'_, '_> {
    fn filter_pairs(&self, collider1: Entity, collider2: Entity, _: &mut Commands) -> bool {
        self.asked.0.fetch_add(1, Relaxed);
        !self.ghosts.contains(collider1) && !self.ghosts.contains(collider2)
    }
}

#[test]
fn filtered_pairs_pass_through_each_other() {
    let mut app = app::<Ghosts>();
    app.init_resource::<Asked>();
    spawn_floor(&mut app);
    let (solid, ghost) = (spawn_box(&mut app, -2.0, 0.6), spawn_box(&mut app, 2.0, 0.6));
    app.world_mut().entity_mut(ghost).insert((Ghost, ActiveCollisionHooks::FILTER_PAIRS));
    // Without the component hooks are not asked.
    let unasked = spawn_box(&mut app, 6.0, 0.6);
    app.world_mut().entity_mut(unasked).insert(Ghost);
    steps(&mut app, 64);
    assert!(position(&app, solid).y > 0.45 && position(&app, unasked).y > 0.45);
    assert!(position(&app, ghost).y < -2.0);
    assert!(app.world().resource::<Asked>().0.load(Relaxed) > 0);
}

#[test]
fn hooks_count_whenever_they_are_inserted() {
    let mut app = app::<Rejecting>();
    spawn_floor(&mut app);
    let falling = spawn_box(&mut app, 0.0, 0.5);
    steps(&mut app, 200);
    assert!((position(&app, falling).y - 0.5).abs() < 0.01, "{}", position(&app, falling));
    app.world_mut().entity_mut(falling).insert(ActiveCollisionHooks::MODIFY_CONTACTS);
    app.world_mut().trigger_wake(falling);
    steps(&mut app, 64);
    assert!(position(&app, falling).y < -2.0, "{}", position(&app, falling));
}

/// Wakes a body as an app does.
trait TriggerWake {
    fn trigger_wake(&mut self, body: Entity);
}

impl TriggerWake for World {
    fn trigger_wake(&mut self, body: Entity) {
        WakeBody(body).apply(self).expect("the body exists");
    }
}

/// Drops every contact it is asked about.
#[derive(SystemParam)]
struct Rejecting<'w, 's> {
    bodies: Query<'w, 's, &'static RigidBody>,
}

impl CollisionHooks for Rejecting<'_, '_> {
    fn modify_contacts(&self, contacts: &mut ContactPair, _: &mut Commands) -> bool {
        assert!(!contacts.manifolds.is_empty(), "only contacts with points are modified");
        assert!(contacts.flags.contains(ContactPairFlags::MODIFY_CONTACTS));
        assert!(self.bodies.contains(contacts.collider1) && self.bodies.contains(contacts.collider2));
        false
    }
}

/// How far a small box falls in 80 steps over a platform whose pairs are refused somehow.
fn fall_through(mut app: App, platform: impl Bundle, swept: Option<SweptCcd>) -> Scalar {
    app.world_mut().spawn((slab(2.0, 0.5), Transform::default(), platform));
    let falling = app.world_mut().spawn((RigidBody::Dynamic, slab(0.1, 0.1))).id();
    app.world_mut().entity_mut(falling).insert(Transform::from_xyz(0.0, 4.0, 0.0));
    if let Some(swept) = swept {
        app.world_mut().entity_mut(falling).insert(swept);
    }
    steps(&mut app, 80);
    4.0 - position(&app, falling).y
}

/// A body of 0.2 m that was let through a platform hung in the air within it.
#[test]
fn what_is_let_through_falls_freely() {
    let expected = fall_through(app::<()>(), Sensor, None);
    for swept in [None, Some(SweptCcd::default())] {
        for kind in [RigidBody::Static, RigidBody::Kinematic] {
            let dropped =
                fall_through(app::<Rejecting>(), (kind, ActiveCollisionHooks::MODIFY_CONTACTS), swept);
            let mut filtering = app::<Ghosts>();
            filtering.init_resource::<Asked>();
            let filtered = fall_through(filtering, (kind, Ghost, ActiveCollisionHooks::FILTER_PAIRS), swept);
            let layers = CollisionLayers::new(LayerMask(2), LayerMask(2));
            let layered = fall_through(app::<()>(), (kind, layers), swept);
            for fallen in [dropped, filtered, layered] {
                assert!(
                    (fallen - expected).abs() < 1e-3,
                    "{kind:?} {swept:?}: {fallen} m instead of {expected} m"
                );
            }
        }
    }
}

#[test]
fn a_dropped_contact_is_no_collision() {
    let mut app = app::<Rejecting>();
    let floor = spawn_floor(&mut app);
    let falling = spawn_box(&mut app, 0.0, 1.0);
    app.world_mut().entity_mut(falling).insert((
        ActiveCollisionHooks::MODIFY_CONTACTS,
        CollisionEventsEnabled,
        CollidingEntities::default(),
    ));
    app.init_resource::<Asked>();
    app.add_systems(PostUpdate, |mut started: MessageReader<CollisionStart>, count: Res<Asked>| {
        count.0.fetch_add(started.read().count() as u32, Relaxed);
    });
    let reported = |app: &App| app.world().resource::<Asked>().0.load(Relaxed);
    for _ in 0..40 {
        steps(&mut app, 1);
        assert!(app.world().get::<CollidingEntities>(falling).unwrap().is_empty());
    }
    assert!(position(&app, falling).y < -0.5);
    assert_eq!(reported(&app), 0, "a dropped contact is reported");
    // Without the hook the collider touches the floor. With the hook again the collision ends.
    app.world_mut().entity_mut(falling).remove::<ActiveCollisionHooks>();
    steps(&mut app, 1);
    assert!(app.world().get::<CollidingEntities>(falling).unwrap().contains(&floor));
    app.world_mut().entity_mut(falling).insert(ActiveCollisionHooks::MODIFY_CONTACTS);
    steps(&mut app, 1);
    assert!(app.world().get::<CollidingEntities>(falling).unwrap().is_empty());
}

/// The speed of a belt along x.
#[derive(Component)]
struct Belt(Scalar);

#[derive(SystemParam)]
struct Belts<'w, 's> {
    belts: Query<'w, 's, &'static Belt>,
}

impl CollisionHooks for Belts<'_, '_> {
    fn modify_contacts(&self, contacts: &mut ContactPair, _: &mut Commands) -> bool {
        let of = |entity| self.belts.get(entity).map_or(0.0, |belt| belt.0);
        // The second surface is to move relative to the first.
        let speed = of(contacts.collider1) - of(contacts.collider2);
        for manifold in &mut contacts.manifolds {
            drive(manifold, speed);
        }
        true
    }
}

/// Has the second surface of a contact move along x.
fn drive(manifold: &mut ContactManifold, speed: Scalar) {
    let along = Vector::X - manifold.normal * manifold.normal.x;
    set_surface_velocity(manifold, along * speed);
}

#[test]
fn a_belt_carries_what_lies_on_it_at_its_speed() {
    for spawns_belt_first in [true, false] {
        let mut app = app::<Belts>();
        let first = (!spawns_belt_first).then(|| spawn_box(&mut app, 0.0, 0.5));
        let belt = spawn_floor(&mut app);
        app.world_mut().entity_mut(belt).insert((Belt(2.0), ActiveCollisionHooks::MODIFY_CONTACTS));
        let carried = first.unwrap_or_else(|| spawn_box(&mut app, 0.0, 0.5));
        steps(&mut app, 64);
        let at = position(&app, carried);
        let speed = app.world().get::<LinearVelocity>(carried).unwrap().x;
        assert!((speed - 2.0).abs() < 1.0e-3, "{speed} m/s");
        // It slips at μ g until it has the speed: v² / 2 μ g are lost.
        let way = 2.0 - 4.0 / (2.0 * 0.5 * 10.0);
        assert!((at.x - way).abs() < 0.05, "{} m for {way}", at.x);
        assert!((at.y - 0.5).abs() < 0.01);
        // The belt stands still: the box brakes, and sleeps.
        app.world_mut().entity_mut(belt).insert(Belt(0.0));
        steps(&mut app, 128);
        assert!(app.world().get::<LinearVelocity>(carried).unwrap().x.abs() < 1.0e-3);
        assert!(app.world().get::<Sleeping>(carried).is_some());
    }
}

/// Sets the surfaces of contacts.
#[derive(Resource, Default)]
struct Surface {
    friction: Scalar,
    restitution: Scalar,
}

#[derive(SystemParam)]
struct Surfaces<'w> {
    surface: Res<'w, Surface>,
}

impl CollisionHooks for Surfaces<'_> {
    fn modify_contacts(&self, contacts: &mut ContactPair, _: &mut Commands) -> bool {
        for manifold in &mut contacts.manifolds {
            manifold.friction = self.surface.friction;
            manifold.restitution = self.surface.restitution;
        }
        true
    }
}

#[test]
fn friction_and_restitution_are_those_of_the_hook() {
    let mut app = app::<Surfaces>();
    app.insert_resource(Surface { friction: 0.0, restitution: 1.0 });
    let floor = spawn_floor(&mut app);
    app.world_mut().entity_mut(floor).insert(ActiveCollisionHooks::MODIFY_CONTACTS);
    let ball = app
        .world_mut()
        .spawn((
            RigidBody::Dynamic,
            Collider::capsule(0.5, 1.0e-3),
            LockedAxes::ROTATION_LOCKED,
            LinearVelocity(Vector::X * 3.0),
            Transform::from_xyz(-10.0, 2.0, 0.0),
        ))
        .id();
    let mut top: Scalar = 0.0;
    for i in 0..150 {
        steps(&mut app, 1);
        if i > 60 {
            top = top.max(position(&app, ball).y);
        }
    }
    assert!((top - 2.0).abs() < 0.1, "it bounced to {top} m");
    let speed = app.world().get::<LinearVelocity>(ball).unwrap().x;
    assert!((speed - 3.0).abs() < 1.0e-3, "friction left {speed} m/s");
    // The contact shows what the hook has set.
    app.insert_resource(Surface { friction: 0.7, restitution: 0.0 });
    steps(&mut app, 200);
    app.add_systems(Update, |collisions: Collisions| {
        let manifolds: Vec<_> = collisions.iter().flat_map(|pair| &pair.manifolds).collect();
        assert!(!manifolds.is_empty());
        assert!(manifolds.iter().all(|m| (m.friction - 0.7).abs() < 1.0e-6));
    });
    app.world_mut().entity_mut(ball).insert(LinearVelocity(Vector::X * 0.5));
    steps(&mut app, 3);
}

/// Breaks contacts in every way.
#[derive(SystemParam)]
struct Breaking<'w> {
    step: Res<'w, Asked>,
}

impl CollisionHooks for Breaking<'_> {
    fn modify_contacts(&self, contacts: &mut ContactPair, commands: &mut Commands) -> bool {
        let way = self.step.0.fetch_add(1, Relaxed) % 8;
        for manifold in &mut contacts.manifolds {
            match way {
                0 => manifold.normal *= Scalar::NAN,
                1 => manifold.normal *= 0.0,
                2 => manifold.points.clear(),
                3 => manifold.friction = -1.0,
                4 => manifold.restitution = Scalar::INFINITY,
                5 => manifold.points.iter_mut().for_each(|p| p.penetration = Scalar::NAN),
                6 => manifold.points.iter_mut().for_each(|p| p.anchor1 = Vector::splat(Scalar::INFINITY)),
                _ => {
                    // A collider may go in its own hook.
                    commands.entity(contacts.collider2).try_despawn();
                }
            }
        }
        true
    }
}

#[test]
fn broken_contacts_are_dropped() {
    let mut app = app::<Breaking>();
    app.init_resource::<Asked>();
    spawn_floor(&mut app);
    for i in 0..10 {
        let body = spawn_box(&mut app, 2.0 * i as f32 - 10.0, 0.5);
        app.world_mut().entity_mut(body).insert(ActiveCollisionHooks::MODIFY_CONTACTS);
    }
    steps(&mut app, 60);
    let mut bodies = app.world_mut().query::<(&Position, &LinearVelocity)>();
    assert!(bodies.iter(app.world()).all(|(p, v)| p.0.is_finite() && v.0.is_finite()));
    assert!(app.world().resource::<Asked>().0.load(Relaxed) > 10);
}

/// Removes what hooks may leave out: contacts without constraints still touch.
#[derive(SystemParam)]
struct Touching<'w> {
    _asked: Res<'w, Asked>,
}

impl CollisionHooks for Touching<'_> {
    fn modify_contacts(&self, contacts: &mut ContactPair, _: &mut Commands) -> bool {
        contacts.flags.remove(ContactPairFlags::GENERATE_CONSTRAINTS);
        true
    }
}

#[test]
fn a_contact_without_constraints_touches_and_pushes_nothing() {
    let mut app = app::<Touching>();
    app.init_resource::<Asked>();
    let floor = spawn_floor(&mut app);
    let body = spawn_box(&mut app, 0.0, 0.5);
    app.world_mut()
        .entity_mut(body)
        .insert((ActiveCollisionHooks::MODIFY_CONTACTS, CollidingEntities::default()));
    steps(&mut app, 20);
    assert!(position(&app, body).y < 0.2);
    assert!(app.world().get::<CollidingEntities>(body).unwrap().contains(&floor));
}

/// What a hook saw last.
#[derive(Resource, Default)]
struct Load(std::sync::Mutex<Scalar>);

#[derive(SystemParam)]
struct Scales<'w> {
    load: Res<'w, Load>,
}

impl CollisionHooks for Scales<'_> {
    fn modify_contacts(&self, contacts: &mut ContactPair, _: &mut Commands) -> bool {
        *self.load.0.lock().unwrap() = contacts.total_normal_impulse_magnitude();
        true
    }
}

/// An app that listens by hooks only sees impulses grow.
#[test]
fn a_hook_reads_the_impulses_of_the_last_step() {
    let mut app = app::<Scales>();
    app.init_resource::<Load>();
    spawn_floor(&mut app);
    let body = spawn_box(&mut app, 0.0, 0.5);
    app.world_mut().entity_mut(body).insert((
        Mass(1.0),
        SleepingDisabled,
        ActiveCollisionHooks::MODIFY_CONTACTS,
    ));
    for mass in [1.0, 10.0, 3.0] {
        app.world_mut().entity_mut(body).insert(Mass(mass));
        steps(&mut app, 64);
        let load = *app.world().resource::<Load>().0.lock().unwrap();
        let expected = mass as Scalar * 10.0 / 64.0;
        assert!((load - expected).abs() < 0.02 * expected, "{load} N·s for {expected}");
    }
}

#[test]
fn hooked_contacts_have_the_same_bits_for_any_number_of_workers() {
    let run = |workers| {
        let mut app = app::<Belts>();
        app.insert_resource(avian::dynamics::solver::WorkerCount(workers));
        let belt = spawn_floor(&mut app);
        app.world_mut().entity_mut(belt).insert((Belt(1.0), ActiveCollisionHooks::MODIFY_CONTACTS));
        let bodies: Vec<Entity> = (0..30)
            .map(|i| spawn_box(&mut app, (i % 6) as f32 * 1.1 - 3.0, 0.5 + 1.1 * (i / 6) as f32))
            .collect();
        steps(&mut app, 100);
        bodies.iter().map(|body| position(&app, *body).to_array().map(Scalar::to_bits)).collect::<Vec<_>>()
    };
    assert_eq!(run(1), run(2));
}
