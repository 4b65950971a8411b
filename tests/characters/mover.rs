//! Dynamic movers: bodies that walk by forces.

use super::{SKIN, app, block, fixed, floor, spin, step, toward, turned};
use avian::{math::*, prelude::*};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use core::time::Duration;

/// Half the height of the shape, with the height of rest.
const HOVERING: Scalar = 0.75 + 0.3;

/// The rates in Hz, and the height of the spring: 0 slides.
const CASES: [(u32, Scalar); 5] = [(30, 0.3), (64, 0.3), (144, 0.3), (30, 0.0), (64, 0.0)];

struct Hall {
    app: App,
    player: Entity,
    rate: u32,
}

impl Hall {
    fn new(rate: u32, float_height: Scalar, at: Vector) -> Self {
        let mut app = app();
        app.insert_resource(Gravity(Vector::NEG_Y * 9.81));
        let mover = DynamicMover { float_height, ..Default::default() };
        let shape = Collider::capsule(0.4, 0.7);
        let player = app.world_mut().spawn((mover, shape, Mass(70.0), Position(at))).id();
        Self { app, player, rate }
    }

    fn get<C: Component + Copy>(&self, entity: Entity) -> C {
        *self.app.world().get::<C>(entity).expect("it has one")
    }

    fn state(&self) -> CharacterState {
        self.get(self.player)
    }

    fn position(&self) -> Vector {
        self.get::<Position>(self.player).0
    }

    fn input(&mut self) -> Mut<'_, CharacterInput> {
        self.app.world_mut().get_mut(self.player).expect("a mover")
    }

    /// Walks for some seconds; returns the positions and states.
    fn walk(&mut self, velocity: Vector, seconds: Scalar) -> Vec<(Vector, CharacterState)> {
        self.input().velocity = velocity;
        let tick = |hall: &mut Self| {
            step(&mut hall.app, Duration::from_secs_f64(1.0 / f64::from(hall.rate)));
            (hall.position(), hall.state())
        };
        (0..(seconds * self.rate as Scalar).round() as u32).map(|_| tick(self)).collect()
    }
}

fn rest(float_height: Scalar) -> Scalar {
    0.75 + float_height
}

#[test]
fn it_rests_at_its_height_and_walks_at_the_speed_asked_for() {
    for (rate, float_height) in CASES {
        let what = (rate, float_height);
        let mut hall = Hall::new(rate, float_height, Vector::Y * (rest(float_height) + 0.5));
        floor(&mut hall.app);
        hall.walk(Vector::ZERO, 1.5);
        let start = hall.position();
        assert!(hall.state().is_grounded(), "{what:?}: {:?}", hall.state());
        assert!((start.y - rest(float_height)).abs() < 6.0e-3, "{what:?}: {start}");
        hall.walk(Vector::ZERO, 5.0);
        assert!((hall.position() - start).length() < 1.0e-3, "{what:?}: {} from {start}", hall.position());
        hall.walk(Vector::X * 4.0, 0.5);
        let from = hall.position();
        let path = hall.walk(Vector::X * 4.0, 1.0);
        assert!((hall.position().x - from.x - 4.0).abs() < 0.02, "{what:?}: {}", hall.position());
        assert!(path.iter().all(|(_, state)| state.is_grounded()), "{what:?}");
        // It stops within a tick more than its acceleration allows.
        hall.walk(Vector::ZERO, 0.1 + 1.5 / rate as Scalar);
        assert!(hall.get::<LinearVelocity>(hall.player).0.length() < 0.05, "{what:?}");
        let before = hall.position().y;
        hall.input().jump = 5.0;
        let path = hall.walk(Vector::ZERO, 0.7);
        let top = path.iter().fold(0.0, |top: Scalar, p| top.max(p.0.y)) - before;
        // Symplectic integration is off by half a tick.
        let height = 25.0 / (2.0 * 9.81);
        assert!((top - height).abs() < 5.0 * 0.5 / rate as Scalar + 0.01, "{what:?}: {top} m, not {height}");
        hall.walk(Vector::ZERO, 1.5);
        assert!((hall.position().y - before).abs() < 6.0e-3, "{what:?}: {}", hall.position());
    }
}

