//! Gears, racks and pulleys, against closed forms.

use super::dim::{SWINGS, hinge_basis, sized, spin};
use super::joints::{SHIFTS, apart, cuboid, hinge, inertia, motor, post};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Rot, Vector, WorldPose};
use kernel::shape::{Ball, Shape};
use kernel::solver::coordinate::*;
use kernel::solver::{
    Axis, CouplingDef, CouplingEnd, EndCoordinate, Give, JointDef, JointError, JointFrame, Motor,
};
use kernel::table::{BodyKind, Velocity};

/// The turn of a body about an axis out of the plane of x and y.
fn turn_at(at: Vector) -> CouplingEnd {
    let frame = JointFrame { anchor: Vector::ZERO, basis: hinge_basis() };
    CouplingEnd {
        coordinate: EndCoordinate::Turn,
        frame,
        ground: WorldPose::new(at.to_world(), hinge_basis()),
    }
}

fn end(coordinate: EndCoordinate, ground: Vector) -> CouplingEnd {
    let ground = WorldPose::new(ground.to_world(), Rot::IDENTITY);
    CouplingEnd { coordinate, frame: JointFrame::default(), ground }
}

/// A wheel on a pin.
fn wheel(sim: &mut Sim, radius: f32, at: Vector, turn: Axis) -> u32 {
    let pin = post(sim, at);
    let wheel = apart(sim, BodyKind::Dynamic, Shape::Ball(Ball { radius }), at, Rot::IDENTITY);
    sim.join(hinge(pin, wheel, [Vector::ZERO; 2]).with([super::dim::TURN], turn)).unwrap();
    wheel
}

/// A torque as a motor that never reaches its speed.
fn torque(of: f32) -> Axis {
    Axis { motor: Some(motor(1.0e6, of)), ..Axis::FREE }
}

fn turn_speed(sim: &Sim, id: u32) -> f32 {
    sim.bodies.velocities[id as usize].angular.z
}

/// α = τ / (I_a + I_b / r²), at any ratio and for both senses, and no tooth slips in many turns.
#[test]
fn gears_share_a_torque_and_never_slip() {
    for ratio in [1.0f32, -0.5, 3.0, -7.0] {
        let mut sim = Sim::new();
        sim.gravity = Vector::ZERO;
        let a = wheel(&mut sim, 0.5, Vector::ZERO, torque(4.0));
        let b = wheel(&mut sim, 0.6, Vector::X * 1.1, Axis::FREE);
        let ends = [turn_at(Vector::ZERO), turn_at(Vector::X * 1.1)];
        let def = CouplingDef { bodies: [a, b], ends, ratio, limits: [0.0; 2], give: Give::Rigid };
        let id = sim.couple(def).unwrap();
        let both = inertia(&sim, a) + inertia(&sim, b) / (ratio * ratio);
        sim.steps(120);
        let (wa, wb) = (turn_speed(&sim, a), turn_speed(&sim, b));
        assert!((wa / (2.0 * 4.0 / both) - 1.0).abs() < 0.01, "ratio {ratio}: {wa} rad/s");
        assert!((wa + ratio * wb).abs() < 1.0e-3 * wa.abs(), "ratio {ratio}: {wa} and {wb} rad/s");
        let force = sim.coupling_force(id);
        let want = -inertia(&sim, b) / (ratio * ratio) * 4.0 / both;
        assert!((force / want - 1.0).abs() < 0.02, "ratio {ratio}: {force} N·m for {want}");
        sim.steps(480);
        let gap = sim.gap(id).unwrap();
        assert!(gap.angle < 1.0e-3 && gap.length == 0.0, "ratio {ratio}: {gap:?} after 10 s at {wa} rad/s");
    }
}

/// A gear box is wound by hand: what the app turns, the other follows, many turns either way.
#[test]
fn a_driven_gear_follows_many_turns() {
    let mut sim = Sim::new();
    sim.gravity = Vector::ZERO;
    let ball = Shape::Ball(Ball { radius: 0.5 });
    let a = apart(&mut sim, BodyKind::Kinematic, ball, Vector::ZERO, Rot::IDENTITY);
    let b = wheel(&mut sim, 0.5, Vector::X, Axis::FREE);
    let ends = [turn_at(Vector::ZERO), turn_at(Vector::X)];
    let def = CouplingDef { bodies: [a, b], ends, ratio: 0.25, limits: [0.0; 2], give: Give::Rigid };
    let id = sim.couple(def).unwrap();
    let mut turned = 0.0f64;
    for rate in [30.0f32, -50.0, 10.0, 40.0] {
        sim.bodies.set_velocity(a, Velocity { linear: Vector::ZERO, angular: spin(rate) });
        for _ in 0..300 {
            sim.step();
            turned += f64::from(turn_speed(&sim, b)) / 60.0;
        }
        assert!((turn_speed(&sim, b) + 4.0 * rate).abs() < 0.01 * rate.abs(), "{rate} rad/s");
    }
    // 150 − 250 + 50 + 200 radians of A.
    assert!((turned + 4.0 * 150.0).abs() < 0.5, "B turned by {turned} rad");
    assert!(sim.gap(id).unwrap().angle < 2.0e-3, "{:?}", sim.gap(id));
}

