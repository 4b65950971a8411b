//! Materials of individual triangles and segments of a collider.

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::{Friction, Restitution};
use crate::math::Vector;

/// Materials of individual facets of a collider, which replace its [`Friction`] and [`Restitution`]: for ice
/// and rubber, or a conveyor belt, in one mesh.
///
/// The facets are the triangles (in 2D the segments) of a mesh, polyline or height field and the parts of a
/// compound, in the order of [`Collider::parts`]. The component has no effect on convex shapes and voxels.
/// Insert it on the collider's entity, not on the body's.
///
/// Contacts with facets of different materials have one manifold per material. Changes take effect in the
/// next step.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn setup(mut commands: Commands) {
///     let corners = vec![Vector::X * -5.0, Vector::ZERO, Vector::X * 5.0];
///     commands.spawn((
///         RigidBody::Static,
///         Collider::polyline(corners, None),
///         FacetMaterials {
///             materials: vec![FacetMaterial::from(Friction::ZERO), FacetMaterial::from(Friction::new(1.0))],
///             // The first segment is ice, the second rubber.
///             facets: vec![0, 1],
///         },
///     ));
/// }
/// ```
///
/// [`Collider::parts`]: crate::collision::collider::Collider::parts
#[derive(Component, Reflect, Clone, Debug, Default, PartialEq)]
#[reflect(Component, Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct FacetMaterials {
    /// The materials, at most 255.
    pub materials: Vec<FacetMaterial>,
    /// The index in `materials` of each facet. Facets without an index, or with an index out of range, have
    /// the material of the collider.
    pub facets: Vec<u8>,
}

/// The material of some facets of a collider.
#[derive(Reflect, Clone, Copy, Debug, Default, PartialEq)]
#[reflect(Debug, Default, PartialEq)]
#[cfg_attr(
    feature = "serialize",
    derive(serde::Serialize, serde::Deserialize),
    reflect(Serialize, Deserialize)
)]
pub struct FacetMaterial {
    /// The friction.
    pub friction: Friction,
    /// The restitution.
    pub restitution: Restitution,
    /// The velocity at which friction carries bodies that lie on the facets, in the collider's frame, m/s.
    /// Only the component in the tangent plane counts.
    pub tangent_velocity: Vector,
}

impl From<Friction> for FacetMaterial {
    fn from(friction: Friction) -> Self {
        Self { friction, ..Self::default() }
    }
}
