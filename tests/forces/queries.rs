//! Forces beside other parameters of systems.

use super::*;

/// Avian's issue 877.
#[test]
fn issue_reading_the_velocity_beside_forces_panicked() {
    fn push(mut bodies: Query<(&LinearVelocity, &AngularVelocity, Forces)>, mut runs: Local<u32>) {
        *runs += 1;
        for (velocity, spin, mut forces) in &mut bodies {
            let before = (velocity.0, spin.0);
            forces.apply_force(Vector::X * 2.0);
            if *runs == 1 {
                forces.apply_linear_impulse(Vector::Y * 2.0);
                forces.apply_linear_impulse(Vector::Y * 2.0);
                forces.apply_angular_impulse(about_z(1.0));
                *forces.linear_velocity_mut() += Vector::Y;
                assert_eq!(forces.linear_velocity(), before.0 + Vector::Y * 3.0);
                assert_eq!(forces.reborrow().angular_velocity(), about_z(1.0));
            }
            assert_eq!((velocity.0, spin.0), before, "what the query reads stays");
        }
    }
    let mut lab = Lab::new();
    lab.app.add_systems(Update, push.before(PhysicsSystems::First));
    let body = lab.spawn(body(2.0, 1.0));
    lab.steps(64);
    near(lab.velocity(body), Vector::new_xy(1.0, 3.0), 1e-5, "velocity");
    near(lab.spin(body), about_z(1.0), 1e-6, "angular velocity");
    let t = 1.0;
    near(lab.at(body), Vector::new_xy(0.5 * t * (t + H), 3.0), 1e-4, "from the first step on");
}

#[test]
fn impulses_beside_a_read_velocity_add_to_what_the_app_writes_later() {
    let mut lab = Lab::new();
    let sleeper = lab.sleeper();
    let world = lab.app.world_mut();
    let mut query = world.query::<(&LinearVelocity, Forces)>();
    let (velocity, mut forces) = query.get_mut(world, sleeper).expect("a body");
    forces.apply_linear_impulse(Vector::Y);
    assert_eq!(forces.linear_velocity(), velocity.0 + Vector::Y);
    // By another query, before the next step.
    lab.apply(sleeper, |forces| {
        near(forces.linear_velocity(), Vector::Y, 0.05, "it is seen");
        *forces.linear_velocity_mut() += Vector::Y;
    });
    near(lab.velocity(sleeper), Vector::Y * 2.0, 0.05, "both were written");
    lab.step();
    assert!(!lab.sleeps(sleeper));
    near(lab.velocity(sleeper), Vector::Y * (2.0 - 10.0 * DT), 0.05, "once");
}

#[test]
fn an_impulse_beside_a_read_velocity_wakes() {
    let mut lab = Lab::new();
    let sleeper = lab.sleeper();
    let world = lab.app.world_mut();
    let mut query = world.query::<(&LinearVelocity, Forces)>();
    query.get_mut(world, sleeper).expect("a body").1.apply_linear_impulse(Vector::Y);
    lab.step();
    assert!(!lab.sleeps(sleeper));
    near(lab.velocity(sleeper), Vector::Y * (1.0 - 10.0 * DT), 0.05, "in this step");
}

/// Bevy asks the parts of a query one by one, so it cannot work in this order. It must not go unnoticed.
#[test]
#[should_panic(expected = "conflicts with a previous access in this query")]
fn a_velocity_that_is_read_after_forces_is_refused() {
    let mut world = World::new();
    world.query::<(Forces, &LinearVelocity)>();
}

#[test]
#[should_panic(expected = "conflicts with a previous access in this query")]
fn a_velocity_that_is_written_beside_forces_is_refused() {
    let mut world = World::new();
    world.query::<(&mut LinearVelocity, Forces)>();
}

