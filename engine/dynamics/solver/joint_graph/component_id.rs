//! [`JointComponentId`]: the type of an entity's joint.

use bevy_ecs::{
    component::{Component, ComponentId},
    reflect::ReflectComponent,
};
use bevy_reflect::{Reflect, std_traits::ReflectDefault};

/// The id of the component that is the entity's joint. An entity has at most one joint.
#[derive(Component, Clone, Debug, Default, PartialEq, Reflect)]
#[reflect(type_path = false, Debug, Component, Default, PartialEq)]
pub struct JointComponentId(#[reflect(ignore)] pub(super) Option<ComponentId>);

crate::type_path::type_path!(JointComponentId, "dynamics::solver::joint_graph::plugin");

impl JointComponentId {
    /// No joint.
    pub fn new() -> Self {
        Self::default()
    }

    /// The id of the joint's component.
    pub fn id(&self) -> Option<ComponentId> {
        self.0
    }
}
