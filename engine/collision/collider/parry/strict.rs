//! Constructors that return an error where other constructors of [`Collider`] repair their input, and the
//! checks that they share with [`ColliderConstructor`](crate::collision::collider::ColliderConstructor).
//!
//! Repair suits values in code: the warning names the constructor. Values from files and editors need an
//! error at the place that reads them.

use super::{
    Collider, ColliderError as Error, TrimeshFlags, VhacdParameters,
    constructors::{MAX_VOXEL, usable_parameters},
    dim,
    input::{Input, MAX_LENGTH, MIN_LENGTH, is_element_usable, is_usable, voxels_fit},
};
use crate::{
    math::{DIM, Scalar, Vector},
    parry::math::IVector,
    physics_transform::{Position, Rotation},
};

/// The result of a constructor.
pub(super) type Made<T = Collider> = Result<T, Error>;

/// Checks that sizes are positive and finite.
pub(super) fn sizes(values: &[Scalar]) -> Made<()> {
    let usable = |v: &Scalar| (MIN_LENGTH..=MAX_LENGTH).contains(v);
    if values.iter().all(usable) { Ok(()) } else { Err(Error::InvalidSize) }
}

/// Checks that sizes are finite and not negative.
pub(super) fn sizes_or_zero(values: &[Scalar]) -> Made<()> {
    let usable = |v: &Scalar| (0.0..=MAX_LENGTH).contains(v);
    if values.iter().all(usable) { Ok(()) } else { Err(Error::NegativeSize) }
}

/// Checks that points are finite.
pub(super) fn points(points: &[Vector]) -> Made<()> {
    let all = points.iter().all(|p| is_usable(*p));
    if all { Ok(()) } else { Err(Error::InvalidPoint) }
}

/// Checks that at least one segment or triangle has distinct corners that exist. Others are left out.
pub(super) fn elements<const N: usize>(vertices: &[Vector], elements: &[[u32; N]]) -> Made<()> {
    let any = elements.iter().any(|element| is_element_usable(vertices, element));
    if any { Ok(()) } else { Err(Error::NoElements) }
}

/// Checks that there is a segment or triangle, and that all have distinct corners that exist.
pub(super) fn all_elements<const N: usize>(vertices: &[Vector], elements: &[[u32; N]]) -> Made<()> {
    match elements.iter().position(|element| !is_element_usable(vertices, element)) {
        Some(bad) => Err(Error::InvalidElement(bad as u32)),
        None if elements.is_empty() => Err(Error::NoElements),
        None => Ok(()),
    }
}

/// Checks that a voxelised shape does not have too many voxels.
pub(super) fn voxel_size(vertices: &[Vector], voxel_size: Scalar) -> Made<()> {
    sizes(&[voxel_size])?;
    if voxels_fit(vertices, voxel_size) { Ok(()) } else { Err(Error::TooManyVoxels) }
}

/// Checks that parameters of a decomposition are within their ranges.
fn parameters(parameters: &VhacdParameters) -> Made<()> {
    let usable = usable_parameters(parameters, &mut Input::default()) == *parameters;
    if usable { Ok(()) } else { Err(Error::InvalidParameters) }
}

/// The collider, or an error if nothing was left of its input.
pub(super) fn made(collider: Collider) -> Made {
    let is_speck = collider.shape().as_ball().is_some_and(|ball| ball.radius <= MIN_LENGTH);
    if is_speck { Err(Error::Empty) } else { Ok(collider) }
}

/// A polyline of the usable segments.
pub(super) fn polyline(vertices: &[Vector], indices: Option<&[[u32; 2]]>) -> Made {
    match indices {
        Some(indices) => elements(vertices, indices)?,
        None if vertices.windows(2).any(|ends| points(ends).is_ok()) => {}
        None => return Err(Error::NoElements),
    }
    made(Collider::polyline(vertices.to_vec(), indices.map(<[_]>::to_vec)))
}

/// A mesh of the usable triangles.
pub(super) fn trimesh(vertices: &[Vector], indices: &[[u32; 3]], flags: TrimeshFlags) -> Made {
    elements(vertices, indices)?;
    made(Collider::trimesh_with_config(vertices.to_vec(), indices.to_vec(), flags))
}

