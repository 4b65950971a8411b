//! Crowds: a hundred characters in a corridor, and a thousand on a mesh.

use super::{ASIDE, SKIN, app, block, figures, fixed, floor, some, step, terrain, usual};
use avian::{
    character_controller::controller::CharacterState, collision::collider::contact_query::contact,
    dynamics::solver::WorkerCount, math::*, prelude::*,
};
use bevy_app::App;
use bevy_ecs::prelude::*;
use core::time::Duration;

const STANDING: Scalar = 0.9 + SKIN;

/// A world with characters of all figures.
struct Crowd {
    app: App,
    rate: u32,
    all: Vec<Entity>,
}

impl Crowd {
    fn new(rate: u32, friends: LayerMask, all: impl Iterator<Item = (Vector, Vector)>) -> Self {
        let mut app = app();
        app.insert_resource(Gravity(Vector::NEG_Y * 9.81));
        let figures = figures();
        let spawn = |(i, (at, velocity)): (usize, (Vector, Vector))| {
            let controller = CharacterController { friends, ..Default::default() };
            let input = CharacterInput { velocity, ..Default::default() };
            let shape = figures[i % figures.len()].1.clone();
            app.world_mut().spawn((controller, input, shape, Position(at))).id()
        };
        let all = all.enumerate().map(spawn).collect();
        Self { app, rate, all }
    }

    fn tick(&mut self) {
        step(&mut self.app, Duration::from_secs_f64(1.0 / f64::from(self.rate)));
    }

    fn positions(&self) -> Vec<Vector> {
        self.all.iter().map(|one| self.app.world().get::<Position>(*one).expect("a body").0).collect()
    }

    fn states(&self) -> Vec<CharacterState> {
        self.all.iter().map(|one| *self.app.world().get(*one).expect("a character")).collect()
    }

    /// The deepest overlap of two of them.
    fn deepest(&self) -> Scalar {
        let at = self.positions();
        let shape = |i: usize| self.app.world().get::<Collider>(self.all[i]).expect("a collider");
        let mut deepest: Scalar = 0.0;
        for i in 0..at.len() {
            for j in 0..i {
                let between = at[i] - at[j];
                if between.dot(Vector::X).abs() > 0.8 || between.dot(ASIDE).abs() > 0.8 {
                    continue;
                }
                let turn = Rotation::IDENTITY;
                let found = contact(shape(i), at[i], turn, shape(j), at[j], turn, 0.0).expect("known shapes");
                deepest = found.map_or(deepest, |contact| deepest.max(contact.penetration));
            }
        }
        deepest
    }
}

/// Fifty each way in a corridor 2 m wide, two abreast in space.
fn corridor(rate: u32, friends: LayerMask) -> Crowd {
    let places = (0..100).map(|i| {
        let way = if i % 2 == 0 { 1.0 } else { -1.0 };
        let abreast = if ASIDE == Vector::ZERO { 1 } else { 2 };
        let (row, side) = (i / 2 / abreast, i / 2 % abreast);
        let at = Vector::X * (way * -(1.0 + 0.9 * row as Scalar)) + ASIDE * (0.45 - 0.9 * side as Scalar);
        (at + Vector::Y * STANDING, Vector::X * (3.0 * way))
    });
    let mut crowd = Crowd::new(rate, friends, places);
    floor(&mut crowd.app);
    for side in [-1.0, 1.0] {
        if ASIDE != Vector::ZERO {
            let wall = block(Vector::ONE * 3.0 + Vector::X * 120.0);
            fixed(&mut crowd.app, wall, ASIDE * (2.5 * side) + Vector::Y * 1.6, Rotation::IDENTITY);
        }
    }
    crowd
}

/// Strangers that meet in the corridor stand still before each other: none is run over, lifted or
/// pushed into a wall.
#[test]
fn a_hundred_strangers_queue_in_a_narrow_corridor() {
    for &rate in some(&[30, 60]) {
        let mut crowd = corridor(rate, LayerMask::NONE);
        let closing = 6.0 / rate as Scalar;
        for tick in 0..5 * rate / 2 {
            crowd.tick();
            for (i, at) in crowd.positions().into_iter().enumerate() {
                assert!((at.y - STANDING).abs() < 2.0e-4, "{rate}, tick {tick}: {i} at {at}");
                assert!(
                    at.dot(ASIDE).abs() < 0.6 - SKIN + 1.0e-3,
                    "{rate}, tick {tick}: {i} in a wall, {at}"
                );
            }
            if tick % 10 == 0 {
                let depth = crowd.deepest();
                assert!(depth < closing, "{rate}, tick {tick}: an overlap of {depth}");
            }
        }
        assert!(crowd.deepest() < 2.0e-3, "{rate}: {}", crowd.deepest());
        assert!(crowd.states().iter().all(CharacterState::is_grounded), "{rate}");
        let before = crowd.positions();
        (0..rate / 2).for_each(|_| crowd.tick());
        let moved = crowd.positions().into_iter().zip(before).map(|(a, b)| (a - b).length());
        let moved = moved.fold(0.0, Scalar::max);
        assert!(moved < 0.02, "{rate}: one moved by {moved} in the jam");
    }
}

