//! Free spin in space against closed forms and a reference integration in `f64`.

use super::super::sim::Sim;
use crate::kernel;
use kernel::math::{Angular, InvInertia, Pose, Rot, Vector};
use kernel::shape::{Capsule, Cuboid, Hull, Shape};
use kernel::solver::{BodyRow, MassRow, Motion, Solver, SubstepParams};
use kernel::table::BodyKind;
use kernel::thread_pool::ThreadPool;
use proptest::prelude::*;
use std::sync::Arc;

/// Step and substeps: 64 Hz × 6 and 60 Hz × 4.
const CLOCKS: [(f32, u32); 2] = [(1.0 / 64.0, 6), (1.0 / 60.0, 4)];

/// One body without contacts, stepped by the solver. Moments are in the body's frame.
struct Spinner {
    moments: [f64; 3],
    rotation: Rot,
    w: Angular,
    solver: Solver,
    clock: (f32, u32),
}

impl Spinner {
    fn new(moments: [f64; 3], w: Angular, clock: (f32, u32)) -> Self {
        Self { moments, rotation: Rot::IDENTITY, w, solver: Solver::default(), clock }
    }

    /// A box of density 1.
    fn cuboid(size: [f64; 3], w: Angular, clock: (f32, u32)) -> Self {
        let [x, y, z] = size.map(|a| a * a);
        let mass = size[0] * size[1] * size[2] / 12.0;
        Self::new([mass * (y + z), mass * (x + z), mass * (x + y)], w, clock)
    }

    fn inv_inertia(&self) -> InvInertia {
        let [x, y, z] = self.moments.map(|i| (1.0 / i) as f32);
        InvInertia::from_diagonal(Vector { x, y, z })
    }

    fn step(&mut self, angular_acceleration: Angular) {
        let (dt, substeps) = self.clock;
        let params = SubstepParams::new(dt, substeps);
        let local = self.inv_inertia();
        self.solver.begin_step(0, 1);
        let rows = &mut self.solver.bodies;
        rows.set_at_rest(1);
        rows.rows[1] = BodyRow::new(Vector::ZERO, self.w);
        rows.masses[1] = MassRow::new(1.0, local.rotated(self.rotation));
        rows.motions[1] = Motion { angular_acceleration, ..Motion::FREE };
        rows.spin(1, local, self.rotation);
        for _ in 0..substeps {
            self.solver.substep(&params, &ThreadPool::default());
        }
        let row = &self.solver.bodies.rows[1];
        self.w = row.velocity().1;
        self.rotation = row.delta().1.mul(self.rotation).renormalized();
    }

    fn run(&mut self, seconds: f64) {
        for _ in 0..(seconds / f64::from(self.clock.0)).round() as usize {
            self.step(Vector::ZERO);
        }
    }

    /// The angular velocity in the body's frame.
    fn local(&self) -> [f64; 3] {
        self.rotation.inverse_rotate(self.w).to_array().map(f64::from)
    }

    /// The length of the angular momentum, and the energy.
    fn kept(&self) -> (f64, f64) {
        let sum = |f: fn(f64, f64) -> f64| -> f64 {
            self.moments.iter().zip(self.local()).map(|(&i, w)| f(i, w)).sum()
        };
        (sum(|i, w| i * i * w * w).sqrt(), 0.5 * sum(|i, w| i * w * w))
    }

    /// The angular momentum in world axes.
    fn momentum(&self) -> Vector {
        let [x, y, z] = self.local();
        let [a, b, c] = self.moments;
        self.rotation.rotate(Vector { x: (a * x) as f32, y: (b * y) as f32, z: (c * z) as f32 })
    }
}