/// The voxels that are not too far away.
pub(super) fn voxels(voxel_size: Vector, cells: &[IVector]) -> Made {
    sizes(&voxel_size.to_array())?;
    if cells.iter().any(is_in_range) {
        made(Collider::voxels(voxel_size, cells))
    } else {
        Err(Error::NoVoxels)
    }
}

/// Whether a voxel is within the range of parry's arithmetic.
fn is_in_range(cell: &IVector) -> bool {
    cell.to_array().iter().all(|v| v.unsigned_abs() as u64 <= MAX_VOXEL as u64)
}

/// Constructors that return an error where their namesakes without `try_` repair the input.
///
/// ```
/// # use avian::{collision::collider::ColliderError, math::Vector, prelude::*};
/// assert!(Collider::try_capsule(0.5, 2.0).is_ok());
/// assert_eq!(Collider::try_capsule(-0.5, 2.0).err(), Some(ColliderError::InvalidSize));
/// assert_eq!(Collider::try_segment(Vector::X, Vector::X).err(), Some(ColliderError::NoLength));
/// ```
impl Collider {
    /// As [`capsule`](Self::capsule).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize) for the radius, [`NegativeSize`](Error::NegativeSize)
    /// for the length.
    pub fn try_capsule(radius: Scalar, length: Scalar) -> Result<Self, Error> {
        sizes(&[radius])?;
        sizes_or_zero(&[length])?;
        Ok(Self::capsule(radius, length))
    }

