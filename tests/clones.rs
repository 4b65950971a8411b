//! Clones of bodies and colliders: where they are, and what belongs to them.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::Time;
use bevy_transform::{TransformPlugin, components::Transform};
use core::time::Duration;
use scenes::dim::{ball, spin};

fn app() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, PhysicsPlugins::new(Update)))
        .insert_resource(Gravity::ZERO);
    app
}

fn step(app: &mut App) {
    app.world_mut().resource_mut::<Time>().advance_by(Duration::from_micros(15_625));
    app.update();
}

fn steps(app: &mut App, count: u32) {
    (0..count).for_each(|_| step(app));
}

fn at(x: f32, y: f32) -> Transform {
    Transform::from_xyz(x, y, 0.0)
}

fn place(x: Scalar, y: Scalar) -> Vector {
    Vector::X * x + Vector::Y * y
}

fn position(app: &App, entity: Entity) -> Vector {
    app.world().get::<Position>(entity).expect("it has a position").0
}

/// A ball at (3, 1) that has moved and turned.
fn original(app: &mut App) -> Entity {
    let body = (RigidBody::Dynamic, ball(0.5), at(2.0, 1.0), LinearVelocity(Vector::X * 2.0), spin(1.0));
    // Clones at the same place do not push each other.
    let body = app.world_mut().spawn((body, SleepingDisabled, CollisionLayers::NONE)).id();
    steps(app, 32);
    let mut entity = app.world_mut().entity_mut(body);
    entity.insert((LinearVelocity::ZERO, AngularVelocity::default()));
    step(app);
    assert!((position(app, body) - place(3.0, 1.0)).length() < 1.0e-4);
    body
}

#[test]
fn issue_a_clone_that_was_placed_by_its_transform_landed_on_the_original() {
    for (frames, steps_first) in [(0, false), (2, false), (0, true)] {
        let mut app = app();
        let body = original(&mut app);
        if frames > 0 {
            app.world_mut().resource_mut::<Time<Physics>>().pause();
        }
        let clone = app.world_mut().entity_mut(body).clone_and_spawn();
        if steps_first {
            step(&mut app);
            assert_eq!(position(&app, clone), position(&app, body));
        }
        app.world_mut().entity_mut(clone).insert(at(-4.0, 2.0));
        (0..frames).for_each(|_| app.update());
        app.world_mut().resource_mut::<Time<Physics>>().unpause();
        step(&mut app);
        assert!((position(&app, clone) - place(-4.0, 2.0)).length() < 1.0e-5, "{}", position(&app, clone));
        assert!((position(&app, body) - place(3.0, 1.0)).length() < 0.1);
        steps(&mut app, 5);
        assert!((position(&app, clone) - place(-4.0, 2.0)).length() < 1.0e-5, "{}", position(&app, clone));
    }
}

#[test]
fn a_clone_has_the_pose_of_its_original_or_the_one_given() {
    let mut app = app();
    let body = original(&mut app);
    let clone = app.world_mut().entity_mut(body).clone_and_spawn();
    let given = app.world_mut().entity_mut(body).clone_and_spawn();
    app.world_mut().entity_mut(given).insert(Position(place(7.0, 7.0)));
    let turned = app.world_mut().entity_mut(body).clone_and_spawn();
    app.world_mut().get_mut::<Transform>(turned).expect("it has one").rotate_z(0.5);
    let of = |app: &App, e| (position(app, e), *app.world().get::<Rotation>(e).expect("it has one"));
    let expected = of(&app, body);
    step(&mut app);
    assert_eq!(of(&app, body), expected);
    assert_eq!(of(&app, clone), expected, "bit for bit");
    assert_eq!(of(&app, given), (place(7.0, 7.0), expected.1));
    assert_eq!(of(&app, turned).0, expected.0);
    let between = (of(&app, turned).1 * Vector::X).dot(expected.1 * Vector::X);
    assert!((between - (0.5 as Scalar).cos()).abs() < 1.0e-5, "{between}");
    let transform = |e| *app.world().get::<Transform>(e).expect("it has one");
    assert_eq!(transform(clone), transform(body));
}

