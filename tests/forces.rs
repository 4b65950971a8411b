//! Forces, torques, impulses and accelerations: closed forms, what wakes, what is ignored, and when they act.

use avian::{
    dynamics::{
        integrator::VelocityIntegrationData,
        rigid_body::forces::{AccumulatedLocalAcceleration, ForcesItem, ForcesReadOnly},
    },
    math::{AsF32, Scalar, Vector},
    prelude::*,
};
use bevy_app::prelude::*;
use bevy_ecs::{prelude::*, schedule::ScheduleLabel};
use bevy_math::Quat;
use bevy_time::{Time, TimePlugin, TimeUpdateStrategy};
use bevy_transform::{TransformPlugin, components::Transform};
use core::{fmt::Debug, ops::Sub, time::Duration};

use super::forces_dim::{Angular, about_z, body, z_of};

/// The length of a step, of which the clock has no rounding error.
pub const DT: Scalar = 1.0 / 64.0;
/// The length of a substep.
pub const H: Scalar = DT / 4.0;

/// An app without gravity that is stepped by hand, at 64 Hz in 4 substeps.
pub struct Lab {
    pub app: App,
}

impl Lab {
    pub fn new() -> Self {
        Self::with(PhysicsPlugins::new(Update).build())
    }

    fn with(plugins: bevy_app::PluginGroupBuilder) -> Self {
        let mut app = App::new();
        app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, plugins));
        app.insert_resource(Gravity::ZERO).insert_resource(SubstepCount(4));
        app.finish();
        app.cleanup();
        Self { app }
    }

    pub fn spawn(&mut self, bundle: impl Bundle) -> Entity {
        self.app.world_mut().spawn(bundle).id()
    }

    pub fn insert(&mut self, entity: Entity, bundle: impl Bundle) {
        self.app.world_mut().entity_mut(entity).insert(bundle);
    }

    fn remove<B: Bundle>(&mut self, entity: Entity) {
        self.app.world_mut().entity_mut(entity).remove::<B>();
    }

    /// Applies forces to a body, between two steps.
    pub fn apply(&mut self, entity: Entity, apply: impl FnOnce(&mut ForcesItem)) {
        let world = self.app.world_mut();
        let mut query = world.query::<Forces>();
        apply(&mut query.get_mut(world, entity).expect("a body has forces"));
    }

    pub fn step(&mut self) {
        self.app.world_mut().resource_mut::<Time>().advance_by(Duration::from_nanos(15_625_000));
        self.app.update();
    }

    pub fn steps(&mut self, count: usize) {
        (0..count).for_each(|_| self.step());
    }

    #[track_caller]
    fn get<C: Component + Clone>(&self, entity: Entity) -> C {
        self.app.world().get::<C>(entity).expect("the entity has the component").clone()
    }

    fn at(&self, entity: Entity) -> Vector {
        self.get::<Position>(entity).0
    }

    fn velocity(&self, entity: Entity) -> Vector {
        self.get::<LinearVelocity>(entity).0
    }

    pub fn spin(&self, entity: Entity) -> Angular {
        self.get::<AngularVelocity>(entity).0
    }

    fn sleeps(&self, entity: Entity) -> bool {
        self.app.world().get::<Sleeping>(entity).is_some()
    }

    fn pause(&mut self, paused: bool) {
        let mut clock = self.app.world_mut().resource_mut::<Time<Physics>>();
        if paused { clock.pause() } else { clock.unpause() }
    }

    /// A box of 1 m and 1 kg, asleep on a floor, in gravity of 10 m/s².
    fn sleeper(&mut self) -> Entity {
        self.app.insert_resource(Gravity(Vector::Y * -10.0));
        self.spawn((RigidBody::Static, Collider::half_space(Vector::Y)));
        let sleeper = self.spawn((
            RigidBody::Dynamic,
            cube(),
            Mass(1.0),
            Friction::new(0.5),
            Transform::from_xyz(0.0, 0.5, 0.0),
        ));
        self.steps(100);
        assert!(self.sleeps(sleeper), "a box at rest sleeps");
        sleeper
    }
}

/// A box of 1 m.
fn cube() -> Collider {
    let mut corners = vec![Vector::ZERO];
    for axis in Vector::AXES {
        corners = corners.iter().flat_map(|c| [*c - axis * 0.5, *c + axis * 0.5]).collect();
    }
    Collider::convex_hull(corners).expect("a box is convex")
}

/// The length of a vector or number.
pub trait Length {
    fn size(self) -> Scalar;
}

impl Length for Vector {
    fn size(self) -> Scalar {
        self.length()
    }
}

impl Length for Scalar {
    fn size(self) -> Scalar {
        self.abs()
    }
}

#[track_caller]
pub fn near<V: Copy + Debug + Sub<Output = V> + Length>(got: V, want: V, tolerance: Scalar, what: &str) {
    let error = (got - want).size();
    assert!(error <= tolerance, "{what}: {got:?} is not {want:?}, off by {error}");
}

fn turned(angle: f32) -> Rotation {
    Rotation::from(Quat::from_rotation_z(angle))
}

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

trait Plane {
    fn new_xy(x: Scalar, y: Scalar) -> Vector;
}

impl Plane for Vector {
    fn new_xy(x: Scalar, y: Scalar) -> Vector {
        Vector::X * x + Vector::Y * y
    }
}

/// Applies one of everything.
fn apply_all(forces: &mut impl RigidBodyForces, push: Vector, turn: Angular) {
    let point = forces.position().0 + Vector::ONE;
    forces.apply_force(push);
    forces.apply_force_at_point(push, point);
    forces.apply_local_force(push);
    forces.apply_torque(turn);
    forces.apply_linear_impulse(push);
    forces.apply_linear_impulse_at_point(push, point);
    forces.apply_local_linear_impulse(push);
    forces.apply_angular_impulse(turn);
    forces.apply_linear_acceleration(push);
    forces.apply_linear_acceleration_at_point(push, point);
    forces.apply_local_linear_acceleration(push);
    forces.apply_angular_acceleration(turn);
}

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
