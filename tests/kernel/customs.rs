//! Constraints of the embedder: soft ropes.

use super::dim::turned;
use super::joints::{apart, post};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{DIM, Rot, Vector};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::solver::{CustomBody, CustomConstraint, CustomError, SubstepParams};
use kernel::table::{BodyKind, Velocity};
use std::any::Any;

/// A spring that pulls where it is longer than its length: an oscillator of a stiffness in N/m and a damping
/// in N·s/m, implicit in each substep.
#[derive(Clone)]
struct Rope {
    length: f32,
    stiffness: f32,
    damping: f32,
    /// The anchors in the frames of the bodies.
    anchors: [Vector; 2],
    impulse: f32,
    arms: [Vector; 2],
    /// From the first anchor to the second at the start of the step.
    offset: Vector,
    /// Where set, velocities become NaN.
    broken: bool,
}

impl Rope {
    fn new(length: f32) -> Self {
        Self {
            length,
            stiffness: 400.0,
            damping: 0.0,
            anchors: [Vector::ZERO; 2],
            impulse: 0.0,
            arms: [Vector::ZERO; 2],
            offset: Vector::ZERO,
            broken: false,
        }
    }

    /// The arms now, and the vector between the anchors.
    fn now(&self, a: &CustomBody, b: &CustomBody) -> ([Vector; 2], Vector) {
        let arms = [a.turn.rotate(self.arms[0]), b.turn.rotate(self.arms[1])];
        let moved = (b.shift + arms[1] - self.arms[1]) - (a.shift + arms[0] - self.arms[0]);
        (arms, self.offset + moved)
    }

    fn push(&self, [a, b]: [&mut CustomBody; 2], arms: [Vector; 2], impulse: Vector) {
        a.push(-impulse, arms[0]);
        b.push(impulse, arms[1]);
    }
}

impl CustomConstraint for Rope {
    fn prepare(&mut self, bodies: [&CustomBody; 2], _: &SubstepParams) {
        let [a, b] = bodies;
        let arm = |body: &CustomBody, anchor: Vector| body.rotation.rotate(anchor - body.local_center);
        self.arms = [arm(a, self.anchors[0]), arm(b, self.anchors[1])];
        self.offset = (b.center - a.center).to_local() + self.arms[1] - self.arms[0];
    }

    fn warm_start(&mut self, [a, b]: [&mut CustomBody; 2], _: &SubstepParams) {
        let (arms, d) = self.now(a, b);
        let n = d * (1.0 / d.length().max(1e-6));
        self.push([a, b], arms, n * self.impulse);
    }

    fn solve(&mut self, [a, b]: [&mut CustomBody; 2], params: &SubstepParams, use_bias: bool) {
        if !use_bias {
            return;
        }
        if self.broken {
            a.linear = a.linear * f32::NAN;
            b.linear = b.linear * f32::NAN;
            return;
        }
        let (arms, d) = self.now(a, b);
        let length = d.length().max(1e-6);
        let n = d * (1.0 / length);
        let h = params.h;
        let give = h * (self.damping + h * self.stiffness);
        let (gamma, bias) = (1.0 / give, (length - self.length) * h * self.stiffness / give);
        let speed = n.dot(b.velocity_at(arms[1]) - a.velocity_at(arms[0]));
        let k = a.inv_mass_along(n, arms[0]) + b.inv_mass_along(n, arms[1]);
        let old = self.impulse;
        self.impulse = (old - (speed + bias + gamma * old) / (k + gamma)).min(0.0);
        self.push([a, b], arms, n * (self.impulse - old));
    }

    fn store(&mut self) {}

    fn boxed(&self) -> Box<dyn CustomConstraint> {
        Box::new(self.clone())
    }

    fn as_any_mut(&mut self) -> &mut dyn Any {
        self
    }

    fn as_any(&self) -> &dyn Any {
        self
    }
}

