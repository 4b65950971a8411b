//! When forces act, and how long.

use super::*;

#[test]
fn a_force_on_a_body_of_this_frame_acts_in_its_first_step() {
    fn spawn(mut commands: Commands, mut done: Local<bool>) {
        if !core::mem::replace(&mut *done, true) {
            commands.spawn((
                RigidBody::Dynamic,
                cube(),
                Mass(2.0),
                Transform::from_xyz(3.0, 1.0, 0.0)
                    .with_rotation(Quat::from_rotation_z(core::f32::consts::PI)),
            ));
        }
    }
    fn push(mut bodies: Query<Forces, Added<RigidBody>>) {
        for mut forces in &mut bodies {
            let place = Vector::new_xy(3.0, 1.0);
            near(forces.position().0, place, 1e-6, "it has its place");
            forces.apply_force_at_point(Vector::X * 4.0, place);
            forces.apply_local_force(Vector::Y * 4.0);
        }
    }
    let mut lab = Lab::new();
    lab.app.add_systems(Update, (spawn, push).chain().before(PhysicsSystems::First));
    lab.step();
    let mut query = lab.app.world_mut().query_filtered::<Entity, With<RigidBody>>();
    let body = query.single(lab.app.world()).expect("one body");
    near(lab.velocity(body), Vector::new_xy(2.0 * DT, -2.0 * DT), 1e-5, "the first step");
    near(z_of(lab.spin(body)), 0.0, 1e-5, "through its centre of mass");
}

/// Whether forces that a system in a schedule and set applies count in the same step.
fn counts_in_the_same_step(schedule: impl ScheduleLabel, set: impl SystemSet) -> bool {
    #[derive(Resource)]
    struct Push(bool);
    let mut lab = Lab::new();
    let body = lab.spawn(body(1.0, 1.0));
    lab.app.insert_resource(Push(false)).add_systems(
        schedule,
        (|mut bodies: Query<Forces>, mut push: ResMut<Push>| {
            if core::mem::take(&mut push.0) {
                bodies.iter_mut().for_each(|mut forces| {
                    forces.apply_force(Vector::X * 64.0);
                    forces.apply_local_force(Vector::Y * 64.0);
                });
            }
        })
        .in_set(set),
    );
    lab.steps(2);
    lab.app.world_mut().resource_mut::<Push>().0 = true;
    lab.step();
    let first = lab.velocity(body);
    lab.steps(3);
    near(lab.velocity(body), Vector::new_xy(1.0, 1.0), 1e-5, "it acts once");
    first == lab.velocity(body)
}

#[test]
fn forces_within_a_step_count_until_the_solver_begins() {
    assert!(counts_in_the_same_step(PhysicsSchedule, PhysicsStepSystems::First));
    assert!(counts_in_the_same_step(PhysicsSchedule, PhysicsStepSystems::BroadPhase));
    assert!(counts_in_the_same_step(PhysicsSchedule, NarrowPhaseSystems::Last));
    assert!(!counts_in_the_same_step(PhysicsSchedule, SolverSystems::PreSubstep));
    assert!(!counts_in_the_same_step(PhysicsSchedule, SolverSystems::Finalize));
    assert!(!counts_in_the_same_step(PhysicsSchedule, PhysicsStepSystems::Last));
}

#[test]
fn forces_within_a_substep_count_in_the_next_step() {
    assert!(!counts_in_the_same_step(
        SubstepSchedule,
        avian::dynamics::solver::schedule::SubstepSolverSystems::SolveConstraints
    ));
}

/// The velocity after `seconds` of an app that draws 144 frames a second and takes 64 steps.
fn after(seconds: u32, schedule: impl ScheduleLabel) -> (Scalar, u32) {
    #[derive(Resource, Default)]
    struct Runs(u32);
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TimePlugin, TransformPlugin, PhysicsPlugins::default()));
    app.insert_resource(TimeUpdateStrategy::ManualDuration(Duration::from_secs_f64(1.0 / 144.0)));
    app.insert_resource(Gravity::ZERO).init_resource::<Runs>();
    app.finish();
    app.cleanup();
    app.add_systems(schedule, |mut bodies: Query<Forces>, mut runs: ResMut<Runs>| {
        bodies.iter_mut().for_each(|mut forces| forces.apply_force(Vector::X));
        runs.0 += 1;
    });
    let body = app.world_mut().spawn(body(1.0, 1.0)).id();
    for _ in 0..144 * seconds {
        app.update();
    }
    let velocity = app.world().get::<LinearVelocity>(body).expect("a body").x;
    (velocity, app.world().resource::<Runs>().0)
}

