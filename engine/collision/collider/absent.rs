//! What stands where the default collider would, without feature `default-collider`: a type that has no value,
//! so that no entity ever has one and nothing that asks for it finds any.

use bevy_ecs::prelude::Component;
use kernel::{manifold::LocalManifold, math::Pose, shape::Shape};

/// No collider.
#[derive(Component)]
pub(crate) enum Collider {}

impl Collider {
    /// The shape as the kernel has it.
    pub(crate) fn native(&self) -> &Shape {
        match *self {}
    }
}

/// Buffers of nothing.
pub(crate) type Workspace = ();

/// The contact manifolds of two colliders of which the kernel does not know one.
pub(crate) fn foreign_manifolds(
    a: &Collider,
    _: &Collider,
    _: &Pose,
    _: f32,
    (): &mut Workspace,
    _: &mut Vec<LocalManifold>,
) {
    match *a {}
}