/// a = τ r / (I + m r²) for a rack with the mass m.
#[test]
fn a_pinion_drives_its_rack() {
    let (radius, torque_of) = (0.4f32, 1.0f32);
    let mut sim = Sim::new();
    sim.gravity = Vector::ZERO;
    let a = wheel(&mut sim, radius, Vector::ZERO, torque(torque_of));
    let rail = post(&mut sim, Vector::Y * radius);
    let b =
        apart(&mut sim, BodyKind::Dynamic, cuboid(sized(2.0, 0.1, 0.1)), Vector::Y * radius, Rot::IDENTITY);
    let rack = JointDef::free([rail, b], [Vector::ZERO; 2]).with(SHIFTS, Axis::LOCKED);
    let rack = rack.with(super::dim::TURN..SWINGS.end, Axis::LOCKED).with([X], Axis::FREE);
    sim.join(rack).unwrap();
    // The wheel's top moves against x when it turns counter-clockwise.
    let ends = [turn_at(Vector::ZERO), end(EndCoordinate::Shift, Vector::Y * radius)];
    let ratio = 1.0 / radius;
    let def = CouplingDef { bodies: [a, b], ends, ratio, limits: [0.0; 2], give: Give::Rigid };
    let id = sim.couple(def).unwrap();
    sim.steps(60);
    let speed = -sim.bodies.velocities[b as usize].linear.x;
    let want = torque_of * radius / (inertia(&sim, a) + sim.mass(b) as f32 * radius * radius);
    assert!((speed / want - 1.0).abs() < 0.01, "{speed} m/s, not {want}");
    let way = -sim.position(b).to_local().x;
    assert!((way / (0.5 * want) - 1.0).abs() < 0.03, "{way} m");
    let (force, pull) = (sim.coupling_force(id) * ratio, sim.reaction(id).force.x);
    assert!(
        (pull / (-want * sim.mass(b) as f32) - 1.0).abs() < 0.02
            && (force - pull).abs() < 1.0e-3 * pull.abs()
    );
    assert!(sim.gap(id).unwrap().angle < 1.0e-3);
}

/// Two weights over pulleys: (m + n / r²) a = (m − n / r) g for A, and the rope bears m (g − a).
#[test]
fn weights_on_a_rope_are_an_atwood_machine() {
    for (kg, ratio) in [([3.0f32, 1.0f32], 1.0f32), ([1.0, 2.0], 1.0), ([4.0, 3.0], 2.0), ([100.0, 1.0], 1.0)]
    {
        let mut sim = Sim::new();
        let block = cuboid(sized(0.2, 0.2, 0.2));
        let ids = [0, 1].map(|k| {
            let at = sized(3.0 * k as f32, -20.0, 0.0);
            let id = apart(&mut sim, BodyKind::Dynamic, block.clone(), at, Rot::IDENTITY);
            sim.load(id, kg[k] / sim.mass(id) as f32);
            id
        });
        let ends = [0.0f32, 3.0].map(|x| end(EndCoordinate::Distance, Vector::X * x));
        let limits = [f32::NEG_INFINITY, 20.0 + ratio * 20.0];
        let def = CouplingDef { bodies: ids, ends, ratio, limits, give: Give::Rigid };
        assert!((def.sum(&sim.bodies) - limits[1]).abs() < 1.0e-4);
        let id = sim.couple(def).unwrap();
        let [m, n] = kg;
        let a = (m - n / ratio) * 10.0 / (m + n / (ratio * ratio));
        sim.steps(60);
        let speed = -sim.bodies.velocities[ids[0] as usize].linear.y;
        let case = format!("{kg:?} kg, ratio {ratio}");
        assert!((speed / a - 1.0).abs() < 0.01, "{case}: {speed} m/s, not {a}");
        let (force, want) = (-sim.coupling_force(id), m * (10.0 - a));
        assert!((force / want - 1.0).abs() < 0.02, "{case}: {force} N, not {want}");
        assert!(sim.gap(id).unwrap().length < 0.01, "{case}: {:?}", sim.gap(id));
        // A rope pulls only: what is lifted by hand falls freely.
        sim.bodies.set_velocity(ids[0], Velocity { linear: Vector::Y * 20.0, angular: spin(0.0) });
        sim.bodies.set_velocity(ids[1], Velocity { linear: Vector::Y * 5.0, angular: spin(0.0) });
        sim.steps(6);
        let falling = sim.bodies.velocities[ids[0] as usize].linear.y;
        assert!((falling - 19.0).abs() < 0.01 && sim.coupling_force(id) == 0.0, "{case}: {falling} m/s");
    }
}

