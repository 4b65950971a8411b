//! Properties of every scene before its first step.

use avian::parry::bounding_volume::{Aabb, BoundingVolume};
use avian::parry::math::Pose;
use avian::parry::query;
use avian::parry::shape::SharedShape;
use avian::prelude::*;
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

use crate::{DT, SUBSTEPS, Scene, Watch, Watched, all, dim, headless_app, pyramid};

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
        let parts = placed(built(scene).world_mut());
        for (i, a) in parts.iter().enumerate() {
            for b in parts[i + 1..].iter().take_while(|b| b.bounds.mins.x <= a.bounds.maxs.x) {
                if a.body == b.body || !(a.dynamic || b.dynamic) || !a.bounds.intersects(&b.bounds) {
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