#[test]
fn forces_are_read_without_writing() {
    fn read(bodies: Query<ForcesReadOnly>, velocities: Query<&LinearVelocity>, mut runs: Local<u32>) {
        for forces in &bodies {
            assert_eq!(forces.linear_velocity(), Vector::X);
            assert_eq!(forces.velocity_at_point(forces.position().0), Vector::X);
            assert_eq!(forces.accumulated_linear_acceleration(), Vector::ZERO);
            assert_eq!(*forces.rotation(), Rotation::default());
        }
        assert_eq!((bodies.iter().count(), velocities.iter().count()), (1, 1));
        *runs += 1;
    }
    let mut lab = Lab::new();
    lab.app.add_systems(Update, read);
    let body = lab.spawn((body(1.0, 1.0), LinearVelocity(Vector::X)));
    lab.steps(2);
    let world = lab.app.world_mut();
    let mut writers = world.query::<Forces>();
    assert_eq!(writers.get(world, body).expect("a body").linear_velocity(), Vector::X);
}

#[test]
fn many_threads_apply_the_same_forces_as_one() {
    fn push(mut forces: ForcesItem) {
        let place = forces.position().0;
        forces.apply_force_at_point(Vector::Y * 5.0, place + Vector::X);
        forces.apply_local_force(place * 0.1);
        forces.apply_linear_impulse(Vector::Y * 0.1);
    }
    fn in_parallel(mut bodies: Query<Forces>) {
        bodies.par_iter_mut().for_each(push);
    }
    fn in_turn(mut bodies: Query<Forces>) {
        bodies.iter_mut().for_each(push);
    }
    let run = |parallel: bool| {
        let mut lab = Lab::new();
        let bodies: Vec<_> = (0..700)
            .map(|i| lab.spawn((body(1.0 + i as f32, 2.0), Position(Vector::X * (3.0 * i as Scalar)))))
            .collect();
        if parallel {
            lab.app.add_systems(Update, in_parallel.before(PhysicsSystems::First));
        } else {
            lab.app.add_systems(Update, in_turn.before(PhysicsSystems::First));
        }
        lab.steps(20);
        bodies.iter().map(|body| (lab.at(*body), lab.velocity(*body), lab.spin(*body))).collect::<Vec<_>>()
    };
    let [one, many] = [false, true].map(run);
    assert!(one == many && one.iter().all(|(_, velocity, _)| velocity.y > 0.004));
}

#[test]
fn a_body_query_gives_what_moves_a_body() {
    let mut lab = Lab::new();
    let dynamic =
        lab.spawn((body(2.0, 4.0), Dominance(3), LinearVelocity(Vector::X), AngularVelocity(about_z(2.0))));
    let fixed = lab.spawn((RigidBody::Static, cube(), Sensor, Dominance(5)));
    let world = lab.app.world_mut();
    let mut query = world.query::<RigidBodyQuery>();
    {
        let body = query.get(world, dynamic).expect("a body");
        assert!(body.rb.is_dynamic() && !body.is_sleeping && !body.is_sensor && body.friction.is_none());
        assert_eq!((body.entity, body.dominance(), body.mass().value()), (dynamic, 3, 2.0));
        assert_eq!(body.velocity_at_point(Vector::X * 3.0), Vector::new_xy(1.0, 6.0));
        assert_eq!(body.effective_inverse_mass(), Vector::ONE * 0.5);
        let fixed = query.get(world, fixed).expect("a body");
        assert!(fixed.is_sensor && fixed.mass().is_infinite() && fixed.angular_inertia().is_infinite());
        assert!(fixed.effective_global_angular_inertia().is_infinite());
        assert_eq!((fixed.effective_inverse_mass(), fixed.dominance()), (Vector::ZERO, 128));
    }
    world.entity_mut(dynamic).insert(LockedAxes::ROTATION_LOCKED.lock_translation_y());
    let mut body = query.get_mut(world, dynamic).expect("a body");
    assert_eq!(body.effective_inverse_mass() * 2.0, Vector::ONE - Vector::Y);
    assert!(body.effective_global_angular_inertia().is_infinite());
    body.linear_velocity.0 = Vector::Y;
    assert_eq!(lab.velocity(dynamic), Vector::Y);
}
