//! [`Forces`]: query data that applies forces, impulses and accelerations to a body.

use bevy_ecs::{prelude::*, query::QueryData};
use bevy_log::warn_once;

use super::{
    access::{Access, Accessed},
    dim::{AccumulatedLocalAcceleration, local_torque_methods},
    pushed::{PushedVelocity, Quantity},
    response::Response,
};
use crate::{
    dynamics::{
        integrator::VelocityIntegrationData,
        rigid_body::{
            AngularVelocity, LinearVelocity, LockedAxes, RigidBody,
            mass_properties::components::{ComputedAngularInertia, ComputedCenterOfMass, ComputedMass},
            sleeping::{SleepTimer, Sleeping},
        },
    },
    math::{
        AngularVector, Vector, angular_from_kernel, angular_to_kernel, vector_from_kernel, vector_to_kernel,
    },
    physics_transform::{Position, Rotation},
};

/// Query data that applies forces, torques, impulses and accelerations to bodies.
///
/// The methods belong to [`ReadRigidBodyForces`] and [`WriteRigidBodyForces`], which are in the prelude. The
/// [module](super) explains when each quantity acts.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// #[derive(Component)]
/// struct Balloon;
///
/// fn lift(mut balloons: Query<Forces, With<Balloon>>) {
///     for mut forces in &mut balloons {
///         forces.apply_force(Vector::Y * 20.0);
///         // Drag, and a push at a point of the world.
///         let drag = -0.5 * forces.linear_velocity();
///         forces.apply_force(drag);
///         let corner = forces.position().0 + Vector::X;
///         forces.apply_linear_impulse_at_point(Vector::Y * 0.1, corner);
///     }
/// }
/// ```
///
/// # Sleeping bodies
///
/// A nonzero force, impulse or acceleration wakes a sleeping body in the next step, even if physics is paused
/// when it is applied. If it is applied through [`non_waking`](ForcesItem::non_waking), it has no effect on a
/// sleeping body, and a force does not keep an awake body from falling asleep.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn wind(mut bodies: Query<Forces>) {
///     for mut forces in &mut bodies {
///         forces.non_waking().apply_force(Vector::X * 0.1);
///     }
/// }
/// ```
///
/// # Reading the velocity in the same query
///
/// `Query<(&LinearVelocity, Forces)>` works if the velocity comes before `Forces`. Impulses then cannot write
/// the velocity while the query hands it out. All methods of `Forces` see the impulses at once, and the start
/// of the next step writes them to the velocity. [`linear_velocity`](ReadRigidBodyForces::linear_velocity)
/// makes the extra query part unnecessary.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn brake(mut bodies: Query<(&LinearVelocity, Forces)>) {
///     for (velocity, mut forces) in &mut bodies {
///         forces.apply_linear_acceleration(-2.0 * velocity.0);
///     }
/// }
/// # let mut world = World::new();
/// # let mut system = bevy_ecs::system::IntoSystem::into_system(brake);
/// # system.initialize(&mut world);
/// ```
#[derive(QueryData)]
#[query_data(mutable)]
pub struct Forces {
    entity: Entity,
    body: &'static RigidBody,
    position: &'static Position,
    rotation: &'static Rotation,
    linear_velocity: Access<LinearVelocity, true>,
    angular_velocity: Access<AngularVelocity, true>,
    pushed: &'static mut PushedVelocity,
    mass: &'static ComputedMass,
    inertia: &'static ComputedAngularInertia,
    center: &'static ComputedCenterOfMass,
    locks: Option<&'static LockedAxes>,
    data: &'static mut VelocityIntegrationData,
    local: &'static mut AccumulatedLocalAcceleration,
    sleep_timer: Option<&'static mut SleepTimer>,
    asleep: Has<Sleeping>,
}

/// [`Forces`] that do not wake the body. Made by [`non_waking`](ForcesItem::non_waking).
pub struct NonWakingForcesItem<'w, 's>(
    /// The forces that wake the body.
    pub ForcesItem<'w, 's>,
);