/// One step of Euler's equations in the body's frame by the classical Runge-Kutta rule.
fn euler_step(moments: [f64; 3], w: [f64; 3], h: f64) -> [f64; 3] {
    let [a, b, c] = moments;
    let rate = |[x, y, z]: [f64; 3]| [(b - c) / a * y * z, (c - a) / b * z * x, (a - b) / c * x * y];
    let ahead = |k: [f64; 3], h: f64| core::array::from_fn(|i| w[i] + h * k[i]);
    let k1 = rate(w);
    let k2 = rate(ahead(k1, 0.5 * h));
    let k3 = rate(ahead(k2, 0.5 * h));
    let k4 = rate(ahead(k3, h));
    core::array::from_fn(|i| w[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

/// The times at which a value changes its sign, by linear interpolation.
fn crossings(samples: &[(f64, f64)]) -> Vec<f64> {
    let crossing = |pair: &[(f64, f64)]| {
        let ((t, a), (u, b)) = (pair[0], pair[1]);
        (a * b < 0.0).then(|| t + (u - t) * a / (a - b))
    };
    samples.windows(2).filter_map(crossing).collect()
}

fn of_length(v: Vector, length: f32) -> Vector {
    v * (length / v.length())
}

#[test]
fn a_tumbling_box_keeps_momentum_and_energy_for_100_seconds() {
    for clock in CLOCKS {
        for size in
            [[1.0, 2.0, 3.0], [10.0, 1.0, 1.0], [10.0, 10.0, 1.0], [10.0, 3.0, 1.0], [0.1, 0.05, 0.01]]
        {
            let w = of_length(Vector { x: 1.0, y: 2.0, z: -1.5 }, 20.0);
            let mut body = Spinner::cuboid(size, w, clock);
            let ((l, e), start) = (body.kept(), body.momentum());
            body.run(100.0);
            let (after_l, after_e) = body.kept();
            assert!((after_l / l - 1.0).abs() < 0.01, "{size:?} at {clock:?}: |L| {}", after_l / l);
            assert!((after_e / e - 1.0).abs() < 0.01, "{size:?} at {clock:?}: E {}", after_e / e);
            let cos = body.momentum().dot(start) / (body.momentum().length() * start.length());
            assert!(cos > 0.995, "{size:?} at {clock:?}: the momentum turned, cosine {cos}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn random_bodies_keep_momentum_and_energy(
        size in prop::array::uniform3(1.0f64..10.0),
        v in prop::array::uniform3(-1.0f32..1.0),
        clock in 0usize..2,
    ) {
        let v = Vector::from_array(v);
        prop_assume!(v.length() > 0.1);
        let mut body = Spinner::cuboid(size, of_length(v, 20.0), CLOCKS[clock]);
        let (l, e) = body.kept();
        body.run(100.0);
        let (after_l, after_e) = body.kept();
        prop_assert!((after_l / l - 1.0).abs() < 0.01, "|L| {}", after_l / l);
        prop_assert!((after_e / e - 1.0).abs() < 0.01, "E {}", after_e / e);
    }
}

#[test]
fn a_symmetric_body_precesses_at_its_rate() {
    for clock in CLOCKS {
        for (side, axis) in [(1.0, 2.0), (2.0, 1.0), (1.0, 10.0)] {
            let w = Vector { x: 2.0, y: 0.0, z: 10.0 };
            let mut body = Spinner::cuboid([side, side, axis], w, clock);
            let [i1, _, i3] = body.moments;
            let rate = (i3 - i1) / i1 * f64::from(w.z);
            // The part of ω across the axis rotates at that rate; its direction is unwrapped.
            let (mut angle, mut last) = (0.0, 0.0f64);
            let steps = (5.0 / clock.0).round();
            for _ in 0..steps as usize {
                body.step(Vector::ZERO);
                let [x, y, _] = body.local();
                let now = y.atan2(x);
                angle += (now - last + 3.0 * core::f64::consts::PI).rem_euclid(core::f64::consts::TAU)
                    - core::f64::consts::PI;
                last = now;
            }
            let got = angle / f64::from(steps * clock.0);
            assert!((got - rate).abs() < 0.005 * rate.abs(), "turns at {got}, not at {rate}");
        }
    }
}

#[test]
fn the_intermediate_axis_flips_on_time() {
    for clock in CLOCKS {
        // The smallest, the intermediate and the largest moment belong to z, y and x.
        let w = Vector { x: 0.4, y: 8.0, z: 0.4 };
        let mut body = Spinner::cuboid([1.0, 2.0, 3.0], w, clock);
        let moments = body.moments;
        let (mut reference, mut ours) = (Vec::new(), Vec::new());
        let mut exact = body.local();
        let fine = 16;
        for step in 0..(60.0 / clock.0) as usize {
            let t = step as f64 * f64::from(clock.0);
            ours.push((t, body.local()[1]));
            reference.push((t, exact[1]));
            body.step(Vector::ZERO);
            for _ in 0..fine {
                exact = euler_step(moments, exact, f64::from(clock.0) / f64::from(fine));
            }
        }
        let (ours, exact) = (crossings(&ours), crossings(&reference));
        assert!(exact.len() > 10, "it flips {} times", exact.len());
        assert_eq!(ours.len(), exact.len());
        let period = exact[1] - exact[0];
        for (i, (got, want)) in ours.iter().zip(&exact).enumerate() {
            assert!((got - want).abs() < 0.02 * period, "flip {i} at {got} s, not at {want} s");
        }
    }
}

#[test]
fn a_heavy_top_precesses_at_its_rate_and_stays_up() {
    // A disc of m = 1 kg, its centre r = 5 cm above the tip, g = 9.81 m/s²; moments about the tip.
    let (i1, i3, torque) = (0.0035, 0.002, 9.81 * 0.05);
    // The torque follows the top from substep to substep, so each substep is a step of its own.
    for clock in CLOCKS.map(|(dt, substeps)| (dt / substeps as f32, 1)) {
        for spin in [100.0f64, 150.0] {
            let tilt = 0.3f32;
            let rotation = Rot::from_axis_angle(Vector::X, tilt);
            // The axis is the body's z, and up is the world's z. Steady precession at Ω:
            // I1 cos θ Ω² − I3 ω3 Ω + m g r = 0, of which Ω = m g r / I3 ω3 is the limit of fast spin.
            let (l3, c) = (i3 * spin, i1 * f64::from(tilt).cos());
            let rate = 2.0 * torque / (l3 + (l3 * l3 - 4.0 * c * torque).sqrt());
            let mut top = Spinner::new([i1, i1, i3], Vector::ZERO, clock);
            top.rotation = rotation;
            let axis = rotation.rotate(Vector::Z);
            // ω = Ω up + σ axis, whose part along the axis is the spin.
            let along = spin - rate * f64::from(tilt).cos();
            // Velocities belong to the middle of the previous substep.
            let before = Rot::from_axis_angle(Vector::Z, -0.5 * rate as f32 * clock.0);
            top.w = Vector::Z * rate as f32 + before.rotate(axis) * along as f32;
            let (mut angle, mut last) = (0.0f64, f64::from(axis.y).atan2(f64::from(axis.x)));
            let steps = (10.0 / clock.0).round();
            for _ in 0..steps as usize {
                let axis = top.rotation.rotate(Vector::Z);
                let moment = axis.cross(Vector::Z * -(torque as f32));
                top.step(top.inv_inertia().rotated(top.rotation).apply(moment));
                let axis = top.rotation.rotate(Vector::Z);
                let lean = f64::from(axis.z.clamp(-1.0, 1.0)).acos();
                assert!((lean - f64::from(tilt)).abs() < 0.01, "{spin} rad/s at {clock:?}: leans by {lean}");
                let now = f64::from(axis.y).atan2(f64::from(axis.x));
                angle += (now - last + 3.0 * core::f64::consts::PI).rem_euclid(core::f64::consts::TAU)
                    - core::f64::consts::PI;
                last = now;
            }
            let got = angle / f64::from(steps * clock.0);
            // The error is of second order in the turn of a substep.
            let error = 0.005 + (spin * f64::from(clock.0)).powi(2) / 12.0;
            assert!((got - rate).abs() < error * rate, "precesses at {got}, not at {rate}");
            let fast = torque / (i3 * spin);
            assert!((got - fast).abs() < 0.1 * fast, "precesses at {got}, not at {fast}");
        }
    }
}

#[test]
fn a_thin_rod_at_100_radians_a_second_does_not_blow_up() {
    for clock in CLOCKS {
        for v in [Vector { x: 1.0, y: 0.1, z: 0.0 }, Vector { x: 0.1, y: 1.0, z: 0.2 }, Vector::ONE] {
            let mut body = Spinner::cuboid([1.0, 0.01, 0.01], of_length(v, 100.0), clock);
            let (l, e) = body.kept();
            for second in 0..60 {
                body.run(1.0);
                let (after_l, after_e) = body.kept();
                assert!((after_l / l - 1.0).abs() < 0.01, "after {second} s |L| is {}", after_l / l);
                assert!((after_e / e - 1.0).abs() < 0.01, "after {second} s E is {}", after_e / e);
            }
        }
    }
}

#[test]
fn spin_of_any_speed_gains_no_energy() {
    for clock in CLOCKS {
        for speed in [300.0, 1000.0, 1.0e5, 1.0e12] {
            for size in [[1.0, 2.0, 3.0], [10.0, 1.0, 0.1], [100.0, 0.01, 0.01], [100.0, 100.0, 0.01]] {
                let w = of_length(Vector { x: 1.0, y: 2.0, z: -1.5 }, speed);
                let mut body = Spinner::cuboid(size, w, clock);
                let (l, e) = body.kept();
                body.run(20.0);
                let (after_l, after_e) = body.kept();
                assert!(
                    after_e < 1.05 * e && after_l < 1.05 * l,
                    "{size:?} at {speed}: E {} L {}",
                    after_e / e,
                    after_l / l
                );
            }
        }
    }
}

/// A wheel of 20 cm on a tip 6 cm below it.
fn top() -> Hull {
    let ring = |y: f32| {
        (0..24).map(move |i| {
            let turn = Rot::from_axis_angle(Vector::Y, i as f32 * core::f32::consts::TAU / 24.0);
            turn.rotate(Vector::X * 0.1) + Vector::Y * y
        })
    };
    let points: Vec<_> = ring(0.06).chain(ring(0.08)).chain([Vector::ZERO]).collect();
    Hull::convex_hull_of(&points).expect("it is a hull")
}

#[test]
fn a_toy_top_on_the_floor_stays_up() {
    for clock in CLOCKS {
        let mut sim = Sim::new();
        (sim.dt, sim.substeps) = clock;
        sim.floor();
        let tilt = Rot::from_axis_angle(Vector::X, 0.1);
        let shape = Shape::Hull(Arc::new(top()));
        let id = sim.add_with(BodyKind::Dynamic, shape, Vector::ZERO, tilt, 1.0, 0.0);
        sim.bodies.velocities[id as usize].angular = tilt.rotate(Vector::Y) * 80.0;
        for step in 0..(3.0 / clock.0) as usize {
            sim.step();
            let up = sim.bodies.poses[id as usize].rotation.rotate(Vector::Y);
            assert!(up.y > 0.95, "after {} s its axis is {up:?}", step as f32 * clock.0);
        }
    }
}

#[test]
fn boxes_that_tumble_on_the_floor_gain_no_energy() {
    let boxes = [
        ([1.0, 2.0, 3.0], 20.0),
        ([3.0, 0.5, 0.3], 10.0),
        ([2.0, 2.0, 0.2], 15.0),
        ([2.0, 2.0, 0.2], 40.0),
        ([4.0, 0.4, 0.4], 30.0),
    ];
    for clock in CLOCKS {
        for (size, speed) in boxes {
            let mut sim = Sim::new();
            (sim.dt, sim.substeps) = clock;
            sim.floor();
            let half = Vector::from_array(size) * 0.5;
            let id = sim.cuboid(half, Vector::Y * (half.length() + 0.1));
            let w = of_length(Vector { x: 1.0, y: 0.5, z: -0.7 }, speed);
            sim.bodies.velocities[id as usize].angular = w;
            let start = sim.energy();
            let weight = 10.0 * half.x * half.y * half.z * 8.0;
            let mut lowest = start;
            for _ in 0..(10.0 / clock.0) as usize {
                sim.step();
                let now = sim.energy();
                assert!(now < lowest + 1e-3 * start, "{size:?} at {clock:?}: {lowest} J rise to {now} J");
                // What sank in as it landed may be pushed out again.
                let pose = &sim.bodies.poses[id as usize];
                let reach = pose.rotation.inverse_rotate(Vector::Y).abs().dot(half);
                let sunk = (reach - pose.center.to_local().y).max(0.0);
                lowest = lowest.min(now + f64::from(weight * sunk));
            }
            assert!(lowest < 0.2 * start, "{size:?} at {clock:?}: {lowest} J of {start} J are left");
        }
    }
}

/// Contacts of rocking rods are computed in the middle of the step, where these would have passed each other.
#[test]
fn crossed_rods_that_are_struck_together_do_not_pass() {
    for clock in CLOCKS {
        for speed in [1.0, 5.0, 10.0, 40.0] {
            let mut sim = Sim::new();
            (sim.dt, sim.substeps, sim.gravity) = (clock.0, clock.1, Vector::ZERO);
            let rod = Shape::Capsule(Capsule { a: -Vector::X, b: Vector::X, radius: 0.02 });
            let across = Rot::from_axis_angle(Vector::Y, core::f32::consts::FRAC_PI_2);
            let [low, high] = [(0.0, Rot::IDENTITY), (0.04, across)]
                .map(|(y, turn)| sim.add(BodyKind::Dynamic, rod.clone(), Vector::Y * y, turn));
            let v = &mut sim.bodies.velocities[high as usize];
            (v.linear, v.angular) = (Vector::Y * -speed, Vector::X * 0.4);
            for _ in 0..20 {
                sim.step();
                let gap = sim.position(high).to_local().y - sim.position(low).to_local().y;
                assert!(gap > 0.03, "at {speed} m/s they are {gap} m apart");
            }
        }
    }
}

#[test]
fn the_inertia_of_a_thin_splinter_has_an_inverse() {
    // A box of 32 × 0.5 × 0.5 mm and one of a micrometre: the determinants are 1e-37 and smaller
    // than any `f32`.
    for size in [[0.032f32, 0.0005, 0.0005], [1.0e-6, 1.0e-6, 2.0e-6]] {
        let half = Vector::from_array(size) * 0.5;
        let inertia = Shape::Cuboid(Cuboid { half }).mass_properties(1.0).inertia;
        let turned = inertia.rotated(Rot::from_axis_angle(Vector::X, 0.3));
        for inertia in [inertia, turned] {
            for axis in Vector::AXES {
                let back = inertia.inverse().apply(inertia.apply(axis));
                assert!((back - axis).length() < 1e-5, "{size:?}: {axis:?} becomes {back:?}");
            }
        }
    }
    let flat = InvInertia { xx: 1.0, yy: 1.0, xy: 1.0, ..InvInertia::ZERO };
    assert_eq!(flat.inverse(), InvInertia::ZERO, "it is singular");
    let tiny = InvInertia::from_diagonal(Vector::ONE * 1.0e-40);
    assert_eq!(tiny.inverse(), InvInertia::ZERO, "the inverse is not finite");
}

/// Solid boxes that are joined: the place and the half size of each.
fn bars(list: [([f32; 3], [f32; 3]); 3]) -> Shape {
    let bar = |(at, half): ([f32; 3], [f32; 3])| {
        let half = Vector::from_array(half);
        (Pose::new(Vector::from_array(at), Rot::IDENTITY), Shape::Cuboid(Cuboid { half }))
    };
    Shape::compound(list.map(bar).into()).expect("a compound")
}

/// The least and the greatest share of its energy that a body has in 15 s on ice, after it was let down and
/// given a spin about the vertical.
fn energy_on_ice(shape: &Shape, clock: (f32, u32), speed: f32) -> [f64; 2] {
    let mut sim = Sim::new();
    (sim.dt, sim.substeps) = clock;
    let ice = Shape::Cuboid(Cuboid { half: Vector { x: 50.0, y: 1.0, z: 50.0 } });
    sim.add_with(BodyKind::Static, ice, Vector::Y * -1.0, Rot::IDENTITY, 0.0, 0.0);
    let id = sim.add_with(BodyKind::Dynamic, shape.clone(), Vector::Y * 0.11, Rot::IDENTITY, 0.0, 0.0);
    sim.steps((3.0 / clock.0) as usize);
    let rest = sim.energy();
    sim.bodies.velocities[id as usize].angular = Vector::Y * speed;
    let start = sim.energy() - rest;
    let mut range = [1.0f64, 1.0];
    for _ in 0..(15.0 / clock.0) as usize {
        sim.step();
        let share = (sim.energy() - rest) / start;
        range = [range[0].min(share), range[1].max(share)];
    }
    range
}

/// The floor pushed a body that spins askew as if it had not turned since the step began: in 15 s it gained a
/// quarter of its spin.
#[test]
fn a_skew_body_that_spins_on_ice_keeps_its_energy() {
    let shape = bars([
        ([0.0, 0.0, 0.0], [0.5, 0.1, 0.1]),
        ([0.4, 0.3, 0.0], [0.1, 0.3, 0.1]),
        ([-0.4, 0.0, 0.3], [0.1, 0.1, 0.3]),
    ]);
    for clock in CLOCKS {
        let [least, most] = energy_on_ice(&shape, clock, 5.0);
        assert!(least > 0.95 && most < 1.05, "{clock:?}: {least} to {most} of its energy");
    }
}

/// It stands on an edge and the corner of another bar. Of the edge only one end was a point of contact, in
/// turns, while points in the air had the other places: it gained up to 3.5 times its energy.
#[test]
fn a_body_that_spins_on_an_edge_and_a_corner_gains_no_energy() {
    let shape = bars([
        ([-0.3, 0.0, 0.3], [0.3, 0.1, 0.1]),
        ([0.3, 0.2, -0.3], [0.3, 0.1, 0.1]),
        ([0.0, 0.1, 0.0], [0.05, 0.2, 0.4]),
    ]);
    for clock in CLOCKS {
        for speed in [4.0, 5.0, 5.5, 8.0] {
            let [least, most] = energy_on_ice(&shape, clock, speed);
            assert!(least > 0.9 && most < 1.01, "{clock:?}, {speed} rad/s: {least} to {most} of its energy");
        }
    }
}
