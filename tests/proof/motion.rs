//! Closed forms of free motion, sliding and rolling: rows 1 to 5 of the required physics.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use scenes::scene::at;

use super::{
    dim,
    world::{G, Lab, assert_close},
};

/// Gravity in the frame of a slope of `angle` that falls towards `along`.
fn on_slope(angle: f32, along: Vector) -> Vector {
    let (sin, cos) = scenes::sin_cos(angle);
    (along * sin - Vector::Y * cos) * G
}

#[test]
fn free_fall_is_symplectic_euler_exactly() {
    // y_n = y0 + v0 t − ½ g t (t + h) and v_n = v0 − g t, h the substep.
    for (dt, substeps) in [(1.0 / 60.0, 4), (1.0 / 64.0, 6), (1.0 / 30.0, 1)] {
        let mut lab = Lab::with_steps(dt, substeps);
        let body = lab.ball(0.5, at(1.0, 2.0, 0.0));
        lab.insert(body, LinearVelocity(dim::sized(3.0, 7.0, 0.0)));
        let n = 150;
        lab.steps(n);
        let h = dt as Scalar / substeps as Scalar;
        let t = n as Scalar * dt as Scalar;
        let p = lab.at(body);
        assert_close(p.y, 2.0 + 7.0 * t - 0.5 * G * t * (t + h), 1e-5, "height");
        assert_close(p.x, 1.0 + 3.0 * t, 1e-5, "way");
        assert_close(lab.velocity(body).y, 7.0 - G * t, 1e-5, "speed");
        assert_close(lab.velocity(body).x, 3.0, 1e-5, "speed along");
    }
}

#[test]
fn gravity_scale_multiplies_gravity() {
    let mut lab = Lab::new();
    let bodies =
        [0.0, 0.5, 2.0, -1.0].map(|scale| (scale, lab.spawn((RigidBody::Dynamic, GravityScale(scale)))));
    lab.seconds(1.0);
    for (scale, body) in bodies {
        assert!((lab.velocity(body).y + scale * G).abs() < 1e-4, "{scale}: {:?}", lab.velocity(body));
    }
}

#[test]
fn damping_divides_by_one_plus_c_h() {
    // v_n = v0 / (1 + c h)^n
    let mut lab = Lab::weightless();
    let body = lab.ball(0.5, at(0.0, 0.0, 0.0));
    lab.insert(body, (LinearVelocity(Vector::X * 5.0), LinearDamping(0.7)));
    lab.insert(body, (scenes::dim::spin(4.0), AngularDamping(1.3)));
    lab.steps(120);
    let rest = |c: f64| (1.0 / (1.0 + c / 240.0).powi(480)) as Scalar;
    // Each of the 480 substeps rounds the factor and the product once.
    let rounding = 480.0 * Scalar::EPSILON;
    assert_close(lab.velocity(body).x, 5.0 * rest(0.7), rounding, "linear");
    assert_close(lab.spin(body), 4.0 * rest(1.3), rounding, "angular");
}

/// Mean acceleration over two seconds, after one second on the slope.
fn acceleration_on_slope(mu: Scalar, angle: f32, along: Vector) -> Scalar {
    let mut lab = Lab::new();
    lab.surfaces(mu, 0.0);
    lab.gravity(on_slope(angle, along));
    lab.floor();
    let body = lab.block([0.5, 0.25, 0.5], at(0.0, 0.125, 0.0));
    // At first it is slow enough to count as at rest.
    lab.insert(body, SleepingDisabled);
    lab.seconds(1.0);
    let before = lab.velocity(body).dot(along);
    lab.seconds(2.0);
    let after = lab.velocity(body);
    let across = (after - along * after.dot(along)).length();
    assert!(across < 0.01 * (after.length() + 0.1), "it left its way: {after:?} off {along:?}");
    (after.dot(along) - before) / 2.0
}

#[test]
fn a_box_sticks_below_the_angle_of_friction_in_every_direction() {
    let mu: Scalar = 0.5;
    for along in dim::directions() {
        let mut lab = Lab::new();
        lab.surfaces(mu, 0.0);
        lab.gravity(on_slope(mu.atan() - Scalar::to_radians(0.5), along));
        lab.floor();
        let body = lab.block([0.5, 0.25, 0.5], at(0.0, 0.125, 0.0));
        lab.insert(body, SleepingDisabled);
        lab.seconds(1.0);
        let before = lab.at(body);
        lab.seconds(3.0);
        let crept = (lab.at(body) - before).length();
        assert!(crept < 1e-3, "towards {along:?} it crept {crept} m");
    }
}