#[test]
fn it_stands_on_slopes_and_walks_up_and_down() {
    for (rate, float_height) in CASES {
        for degrees in [20, 40] {
            let what = (rate, float_height, degrees);
            let angle = (degrees as Scalar).to_radians();
            let out = toward(angle as f32 + core::f32::consts::FRAC_PI_2);
            let mut hall = Hall::new(rate, float_height, Vector::Y * 1.6);
            fixed(&mut hall.app, block(Vector::ONE * 100.0), out * -50.0, turned(angle));
            hall.walk(Vector::ZERO, 2.0);
            let start = hall.position();
            assert!(hall.state().is_grounded(), "{what:?}: {:?}", hall.state());
            hall.walk(Vector::ZERO, 5.0);
            let drift = (hall.position() - start).length();
            assert!(drift < 0.01, "{what:?}: it slides by {drift}");
            for way in [1.0, -1.0] {
                hall.walk(Vector::X * (2.0 * way), 0.5);
                let from = hall.position();
                let path = hall.walk(Vector::X * (2.0 * way), 1.0);
                let off = hall.position() - from - (Vector::X + Vector::Y * angle.tan()) * (2.0 * way);
                assert!(off.length() < 0.04, "{what:?}: off by {off}");
                let lost = path.iter().find(|(_, state)| !state.is_grounded());
                assert!(lost.is_none(), "{what:?}: {lost:?}");
            }
        }
        // Too steep.
        let angle: Scalar = 60.0_f64.to_radians() as Scalar;
        let out = toward(angle as f32 + core::f32::consts::FRAC_PI_2);
        let mut hall = Hall::new(rate, float_height, Vector::Y * 1.6);
        fixed(&mut hall.app, block(Vector::ONE * 100.0), out * -50.0, turned(angle));
        let path = hall.walk(Vector::ZERO, 2.0);
        assert!(path.iter().all(|(_, state)| !state.is_grounded()), "{rate}, {float_height}");
        assert!(hall.position().y < -3.0, "{rate}, {float_height}: {}", hall.position());
    }
}

/// Steps of 0.2 m pass below its collider.
#[test]
fn stairs_are_a_slope_to_the_spring() {
    for rate in [30, 64, 144] {
        let mut hall = Hall::new(rate, 0.3, Vector::Y * HOVERING);
        floor(&mut hall.app);
        for i in 0..8 {
            let height = 0.2 * (i + 1) as Scalar;
            let depth = if i == 7 { 8.0 } else { 0.35 };
            let size = Vector::ONE * 8.0 + Vector::X * (depth - 8.0) + Vector::Y * (height - 8.0);
            let at = Vector::X * (2.0 + 0.35 * i as Scalar + 0.5 * depth) + Vector::Y * (0.5 * height);
            fixed(&mut hall.app, block(size), at, Rotation::IDENTITY);
        }
        hall.walk(Vector::ZERO, 0.5);
        let up = hall.walk(Vector::X * 3.0, 2.5);
        let off = up.iter().find(|(_, state)| !state.is_grounded());
        assert!(off.is_none(), "{rate}: {off:?}");
        assert!((hall.position().y - 1.6 - HOVERING).abs() < 0.02, "{rate}: {}", hall.position());
        assert!(hall.position().x > 5.5, "{rate}: too slow, at {}", hall.position());
        let down = hall.walk(Vector::X * -3.0, 2.7);
        let off = down.iter().find(|(_, state)| !state.is_grounded());
        assert!(off.is_none(), "{rate}: down, {off:?}");
        assert!((hall.position().y - HOVERING).abs() < 0.02, "{rate}: {}", hall.position());
    }
}

#[test]
fn platforms_carry_it() {
    for (rate, float_height) in CASES {
        let what = (rate, float_height);
        for (velocity, turn) in [(Vector::X * 5.0, 0.0), (Vector::Y * 2.0, 0.0), (Vector::ZERO, 1.0)] {
            if turn != 0.0 && !spin::IS_LEVEL {
                continue;
            }
            let from = if turn == 0.0 { Vector::ZERO } else { spin::START * 0.5 };
            let mut hall = Hall::new(rate, float_height, from + Vector::Y * rest(float_height));
            let shape = if turn == 0.0 { block(Vector::ONE * 8.0 - Vector::Y * 7.0) } else { spin::disc() };
            let body = (RigidBody::Kinematic, shape, Position(Vector::Y * -0.5));
            let motion = (LinearVelocity(velocity), AngularVelocity(spin::velocity(turn)));
            let platform = hall.app.world_mut().spawn((body, motion)).id();
            hall.walk(Vector::ZERO, 0.5);
            let offset = |hall: &Hall| {
                let (p, q) = (hall.get::<Position>(platform).0, hall.get::<Rotation>(platform));
                q.inverse() * (hall.position() - p)
            };
            let start = offset(&hall);
            let path = hall.walk(Vector::ZERO, 2.0);
            assert!(path.iter().all(|(_, state)| state.is_grounded()), "{what:?}, {velocity}");
            let slip = (offset(&hall) - start).length();
            assert!(slip < 0.02, "{what:?}, {velocity}, {turn} rad/s: it slips by {slip}");
        }
    }
}

