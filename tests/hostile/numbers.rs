//! Invalid masses, coefficients, settings and steps.
#![allow(clippy::unnecessary_cast, reason = "Scalar may be f32 or f64")]

use avian::{
    math::{AsF32, Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use bevy_time::Time;
use core::time::Duration;

use super::{
    dim,
    world::{
        WRONG, WRONG_SIZES, Witness, app, at, ball, corners, floor, is_disabled, position, resting, step_by,
        steps,
    },
};

#[test]
fn masses_that_are_none_leave_the_others_alone() {
    for wrong in WRONG_SIZES {
        let mut witness = Witness::new();
        let bodies = [
            witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 0.6), Mass(wrong as f32))),
            witness.spawn((RigidBody::Dynamic, ball(), at(2.0, 0.6), ColliderDensity(wrong as f32))),
            witness.spawn((RigidBody::Dynamic, ball(), at(4.0, 0.6), GravityScale(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(6.0, 0.6), LinearDamping(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(8.0, 0.6), AngularDamping(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(10.0, 0.6), MaxLinearSpeed(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(12.0, 0.6), MaxAngularSpeed(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(14.0, 0.6), Friction::new(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(16.0, 0.6), Restitution::new(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(18.0, 0.6), CollisionMargin(wrong.min(1.0)))),
            witness.spawn((RigidBody::Dynamic, ball(), at(20.0, 0.6), SpeculativeMargin(wrong))),
            witness.spawn((RigidBody::Dynamic, ball(), at(22.0, 0.6), dim::inertia(wrong as f32))),
            witness.spawn((
                RigidBody::Dynamic,
                ball(),
                at(26.0, 0.6),
                CenterOfMass(Vector::splat(wrong).f32()),
            )),
            witness.spawn((
                RigidBody::Dynamic,
                ball(),
                at(30.0, 0.6),
                SleepThreshold { linear: wrong as f32, angular: wrong as f32 },
            )),
        ];
        witness.is_undisturbed();
        for (i, body) in bodies.into_iter().enumerate() {
            let height = match (i, wrong) {
                // Without mass nothing holds it: it falls for 1.5 s.
                (0 | 1, _) => -10.457,
                // Gravity and top speed may be zero, gravity may be negative.
                (2 | 5, 0.0) => 0.6,
                (2, -1.0) => 11.657,
                (3, Scalar::INFINITY) => 0.586,
                // The margin is a metre.
                (9, wrong) if wrong.is_nan() || wrong > 0.0 => 1.5,
                _ => 0.5,
            };
            let at = position(&witness.app, body);
            assert!(!is_disabled(&witness.app, body), "body {i} with {wrong}");
            assert!((at.y - height).abs() < 0.002, "body {i} with {wrong} is at {at}");
        }
    }
}

#[test]
fn damping_of_nan_is_no_damping() {
    let mut app = app();
    let plain = app.world_mut().spawn((RigidBody::Dynamic, at(0.0, 0.0))).id();
    let damped = (LinearDamping(Scalar::NAN), AngularDamping(Scalar::NAN));
    let damped = app.world_mut().spawn((RigidBody::Dynamic, at(0.0, 0.0), damped)).id();
    steps(&mut app, 30);
    assert!(!is_disabled(&app, damped));
    assert_eq!(position(&app, plain), position(&app, damped));
}

#[test]
fn friction_without_bounds_sticks() {
    for mu in [Scalar::INFINITY, Scalar::MAX, 1.0e30] {
        let mut app = app();
        let friction = Friction::new(mu).with_combine_rule(CoefficientCombine::Multiply);
        app.world_mut().spawn((RigidBody::Static, Collider::half_space(Vector::X + Vector::Y), friction));
        let block = Collider::convex_hull(corners(0.5)).expect("a box is convex");
        let body = (RigidBody::Dynamic, block, friction, LockedAxes::ROTATION_LOCKED);
        let body = app.world_mut().spawn((body, at(0.5, 0.5))).id();
        steps(&mut app, 60);
        let moved = position(&app, body) - (Vector::X + Vector::Y) * 0.5;
        assert!(moved.length() < 0.05, "with friction {mu} it moved by {moved}");
    }
}

#[test]
fn a_dynamic_body_without_mass_falls() {
    let mut app = app();
    let body = app.world_mut().spawn(RigidBody::Dynamic).id();
    steps(&mut app, 60);
    assert!(position(&app, body).y < -4.0);
}

#[test]
fn locked_axes_hold_a_body_with_its_centre_of_mass_far_off() {
    let mut app = app();
    floor(&mut app);
    let compound = |x: Scalar| Collider::compound(vec![(Vector::X * x, Rotation::IDENTITY, ball())]);
    let body = (RigidBody::Dynamic, compound(3.0), LockedAxes::ALL_LOCKED, at(0.0, 0.3));
    let held = app.world_mut().spawn(body).id();
    let body = (RigidBody::Dynamic, compound(3.0), LockedAxes::ROTATION_LOCKED, at(10.0, 0.7));
    let upright = app.world_mut().spawn(body).id();
    steps(&mut app, 120);
    assert_eq!(position(&app, held), Vector::Y * 0.3 as Scalar);
    let at_rest = position(&app, upright);
    assert!((at_rest - Vector::X * 10.0 - Vector::Y * 0.5).length() < 0.02, "{at_rest}");
    let rotation = app.world().get::<Rotation>(upright).expect("a body has a rotation");
    assert_eq!(*rotation, Rotation::IDENTITY);
}

#[test]
fn gravity_that_is_not_finite_is_none() {
    for wrong in WRONG {
        let mut witness = Witness::new();
        witness.app.insert_resource(Gravity(Vector::Y * wrong));
        let free = witness.spawn((RigidBody::Dynamic, at(0.0, 5.0)));
        steps(&mut witness.app, 10);
        assert_eq!(position(&witness.app, free), Vector::Y * 5.0);
        witness.app.insert_resource(Gravity::default());
        witness.is_undisturbed();
    }
}

#[test]
fn a_length_unit_that_is_no_length_counts_as_one() {
    for wrong in WRONG_SIZES {
        let mut witness = Witness::new();
        witness.app.insert_resource(PhysicsLengthUnit(wrong));
        witness.is_undisturbed();
    }
}

#[test]
fn settings_that_are_none_are_survived() {
    use avian::dynamics::solver::SolverConfig;
    for wrong in WRONG_SIZES {
        let mut witness = Witness::new();
        witness.app.insert_resource(SolverConfig {
            contact_damping_ratio: wrong,
            contact_frequency_factor: wrong,
            max_overlap_solve_speed: wrong,
            warm_start_coefficient: wrong,
            restitution_threshold: wrong,
            restitution_iterations: 0,
        });
        let narrow = NarrowPhaseConfig {
            default_speculative_margin: wrong,
            contact_tolerance: wrong,
            match_contacts: false,
        };
        witness.app.insert_resource(narrow).insert_resource(TimeToSleep(wrong as f32));
        let falling = witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 1.0)));
        steps(&mut witness.app, 60);
        let at = position(&witness.app, falling);
        assert!(!is_disabled(&witness.app, falling) && (0.4..0.51).contains(&at.y), "with {wrong} at {at}");
    }
}

#[test]
fn a_step_of_no_time_changes_nothing() {
    let mut witness = Witness::new();
    let falling = witness.spawn((RigidBody::Dynamic, ball(), at(0.0, 3.0)));
    let overlapping = witness.spawn((RigidBody::Dynamic, ball(), at(5.0, 0.2)));
    steps(&mut witness.app, 1);
    let before = [falling, overlapping, witness.ball].map(|e| position(&witness.app, e));
    witness.app.world_mut().resource_mut::<Time<Physics>>().advance_by(Duration::ZERO);
    for _ in 0..3 {
        witness.app.world_mut().run_schedule(PhysicsSchedule);
    }
    let after = [falling, overlapping, witness.ball].map(|e| position(&witness.app, e));
    assert_eq!(before, after);
    witness.is_undisturbed();
}

#[test]
fn steps_of_ten_seconds_and_of_a_nanosecond_move_nobody() {
    for dt in [Duration::from_secs(10), Duration::from_nanos(1), Duration::from_secs(100_000)] {
        let mut app = app();
        floor(&mut app);
        let bodies: Vec<Entity> = (0..10).map(|i| resting(&mut app, 0.4 * i as f32)).collect();
        (0..20).for_each(|_| step_by(&mut app, dt));
        // They overlap each other by more than half, and none is thrown or sinks.
        for (i, body) in bodies.iter().enumerate() {
            let at = position(&app, *body);
            let is_there = (at.x - 0.4 * i as Scalar).abs() < 0.02 && (0.24..0.51).contains(&at.y);
            assert!(is_there, "steps of {dt:?}: {at}");
        }
        let late = resting(&mut app, -30.0);
        steps(&mut app, 60);
        assert!((position(&app, late).y - 0.5).abs() < 0.02, "after steps of {dt:?}");
    }
}

#[test]
fn no_substeps_count_as_one_and_a_thousand_are_taken() {
    for count in [0, 1, 1000] {
        let mut witness = Witness::new();
        witness.app.insert_resource(SubstepCount(count));
        witness.is_undisturbed();
    }
}
