//! Velocities of kinematic bodies that follow their `Transform`.

use bevy_ecs::prelude::*;
use bevy_time::Time;
use kernel::table::NONE;

use crate::{
    dynamics::{
        ids::BodyId,
        rigid_body::{AngularVelocity, LinearVelocity, mass_properties::components::ComputedCenterOfMass},
        tables::Bodies,
    },
    math::{Scalar, angular_to_kernel},
    physics_transform::{
        Position, Rotation,
        follow::{Followed, Lead, Target},
        said_pose,
    },
    schedule::{Physics, TimePrecisionAdjusted},
};

/// Maximum distance, as a fraction of the coordinates, and maximum angle in rad, at which a body is at its
/// target: the rounding of a step. A body that does not move must be at rest, so that bodies on it can sleep.
const ROUNDING: Scalar = 2.0e-6;

/// Components of a body that follows its transform.
type Follower = (
    &'static BodyId,
    &'static mut Followed,
    &'static mut Position,
    &'static mut Rotation,
    &'static mut LinearVelocity,
    &'static mut AngularVelocity,
    &'static ComputedCenterOfMass,
);

/// Gives each body that follows its transform the velocity to reach it in this step. If the app set the
/// body's pose, the body stays there and rests.
pub(crate) fn follow_transforms(
    mut followers: Query<Follower>,
    bodies: Res<Bodies>,
    time: Res<Time<Physics>>,
) {
    let dt = time.delta_seconds_adjusted();
    for (id, mut followed, mut position, mut rotation, mut linear, mut angular, center) in &mut followers {
        if !followed.is_led() {
            followed.lead = Lead::Pose;
            continue;
        }
        if id.0 == NONE {
            continue;
        }
        let (mut v, mut w) = (LinearVelocity::ZERO, AngularVelocity::ZERO);
        if bodies.seen[id.0 as usize] != said_pose(&position, &rotation) {
            followed.stop();
        } else if let Some(Target { place: (to, turned), is_same, is_late }) = followed.take() {
            // Bodies rotate about their centre of mass.
            let way = to.0 + turned * center.0 - (position.0 + *rotation * center.0);
            let turn = rotation.turn_to(turned);
            let size = 1.0 + to.0.abs().max_element();
            let is_there = way.length_squared() <= (ROUNDING * size) * (ROUNDING * size)
                && Scalar::from(angular_to_kernel(turn).length_squared()) <= ROUNDING * ROUNDING;
            let velocity = (LinearVelocity(way / dt), AngularVelocity(turn / dt));
            let is_finite = velocity.0.is_finite() && angular_to_kernel(velocity.1.0).is_finite();
            if is_late || !is_finite {
                position.set_if_neq(to);
                rotation.set_if_neq(turned);
            } else if !(is_same && is_there) {
                (v, w) = velocity;
            }
        }
        linear.set_if_neq(v);
        angular.set_if_neq(w);
    }
}