fn ball(sim: &mut Sim, at: Vector) -> u32 {
    apart(sim, BodyKind::Dynamic, Shape::Ball(Ball { radius: 0.2 }), at, Rot::IDENTITY)
}

fn block(sim: &mut Sim, at: Vector) -> u32 {
    let shape = Shape::Cuboid(Cuboid { half: Vector::ONE * 0.2 });
    apart(sim, BodyKind::Dynamic, shape, at, turned(0.3))
}

fn tie(sim: &mut Sim, bodies: [u32; 2], rope: Rope) -> u32 {
    sim.tie(bodies, Some(Box::new(rope))).expect("two bodies")
}

fn rope(sim: &Sim, id: u32) -> &Rope {
    let act = sim.customs().act(id).expect("it acts");
    act.as_any().downcast_ref().expect("all are ropes")
}

#[test]
fn a_rope_stretches_by_its_load() {
    let mut sim = Sim::new();
    let top = post(&mut sim, Vector::ZERO);
    let load = ball(&mut sim, Vector::Y * -1.0);
    let damping = 20.0;
    let id = tie(&mut sim, [top, load], Rope { damping, ..Rope::new(1.0) });
    sim.steps(600);
    let weight = 10.0 / sim.masses[load as usize].0;
    let stretch = -sim.position(load).to_local().dot(Vector::Y) - 1.0;
    assert!((stretch / (weight / 400.0) - 1.0).abs() < 1e-3, "{stretch}");
    let force = -rope(&sim, id).impulse * 240.0;
    assert!((force / weight - 1.0).abs() < 1e-3, "{force} of {weight} N");
}

#[test]
fn a_loose_rope_pulls_nothing() {
    let mut sim = Sim::new();
    let top = post(&mut sim, Vector::ZERO);
    let load = ball(&mut sim, Vector::Y * -1.0);
    let id = tie(&mut sim, [top, load], Rope::new(100.0));
    sim.steps(30);
    assert_eq!(rope(&sim, id).impulse, 0.0);
    let fall = sim.bodies.velocities[load as usize].linear.dot(Vector::Y);
    assert!((fall + 5.0).abs() < 1e-3, "{fall}");
}

#[test]
fn ropes_keep_momentum() {
    let mut sim = Sim::new();
    sim.gravity = Vector::ZERO;
    let bodies: Vec<u32> = (0..6).map(|i| block(&mut sim, Vector::X * i as f32)).collect();
    for pair in bodies.windows(2) {
        let anchors = [Vector::Y * 0.2, Vector::Y * -0.2];
        tie(&mut sim, [pair[0], pair[1]], Rope { anchors, ..Rope::new(0.8) });
    }
    let momentum = |sim: &Sim| {
        let of = |id: &u32| sim.bodies.velocities[*id as usize].linear * (1.0 / sim.masses[*id as usize].0);
        bodies.iter().map(of).fold(Vector::ZERO, |sum, p| sum + p)
    };
    let pushed = Velocity { linear: Vector::Y * 3.0, ..Default::default() };
    sim.bodies.set_velocity(bodies[0], pushed);
    let before = momentum(&sim);
    sim.steps(240);
    let lost = (momentum(&sim) - before).length() / before.length();
    assert!(lost < 1e-5, "{lost} of the momentum");
    assert!(
        sim.bodies.velocities[bodies[5] as usize].linear.length() > 0.01,
        "the last one was pulled along"
    );
}

