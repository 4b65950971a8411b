//! Crowds of boxes that are driven over floors of pieces with friction, against closed forms.

use super::dim::floors::{apart, laid, yawed};
use super::dim::{more_riders, sized, spin};
use super::extreme::Dice;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Scalar, Vector};
use kernel::shape::{Capsule, Cuboid, Shape};
use kernel::table::{BodyKind, Velocity};

const GRAVITY: f32 = 10.0;
const FRICTION: f32 = 0.5;
const COUNT: usize = 100;

/// How the boxes stand on the floor.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Start {
    /// Square to the tiles.
    Square,
    /// Turned about the vertical by any angle.
    Yawed,
    /// Dropped a little tilted.
    Dropped,
}

/// How the boxes are brought to their speed.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Drive {
    /// From rest by a constant force F: v = (F / m − μ g) t.
    Force,
    /// Braked by friction alone: v = v₀ − μ g t.
    Brake,
}

/// The mean and the least speed along x after two seconds of a drive to 6 m/s.
fn driven(floor: &[(Shape, Vector)], start: Start, drive: Drive, (rate, substeps): (f32, u32)) -> [f32; 2] {
    let mut sim = Sim::new();
    (sim.checked, sim.dt, sim.substeps) = (false, 1.0 / rate, substeps);
    for (shape, place) in floor {
        sim.add_with(BodyKind::Static, shape.clone(), *place, Rot::IDENTITY, FRICTION, 0.0);
    }
    let mut dice = Dice::new(17);
    let cube = Shape::Cuboid(Cuboid { half: Vector::ONE * 0.5 });
    let places = apart(COUNT);
    let ids: Vec<u32> = places
        .into_iter()
        .map(|place| {
            let jitter = sized(dice.signed(), 0.0, dice.signed()) * 0.2;
            let (height, rotation) = match start {
                Start::Square => (0.5, Rot::IDENTITY),
                Start::Yawed => (0.5, yawed(&mut dice)),
                Start::Dropped => (0.65, yawed(&mut dice).integrated(spin(0.1 * dice.signed()))),
            };
            let at = place + jitter + Vector::Y * height;
            sim.add_with(BodyKind::Dynamic, cube.clone(), at, rotation, FRICTION, 0.0)
        })
        .collect();
    sim.steps(rate as usize);
    let steps = 2 * rate as usize;
    match drive {
        Drive::Force => sim.gravity += Vector::X * (3.0 + FRICTION * GRAVITY),
        Drive::Brake => {
            let linear = Vector::X * (6.0 + 2.0 * FRICTION * GRAVITY);
            ids.iter()
                .for_each(|id| sim.bodies.set_velocity(*id, Velocity { linear, ..Velocity::default() }));
        }
    }
    sim.steps(steps);
    let speeds: Vec<f32> = ids.iter().map(|id| sim.bodies.velocities[*id as usize].linear.x).collect();
    [speeds.iter().sum::<f32>() / COUNT as f32, speeds.iter().copied().fold(f32::INFINITY, f32::min)]
}

/// The greatest errors of the mean speed, as shares of 6 m/s, by floor, for one kind of drive.
fn errors(drive: Drive) -> Vec<(&'static str, f32)> {
    let mut errors = Vec::new();
    for (name, floor) in laid() {
        let mut most = 0.0f32;
        for start in [Start::Square, Start::Yawed, Start::Dropped] {
            for clock in [(60.0, 4), (64.0, 6)] {
                let [mean, least] = driven(&floor, start, drive, clock);
                most = most.max((mean / 6.0 - 1.0).abs());
                assert!(least > 5.5, "{name} {start:?} {drive:?} {clock:?}: one has only {least} m/s");
            }
        }
        errors.push((name, most));
    }
    errors
}

#[test]
fn boxes_driven_over_tiles_reach_the_speed_of_the_closed_form() {
    let errors = errors(Drive::Force);
    assert!(errors.iter().all(|(_, error)| *error < 0.005), "{errors:?}");
}

/// They start at 16 m/s, and lose some friction at each seam: the load that comes to a new tile
/// takes a substep.
#[test]
fn boxes_braked_by_tiles_end_at_the_speed_of_the_closed_form() {
    let errors = errors(Drive::Brake);
    assert!(errors.iter().all(|(_, error)| *error < 0.01), "{errors:?}");
}

/// A plank caught on the side of a tile whose upper corner was level with it. Of round bodies that lay on a
/// tile's plane and others that were tilted by rounding against it, one tile alone held.
#[test]
fn small_tiles_brake_by_friction_alone() {
    let mut shapes = vec![
        ("box", Shape::Cuboid(Cuboid { half: Vector::ONE * 0.25 })),
        ("plank", Shape::Cuboid(Cuboid { half: sized(0.5, 0.04, 0.2) })),
        ("capsule", Shape::Capsule(Capsule { a: Vector::X * -0.25, b: Vector::X * 0.25, radius: 0.2 })),
    ];
    shapes.extend(
        more_riders()
            .into_iter()
            .map(|(name, shape, _)| (name, shape))
            .filter(|(name, _)| *name == "round box"),
    );
    let mut bad = Vec::new();
    for size in [0.05f32, 0.1, 0.2] {
        for (name, shape) in &shapes {
            for (speed, friction) in [(5.0f32, 0.25f32), (8.0, 0.4)] {
                let mut sim = Sim::new();
                sim.checked = false;
                let tile = Shape::Cuboid(Cuboid { half: sized(0.5 * size, 0.5, 1.0) });
                for k in 0..(12.0 / size) as usize {
                    let at = sized(-2.0 + 0.5 * size + size * k as f32, -0.5, 0.0);
                    sim.add_with(BodyKind::Static, tile.clone(), at, Rot::IDENTITY, friction, 0.0);
                }
                let at = Vector::Y * -shape.local_aabb(Rot::IDENTITY).min.y;
                let id = sim.add_with(BodyKind::Dynamic, shape.clone(), at, Rot::IDENTITY, friction, 0.0);
                sim.steps(30);
                let start = sim.position(id).x;
                sim.bodies.set_velocity(id, Velocity { linear: Vector::X * speed, ..Velocity::default() });
                sim.steps(180);
                let way = Scalar::from(speed * speed / (2.0 * friction * GRAVITY));
                let share = (sim.position(id).x - start) / way;
                if (share - 1.0).abs() > 0.04 {
                    bad.push(format!("{name} on {size} m at {speed} m/s: {share} of the way"));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}
