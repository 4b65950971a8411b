//! Landings with the default restitution of 0 and with others: friction of a blow, flat falls, and rebounds.

use super::dim::{any_rotation, any_spin, cylinder, sized, tiles};
use super::extreme::Dice;
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector};
use kernel::shape::{Ball, Capsule, Cuboid, Shape};
use kernel::table::{BodyKind, Velocity};

/// Step rates in Hz and numbers of substeps.
pub const CLOCKS: [(f32, u32); 4] = [(30.0, 4), (60.0, 4), (64.0, 6), (144.0, 4)];
/// Number of phases of the step at which a blow falls.
pub const PHASES: u32 = 24;
/// The gravity of the simulation, m/s².
pub const G: f32 = 10.0;
const MU: f32 = 0.5;

/// Floors of [`tiles`] on which bodies land.
const FLOORS: [&str; 6] = ["one box", "half-space", "boxes", "small boxes", "mesh", "polyline"];

/// Places on floors for bodies up to 0.8 m wide: on one piece, across a seam at x = 1, on the corner of four
/// tiles at z = -0.13.
const PLACES: [(&str, f32, f32); 7] = [
    ("one box", 0.3, 0.2),
    ("boxes", 1.0, 0.37),
    ("boxes", 1.1, 0.37),
    ("boxes", 1.0, -0.13),
    ("boxes", 1.1, -0.05),
    ("mesh", 1.1, -0.05),
    ("polyline", 1.1, 0.0),
];

/// A simulation without gravity or ground.
pub fn clocked((rate, substeps): (f32, u32)) -> Sim {
    let mut sim = Sim::new();
    (sim.checked, sim.dt, sim.substeps) = (false, 1.0 / rate, substeps);
    sim
}

/// A simulation on a floor of [`tiles`], unless this dimension has none of that name.
pub fn on_floor(name: &str, clock: (f32, u32), friction: f32, e: f32) -> Option<Sim> {
    let (_, pieces) = tiles().into_iter().find(|floor| floor.0 == name)?;
    let mut sim = clocked(clock);
    for (shape, place) in pieces {
        sim.add_with(BodyKind::Static, shape, place, Rot::IDENTITY, friction, e);
    }
    Some(sim)
}

pub fn cuboid(half: Vector) -> Shape {
    Shape::Cuboid(Cuboid { half })
}

/// The height of a shape's frame over its lowest point.
pub fn foot(shape: &Shape) -> f32 {
    -shape.local_aabb(Rot::IDENTITY).min.y
}

/// The speed at a height of a body that rises to, or falls from, an apex.
///
/// Semi-implicit Euler with substeps of h conserves y + v² / 2g - v h / 2, with v upwards.
fn speed_at(sim: &Sim, height: f32, apex: f32, sign: f32) -> f32 {
    let shift = 0.5 * G * sim.dt / sim.substeps as f32;
    shift + sign * (shift * shift + 2.0 * G * (apex - height)).sqrt()
}

/// The apex of a body at a height with a speed, by the same law.
fn apex(sim: &Sim, height: f32, speed: f32) -> f32 {
    height + speed * speed / (2.0 * G) - 0.5 * speed * sim.dt / sim.substeps as f32
}

/// Phases of the step, from 0 to 1.
pub fn phases() -> impl Iterator<Item = f32> {
    (0..PHASES).map(|k| k as f32 / PHASES as f32)
}

/// Adds a body that has fallen from a height, and lands in the second or third step.
pub fn falling(sim: &mut Sim, shape: &Shape, at: Vector, height: f32, phase: f32, surface: [f32; 2]) -> u32 {
    let gap = (1.0 + phase) * (2.0 * G * height).sqrt() * sim.dt;
    let place = at + Vector::Y * (foot(shape) + gap);
    let [friction, e] = surface;
    let id = sim.add_with(BodyKind::Dynamic, shape.clone(), place, Rot::IDENTITY, friction, e);
    let linear = Vector::Y * speed_at(sim, gap, height, -1.0);
    sim.bodies.set_velocity(id, Velocity { linear, ..Velocity::default() });
    id
}