/// A net of ropes between posts with boxes in it, and its velocities after a second.
fn net(setup: impl Fn(&mut Sim)) -> Vec<String> {
    let mut sim = Sim::new();
    setup(&mut sim);
    let size = 9;
    let mut knots = Vec::new();
    for i in 0..size * size {
        let at = Vector::X * ((i % size) as f32) + Vector::Y * (5.0 + (i / size) as f32);
        knots.push(if i == 0 || i == size - 1 { post(&mut sim, at) } else { ball(&mut sim, at) });
        if i % size > 0 {
            tie(&mut sim, [knots[i - 1], knots[i]], Rope::new(1.0));
        }
        if i >= size {
            tie(&mut sim, [knots[i - size], knots[i]], Rope::new(1.0));
        }
    }
    sim.floor();
    for i in 0..20 {
        sim.cuboid(Vector::ONE * 0.4, Vector::X * (i % 5) as f32 * 1.1 + Vector::Y * (0.5 + (i / 5) as f32));
    }
    sim.steps(60);
    sim.bodies.velocities.iter().map(|velocity| format!("{velocity:?}")).collect()
}

#[test]
fn workers_and_lanes_change_no_bit() {
    let expected = net(|_| {});
    assert!(expected.iter().all(|velocity| !velocity.contains("NaN")));
    for workers in 1..=3 {
        assert_eq!(net(|sim| sim.set_workers(workers)), expected, "{workers} workers");
        let narrow = |sim: &mut Sim| {
            sim.set_workers(workers);
            sim.set_narrow();
        };
        assert_eq!(net(narrow), expected, "{workers} workers, four lanes");
    }
}

#[test]
fn what_a_rope_holds_sleeps_and_wakes_with_it() {
    let mut sim = Sim::new();
    sim.sleeping = true;
    sim.gravity = Vector::ZERO;
    let [a, b, c] = [0.0, 1.0, 2.0].map(|x| ball(&mut sim, Vector::X * x));
    let id = tie(&mut sim, [a, b], Rope::new(1.0));
    // One that does nothing connects as well.
    sim.tie([b, c], None).expect("two bodies");
    sim.steps(120);
    assert!([a, b, c].iter().all(|id| !sim.bodies[*id].awake));
    sim.contact_manager().wake_body(c);
    assert!([a, b, c].iter().all(|id| sim.bodies[*id].awake));
    sim.steps(120);
    sim.untie(id).expect("it is there");
    assert!(sim.bodies[a].awake && sim.bodies[b].awake, "what it held is woken");
    assert_eq!(sim.untie(id), Err(CustomError::NoConstraint(id)));
    sim.steps(10);
    let again = tie(&mut sim, [a, b], Rope::new(1.0));
    sim.contact_manager().retype(b, BodyKind::Static);
    sim.steps(10);
    sim.contact_manager().retype(a, BodyKind::Static);
    sim.steps(10);
    sim.contact_manager().retype(b, BodyKind::Kinematic);
    sim.steps(10);
    sim.untie(again).expect("retyping keeps it");
}

#[test]
fn what_cannot_be_tied_is_refused() {
    let mut sim = Sim::new();
    let a = ball(&mut sim, Vector::ZERO);
    let b = ball(&mut sim, Vector::X);
    assert_eq!(sim.tie([a, a], None), Err(CustomError::SameBody));
    tie(&mut sim, [a, b], Rope::new(1.0));
    sim.steps(2);
    // A body takes its ropes with it.
    sim.remove(b);
    sim.steps(2);
    assert_eq!(sim.tie([a, b], None), Err(CustomError::NoBody(b)));
    assert_eq!(sim.tie([a, 7_777], None), Err(CustomError::NoBody(7_777)));
}

#[test]
fn velocities_that_are_not_finite_are_ignored() {
    let mut sim = Sim::new();
    let [a, b] = [0.0, 1.0].map(|x| ball(&mut sim, Vector::X * x));
    let id = tie(&mut sim, [a, b], Rope { broken: true, ..Rope::new(0.5) });
    let good = ball(&mut sim, Vector::X * (2.0 + DIM as f32));
    let other = tie(&mut sim, [b, good], Rope::new(1.0));
    sim.steps(5);
    assert!(sim.customs().is_faulty(id) && !sim.customs().is_faulty(other));
    assert!([a, b, good].iter().all(|id| sim.bodies.velocities[*id as usize].linear.is_finite()));
}