/// Hostile settings are refused, and changes wake.
#[test]
fn couplings_have_a_life_cycle() {
    let mut sim = Sim::new();
    sim.sleeping = true;
    sim.floor();
    let [a, b] = [0.0f32, 3.0].map(|x| sim.cuboid(Vector::ONE * 0.5, sized(x, 0.5, 0.0)));
    let ends = [turn_at(Vector::ZERO), end(EndCoordinate::Shift, Vector::X * 3.0)];
    let def = CouplingDef { bodies: [a, b], ends, ratio: 2.0, limits: [-9.0, 9.0], give: Give::Rigid };
    let nan = CouplingEnd {
        ground: WorldPose::new(Vector::X.to_world() * kernel::math::Scalar::NAN, Rot::IDENTITY),
        ..ends[0]
    };
    for (bad, error) in [
        (CouplingDef { bodies: [a, a], ..def }, JointError::SameBody(a)),
        (CouplingDef { bodies: [a, 99], ..def }, JointError::NoBody(99)),
        (CouplingDef { ratio: 0.0, ..def }, JointError::Coupling),
        (CouplingDef { ratio: f32::INFINITY, ..def }, JointError::Coupling),
        (CouplingDef { limits: [1.0, 0.0], ..def }, JointError::Coupling),
        (CouplingDef { limits: [f32::NAN, 0.0], ..def }, JointError::Coupling),
        (CouplingDef { give: Give::Compliance(-1.0), ..def }, JointError::Coupling),
        (CouplingDef { ends: [ends[0], nan], ..def }, JointError::End(1)),
    ] {
        assert_eq!(sim.couple(bad), Err(error));
    }
    let id = sim.couple(def).unwrap();
    sim.steps(120);
    assert_eq!(sim.bodies.awake_dynamic().count(), 0);
    sim.recouple(id, def).unwrap();
    assert_eq!(sim.bodies.awake_dynamic().count(), 0, "nothing changed");
    sim.recouple(id, CouplingDef { ratio: 3.0, ..def }).unwrap();
    assert_eq!(sim.bodies.awake_dynamic().count(), 2, "one island");
    assert_eq!(sim.rejoin(id, JointDef::free([a, b], [Vector::ZERO; 2])), Err(JointError::NoJoint(id)));
    let joint = sim.join(JointDef::free([a, b], [Vector::ZERO; 2])).unwrap();
    assert_eq!(sim.recouple(joint, def), Err(JointError::NoJoint(joint)));
    assert_eq!(sim.coupling_force(joint), 0.0);
    sim.part(id).unwrap();
    assert_eq!((sim.part(id), sim.gap(id)), (Err(JointError::NoJoint(id)), None));
    sim.steps(60);
    sim.remove(a);
    sim.steps(60);
}

/// A winch: a wheel with a motor winds up a weight, and holds it.
#[test]
fn a_winch_lifts_and_holds_a_weight() {
    let mut sim = Sim::new();
    let drive = motor(2.0, 500.0);
    let a = wheel(&mut sim, 0.5, Vector::ZERO, Axis { motor: Some(drive), ..Axis::FREE });
    sim.load(a, 20.0);
    let b = apart(&mut sim, BodyKind::Dynamic, cuboid(sized(0.2, 0.2, 0.2)), Vector::Y * -5.0, Rot::IDENTITY);
    sim.load(b, 2.0 / sim.mass(b) as f32);
    let ends = [turn_at(Vector::ZERO), end(EndCoordinate::Distance, Vector::ZERO)];
    let def = CouplingDef { bodies: [a, b], ends, ratio: 2.0, limits: [10.0; 2], give: Give::Rigid };
    let id = sim.couple(def).unwrap();
    sim.steps(120);
    let height = sim.position(b).to_local().y;
    assert!((height + 3.0).abs() < 0.05, "wound up to {height} m");
    let hold = Axis { motor: Some(Motor { target_velocity: 0.0, ..drive }), ..Axis::FREE };
    let joint = hinge(0, a, [Vector::ZERO; 2]).with([super::dim::TURN], hold);
    sim.rejoin(0, joint).unwrap();
    sim.steps(120);
    assert!((-sim.coupling_force(id) - 10.0).abs() < 0.2, "{} N·m", sim.coupling_force(id));
    assert!(sim.bodies.velocities[b as usize].linear.length() < 0.02);
}

/// The same bits for any number of workers and any width.
#[test]
fn couplings_do_not_depend_on_workers() {
    let run = |workers: usize, narrow: bool| {
        let mut sim = Sim::new();
        sim.set_workers(workers);
        if narrow {
            sim.set_narrow();
        }
        let mut ids: Vec<u32> = Vec::new();
        for k in 0..20 {
            let at = Vector::X * k as f32;
            let turn = if k == 0 { torque(10.0) } else { Axis::FREE };
            let id = wheel(&mut sim, 0.4 + 0.01 * k as f32, at, turn);
            if let Some(before) = ids.last() {
                let ends = [turn_at(at - Vector::X), turn_at(at)];
                let ratio = 1.0 + 0.1 * k as f32;
                let bodies = [*before, id];
                let def = CouplingDef { bodies, ends, ratio, limits: [0.0; 2], give: Give::Rigid };
                sim.couple(def).unwrap();
            }
            ids.push(id);
        }
        sim.steps(120);
        ids.iter().map(|id| turn_speed(&sim, *id).to_bits()).collect::<Vec<_>>()
    };
    let one = run(1, false);
    for workers in [2, 5] {
        assert!(run(workers, workers == 5) == one, "{workers} workers");
    }
}
