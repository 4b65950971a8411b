//! Replaces the default collider in builds without feature `default-collider`: a type without values. No
//! entity has this component, so queries for it are empty.

use bevy_ecs::prelude::Component;
use kernel::{
    manifold::LocalManifold,
    math::{Pose, Vector},
    shape::Shape,
};

/// No collider.
#[derive(Component)]
pub(crate) enum Collider {}

impl Collider {
    /// The shape in the kernel's format.
    pub(crate) fn native(&self) -> &Shape {
        match *self {}
    }
}

/// Contact manifolds of a ball and a collider whose shape the kernel does not support.
pub(crate) fn foreign_ball_manifolds(
    collider: &Collider,
    _: Vector,
    _: f32,
    _: f32,
    _: &mut Vec<LocalManifold>,
) {
    match *collider {}
}

/// Contact manifolds of two colliders. The kernel does not support the shape of at least one.
pub(crate) fn foreign_manifolds(a: &Collider, _: &Collider, _: &Pose, _: f32, _: &mut Vec<LocalManifold>) {
    match *a {}
}
