//! Bodies on rotating platforms: contacts are recycled while both rotate together.

use super::dim::{sized, spin, tilts, turntables, upright};
use super::sim::Sim;
use crate::kernel;
use kernel::math::{Angular, Rot, Vector, WorldPose};
use kernel::shape::{Ball, Cuboid, Shape};
use kernel::table::{BodyKind, Velocity};

const GRAVITY: f32 = 10.0;

/// A plate of 20 m with a body at its centre. Returns plate and body. The body is added first if
/// `body_first`.
struct Plate {
    sim: Sim,
    plate: u32,
    body: u32,
}

impl Plate {
    fn new(kind: BodyKind, shape: Shape, tilt: Rot, friction: f32, body_first: bool) -> Self {
        let mut sim = Sim::new();
        let height = match &shape {
            Shape::Ball(ball) => ball.radius,
            _ => 0.5,
        };
        let slab = Shape::Cuboid(Cuboid { half: sized(10.0, 0.25, 10.0) });
        let add_plate = |sim: &mut Sim| {
            sim.add_with(kind, slab.clone(), tilt.rotate(Vector::Y * -0.25), tilt, friction, 0.0)
        };
        let early = (!body_first).then(|| add_plate(&mut sim));
        let place = tilt.rotate(Vector::Y * height);
        let body = sim.add_with(BodyKind::Dynamic, shape, place, tilt, friction, 0.0);
        let plate = early.unwrap_or_else(|| add_plate(&mut sim));
        Self { sim, plate, body }
    }

    /// Rotates the plate about an axis through its centre at constant speed for some steps, then stops it.
    fn turn(&mut self, spin: Angular, steps: usize) {
        for _ in 0..steps {
            // The centre of the upper face stays in place, so the plate's centre moves on a circle.
            let linear = spin.cross(self.arm());
            self.sim.bodies.set_velocity(self.plate, Velocity { linear, angular: spin });
            self.sim.step();
        }
        self.sim.bodies.set_velocity(self.plate, Velocity::default());
    }

    fn arm(&self) -> Vector {
        self.sim.bodies.poses[self.plate as usize].rotation.rotate(Vector::Y * -0.25)
    }

    /// Displacement of the body along the plate in a time.
    fn slide(&mut self, seconds: f32) -> f32 {
        let from = self.place();
        self.sim.steps((seconds * 60.0) as usize);
        (self.place() - from).length()
    }

    /// The position of the body in the plate's frame.
    fn place(&self) -> Vector {
        let plate = self.sim.bodies.frame(self.plate);
        plate.rotation.inverse_rotate((self.sim.position(self.body) - plate.position).to_local())
    }

    fn stop(&mut self) {
        self.sim.bodies.set_velocity(self.body, Velocity::default());
    }
}

fn cube() -> Shape {
    Shape::Cuboid(Cuboid { half: Vector::ONE * 0.5 })
}

fn shapes() -> [Shape; 2] {
    [cube(), Shape::Ball(Ball { radius: 0.5 })]
}

#[test]
fn what_lies_on_a_plate_that_is_tilted_a_little_slides_as_on_a_fixed_slope() {
    for (k, shape) in shapes().into_iter().enumerate() {
        for degrees in [0.5f32, 2.0, 5.0] {
            for body_first in [false, true] {
                let angle = degrees.to_radians();
                let mut plate =
                    Plate::new(BodyKind::Kinematic, shape.clone(), Rot::IDENTITY, 0.0, body_first);
                plate.sim.steps(30);
                plate.turn(spin(-angle), 60);
                plate.stop();
                let way = plate.slide(1.5);
                let expected = 0.5 * GRAVITY * angle.sin() * 1.5 * 1.5;
                let error = (way / expected - 1.0).abs();
                assert!(error < 0.02, "shape {k}, {degrees}°, {body_first}: {way} m for {expected} m");
            }
        }
    }
}