impl ForcesItem<'_, '_> {
    /// Reborrows the forces for a shorter lifetime, to be passed on by value.
    pub fn reborrow(&mut self) -> ForcesItem<'_, '_> {
        ForcesItem {
            entity: self.entity,
            body: self.body,
            position: self.position,
            rotation: self.rotation,
            linear_velocity: self.linear_velocity.reborrow(),
            angular_velocity: self.angular_velocity.reborrow(),
            pushed: self.pushed.reborrow(),
            mass: self.mass,
            inertia: self.inertia,
            center: self.center,
            locks: self.locks,
            data: self.data.reborrow(),
            local: self.local.reborrow(),
            sleep_timer: self.sleep_timer.as_mut().map(|timer| timer.reborrow()),
            asleep: self.asleep,
        }
    }

    /// The same forces without waking the body.
    pub fn non_waking(&mut self) -> NonWakingForcesItem<'_, '_> {
        NonWakingForcesItem(self.reborrow())
    }

    /// Whether the quantity is applied. Warns of a value that is not finite.
    fn admits(&self, what: &str, is_number: bool) -> bool {
        if !is_number {
            warn_of(what, self.entity);
        }
        is_number && self.body.is_dynamic()
    }

    /// Restarts the time until the body falls asleep.
    fn stay_awake(&mut self) {
        if let Some(timer) = &mut self.sleep_timer {
            timer.set_if_neq(SleepTimer(0.0));
        }
    }

    /// The linear velocity, to be written. A quiet change is detected only while the body is awake, and wakes
    /// nothing.
    fn linear_mut(&mut self, quiet: bool) -> &mut Vector {
        match &mut self.linear_velocity {
            Accessed::Mut(velocity) => {
                if let Some(pushed) = self.pushed.bypass_change_detection().linear.take(velocity.0) {
                    velocity.0 = pushed;
                }
                if quiet { &mut velocity.bypass_change_detection().0 } else { &mut velocity.0 }
            }
            Accessed::Ref(velocity) => {
                if !quiet {
                    self.data.set_changed();
                }
                self.pushed.bypass_change_detection().linear.start(velocity.0)
            }
        }
    }

    /// The angular velocity, to be written.
    fn angular_mut(&mut self, quiet: bool) -> &mut AngularVector {
        match &mut self.angular_velocity {
            Accessed::Mut(velocity) => {
                if let Some(pushed) = self.pushed.bypass_change_detection().angular.take(velocity.0) {
                    velocity.0 = pushed;
                }
                if quiet { &mut velocity.bypass_change_detection().0 } else { &mut velocity.0 }
            }
            Accessed::Ref(velocity) => {
                if !quiet {
                    self.data.set_changed();
                }
                self.pushed.bypass_change_detection().angular.start(velocity.0)
            }
        }
    }
}

impl<'w, 's> NonWakingForcesItem<'w, 's> {
    /// The same forces, waking the body.
    pub fn waking(self) -> ForcesItem<'w, 's> {
        self.0
    }
}

fn warn_of(what: &str, entity: Entity) {
    warn_once!("the {what} applied to {entity} is not finite or too large, and is ignored");
}

/// The state of a body that forces depend on.
pub struct Seen<'a> {
    pub(super) position: &'a Position,
    pub(super) rotation: &'a Rotation,
    linear_velocity: Vector,
    angular_velocity: AngularVector,
    mass: &'a ComputedMass,
    inertia: &'a ComputedAngularInertia,
    center: &'a ComputedCenterOfMass,
    locks: Option<&'a LockedAxes>,
    data: &'a VelocityIntegrationData,
    local: &'a AccumulatedLocalAcceleration,
}

impl Seen<'_> {
    fn response(&self) -> Response {
        Response::new(self.mass, self.inertia, self.rotation, self.locks)
    }

    /// The angular acceleration caused by a torque.
    pub(super) fn angular_response(&self, torque: AngularVector) -> AngularVector {
        self.response().angular(torque)
    }

    /// The vector from the centre of mass to a point of the world.
    fn arm(&self, world_point: Vector) -> Vector {
        world_point - (self.position.0 + self.rotation * self.center.0)
    }

    /// The torque of a force that acts at a point of the world.
    fn torque(&self, force: Vector, world_point: Vector) -> AngularVector {
        let arm = vector_to_kernel(self.arm(world_point));
        angular_from_kernel(arm.cross(vector_to_kernel(force)))
    }
}

