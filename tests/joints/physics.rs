//! What joints do to bodies, against closed forms.

use super::*;
use avian::math::PI;

/// Hangs a body a metre below a post, by a kind of joint.
fn hang(rig: &mut Rig, kind: usize, post: Entity, body: Entity) -> Entity {
    let above = xy(0.0, 1.0);
    match kind {
        0 => rig.spawn(FixedJoint::new(post, body).with_local_anchor2(above)),
        1 => rig.spawn(DistanceJoint::new(post, body).with_limits(0.5, 1.0)),
        2 => rig.spawn(RevoluteJoint::new(post, body).with_local_anchor2(above)),
        3 => rig.spawn(PrismaticJoint::new(post, body).with_local_anchor2(above)),
        _ => rig.spawn(PrismaticJoint::new(post, body).with_slider_axis(Vector::Y).with_limits(-1.0, 0.0)),
    }
}

#[test]
fn the_force_of_a_joint_is_the_weight_that_hangs_on_it() {
    for kind in 0..5 {
        let mut rig = Rig::new();
        let post = rig.post(3.0, 2.0);
        let body = rig.rod(3.0, 1.0);
        let joint = hang(&mut rig, kind, post, body);
        rig.insert(joint, JointForces::new());
        rig.steps(128);
        let force = rig.get::<JointForces>(joint).force();
        let weight = Vector::Y * MASS * G;
        assert!((force - weight).length() < 0.02 * weight.length(), "joint {kind}: {force}");
        assert!((rig.place(body) - xy(3.0, 1.0)).length() < 2e-3, "joint {kind}: {}", rig.place(body));
    }
}

#[test]
fn a_fixed_joint_carries_the_torque_of_an_arm() {
    let mut rig = Rig::new();
    let post = rig.post(0.0, 0.0);
    let body = rig.rod(1.0, 0.0);
    let joint = FixedJoint::new(post, body).with_local_anchor1(xy(1.0, 0.0)).with_local_anchor2(Vector::ZERO);
    let joint = rig.spawn((joint, JointForces::new()));
    rig.steps(128);
    assert!((rig.place(body) - xy(1.0, 0.0)).length() < 5e-3, "{}", rig.place(body));
    let force = rig.get::<JointForces>(joint).force();
    assert!((force - Vector::Y * MASS * G).length() < 0.02 * MASS * G, "{force}");
}

/// The pendulum's period is T = 2π √((I + m L²) / (m g L)) (1 + θ² / 16) for small amplitudes θ.
#[test]
fn a_pendulum_swings_in_its_period() {
    let mut rig = Rig::new();
    let (length, amplitude): (Scalar, Scalar) = (1.0, 0.3);
    let post = rig.post(0.0, 0.0);
    let bob = rig.rod(length * amplitude.sin(), -length * amplitude.cos());
    rig.insert(bob, turned(amplitude));
    rig.spawn(RevoluteJoint::new(post, bob).with_local_anchor2(xy(0.0, length)));
    let period = 2.0 * PI * ((INERTIA + MASS * length * length) / (MASS * G * length)).sqrt();
    let period = period * (1.0 + amplitude * amplitude / 16.0);
    let (mut crossings, mut last) = (Vec::new(), rig.place(bob).x);
    for step in 0..1024 {
        rig.step();
        let x = rig.place(bob).x;
        if last > 0.0 && x <= 0.0 {
            crossings.push((step as Scalar + last / (last - x)) * DT);
        }
        last = x;
        assert!((rig.place(bob).length() - length).abs() < 2e-3, "{}", rig.place(bob).length());
    }
    let swings = crossings.len() - 1;
    let measured = (crossings[swings] - crossings[0]) / swings as Scalar;
    assert!(swings >= 5 && (measured / period - 1.0).abs() < 5e-3, "{measured} s instead of {period} s");
}

#[test]
fn a_hinge_stops_at_its_limits() {
    for (start, rest) in [(0.0, -0.5), (PI, PI + 0.75)] {
        let mut rig = Rig::new();
        let post = rig.post(0.0, 0.0);
        let arm = rig.rod(start.cos(), start.sin());
        rig.insert(arm, turned(start));
        let joint = RevoluteJoint::new(post, arm)
            .with_local_basis1(turned(start))
            .with_local_anchor2(xy(-1.0, 0.0))
            .with_angle_limits(-0.5, 0.75);
        rig.spawn((joint, JointDamping { linear: 0.0, angular: 2.0 }));
        rig.steps(384);
        let angle = (rig.angle(arm) - rest).rem_euclid(2.0 * PI);
        let off = angle.min(2.0 * PI - angle);
        assert!(off < 0.01, "{} instead of {rest}", rig.angle(arm));
        assert!((rig.place(arm).length() - 1.0).abs() < 2e-3, "it stays on the hinge");
    }
}

