//! Deep overlap without explosions, and scenes in pixels: row 18 of the required physics.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;
use bevy_transform::components::Transform;
use scenes::scene::at;

use super::{
    dim,
    world::{G, Lab},
};

/// A closed box above the origin, `2 half` wide and high, with alternating balls and boxes inside.
fn full_container(lab: &mut Lab) -> (Scalar, Vec<Entity>) {
    let (columns, rows) = dim::LAYER;
    let half = 0.5 * columns as f32;
    let long = 2.0 * half + 8.0;
    for (size, x, y) in [
        ([long, 4.0], 0.0, -2.0),
        ([long, 4.0], 0.0, 2.0 * half + 2.0),
        ([4.0, long], -half - 2.0, half),
        ([4.0, long], half + 2.0, half),
    ] {
        lab.spawn((RigidBody::Static, dim::sized_block(size[0], size[1], long), at(x, y, 0.0)));
    }
    for (wall, place) in dim::side_walls(half) {
        lab.spawn((RigidBody::Static, wall, Position(place), Rotation::default()));
    }
    let mut bodies = Vec::new();
    for layer in 0..columns {
        for row in 0..rows {
            for column in 0..columns {
                let cell = |i: u32, n: u32| i as f32 + 0.5 - 0.5 * n as f32;
                let pose = at(cell(column, columns), layer as f32 + 0.5, cell(row, rows));
                let body = lab.spawn((RigidBody::Dynamic, growing(bodies.len(), 0.2), pose));
                bodies.push(body);
            }
        }
    }
    (half, bodies)
}

/// A ball of a radius, or a box of twice its width.
fn growing(index: usize, radius: f32) -> Collider {
    match index % 2 {
        0 => scenes::dim::ball(radius),
        _ => dim::sized_block(2.0 * radius, 2.0 * radius, 2.0 * radius),
    }
}

/// Fails unless all bodies are inside of the container. Returns the maximum speed.
#[track_caller]
fn greatest_speed_inside(lab: &Lab, half: Scalar, bodies: &[Entity]) -> Scalar {
    let mut fastest: Scalar = 0.0;
    for &body in bodies {
        let p = lab.at(body) - Vector::Y * half;
        assert!(p.abs().max_element() < half, "a body left: {p:?} from the middle");
        fastest = fastest.max(lab.velocity(body).length());
    }
    fastest
}

#[test]
fn bodies_that_grow_in_a_full_container_neither_explode_nor_leave() {
    let mut lab = Lab::new();
    let (half, bodies) = full_container(&mut lab);
    let mut fastest: Scalar = 0.0;
    // From loose to 1.5 times the capacity, in five seconds.
    for step in 0..300 {
        let radius = 0.2 + 0.4 * step as f32 / 300.0;
        for (i, &body) in bodies.iter().enumerate() {
            lab.insert(body, growing(i, radius));
        }
        lab.steps(1);
        fastest = fastest.max(greatest_speed_inside(&lab, half, &bodies));
    }
    println!("while growing: at most {fastest} m/s");
    // A body that falls from lid to floor is faster.
    assert!(fastest < (2.0 * G * 2.0 * half).sqrt(), "flung at {fastest} m/s");
    let mut later: Vec<Scalar> = (0..300)
        .map(|_| {
            lab.steps(1);
            greatest_speed_inside(&lab, half, &bodies)
        })
        .collect();
    let last_second = &mut later[240..];
    last_second.sort_by(Scalar::total_cmp);
    println!("crammed: {last_second:?} m/s");
    // Bodies for which there is no room jostle for good, and now and then one of them jumps.
    assert!(last_second[30] < 0.5, "it does not calm down: {} m/s", last_second[30]);
}

#[test]
fn a_collider_grows_by_its_scale_too() {
    let mut lab = Lab::new();
    lab.floor();
    let body = lab.unit_box(at(0.0, 0.5, 0.0));
    lab.seconds(0.5);
    for step in 1..=60 {
        let world = lab.app.world_mut();
        let mut entity = world.entity_mut(body);
        let mut transform = entity.get_mut::<Transform>().expect("a transform");
        transform.scale = Vec3::splat(1.0 + step as f32 / 60.0);
        lab.steps(1);
    }
    lab.seconds(1.0);
    assert!((lab.at(body).y - 1.0).abs() < 0.02, "twice as large it rests at {:?}", lab.at(body));
}

/// Takes a step. Returns the maximum speed of a body, by its displacement and by its velocity.
///
/// Deep overlap displaces bodies without changing velocities, so velocities alone would not show it.
fn fastest_in_step(lab: &mut Lab, bodies: &[Entity]) -> Scalar {
    let before: Vec<Vector> = bodies.iter().map(|&b| lab.at(b)).collect();
    lab.steps(1);
    bodies.iter().zip(before).fold(0.0, |most: Scalar, (&b, before)| {
        most.max((lab.at(b) - before).length() / lab.dt as Scalar).max(lab.velocity(b).length())
    })
}

