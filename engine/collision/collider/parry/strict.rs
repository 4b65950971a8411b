//! Constructors that refuse what those of [`Collider`] repair.
//!
//! Whoever writes code sees a warning where the code runs. Data comes from files and editors: there the collider of a
//! wrong description would be found much later, if at all.

use super::{
    Collider, TrimeshFlags,
    constructors::MAX_VOXEL,
    dim,
    input::{MAX_LENGTH, MIN_LENGTH, is_element_usable, is_usable, voxels_fit},
};
use crate::{
    math::{Scalar, Vector},
    parry::math::IVector,
    physics_transform::{Position, Rotation},
};

/// Why a constructor makes no shape, as the end of a sentence about it.
pub(crate) type Fault = &'static str;

/// Sizes have to be positive and finite.
pub(super) fn sizes(values: &[Scalar]) -> Result<(), Fault> {
    let usable = |v: &Scalar| (MIN_LENGTH..=MAX_LENGTH).contains(v);
    if values.iter().all(usable) {
        Ok(())
    } else {
        Err("has a size that is zero, negative, too large or no number")
    }
}

/// Sizes that may be zero.
pub(super) fn sizes_or_zero(values: &[Scalar]) -> Result<(), Fault> {
    let usable = |v: &Scalar| (0.0..=MAX_LENGTH).contains(v);
    if values.iter().all(usable) {
        Ok(())
    } else {
        Err("has a size that is negative, too large or no number")
    }
}

/// Points have to be finite.
pub(super) fn points(points: &[Vector]) -> Result<(), Fault> {
    let all = points.iter().all(|p| is_usable(*p));
    if all { Ok(()) } else { Err("has a point that is too far away or no number") }
}

/// At least one segment or triangle has to have different corners that exist. Others are left out.
pub(super) fn elements<const N: usize>(vertices: &[Vector], elements: &[[u32; N]]) -> Result<(), Fault> {
    let any = elements.iter().any(|element| is_element_usable(vertices, element));
    if any { Ok(()) } else { Err("has no segments or triangles whose corners exist and differ") }
}

/// What is to be voxelised has to have elements, and not too many voxels.
pub(super) fn voxel_grid<const N: usize>(
    vertices: &[Vector],
    indices: &[[u32; N]],
    voxel_size: Scalar,
) -> Result<(), Fault> {
    sizes(&[voxel_size])?;
    elements(vertices, indices)?;
    if voxels_fit(vertices, voxel_size) { Ok(()) } else { Err("has voxels too small for its size: too many") }
}

/// The collider, if anything was left of what it was made from.
pub(super) fn made(collider: Collider) -> Result<Collider, Fault> {
    let is_speck = collider.shape().as_ball().is_some_and(|ball| ball.radius <= MIN_LENGTH);
    if is_speck { Err("makes no shape: nothing of what it is made from can be used") } else { Ok(collider) }
}

pub(super) fn capsule(radius: Scalar, height: Scalar) -> Result<Collider, Fault> {
    sizes(&[radius])?;
    sizes_or_zero(&[height])?;
    Ok(Collider::capsule(radius, height))
}

pub(super) fn capsule_endpoints(radius: Scalar, a: Vector, b: Vector) -> Result<Collider, Fault> {
    sizes(&[radius])?;
    points(&[a, b])?;
    Ok(Collider::capsule_endpoints(radius, a, b))
}

pub(super) fn half_space(outward_normal: Vector) -> Result<Collider, Fault> {
    let longest = outward_normal.abs().max_element();
    if outward_normal.is_finite() && longest > 0.0 {
        Ok(Collider::half_space(outward_normal))
    } else {
        Err("has a normal without a direction")
    }
}

pub(super) fn segment(a: Vector, b: Vector) -> Result<Collider, Fault> {
    points(&[a, b])?;
    if a.distance(b) >= MIN_LENGTH { Ok(Collider::segment(a, b)) } else { Err("has no length") }
}

pub(super) fn triangle(a: Vector, b: Vector, c: Vector) -> Result<Collider, Fault> {
    points(&[a, b, c])?;
    let collider = Collider::triangle(a, b, c);
    // One without an area becomes a segment.
    if collider.shape().as_triangle().is_some() { Ok(collider) } else { Err("has no area") }
}

pub(super) fn polyline(vertices: &[Vector], indices: Option<&[[u32; 2]]>) -> Result<Collider, Fault> {
    match indices {
        Some(indices) => elements(vertices, indices)?,
        None if vertices.windows(2).any(|ends| points(ends).is_ok()) => {}
        None => return Err("has no two points in a row"),
    }
    made(Collider::polyline(vertices.to_vec(), indices.map(<[_]>::to_vec)))
}

pub(super) fn trimesh(
    vertices: &[Vector],
    indices: &[[u32; 3]],
    flags: TrimeshFlags,
) -> Result<Collider, Fault> {
    elements(vertices, indices)?;
    made(Collider::trimesh_with_config(vertices.to_vec(), indices.to_vec(), flags))
}

pub(super) fn convex_hull(points: &[Vector]) -> Result<Collider, Fault> {
    Collider::convex_hull(points.to_vec()).ok_or("has points that are not finite or span no hull")
}

pub(super) fn voxels(voxel_size: Vector, cells: &[IVector]) -> Result<Collider, Fault> {
    sizes(&voxel_size.to_array())?;
    let in_range =
        |cell: &IVector| cell.to_array().iter().all(|v| v.unsigned_abs() as u64 <= MAX_VOXEL as u64);
    if cells.iter().any(in_range) {
        made(Collider::voxels(voxel_size, cells))
    } else {
        Err("has no voxels, or only some that are too far away")
    }
}

pub(super) fn compound(parts: Vec<(Position, Rotation, Collider)>) -> Result<Collider, Fault> {
    let is_pose = |(position, rotation, _): &(Position, Rotation, Collider)| {
        // The tolerance covers rounding.
        let length = dim::pose(position.0, *rotation).rotation.length();
        is_usable(position.0) && (length - 1.0).abs() < 1.0e-3
    };
    let are_poses = parts.iter().all(is_pose);
    if parts.is_empty() {
        Err("is a compound without parts")
    } else if are_poses {
        made(Collider::compound(parts))
    } else {
        Err("has a part whose pose is no rotation or too far away")
    }
}
