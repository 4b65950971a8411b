//! Colliders from [`ColliderConstructor`]s.

#[cfg(feature = "collider-from-mesh")]
use bevy_mesh::Mesh;

use super::{Collider, ColliderError, shapes::from_constructor::build};
use crate::collision::collider::constructor::ColliderConstructor;

impl Collider {
    /// The collider that a constructor describes; `None` if its values make no shape.
    ///
    /// Unlike the constructors of `Collider`, this function does not repair NaN or sizes that are zero or
    /// negative. It repairs only heights of height fields and parameters of decompositions. Single elements
    /// of a mesh that cannot be used are left out. Constructors from meshes return `None` without a mesh, if
    /// the mesh has no triangles, or if its data was moved to the render world.
    #[cfg(feature = "collider-from-mesh")]
    pub fn try_from_constructor(
        collider_constructor: ColliderConstructor,
        mesh: Option<&Mesh>,
    ) -> Option<Self> {
        Self::from_constructor(&collider_constructor, mesh).ok()
    }

    /// The collider that a constructor describes; `None` if its values make no shape.
    ///
    /// Unlike the constructors of `Collider`, this function does not repair NaN or sizes that are zero or
    /// negative. It repairs only heights of height fields and parameters of decompositions. Single elements
    /// of a mesh that cannot be used are left out. With feature `collider-from-mesh` there is a second
    /// parameter: the mesh.
    #[cfg(not(feature = "collider-from-mesh"))]
    pub fn try_from_constructor(collider_constructor: ColliderConstructor) -> Option<Self> {
        Self::from_constructor(&collider_constructor, None).ok()
    }

    /// The collider that a constructor describes, or the reason why there is none.
    pub(crate) fn from_constructor(
        constructor: &ColliderConstructor,
        mesh: Option<&super::mesh_type::Mesh>,
    ) -> Result<Self, ColliderError> {
        build(constructor, mesh)
    }
}
