//! Scaled shapes. A scale is applied in two parts: first it mirrors, then it stretches.
//!
//! A mirror of axes maps every shape to a shape of its kind, or to a rotated one, so it is exact. Parry
//! scales by factors of any sign, but keeps the windings of mirrored polygons, hulls and meshes, and has no
//! mirrored voxels, height fields and cones. It also scales normals like points, which is correct for even
//! scales only.

use super::composite::flatten;
use super::dim;
use super::handedness::{stretched_border, turns_winding};
use super::input::{is_usable, without_panic};
use super::shapes::scaled as special;
use crate::math::Vector;
use crate::parry::math::{IVector, Pose};
use crate::parry::shape::{
    Capsule, Compound, Cuboid, HalfSpace, RoundShape, Segment, SharedShape, TriMesh, Triangle, TypedShape,
    Voxels,
};

/// The shape scaled along its axes; `None` if parry has no shape for the result.
pub(super) fn scaled(shape: &SharedShape, scale: Vector, subdivisions: u32) -> Option<SharedShape> {
    if scale == Vector::ONE {
        return Some(shape.clone());
    }
    // Curved shapes become hulls, with at least a triangle and at most a hull that still collides fast.
    let subdivisions = subdivisions.clamp(2, 100);
    let scaled = without_panic(|| {
        if matches!(shape.as_typed_shape(), TypedShape::Custom(_)) {
            return by_parry(shape, scale, subdivisions);
        }
        let (signs, size) = (scale.signum(), scale.abs());
        let mirrored =
            if signs == Vector::ONE { shape.clone() } else { mirrored(shape, signs, subdivisions)? };
        if size == Vector::ONE { Some(mirrored) } else { stretched(&mirrored, size, subdivisions) }
    })??;
    let aabb = scaled.compute_local_aabb();
    let endless = matches!(scaled.as_typed_shape(), TypedShape::HalfSpace(_));
    (endless || is_usable(aabb.mins) && is_usable(aabb.maxs)).then_some(scaled)
}

/// The shape scaled by parry.
fn by_parry(shape: &SharedShape, scale: Vector, subdivisions: u32) -> Option<SharedShape> {
    Some(SharedShape(shape.scale_dyn(scale, subdivisions)?.into()))
}

/// The shape with mirrored axes: `signs` has 1 and -1.
fn mirrored(shape: &SharedShape, signs: Vector, subdivisions: u32) -> Option<SharedShape> {
    Some(match shape.as_typed_shape() {
        TypedShape::Ball(_) | TypedShape::Cuboid(_) | TypedShape::RoundCuboid(_) => shape.clone(),
        TypedShape::Capsule(capsule) => {
            let Segment { a, b } = capsule.segment.scaled(signs);
            SharedShape::new(Capsule::new(a, b, capsule.radius))
        }
        TypedShape::Segment(segment) => SharedShape::new(segment.scaled(signs)),
        TypedShape::Triangle(triangle) => SharedShape::new(mirrored_triangle(triangle, signs)),
        TypedShape::RoundTriangle(round) => SharedShape::new(RoundShape {
            inner_shape: mirrored_triangle(&round.inner_shape, signs),
            border_radius: round.border_radius,
        }),
        TypedShape::HalfSpace(half_space) => scaled_half_space(half_space, signs)?,
        TypedShape::TriMesh(mesh) => scaled_mesh(mesh, signs)?,
        TypedShape::Voxels(voxels) => mirrored_voxels(voxels, signs),
        TypedShape::Compound(compound) => parts(compound, |pose, part| {
            pose.translation *= signs;
            pose.rotation = special::mirrored_rotation(pose.rotation, signs);
            mirrored(part, signs, subdivisions)
        })?,
        other => match special::mirrored(other, signs) {
            Some(shape) => shape,
            None => by_parry(shape, signs, subdivisions)?,
        },
    })
}

/// The shape with positive scales along its axes.
fn stretched(shape: &SharedShape, size: Vector, subdivisions: u32) -> Option<SharedShape> {
    let is_even = size == Vector::splat(size.x);
    Some(match shape.as_typed_shape() {
        TypedShape::Cuboid(cuboid) => dim::cuboid_shape(cuboid.half_extents * size),
        TypedShape::RoundCuboid(round) => {
            let border_radius = stretched_border(round.border_radius, size);
            let outer = (round.inner_shape.half_extents + round.border_radius) * size;
            SharedShape::new(RoundShape { inner_shape: Cuboid::new(outer - border_radius), border_radius })
        }
        TypedShape::RoundTriangle(round) => SharedShape::new(RoundShape {
            inner_shape: round.inner_shape.scaled(size),
            border_radius: stretched_border(round.border_radius, size),
        }),
        TypedShape::HalfSpace(half_space) => scaled_half_space(half_space, size)?,
        TypedShape::TriMesh(mesh) if !is_even => scaled_mesh(mesh, size)?,
        TypedShape::Compound(compound) => parts(compound, |pose, part| {
            pose.translation *= size;
            scaled(part, dim::scale_in_frame(size, pose.rotation), subdivisions)
        })?,
        other => match special::stretched(other, size) {
            Some(shape) => shape,
            None => by_parry(shape, size, subdivisions)?,
        },
    })
}

/// A compound of changed parts. A part may become several parts.
fn parts(
    compound: &Compound,
    change: impl Fn(&mut Pose, &SharedShape) -> Option<SharedShape>,
) -> Option<SharedShape> {
    let mut parts = Vec::with_capacity(compound.shapes().len());
    for (pose, part) in compound.shapes() {
        let mut pose = *pose;
        let part = change(&mut pose, part)?;
        flatten(pose, &part, &mut parts);
    }
    Some(SharedShape::compound(parts))
}

fn mirrored_triangle(triangle: &Triangle, signs: Vector) -> Triangle {
    let Triangle { a, b, c } = triangle.scaled(signs);
    if turns_winding(signs) { Triangle::new(a, c, b) } else { Triangle::new(a, b, c) }
}

/// With x' = S x, the half-space n · x ≤ 0 becomes (S⁻¹ n) · x' ≤ 0.
fn scaled_half_space(half_space: &HalfSpace, scale: Vector) -> Option<SharedShape> {
    let normal = (half_space.normal / scale).try_normalize()?;
    Some(SharedShape::new(HalfSpace::new(normal)))
}

/// A mesh with the scale applied to its vertices. Data that its flags request is computed again.
fn scaled_mesh(mesh: &TriMesh, scale: Vector) -> Option<SharedShape> {
    let vertices = mesh.vertices().iter().map(|v| *v * scale).collect();
    let turned = turns_winding(scale);
    let triangle = |[a, b, c]: &[u32; 3]| if turned { [*a, *c, *b] } else { [*a, *b, *c] };
    let indices = mesh.indices().iter().map(triangle).collect();
    Some(SharedShape::new(TriMesh::with_flags(vertices, indices, mesh.flags()).ok()?))
}

/// The cell k, from k to k + 1, becomes the cell from -k - 1 to -k along a mirrored axis.
fn mirrored_voxels(voxels: &Voxels, signs: Vector) -> SharedShape {
    let full = voxels.voxels().filter(|voxel| !voxel.state.is_empty());
    let cells: Vec<IVector> = full
        .map(|voxel| {
            let cell = voxel.grid_coords.to_array();
            IVector::from_array(core::array::from_fn(|i| if signs[i] < 0.0 { -1 - cell[i] } else { cell[i] }))
        })
        .collect();
    SharedShape::new(Voxels::new(voxels.voxel_size(), &cells))
}
