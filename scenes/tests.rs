//! Properties of every scene before its first step.

use avian::dynamics::solver::joint_graph::JointGraph;
use avian::parry::bounding_volume::{Aabb, BoundingVolume};
use avian::parry::math::Pose;
use avian::parry::query;
use avian::parry::shape::SharedShape;
use avian::prelude::*;
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

use crate::{Bounds, DT, SUBSTEPS, Scene, Watch, Watched, all, dim, headless_app, pyramid};

/// A collider at its initial place.
struct Placed {
    body: Entity,
    dynamic: bool,
    shape: SharedShape,
    pose: Pose,
    bounds: Aabb,
}

fn built(scene: &Scene) -> App {
    let mut app = headless_app(DT, SUBSTEPS);
    (scene.build)(app.world_mut());
    app
}

/// All colliders of a scene, in the order of their left sides.
fn placed(world: &mut World) -> Vec<Placed> {
    let mut colliders = world.query::<(Entity, &Collider, &Transform, Option<&ChildOf>)>();
    let mut bodies = world.query::<(&RigidBody, &Transform)>();
    let found: Vec<(Entity, Option<Entity>, SharedShape, Transform)> = colliders
        .iter(world)
        .map(|(entity, collider, pose, parent)| {
            (entity, parent.map(ChildOf::parent), collider.shape_scaled().clone(), *pose)
        })
        .collect();
    let mut placed: Vec<Placed> = found
        .into_iter()
        .map(|(entity, parent, shape, local)| {
            let body = parent.unwrap_or(entity);
            let (kind, base) = bodies.get(world, body).expect("every collider belongs to a body");
            let global = if parent.is_some() { *base * local } else { local };
            let pose = dim::pose(&global);
            let bounds = shape.compute_aabb(&pose);
            Placed { body, dynamic: kind.is_dynamic(), shape, pose, bounds }
        })
        .collect();
    placed.sort_by(|a, b| a.bounds.mins.x.total_cmp(&b.bounds.mins.x));
    placed
}

#[test]
fn no_scene_starts_with_an_overlap() {
    for scene in all() {
        let mut app = built(scene);
        let parts = placed(app.world_mut());
        let joints = app.world().resource::<JointGraph>();
        for (i, a) in parts.iter().enumerate() {
            for b in parts[i + 1..].iter().take_while(|b| b.bounds.mins.x <= a.bounds.maxs.x) {
                let are_joined = joints.joints_between(a.body, b.body).next().is_some();
                if a.body == b.body
                    || are_joined
                    || !(a.dynamic || b.dynamic)
                    || !a.bounds.intersects(&b.bounds)
                {
                    continue;
                }
                if let Ok(Some(contact)) = query::contact(&a.pose, &*a.shape, &b.pose, &*b.shape, 0.0) {
                    assert!(
                        contact.dist > -1e-3,
                        "{}: {} deep at {}",
                        scene.name,
                        -contact.dist,
                        contact.point1
                    );
                }
            }
        }
    }
}

#[test]
fn what_ought_to_rest_is_marked_and_what_ought_to_stay_is_inside() {
    for scene in all() {
        let mut app = built(scene);
        let world = app.world_mut();
        let watched = world.query::<&Watched>().iter(world).count();
        match scene.watch {
            Watch::Rest => assert!(watched > 0, "{}", scene.name),
            Watch::Inside => {
                // Poured piles start above the picture, but no body starts beside or below it.
                for part in placed(world).iter().filter(|part| part.dynamic) {
                    let middle = part.bounds.center();
                    assert!(middle.x.abs() < scene.bounds.max.x, "{}", scene.name);
                    assert!(middle.y > scene.bounds.min.y, "{}", scene.name);
                }
            }
        }
    }
}

#[test]
fn names_are_unique_and_found() {
    for (i, scene) in all().iter().enumerate() {
        assert!(all()[..i].iter().all(|other| other.name != scene.name));
        assert_eq!(crate::find(scene.name).map(|found| found.about), Some(scene.about));
    }
    assert!(crate::find("no such scene").is_none());
}

#[test]
fn a_pyramid_of_base_n_has_n_rows() {
    let mut app = headless_app(DT, SUBSTEPS);
    let boxes = pyramid::large(app.world_mut(), 12);
    assert_eq!(boxes.len(), 12 * 13 / 2);
    let top = app.world().get::<Watched>(boxes[boxes.len() - 1]).expect("the last box is the top");
    assert_eq!(top.0.to_array(), [0.0, 11.5, 0.0]);
}

#[test]
fn one_step_is_one_tick() {
    let mut app = headless_app(0.5, SUBSTEPS);
    let falling = (RigidBody::Dynamic, Collider::capsule(0.5, 1.0), Transform::default());
    let body = app.world_mut().spawn(falling).id();
    app.world_mut().insert_resource(Gravity(dim::upwards(-2.0)));
    crate::step(&mut app);
    let speed = app.world().get::<LinearVelocity>(body).expect("bodies have velocities").0.y;
    assert!((speed + 1.0).abs() < 1e-5, "after one step of 0.5 s at 2 m/s²: {speed}");
}

/// A scene after some seconds, and all its dynamic and kinematic bodies.
fn played(name: &str, seconds: u32) -> (App, Vec<Entity>) {
    let scene = crate::find(name).expect("a scene of that name");
    let mut app = built(scene);
    (0..60 * seconds).for_each(|_| crate::step(&mut app));
    let world = app.world_mut();
    let mut bodies = world.query::<(Entity, &RigidBody, &Position)>();
    let moving = bodies.iter(world).filter(|(_, body, _)| !body.is_static());
    let found = moving.map(|(entity, _, position)| {
        let Bounds { min, max } = scene.bounds;
        let inside = (min.x..max.x).contains(&position.x) && (min.y..max.y).contains(&position.y);
        assert!(inside, "{name}: a body is at {}", position.0);
        entity
    });
    let found = found.collect();
    (app, found)
}

/// How many joints of a world are intact, by their graph.
fn joint_count(app: &App, bodies: &[Entity]) -> usize {
    let joints = app.world().resource::<JointGraph>();
    bodies.iter().map(|body| joints.joints_of(*body).count()).sum()
}

#[test]
fn joints_and_characters_do_what_their_scenes_say() {
    let (app, cars) = played("cars", 10);
    let x = |body: &Entity| app.world().get::<Position>(*body).expect("a body has a place").x;
    let farthest = cars.iter().map(x).fold(f32::MIN, f32::max);
    assert!(farthest > 17.0, "the stacks were moved: {:?}", cars.iter().map(x).collect::<Vec<_>>());

    let (app, bricks) = played("breaking", 3);
    let (whole, _) = played("breaking", 0);
    assert!(joint_count(&app, &bricks) < joint_count(&whole, &bricks), "some joints broke");

    let (app, humans) = played("ragdolls", 6);
    assert!(humans.len() >= 11 * 6, "{} bones", humans.len());
    for bone in humans {
        let speed = app.world().get::<LinearVelocity>(bone).expect("a body has a velocity").length();
        assert!(speed < 3.0, "a bone moves at {speed} m/s");
    }

    let (app, walkers) = played("walkers", 8);
    for walker in walkers {
        let Some(state) = app.world().get::<CharacterState>(walker) else { continue };
        assert!(state.is_grounded(), "{state:?}");
    }
}
