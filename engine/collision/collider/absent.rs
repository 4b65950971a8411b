//! Stands in for the default collider without feature `default-collider`: a type without values, so that no
//! entity has one and queries for it are empty.

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

/// Contact manifolds of a collider that the kernel has no shape for, and a ball.
pub(crate) fn foreign_ball_manifolds(
    collider: &Collider,
    _: Vector,
    _: f32,
    _: f32,
    _: &mut Vec<LocalManifold>,
) {
    match *collider {}
}

/// Contact manifolds of two colliders, one of which the kernel has no shape for.
pub(crate) fn foreign_manifolds(a: &Collider, _: &Collider, _: &Pose, _: f32, _: &mut Vec<LocalManifold>) {
    match *a {}
}
