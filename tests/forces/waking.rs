//! Which forces wake bodies.

use super::*;

#[test]
fn a_force_wakes_and_moves_a_sleeping_body() {
    let pushes: [fn(&mut ForcesItem); 6] = [
        |forces| forces.apply_force(Vector::Y * 100.0),
        |forces| forces.apply_local_force(Vector::Y * 100.0),
        |forces| forces.apply_linear_impulse(Vector::Y * (90.0 * DT)),
        |forces| forces.apply_linear_acceleration(Vector::Y * 100.0),
        |forces| forces.apply_local_linear_acceleration(Vector::Y * 100.0),
        |forces| *forces.linear_velocity_mut() += Vector::Y * (90.0 * DT),
    ];
    for (i, push) in pushes.into_iter().enumerate() {
        let mut lab = Lab::new();
        let sleeper = lab.sleeper();
        lab.apply(sleeper, push);
        lab.step();
        assert!(!lab.sleeps(sleeper), "push {i} wakes it");
        let want = Vector::Y * if i == 2 || i == 5 { 80.0 * DT } else { 90.0 * DT };
        near(lab.velocity(sleeper), want, 0.02, "in the same step");
    }
    let mut lab = Lab::new();
    let sleeper = lab.sleeper();
    lab.apply(sleeper, |forces| forces.apply_torque(about_z(300.0)));
    lab.step();
    assert!(!lab.sleeps(sleeper), "a torque wakes it");
}

#[test]
fn a_force_of_zero_wakes_nothing() {
    let mut lab = Lab::new();
    let sleeper = lab.sleeper();
    for _ in 0..3 {
        lab.apply(sleeper, |forces| {
            apply_all(forces, Vector::ZERO, Angular::default());
            let same = forces.linear_velocity();
            *forces.linear_velocity_mut() = same;
            forces.reset_accumulated_linear_acceleration();
        });
        lab.step();
        assert!(lab.sleeps(sleeper));
    }
}

#[test]
fn forces_that_do_not_wake_leave_a_sleeping_body_alone() {
    let mut lab = Lab::new();
    let sleeper = lab.sleeper();
    let before = (lab.at(sleeper), lab.velocity(sleeper));
    for _ in 0..10 {
        lab.apply(sleeper, |forces| {
            apply_all(&mut forces.non_waking(), Vector::Y * 1000.0, about_z(1000.0));
            *forces.non_waking().linear_velocity_mut() += Vector::ZERO;
        });
        lab.step();
        assert!(lab.sleeps(sleeper));
    }
    assert_eq!((lab.at(sleeper), lab.velocity(sleeper)), before);
    // Nothing was kept for when it wakes.
    lab.app.world_mut().commands().queue(WakeBody(sleeper));
    lab.app.world_mut().flush();
    lab.steps(2);
    assert!(!lab.sleeps(sleeper));
    near(lab.velocity(sleeper), Vector::ZERO, 0.01, "awake");
    // Turned back, they wake.
    lab.steps(100);
    assert!(lab.sleeps(sleeper));
    lab.apply(sleeper, |forces| forces.non_waking().waking().apply_force(Vector::Y * 100.0));
    lab.step();
    assert!(!lab.sleeps(sleeper));
}

/// A force too weak to move a body keeps it awake; one that does not wake lets it fall asleep.
#[test]
fn an_awake_body_stays_awake_by_waking_forces_only() {
    let mut lab = Lab::new();
    let body = lab.sleeper();
    for (waking, sleeps) in [(true, false), (false, true)] {
        lab.apply(body, |forces| forces.apply_force(Vector::X * 0.1));
        for _ in 0..100 {
            lab.apply(body, |forces| {
                if waking {
                    forces.apply_force(Vector::X * 0.1);
                } else {
                    forces.non_waking().apply_force(Vector::X * 0.1);
                }
            });
            lab.step();
        }
        assert_eq!(lab.sleeps(body), sleeps, "waking: {waking}");
    }
}

