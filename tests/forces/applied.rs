//! What forces are ignored, and on what bodies they act.

use super::*;

#[test]
fn forces_move_dynamic_bodies_only() {
    let mut lab = Lab::new();
    for kind in [RigidBody::Static, RigidBody::Kinematic] {
        let constant =
            (ConstantForce(Vector::X), ConstantLocalForce(Vector::X), ConstantTorque(about_z(1.0)));
        let body = lab.spawn((kind, Mass(1.0), cube(), constant));
        lab.apply(body, |forces| apply_all(forces, Vector::X, about_z(1.0)));
        lab.insert(body, VelocityIntegrationData { linear_increment: Vector::X, ..Default::default() });
        lab.steps(3);
        assert_eq!((lab.at(body), lab.velocity(body)), (Vector::ZERO, Vector::ZERO), "{kind:?}");
        assert_eq!(lab.spin(body), Angular::default(), "{kind:?}");
    }
    let body = lab.spawn(RigidBody::Kinematic);
    lab.apply(body, |forces| *forces.linear_velocity_mut() = Vector::X);
    lab.steps(64);
    near(lab.at(body), Vector::X, 1e-5, "its velocity may be set");
}

#[test]
fn a_body_without_mass_is_moved_by_accelerations_only() {
    let mut lab = Lab::new();
    let body = lab.spawn(RigidBody::Dynamic);
    lab.apply(body, |forces| {
        forces.apply_force(Vector::X);
        forces.apply_local_force(Vector::X);
        forces.apply_linear_impulse_at_point(Vector::X, Vector::Y);
        forces.apply_torque(about_z(1.0));
        forces.apply_linear_acceleration_at_point(Vector::Y * 2.0, Vector::X);
        forces.apply_angular_acceleration(about_z(3.0));
    });
    lab.step();
    near(lab.velocity(body), Vector::Y * (2.0 * DT), 1e-6, "velocity");
    near(z_of(lab.spin(body)), 3.0 * DT, 1e-6, "angular velocity");
}

#[test]
fn locked_axes_are_not_moved() {
    let mut lab = Lab::new();
    let push = Vector::new_xy(1.0, 1.0);
    let constant = (ConstantForce(push), ConstantLocalForce(push), ConstantTorque(about_z(1.0)));
    let held = LockedAxes::ROTATION_LOCKED.lock_translation_x();
    let body = lab.spawn((body(1.0, 1.0), constant, held, turned(0.5)));
    lab.apply(body, |forces| {
        apply_all(forces, push, about_z(1.0));
        assert_eq!(forces.accumulated_angular_acceleration(), Angular::default());
    });
    let struck = lab.velocity(body);
    assert_eq!((struck.x, lab.spin(body)), (0.0, Angular::default()));
    assert!(struck.y > 1.0, "{struck:?}");
    lab.steps(10);
    assert_eq!((lab.at(body).x, lab.spin(body)), (0.0, Angular::default()));
    assert!(lab.velocity(body).y > struck.y);
}

#[test]
fn a_disabled_body_is_not_moved_and_gathers_nothing() {
    let mut lab = Lab::new();
    let body = lab.spawn((body(1.0, 1.0), RigidBodyDisabled, ConstantForce(Vector::Y)));
    for _ in 0..10 {
        lab.apply(body, |forces| {
            forces.apply_force(Vector::X * 100.0);
            forces.apply_local_force(Vector::X * 100.0);
        });
        lab.step();
    }
    assert_eq!(lab.velocity(body), Vector::ZERO);
    lab.remove::<RigidBodyDisabled>(body);
    lab.step();
    near(lab.velocity(body), Vector::Y * DT, 1e-6, "only what acts now");
}

#[test]
fn custom_integration_leaves_forces_to_the_app() {
    let mut lab = Lab::new();
    let body = lab.spawn((body(1.0, 1.0), CustomVelocityIntegration, ConstantForce(Vector::Y)));
    lab.apply(body, |forces| {
        forces.apply_force(Vector::X);
        forces.apply_local_force(Vector::X);
    });
    lab.step();
    assert_eq!(lab.velocity(body), Vector::ZERO);
    lab.apply(body, |forces| assert_eq!(forces.accumulated_linear_acceleration(), Vector::ZERO));
}