/// By its mass: light crates go with it, heavy ones stay; and the crate it stands on bears its weight.
#[test]
fn it_pushes_by_its_mass() {
    for (rate, float_height) in [(30, 0.3), (64, 0.0), (64, 0.3)] {
        let mut ways = Vec::new();
        for mass in [5.0, 50.0, 5000.0] {
            let mut hall = Hall::new(rate, float_height, Vector::Y * rest(float_height));
            floor(&mut hall.app);
            let at = Vector::X * 1.5 + Vector::Y * 0.75;
            let body = (RigidBody::Dynamic, block(Vector::ONE * 1.5), Position(at), Mass(mass));
            let load = hall.app.world_mut().spawn((body, Friction::new(0.4))).id();
            hall.walk(Vector::ZERO, 0.3);
            hall.walk(Vector::X * 2.0, 2.0);
            ways.push(hall.get::<Position>(load).0.x - 1.5);
        }
        let what = (rate, float_height);
        assert!(ways[0] > 2.0 && ways[1] > 1.0 && ways[2].abs() < 0.05, "{what:?}: {ways:?}");
        assert!(ways.windows(2).all(|w| w[1] < w[0] + 0.1), "{what:?}: {ways:?}");
    }
}

/// A raft without weight of its own, that a spring carries: it sinks by the weight of the mover.
#[test]
fn the_ground_bears_its_weight() {
    for (rate, float_height) in [(64, 0.3), (64, 0.0), (144, 0.3)] {
        let mut hall = Hall::new(rate, float_height, Vector::Y * (rest(float_height) + 0.3));
        let bearer = fixed(&mut hall.app, block(Vector::ONE * 0.1), Vector::Y * -3.0, Rotation::IDENTITY);
        let raft = (
            RigidBody::Dynamic,
            block(Vector::ONE * 4.0 - Vector::Y * 3.5),
            Position(Vector::ZERO),
            (Mass(200.0), GravityScale(0.0), LockedAxes::ROTATION_LOCKED),
        );
        let raft = hall.app.world_mut().spawn(raft).id();
        // k = 200 · (2π)².
        let spring = MotorModel::SpringDamper { frequency: 1.0, damping_ratio: 1.0 };
        let motor = LinearMotor::new(spring).with_target_position(3.0);
        hall.app
            .world_mut()
            .spawn(PrismaticJoint::new(bearer, raft).with_slider_axis(Vector::Y).with_motor(motor));
        hall.walk(Vector::ZERO, 6.0);
        let sunk = -hall.get::<Position>(raft).0.y;
        let expected = 70.0 * 9.81 / (200.0 * TAU * TAU);
        assert!((sunk / expected - 1.0).abs() < 0.05, "{rate}, {float_height}: {sunk} m, not {expected}");
    }
}

/// What observers heard.
#[derive(Resource, Default, Debug)]
struct Heard {
    landed: Vec<CharacterLanded>,
    left: usize,
}

