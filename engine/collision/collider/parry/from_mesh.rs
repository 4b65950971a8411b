//! Colliders from meshes, with feature `collider-from-mesh`.

use bevy_mesh::{Mesh, PrimitiveTopology, VertexAttributeValues};

use super::{
    Collider, ColliderError, FillMode, TrimeshFlags, VhacdParameters,
    constructors::usable_vertices,
    input::{is_element_usable, is_usable},
    shapes::from_mesh::{decomposed, point, surface, voxelized},
    strict::{self, Made, made},
};
use crate::math::{Scalar, Vector};

/// The preprocessing of meshes. Meshes duplicate vertices where normals or texture coordinates differ, and
/// grids of spheres have flat triangles at their poles.
pub(super) const OF_MESH: TrimeshFlags =
    TrimeshFlags::MERGE_DUPLICATE_VERTICES.union(TrimeshFlags::DELETE_DEGENERATE_TRIANGLES);

impl Collider {
    /// The triangles of a mesh. Vertices at the same place are merged, and triangles without an area are left
    /// out.
    ///
    /// `None` if the mesh has no triangles that can be used, or if its data was moved to the render world
    /// (`RenderAssetUsages`). In 2D the Z coordinate is ignored. That holds for all constructors from meshes.
    ///
    /// ```
    /// # use avian::prelude::*;
    /// # use bevy_mesh::prelude::*;
    /// # use bevy_math::primitives::*;
    /// let mesh = Mesh::from(Rectangle::new(2.0, 1.0));
    /// let collider = Collider::trimesh_from_mesh(&mesh).expect("it has two triangles");
    /// assert_eq!(collider.shape().as_trimesh().map(|mesh| mesh.num_triangles()), Some(2));
    /// ```
    pub fn trimesh_from_mesh(mesh: &Mesh) -> Option<Self> {
        trimesh(mesh, OF_MESH).ok()
    }

    /// The triangles of a mesh, preprocessed by `flags`; see [`trimesh_from_mesh`](Self::trimesh_from_mesh).
    pub fn trimesh_from_mesh_with_config(mesh: &Mesh, flags: TrimeshFlags) -> Option<Self> {
        trimesh(mesh, flags).ok()
    }

    /// The convex hull of a mesh. `None` if its vertices do not span a volume (in 2D an area).
    pub fn convex_hull_from_mesh(mesh: &Mesh) -> Option<Self> {
        convex_hull(mesh).ok()
    }

    /// Convex shapes that together approximate the inside of a closed mesh, in 2D of its outline.
    pub fn convex_decomposition_from_mesh(mesh: &Mesh) -> Option<Self> {
        convex_decomposition(mesh, &VhacdParameters::default()).ok()
    }

    /// Convex shapes that together approximate the inside of a closed mesh, in 2D of its outline,
    /// with parameters.
    pub fn convex_decomposition_from_mesh_with_config(
        mesh: &Mesh,
        parameters: &VhacdParameters,
    ) -> Option<Self> {
        convex_decomposition(mesh, parameters).ok()
    }

    /// The grid boxes that a mesh (in 2D its outline) passes through, and the boxes inside it as set by
    /// `fill_mode`.
    ///
    /// `None` also if the size is not positive, or so small that the mesh would have more than 8 million
    /// boxes around it.
    pub fn voxelized_trimesh_from_mesh(mesh: &Mesh, voxel_size: Scalar, fill_mode: FillMode) -> Option<Self> {
        voxelized_trimesh(mesh, voxel_size, fill_mode).ok()
    }
}

pub(super) fn trimesh(mesh: &Mesh, flags: TrimeshFlags) -> Made {
    let (vertices, indices) = triangles(mesh)?;
    let made = Collider::try_trimesh_with_config(vertices, indices, flags);
    made.map_err(|_| ColliderError::NoMeshTriangles)
}

pub(super) fn convex_hull(mesh: &Mesh) -> Made {
    let points: Vec<_> = corners(mesh)?.into_iter().filter(|p| is_usable(*p)).collect();
    Collider::try_convex_hull(points)
}

pub(super) fn convex_decomposition(mesh: &Mesh, parameters: &VhacdParameters) -> Made {
    let (vertices, indices) = triangles(mesh)?;
    let (vertices, indices) = surface(vertices, indices);
    strict::elements(&vertices, &indices)?;
    made(decomposed(vertices, indices, parameters))
}

pub(super) fn voxelized_trimesh(mesh: &Mesh, voxel_size: Scalar, fill_mode: FillMode) -> Made {
    let (vertices, indices) = triangles(mesh)?;
    let (vertices, indices) = surface(vertices, indices);
    strict::voxel_size(&vertices, voxel_size)?;
    strict::elements(&vertices, &indices)?;
    made(voxelized(&vertices, &indices, voxel_size, fill_mode))
}

/// The corners of a mesh. Some may not be finite.
fn corners(mesh: &Mesh) -> Made<Vec<Vector>> {
    let positions = mesh.try_attribute_option(Mesh::ATTRIBUTE_POSITION);
    match positions {
        Ok(Some(VertexAttributeValues::Float32x3(positions))) => {
            Ok(positions.iter().copied().map(point).collect())
        }
        Ok(_) => Err(ColliderError::NoMeshPositions),
        Err(_) => Err(ColliderError::MeshNotReadable),
    }
}

/// The corners and triangles of a mesh. Triangles that cannot be used are left out; there is at least one.
fn triangles(mesh: &Mesh) -> Made<(Vec<Vector>, Vec<[u32; 3]>)> {
    let corners = corners(mesh)?;
    let order: Vec<u32> = match mesh.try_indices_option() {
        Ok(Some(indices)) => indices.iter().map(|i| i as u32).collect(),
        _ => (0..corners.len() as u32).collect(),
    };
    let mut triangles: Vec<[u32; 3]> = match mesh.primitive_topology() {
        PrimitiveTopology::TriangleList => order.as_chunks().0.to_vec(),
        // Every second triangle of a strip is reversed.
        PrimitiveTopology::TriangleStrip => {
            let turned =
                |(i, t): (usize, &[u32])| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
            order.windows(3).enumerate().map(turned).collect()
        }
        _ => return Err(ColliderError::NotTriangles),
    };
    triangles.retain(|triangle| is_element_usable(&corners, triangle));
    if triangles.is_empty() {
        return Err(ColliderError::NoMeshTriangles);
    }
    // Parry reads corners that no triangle uses.
    Ok((usable_vertices(corners), triangles))
}