#[test]
fn what_is_not_finite_is_ignored_and_the_rest_acts() {
    let wrong = [Scalar::NAN, Scalar::INFINITY, Scalar::NEG_INFINITY];
    let mut lab = Lab::new();
    let bystander = lab.spawn((body(1.0, 1.0), ConstantForce(Vector::Y)));
    for (i, wrong) in wrong.into_iter().enumerate() {
        let body = lab.spawn((body(1.0, 1.0), Position(Vector::X * (10.0 * i as Scalar))));
        lab.apply(body, |forces| {
            forces.apply_force(Vector::X);
            forces.apply_linear_impulse(Vector::Y);
            apply_all(forces, Vector::X * wrong, about_z(wrong));
            forces.apply_force_at_point(Vector::ZERO, Vector::X * wrong);
        });
        assert_eq!((lab.velocity(body), lab.spin(body)), (Vector::Y, Angular::default()));
        lab.step();
        near(lab.velocity(body), Vector::Y + Vector::X * DT, 1e-6, "the rest acts");
        // Components that are set by hand.
        let data = VelocityIntegrationData { linear_increment: Vector::X * wrong, ..Default::default() };
        lab.insert(body, (data, ConstantForce(Vector::X * wrong), ConstantTorque(about_z(wrong))));
        lab.steps(3);
        near(lab.velocity(body), Vector::Y + Vector::X * DT, 1e-6, "ignored");
        lab.insert(body, (ConstantForce(Vector::ZERO), ConstantTorque(about_z(0.0))));
        lab.apply(body, |forces| forces.apply_force(Vector::X));
        lab.step();
        near(lab.velocity(body), Vector::Y + Vector::X * (2.0 * DT), 1e-6, "and acts again");
        assert!(!lab.app.world().entity(body).contains::<RigidBodyDisabled>());
    }
    near(lab.velocity(bystander), Vector::Y * (15.0 * DT), 1e-5, "others are not touched");
}

#[test]
fn sums_too_large_for_a_number_are_ignored() {
    let mut lab = Lab::new();
    let body = lab.spawn(body(1.0e-3, 1.0));
    lab.apply(body, |forces| {
        forces.apply_force(Vector::X);
        (0..5).for_each(|_| forces.apply_linear_acceleration(Vector::Y * (Scalar::MAX * 0.4)));
        forces.apply_force(Vector::X * Scalar::MAX);
        forces.apply_linear_impulse(Vector::X * Scalar::MAX);
        assert!(forces.accumulated_linear_acceleration().is_finite() && forces.linear_velocity().is_finite());
    });
    lab.steps(3);
    assert!(lab.at(body).is_finite() && lab.velocity(body).is_finite());
}

#[test]
fn forces_on_what_is_gone_do_nothing() {
    let mut lab = Lab::new();
    let (gone, bare, freed) =
        (lab.spawn(body(1.0, 1.0)), lab.spawn(body(1.0, 1.0)), lab.spawn(body(1.0, 1.0)));
    lab.insert(freed, ConstantForce(Vector::X));
    lab.step();
    for body in [gone, bare, freed] {
        lab.apply(body, |forces| apply_all(forces, Vector::X, about_z(1.0)));
    }
    lab.app.world_mut().despawn(gone);
    lab.remove::<RigidBody>(bare);
    lab.app.world_mut().entity_mut(freed).remove::<(RigidBody, ConstantForce, VelocityIntegrationData)>();
    lab.steps(3);
    // A body that is one again.
    lab.insert(bare, body(1.0, 1.0));
    lab.steps(3);
    assert!(lab.at(bare).is_finite());
}

#[test]
fn without_the_plugin_only_impulses_act() {
    let mut lab = Lab::with(PhysicsPlugins::new(Update).build().disable::<ForcePlugin>());
    let body = lab.spawn((body(1.0, 1.0), ConstantForce(Vector::X)));
    lab.apply(body, |forces| {
        forces.apply_force(Vector::X);
        forces.apply_linear_impulse(Vector::Y);
    });
    lab.steps(3);
    assert_eq!(lab.velocity(body), Vector::Y);
}

#[test]
fn without_a_solver_forces_move_nothing() {
    let mut lab = Lab::with(PhysicsPlugins::new(Update).build().disable::<SolverBodyPlugin>());
    let body = lab.spawn((body(1.0, 1.0), ConstantForce(Vector::X)));
    lab.apply(body, |forces| forces.apply_local_force(Vector::X));
    lab.steps(3);
    assert_eq!(lab.velocity(body), Vector::ZERO);
}
