//! Motion under forces, against closed forms.

use super::*;

/// F = m a. After n steps v = a t and x = ½ a t (t + h), as symplectic Euler has it.
#[test]
fn a_constant_force_accelerates_by_f_over_m() {
    let (force, mass) = (Vector::X * 3.0 - Vector::Y, 2.0f32);
    let acceleration = force / Scalar::from(mass);
    let mut lab = Lab::new();
    let constant = lab.spawn((body(mass, 1.0), ConstantForce(force)));
    let accelerated = lab.spawn((body(7.0, 1.0), ConstantLinearAcceleration(acceleration)));
    let applied = lab.spawn(body(mass, 1.0));
    for _ in 0..128 {
        lab.apply(applied, |forces| forces.apply_force(force));
        lab.step();
    }
    let t = 2.0;
    for (body, what) in [(constant, "constant"), (accelerated, "acceleration"), (applied, "applied")] {
        near(lab.velocity(body), acceleration * t, 1e-5, what);
        near(lab.at(body), acceleration * (0.5 * t * (t + H)), 1e-4, what);
        assert_eq!(lab.spin(body), Angular::default());
    }
    assert_eq!(lab.at(constant), lab.at(applied), "the same bits");
    assert_eq!(lab.velocity(constant), lab.velocity(accelerated));
}

/// τ = I α. After n steps ω = α t, and the angle is ½ α t (t + h).
#[test]
fn a_constant_torque_turns_by_torque_over_inertia() {
    let (torque, inertia) = (3.0, 4.0f32);
    let alpha = torque / Scalar::from(inertia);
    let mut lab = Lab::new();
    let constant = lab.spawn((body(1.0, inertia), ConstantTorque(about_z(torque))));
    let turning = lab.spawn((body(1.0, 9.0), ConstantAngularAcceleration(about_z(alpha))));
    let applied = lab.spawn(body(1.0, inertia));
    for _ in 0..128 {
        lab.apply(applied, |forces| forces.apply_torque(about_z(torque)));
        lab.step();
    }
    let t = 2.0;
    let angle = 0.5 * alpha * t * (t + H);
    for (body, what) in [(constant, "constant"), (turning, "acceleration"), (applied, "applied")] {
        near(z_of(lab.spin(body)), alpha * t, 1e-5, what);
        near(lab.get::<Rotation>(body) * Vector::X, Vector::new_xy(angle.cos(), angle.sin()), 1e-4, what);
        assert_eq!(lab.velocity(body), Vector::ZERO);
    }
}

/// A force at a point r from the centre of mass accelerates the centre by F / m, and turns by I⁻¹ (r × F).
#[test]
fn a_force_at_a_point_accelerates_and_turns() {
    let mut lab = Lab::new();
    let place = Vector::X * 5.0 + Vector::Y;
    let bodies: [Entity; 3] = core::array::from_fn(|_| {
        // The centre of mass is 2 m to the left of the body, which is turned by a half turn.
        let center = CenterOfMass((Vector::X * 2.0).f32());
        lab.spawn((body(2.0, 4.0), center, Position(place), turned(core::f32::consts::PI)))
    });
    let (center, arm, push) = (place - Vector::X * 2.0, Vector::X * 3.0 + Vector::Y, Vector::Y * 8.0);
    let [pushed, accelerated, struck] = bodies;
    lab.apply(pushed, |forces| forces.apply_force_at_point(push, center + arm));
    lab.apply(accelerated, |forces| forces.apply_linear_acceleration_at_point(push / 2.0, center + arm));
    lab.apply(struck, |forces| {
        forces.apply_linear_impulse_at_point(push * DT, center + arm);
        // v + ω × r, with ω = 3 · 8 / 4 · dt about z.
        let spin = 6.0 * DT;
        let want = Vector::Y * (4.0 * DT + spin * 3.0) - Vector::X * spin;
        near(forces.velocity_at_point(center + arm), want, 1e-5, "the point that was struck");
    });
    near(lab.velocity(struck), push / 2.0 * DT, 1e-6, "an impulse acts at once");
    near(z_of(lab.spin(struck)), 6.0 * DT, 1e-6, "an impulse turns at once");
    lab.step();
    for body in bodies {
        near(lab.velocity(body), push / 2.0 * DT, 1e-6, "velocity");
        near(z_of(lab.spin(body)), 6.0 * DT, 1e-6, "angular velocity");
    }
}

