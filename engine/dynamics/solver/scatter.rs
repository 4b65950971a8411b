//! From rows back to components, and which bodies have come to rest.

use bevy_ecs::prelude::*;
use bevy_time::Time;
use kernel::{
    math::Vector as KernelVector,
    table::{BodyKind, NONE, Velocity},
};

use crate::{
    dynamics::{
        integrator::CustomPositionIntegration,
        lifecycle::BodyId,
        quarantine::{is_finite, quarantine},
        rigid_body::{
            AngularVelocity, LinearVelocity,
            sleeping::{SleepThreshold, SleepTimer, SleepingDisabled},
        },
        solver::{PhysicsLengthUnit, StepSolver},
        tables::Bodies,
    },
    math::{angular_from_kernel, vector_from_kernel},
    physics_transform::{Position, Rotation, set_pose, world_pose},
    schedule::Physics,
};

/// What a body's motion is written to.
type Output = (
    Entity,
    &'static BodyId,
    &'static mut Position,
    &'static mut Rotation,
    &'static mut LinearVelocity,
    &'static mut AngularVelocity,
    Option<&'static SleepThreshold>,
    Has<SleepingDisabled>,
    Option<&'static mut SleepTimer>,
    Has<CustomPositionIntegration>,
);

/// Folds each awake body's motion into its pose, and writes pose and velocity where they changed.
///
/// A body whose result is not finite keeps the pose it had, stops, and is disabled with one warning: a NaN
/// must not spread.
pub(crate) fn scatter_bodies(
    mut query: Query<Output>,
    solver: Res<StepSolver>,
    time: Res<Time<Physics>>,
    unit: Res<PhysicsLengthUnit>,
    mut bodies: ResMut<Bodies>,
    mut commands: Commands,
) {
    let dt = time.delta_secs();
    let unit = unit.metres();
    let mut write = |item: <Output as bevy_ecs::query::QueryData>::Item<'_, '_>| {
        let (entity, id, position, rotation, linear, angular, threshold, sleepless, timer, own_position) =
            item;
        let row = if id.0 == NONE { 0 } else { bodies.table.rows[id.0 as usize] };
        if row == 0 {
            return;
        }
        let body = &solver.kernel.bodies.rows[row as usize];
        let (v, w) = body.velocity();
        let (moved, turned) = if own_position { Default::default() } else { body.delta() };
        let old = bodies.table.poses[id.0 as usize];
        let mut pose = old;
        pose.center = old.center + moved.to_world();
        pose.rotation = turned.mul(old.rotation).normalized();
        let result =
            v.is_finite() && w.is_finite() && pose.center.is_finite_world() && pose.rotation.is_finite();
        // What came in not finite was left out of the step.
        let given =
            linear.is_finite() && angular.0.is_finite() && is_finite(&world_pose(&position, &rotation));
        if !(result && given) {
            quarantine(entity, Some(bodies.table.frame(id.0)), &mut commands);
            return;
        }
        bodies.table.poses[id.0 as usize] = pose;
        if bodies.table[id.0].kind == BodyKind::Dynamic {
            bodies.table.set_velocity(id.0, Velocity { linear: v, angular: w });
            write_changed(linear, LinearVelocity(vector_from_kernel(v)));
            write_changed(angular, AngularVelocity(angular_from_kernel(w)));
        }
        if pose != old {
            set_pose(position, rotation, bodies.table.frame(id.0));
        }
        let threshold = threshold.copied().unwrap_or_default();
        let angle = old.rotation.difference(pose.rotation).length();
        let rests = !sleepless && is_slow(&threshold, moved, angle, unit, dt);
        let body = &mut bodies.table[id.0];
        body.sleep_timer = if rests { body.sleep_timer + dt } else { 0.0 };
        if sleepless {
            body.sleep_timer = f32::NEG_INFINITY;
        }
        if let Some(mut timer) = timer {
            timer.0 = body.sleep_timer.max(0.0);
        }
    };
    for item in &mut query {
        write(item);
    }
}

/// Writes, and marks as changed, only what differs.
fn write_changed<T: PartialEq>(mut target: Mut<T>, value: T) {
    if *target != value {
        *target = value;
    }
}

/// Whether a body moved and turned less in this step than its thresholds allow. Judged on displacement,
/// not velocity: what jitters in place rests.
fn is_slow(threshold: &SleepThreshold, moved: KernelVector, angle: f32, unit: f32, dt: f32) -> bool {
    // A negative threshold, or NaN, never rests.
    threshold.linear >= 0.0
        && threshold.angular >= 0.0
        && moved.length() <= threshold.linear * unit * dt
        && angle <= threshold.angular * dt
}
