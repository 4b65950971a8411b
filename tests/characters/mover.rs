//! Dynamic movers: bodies that walk by forces.

use super::{
    SKIN, app, block, fixed, floor, lane, some, spin, stay_on_one_thread, step, toward, turned, usual,
};
use avian::{dynamics::solver::WorkerCount, math::*, prelude::*};
use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::TransformPlugin;
use core::time::Duration;

/// Half the height of the shape, with the height of rest.
const HOVERING: Scalar = 0.75 + 0.3;

/// The heights of the spring at each rate in Hz: 0 slides.
const CASES: [(u32, &[Scalar]); 3] = [(30, &[0.3, 0.0]), (64, &[0.3, 0.0]), (144, &[0.3])];

/// One mover, or several side by side.
struct Hall {
    app: App,
    player: Entity,
    players: Vec<Entity>,
    rate: u32,
}

type Path = Vec<(Vector, CharacterState)>;

impl Hall {
    fn new(rate: u32, float_height: Scalar, at: Vector) -> Self {
        Self::side_by_side(rate, [(float_height, at)])
    }

    /// Movers by the heights of their springs, each in a lane of its own.
    fn side_by_side(rate: u32, starts: impl IntoIterator<Item = (Scalar, Vector)>) -> Self {
        let mut app = app();
        app.insert_resource(Gravity(Vector::NEG_Y * 9.81));
        let spawn = |(i, (float_height, at))| {
            let mover = DynamicMover { float_height, ..Default::default() };
            let shape = Collider::capsule(0.4, 0.7);
            app.world_mut().spawn((mover, shape, Mass(70.0), Position(at), lane(i))).id()
        };
        let players: Vec<Entity> = starts.into_iter().enumerate().map(spawn).collect();
        Self { app, player: players[0], players, rate }
    }

