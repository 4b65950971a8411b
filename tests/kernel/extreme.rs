//! Random extreme worlds: no body is lost, and none becomes faster than what was there at the start allows.

use super::dim::{any_rotation, any_spin, hull_of};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{DIM, Rot, Vector};
use kernel::shape::{Ball, Capsule, Cuboid, HalfSpace, Segment, Shape, Triangle};
use kernel::table::BodyKind;

/// A random number generator.
pub struct Dice(u64);

impl Dice {
    /// A generator whose sequence is not near that of another seed.
    pub fn new(seed: u64) -> Self {
        let mut dice = Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        for _ in 0..8 {
            dice.unit();
        }
        dice
    }

    /// A number from 0 to 1.
    pub fn unit(&mut self) -> f32 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 40) as f32 / (1u32 << 24) as f32
    }

    /// A number from -1 to 1.
    pub fn signed(&mut self) -> f32 {
        2.0 * self.unit() - 1.0
    }

    /// A number between two others, with a uniformly distributed logarithm.
    fn between(&mut self, low: f32, high: f32) -> f32 {
        low * (high / low).powf(self.unit())
    }

    /// A vector with components up to a limit.
    fn vector(&mut self, length: f32) -> Vector {
        Vector::from_array(core::array::from_fn(|_| length * self.signed()))
    }

    /// Half extents of 0.01 to 100 m, with one or more sides thinner by up to 10,000.
    fn extents(&mut self) -> Vector {
        let size = self.between(0.005, 50.0);
        let thin = self.between(1.0e-4, 1.0);
        let mut half = [size; DIM];
        half[0] = size * thin;
        if self.unit() < 0.3 {
            half[DIM - 1] = size * self.between(thin, 1.0);
        }
        Vector::from_array(half)
    }

    /// A shape with a volume.
    fn solid(&mut self) -> Shape {
        let half = self.extents();
        match (4.0 * self.unit()) as u32 {
            0 => Shape::Ball(Ball { radius: half.max_element() }),
            1 => {
                let axis = self.vector(1.0);
                let axis = axis * (half.max_element() / axis.length());
                Shape::Capsule(Capsule { a: axis * -1.0, b: axis, radius: half.min_element() })
            }
            2 => Shape::Cuboid(Cuboid { half }),
            _ => hull_of(half),
        }
    }

    /// A shape for an immovable body.
    fn surface(&mut self) -> Shape {
        let mut point = || self.vector(100.0);
        match [point(), point(), point()] {
            [a, b, _] if a.x > 50.0 => Shape::Segment(Segment { a, b }),
            [a, b, c] if a.x > 0.0 => Shape::Triangle(Triangle { a, b, c }),
            _ if self.unit() < 0.5 => Shape::HalfSpace(HalfSpace { normal: Vector::Y }),
            _ => self.solid(),
        }
    }
}

/// The extent of a shape from its frame.
fn reach(shape: &Shape) -> f32 {
    let aabb = shape.local_aabb(Rot::IDENTITY);
    aabb.min.abs().max(aabb.max.abs()).length()
}

/// What bodies may get out of the start of a world.
struct Start {
    /// The speed of the fastest centre of mass, m/s.
    speed: f32,
    /// The speed of the fastest point of a kinematic body, m/s.
    surface: f32,
    /// The kinetic energy of all that has a mass, J.
    energy: f64,
}

/// A world of up to 20 bodies.
fn world(seed: u64) -> (Sim, Start) {
    let mut dice = Dice::new(seed);
    let mut sim = Sim::new();
    (sim.dt, sim.substeps) = if seed.is_multiple_of(2) { (1.0 / 60.0, 4) } else { (1.0 / 64.0, 6) };
    let spread = dice.between(0.1, 50.0);
    let mut start = Start { speed: 0.0, surface: 0.0, energy: 0.0 };
    for i in 0..2 + (18.0 * dice.unit()) as u32 {
        let position = dice.vector(spread);
        let rotation = any_rotation(&mut dice);
        let (friction, restitution) = (dice.unit(), if dice.unit() < 0.3 { dice.unit() } else { 0.0 });
        if i < 2 && dice.unit() < 0.7 {
            let shape = dice.surface();
            sim.add_with(BodyKind::Static, shape, position, rotation, friction, restitution);
            continue;
        }
        let shape = dice.solid();
        let kind = if dice.unit() < 0.1 { BodyKind::Kinematic } else { BodyKind::Dynamic };
        let (speed, spin) = (dice.between(0.5, 500.0), dice.between(1.0, 1000.0));
        let (v, w) = (dice.vector(1.0), any_spin(&mut dice));
        let radius = reach(&shape);
        let id = sim.add_with(kind, shape, position, rotation, friction, restitution);
        let velocity = &mut sim.bodies.velocities[id as usize];
        (velocity.linear, velocity.angular) = (v * (speed / v.length()), w * (spin / w.length()));
        start.speed = start.speed.max(speed);
        if kind == BodyKind::Kinematic {
            start.surface = start.surface.max(speed + spin * radius);
        } else {
            start.energy += sim.kinetic_energy(id);
        }
    }
    (sim, start)
}

/// Whether bodies stay below three times the fastest centre at the start, what they fall, the speed at which
/// a kinematic body throws, and the speed that all energy at the start gives to one of them. A lost body
/// makes a step panic.
fn is_calm(seed: u64) -> bool {
    let (mut sim, start) = world(seed);
    (1..=180).all(|step| {
        sim.step();
        let fallen = sim.gravity.length() * sim.dt * step as f32;
        let allowed = f64::from(3.0 * (start.speed + fallen) + 2.0 * start.surface);
        sim.bodies.awake_dynamic().all(|id| {
            let speed = f64::from(sim.bodies.velocities[id as usize].linear.length());
            speed <= allowed + (2.0 * start.energy / sim.mass(id)).sqrt()
        })
    })
}

#[test]
fn in_random_extreme_worlds_no_body_is_lost_or_thrown() {
    let thrown: Vec<u64> = (1..=400).filter(|seed| !is_calm(*seed)).collect();
    assert!(thrown.is_empty(), "bodies are thrown in the worlds {thrown:?}");
}