/// The sums of accelerations of a body.
pub struct Sums<'a> {
    pub(super) data: &'a mut VelocityIntegrationData,
    pub(super) local: &'a mut AccumulatedLocalAcceleration,
}

/// Implementation details of the reading methods.
pub trait ReadRigidBodyForcesInternal {
    /// The state of the body.
    fn seen(&self) -> Seen<'_>;
}

/// Implementation details of the writing methods.
pub trait WriteRigidBodyForcesInternal: ReadRigidBodyForcesInternal {
    /// Whether the quantity is applied. Wakes the body in that case.
    fn admit(&mut self, what: &str, is_number: bool) -> bool;

    /// The sums of accelerations, to be written.
    fn sums(&mut self) -> Sums<'_>;

    /// The linear velocity, to be written.
    fn linear(&mut self) -> &mut Vector;

    /// The angular velocity, to be written.
    fn angular(&mut self) -> &mut AngularVector;

    /// Warns that a value cannot be applied.
    fn warn(&self, what: &str);
}

impl ReadRigidBodyForcesInternal for ForcesItem<'_, '_> {
    fn seen(&self) -> Seen<'_> {
        Seen {
            position: self.position,
            rotation: self.rotation,
            linear_velocity: self.pushed.linear.of(self.linear_velocity.get().0),
            angular_velocity: self.pushed.angular.of(self.angular_velocity.get().0),
            mass: self.mass,
            inertia: self.inertia,
            center: self.center,
            locks: self.locks,
            data: &self.data,
            local: &self.local,
        }
    }
}

impl ReadRigidBodyForcesInternal for ForcesReadOnlyItem<'_, '_> {
    fn seen(&self) -> Seen<'_> {
        Seen {
            position: self.position,
            rotation: self.rotation,
            linear_velocity: self.pushed.linear.of(self.linear_velocity.get().0),
            angular_velocity: self.pushed.angular.of(self.angular_velocity.get().0),
            mass: self.mass,
            inertia: self.inertia,
            center: self.center,
            locks: self.locks,
            data: self.data,
            local: self.local,
        }
    }
}

impl ReadRigidBodyForcesInternal for NonWakingForcesItem<'_, '_> {
    fn seen(&self) -> Seen<'_> {
        self.0.seen()
    }
}

impl WriteRigidBodyForcesInternal for ForcesItem<'_, '_> {
    fn admit(&mut self, what: &str, is_number: bool) -> bool {
        let admits = self.admits(what, is_number);
        if admits {
            self.stay_awake();
        }
        admits
    }

    fn sums(&mut self) -> Sums<'_> {
        Sums { data: &mut self.data, local: &mut self.local }
    }

    fn linear(&mut self) -> &mut Vector {
        self.linear_mut(false)
    }

    fn angular(&mut self) -> &mut AngularVector {
        self.angular_mut(false)
    }

    fn warn(&self, what: &str) {
        warn_of(what, self.entity);
    }
}

impl WriteRigidBodyForcesInternal for NonWakingForcesItem<'_, '_> {
    fn admit(&mut self, what: &str, is_number: bool) -> bool {
        self.0.admits(what, is_number) && !self.0.asleep
    }

    fn sums(&mut self) -> Sums<'_> {
        self.0.sums()
    }

    fn linear(&mut self) -> &mut Vector {
        let quiet = self.0.asleep;
        self.0.linear_mut(quiet)
    }

    fn angular(&mut self) -> &mut AngularVector {
        let quiet = self.0.asleep;
        self.0.angular_mut(quiet)
    }

    fn warn(&self, what: &str) {
        self.0.warn(what);
    }
}

/// Adds an acceleration to a sum.
fn accumulate<V: Quantity>(
    forces: &mut (impl WriteRigidBodyForcesInternal + ?Sized),
    what: &str,
    place: impl for<'a> Fn(Sums<'a>) -> &'a mut V,
    acceleration: V,
) {
    if acceleration == V::default() || !forces.admit(what, acceleration.is_number()) {
        return;
    }
    let sum = place(forces.sums());
    let after = *sum + acceleration;
    if after.is_number() {
        *sum = after;
    } else {
        forces.warn(what);
    }
}