/// The minimum distance between the centres of two bodies.
fn nearest_two(lab: &Lab, bodies: &[Entity]) -> Scalar {
    let places: Vec<Vector> = bodies.iter().map(|&b| lab.at(b)).collect();
    let pairs =
        places.iter().enumerate().flat_map(|(i, p)| places[..i].iter().map(move |q| (*p - *q).length()));
    pairs.fold(Scalar::INFINITY, Scalar::min)
}

#[test]
fn a_hundred_bodies_in_one_place_come_apart_gently() {
    for kind in [0, 1] {
        let mut lab = Lab::weightless();
        let bodies: Vec<Entity> = (0..100)
            .map(|i| {
                lab.spawn((
                    RigidBody::Dynamic,
                    growing(kind, 0.5),
                    // What parts more slowly than the threshold falls asleep with some overlap left.
                    SleepingDisabled,
                    dim::turned(0.01 * i as f32),
                    Position::default(),
                ))
            })
            .collect();
        let push_out =
            lab.app.world().resource::<avian::dynamics::solver::SolverConfig>().max_overlap_solve_speed;
        let mut fastest: Scalar = 0.0;
        let apart = (0..150).find(|_| {
            fastest = (0..10).fold(fastest, |most, _| most.max(fastest_in_step(&mut lab, &bodies)));
            nearest_two(&lab, &bodies) > 0.95
        });
        let seconds = apart.map(|tenths| (tenths + 1) as f64 * 10.0 * lab.dt);
        println!("kind {kind}: at up to {fastest} m/s of {push_out}, apart after {seconds:?} s");
        assert!(fastest <= push_out, "pushed apart at {fastest} m/s");
        assert!(apart.is_some(), "two are still in each other: {} m", nearest_two(&lab, &bodies));
    }
}

/// Stacks of balls and of boxes, and a ball that rolls into them, with lengths times `unit`.
fn stacks(unit: Scalar) -> Vec<Vector> {
    let mut lab = Lab::with_unit(unit);
    lab.gravity(Vector::Y * -10.0 * unit);
    let place = |x: f32, y: f32| at(x * unit, y * unit, 0.0);
    lab.spawn((RigidBody::Static, dim::sized_block(40.0 * unit, 4.0 * unit, 40.0 * unit), place(0.0, -2.0)));
    let mut bodies = Vec::new();
    for i in 0..8 {
        bodies.push(lab.ball(0.5 * unit, place(-3.0, 0.5 + i as f32)));
        bodies.push(lab.block([unit; 3], place(3.0, 0.5 + i as f32)));
    }
    let ball = lab.ball(0.4 * unit, place(-1.5, 0.4));
    lab.insert(ball, LinearVelocity(Vector::X * 3.0 * unit));
    bodies.push(ball);
    lab.seconds(5.0);
    bodies.iter().map(|&b| lab.at(b) / unit).collect()
}

#[test]
fn a_scene_in_pixels_with_its_length_unit_behaves_as_in_metres() {
    let metres = stacks(1.0);
    for unit in [10.0, 100.0] {
        for (m, p) in metres.iter().zip(stacks(unit)) {
            assert!((*m - p).length() < 0.01, "{m:?} m, but {p:?} times {unit} pixels");
        }
    }
    // A power of two scales without rounding: all bits agree unless a tolerance is not scaled.
    assert_eq!(metres, stacks(8.0));
}

#[test]
fn two_bodies_in_each_other_part_at_no_more_than_the_push_out_speed() {
    let mut lab = Lab::weightless();
    let pair = [0.0, 0.1].map(|x| lab.ball(0.5, at(x, 0.0, 0.0)));
    let mut fastest: Scalar = 0.0;
    for _ in 0..120 {
        let before = lab.at(pair[1]) - lab.at(pair[0]);
        lab.steps(1);
        let way = lab.at(pair[1]) - lab.at(pair[0]) - before;
        let speed = (lab.velocity(pair[1]) - lab.velocity(pair[0])).length();
        fastest = fastest.max(speed).max(way.length() / lab.dt as Scalar);
    }
    // Displacements are differences of rounded positions.
    assert!(fastest <= 4.0001, "apart at {fastest} m/s");
    assert!((lab.at(pair[1]) - lab.at(pair[0])).length() > 0.99, "they did not come apart");
}

#[test]
fn bodies_may_be_spawned_in_each_other_on_a_floor() {
    let mut lab = Lab::new();
    lab.floor();
    let bodies: Vec<Entity> = (0..20)
        .map(|_| lab.spawn((RigidBody::Dynamic, growing(1, 0.5), Transform::from_xyz(0.0, 0.5, 0.0))))
        .collect();
    lab.seconds(15.0);
    for &body in &bodies {
        let p = lab.at(body);
        assert!(p.is_finite() && p.y > 0.45 && p.length() < 12.0, "at {p:?}");
        assert!(lab.velocity(body).length() < 0.2, "still at {:?} m/s", lab.velocity(body));
    }
}
