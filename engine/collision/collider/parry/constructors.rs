//! Constructors of [`Collider`] that are the same in both dimensions.

use super::input::{Input, MIN_LENGTH, checked, is_element_usable, is_usable, voxels_fit, without_panic};
use super::{Collider, FillMode, TrimeshBuilderError, TrimeshFlags, VhacdParameters, composite, dim};
use crate::math::{DIM, Scalar, Vector};
use crate::parry::math::IVector;
use crate::parry::shape::{SharedShape, TopologyError, TriMesh};
use crate::physics_transform::{Position, Rotation};

/// Maximum coordinate of a voxel. Larger ones overflow parry's chunk arithmetic.
pub(super) const MAX_VOXEL: i32 = 1 << 24;

impl Collider {
    /// A collider made of several colliders at poses relative to it.
    ///
    /// Nested compounds are flattened. Meshes, polylines, height fields and voxels are decomposed into
    /// triangles, segments and boxes.
    pub fn compound(shapes: Vec<(impl Into<Position>, impl Into<Rotation>, impl Into<Collider>)>) -> Self {
        checked!("compound", |input| {
            let mut parts = Vec::with_capacity(shapes.len());
            for (position, rotation, collider) in shapes {
                let mut pose = dim::pose(position.into().0, rotation.into());
                pose.translation = input.point(pose.translation);
                if !pose.rotation.is_finite() {
                    pose.rotation = input.repair(Default::default());
                }
                composite::flatten(pose, collider.into().shape_scaled(), &mut parts);
            }
            compound_or_speck(parts, &mut input)
        })
    }

    /// A capsule along the Y axis: a segment of the given length with a radius. Its total height is
    /// `length + 2 * radius`.
    pub fn capsule(radius: Scalar, length: Scalar) -> Self {
        checked!("capsule", |input| {
            let half = input.length_or_zero(length) * 0.5;
            SharedShape::capsule(Vector::NEG_Y * half, Vector::Y * half, input.length(radius)).into()
        })
    }

    /// A capsule around the segment from `a` to `b`.
    pub fn capsule_endpoints(radius: Scalar, a: Vector, b: Vector) -> Self {
        checked!("capsule_endpoints", |input| {
            SharedShape::capsule(input.point(a), input.point(b), input.length(radius)).into()
        })
    }

    /// The half-space (in 2D half-plane) behind the plane through the origin with an outward normal. A zero
    /// or invalid normal becomes the Y axis.
    pub fn half_space(outward_normal: Vector) -> Self {
        checked!("half_space", |input| SharedShape::halfspace(input.direction(outward_normal)).into())
    }

    /// A line segment from `a` to `b`.
    pub fn segment(a: Vector, b: Vector) -> Self {
        checked!("segment", |input| {
            let (a, b) = input.segment(a, b);
            SharedShape::segment(a, b).into()
        })
    }

    /// The segments between pairs of vertices. Without `indices`, each vertex is connected to the next.
    pub fn polyline(vertices: Vec<Vector>, indices: Option<Vec<[u32; 2]>>) -> Self {
        checked!("polyline", |input| {
            let indices = indices.unwrap_or_else(|| (1..vertices.len() as u32).map(|i| [i - 1, i]).collect());
            let indices = input.elements(&vertices, indices);
            if indices.is_empty() {
                speck(&mut input).into()
            } else {
                SharedShape::polyline(usable_vertices(vertices), Some(indices)).into()
            }
        })
    }

    /// A triangle mesh. Invalid triangles are left out; [`try_trimesh`](Self::try_trimesh) returns an error
    /// instead.
    ///
    /// A mesh has no volume, so thin or fast bodies tunnel through it more easily than through solid shapes.
    /// For dynamic bodies prefer several convex shapes.
    pub fn trimesh(vertices: Vec<Vector>, indices: Vec<[u32; 3]>) -> Self {
        Self::trimesh_with_config(vertices, indices, TrimeshFlags::empty())
    }

    /// A triangle mesh, or an error if there are no triangles, or if a triangle has indices that do not
    /// exist, repeat or refer to coordinates that are not finite (`BadTriangle`).
    pub fn try_trimesh(vertices: Vec<Vector>, indices: Vec<[u32; 3]>) -> Result<Self, TrimeshBuilderError> {
        Self::try_trimesh_with_config(vertices, indices, TrimeshFlags::empty())
    }