#[test]
fn forces_of_every_step_last_and_those_of_every_frame_add_up() {
    let (velocity, runs) = after(2, FixedUpdate);
    assert!((126..=128).contains(&runs), "{runs} steps");
    near(velocity, DT * runs as Scalar, 1e-4, "one per step: v = F t / m");
    // Every frame's force acts for a step. Those of the last frame or two wait for the next one.
    let (velocity, runs) = after(2, Update);
    assert_eq!(runs, 288);
    let counted = velocity / DT;
    assert!((counted - counted.round()).abs() < 1e-2, "{counted} whole forces");
    assert!((284.0..=288.0).contains(&counted.round()), "{counted} of {runs} forces");
}

#[test]
fn accelerations_written_by_hand_act_for_one_step() {
    let mut lab = Lab::new();
    let [body, turning] = [(); 2].map(|()| lab.spawn(body(3.0, 1.0)));
    lab.step();
    let mut turned =
        lab.app.world_mut().get_mut::<VelocityIntegrationData>(turning).expect("every body has it");
    turned.apply_angular_acceleration(about_z(4.0));
    let mut entity = lab.app.world_mut().entity_mut(body);
    let mut data = entity.get_mut::<VelocityIntegrationData>().expect("every body has it");
    data.apply_linear_acceleration(Vector::X * 2.0);
    data.update_linear_damping_rhs(2.0, 0.5);
    data.update_angular_damping_rhs(6.0, 0.5);
    assert_eq!((data.linear_damping_rhs, data.angular_damping_rhs), (0.5, 0.25));
    entity.get_mut::<AccumulatedLocalAcceleration>().expect("every body has it").linear = Vector::Y * 3.0;
    lab.steps(2);
    near(lab.velocity(body), Vector::new_xy(2.0, 3.0) * DT, 1e-6, "velocity");
    near(z_of(lab.spin(turning)), 4.0 * DT, 1e-6, "angular velocity");
    let data = lab.app.world().get::<VelocityIntegrationData>(body).expect("every body has it");
    assert_eq!((data.linear_increment, data.angular_increment), (Vector::ZERO, Angular::default()));
    assert_eq!(lab.get::<AccumulatedLocalAcceleration>(body), AccumulatedLocalAcceleration::default());
}

/// What a force of 2 N and local ones do to a body of 1 kg in a step.
fn push(forces: &mut ForcesItem) {
    forces.apply_force(Vector::X * 2.0);
    forces.apply_local_force(Vector::Y * 2.0);
    forces.apply_torque(about_z(2.0));
}

#[test]
fn issue_forces_of_ticks_without_a_step_added_up() {
    let stops: [fn(&mut Lab, bool); 2] = [
        |lab, stopped| lab.pause(stopped),
        |lab, stopped| {
            let mut clock = lab.app.world_mut().resource_mut::<Time<Physics>>();
            clock.set_relative_speed(if stopped { 0.0 } else { 1.0 });
        },
    ];
    for stop in stops {
        let mut lab = Lab::new();
        let [pushed, once, lone] = [(); 3].map(|()| lab.spawn(body(1.0, 1.0)));
        lab.app
            .world_mut()
            .get_mut::<VelocityIntegrationData>(pushed)
            .expect("it has it")
            .linear_damping_rhs = 0.5;
        lab.step();
        stop(&mut lab, true);
        lab.apply(once, push);
        for _ in 0..128 {
            lab.apply(pushed, push);
            lab.step();
        }
        assert_eq!(lab.velocity(pushed), Vector::ZERO, "nothing moves");
        stop(&mut lab, false);
        lab.apply(pushed, push);
        lab.step();
        for body in [pushed, once] {
            near(lab.velocity(body), Vector::new_xy(2.0 * DT, 2.0 * DT), 1e-3, "one force");
            near(z_of(lab.spin(body)), 2.0 * DT, 1e-5, "one torque");
        }
        assert_eq!(lab.velocity(lone), Vector::ZERO, "no force");
        let data = lab.app.world().get::<VelocityIntegrationData>(pushed).expect("every body has it");
        assert_eq!((data.linear_increment, data.linear_damping_rhs), (Vector::ZERO, 0.5));
        lab.step();
        near(lab.velocity(once), Vector::new_xy(2.0 * DT, 2.0 * DT), 1e-3, "it has acted");
    }
}

/// A step that the app runs by hand, while the hosting schedule runs without one.
#[test]
fn forces_of_ticks_without_a_step_act_in_a_step_by_hand() {
    let mut lab = Lab::new();
    let body = lab.spawn(body(1.0, 1.0));
    lab.step();
    lab.pause(true);
    for _ in 0..10 {
        lab.apply(body, |forces| forces.apply_force(Vector::X * 2.0));
        lab.app.update();
    }
    lab.app.world_mut().resource_mut::<Time<Physics>>().advance_by(Duration::from_secs_f64(DT as f64));
    lab.app.world_mut().run_schedule(PhysicsSchedule);
    near(lab.velocity(body), Vector::X * 2.0 * DT, 1e-5, "one force");
}