/// Avian's issue 901.
#[test]
fn issue_a_force_that_was_applied_while_paused_did_not_wake_a_sleeping_body() {
    let pushes: [fn(&mut ForcesItem); 3] = [
        |forces| forces.apply_force(Vector::Y * 100.0),
        |forces| forces.apply_local_force(Vector::Y * 100.0),
        |forces| forces.apply_linear_impulse(Vector::Y * (100.0 * DT)),
    ];
    for push in pushes {
        let mut lab = Lab::new();
        let sleeper = lab.sleeper();
        lab.pause(true);
        lab.steps(20);
        lab.apply(sleeper, push);
        lab.steps(20);
        assert!(lab.sleeps(sleeper), "while paused nothing moves");
        lab.pause(false);
        lab.step();
        assert!(!lab.sleeps(sleeper));
        near(lab.velocity(sleeper), Vector::Y * (90.0 * DT), 0.02, "as if it had been applied now");
    }
}

#[test]
fn a_constant_force_wakes_when_it_comes_changes_and_goes() {
    let mut lab = Lab::new();
    let body = lab.sleeper();
    lab.app.world_mut().resource_mut::<Gravity>().0 = Vector::ZERO;
    lab.insert(body, ConstantForce(Vector::Y * -10.0));
    lab.steps(100);
    assert!(lab.sleeps(body), "pressed down, it sleeps again");
    lab.app.world_mut().get_mut::<ConstantForce>(body).expect("inserted").0 = Vector::Y * -11.0;
    lab.step();
    assert!(!lab.sleeps(body), "changed");
    lab.steps(100);
    assert!(lab.sleeps(body));
    lab.remove::<ConstantForce>(body);
    lab.step();
    assert!(!lab.sleeps(body), "removed");
    lab.steps(100);
    assert!(lab.sleeps(body));
    lab.insert(body, ConstantForce(Vector::Y * 10.0));
    lab.step();
    near(lab.velocity(body), Vector::Y * (10.0 * DT), 0.01, "inserted");
    lab.remove::<ConstantForce>(body);
    let before = lab.velocity(body);
    lab.steps(10);
    near(lab.velocity(body), before, 1e-6, "removal ends it");
}

/// The sleeping body of a level in which most bodies are awake, and of one in which most sleep.
#[test]
fn a_force_within_a_step_wakes_a_body_in_the_next() {
    #[derive(Resource)]
    struct Pushed(Entity, bool);
    for awake in [0, 50] {
        let mut lab = Lab::new();
        let sleeper = lab.sleeper();
        for i in 0..awake {
            lab.spawn((
                body(1.0, 1.0),
                GravityScale(0.0),
                Position(Vector::Y * (10.0 + i as Scalar)),
                SleepingDisabled,
            ));
        }
        lab.steps(2);
        assert!(lab.sleeps(sleeper));
        lab.app.insert_resource(Pushed(sleeper, true)).add_systems(
            PhysicsSchedule,
            (|mut bodies: Query<Forces>, mut pushed: ResMut<Pushed>| {
                if core::mem::take(&mut pushed.1) {
                    bodies.get_mut(pushed.0).expect("a body").apply_force(Vector::Y * 100.0);
                }
            })
            .in_set(PhysicsStepSystems::NarrowPhase),
        );
        lab.step();
        lab.step();
        assert!(!lab.sleeps(sleeper), "{awake} others are awake");
        near(lab.velocity(sleeper), Vector::Y * (90.0 * DT), 0.02, "its force was kept");
        lab.step();
        near(lab.velocity(sleeper), Vector::Y * (80.0 * DT), 0.02, "and acted once");
    }
}

#[test]
fn accelerations_written_by_hand_wake() {
    let mut lab = Lab::new();
    let sleeper = lab.sleeper();
    lab.insert(
        sleeper,
        VelocityIntegrationData { linear_increment: Vector::Y * 100.0, ..Default::default() },
    );
    lab.step();
    assert!(!lab.sleeps(sleeper));
    near(lab.velocity(sleeper), Vector::Y * (90.0 * DT), 0.02, "velocity");
}