    /// A body in the lane of a mover.
    fn spawn_in_lane(&mut self, index: usize, body: impl Bundle) -> Entity {
        self.app.world_mut().spawn((body, lane(index))).id()
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

    /// Walks for some seconds; returns the positions and states of the first mover.
    fn walk(&mut self, velocity: Vector, seconds: Scalar) -> Path {
        self.walk_all(velocity, seconds).swap_remove(0)
    }

    /// Walks for some seconds; returns the paths of all.
    fn walk_all(&mut self, velocity: Vector, seconds: Scalar) -> Vec<Path> {
        for &player in &self.players {
            self.app.world_mut().get_mut::<CharacterInput>(player).expect("a mover").velocity = velocity;
        }
        let mut paths = vec![Vec::new(); self.players.len()];
        for _ in 0..(seconds * self.rate as Scalar).round() as u32 {
            step(&mut self.app, Duration::from_secs_f64(1.0 / f64::from(self.rate)));
            for (path, &player) in paths.iter_mut().zip(&self.players) {
                path.push((self.get::<Position>(player).0, self.get::<CharacterState>(player)));
            }
        }
        paths
    }
}

fn last(path: &Path) -> Vector {
    path.last().expect("it moves").0
}

fn rest(float_height: Scalar) -> Scalar {
    0.75 + float_height
}

#[test]
fn it_rests_at_its_height_and_walks_at_the_speed_asked_for() {
    for (rate, heights) in CASES {
        let starts = heights.iter().map(|height| (*height, Vector::Y * (rest(*height) + 0.3)));
        let mut hall = Hall::side_by_side(rate, starts);
        floor(&mut hall.app);
        let settled = hall.walk_all(Vector::ZERO, 1.2);
        let stood = hall.walk_all(Vector::ZERO, 4.0);
        let begun = hall.walk_all(Vector::X * 4.0, 0.4);
        let walked = hall.walk_all(Vector::X * 4.0, 1.0);
        // It stops within a tick more than its acceleration allows.
        let stopped = hall.walk_all(Vector::ZERO, 0.1 + 1.5 / rate as Scalar);
        let speeds: Vec<_> =
            hall.players.iter().map(|player| hall.get::<LinearVelocity>(*player).0.length()).collect();
        for &player in &hall.players {
            hall.app.world_mut().get_mut::<CharacterInput>(player).expect("a mover").jump = 5.0;
        }
        let flown = hall.walk_all(Vector::ZERO, 0.7);
        let landed = hall.walk_all(Vector::ZERO, 1.2);
        for (i, float_height) in heights.iter().enumerate() {
            let what = (rate, float_height);
            let start = last(&settled[i]);
            assert!(settled[i].last().is_some_and(|(_, state)| state.is_grounded()), "{what:?}: {start}");
            assert!((start.y - rest(*float_height)).abs() < 6.0e-3, "{what:?}: {start}");
            let end = last(&stood[i]);
            assert!((end - start).length() < 1.0e-3, "{what:?}: {end} from {start}");
            let way = last(&walked[i]).x - last(&begun[i]).x;
            assert!((way - 4.0).abs() < 0.02, "{what:?}: {way}");
            assert!(walked[i].iter().all(|(_, state)| state.is_grounded()), "{what:?}");
            assert!(speeds[i] < 0.05, "{what:?}: {}", speeds[i]);
            let before = last(&stopped[i]).y;
            let top = flown[i].iter().fold(0.0, |top: Scalar, p| top.max(p.0.y)) - before;
            // Symplectic integration is off by half a tick.
            let height = 25.0 / (2.0 * 9.81);
            assert!(
                (top - height).abs() < 5.0 * 0.5 / rate as Scalar + 0.01,
                "{what:?}: {top} m, not {height}"
            );
            let end = last(&landed[i]);
            assert!((end.y - before).abs() < 6.0e-3, "{what:?}: {end}");
        }
    }
}

#[test]
fn it_stands_on_slopes_and_walks_up_and_down() {
    for (rate, heights) in CASES {
        let cases = heights.iter().flat_map(|height| [20, 40, 60].map(|degrees| (*height, degrees)));
        let cases: Vec<(Scalar, i32)> = cases.collect();
        let starts = cases.iter().map(|(height, _)| (*height, Vector::Y * 1.6));
        let mut hall = Hall::side_by_side(rate, starts);
        for (i, (_, degrees)) in cases.iter().enumerate() {
            let angle = (*degrees as Scalar).to_radians();
            let out = toward(angle as f32 + core::f32::consts::FRAC_PI_2);
            let slope = (RigidBody::Static, block(Vector::ONE * 100.0), Position(out * -50.0), turned(angle));
            hall.spawn_in_lane(i, slope);
        }
        let settled = hall.walk_all(Vector::ZERO, 2.0);
        let stood = hall.walk_all(Vector::ZERO, 4.0);
        let runs = [1.0, -1.0].map(|way| {
            let begun = hall.walk_all(Vector::X * (2.0 * way), 0.5);
            (way, begun, hall.walk_all(Vector::X * (2.0 * way), 1.0))
        });
        for (i, (float_height, degrees)) in cases.into_iter().enumerate() {
            let what = (rate, float_height, degrees);
            let start = last(&settled[i]);
            if degrees == 60 {
                // Too steep.
                assert!(settled[i].iter().all(|(_, state)| !state.is_grounded()), "{what:?}");
                assert!(start.y < -3.0, "{what:?}: {start}");
                continue;
            }
            assert!(settled[i].last().is_some_and(|(_, state)| state.is_grounded()), "{what:?}: {start}");
            let drift = (last(&stood[i]) - start).length();
            assert!(drift < 0.01, "{what:?}: it slides by {drift}");
            let rise = (degrees as Scalar).to_radians().tan();
            for (way, begun, walked) in &runs {
                let expected = (Vector::X + Vector::Y * rise) * (2.0 * way);
                let off = last(&walked[i]) - last(&begun[i]) - expected;
                assert!(off.length() < 0.04, "{what:?}: off by {off}");
                let lost = walked[i].iter().find(|(_, state)| !state.is_grounded());
                assert!(lost.is_none(), "{what:?}: {lost:?}");
            }
        }
    }
}

/// Steps of 0.2 m pass below its collider.
#[test]
fn stairs_are_a_slope_to_the_spring() {
    for &rate in some(&[30, 64, 144]) {
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
    let motions = [(Vector::X * 5.0, 0.0), (Vector::Y * 2.0, 0.0), (Vector::ZERO, 1.0)];
    for (rate, heights) in CASES {
        let motions = motions.iter().filter(|(_, turn)| *turn == 0.0 || spin::IS_LEVEL);
        let cases: Vec<_> =
            motions.flat_map(|motion| heights.iter().map(move |height| (*motion, *height))).collect();
        let starts = cases.iter().map(|((_, turn), height)| {
            let from = if *turn == 0.0 { Vector::ZERO } else { spin::START * 0.5 };
            (*height, from + Vector::Y * rest(*height))
        });
        let mut hall = Hall::side_by_side(rate, starts);
        let mut platforms = Vec::new();
        for (i, ((velocity, turn), _)) in cases.iter().enumerate() {
            let is_level = *turn == 0.0;
            let shape = if is_level { block(Vector::ONE * 8.0 - Vector::Y * 7.0) } else { spin::disc() };
            let body = (RigidBody::Kinematic, shape, Position(Vector::Y * -0.5));
            let motion = (LinearVelocity(*velocity), AngularVelocity(spin::velocity(*turn)));
            platforms.push(hall.spawn_in_lane(i, (body, motion)));
        }
        hall.walk(Vector::ZERO, 0.5);
        let offset = |hall: &Hall, i: usize| {
            let (p, q) = (hall.get::<Position>(platforms[i]).0, hall.get::<Rotation>(platforms[i]));
            q.inverse() * (hall.get::<Position>(hall.players[i]).0 - p)
        };
        let start: Vec<Vector> = (0..cases.len()).map(|i| offset(&hall, i)).collect();
        let paths = hall.walk_all(Vector::ZERO, 2.0);
        for (i, case) in cases.iter().enumerate() {
            assert!(paths[i].iter().all(|(_, state)| state.is_grounded()), "{rate}: {case:?}");
            let slip = (offset(&hall, i) - start[i]).length();
            assert!(slip < 0.02, "{rate}: {case:?}: it slips by {slip}");
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

/// Light crates rain on a mover that walks through them: what it steps on in the air is not thrown.
#[test]
fn it_throws_nothing_that_bears_nothing() {
    for rate in usual() {
        let mut hall = Hall::new(rate, 0.3, Vector::Y * rest(0.3));
        floor(&mut hall.app);
        let crates: Vec<Entity> = (0..50)
            .map(|i| {
                let (place, layer) = (i % 10, i / 10);
                let at =
                    Vector::X * (0.45 * place as Scalar - 2.0) + Vector::Y * (3.0 + 0.5 * layer as Scalar);
                let body = (RigidBody::Dynamic, block(Vector::ONE * 0.4), Mass(0.1), Position(at));
                hall.app.world_mut().spawn(body).id()
            })
            .collect();
        for velocity in [Vector::ZERO, Vector::X * 3.0] {
            for _ in 0..rate * 2 {
                hall.walk(velocity, 1.0 / rate as Scalar);
                let speeds = crates.iter().map(|of| hall.get::<LinearVelocity>(*of).0.length());
                let fastest = speeds.fold(0.0, Scalar::max);
                assert!(fastest < 15.0, "{rate}: a crate at {fastest} m/s, the mover {}", hall.position());
                let speed = hall.get::<LinearVelocity>(hall.player).0 * (Vector::ONE - Vector::Y);
                assert!(speed.length() < 3.3, "{rate}: the mover runs at {speed} m/s");
            }
        }
        assert!(hall.position().x > 4.5, "{rate}: the mover is stuck at {}", hall.position());
    }
}

/// A crate of 1 kg on the floor bears all of its weight, and gives as much to a jump as the floor.
#[test]
fn a_light_crate_on_the_floor_is_firm() {
    for rate in usual() {
        for aside in [0.0, 0.3] {
            let mut hall = Hall::new(rate, 0.3, Vector::Y * (rest(0.3) + 0.8) + Vector::X * aside);
            floor(&mut hall.app);
            let body = (RigidBody::Dynamic, block(Vector::ONE * 0.8), Mass(1.0), Position(Vector::Y * 0.4));
            hall.app.world_mut().spawn(body);
            hall.walk(Vector::ZERO, 1.5);
            let load = hall.state().load;
            assert!((load - 70.0 * 9.81).abs() < 1.0, "{rate}, {aside} m aside: it bears {load} N");
            hall.input().jump = 5.0;
            hall.walk(Vector::ZERO, 1.0 / rate as Scalar);
            let speed = hall.get::<LinearVelocity>(hall.player).0.y;
            assert!(
                (speed - 5.0 + 9.81 / rate as Scalar).abs() < 0.1,
                "{rate}, {aside} m aside: {speed} m/s"
            );
        }
    }
}

/// Who presses forward and jumps in the same tick from a moving platform goes on relative to that.
#[test]
fn a_jump_from_a_platform_keeps_all_of_its_velocity() {
    for rate in usual() {
        let mut hall = Hall::new(rate, 0.3, Vector::Y * (rest(0.3) + 0.1));
        let body =
            (RigidBody::Kinematic, block(Vector::ONE * 0.2 + Vector::X * 60.0), Position(Vector::ZERO));
        hall.app.world_mut().spawn((body, LinearVelocity(Vector::X * 5.0)));
        hall.walk(Vector::ZERO, 1.0);
        hall.input().jump = 5.0;
        hall.walk(Vector::X * 3.0, 0.5);
        let speed = hall.get::<LinearVelocity>(hall.player).0.dot(Vector::X);
        assert!((speed - 8.0).abs() < 0.05, "{rate}: {speed} m/s instead of 8");
    }
}

/// A hundred movers and crates have the same bits with one worker and three.
#[test]
fn workers_change_no_bits_of_movers() {
    let run = |workers| {
        let mut hall = Hall::new(60, 0.3, Vector::Y * rest(0.3));
        hall.app.insert_resource(WorkerCount(workers));
        floor(&mut hall.app);
        for i in 1..100 {
            let place = Vector::X * (1.3 * i as Scalar);
            let (mover, shape) = (DynamicMover::default(), Collider::capsule(0.4, 0.7));
            let at = Position(place + Vector::Y * rest(0.3));
            hall.players.push(hall.app.world_mut().spawn((mover, shape, Mass(70.0), at)).id());
            let at = Position(place + Vector::X * 0.65 + Vector::Y * 0.2);
            hall.app.world_mut().spawn((RigidBody::Dynamic, block(Vector::ONE * 0.3), Mass(1.0), at));
        }
        let paths = hall.walk_all(Vector::X * 3.0, 1.0);
        let velocities: Vec<_> =
            hall.players.iter().map(|player| hall.get::<LinearVelocity>(*player)).collect();
        (paths, velocities)
    };
    assert_eq!(run(1), run(3));
}

/// A raft without weight of its own, that a spring carries: it sinks by the weight of the mover.
#[test]
fn the_ground_bears_its_weight() {
    for (rate, heights) in CASES {
        let starts = heights.iter().map(|height| (*height, Vector::Y * (rest(*height) + 0.3)));
        let mut hall = Hall::side_by_side(rate, starts);
        let bearer = fixed(&mut hall.app, block(Vector::ONE * 0.1), Vector::Y * -3.0, Rotation::IDENTITY);
        let mut rafts = Vec::new();
        for i in 0..heights.len() {
            let raft = (
                RigidBody::Dynamic,
                block(Vector::ONE * 4.0 - Vector::Y * 3.5),
                Position(Vector::ZERO),
                (Mass(200.0), GravityScale(0.0), LockedAxes::ROTATION_LOCKED),
            );
            let raft = hall.spawn_in_lane(i, raft);
            // k = 200 · (2π)².
            let spring = MotorModel::SpringDamper { frequency: 1.0, damping_ratio: 1.0 };
            let motor = LinearMotor::new(spring).with_target_position(3.0);
            let slider = PrismaticJoint::new(bearer, raft).with_slider_axis(Vector::Y).with_motor(motor);
            hall.app.world_mut().spawn(slider);
            rafts.push(raft);
        }
        hall.walk(Vector::ZERO, 5.0);
        let expected = 70.0 * 9.81 / (200.0 * TAU * TAU);
        for (raft, height) in rafts.iter().zip(heights) {
            let sunk = -hall.get::<Position>(*raft).0.y;
            assert!((sunk / expected - 1.0).abs() < 0.05, "{rate}, {height}: {sunk} m, not {expected}");
        }
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

/// Movers whose layers exclude each other walk through each other at full speed, on ground of any layers.
#[test]
fn layers_of_their_own_do_not_stop_movers() {
    let layers = |own: u32, met: u32| CollisionLayers::new(LayerMask(own), LayerMask(met));
    // Of a mover, and of what it meets.
    let cases = [
        (layers(2, 1), CollisionLayers::DEFAULT),
        (layers(2, !2), CollisionLayers::DEFAULT),
        (layers(4, 8), layers(8, 4)),
        (layers(16, 32 | 64), layers(32, LayerMask::ALL.0)),
    ];
    for &rate in some(&[30, 64]) {
        let starts =
            cases.iter().flat_map(|_| [0.0, 0.3].map(|height| (height, Vector::Y * (rest(height) + 0.2))));
        let mut hall = Hall::side_by_side(rate, starts);
        for (i, (own, ground)) in cases.into_iter().enumerate() {
            for (k, way) in [1.0, -1.0].into_iter().enumerate() {
                let player = hall.players[2 * i + k];
                let input = CharacterInput { velocity: Vector::X * (3.0 * way), ..Default::default() };
                hall.app.world_mut().entity_mut(player).insert((own, input));
            }
            let floor = floor(&mut hall.app);
            hall.app.world_mut().entity_mut(floor).insert(ground);
        }
        let tick = Duration::from_secs_f64(1.0 / f64::from(rate));
        (0..2 * rate).for_each(|_| step(&mut hall.app, tick));
        for (i, &player) in hall.players.iter().enumerate() {
            let way = if i % 2 == 0 { 1.0 } else { -1.0 };
            let (at, velocity) = (hall.get::<Position>(player).0, hall.get::<LinearVelocity>(player).0);
            assert!(hall.get::<CharacterState>(player).is_grounded(), "{rate}, {i}: at {at}");
            assert!((velocity.x * way - 3.0).abs() < 0.05, "{rate}, {i}: {velocity} m/s");
            assert!(at.x * way > 5.0, "{rate}, {i}: at {at}");
        }
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
        stay_on_one_thread(&mut app);
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