/// The way that a crate slides which was thrown forwards and upwards at 5 m/s and lands at 5 m/s.
fn slide(sim: &mut Sim, phase: f32) -> f32 {
    let gap = 5.0 * sim.dt * phase;
    let place = Vector::Y * (0.5 + gap);
    let shape = cuboid(Vector::ONE * 0.5);
    let id = sim.add_with(BodyKind::Dynamic, shape, place, Rot::IDENTITY, MU, 0.0);
    let linear = Vector::X * 5.0 + Vector::Y * speed_at(sim, gap, 1.25, 1.0);
    sim.bodies.set_velocity(id, Velocity { linear, ..Velocity::default() });
    let mut touch = 0.0;
    for _ in 0..(2.3 / sim.dt) as usize {
        let at = sim.position(id).to_local();
        let v = sim.bodies.velocities[id as usize].linear;
        if v.y < -1.0 && at.y > 0.51 {
            // It falls on at 5 m/s less half of what it still gains.
            touch = at.x + 5.0 * (at.y - 0.5) / (0.5 * (5.0 - v.y));
        }
        sim.step();
    }
    sim.position(id).to_local().x - touch
}

/// The landing takes μ v of the speed: it goes on with 5 - 0.5 · 5 m/s, and slides (2.5 m/s)² / 2 μ g = 0.625
/// m.
#[test]
fn a_thrown_crate_slides_by_the_closed_form_after_landing() {
    let mut bad = Vec::new();
    for name in FLOORS {
        for clock in CLOCKS {
            let Some(floor) = on_floor(name, clock, MU, 0.0) else { continue };
            // One of the phases meets an edge between two tiles.
            if name == "small boxes" && clock.0 < 60.0 {
                continue;
            }
            let ways: Vec<f32> = phases().map(|phase| slide(&mut floor.clone(), phase)).collect();
            let mean = ways.iter().sum::<f32>() / ways.len() as f32;
            let [least, most] = range(&ways);
            if (mean / 0.625 - 1.0).abs() > 0.1 || least < 0.56 || most > 0.69 {
                bad.push(format!("{name}, {clock:?}: {least} to {most} m, mean {mean}"));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// The share of the speed of a landing, times μ (1 + e), that friction takes from a body that slips
/// throughout.
///
/// By the momenta, the normal impulses of all steps are J = m (Δv + g t), of which the landing is m (1 + e)
/// v. Friction takes μ J in all. The share of the landing is the rest if that of resting contact is complete.
fn landing_friction(sim: &mut Sim, shape: &Shape, e: f32, phase: f32) -> f32 {
    // A ball slips at 20 m/s for long enough; a box, whose spin does not count, at 6 m/s.
    let along = if matches!(shape, Shape::Ball(_)) { 20.0 } else { 6.0 };
    let (speed, steps) = (5.0, 4);
    let height = speed * speed / (2.0 * G);
    let id = falling(sim, shape, Vector::ZERO, height, phase, [MU, e]);
    let start = sim.bodies.velocities[id as usize].linear + Vector::X * along;
    sim.bodies.set_velocity(id, Velocity { linear: start, ..Velocity::default() });
    sim.steps(steps);
    let change = sim.bodies.velocities[id as usize].linear - start;
    let landing = (1.0 + e) * speed;
    let after = (change.y + G * sim.dt * steps as f32 - landing).max(0.0);
    (-change.x / MU - after) / landing
}

/// Friction changes the slip of a ball by μ (1 + e) v (1 + m r² / I), at most 13 m/s of 20: it slips all the
/// time.
#[test]
fn friction_of_a_landing_is_that_of_its_normal_impulse() {
    let shapes = [("ball", Shape::Ball(Ball { radius: 0.25 })), ("box", cuboid(Vector::ONE * 0.25))];
    let mut bad = Vec::new();
    for floor in FLOORS {
        for clock in CLOCKS {
            for e in [0.0, 0.02, 0.5] {
                let Some(ground) = on_floor(floor, clock, MU, e) else { continue };
                for (name, shape) in &shapes {
                    // Boxes that land on tiles of 31 cm meet edges between them.
                    if floor == "small boxes" && *name == "box" {
                        continue;
                    }
                    let share = |phase| landing_friction(&mut ground.clone(), shape, e, phase);
                    let shares: Vec<f32> = phases().map(share).collect();
                    let [least, most] = range(&shares);
                    if least < 0.95 || most > 1.05 {
                        let mean = shares.iter().sum::<f32>() / shares.len() as f32;
                        bad.push(format!(
                            "{name}, {floor}, {clock:?}, e = {e}: {least} to {most}, mean {mean}"
                        ));
                    }
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// The least and the greatest of some values.
fn range(values: &[f32]) -> [f32; 2] {
    [
        values.iter().copied().fold(f32::INFINITY, f32::min),
        values.iter().copied().fold(-f32::INFINITY, f32::max),
    ]
}

/// What became of a body that fell flat.
#[derive(Clone, Copy, Default)]
struct Fall {
    /// Maximum angular speed, rad/s.
    spin: f32,
    /// Maximum height of the frame over its place at rest after landing, in metres.
    rise: f32,
    /// Minimum cosine of the tilt.
    upright: f32,
}

impl Fall {
    fn of(sim: &mut Sim, shape: &Shape, at: Vector, height: f32, phase: f32, seconds: f32) -> Self {
        let id = falling(sim, shape, at, height, phase, [MU, 0.0]);
        let mut fall = Self { upright: 1.0, ..Self::default() };
        for step in 0..(seconds / sim.dt) as usize {
            sim.step();
            fall.spin = fall.spin.max(sim.bodies.velocities[id as usize].angular.length());
            fall.upright = fall.upright.min(sim.bodies.poses[id as usize].rotation.rotate(Vector::Y).y);
            if step >= 2 {
                fall.rise = fall.rise.max(sim.position(id).to_local().y - foot(shape));
            }
        }
        fall
    }

    fn or_worse(self, other: Self) -> Self {
        Self {
            spin: self.spin.max(other.spin),
            rise: self.rise.max(other.rise),
            upright: self.upright.min(other.upright),
        }
    }
}

/// Drops a shape at all places and rates; asserts that it stays flat.
fn assert_falls_flat(name: &str, shape: &Shape, heights: &[f32], count: u32, seconds: f32) {
    let mut bad = Vec::new();
    for (floor, x, z) in PLACES {
        for clock in CLOCKS {
            let Some(ground) = on_floor(floor, clock, MU, 0.0) else { continue };
            for height in heights {
                let falls: Vec<Fall> = (0..count)
                    .map(|k| k as f32 / count as f32)
                    .map(|phase| {
                        Fall::of(&mut ground.clone(), shape, sized(x, 0.0, z), *height, phase, seconds)
                    })
                    .collect();
                let down = falls.iter().filter(|fall| fall.upright < 0.99).count();
                let Fall { spin, rise, .. } = falls.into_iter().reduce(Fall::or_worse).unwrap_or_default();
                if down > 0 || spin > 0.3 || rise > 0.01 {
                    let place = format!("{floor} at {x}, {z}, {clock:?}");
                    bad.push(format!(
                        "{name} from {height} m on {place}: {down} fall, {spin} rad/s, rises {rise} m"
                    ));
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

#[test]
fn pillars_that_fall_flat_stay_upright() {
    assert_falls_flat("pillar", &cuboid(sized(0.2, 0.8, 0.2)), &[1.0], 60, 1.0);
}

#[test]
fn crates_that_fall_flat_stay_flat() {
    assert_falls_flat("crate", &cuboid(Vector::ONE * 0.4), &[0.3, 1.0, 3.0], PHASES, 0.4);
}

#[test]
fn barrels_and_coins_that_fall_flat_stay_flat() {
    assert_falls_flat("barrel", &cylinder(0.3, 0.45), &[0.3, 3.0], PHASES, 0.4);
    assert_falls_flat("coin", &cylinder(0.3, 0.03), &[0.3, 1.0, 3.0], PHASES, 0.4);
}

/// The heights of the first two rebounds of a box.
fn rebounds(sim: &mut Sim, at: Vector, height: f32, e: f32, phase: f32, count: usize) -> Vec<f32> {
    let shape = cuboid(Vector::ONE * 0.4);
    let id = falling(sim, &shape, at, height, phase, [MU, e]);
    let (mut heights, mut was_falling) = (Vec::new(), true);
    for _ in 0..(4.0 * height.sqrt() / sim.dt) as usize {
        sim.step();
        let v = sim.bodies.velocities[id as usize].linear.y;
        if v > 0.0 && was_falling {
            heights.push(apex(sim, sim.position(id).to_local().y - foot(&shape), v));
            if heights.len() == count {
                break;
            }
        }
        was_falling = v < 0.0;
    }
    heights.resize(count, 0.0);
    heights
}

#[test]
fn boxes_rebound_from_tiles_and_meshes_to_e_squared_of_the_height() {
    let mut bad = Vec::new();
    for (floor, x, z) in PLACES {
        for clock in CLOCKS {
            for e in [0.1, 0.5, 0.9, 0.95f32] {
                let Some(ground) = on_floor(floor, clock, MU, e) else { continue };
                for height in [1.0, 10.0] {
                    let shares: Vec<f32> = phases()
                        .map(|phase| {
                            let at = sized(x, 0.0, z);
                            rebounds(&mut ground.clone(), at, height, e, phase, 1)[0] / (e * e * height)
                        })
                        .collect();
                    let [least, most] = range(&shares);
                    if least < 0.99 || most > 1.01 {
                        bad.push(format!(
                            "{floor} at {x}, {z}, {clock:?}, e = {e}, from {height} m: {least} to {most}"
                        ));
                    }
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// A box that turned a little in its first bounce would lose height in the second.
#[test]
fn the_second_rebound_is_e_to_the_fourth_of_the_height() {
    let (e, height) = (0.9f32, 2.0);
    let mut bad = Vec::new();
    for (floor, x, z) in PLACES {
        for clock in CLOCKS {
            let Some(ground) = on_floor(floor, clock, MU, e) else { continue };
            let second =
                |phase| rebounds(&mut ground.clone(), sized(x, 0.0, z), height, e, phase, 2)[1] / height;
            let [least, most] = range(&phases().map(second).collect::<Vec<_>>());
            let want = e.powi(4);
            if least < 0.97 * want || most > 1.03 * want {
                bad.push(format!(
                    "{floor} at {x}, {z}, {clock:?}: {least} to {most} of the height, not {want}"
                ));
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}

/// What is thin turns with little energy: rounding of arms and of inverse inertias counts most.
#[test]
fn thin_rods_gain_no_energy_in_a_blow() {
    let mut bad = Vec::new();
    for floor in ["one box", "boxes", "mesh", "polyline"] {
        for clock in [CLOCKS[1], CLOCKS[2]] {
            for radius in [0.004, 0.02f32] {
                let Some(ground) = on_floor(floor, clock, MU, 0.0) else { continue };
                let mut dice = Dice::new(7);
                for k in 0..30 {
                    let mut sim = ground.clone();
                    let [a, b] = [-0.4, 0.4].map(|x| Vector::X * x);
                    let capsule = Shape::Capsule(Capsule { a, b, radius });
                    let shape = if k % 2 == 0 { capsule } else { cuboid(sized(0.4, radius, radius)) };
                    let (turn, spin) = (any_rotation(&mut dice), any_spin(&mut dice) * 5.0);
                    let way = sized(dice.signed(), -0.2 - dice.unit(), 0.3 * dice.signed());
                    let at = sized(0.3, 1.5, 0.2) - way * (1.0 / way.length());
                    let id = sim.add_with(BodyKind::Dynamic, shape, at, turn, MU, 0.0);
                    let linear = way * (60.0 / way.length());
                    sim.bodies.set_velocity(id, Velocity { linear, angular: spin });
                    let start = sim.energy();
                    let most = (0..30).fold(0.0f64, |most, _| {
                        sim.step();
                        most.max(sim.energy() / start)
                    });
                    if !(most < 1.001) {
                        bad.push(format!("{floor}, {clock:?}, radius {radius}, {k}: {most} of the energy"));
                    }
                }
            }
        }
    }
    assert!(bad.is_empty(), "{bad:#?}");
}
