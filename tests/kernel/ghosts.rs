//! Bodies that slide over floors of several pieces, as if the floor were one piece.

use super::dim::{riders, sized, tiles, turned};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Cuboid, Shape};
use kernel::table::BodyKind;

/// The effect of a ride over a floor on the rider.
#[derive(Clone, Copy, Debug)]
struct Ride {
    /// The ratio of final to initial speed, minus 1.
    gained: f32,
    /// Maximum rise above the initial height, in metres.
    bump: f32,
    /// Sideways displacement, in metres.
    aside: f32,
}

/// The ride of a rider without friction over 10 m of a floor whose top is at y = 0.
fn ride(floor: &[(Shape, Vector)], rider: &Shape, speed: f32) -> Ride {
    ride_on(BodyKind::Static, floor, rider, Vector::X, speed)
}

/// The same over pieces of a kind, in a direction of length 1.
fn ride_on(kind: BodyKind, floor: &[(Shape, Vector)], rider: &Shape, direction: Vector, speed: f32) -> Ride {
    let mut sim = Sim::new();
    sim.checked = false;
    (sim.dt, sim.substeps) = (1.0 / 64.0, 6);
    for (shape, place) in floor {
        sim.add_with(kind, shape.clone(), *place, Rot::IDENTITY, 0.0, 0.0);
    }
    if kind == BodyKind::Dynamic {
        let half = sized(40.0, 1.0, 40.0);
        sim.add_with(
            BodyKind::Static,
            Shape::Cuboid(Cuboid { half }),
            Vector::Y * -2.0,
            Rot::IDENTITY,
            1.0,
            0.0,
        );
    }
    let low = rider.local_aabb(Rot::IDENTITY).min.y;
    let id = sim.add_with(BodyKind::Dynamic, rider.clone(), Vector::Y * -low, Rot::IDENTITY, 0.0, 0.0);
    // The rider settles first.
    sim.steps(64);
    let start = sim.bodies.poses[id as usize].center.to_local();
    sim.bodies.velocities[id as usize].linear = direction * speed;
    let mut ride = Ride { gained: 0.0, bump: 0.0, aside: 0.0 };
    for _ in 0..(10.0 / speed / sim.dt) as usize {
        sim.step();
        let moved = sim.bodies.poses[id as usize].center.to_local() - start;
        ride.bump = ride.bump.max(moved.y);
        let along = direction * moved.dot(direction);
        ride.aside = ride.aside.max(super::dim::across(moved - along).abs());
    }
    ride.gained = sim.bodies.velocities[id as usize].linear.dot(direction) / speed - 1.0;
    ride
}

#[test]
fn floors_of_flush_pieces_do_not_stop_or_lift_what_slides_over_them() {
    let mut bad = Vec::new();
    for (floor, pieces) in tiles() {
        for (name, rider) in riders() {
            for speed in [1.0, 3.0, 10.0, 20.0] {
                let ride = ride(&pieces, &rider, speed);
                if !(ride.gained.abs() < 1.0e-3 && ride.bump < 5.0e-4 && ride.aside < 1.0e-3) {
                    bad.push((floor, name, speed, ride));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

#[test]
fn floors_of_flush_pieces_do_not_stop_what_slides_over_them_aslant() {
    let direction = sized(1.0, 0.0, 0.14);
    let direction = direction * (1.0 / direction.length());
    let mut bad = Vec::new();
    for (floor, pieces) in tiles() {
        for (name, rider) in riders() {
            for speed in [1.0, 3.0, 10.0, 20.0] {
                let ride = ride_on(BodyKind::Static, &pieces, &rider, direction, speed);
                if !(ride.gained.abs() < 1.0e-3 && ride.bump < 5.0e-4 && ride.aside < 1.0e-3) {
                    bad.push((floor, name, speed, ride));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

#[test]
fn bodies_that_rest_side_by_side_are_a_floor() {
    let mut bad = Vec::new();
    for (floor, pieces) in tiles().into_iter().filter(|(name, _)| ["boxes", "hulls"].contains(name)) {
        for (name, rider) in riders() {
            // Slower riders are aslant on what gives way under them for longer.
            for speed in [3.0, 10.0] {
                let ride = ride_on(BodyKind::Dynamic, &pieces, &rider, Vector::X, speed);
                if !(ride.gained.abs() < 1.0e-3 && ride.bump < 5.0e-4 && ride.aside < 1.0e-3) {
                    bad.push((floor, name, speed, ride));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// Two flush boxes of 1 m depth, the second higher than the first by `height`, which meet at x = 2.
fn step_of(height: f32) -> Vec<(Shape, Vector)> {
    let half = sized(2.5, 0.5, 2.0);
    let cuboid = |half| Shape::Cuboid(Cuboid { half });
    let middle = Vector::Y * -0.5;
    vec![
        (cuboid(half), middle + Vector::X * -0.5),
        (cuboid(sized(6.0, 0.5, 2.0)), middle + Vector::X * 8.0 + Vector::Y * height),
    ]
}

#[test]
fn steps_stop_or_lift_what_runs_against_them() {
    for height in [0.001, 0.005, 0.02, 0.05] {
        for (name, rider) in riders() {
            for speed in [1.0, 3.0, 10.0] {
                let ride = ride(&step_of(height), &rider, speed);
                // It either rose by the height of the step, or was thrown back.
                let is_up = ride.bump > 0.9 * height;
                let is_stopped = ride.gained < -0.5;
                assert!(is_up || is_stopped, "{name} at {speed} through a step of {height}: {ride:?}");
            }
        }
    }
}

#[test]
fn a_wall_on_a_floor_of_tiles_stops_what_slides_against_it() {
    for (floor, mut pieces) in tiles() {
        let wall = Shape::Cuboid(Cuboid { half: sized(0.5, 1.0, 2.0) });
        pieces.push((wall, Vector::X * 4.5 + Vector::Y * 1.0));
        for (name, rider) in riders() {
            for speed in [1.0, 3.0, 10.0, 20.0] {
                let ride = ride(&pieces, &rider, speed);
                assert!(ride.gained < -0.99, "{name} over {floor} at {speed}: {ride:?}");
            }
        }
    }
}

/// A body without friction between two walls that lean away from it by an angle, after three seconds.
fn in_a_groove(rider: &Shape, angle: f32) -> Vector {
    let mut sim = Sim::new();
    let half = sized(2.0, 0.5, 2.0);
    for side in [-1.0, 1.0] {
        let rotation = turned(side * angle);
        // The inner edges of both tops meet at the origin.
        let center = rotation.rotate(Vector::X * (side * 2.0) - Vector::Y * 0.5);
        sim.add_with(BodyKind::Static, Shape::Cuboid(Cuboid { half }), center, rotation, 0.0, 0.0);
    }
    let id = sim.add_with(BodyKind::Dynamic, rider.clone(), Vector::Y * 1.0, Rot::IDENTITY, 0.0, 0.0);
    sim.steps(180);
    sim.bodies.poses[id as usize].center.to_local()
}

#[test]
fn a_groove_holds_what_lies_in_it() {
    for (name, rider) in riders() {
        for angle in [0.1, 0.4, 0.8] {
            let place = in_a_groove(&rider, angle);
            assert!(place.y > 0.15 && place.x.abs() < 0.4, "{name} in a groove of {angle} rad: {place:?}");
        }
    }
}
