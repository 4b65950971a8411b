//! Islands fall asleep together and wake when something happens to them.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use bevy_transform::components::Transform;
use scenes::scene::at;

use super::{
    dim,
    world::{G, Lab},
};

/// A floor and a sleeping tower of three boxes on it.
fn sleeping_tower() -> (Lab, Entity, [Entity; 3]) {
    let mut lab = Lab::new();
    let floor = lab.floor();
    let boxes = [0.5, 1.5, 2.5].map(|y| lab.unit_box(at(0.0, y, 0.0)));
    lab.seconds(3.0);
    assert_eq!(asleep(&lab, &boxes), 3, "a tower at rest sleeps");
    (lab, floor, boxes)
}

fn asleep(lab: &Lab, bodies: &[Entity]) -> usize {
    bodies.iter().filter(|&&b| lab.has::<Sleeping>(b)).count()
}

#[test]
fn a_tower_sleeps_as_one_after_half_a_second_of_rest() {
    let mut lab = Lab::new();
    lab.floor();
    let boxes = [0.5, 1.5, 2.5].map(|y| lab.unit_box(at(0.0, y, 0.0)));
    let mut counts = Vec::new();
    let mut fell_asleep = None;
    for step in 0..180 {
        lab.steps(1);
        counts.push(asleep(&lab, &boxes));
        if counts[step] > 0 && fell_asleep.is_none() {
            fell_asleep = Some(step);
        }
    }
    let step = fell_asleep.expect("it sleeps");
    assert!((29..120).contains(&step), "after {step} steps");
    assert!(counts[..step].iter().all(|&n| n == 0) && counts[step..].iter().all(|&n| n == 3), "{counts:?}");
}

#[test]
fn a_hit_wakes_the_whole_tower() {
    let (mut lab, _, boxes) = sleeping_tower();
    lab.ball(0.3, at(0.2, 5.0, 0.0));
    lab.seconds(1.0);
    assert_eq!(asleep(&lab, &boxes), 0);
    lab.seconds(5.0);
    assert_eq!(asleep(&lab, &boxes), 3);
}

#[test]
fn taking_the_marker_off_one_wakes_all() {
    let (mut lab, _, boxes) = sleeping_tower();
    lab.remove::<Sleeping>(boxes[0]);
    lab.steps(2);
    assert_eq!(asleep(&lab, &boxes), 0);
}

#[test]
fn putting_the_marker_on_one_puts_all_to_sleep() {
    let mut lab = Lab::new();
    lab.floor();
    let boxes = [0.5, 1.5].map(|y| lab.unit_box(at(0.0, y, 0.0)));
    lab.steps(5);
    lab.insert(boxes[0], Sleeping);
    lab.steps(2);
    assert_eq!(asleep(&lab, &boxes), 2);
}

#[test]
fn a_velocity_wakes() {
    let (mut lab, _, boxes) = sleeping_tower();
    lab.insert(boxes[2], LinearVelocity(Vector::Y * 3.0));
    lab.steps(2);
    assert_eq!(asleep(&lab, &boxes), 0);
    assert!(lab.velocity(boxes[2]).y > 2.0, "{:?}", lab.velocity(boxes[2]));
}

#[test]
fn a_teleport_wakes_what_is_left_and_what_is_moved() {
    let (mut lab, _, boxes) = sleeping_tower();
    lab.insert(boxes[0], Position(dim::sized(10.0, 0.5, 0.0)));
    lab.seconds(1.5);
    assert!((lab.at(boxes[1]).y - 0.5).abs() < 0.02, "it fell to {:?}", lab.at(boxes[1]));
    assert!((lab.at(boxes[0]).x - 10.0).abs() < 0.02, "and the other stays away");
}

#[test]
fn a_transform_moves_a_sleeper_too() {
    let (mut lab, _, boxes) = sleeping_tower();
    lab.insert(boxes[2], Transform::from_xyz(0.0, 6.0, 0.0));
    lab.steps(6);
    let y = lab.at(boxes[2]).y;
    assert!(y < 6.0 && y > 5.5, "it falls from there: {y}");
}

