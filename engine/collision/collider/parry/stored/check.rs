//! Checks of stored data before it is passed to parry.

use crate::{
    collision::collider::parry::input::{MAX_LENGTH, is_usable},
    math::{Scalar, Vector},
    parry::shape::{RoundShape, SharedShape},
};

/// Why a shape cannot be stored, or why stored data is invalid.
pub(super) type Fault = &'static str;

/// Whether the indices of elements exist, and all vertices are finite.
pub(super) fn check_elements<const N: usize>(
    vertices: &[Vector],
    elements: &[[u32; N]],
) -> Result<(), Fault> {
    if elements.is_empty() {
        return Err("a mesh has no elements");
    }
    if !elements.as_flattened().iter().all(|i| (*i as usize) < vertices.len()) {
        return Err("a mesh has an index out of range");
    }
    check_points(vertices)
}

/// Whether all points are finite and within the range of parry's algorithms.
pub(super) fn check_points(points: &[Vector]) -> Result<(), Fault> {
    let all = points.iter().all(|p| is_usable(*p));
    if all { Ok(()) } else { Err("a shape has a point that is not finite or too far away") }
}

/// Whether lengths are neither negative nor NaN nor too large.
pub(super) fn check_lengths<const N: usize>(lengths: [Scalar; N]) -> Result<(), Fault> {
    let usable = |v: Scalar| (0.0..=MAX_LENGTH).contains(&v);
    if lengths.into_iter().all(usable) {
        Ok(())
    } else {
        Err("a length is negative, too large or not a number")
    }
}

/// Whether the heights of a height field are finite and within the range of parry's algorithms, also
/// times its scale.
pub(super) fn check_heights(heights: &[Scalar], scale: Scalar) -> Result<(), Fault> {
    let usable = |v: Scalar| v.abs() <= MAX_LENGTH;
    if heights.iter().all(|h| usable(*h) && usable(*h * scale)) {
        Ok(())
    } else {
        Err("a height is too large or not a number")
    }
}

/// A shape with a border.
pub(super) fn round<S>(
    inner_shape: S,
    border_radius: Scalar,
    shared: impl FnOnce(RoundShape<S>) -> SharedShape,
) -> Result<SharedShape, Fault> {
    check_lengths([border_radius])?;
    Ok(shared(RoundShape { inner_shape, border_radius }))
}

/// Whether all vectors have unit length, within rounding.
pub(super) fn check_normals(normals: &[Vector]) -> Result<(), Fault> {
    let is_unit = |n: &Vector| (n.length() - 1.0).abs() < 1.0e-3;
    if normals.iter().all(is_unit) { Ok(()) } else { Err("a normal is no unit vector") }
}