    /// As [`capsule_endpoints`](Self::capsule_endpoints). The ends may be at one place.
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize), [`InvalidPoint`](Error::InvalidPoint).
    pub fn try_capsule_endpoints(radius: Scalar, a: Vector, b: Vector) -> Result<Self, Error> {
        sizes(&[radius])?;
        points(&[a, b])?;
        Ok(Self::capsule_endpoints(radius, a, b))
    }

    /// As [`half_space`](Self::half_space). The normal may have any length but zero.
    ///
    /// # Errors
    ///
    /// [`NoDirection`](Error::NoDirection).
    pub fn try_half_space(outward_normal: Vector) -> Result<Self, Error> {
        let longest = outward_normal.abs().max_element();
        if outward_normal.is_finite() && longest > 0.0 {
            Ok(Self::half_space(outward_normal))
        } else {
            Err(Error::NoDirection)
        }
    }

    /// As [`segment`](Self::segment).
    ///
    /// # Errors
    ///
    /// [`InvalidPoint`](Error::InvalidPoint), [`NoLength`](Error::NoLength).
    pub fn try_segment(a: Vector, b: Vector) -> Result<Self, Error> {
        points(&[a, b])?;
        if a.distance(b) >= MIN_LENGTH { Ok(Self::segment(a, b)) } else { Err(Error::NoLength) }
    }

    /// As [`triangle`](Self::triangle).
    ///
    /// # Errors
    ///
    /// [`InvalidPoint`](Error::InvalidPoint), [`NoArea`](Error::NoArea).
    pub fn try_triangle(a: Vector, b: Vector, c: Vector) -> Result<Self, Error> {
        points(&[a, b, c])?;
        let collider = Self::triangle(a, b, c);
        // A triangle without an area becomes a segment.
        if collider.shape().as_triangle().is_some() { Ok(collider) } else { Err(Error::NoArea) }
    }

    /// As [`polyline`](Self::polyline).
    ///
    /// # Errors
    ///
    /// [`InvalidElement`](Error::InvalidElement), [`NoElements`](Error::NoElements); without indices also
    /// [`InvalidPoint`](Error::InvalidPoint).
    pub fn try_polyline(vertices: Vec<Vector>, indices: Option<Vec<[u32; 2]>>) -> Result<Self, Error> {
        match &indices {
            Some(indices) => all_elements(&vertices, indices)?,
            None => points(&vertices)?,
        }
        polyline(&vertices, indices.as_deref())
    }

    /// As [`convex_hull`](Self::convex_hull).
    ///
    /// # Errors
    ///
    /// [`InvalidPoint`](Error::InvalidPoint), [`NoHull`](Error::NoHull).
    pub fn try_convex_hull(hull: Vec<Vector>) -> Result<Self, Error> {
        points(&hull)?;
        Self::convex_hull(hull).ok_or(Error::NoHull)
    }

    /// As [`voxels`](Self::voxels).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize), [`InvalidVoxel`](Error::InvalidVoxel),
    /// [`NoVoxels`](Error::NoVoxels).
    pub fn try_voxels(voxel_size: Vector, grid_coordinates: &[IVector]) -> Result<Self, Error> {
        sizes(&voxel_size.to_array())?;
        if let Some(bad) = grid_coordinates.iter().position(|cell| !is_in_range(cell)) {
            return Err(Error::InvalidVoxel(bad as u32));
        }
        voxels(voxel_size, grid_coordinates)
    }

    /// As [`voxels_from_points`](Self::voxels_from_points).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize), [`InvalidVoxel`](Error::InvalidVoxel) for a point that is too
    /// many voxels away or not finite, [`NoVoxels`](Error::NoVoxels).
    pub fn try_voxels_from_points(voxel_size: Vector, points: &[Vector]) -> Result<Self, Error> {
        sizes(&voxel_size.to_array())?;
        let in_range = |p: &Vector| (*p / voxel_size).abs().cmple(Vector::splat(MAX_VOXEL as Scalar)).all();
        match points.iter().position(|p| !in_range(p)) {
            Some(bad) => Err(Error::InvalidVoxel(bad as u32)),
            None if points.is_empty() => Err(Error::NoVoxels),
            None => Ok(Self::voxels_from_points(voxel_size, points)),
        }
    }

    /// As [`voxelized_convex_decomposition_with_config`](Self::voxelized_convex_decomposition_with_config).
    ///
    /// # Errors
    ///
    /// [`InvalidElement`](Error::InvalidElement), [`NoElements`](Error::NoElements),
    /// [`InvalidParameters`](Error::InvalidParameters), [`NoDecomposition`](Error::NoDecomposition).
    pub fn try_voxelized_convex_decomposition_with_config(
        vertices: &[Vector],
        indices: &[[u32; DIM]],
        parameters: &VhacdParameters,
    ) -> Result<Vec<Self>, Error> {
        all_elements(vertices, indices)?;
        self::parameters(parameters)?;
        let parts = Self::voxelized_convex_decomposition_with_config(vertices, indices, parameters);
        if parts.is_empty() { Err(Error::NoDecomposition) } else { Ok(parts) }
    }

    /// As [`convex_decomposition`](Self::convex_decomposition), with parameters.
    ///
    /// # Errors
    ///
    /// [`InvalidElement`](Error::InvalidElement), [`NoElements`](Error::NoElements),
    /// [`InvalidParameters`](Error::InvalidParameters), [`NoDecomposition`](Error::NoDecomposition).
    pub fn try_convex_decomposition_with_config(
        vertices: Vec<Vector>,
        indices: Vec<[u32; DIM]>,
        parameters: &VhacdParameters,
    ) -> Result<Self, Error> {
        all_elements(&vertices, &indices)?;
        self::parameters(parameters)?;
        let mut input = Input::default();
        let collider = Self::decomposition(&vertices, indices, parameters, &mut input);
        // A hull replaces the parts of a decomposition that failed.
        if input.repaired { Err(Error::NoDecomposition) } else { made(collider) }
    }

    /// As [`compound`](Self::compound).
    ///
    /// # Errors
    ///
    /// [`NoParts`](Error::NoParts), [`InvalidPose`](Error::InvalidPose), [`Empty`](Error::Empty).
    pub fn try_compound(
        shapes: Vec<(impl Into<Position>, impl Into<Rotation>, impl Into<Self>)>,
    ) -> Result<Self, Error> {
        let parts: Vec<(Position, Rotation, Self)> = shapes
            .into_iter()
            .map(|(position, rotation, collider)| (position.into(), rotation.into(), collider.into()))
            .collect();
        let is_pose = |(position, rotation, _): &(Position, Rotation, Self)| {
            // The tolerance covers rounding.
            let length = dim::pose(position.0, *rotation).rotation.length();
            is_usable(position.0) && (length - 1.0).abs() < 1.0e-3
        };
        if parts.is_empty() {
            Err(Error::NoParts)
        } else if parts.iter().all(is_pose) {
            made(Self::compound(parts))
        } else {
            Err(Error::InvalidPose)
        }
    }
}