#[test]
fn a_support_that_goes_wakes_what_stood_on_it() {
    for how in 0..4 {
        let (mut lab, floor, boxes) = sleeping_tower();
        match how {
            0 => lab.despawn(floor),
            1 => lab.insert(floor, ColliderDisabled),
            2 => lab.insert(floor, RigidBodyDisabled),
            _ => lab.remove::<Collider>(floor),
        }
        lab.seconds(1.0);
        let y = lab.at(boxes[0]).y;
        assert!((y + 0.5 * G - 0.5).abs() < 0.6, "way {how}: it fell freely for a second, to {y}");
    }
}

#[test]
fn a_floor_that_moves_wakes_what_stands_on_it() {
    let (mut lab, floor, boxes) = sleeping_tower();
    lab.insert(floor, Position(dim::sized(0.0, -11.0, 0.0)));
    lab.seconds(1.5);
    assert!((lab.at(boxes[0]).y + 0.5).abs() < 0.02, "it followed to {:?}", lab.at(boxes[0]));
}

#[test]
fn issue_sleepers_slept_on_when_a_surface_changed() {
    type Change = (&'static str, fn(&mut Lab, Entity));
    fn facets() -> FacetMaterials {
        FacetMaterials { materials: vec![FacetMaterial::from(Friction::new(0.01))], facets: vec![0; 64] }
    }
    let changes: [Change; 6] = [
        ("friction", |lab, e| lab.insert(e, Friction::new(0.1))),
        ("restitution", |lab, e| lab.insert(e, Restitution::new(0.9))),
        ("mutated friction", |lab, e| {
            lab.insert(e, Friction::new(0.1));
            lab.seconds(8.0);
            lab.app.world_mut().get_mut::<Friction>(e).expect("inserted").dynamic_coefficient = 0.2;
        }),
        ("hooks", |lab, e| lab.insert(e, ActiveCollisionHooks::MODIFY_CONTACTS)),
        ("facets", |lab, e| lab.insert(e, facets())),
        ("no friction any more", |lab, e| {
            lab.insert(e, Friction::new(0.1));
            lab.seconds(8.0);
            lab.remove::<Friction>(e);
        }),
    ];
    for (what, change) in changes {
        for of_floor in [true, false] {
            let (mut lab, floor, boxes) = sleeping_tower();
            let changed = if of_floor { floor } else { boxes[0] };
            change(&mut lab, changed);
            lab.steps(1);
            assert_eq!(asleep(&lab, &boxes), 0, "{what}, of the floor: {of_floor}");
            lab.seconds(8.0);
            assert_eq!(asleep(&lab, &boxes), boxes.len(), "{what}, of the floor: {of_floor}");
            // The same again is no change.
            if let Some(friction) = lab.app.world().get::<Friction>(changed).copied() {
                lab.insert(changed, friction);
            }
            lab.steps(2);
            assert_eq!(asleep(&lab, &boxes), boxes.len(), "{what}, of the floor: {of_floor}");
        }
    }
}

#[test]
fn other_gravity_wakes() {
    let (mut lab, _, boxes) = sleeping_tower();
    lab.gravity(Vector::Y * 5.0);
    lab.seconds(1.0);
    assert_eq!(asleep(&lab, &boxes), 0);
    assert!(lab.at(boxes[0]).y > 1.0, "it rises: {:?}", lab.at(boxes[0]));
}

#[test]
fn who_must_not_sleep_keeps_the_island_awake() {
    for way in 0..2 {
        let mut lab = Lab::new();
        lab.floor();
        let boxes = [0.5, 1.5].map(|y| lab.unit_box(at(0.0, y, 0.0)));
        let apart = lab.unit_box(at(5.0, 0.5, 0.0));
        match way {
            0 => lab.insert(boxes[1], SleepingDisabled),
            _ => lab.insert(boxes[1], SleepThreshold { linear: -1.0, angular: -1.0 }),
        }
        lab.seconds(3.0);
        assert_eq!((asleep(&lab, &boxes), asleep(&lab, &[apart])), (0, 1), "way {way}");
    }
}

#[test]
fn a_moving_platform_keeps_its_load_awake() {
    let mut lab = Lab::new();
    let platform = lab.spawn((RigidBody::Kinematic, dim::sized_block(8.0, 1.0, 8.0), at(0.0, -0.5, 0.0)));
    lab.insert(platform, LinearVelocity(Vector::X * 0.01));
    let load = lab.unit_box(at(0.0, 0.5, 0.0));
    lab.seconds(3.0);
    assert_eq!(asleep(&lab, &[load]), 0);
    lab.insert(platform, LinearVelocity::ZERO);
    lab.seconds(3.0);
    assert_eq!(asleep(&lab, &[load]), 1);
    lab.insert(platform, LinearVelocity(Vector::Y));
    lab.seconds(1.0);
    assert!((lab.at(load).y - 1.5).abs() < 0.05, "it is lifted: {:?}", lab.at(load));
}

#[test]
fn without_the_sleeping_plugin_nobody_sleeps() {
    use bevy_app::PluginGroup;
    let plugins = PhysicsPlugins::default().build().disable::<IslandSleepingPlugin>();
    let mut lab = Lab { app: scenes::headless_app_with(1.0 / 60.0, 4, plugins), dt: 1.0 / 60.0 };
    lab.floor();
    let body = lab.unit_box(at(0.0, 0.5, 0.0));
    lab.seconds(3.0);
    assert!(!lab.has::<Sleeping>(body) && (lab.at(body).y - 0.5).abs() < 0.01);
}

#[test]
fn issue_a_body_once_forbidden_to_sleep_never_slept_again() {
    let mut lab = Lab::new();
    lab.floor();
    let boxes = [0.5, 1.5].map(|y| lab.unit_box(at(0.0, y, 0.0)));
    lab.insert(boxes[0], SleepingDisabled);
    lab.seconds(2.0);
    assert_eq!(asleep(&lab, &boxes), 0);
    lab.remove::<SleepingDisabled>(boxes[0]);
    lab.steps(20);
    assert_eq!(asleep(&lab, &boxes), 0, "the half second begins when it is allowed to");
    lab.seconds(1.0);
    assert_eq!(asleep(&lab, &boxes), 2);
    lab.insert(boxes[0], SleepingDisabled);
    lab.seconds(2.0);
    assert_eq!(asleep(&lab, &boxes), 0, "forbidding it wakes");
}

#[test]
fn issue_bodies_whose_position_is_the_apps_slept_in_motion() {
    use avian::dynamics::integrator::CustomPositionIntegration;
    let mut lab = Lab::weightless();
    let [fast, moved, still] = [0.0, 5.0, 10.0].map(|x| lab.unit_box(at(x, 0.0, 0.0)));
    for body in [fast, moved, still] {
        lab.insert(body, CustomPositionIntegration);
    }
    lab.insert(fast, LinearVelocity(Vector::Y));
    for _ in 0..120 {
        let to = lab.at(moved) + Vector::Y * 0.05;
        lab.insert(moved, Position(to));
        lab.steps(1);
    }
    assert_eq!((asleep(&lab, &[fast, moved]), asleep(&lab, &[still])), (0, 1));
    assert_eq!(lab.velocity(fast), Vector::Y);
    lab.insert(fast, LinearVelocity::ZERO);
    lab.seconds(1.0);
    assert_eq!(asleep(&lab, &[fast, moved, still]), 3, "left alone they rest");
}

/// A thrown body turns at the top, a released one starts slowly: neither is rest.
#[test]
fn issue_with_no_time_to_sleep_bodies_froze_in_flight() {
    for (time, up) in [(0.0, 3.0), (-1.0, 3.0), (0.0, 0.0)] {
        let mut lab = Lab::new();
        lab.app.insert_resource(TimeToSleep(time));
        lab.floor();
        let body = lab.unit_box(at(0.0, 3.0, 0.0));
        lab.insert(body, LinearVelocity(Vector::Y * up));
        for step in 0..40 {
            lab.steps(1);
            assert_eq!(asleep(&lab, &[body]), 0, "in step {step} at {}", lab.at(body));
        }
        lab.seconds(3.0);
        assert_eq!(asleep(&lab, &[body]), 1, "on the floor it sleeps");
        assert!((lab.at(body).y - 0.5).abs() < 0.02, "{}", lab.at(body));
    }
}

#[test]
fn issue_falling_asleep_zeroed_the_velocity() {
    let mut lab = Lab::new();
    lab.surfaces(0.0, 0.0);
    lab.floor();
    let boxes = [0.5, 1.5].map(|y| lab.unit_box(at(0.0, y, 0.0)));
    for body in boxes {
        lab.insert(body, (LinearVelocity(Vector::X * 0.02), AngularVelocity::default()));
    }
    while asleep(&lab, &boxes) == 0 {
        lab.steps(1);
    }
    let (velocity, place) = (boxes.map(|b| lab.velocity(b)), boxes.map(|b| lab.at(b)));
    assert!(velocity.iter().all(|v| (v.x - 0.02).abs() < 1.0e-3), "{velocity:?}");
    lab.seconds(2.0);
    // Setting the same value again is no push.
    lab.insert(boxes[1], LinearVelocity(velocity[1]));
    lab.steps(2);
    assert_eq!(asleep(&lab, &boxes), 2);
    assert_eq!((boxes.map(|b| lab.velocity(b)), boxes.map(|b| lab.at(b))), (velocity, place));

    lab.app.world_mut().commands().queue(WakeBody(boxes[0]));
    lab.steps(10);
    let way = lab.at(boxes[0]).x - place[0].x;
    assert!((way - 10.0 * 0.02 / 60.0).abs() < 1.0e-4, "woken it goes on as fast as it was: {way}");
}

#[test]
fn a_body_put_to_sleep_goes_on_when_it_wakes() {
    let mut lab = Lab::new();
    lab.surfaces(0.0, 0.0);
    lab.floor();
    let body = lab.unit_box(at(0.0, 0.5, 0.0));
    // Closer than one step's motion. Sleeping bodies have no velocity for contacts.
    let awake = lab.unit_box(at(1.1, 0.5, 0.0));
    lab.insert(awake, SleepingDisabled);
    lab.steps(5);
    lab.insert(body, (Sleeping, LinearVelocity(Vector::X * 10.0)));
    for _ in 0..30 {
        lab.steps(1);
        assert_eq!((asleep(&lab, &[body]), lab.velocity(body)), (1, Vector::X * 10.0));
        assert!(lab.at(body).x == 0.0 && lab.velocity(awake).x == 0.0);
    }
    lab.remove::<Sleeping>(body);
    lab.steps(10);
    assert!(lab.at(awake).x > 1.5, "it is hit: {:?}", lab.at(awake));

    // Another velocity wakes it.
    lab.insert(body, (Sleeping, LinearVelocity(-Vector::X)));
    lab.steps(3);
    assert_eq!(asleep(&lab, &[body]), 1);
    lab.insert(body, LinearVelocity(-Vector::X * 2.0));
    lab.steps(2);
    assert_eq!(asleep(&lab, &[body]), 0);
}

#[test]
fn a_tower_that_is_woken_again_and_again_stands() {
    let (mut lab, _, boxes) = sleeping_tower();
    let before = boxes.map(|b| lab.at(b));
    for _ in 0..30 {
        lab.app.world_mut().commands().queue(WakeBody(boxes[1]));
        lab.seconds(1.5);
        assert_eq!(asleep(&lab, &boxes), 3);
    }
    let moved = boxes.iter().zip(before).map(|(&b, before)| lab.at(b).distance(before));
    let farthest = moved.fold(0.0, Scalar::max);
    assert!(farthest < 1.0e-3, "it moved by {farthest}");
}

/// Moves a static body into a sleeping one, in one of several ways.
fn beset(lab: &mut Lab, how: usize, place: Vector) {
    let far = Vector::Y * 50.0;
    let wall = || dim::sized_block(1.0, 1.0, 1.0);
    let moved = |lab: &mut Lab, body: RigidBody| {
        let wall = lab.spawn((body, wall(), Position(far)));
        lab.steps(1);
        wall
    };
    match how {
        0 => _ = lab.spawn((RigidBody::Static, wall(), Position(place))),
        1 => _ = lab.spawn((RigidBody::Kinematic, wall(), Position(place))),
        2 => {
            let wall = moved(lab, RigidBody::Static);
            lab.insert(wall, Position(place));
        }
        3 => {
            let wall = moved(lab, RigidBody::Kinematic);
            lab.insert(wall, Position(place));
        }
        4 => {
            let body = lab.spawn((RigidBody::Static, Transform::IDENTITY));
            let wall = lab.spawn((wall(), at(0.0, 50.0, 0.0), ChildOf(body)));
            lab.steps(1);
            let [x, y] = [place.x, place.y];
            lab.insert(wall, at(x, y, 0.0));
        }
        5 => {
            let wall = lab.spawn((RigidBody::Static, wall(), Position(place), ColliderDisabled));
            lab.steps(1);
            lab.remove::<ColliderDisabled>(wall);
        }
        // In small steps: it is near before it touches.
        _ => {
            let wall = lab.spawn((RigidBody::Static, wall(), Position(place + Vector::X * 0.45)));
            for step in (0..45).rev() {
                lab.steps(50);
                lab.insert(wall, Position(place + Vector::X * (0.01 * step as f32)));
            }
        }
    }
}

#[test]
fn issue_what_was_put_into_a_sleeper_was_ignored() {
    for how in 0..7 {
        let mut lab = Lab::new();
        lab.floor();
        let body = lab.unit_box(at(0.0, 0.5, 0.0));
        lab.seconds(2.0);
        assert_eq!(asleep(&lab, &[body]), 1);
        beset(&mut lab, how, Vector::X * 0.7 + Vector::Y * 0.5);
        lab.steps(3);
        assert_eq!(asleep(&lab, &[body]), 0, "way {how}");
        lab.seconds(3.0);
        let x = lab.at(body).x;
        assert!(x < -0.28, "way {how}: it is pushed aside, to {x}");
        assert_eq!(asleep(&lab, &[body]), 1, "way {how}: and sleeps again");
    }
}

#[test]
fn a_level_may_be_spawned_asleep() {
    let mut lab = Lab::new();
    lab.floor();
    let boxes = |lab: &mut Lab, x: f32| {
        [0.5, 1.5, 2.5].map(|y| {
            let body = lab.unit_box(at(x, y, 0.0));
            // The state that was saved.
            lab.insert(body, (Sleeping, LinearVelocity(Vector::Y * 0.01)));
            body
        })
    };
    let first = boxes(&mut lab, 0.0);
    lab.steps(30);
    // Later, beside the first and on the existing floor.
    let later = boxes(&mut lab, 1.01);
    for _ in 0..60 {
        lab.steps(1);
        assert_eq!(asleep(&lab, &first) + asleep(&lab, &later), 6);
    }
}

/// Its position, recomputed from the centre of mass, differs in the last bit from the one that the app set.
#[test]
fn issue_a_body_off_its_centre_was_taken_for_moved_by_the_app_in_every_step() {
    for i in 0..20 {
        let mut lab = Lab::new();
        let turn = 0.037 * i as f32;
        let pose = Transform::from_xyz(0.3 + 0.17 * i as f32, 0.1, 0.0);
        let held = lab.block([4.0, 1.0, 4.0], pose);
        lab.insert(held, (LockedAxes::ALL_LOCKED, dim::turned(turn)));
        lab.insert(held, CenterOfMass(dim::sized(1.3, 0.71, 0.0)));
        lab.seconds(2.0);
        assert_eq!(asleep(&lab, &[held]), 1, "turned by {turn}");
    }
}