    /// A triangle mesh, preprocessed by `flags`. Invalid triangles are left out.
    pub fn trimesh_with_config(vertices: Vec<Vector>, indices: Vec<[u32; 3]>, flags: TrimeshFlags) -> Self {
        checked!("trimesh", |input| {
            let indices = input.elements(&vertices, indices);
            Self::try_trimesh_with_config(vertices, indices, flags)
                .unwrap_or_else(|_| speck(&mut input).into())
        })
    }

    /// A triangle mesh, preprocessed by `flags`, or an error; see [`try_trimesh`](Self::try_trimesh).
    pub fn try_trimesh_with_config(
        vertices: Vec<Vector>,
        indices: Vec<[u32; 3]>,
        flags: TrimeshFlags,
    ) -> Result<Self, TrimeshBuilderError> {
        if let Some(bad) = indices.iter().position(|t| !is_element_usable(&vertices, t)) {
            return Err(TrimeshBuilderError::TopologyError(TopologyError::BadTriangle(bad as u32)));
        }
        let mesh = TriMesh::with_flags(usable_vertices(vertices), indices, flags.into())?;
        // The flags may have removed every triangle.
        if mesh.indices().is_empty() {
            Err(TrimeshBuilderError::EmptyIndices)
        } else {
            Ok(SharedShape::new(mesh).into())
        }
    }

    /// The convex hull of some points. `None` if they do not span an area or volume, or are not finite.
    pub fn convex_hull(points: Vec<Vector>) -> Option<Self> {
        if !points.iter().all(|p| is_usable(*p)) || !spans_space(&points) {
            return None;
        }
        let hull = without_panic(|| SharedShape::convex_hull(&points))??;
        dim::is_solid(&hull).then(|| hull.into())
    }

    /// Convex shapes that together approximate the inside of a closed outline (2D: segments) or surface
    /// (3D: triangles).
    pub(super) fn decomposition(
        vertices: &[Vector],
        indices: Vec<[u32; DIM]>,
        parameters: &VhacdParameters,
        input: &mut Input,
    ) -> Self {
        let indices = input.elements(vertices, indices);
        let usable = usable_vertices(vertices.to_vec());
        let parameters = usable_parameters(parameters, input);
        let parts = if indices.is_empty() {
            None
        } else {
            without_panic(|| {
                SharedShape::convex_decomposition_with_params(&usable, &indices, &parameters.into())
            })
        };
        let hull = || Self::convex_hull(vertices.iter().copied().filter(|v| is_usable(*v)).collect());
        match parts {
            Some(shape) => shape.into(),
            None => input.repair(hull()).unwrap_or_else(|| speck(input).into()),
        }
    }

    /// Boxes of size `voxel_size` on a grid. The box at `(0, 0)` has its lower corner at the origin.
    pub fn voxels(voxel_size: Vector, grid_coordinates: &[IVector]) -> Self {
        checked!("voxels", |input| {
            let size = Vector::from_array(voxel_size.to_array().map(|v| input.length(v)));
            let in_range =
                |c: &IVector| c.to_array().iter().all(|v| v.unsigned_abs() as u64 <= MAX_VOXEL as u64);
            let cells: Vec<_> = grid_coordinates.iter().copied().filter(in_range).collect();
            input.repaired |= cells.len() != grid_coordinates.len();
            voxels_or_speck(size, &cells, &mut input)
        })
    }

    /// The boxes of size `voxel_size` on a grid that contain at least one of the points.
    pub fn voxels_from_points(voxel_size: Vector, points: &[Vector]) -> Self {
        checked!("voxels_from_points", |input| {
            let size = Vector::from_array(voxel_size.to_array().map(|v| input.length(v)));
            let in_range = |p: &Vector| (*p / size).abs().cmple(Vector::splat(MAX_VOXEL as Scalar)).all();
            let kept: Vec<_> = points.iter().copied().filter(in_range).collect();
            input.repaired |= kept.len() != points.len();
            if kept.is_empty() { speck(&mut input) } else { SharedShape::voxels_from_points(size, &kept) }
                .into()
        })
    }

    /// The grid boxes that an outline (2D: segments) or surface (3D: triangles) passes through, and the boxes
    /// inside it as set by `fill_mode`. The boxes are larger if there would be too many.
    pub(super) fn voxelized(
        vertices: &[Vector],
        indices: &[[u32; DIM]],
        voxel_size: Scalar,
        fill_mode: FillMode,
        input: &mut Input,
    ) -> Self {
        let indices = input.elements(vertices, indices.to_vec());
        let usable = usable_vertices(vertices.to_vec());
        let mut size = input.length(voxel_size);
        while !voxels_fit(&usable, size) {
            size = input.repair(size * 1.25);
        }
        let shape = (!indices.is_empty()).then(|| {
            without_panic(|| SharedShape::voxelized_mesh(&usable, &indices, size, fill_mode.into()))
        });
        shape.flatten().unwrap_or_else(|| speck(input)).into()
    }

