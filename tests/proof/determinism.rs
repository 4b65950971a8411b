//! The same bits, with any other entities in the app and any number of threads: row 22 of the
//! required physics.

use avian::{
    dynamics::solver::WorkerCount,
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;

use super::world::Lab;
use scenes::scene::at;

/// A component that physics does not know.
#[derive(Component)]
struct Paint(#[expect(dead_code, reason = "only there to make tables differ")] u64);

/// A heap of all shapes and compounds, poured for 200 steps. `before` and `after` change the app.
fn run(before: impl FnOnce(&mut Lab), after: impl FnOnce(&mut Lab, &[Entity])) -> Vec<u32> {
    let mut lab = Lab::new();
    before(&mut lab);
    scenes::pile::mixed(lab.app.world_mut(), 3);
    let bodies = bodies_by_place(&mut lab);
    after(&mut lab, &bodies);
    lab.steps(200);
    lab.bits(&bodies)
}

/// The dynamic bodies in an order that does not depend on entities.
fn bodies_by_place(lab: &mut Lab) -> Vec<Entity> {
    let world = lab.app.world_mut();
    let mut query = world.query::<(Entity, &RigidBody, &Transform)>();
    let mut bodies: Vec<(Entity, [u32; 3])> = query
        .iter(world)
        .filter(|(_, kind, _)| kind.is_dynamic())
        .map(|(e, _, t)| (e, t.translation.to_array().map(f32::to_bits)))
        .collect();
    bodies.sort_by_key(|b| b.1);
    bodies.into_iter().map(|b| b.0).collect()
}

fn plain() -> Vec<u32> {
    run(|_| {}, |_, _| {})
}

/// Replaces `assert_eq`, which would print ten thousand numbers.
#[track_caller]
fn assert_same_bits(one: &[u32], two: &[u32], what: &str) {
    let other = one.iter().zip(two).filter(|(a, b)| a != b).count();
    assert!(one.len() == two.len() && other == 0, "{what}: {other} of {} numbers differ", one.len());
    assert!(one.iter().all(|&bits| (Scalar::from_bits(bits)).is_finite()));
}

#[test]
fn the_same_bits_twice() {
    assert_same_bits(&plain(), &plain(), "run twice");
}

#[test]
fn entities_without_physics_do_not_matter() {
    let crowded = run(
        |lab| {
            for i in 0..100 {
                lab.spawn((Paint(i), Transform::default()));
            }
        },
        |lab, _| {
            for i in 0..57 {
                lab.spawn(Paint(i));
            }
        },
    );
    assert_same_bits(&plain(), &crowded, "among other entities");
}

#[test]
fn what_else_a_body_has_does_not_matter() {
    let painted = run(|_| {}, |lab, bodies| bodies.iter().step_by(3).for_each(|&b| lab.insert(b, Paint(1))));
    assert_same_bits(&plain(), &painted, "with other components");
}

#[test]
fn the_numbers_of_entities_do_not_matter() {
    // Freed entities are reused in another order.
    let reused = run(
        |lab| {
            let mut spare: Vec<Entity> = (0..300).map(|i| lab.spawn(Paint(i))).collect();
            let odd: Vec<Entity> = spare.iter().copied().skip(1).step_by(2).collect();
            spare.retain(|e| !odd.contains(e));
            spare.into_iter().chain(odd).for_each(|e| lab.despawn(e));
        },
        |_, _| {},
    );
    assert_same_bits(&plain(), &reused, "with other entities");
}

#[test]
fn a_foreign_system_in_the_substeps_does_not_matter() {
    #[derive(Resource, Default)]
    struct Substeps(u32);
    let counted = run(
        |lab| {
            lab.app.init_resource::<Substeps>();
            lab.app.add_systems(SubstepSchedule, |mut count: ResMut<Substeps>| count.0 += 1);
        },
        |_, _| {},
    );
    assert_same_bits(&plain(), &counted, "through the schedule");
}

#[test]
fn the_foreign_system_does_run_in_every_substep() {
    #[derive(Resource, Default)]
    struct Substeps(u32);
    let mut lab = Lab::new();
    lab.app.init_resource::<Substeps>();
    lab.app.add_systems(SubstepSchedule, |mut count: ResMut<Substeps>| count.0 += 1);
    lab.steps(10);
    assert_eq!(lab.app.world().resource::<Substeps>().0, 40);
}

#[test]
fn the_number_of_workers_does_not_matter() {
    // Enough contacts to wake all threads: a pyramid that a ball hits.
    let run = |workers: usize| {
        let mut lab = Lab::new();
        lab.app.insert_resource(WorkerCount(workers));
        let mut bodies = scenes::pyramid::large(lab.app.world_mut(), 36);
        let ball = lab.ball(1.5, at(-30.0, 6.0, 0.0));
        lab.insert(ball, LinearVelocity(Vector::X * 40.0));
        bodies.push(ball);
        lab.steps(120);
        lab.bits(&bodies)
    };
    let alone = run(1);
    for workers in [0, 2, 3, 8] {
        assert_same_bits(&alone, &run(workers), "by a pool");
    }
}

/// Changes by the app are found, and rows of bodies are filled, by several threads.
#[test]
fn the_number_of_workers_does_not_matter_to_what_the_app_changes() {
    let run = |workers: usize| {
        let mut lab = Lab::new();
        lab.app.insert_resource(WorkerCount(workers));
        let bodies = scenes::pyramid::large(lab.app.world_mut(), 36);
        for (i, &body) in bodies.iter().enumerate() {
            match i % 9 {
                0 => lab.insert(body, Dominance(i as i8 % 3)),
                1 => lab.insert(body, LockedAxes::ROTATION_LOCKED),
                2 => lab.insert(body, (MaxLinearSpeed(2.0), LinearDamping(0.1))),
                3 => drop(lab.spawn((Transform::default(), ChildOf(body)))),
                _ => {}
            }
        }
        for step in 0..60 {
            for (i, &body) in bodies.iter().enumerate() {
                if (i + step) % 41 == 0 {
                    lab.insert(body, LinearVelocity(Vector::Y * 3.0));
                }
                if (i + step) % 97 == 0 {
                    let mut body = lab.app.world_mut().entity_mut(body);
                    body.get_mut::<Position>().expect("it is a body").0.x += 0.01;
                }
                if i % 100 == 50 && step == 20 {
                    lab.insert(body, LinearVelocity(Vector::splat(Scalar::NAN)));
                }
            }
            lab.steps(1);
        }
        let world = lab.app.world();
        for &body in &bodies {
            let (position, transform) = (world.get::<Position>(body), world.get::<Transform>(body));
            let (position, transform) = (position.expect("it is a body"), transform.expect("it is a body"));
            assert_eq!(
                (position.x as f32, position.y as f32),
                (transform.translation.x, transform.translation.y)
            );
        }
        let disabled = bodies.iter().filter(|body| world.get::<RigidBodyDisabled>(**body).is_some()).count();
        assert_eq!(disabled, bodies.len().div_ceil(100) - usize::from(bodies.len() % 100 < 51));
        lab.bits(&bodies)
    };
    let alone = run(1);
    for workers in [2, 4] {
        assert_same_bits(&alone, &run(workers), "by a pool");
    }
}