/// Reads the state that forces depend on. Implemented by the items of [`Forces`].
pub trait ReadRigidBodyForces: ReadRigidBodyForcesInternal {
    /// The position of the body.
    fn position(&self) -> &Position {
        self.seen().position
    }

    /// The rotation of the body.
    fn rotation(&self) -> &Rotation {
        self.seen().rotation
    }

    /// The velocity of the centre of mass in m/s, including all applied impulses.
    fn linear_velocity(&self) -> Vector {
        self.seen().linear_velocity
    }

    /// The angular velocity in rad/s, including all applied impulses.
    fn angular_velocity(&self) -> AngularVector {
        self.seen().angular_velocity
    }

    /// The linear acceleration in world axes that was applied for the next step, in m/s². It does not include
    /// gravity and constant forces.
    fn accumulated_linear_acceleration(&self) -> Vector {
        let seen = self.seen();
        seen.data.linear_increment + seen.rotation * seen.local.linear
    }

    /// The angular acceleration in world axes that was applied for the next step, in rad/s². It does not
    /// include constant torques.
    fn accumulated_angular_acceleration(&self) -> AngularVector {
        let seen = self.seen();
        seen.data.angular_increment + seen.local.world_angular(seen.rotation)
    }

    /// The velocity in m/s of a point of the body, given in world space.
    fn velocity_at_point(&self, world_point: Vector) -> Vector {
        let seen = self.seen();
        let spin = angular_to_kernel(seen.angular_velocity);
        seen.linear_velocity + vector_from_kernel(spin.cross(vector_to_kernel(seen.arm(world_point))))
    }
}

/// Applies forces, torques, impulses and accelerations to a body. Implemented by the items of [`Forces`].
///
/// Only dynamic bodies respond. Locked axes act as an infinite mass or inertia. Forces and accelerations add
/// up and act during the next step; impulses change the velocity at once. A value that is not finite is
/// ignored, with one warning.
pub trait WriteRigidBodyForces: ReadRigidBodyForces + WriteRigidBodyForcesInternal {
    /// Applies a force in N at the centre of mass, along the world's axes.
    fn apply_force(&mut self, force: Vector) {
        let acceleration = self.seen().response().linear(force);
        accumulate(self, "force", |to| &mut to.data.linear_increment, acceleration);
    }

    /// Applies a force in N at a point of the world, along the world's axes. Off the centre of mass it also
    /// causes a torque.
    fn apply_force_at_point(&mut self, force: Vector, world_point: Vector) {
        let torque = self.seen().torque(force, world_point);
        self.apply_force(force);
        self.apply_torque(torque);
    }

    /// Applies a force in N at the centre of mass, along the body's own axes. It rotates with the body during
    /// the step.
    fn apply_local_force(&mut self, force: Vector) {
        let acceleration = force * self.seen().mass.inverse();
        accumulate(self, "force", |to| &mut to.local.linear, acceleration);
    }

    /// Applies a torque in N·m about the world's axes.
    fn apply_torque(&mut self, torque: AngularVector) {
        let acceleration = self.seen().angular_response(torque);
        accumulate(self, "torque", |to| &mut to.data.angular_increment, acceleration);
    }

    local_torque_methods!();

    /// Applies an impulse in N·s at the centre of mass, along the world's axes. The velocity changes at once.
    fn apply_linear_impulse(&mut self, impulse: Vector) {
        let seen = self.seen();
        let change = seen.response().linear(impulse);
        let is_number = (seen.linear_velocity + change).is_number();
        if change != Vector::ZERO && self.admit("impulse", is_number) {
            *self.linear() += change;
        }
    }

    /// Applies an impulse in N·s at a point of the world, along the world's axes. Off the centre of mass it
    /// also changes the angular velocity.
    fn apply_linear_impulse_at_point(&mut self, impulse: Vector, world_point: Vector) {
        let angular = self.seen().torque(impulse, world_point);
        self.apply_linear_impulse(impulse);
        self.apply_angular_impulse(angular);
    }

