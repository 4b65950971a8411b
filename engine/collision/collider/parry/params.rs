//! Settings of mesh colliders, convex decomposition and voxelisation. Parry's own types have no reflection,
//! and their paths depend on dimension and precision.

use crate::math::Scalar;
use bevy_reflect::Reflect;
use bevy_reflect::std_traits::ReflectDefault;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bitflags::bitflags;

use super::dim;

/// Settings of the decomposition of a shape into convex ones (V-HACD, Mamou and Ghorbel 2009).
#[derive(Clone, PartialEq, Debug, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, Default, PartialEq)]
pub struct VhacdParameters {
    /// How much a part may deviate from its convex hull, 0 to 1. Default 0.1 in 2D, 0.01 in 3D.
    pub concavity: Scalar,
    /// The preference for cuts along planes of symmetry, 0 to 1. Default 0.05.
    pub alpha: Scalar,
    /// The preference for cuts along axes of revolution, 0 to 1. Default 0.05.
    pub beta: Scalar,
    /// The number of voxels along the longest side. Default 256 in 2D, 64 in 3D.
    pub resolution: u32,
    /// A cut is tried at every n-th voxel. Default 4.
    pub plane_downsampling: u32,
    /// Every n-th point of a part is used for its hull while cuts are compared. Default 4.
    pub convex_hull_downsampling: u32,
    /// How the inside is distinguished from the outside. Default flood filling without cavities.
    pub fill_mode: FillMode,
    /// Whether hulls are approximated while cuts are compared. Default true.
    pub convex_hull_approximation: bool,
    /// Maximum number of parts. Default 1024.
    pub max_convex_hulls: u32,
}

crate::type_path::type_path!(VhacdParameters, "collision::collider::parry");

impl Default for VhacdParameters {
    fn default() -> Self {
        Self {
            concavity: dim::VHACD_CONCAVITY,
            alpha: 0.05,
            beta: 0.05,
            resolution: dim::VHACD_RESOLUTION,
            plane_downsampling: 4,
            convex_hull_downsampling: 4,
            fill_mode: FillMode::USUAL,
            convex_hull_approximation: true,
            max_convex_hulls: 1024,
        }
    }
}

impl From<VhacdParameters> for crate::parry::transformation::vhacd::VHACDParameters {
    fn from(value: VhacdParameters) -> Self {
        Self {
            concavity: value.concavity,
            alpha: value.alpha,
            beta: value.beta,
            resolution: value.resolution,
            plane_downsampling: value.plane_downsampling,
            convex_hull_downsampling: value.convex_hull_downsampling,
            fill_mode: value.fill_mode.into(),
            convex_hull_approximation: value.convex_hull_approximation,
            max_convex_hulls: value.max_convex_hulls,
        }
    }
}

/// How voxelisation distinguishes the inside of a closed surface from the outside.
#[derive(Hash, Clone, Copy, PartialEq, Eq, Debug, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Hash, Debug, PartialEq)]
pub enum FillMode {
    /// Only voxels that the surface passes through are filled.
    SurfaceOnly,
    /// Voxels that cannot be reached from outside are filled as well.
    FloodFill {
        /// Whether closed surfaces inside other surfaces are holes.
        detect_cavities: bool,
        /// Whether outlines that cross themselves are supported.
        #[cfg(feature = "2d")]
        detect_self_intersections: bool,
    },
}

crate::type_path::type_path!(FillMode, "collision::collider::parry");

/// Preprocessing of a mesh collider, as bits.
#[repr(transparent)]
#[derive(Hash, Clone, Copy, PartialEq, Eq, Debug, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, opaque, Hash, Clone, Debug, PartialEq)]
pub struct TrimeshFlags(u8);

crate::type_path::type_path!(TrimeshFlags, "collision::collider::parry");

bitflags! {
    impl TrimeshFlags: u8 {
        /// Finds which triangles share an edge.
        const HALF_EDGE_TOPOLOGY = 1;
        /// Finds connected components. Implies the topology.
        const CONNECTED_COMPONENTS = 2;
        /// Drops triangles that make the topology invalid.
        const DELETE_BAD_TOPOLOGY_TRIANGLES = 4;
        /// Treats the mesh as a closed surface with outward triangles, so that it has an inside.
        const ORIENTED = 8;
        /// Joins vertices at the same place.
        const MERGE_DUPLICATE_VERTICES = 16;
        /// Drops triangles without an area. Joins vertices too.
        const DELETE_DEGENERATE_TRIANGLES = 32;
        /// Drops triangles with the same three vertices. Joins vertices too.
        const DELETE_DUPLICATE_TRIANGLES = 64;
        /// Prevents bodies from catching on edges between triangles of one surface.
        const FIX_INTERNAL_EDGES = 128 | Self::ORIENTED.bits() | Self::MERGE_DUPLICATE_VERTICES.bits();
    }
}

impl From<TrimeshFlags> for crate::parry::shape::TriMeshFlags {
    fn from(value: TrimeshFlags) -> Self {
        Self::from_bits_truncate(value.bits().into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parry::shape::TriMeshFlags;
    use crate::parry::transformation::vhacd::VHACDParameters;

    #[test]
    fn flags_mean_the_same_to_parry() {
        let pairs = [
            (TrimeshFlags::HALF_EDGE_TOPOLOGY, TriMeshFlags::HALF_EDGE_TOPOLOGY),
            (TrimeshFlags::CONNECTED_COMPONENTS, TriMeshFlags::CONNECTED_COMPONENTS),
            (TrimeshFlags::DELETE_BAD_TOPOLOGY_TRIANGLES, TriMeshFlags::DELETE_BAD_TOPOLOGY_TRIANGLES),
            (TrimeshFlags::ORIENTED, TriMeshFlags::ORIENTED),
            (TrimeshFlags::MERGE_DUPLICATE_VERTICES, TriMeshFlags::MERGE_DUPLICATE_VERTICES),
            (TrimeshFlags::DELETE_DEGENERATE_TRIANGLES, TriMeshFlags::DELETE_DEGENERATE_TRIANGLES),
            (TrimeshFlags::DELETE_DUPLICATE_TRIANGLES, TriMeshFlags::DELETE_DUPLICATE_TRIANGLES),
        ];
        for (ours, theirs) in pairs {
            assert_eq!(TriMeshFlags::from(ours), theirs);
        }
        assert!(
            TriMeshFlags::from(TrimeshFlags::FIX_INTERNAL_EDGES).contains(TriMeshFlags::FIX_INTERNAL_EDGES)
        );
    }

    #[test]
    fn the_default_decomposition_is_parrys() {
        let (ours, theirs) = (VHACDParameters::from(VhacdParameters::default()), VHACDParameters::default());
        assert_eq!(format!("{ours:?}"), format!("{theirs:?}"));
    }
}