#[test]
fn a_plate_tilted_slowly_is_as_a_slope_that_was_always_there() {
    for axis in tilts() {
        for body_first in [false, true] {
            // Friction is high enough to hold the body until the plate stops.
            let mut plate = Plate::new(BodyKind::Kinematic, cube(), Rot::IDENTITY, 2.0, body_first);
            plate.turn(axis * (core::f32::consts::FRAC_PI_4 / 10.0), 600);
            assert!((plate.place() - Vector::Y * 0.75).length() < 0.01, "it was held: {:?}", plate.place());
            let tilt = plate.sim.bodies.poses[plate.plate as usize].rotation;
            let mut fixed = Plate::new(BodyKind::Static, cube(), tilt, 2.0, body_first);
            fixed.sim.steps(30);
            for p in [&mut plate, &mut fixed] {
                for id in [p.plate, p.body] {
                    let mut material = p.sim.colliders[id].def.material;
                    material.friction.coefficient = 0.1;
                    p.sim.contact_manager().set_material(id, material);
                }
                p.stop();
            }
            let (way, expected) = (plate.slide(1.0), fixed.slide(1.0));
            assert!((way - expected).abs() < 0.01 * expected.max(0.1), "{axis:?}: {way} m for {expected} m");
        }
    }
}

#[test]
fn friction_on_a_tilted_plate_holds_below_its_angle_and_not_above() {
    for body_first in [false, true] {
        for (degrees, slides) in [(-0.5f32, false), (0.5, true)] {
            let angle = 0.3f32.atan() + degrees.to_radians();
            let mut plate = Plate::new(BodyKind::Kinematic, cube(), Rot::IDENTITY, 0.3, body_first);
            plate.sim.steps(30);
            plate.turn(spin(-angle / 5.0), 300);
            // The plate stops at once, the box some time later.
            plate.sim.steps(60);
            let way = plate.slide(2.0);
            assert_eq!(way > 0.05, slides, "{way} m, {degrees}° above the angle of friction");
            assert!(slides || way < 2e-4, "it creeps {way} m");
        }
    }
}

#[test]
fn a_box_rides_a_plate_that_rocks() {
    for axis in tilts() {
        for body_first in [false, true] {
            let mut plate = Plate::new(BodyKind::Kinematic, cube(), Rot::IDENTITY, 0.6, body_first);
            plate.sim.steps(30);
            let from = plate.place();
            plate.turn(axis * 0.175, 60);
            for _ in 0..3 {
                plate.turn(axis * -0.175, 120);
                plate.turn(axis * 0.175, 120);
            }
            let way = (plate.place() - from).length();
            // The cube's centre is h = 0.5 m over the pivot. Where the plate turns back at once, friction
            // takes time to change its speed by 2 ω h, and the cube slips by (2 ω h)² / 2 μ g. Slips to and
            // fro cancel, but for one.
            let about_vertical = upright().map_or(0.0, |up| axis.dot(up));
            let change = 2.0 * 0.175 * 0.5 * (1.0 - about_vertical * about_vertical).sqrt();
            let slip = change * change / (2.0 * 0.6 * GRAVITY);
            assert!(way < slip, "{axis:?}, {body_first}: it crept {way} m, more than a slip of {slip} m");
        }
    }
}

#[test]
fn a_box_rides_a_turntable() {
    if let Some(axis) = upright() {
        for body_first in [false, true] {
            let mut plate = Plate::new(BodyKind::Kinematic, cube(), Rot::IDENTITY, 0.6, body_first);
            let frame = plate.sim.bodies.frame(plate.body);
            let frame = WorldPose::new(frame.position + (Vector::X * 2.0).to_world(), frame.rotation);
            plate.sim.bodies.teleport(plate.body, frame);
            plate.sim.steps(30);
            // Six seconds per revolution, after a start without slipping.
            let speed = core::f32::consts::TAU / 6.0;
            (0..60).for_each(|k| plate.turn(axis * (speed * k as f32 / 60.0), 1));
            plate.turn(axis * speed, 60);
            let from = plate.place();
            for turn in 1..=10 {
                plate.turn(axis * speed, 360);
                let way = (plate.place() - from).length();
                assert!(way < 1e-3, "{body_first}: it crept {way} m in {turn} turns");
            }
        }
    }
}