    /// Applies an impulse in N·s at the centre of mass, along the body's own axes.
    fn apply_local_linear_impulse(&mut self, impulse: Vector) {
        let impulse = self.seen().rotation * impulse;
        self.apply_linear_impulse(impulse);
    }

    /// Applies an angular impulse in N·m·s about the world's axes. The angular velocity changes at once.
    fn apply_angular_impulse(&mut self, impulse: AngularVector) {
        let seen = self.seen();
        let change = seen.angular_response(impulse);
        let is_number = (seen.angular_velocity + change).is_number();
        if change != AngularVector::default() && self.admit("angular impulse", is_number) {
            *self.angular() += change;
        }
    }

    /// Applies an acceleration in m/s² along the world's axes, independent of the mass.
    fn apply_linear_acceleration(&mut self, acceleration: Vector) {
        let acceleration = self.seen().response().free_linear(acceleration);
        accumulate(self, "acceleration", |to| &mut to.data.linear_increment, acceleration);
    }

    /// Applies an acceleration in m/s² at a point of the world. It is equal to
    /// [`apply_force_at_point`](Self::apply_force_at_point) with the force that gives the centre of mass this
    /// acceleration.
    fn apply_linear_acceleration_at_point(&mut self, acceleration: Vector, world_point: Vector) {
        let seen = self.seen();
        let torque = seen.torque(seen.response().force_of(acceleration), world_point);
        self.apply_linear_acceleration(acceleration);
        self.apply_torque(torque);
    }

    /// Applies an acceleration in m/s² along the body's own axes, independent of the mass. It rotates with
    /// the body during the step.
    fn apply_local_linear_acceleration(&mut self, acceleration: Vector) {
        accumulate(self, "acceleration", |to| &mut to.local.linear, acceleration);
    }

    /// Applies an angular acceleration in rad/s² about the world's axes, independent of the inertia.
    fn apply_angular_acceleration(&mut self, acceleration: AngularVector) {
        let acceleration = self.seen().response().free_angular(acceleration);
        accumulate(self, "angular acceleration", |to| &mut to.data.angular_increment, acceleration);
    }

    /// The velocity of the centre of mass in m/s, to be written. A change wakes the body if these forces wake
    /// bodies.
    fn linear_velocity_mut(&mut self) -> &mut Vector {
        self.linear()
    }

    /// The angular velocity in rad/s, to be written. A change wakes the body if these forces wake bodies.
    fn angular_velocity_mut(&mut self) -> &mut AngularVector {
        self.angular()
    }

    /// Removes all forces and linear accelerations that were applied for the next step.
    fn reset_accumulated_linear_acceleration(&mut self) {
        let sums = self.sums();
        sums.data.linear_increment = Vector::ZERO;
        sums.local.linear = Vector::ZERO;
    }

    /// Removes all torques and angular accelerations that were applied for the next step.
    fn reset_accumulated_angular_acceleration(&mut self) {
        let sums = self.sums();
        sums.data.angular_increment = AngularVector::default();
        sums.local.reset_angular();
    }
}

/// Reads and applies forces: both [`ReadRigidBodyForces`] and [`WriteRigidBodyForces`], for generic code.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// fn brake(forces: &mut impl RigidBodyForces, rate: avian::math::Scalar) {
///     let velocity = forces.linear_velocity();
///     forces.apply_linear_acceleration(-rate * velocity);
/// }
/// ```
pub trait RigidBodyForces: ReadRigidBodyForces + WriteRigidBodyForces {}

impl ReadRigidBodyForces for ForcesItem<'_, '_> {}
impl ReadRigidBodyForces for ForcesReadOnlyItem<'_, '_> {}
impl ReadRigidBodyForces for NonWakingForcesItem<'_, '_> {}
impl WriteRigidBodyForces for ForcesItem<'_, '_> {}
impl WriteRigidBodyForces for NonWakingForcesItem<'_, '_> {}
impl<T: ReadRigidBodyForces + WriteRigidBodyForces> RigidBodyForces for T {}
