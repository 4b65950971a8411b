//! Numbers of bodies, colliders and joints.

use super::{PhysicsDiagnosticsSystems, Within, diagnostic_paths, list};
use crate::{
    collision::collider::ColliderMarker,
    dynamics::{
        joints::JointDisabled,
        rigid_body::{RigidBody, RigidBodyDisabled},
        solver::joint_graph::JointComponentId,
    },
    schedule::PhysicsSchedule,
};
use bevy_app::{App, Plugin};
use bevy_ecs::prelude::*;
use bevy_reflect::{Reflect, std_traits::ReflectDefault};

/// Counts bodies, colliders and joints after each step, in [`PhysicsEntityDiagnostics`].
pub struct PhysicsEntityDiagnosticsPlugin;

impl Plugin for PhysicsEntityDiagnosticsPlugin {
    fn build(&self, app: &mut App) {
        list::<PhysicsEntityDiagnostics>(app, Within::Nothing);
        app.add_systems(PhysicsSchedule, count_entities.in_set(PhysicsDiagnosticsSystems::Reset));
    }
}

/// Numbers of entities in physics, counted before the last step.
#[derive(Resource, Debug, Default, Reflect)]
#[reflect(Resource, Debug, Default)]
pub struct PhysicsEntityDiagnostics {
    /// Number of dynamic bodies.
    pub dynamic_body_count: u32,
    /// Number of kinematic bodies.
    pub kinematic_body_count: u32,
    /// Number of static bodies.
    pub static_body_count: u32,
    /// Number of colliders.
    pub collider_count: u32,
    /// Number of joints that are not disabled.
    pub joint_count: u32,
}

diagnostic_paths! {
    PhysicsEntityDiagnostics {
        counter DYNAMIC_BODY_COUNT: "avian/entity_count/dynamic_bodies" = dynamic_body_count,
        counter KINEMATIC_BODY_COUNT: "avian/entity_count/kinematic_bodies" = kinematic_body_count,
        counter STATIC_BODY_COUNT: "avian/entity_count/static_bodies" = static_body_count,
        counter COLLIDER_COUNT: "avian/entity_count/colliders" = collider_count,
        counter JOINT_COUNT: "avian/entity_count/joints" = joint_count,
    }
    reset keep
}

/// Keeps the old numbers, since each step counts them anew.
fn keep(_: ResMut<PhysicsEntityDiagnostics>) {}

fn count_entities(
    bodies: Query<&RigidBody, Without<RigidBodyDisabled>>,
    colliders: Query<(), With<ColliderMarker>>,
    joints: Query<(), (With<JointComponentId>, Without<JointDisabled>)>,
    mut diagnostics: ResMut<PhysicsEntityDiagnostics>,
) {
    let mut counts = PhysicsEntityDiagnostics::default();
    for body in &bodies {
        match body {
            RigidBody::Dynamic => counts.dynamic_body_count += 1,
            RigidBody::Kinematic => counts.kinematic_body_count += 1,
            RigidBody::Static => counts.static_body_count += 1,
        }
    }
    let count = |all: usize| u32::try_from(all).unwrap_or(u32::MAX);
    counts.collider_count = count(colliders.iter().count());
    counts.joint_count = count(joints.iter().count());
    *diagnostics = counts;
}