    /// The parts of a [convex decomposition](Self::convex_decomposition) as voxels, one collider each.
    pub fn voxelized_convex_decomposition(vertices: &[Vector], indices: &[[u32; DIM]]) -> Vec<Self> {
        Self::voxelized_convex_decomposition_with_config(vertices, indices, &VhacdParameters::default())
    }

    /// The parts of a [convex decomposition](Self::convex_decomposition_with_config) as voxels, one
    /// collider each.
    pub fn voxelized_convex_decomposition_with_config(
        vertices: &[Vector],
        indices: &[[u32; DIM]],
        parameters: &VhacdParameters,
    ) -> Vec<Self> {
        checked!("voxelized_convex_decomposition", |input| {
            let indices = input.elements(vertices, indices.to_vec());
            let usable = usable_vertices(vertices.to_vec());
            let parameters = usable_parameters(parameters, &mut input).into();
            let parts = (!indices.is_empty()).then(|| {
                without_panic(|| {
                    SharedShape::voxelized_convex_decomposition_with_params(&usable, &indices, &parameters)
                })
            });
            parts.flatten().unwrap_or_default().into_iter().map(Self::from).collect()
        })
    }
}

/// Whether points are not collinear (in 3D not coplanar): parry's hulls assert it.
fn spans_space(points: &[Vector]) -> bool {
    let Some(&origin) = points.first() else {
        return false;
    };
    // Gram–Schmidt with pivots: each axis is the offset of the farthest point from the span of previous axes.
    let mut offsets: Vec<_> = points.iter().map(|p| *p - origin).collect();
    let size = offsets.iter().map(|v| v.length()).fold(0.0, Scalar::max);
    for _ in 0..DIM {
        let farthest = offsets
            .iter()
            .copied()
            .fold(Vector::ZERO, |a, b| if b.length_squared() > a.length_squared() { b } else { a });
        if farthest.length() <= (1.0e-5 * size).max(MIN_LENGTH) {
            return false;
        }
        let axis = farthest.normalize();
        for v in &mut offsets {
            *v -= axis * v.dot(axis);
        }
    }
    true
}

/// A tiny ball, for input that makes no shape.
pub(super) fn speck(input: &mut Input) -> SharedShape {
    input.repair(SharedShape::ball(MIN_LENGTH))
}

/// A compound of convex parts, or a tiny ball for none.
pub(super) fn compound_or_speck(
    parts: Vec<(crate::parry::math::Pose, SharedShape)>,
    input: &mut Input,
) -> Collider {
    if parts.is_empty() { speck(input).into() } else { SharedShape::compound(parts).into() }
}

/// Voxels, or a tiny ball for none.
fn voxels_or_speck(size: Vector, cells: &[IVector], input: &mut Input) -> Collider {
    if cells.is_empty() { speck(input) } else { SharedShape::voxels(size, cells) }.into()
}

/// Replaces invalid unused vertices: parry reads some of them.
pub(super) fn usable_vertices(mut vertices: Vec<Vector>) -> Vec<Vector> {
    for v in &mut vertices {
        if !is_usable(*v) {
            *v = Vector::ZERO;
        }
    }
    vertices
}

/// Clamps parameters to ranges for which the decomposition terminates.
pub(super) fn usable_parameters(parameters: &VhacdParameters, input: &mut Input) -> VhacdParameters {
    let mut unit = |v: Scalar, fallback: Scalar| {
        if (0.0..=1.0).contains(&v) {
            v
        } else {
            input.repair(if v.is_nan() { fallback } else { v.clamp(0.0, 1.0) })
        }
    };
    let default = VhacdParameters::default();
    VhacdParameters {
        concavity: unit(parameters.concavity, default.concavity),
        alpha: unit(parameters.alpha, default.alpha),
        beta: unit(parameters.beta, default.beta),
        resolution: parameters.resolution.clamp(2, 1024),
        plane_downsampling: parameters.plane_downsampling.max(1),
        convex_hull_downsampling: parameters.convex_hull_downsampling.max(1),
        fill_mode: parameters.fill_mode,
        convex_hull_approximation: parameters.convex_hull_approximation,
        max_convex_hulls: parameters.max_convex_hulls.max(1),
    }
}
