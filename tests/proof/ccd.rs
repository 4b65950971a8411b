//! Continuous collision: nothing passes what does not move, and swept bodies pass nothing that moves.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::{hierarchy::ChildOf, prelude::*};
use bevy_transform::components::Transform;
use scenes::scene::at;

use super::{dim, world::Lab};

const SPEEDS: [f32; 3] = [20.0, 200.0, 1000.0];

fn lab() -> Lab {
    let mut lab = Lab::with_steps(1.0 / 64.0, 6);
    lab.gravity(Vector::ZERO);
    lab.surfaces(0.0, 0.0);
    lab
}

/// How many of 12 balls of 5 cm that are shot at x = 0, from all phases of a step, are beyond it in the end.
fn through(speed: f32, settle: impl Fn(&mut Lab, Entity), wall: impl Fn(&mut Lab)) -> usize {
    let mut lab = lab();
    wall(&mut lab);
    let balls: Vec<_> = (0..12)
        .map(|k| {
            let away = 0.3 + speed / 64.0 * (k as f32 / 12.0);
            let ball = lab.ball(0.025, at(-away, 0.2 * k as f32 - 1.13, 0.07));
            lab.insert(ball, LinearVelocity(Vector::X * speed as Scalar));
            settle(&mut lab, ball);
            ball
        })
        .collect();
    lab.steps(30);
    balls.into_iter().filter(|ball| lab.at(*ball).x > 0.1).count()
}

fn plate() -> Collider {
    dim::sized_block(0.01, 8.0, 8.0)
}

fn discrete(lab: &mut Lab, ball: Entity) {
    lab.insert(ball, SpeculativeMargin::ZERO);
}

/// A wall that moves by its velocity, which is none.
fn kinematic(lab: &mut Lab) {
    lab.spawn((RigidBody::Kinematic, plate(), Transform::default(), SpeculativeMargin::ZERO));
}

/// A wall that is too heavy to be moved.
fn heavy(lab: &mut Lab) {
    lab.spawn((
        RigidBody::Dynamic,
        plate(),
        Transform::default(),
        ColliderDensity(1.0e6),
        SpeculativeMargin::ZERO,
    ));
}

#[test]
fn no_ball_passes_a_static_wall_of_any_kind() {
    let mut walls: Vec<(&str, Box<dyn Fn(&mut Lab)>)> = vec![
        ("box", Box::new(|lab| _ = lab.spawn((RigidBody::Static, plate(), Transform::default())))),
        ("no body", Box::new(|lab| _ = lab.spawn((plate(), Transform::default())))),
        (
            "child",
            Box::new(|lab| {
                let body = lab.spawn((RigidBody::Static, at(0.0, 1.0, 0.0)));
                lab.spawn((ChildOf(body), plate(), at(0.0, -1.0, 0.0)));
            }),
        ),
        (
            "compound",
            Box::new(|lab| {
                let parts = vec![(Vector::ZERO, Rotation::IDENTITY, plate())];
                lab.spawn((RigidBody::Static, Collider::compound(parts)));
            }),
        ),
    ];
    walls.extend(dim::thin_walls().into_iter().map(|(name, wall)| {
        let spawn =
            move |lab: &mut Lab| _ = lab.spawn((RigidBody::Static, wall.clone(), Transform::default()));
        (name, Box::new(spawn) as Box<dyn Fn(&mut Lab)>)
    }));
    let mut bad = Vec::new();
    for (name, wall) in &walls {
        for speed in SPEEDS {
            let counts = [through(speed, |_, _| {}, wall), through(speed, discrete, wall)];
            if counts != [0, 0] {
                bad.push((*name, speed, counts));
            }
        }
    }
    assert!(bad.is_empty(), "wall, speed, through of 12 by default and without margin: {bad:#?}");
}