/// Two curved shapes counted as round, between which nothing is carried: coins flew off.
#[test]
fn coins_ride_a_round_turntable() {
    let Some(axis) = upright() else { return };
    for (name, table, coin) in turntables() {
        for share in [0.1f32, 0.5] {
            let (radius, friction) = (1.0, 0.6);
            let mut sim = Sim::new();
            sim.checked = false;
            let height = |shape: &Shape| shape.local_aabb(Rot::IDENTITY).max.y;
            let plate =
                sim.add_with(BodyKind::Kinematic, table.clone(), Vector::ZERO, Rot::IDENTITY, friction, 0.0);
            let at = Vector::Y * (height(&table) + height(&coin)) + Vector::X * radius;
            let id = sim.add_with(BodyKind::Dynamic, coin.clone(), at, Rot::IDENTITY, friction, 0.0);
            sim.steps(30);
            // ω² r is a share of μ g.
            let speed = (share * friction * GRAVITY / radius).sqrt();
            for k in 0..1500 {
                let angular = axis * (speed * (k as f32 / 300.0).min(1.0));
                sim.bodies.set_velocity(plate, Velocity { angular, ..Velocity::default() });
                sim.step();
            }
            let away = sim.position(id).to_local() - Vector::Y * sim.position(id).to_local().y;
            let moved = (away.length() - radius).abs();
            assert!(moved < 0.01, "{name} at {share} of its grip: {moved} m outwards");
        }
    }
}

/// How a platform moves, as its velocity at a time.
type Path = fn(f32) -> Vector;

/// How far a cube creeps on a platform in a number of seconds, in metres.
fn crept(path: Path, friction: f32, seconds: usize, body_first: bool) -> f32 {
    let mut plate = Plate::new(BodyKind::Kinematic, cube(), Rot::IDENTITY, friction, body_first);
    plate.sim.steps(30);
    let from = plate.place();
    for k in 0..60 * seconds {
        let linear = path(k as f32 / 60.0);
        plate.sim.bodies.set_velocity(plate.plate, Velocity { linear, ..Velocity::default() });
        plate.sim.step();
    }
    let way = plate.place() - from;
    (way - Vector::Y * way.dot(Vector::Y)).length()
}

#[test]
fn a_box_does_not_creep_on_a_platform_that_is_shaken_or_rises() {
    let paths: [(&str, Path); 3] = [
        // Up and down by 5 cm at 1 Hz, with up to 0.2 g.
        ("rises and falls", |t| {
            Vector::Y * (0.05 * core::f32::consts::TAU * (core::f32::consts::TAU * t).cos())
        }),
        ("rises", |t| Vector::Y * t.min(2.0)),
        // To and fro with 3.2 m/s², of 6 m/s² that friction holds.
        ("is shaken", |t| Vector::X * (0.51 * (core::f32::consts::TAU * t).sin())),
    ];
    for (name, path) in paths {
        for body_first in [false, true] {
            let way = crept(path, 0.6, 10, body_first);
            assert!(way < 1.0e-3, "{name}, {body_first}: it crept {way} m in 10 s");
        }
    }
}

#[test]
fn a_box_below_its_grip_does_not_creep_out_on_a_turntable() {
    let Some(axis) = upright() else { return };
    for (share, radius) in [(0.2, 2.0), (0.41, 0.5), (0.41, 2.0), (0.41, 6.0), (0.7, 2.0), (0.95, 6.0f32)] {
        for body_first in [false, true] {
            let mut plate = Plate::new(BodyKind::Kinematic, cube(), Rot::IDENTITY, 0.6, body_first);
            let frame = plate.sim.bodies.frame(plate.body);
            let frame = WorldPose::new(frame.position + (Vector::X * radius).to_world(), frame.rotation);
            plate.sim.bodies.teleport(plate.body, frame);
            plate.sim.steps(30);
            // ω² r is a share of μ g.
            let speed = (share * 0.6 * GRAVITY / radius).sqrt();
            (0..300).for_each(|k| plate.turn(axis * (speed * k as f32 / 300.0), 1));
            plate.turn(axis * speed, 300);
            let from = plate.place();
            plate.turn(axis * speed, 1200);
            let creep = (plate.place() - from).length() / 20.0;
            assert!(creep < 1.0e-4, "at {share} of its grip, {body_first}: it creeps {creep} m/s");
        }
    }
}