/// Two that walk at each other stand still where they met, at any rate: each moves out by half of what
/// they overlap.
#[test]
fn two_that_meet_do_not_shake() {
    for rate in usual() {
        for apart in [3.0, 3.01, 3.03] {
            let ways = [-1.0, 1.0].map(|way| (Vector::X * (0.5 * apart * way), Vector::X * (-3.0 * way)));
            let places = ways.map(|(at, velocity)| (at + Vector::Y * STANDING, velocity));
            let mut crowd = Crowd::new(rate, LayerMask::NONE, places.into_iter());
            floor(&mut crowd.app);
            (0..rate).for_each(|_| crowd.tick());
            let before = crowd.positions();
            assert!(crowd.deepest() < 1.0e-3, "{rate}, {apart} m: {}", crowd.deepest());
            for tick in 0..rate / 4 {
                crowd.tick();
                for (at, start) in crowd.positions().into_iter().zip(&before) {
                    let moved = (at - start).length();
                    assert!(moved < 1.0e-3, "{rate}, {apart} m, tick {tick}: one moved by {moved}");
                }
            }
        }
    }
}

/// Friends pass through each other, and none is pushed back.
#[test]
fn a_hundred_friends_pass_in_a_narrow_corridor() {
    let mut crowd = corridor(30, LayerMask::ALL);
    let start = crowd.positions();
    for tick in 0..3 * 30 {
        crowd.tick();
        for (i, at) in crowd.positions().into_iter().enumerate() {
            assert!((at.y - STANDING).abs() < 5.0e-3, "tick {tick}: {i} at {at}");
            assert!(at.dot(ASIDE).abs() < 0.6 - SKIN + 1.0e-3, "tick {tick}: {i} in a wall, {at}");
        }
    }
    for (i, (from, to)) in start.into_iter().zip(crowd.positions()).enumerate() {
        let walked = (to.x - from.x) * if i % 2 == 0 { 1.0 } else { -1.0 };
        assert!(walked > 6.0 && walked < 11.0, "{i}: {walked} m of 9");
    }
}

/// Crates fall between characters and on them: these stand as they stood, and no crate is thrown.
#[test]
fn crates_that_rain_on_characters_move_nobody() {
    let places = (0..5).map(|i| (Vector::X * i as Scalar + Vector::Y * STANDING, Vector::ZERO));
    let mut crowd = Crowd::new(60, LayerMask::NONE, places);
    floor(&mut crowd.app);
    let shape = block(Vector::ONE * 0.4);
    let crates: Vec<Entity> = (0..100)
        .map(|i| {
            let (row, place, layer) = (i / 50, i % 10, i / 10 % 5);
            let at = Vector::X * (0.45 * place as Scalar)
                + Vector::Y * (3.0 + 0.5 * (layer + 5 * row) as Scalar)
                + ASIDE * (0.45 * row as Scalar - 0.25);
            crowd.app.world_mut().spawn((RigidBody::Dynamic, shape.clone(), Position(at))).id()
        })
        .collect();
    (0..10).for_each(|_| crowd.tick());
    let before = crowd.positions();
    for tick in 0..3 * 60 {
        crowd.tick();
        let moved = crowd.positions().into_iter().zip(&before).map(|(at, start)| (at - start).length());
        let moved = moved.fold(0.0, Scalar::max);
        assert!(moved < 2.0e-3, "tick {tick}: a character moved by {moved}");
        for of in &crates {
            let world = crowd.app.world();
            let (at, velocity) = (world.get::<Position>(*of), world.get::<LinearVelocity>(*of));
            let (at, speed) = (at.expect("a body").0, velocity.expect("a body").0.length());
            assert!(at.y > 0.15 && speed < 12.0, "tick {tick}: a crate at {at} with {speed} m/s");
        }
    }
}

/// The height of a hilly level.
fn hill(x: Scalar) -> Scalar {
    0.6 * (x * 0.7).sin() + 0.3 * (x * 1.9 + 1.0).sin()
}

/// A thousand on hills; with the same bits on any number of threads, and again.
#[test]
fn a_thousand_on_a_mesh_stay_on_it_and_do_the_same_on_any_number_of_threads() {
    let abreast = if ASIDE == Vector::ZERO { 1 } else { 5 };
    let half = 0.6 * (1000 / abreast) as Scalar;
    let run = |workers| {
        let places = (0..1000).map(|i| {
            let x = 1.2 * (i / abreast) as Scalar - half + 0.6;
            let aside = ASIDE * (1.4 * (i % abreast) as Scalar - 2.8);
            let velocity = Vector::X * (if i % 2 == 0 { 1.5 } else { -1.0 });
            (Vector::X * x + Vector::Y * (hill(x) + 1.3) + aside, velocity)
        });
        let mut crowd = Crowd::new(30, LayerMask::NONE, places);
        crowd.app.insert_resource(WorkerCount(workers));
        let corner = |i: i32| Vector::X * (0.25 * i as Scalar) + Vector::Y * hill(0.25 * i as Scalar);
        let end = (4.0 * half) as i32 + 20;
        let level = terrain(&(-end..=end).map(corner).collect::<Vec<_>>());
        fixed(&mut crowd.app, level, Vector::ZERO, Rotation::IDENTITY);
        (0..20).for_each(|_| crowd.tick());
        (crowd.positions(), crowd.states())
    };
    let (places, states) = run(1);
    for (at, state) in places.iter().zip(&states) {
        let above = at.y - hill(at.x);
        assert!(above > 0.85 && above < 1.4, "{above} m above the ground at {at}");
        assert!(state.is_grounded(), "{state:?} at {at}");
    }
    assert_eq!(run(3), (places, states));
}