#[test]
fn a_slider_falls_to_its_limit_without_turning() {
    let mut rig = Rig::new();
    let post = rig.post(1.0, 0.0);
    let body = rig.rod(1.0, 0.5);
    rig.insert(body, LinearVelocity(Vector::X * 3.0));
    rig.spawn(PrismaticJoint::new(post, body).with_slider_axis(Vector::Y * 2.0).with_limits(-1.5, 2.0));
    let mut lowest: Scalar = 0.0;
    for _ in 0..192 {
        rig.step();
        lowest = lowest.min(rig.place(body).y);
        assert!((rig.place(body).x - 1.0).abs() < 0.02 && rig.angle(body).abs() < 0.01);
    }
    assert!(lowest > -1.5 - 0.03 && (rig.place(body).y + 1.5).abs() < 2e-3, "{lowest}, {}", rig.place(body));
}

#[test]
fn a_rope_is_slack_until_it_is_tight() {
    let mut rig = Rig::new();
    let post = rig.post(0.0, 0.0);
    let body = rig.rod(0.0, -0.5);
    let rope = rig.spawn((DistanceJoint::new(post, body).with_max_distance(2.0), JointForces::new()));
    rig.steps(16);
    let fallen = 0.5 * G * (16.0 * DT) * (16.0 * DT);
    assert!((rig.place(body).y + 0.5 + fallen).abs() < 0.05 && !rig.acts(rope), "it falls freely");
    let mut longest: Scalar = 0.0;
    for _ in 0..240 {
        rig.step();
        longest = longest.max(rig.place(body).length());
    }
    assert!(longest < 2.0 + 0.03 && (rig.place(body).y + 2.0).abs() < 2e-3, "{longest}, {}", rig.place(body));
}

/// A weight m on a spring of stiffness 1 / α sags by α m g.
#[test]
fn a_compliance_sags_under_a_weight() {
    let compliance: Scalar = 2.0e-3;
    for kind in 0..2 {
        let mut rig = Rig::new();
        let post = rig.post(0.0, 0.0);
        let body = rig.rod(0.0, -1.0);
        // It would fall asleep while it still swings by 2 mm, at 3 cm/s.
        rig.insert(body, SleepingDisabled);
        let damping = JointDamping { linear: 8.0, angular: 0.0 };
        if kind == 0 {
            rig.spawn((
                DistanceJoint::new(post, body).with_limits(1.0, 1.0).with_compliance(compliance),
                damping,
            ));
        } else {
            let joint = FixedJoint::new(post, body).with_local_anchor2(Vector::Y);
            rig.spawn((joint.with_point_compliance(compliance), damping));
        }
        rig.steps(384);
        let sag = -1.0 - rig.place(body).y;
        assert!((sag / (compliance * MASS * G) - 1.0).abs() < 0.02, "joint {kind}: {sag} m");
    }
}

/// The relative velocity of two free bodies fades by e^(−c t), and momentum stays.
#[test]
fn damping_fades_relative_velocity_and_conserves_momentum() {
    let mut rig = Rig::weightless();
    let (a, b) = (rig.rod(0.0, 0.0), rig.rod(2.0, 0.0));
    rig.insert(b, LinearVelocity(Vector::X * 2.0));
    let damping = JointDamping { linear: 1.0, angular: 0.0 };
    rig.spawn((PrismaticJoint::new(a, b), damping));
    rig.steps(64);
    let [va, vb] = [a, b].map(|body| rig.get::<LinearVelocity>(body).0);
    assert!((va + vb - Vector::X * 2.0).length() < 1e-3, "{va} and {vb}");
    let expected = 2.0 * (-1.0 as Scalar).exp();
    assert!(((vb - va).x / expected - 1.0).abs() < 0.02, "{} instead of {expected}", (vb - va).x);
}

/// Where a point of one body meets a point of the other decides, not where the origins are.
#[test]
fn frames_in_the_world_hold_bodies_as_they_are() {
    let mut rig = Rig::weightless();
    let (a, b) = (rig.rod(0.0, 0.0), rig.rod(2.0, 1.0));
    rig.insert(a, turned(0.4));
    rig.insert(b, (turned(-1.1), AngularVelocity::ZERO));
    let joint = rig.spawn(FixedJoint::new(a, b).with_anchor(xy(1.0, 0.5)).with_basis(turned(0.2)));
    rig.steps(32);
    assert!((rig.place(a) - xy(0.0, 0.0)).length() < 1e-3 && (rig.place(b) - xy(2.0, 1.0)).length() < 1e-3);
    assert!((rig.angle(a) - 0.4).abs() < 1e-3 && (rig.angle(b) + 1.1).abs() < 1e-3);
    let joint = rig.get::<FixedJoint>(joint);
    assert!(joint.local_frame1().is_some() && joint.local_frame2().is_some(), "they are local now");
    let back = turned(-0.4) * xy(1.0, 0.5);
    assert!((joint.local_anchor1().expect("it is local") - back).length() < 1e-5);
}