#[test]
fn balls_pass_what_moves_only_without_margin_and_sweep() {
    for (name, wall) in [("kinematic", kinematic as fn(&mut Lab)), ("dynamic", heavy)] {
        for speed in SPEEDS {
            assert_eq!(through(speed, |_, _| {}, wall), 0, "{name} at {speed} by default");
            for swept in [SweptCcd::LINEAR, SweptCcd::NON_LINEAR] {
                let settle = |lab: &mut Lab, ball: Entity| {
                    discrete(lab, ball);
                    lab.insert(ball, swept);
                };
                assert_eq!(through(speed, settle, wall), 0, "{name} at {speed} with {swept:?}");
            }
            let passed = through(speed, discrete, wall);
            assert!(passed > 0, "{name} at {speed}: the margin of 0 has no effect");
        }
    }
}

#[test]
fn sweeps_leave_out_what_they_are_told_to() {
    let settle = |swept: SweptCcd| {
        move |lab: &mut Lab, ball: Entity| {
            discrete(lab, ball);
            lab.insert(ball, swept);
        }
    };
    let speed = 200.0;
    let all = SweptCcd::NON_LINEAR;
    assert_eq!(through(speed, settle(all.include_dynamic(false)), kinematic), 0, "a kinematic wall");
    assert!(through(speed, settle(all.include_dynamic(false)), heavy) > 0, "a dynamic wall is left out");
    let slow = all.with_velocity_threshold(100.0, 100.0);
    assert_eq!(through(speed, settle(slow), heavy), 0, "faster than the threshold");
    let fast = all.with_velocity_threshold(300.0, 300.0);
    assert!(through(speed, settle(fast), heavy) > 0, "slower than the threshold");
    let sensor = |lab: &mut Lab| _ = lab.spawn((RigidBody::Static, plate(), Transform::default(), Sensor));
    assert_eq!(through(speed, settle(all), sensor), 12, "a sensor");
    let other = |lab: &mut Lab| {
        let layers = CollisionLayers::new(0b10u32, 0b10u32);
        lab.spawn((RigidBody::Static, plate(), Transform::default(), layers));
        lab.spawn((RigidBody::Kinematic, plate(), Transform::default(), layers));
    };
    let own = |lab: &mut Lab, ball: Entity| {
        lab.insert(ball, (all, CollisionLayers::new(0b1u32, 0b1u32)));
    };
    assert_eq!(through(speed, own, other), 12, "another layer");
}

/// A collider without a body stops what would get past it in a step, and nothing that is slower.
#[test]
fn what_tumbles_falls_freely_through_a_collider_without_a_body() {
    let fall = |is_there: bool| {
        let mut lab = Lab::with_steps(1.0 / 64.0, 6);
        if is_there {
            lab.spawn((dim::sized_block(8.0, 2.0, 8.0), Transform::default()));
        }
        let block = dim::sized_block(1.0, 1.0, 1.0);
        let spin = AngularVelocity(dim::about_z(8.0));
        let body = lab.spawn((RigidBody::Dynamic, block, at(0.0, 2.0, 0.0), spin));
        lab.steps(64);
        lab.at(body).y
    };
    assert_eq!(fall(true).to_bits(), fall(false).to_bits());
}

/// A ball at rest beside a bar that turns by 0.6 rad in a step, both without margin: whether it is hit.
fn is_hit(swept: Option<SweptCcd>, phase: f32) -> bool {
    let mut lab = lab();
    let bar = dim::sized_block(2.0, 0.02, 0.02);
    let velocity = AngularVelocity(dim::about_z(40.0));
    lab.spawn((
        RigidBody::Kinematic,
        bar,
        Transform::from_rotation(scenes::scene::turned(phase)),
        velocity,
        SpeculativeMargin::ZERO,
    ));
    let ball = lab.ball(0.02, at(0.0, 0.9, 0.0));
    discrete(&mut lab, ball);
    if let Some(swept) = swept {
        lab.insert(ball, swept);
    }
    // Less than half a turn.
    (0..4).any(|_| {
        lab.steps(1);
        lab.velocity(ball).length() > 0.0
    })
}

#[test]
fn a_turning_bar_hits_what_is_swept_with_turning() {
    let hits = |swept| (0..12).filter(|k| is_hit(swept, 0.1 * *k as f32)).count();
    assert_eq!(hits(Some(SweptCcd::NON_LINEAR)), 12);
    assert!(hits(Some(SweptCcd::LINEAR)) < 12, "a bar that turns is missed");
    assert!(hits(None) < 12, "a bar that turns is missed");
}
