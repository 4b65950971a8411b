//! The constructors of 3D colliders as data. See `dim2` for 2D.

pub mod trimesh_builder;

use bevy_app::App;
use bevy_ecs::prelude::Component;
use bevy_ecs::reflect::ReflectComponent;
use bevy_reflect::Reflect;
#[cfg(feature = "collider-from-mesh")]
use bevy_reflect::std_traits::ReflectDefault;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::{
    collision::collider::{FillMode, TrimeshFlags, VhacdParameters},
    math::{Scalar, Vector},
    parry::math::IVector,
    physics_transform::{Position, Rotation},
};

#[cfg(feature = "collider-from-mesh")]
pub(super) use bevy_mesh::Mesh3d as MeshComponent;

/// Makes a [`Collider`](crate::collision::collider::Collider) on the same entity, from data or from its mesh.
///
/// The constructor is processed in `Update` and then removed. Its variants are the constructors of
/// `Collider`, as data that is reflected and stored, so that editors and scene files can describe colliders.
/// Variants whose names end in `FromMesh` need feature `collider-from-mesh` and a mesh (`Mesh3d`) on the
/// entity, and wait until the mesh is loaded.
///
/// - A collider that the entity has already is replaced.
/// - [`ColliderConstructorReady`](super::ColliderConstructorReady) is triggered after the collider
///   was inserted.
/// - A constructor that is removed before its mesh is loaded has no effect.
/// - If the entity has no mesh, one warning names it, and the constructor waits for a mesh.
/// - If the values make no shape, or the mesh cannot be loaded, one warning names the entity, and the
///   constructor is removed without an event.
///
/// [`ColliderConstructorHierarchy`](super::ColliderConstructorHierarchy) does the same for all descendants
/// of an entity.
///
/// ```
/// # use avian::{math::Vector, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn setup(mut commands: Commands) {
///     commands.spawn((RigidBody::Dynamic, ColliderConstructor::Capsule { radius: 0.4, height: 1.0 }));
///     commands.spawn((RigidBody::Static, ColliderConstructor::HalfSpace { outward_normal: Vector::Y }));
/// }
/// ```
#[derive(Clone, Debug, PartialEq, Reflect, Component)]
#[cfg_attr(feature = "collider-from-mesh", derive(Default))]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[reflect(type_path = false, no_field_bounds, Debug, Component, PartialEq)]
#[cfg_attr(feature = "collider-from-mesh", reflect(Default))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[non_exhaustive]
pub enum ColliderConstructor {
    /// [`Collider::sphere`](crate::collision::collider::Collider::sphere).
    Sphere {
        /// Radius in metres.
        radius: Scalar,
    },
    /// [`Collider::cuboid`](crate::collision::collider::Collider::cuboid).
    Cuboid {
        /// Length along the X axis in metres.
        x_length: Scalar,
        /// Length along the Y axis in metres.
        y_length: Scalar,
        /// Length along the Z axis in metres.
        z_length: Scalar,
    },
    /// [`Collider::round_cuboid`](crate::collision::collider::Collider::round_cuboid).
    RoundCuboid {
        /// Length along the X axis in metres.
        x_length: Scalar,
        /// Length along the Y axis in metres.
        y_length: Scalar,
        /// Length along the Z axis in metres.
        z_length: Scalar,
        /// Radius of the border around it, in metres.
        border_radius: Scalar,
    },
    /// [`Collider::cylinder`](crate::collision::collider::Collider::cylinder).
    Cylinder {
        /// Radius in metres.
        radius: Scalar,
        /// Height in metres.
        height: Scalar,
    },
    /// [`Collider::cone`](crate::collision::collider::Collider::cone).
    Cone {
        /// Radius in metres.
        radius: Scalar,
        /// Height in metres.
        height: Scalar,
    },
    /// [`Collider::capsule`](crate::collision::collider::Collider::capsule).
    Capsule {
        /// Radius in metres.
        radius: Scalar,
        /// Length of the segment in metres, without the caps.
        height: Scalar,
    },
    /// [`Collider::capsule_endpoints`](crate::collision::collider::Collider::capsule_endpoints).
    CapsuleEndpoints {
        /// Radius in metres.
        radius: Scalar,
        /// One end of the segment.
        a: Vector,
        /// The other end.
        b: Vector,
    },
    /// [`Collider::half_space`](crate::collision::collider::Collider::half_space).
    HalfSpace {
        /// The normal of the surface, of any length but zero.
        outward_normal: Vector,
    },
    /// [`Collider::segment`](crate::collision::collider::Collider::segment).
    Segment {
        /// One end.
        a: Vector,
        /// The other end.
        b: Vector,
    },
    /// [`Collider::triangle`](crate::collision::collider::Collider::triangle).
    Triangle {
        /// First corner.
        a: Vector,
        /// Second corner.
        b: Vector,
        /// Third corner.
        c: Vector,
    },
    /// [`Collider::polyline`](crate::collision::collider::Collider::polyline).
    Polyline {
        /// The ends of the segments.
        vertices: Vec<Vector>,
        /// The segments; `None` connects each vertex to the next.
        indices: Option<Vec<[u32; 2]>>,
    },
    /// [`Collider::trimesh`](crate::collision::collider::Collider::trimesh).
    Trimesh {
        /// The corners.
        vertices: Vec<Vector>,
        /// The triangles.
        indices: Vec<[u32; 3]>,
    },
    /// [`Collider::trimesh_with_config`](crate::collision::collider::Collider::trimesh_with_config).
    TrimeshWithConfig {
        /// The corners.
        vertices: Vec<Vector>,
        /// The triangles.
        indices: Vec<[u32; 3]>,
        /// Preprocessing.
        flags: TrimeshFlags,
    },
    /// [`Collider::convex_decomposition`](crate::collision::collider::Collider::convex_decomposition).
    ConvexDecomposition {
        /// The corners.
        vertices: Vec<Vector>,
        /// The triangles of the surface.
        indices: Vec<[u32; 3]>,
    },
    /// [`Collider::convex_decomposition_with_config`](crate::collision::collider::Collider::convex_decomposition_with_config).
    ConvexDecompositionWithConfig {
        /// The corners.
        vertices: Vec<Vector>,
        /// The triangles of the surface.
        indices: Vec<[u32; 3]>,
        /// Parameters of the decomposition.
        params: VhacdParameters,
    },
    /// [`Collider::convex_hull`](crate::collision::collider::Collider::convex_hull).
    ConvexHull {
        /// The points.
        points: Vec<Vector>,
    },
    /// [`Collider::voxels`](crate::collision::collider::Collider::voxels).
    Voxels {
        /// Size of a voxel in metres.
        voxel_size: Vector,
        /// The voxels that are filled.
        grid_coordinates: Vec<IVector>,
    },
    /// [`Collider::voxelized_trimesh`](crate::collision::collider::Collider::voxelized_trimesh).
    VoxelizedTrimesh {
        /// The corners.
        vertices: Vec<Vector>,
        /// The triangles of the surface.
        indices: Vec<[u32; 3]>,
        /// Side of a voxel in metres.
        voxel_size: Scalar,
        /// Which voxels are filled.
        fill_mode: FillMode,
    },
    /// [`Collider::heightfield`](crate::collision::collider::Collider::heightfield).
    Heightfield {
        /// Heights on a grid.
        heights: Vec<Vec<Scalar>>,
        /// Size of the whole field along X and Z, and factor of the heights.
        scale: Vector,
    },
    /// [`Collider::trimesh_from_mesh`](crate::collision::collider::Collider::trimesh_from_mesh).
    #[cfg(feature = "collider-from-mesh")]
    #[default]
    TrimeshFromMesh,
    /// [`Collider::trimesh_from_mesh_with_config`](crate::collision::collider::Collider::trimesh_from_mesh_with_config).
    #[cfg(feature = "collider-from-mesh")]
    TrimeshFromMeshWithConfig(TrimeshFlags),
    /// [`Collider::convex_decomposition_from_mesh`](crate::collision::collider::Collider::convex_decomposition_from_mesh).
    #[cfg(feature = "collider-from-mesh")]
    ConvexDecompositionFromMesh,
    /// [`Collider::convex_decomposition_from_mesh_with_config`](crate::collision::collider::Collider::convex_decomposition_from_mesh_with_config).
    #[cfg(feature = "collider-from-mesh")]
    ConvexDecompositionFromMeshWithConfig(VhacdParameters),
    /// [`Collider::convex_hull_from_mesh`](crate::collision::collider::Collider::convex_hull_from_mesh).
    #[cfg(feature = "collider-from-mesh")]
    ConvexHullFromMesh,
    /// [`Collider::voxelized_trimesh_from_mesh`](crate::collision::collider::Collider::voxelized_trimesh_from_mesh).
    #[cfg(feature = "collider-from-mesh")]
    VoxelizedTrimeshFromMesh {
        /// Side of a voxel in metres.
        voxel_size: Scalar,
        /// Which voxels are filled.
        fill_mode: FillMode,
    },
    /// [`Collider::compound`](crate::collision::collider::Collider::compound).
    Compound(Vec<(Position, Rotation, ColliderConstructor)>),
}

crate::type_path::type_path!(ColliderConstructor, "collision::collider::constructor");

#[cfg(feature = "collider-from-mesh")]
impl ColliderConstructor {
    /// Whether the constructor or a part of it needs a mesh.
    pub fn requires_mesh(&self) -> bool {
        match self {
            Self::TrimeshFromMesh
            | Self::TrimeshFromMeshWithConfig(_)
            | Self::ConvexDecompositionFromMesh
            | Self::ConvexDecompositionFromMeshWithConfig(_)
            | Self::ConvexHullFromMesh
            | Self::VoxelizedTrimeshFromMesh { .. } => true,
            Self::Compound(parts) => parts.iter().any(|(.., part)| part.requires_mesh()),
            _ => false,
        }
    }
}

/// Registers the types of this folder for reflection.
pub(crate) fn register_types(app: &mut App) {
    app.register_type::<ColliderConstructor>().register_type::<trimesh_builder::Trimesh>();
}
