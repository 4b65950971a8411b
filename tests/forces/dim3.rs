//! 3D parts of the tests of forces: torques in the body's frame, and inertia that differs about three axes.

use avian::{
    math::{Scalar, Vector},
    prelude::*,
};
use bevy_ecs::prelude::*;
use bevy_math::Vec3;

use super::forces::{DT, H, Lab, near};

/// An angular velocity or torque.
pub type Angular = Vector;

/// About z.
pub fn about_z(w: Scalar) -> Angular {
    Vector::Z * w
}

/// The component about z.
pub fn z_of(w: Angular) -> Scalar {
    w.z
}

/// A body with a mass in kg and a moment of inertia in kg·m² about all axes, without a collider.
pub fn body(mass: f32, inertia: f32) -> impl Bundle {
    (RigidBody::Dynamic, Mass(mass), AngularInertia::new(Vec3::splat(inertia)))
}

#[test]
fn constant_forces_are_made_of_components() {
    let v = Vector::new(1.0, 2.0, 3.0);
    assert_eq!([ConstantForce::new(1.0, 2.0, 3.0).0, ConstantTorque::new(1.0, 2.0, 3.0).0], [v; 2]);
    assert_eq!([ConstantLocalForce::new(1.0, 2.0, 3.0).0, ConstantLocalTorque::new(1.0, 2.0, 3.0).0], [v; 2]);
    let linear = ConstantLinearAcceleration::new(1.0, 2.0, 3.0).0;
    assert_eq!([linear, ConstantAngularAcceleration::new(1.0, 2.0, 3.0).0], [v; 2]);
    let linear = ConstantLocalLinearAcceleration::new(1.0, 2.0, 3.0).0;
    assert_eq!([linear, ConstantLocalAngularAcceleration::new(1.0, 2.0, 3.0).0], [v; 2]);
}

/// Moments of 2, 3 and 4 kg·m² about its own axes, which are turned by a quarter about z.
fn turned(lab: &mut Lab) -> Entity {
    let inertia = AngularInertia::new(Vec3::new(2.0, 3.0, 4.0));
    let turn = Rotation::from(bevy_math::Quat::from_rotation_z(core::f32::consts::FRAC_PI_2));
    lab.spawn((RigidBody::Dynamic, Mass(1.0), inertia, turn))
}

#[test]
fn a_torque_turns_a_body_by_its_inertia_in_world_axes() {
    // The body's own x axis, with 2 kg·m², is the world's y axis.
    let mut lab = Lab::new();
    let body = turned(&mut lab);
    lab.apply(body, |forces| forces.apply_angular_impulse(Vector::new(6.0, 6.0, 6.0)));
    near(lab.spin(body), Vector::new(2.0, 3.0, 1.5), 1e-5, "world");
    let body = turned(&mut lab);
    lab.apply(body, |forces| forces.apply_local_angular_impulse(Vector::new(6.0, 6.0, 6.0)));
    // 3 rad/s about its x axis, 2 about its y axis, 1.5 about z.
    near(lab.spin(body), Vector::new(-2.0, 3.0, 1.5), 1e-5, "local");
}

#[test]
fn a_local_torque_acts_about_the_axis_of_the_body() {
    for constant in [false, true] {
        let mut lab = Lab::new();
        let [by_torque, by_acceleration] = [turned(&mut lab), turned(&mut lab)];
        for _ in 0..64 {
            if constant {
                lab.insert(by_torque, ConstantLocalTorque(Vector::X * 4.0));
                lab.insert(by_acceleration, ConstantLocalAngularAcceleration(Vector::X * 2.0));
            } else {
                lab.apply(by_torque, |forces| forces.apply_local_torque(Vector::X * 4.0));
                lab.apply(by_acceleration, |f| f.apply_local_angular_acceleration(Vector::X * 2.0));
            }
            lab.step();
        }
        // ω = α t about the body's x axis, a principal axis, which stays where it is.
        let want = Vector::Y * (2.0 * 64.0 * DT);
        near(lab.spin(by_torque), want, 1e-4, "torque");
        near(lab.spin(by_acceleration), want, 1e-4, "acceleration");
    }
}

#[test]
fn a_local_torque_turns_with_a_body_that_turns_about_another_axis() {
    // ω_z = w turns the x axis of a ball. ω_n = h Σ α (cos w k h, sin w k h, 0).
    let (mut lab, w, steps) = (Lab::new(), 1.5, 32);
    let ball = lab.spawn((body(1.0, 2.0), AngularVelocity(Vector::Z * w)));
    lab.insert(ball, ConstantLocalTorque(Vector::X * 0.02));
    lab.steps(steps);
    let mut want = Vector::Z * w;
    for k in 0..4 * steps {
        let angle = w * H * k as Scalar;
        want += Vector::new(angle.cos(), angle.sin(), 0.0) * (0.01 * H);
    }
    near(lab.spin(ball), want, 2e-5, "angular velocity");
}

#[test]
fn a_torque_about_a_locked_axis_turns_nothing() {
    let mut lab = Lab::new();
    let body = turned(&mut lab);
    lab.insert(body, LockedAxes::new().lock_rotation_y());
    lab.apply(body, |forces| {
        forces.apply_torque(Vector::new(3.0, 3.0, 3.0));
        forces.apply_local_torque(Vector::X * 50.0);
        forces.apply_angular_impulse(Vector::new(3.0, 3.0, 4.0));
    });
    near(lab.spin(body), Vector::new(1.0, 0.0, 1.0), 1e-5, "impulse");
    lab.step();
    assert_eq!(lab.spin(body).y, 0.0);
}

/// A body query gives inertia in world axes, with locks.
#[test]
fn a_body_query_gives_the_inertia_about_the_axes_of_the_world() {
    let mut lab = Lab::new();
    let body = turned(&mut lab);
    let read = |lab: &mut Lab| {
        let mut query = lab.app.world_mut().query::<RigidBodyQueryReadOnly>();
        let body = query.get(lab.app.world(), body).expect("a body");
        (body.angular_inertia().inverse(), body.effective_global_angular_inertia().inverse())
    };
    let (local, world) = read(&mut lab);
    near(local * Vector::ONE, Vector::new(1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0), 1e-6, "local");
    near(world * Vector::ONE, Vector::new(1.0 / 3.0, 1.0 / 2.0, 1.0 / 4.0), 1e-6, "world");
    lab.insert(body, LockedAxes::new().lock_rotation_x());
    let (_, world) = read(&mut lab);
    near(world * Vector::ONE, Vector::new(0.0, 1.0 / 2.0, 1.0 / 4.0), 1e-6, "locked");
}