#[test]
fn a_box_slides_above_the_angle_of_friction_the_same_in_every_direction() {
    let mu: Scalar = 0.5;
    for over in [0.5, 10.0] {
        let angle = mu.atan() + Scalar::to_radians(over);
        let want = G * (angle.sin() - mu * angle.cos());
        let got: Vec<Scalar> =
            dim::directions().into_iter().map(|d| acceleration_on_slope(mu, angle, d)).collect();
        let (low, high) =
            got.iter().fold((Scalar::MAX, 0.0), |(l, h): (Scalar, Scalar), &a| (l.min(a), h.max(a)));
        assert!(high - low < 0.01 * want, "{over} degrees above: from {low} to {high}");
        for a in got {
            assert_close(a, want, 0.02, "acceleration");
        }
    }
}

#[test]
fn a_sliding_box_stops_after_v_squared_over_two_mu_g() {
    for along in dim::directions() {
        let (mu, v) = (0.4, 6.0);
        let mut lab = Lab::new();
        lab.surfaces(mu, 0.0);
        lab.floor();
        let body = lab.block([0.5, 0.25, 0.5], at(0.0, 0.125, 0.0));
        lab.seconds(0.5);
        let from = lab.at(body);
        lab.insert(body, LinearVelocity(along * v));
        lab.seconds(3.0);
        assert!(lab.velocity(body).length() < 1e-3);
        assert_close((lab.at(body) - from).length(), v * v / (2.0 * mu * G), 0.01, "way");
    }
}

#[test]
fn a_box_tips_where_its_base_is_narrower_than_the_slope_is_steep() {
    let (width, height): (Scalar, Scalar) = (0.4, 1.0);
    let critical = (width / height).atan();
    for (over, tips) in [(-1.0, false), (1.0, true)] {
        let mut lab = Lab::new();
        lab.surfaces(1.0, 0.0);
        lab.gravity(on_slope(critical + Scalar::to_radians(over), Vector::X));
        lab.floor();
        let body = lab.block([width, height, 0.8], at(0.0, 0.5 * height, 0.0));
        lab.insert(body, SleepingDisabled);
        lab.seconds(5.0);
        assert_eq!(lab.uprightness(body) < 0.5, tips, "{over} degrees over: leans {}", lab.uprightness(body));
    }
    // Friction below the ratio of base to height: it slides before it tips.
    let mut lab = Lab::new();
    lab.surfaces(0.3, 0.0);
    lab.gravity(on_slope(critical + Scalar::to_radians(3.0), Vector::X));
    lab.floor();
    let body = lab.block([width, height, 0.8], at(0.0, 0.5 * height, 0.0));
    lab.seconds(3.0);
    assert!(lab.uprightness(body) > 0.99 && lab.velocity(body).x > 1.0);
}

#[test]
fn balls_and_cylinders_roll_as_their_inertia_says() {
    // a = g sin θ / (1 + I / m r²): 5/7 for a solid sphere, 2/3 for a solid cylinder or a disc.
    let angle: Scalar = Scalar::to_radians(15.0);
    let shapes = [
        ("ball", scenes::dim::ball(0.5), bevy_math::Quat::IDENTITY, dim::BALL_INERTIA),
        ("cylinder", scenes::dim::roller(0.5, 1.0), scenes::dim::roller_turn(), 0.5),
    ];
    for (name, collider, turn, inertia) in shapes {
        let mut lab = Lab::new();
        lab.gravity(on_slope(angle, Vector::X));
        lab.floor();
        let body = lab.spawn((RigidBody::Dynamic, collider, at(0.0, 0.5, 0.0).with_rotation(turn)));
        lab.seconds(1.0);
        let before = lab.velocity(body).x;
        lab.seconds(2.0);
        let after = lab.velocity(body).x;
        assert_close((after - before) / 2.0, G * angle.sin() / (1.0 + inertia), 0.01, name);
        assert_close(-0.5 * lab.spin(body), after, 0.01, "it rolls without slipping");
    }
}

#[test]
fn a_sliding_ball_comes_to_roll_in_time() {
    // With k = I / m r²: it slips for t = k v0 / ((1 + k) μ g), 2/7 v0 / μ g for a sphere, then rolls at
    // v0 / (1 + k).
    let (mu, v0, k) = (0.2, 7.0, dim::BALL_INERTIA);
    let mut lab = Lab::new();
    lab.surfaces(mu, 0.0);
    lab.floor();
    let ball = lab.ball(0.5, at(0.0, 0.5, 0.0));
    lab.seconds(0.25);
    lab.insert(ball, LinearVelocity(Vector::X * v0));
    let t = f64::from(k * v0 / ((1.0 + k) * mu * G));
    let slip = |lab: &Lab| lab.velocity(ball).x + 0.5 * lab.spin(ball);
    lab.seconds(0.9 * t);
    assert!(slip(&lab) > 0.05 * v0, "it still slips: {}", slip(&lab));
    lab.seconds(0.2 * t);
    assert!(slip(&lab).abs() < 0.01 * v0, "it rolls: {}", slip(&lab));
    assert_close(lab.velocity(ball).x, v0 / (1.0 + k), 0.01, "speed of rolling");
}