/// A body that turns at ω with a force along its own axis: v_n = h Σ a (cos ω k h, sin ω k h), which tends to
/// (a / ω) (sin ω t, 1 − cos ω t), a circle.
#[test]
fn a_local_force_turns_with_the_body() {
    let (mut lab, w, a, steps) = (Lab::new(), 3.0, 2.0, 128);
    let spin = AngularVelocity(about_z(w));
    let constant = lab.spawn((body(2.0, 1.0), spin, ConstantLocalForce(Vector::X * (2.0 * a))));
    let accelerated = lab.spawn((body(3.0, 1.0), spin, ConstantLocalLinearAcceleration(Vector::X * a)));
    let [pushed, thrust] = [(); 2].map(|()| lab.spawn((body(2.0, 1.0), spin)));
    for _ in 0..steps {
        lab.apply(pushed, |forces| forces.apply_local_force(Vector::X * (2.0 * a)));
        lab.apply(thrust, |forces| forces.apply_local_linear_acceleration(Vector::X * a));
        lab.step();
    }
    let mut want = Vector::ZERO;
    for k in 0..4 * steps {
        let angle = w * H * k as Scalar;
        want += (Vector::X * angle.cos() + Vector::Y * angle.sin()) * (a * H);
    }
    let t = DT * steps as Scalar;
    let circle = (Vector::X * (w * t).sin() + Vector::Y * (1.0 - (w * t).cos())) * (a / w);
    for body in [constant, accelerated, pushed, thrust] {
        near(lab.velocity(body), want, 1e-4, "the sum");
        near(lab.velocity(body), circle, a * H, "the circle");
        near(z_of(lab.spin(body)), w, 1e-6, "nothing turns it");
    }
}

#[test]
fn an_impulse_changes_the_velocity_at_once() {
    let mut lab = Lab::new();
    let body = lab.spawn((body(2.0, 4.0), turned(core::f32::consts::FRAC_PI_2)));
    lab.apply(body, |forces| {
        forces.apply_linear_impulse(Vector::X * 6.0);
        assert_eq!(forces.linear_velocity(), Vector::X * 3.0);
        forces.apply_local_linear_impulse(Vector::X * 2.0);
        forces.apply_angular_impulse(about_z(2.0));
        *forces.linear_velocity_mut() += Vector::X;
        *forces.angular_velocity_mut() += about_z(0.25);
    });
    near(lab.velocity(body), Vector::X * 4.0 + Vector::Y, 1e-6, "velocity");
    assert_eq!(lab.spin(body), about_z(0.75));
    lab.steps(64);
    near(lab.velocity(body), Vector::X * 4.0 + Vector::Y, 1e-6, "it stays");
    near(lab.at(body), Vector::X * 4.0 + Vector::Y, 1e-4, "way of a second");
}

#[test]
fn a_force_lasts_one_step_and_forces_add_up() {
    let mut lab = Lab::new();
    let body = lab.spawn(body(2.0, 1.0));
    lab.apply(body, |forces| {
        (0..3).for_each(|_| forces.apply_force(Vector::X * 2.0));
        forces.apply_linear_acceleration(Vector::Y);
        forces.apply_local_force(Vector::Y * 4.0);
        near(forces.accumulated_linear_acceleration(), Vector::new_xy(3.0, 3.0), 1e-6, "sum");
    });
    lab.steps(5);
    near(lab.velocity(body), Vector::new_xy(3.0 * DT, 3.0 * DT), 1e-6, "one step");
    assert_eq!(lab.get::<AccumulatedLocalAcceleration>(body), AccumulatedLocalAcceleration::default());
    lab.apply(body, |forces| assert_eq!(forces.accumulated_linear_acceleration(), Vector::ZERO));
    let before = (lab.velocity(body), lab.spin(body));
    lab.apply(body, |forces| {
        forces.apply_torque(about_z(5.0));
        forces.apply_angular_acceleration(about_z(2.0));
        near(z_of(forces.accumulated_angular_acceleration()), 7.0, 1e-6, "sum");
        forces.apply_force(Vector::X);
        forces.apply_local_force(Vector::X);
        forces.reset_accumulated_linear_acceleration();
        forces.reset_accumulated_angular_acceleration();
    });
    lab.step();
    assert_eq!((lab.velocity(body), lab.spin(body)), before, "taken back");
}