/// A cart with two wheels below it, one of them below a picture, and a flag that the app attached.
fn cart(app: &mut App) -> (Entity, Entity) {
    let world = app.world_mut();
    let root = world.spawn(at(10.0, 0.0)).id();
    let cart = world.spawn((RigidBody::Dynamic, ball(0.5), at(0.0, 1.0), ChildOf(root))).id();
    world.spawn((ball(0.2), at(-1.0, 0.0), ChildOf(cart)));
    let picture = world.spawn((at(1.0, 0.0), ChildOf(cart))).id();
    world.spawn((ball(0.2), at(0.0, 0.5), ChildOf(picture)));
    world.spawn((ball(0.1), ColliderOf { body: cart }, at(10.0, 3.0)));
    steps(app, 3);
    (root, cart)
}

/// Places of a body's colliders relative to it, sorted.
fn parts(app: &App, body: Entity) -> Vec<[i32; 2]> {
    let list = app.world().get::<RigidBodyColliders>(body).expect("it has colliders");
    let mut all: Vec<[i32; 2]> = list
        .iter()
        .map(|collider| {
            let of = app.world().get::<ColliderOf>(collider).expect("a link").body;
            assert_eq!(of, body);
            let offset = position(app, collider) - position(app, body);
            [offset.x, offset.y].map(|c| (c * 1000.0).round() as i32)
        })
        .collect();
    all.sort();
    all
}

#[test]
fn issue_linked_cloning_of_a_body_did_not_end() {
    let mut app = app();
    let (root, cart) = cart(&mut app);
    let expected = [[-1000, 0], [0, 0], [0, 2000], [1000, 500]];
    assert_eq!(parts(&app, cart), expected);
    let count = |app: &mut App| {
        let mut all = app.world_mut().query_filtered::<Entity, With<Collider>>();
        all.iter(app.world()).count()
    };
    let mass = app.world().get::<ComputedMass>(cart).expect("a body has one").value();

    // The body alone, and then all below its root, elsewhere.
    let clone = app.world_mut().entity_mut(cart).clone_and_spawn_with_opt_out(|cloner| {
        cloner.linked_cloning(true);
    });
    app.world_mut().entity_mut(clone).insert(at(0.0, 50.0));
    let other = app.world_mut().entity_mut(root).clone_and_spawn_with_opt_out(|cloner| {
        cloner.linked_cloning(true);
    });
    app.world_mut().entity_mut(other).insert(at(-30.0, 0.0));
    step(&mut app);
    let below = app.world().get::<Children>(other).expect("it has children");
    // The clone of the body is below the root, too.
    let carts: Vec<Entity> =
        below.iter().filter(|child| app.world().get::<RigidBody>(*child).is_some()).collect();
    assert_eq!(carts.len(), 2);
    assert_eq!(count(&mut app), 4 * 4);
    let all = [(clone, place(10.0, 50.0)), (carts[0], place(-30.0, 1.0)), (carts[1], place(-30.0, 50.0))];
    for (clone, expected_at) in all {
        assert!((position(&app, clone) - expected_at).length() < 1.0e-4, "{}", position(&app, clone));
        let cloned_mass = app.world().get::<ComputedMass>(clone).expect("a body has one").value();
        assert!((cloned_mass - mass).abs() < 1.0e-4 * mass, "{cloned_mass} for {mass}");
    }
    assert_eq!(parts(&app, cart), expected);
    for (clone, _) in all {
        assert_eq!(parts(&app, clone), expected);
    }
    // Despawning a clone takes its colliders with it, and no other.
    app.world_mut().despawn(clone);
    step(&mut app);
    assert_eq!(count(&mut app), 3 * 4);
    assert_eq!(parts(&app, cart), expected);
}

#[test]
fn a_body_cloned_without_links_has_its_own_collider_alone() {
    let mut app = app();
    let (_, cart) = cart(&mut app);
    let clone = app.world_mut().entity_mut(cart).clone_and_spawn();
    app.world_mut().entity_mut(clone).insert(at(0.0, 50.0));
    steps(&mut app, 2);
    assert_eq!(parts(&app, clone), [[0, 0]]);
    assert_eq!(parts(&app, cart).len(), 4);
}