#[test]
fn what_it_is_told_and_what_it_cannot_do() {
    let mut hall = Hall::new(60, 0.3, Vector::Y * (HOVERING + 1.0));
    let ground = floor(&mut hall.app);
    hall.app.init_resource::<Heard>();
    hall.app.add_observer(|on: On<CharacterLanded>, mut heard: ResMut<Heard>| heard.landed.push(*on));
    hall.app.add_observer(|_: On<CharacterLeftGround>, mut heard: ResMut<Heard>| heard.left += 1);
    hall.walk(Vector::ZERO, 1.0);
    let landed = hall.app.world().resource::<Heard>().landed.clone();
    assert_eq!(landed.len(), 1, "{landed:?}");
    assert_eq!((landed[0].character, landed[0].ground), (hall.player, ground));
    assert!((landed[0].speed - (2.0 * 9.81 as Scalar).sqrt()).abs() < 0.3, "{landed:?}");
    hall.input().jump = 3.0;
    hall.walk(Vector::ZERO, 1.0);
    let heard = hall.app.world().resource::<Heard>();
    assert_eq!((heard.landed.len(), heard.left), (2, 1), "{heard:?}");
    // Bad input moves nothing, bad settings crash nothing.
    let at = hall.position();
    hall.walk(Vector::splat(Scalar::NAN), 0.05);
    assert!((hall.position() - at).length() < 0.05, "{}", hall.position());
    let player = hall.player;
    for value in [Scalar::NAN, -1.0, 0.0, Scalar::INFINITY] {
        let mover = DynamicMover {
            max_slope: value,
            float_height: value,
            snap_distance: value,
            frequency: value,
            damping_ratio: value,
            max_acceleration: value,
            max_air_acceleration: value,
            ..Default::default()
        };
        hall.app.world_mut().entity_mut(player).insert(mover);
        hall.input().jump = value;
        hall.walk(Vector::X, 0.2);
        assert!(hall.position().is_finite(), "{value}: {}", hall.position());
    }
    let place = (Position(Vector::Y * HOVERING), LinearVelocity::ZERO);
    hall.app.world_mut().entity_mut(player).insert((DynamicMover::default(), place));
    hall.walk(Vector::ZERO, 1.0);
    assert!(hall.state().is_grounded());
    // The ground goes, then the collider, then all.
    hall.app.world_mut().despawn(ground);
    hall.walk(Vector::ZERO, 0.5);
    assert!(!hall.state().is_grounded() && hall.position().y < HOVERING - 1.0);
    hall.app.world_mut().entity_mut(player).insert(RigidBodyDisabled);
    hall.walk(Vector::X, 0.1);
    hall.app.world_mut().entity_mut(player).remove::<(RigidBodyDisabled, Collider)>();
    hall.walk(Vector::X, 0.1);
    hall.app.world_mut().despawn(player);
    for _ in 0..3 {
        step(&mut hall.app, Duration::from_millis(16));
    }
}

/// A character with a skin of its own and a mover push each other, and both stay whole.
#[test]
fn a_mover_and_a_walker_meet() {
    let mut hall = Hall::new(60, 0.3, Vector::Y * HOVERING);
    floor(&mut hall.app);
    let at = Position(Vector::X * 3.0 + Vector::Y * (0.9 + SKIN));
    let input = CharacterInput { velocity: Vector::X * -2.0, ..Default::default() };
    let walker = (CharacterController::default(), input, Collider::capsule(0.4, 1.0), at);
    let walker = hall.app.world_mut().spawn(walker).id();
    let path = hall.walk(Vector::X * 2.0, 3.0);
    let between = hall.get::<Position>(walker).0.x - hall.position().x;
    assert!(between > 0.75 && between < 0.9, "{between} m between them");
    assert!(path.iter().all(|(p, _)| p.y.is_finite() && p.y < HOVERING + 0.1));
}

/// At the ticks of a game, between walls, for long enough to fall asleep.
#[test]
fn it_walks_to_and_fro_in_the_fixed_schedule() {
    for float_height in [0.0, 0.3] {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, TimePlugin, PhysicsPlugins::default()));
        app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 60.0)));
        app.finish();
        app.cleanup();
        floor(&mut app);
        for side in [-1.0, 1.0] {
            let wall = block(Vector::ONE * 4.0);
            fixed(&mut app, wall, Vector::X * (side * 8.0) + Vector::Y * 2.0, Rotation::IDENTITY);
        }
        let mover = DynamicMover { float_height, ..Default::default() };
        let at = Position(Vector::Y * rest(float_height));
        let player = app.world_mut().spawn((mover, Collider::capsule(0.4, 0.7), Mass(70.0), at)).id();
        let turn_round = |mut walkers: Query<(&Position, &mut CharacterInput)>, mut way: Local<Scalar>| {
            for (position, mut input) in &mut walkers {
                if position.x.abs() > 4.0 || *way == 0.0 {
                    *way = if position.x > 0.0 { -1.0 } else { 1.0 };
                }
                input.velocity = Vector::X * (3.0 * *way);
            }
        };
        app.add_systems(FixedUpdate, turn_round);
        let (mut before, mut stood) = (0.0, 0);
        for frame in 0..600 {
            app.update();
            let x = app.world().get::<Position>(player).expect("a mover").x;
            stood = if x == before { stood + 1 } else { 0 };
            assert!(stood < 3 || frame < 4, "height {float_height}, frame {frame}: it stands at {x}");
            before = x;
        }
    }
}
