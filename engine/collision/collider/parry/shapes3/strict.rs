//! 3D constructors that return an error where their namesakes without `try_` repair. See `shapes2` for 2D.

use super::super::{
    Collider, ColliderError as Error, FillMode,
    input::{MAX_LENGTH, is_usable},
    strict::{all_elements, made, sizes, sizes_or_zero, voxel_size},
};
use crate::math::{Scalar, Vector};

impl Collider {
    /// As [`sphere`](Self::sphere).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize).
    pub fn try_sphere(radius: Scalar) -> Result<Self, Error> {
        sizes(&[radius])?;
        Ok(Self::sphere(radius))
    }

    /// As [`cuboid`](Self::cuboid).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize).
    pub fn try_cuboid(x_length: Scalar, y_length: Scalar, z_length: Scalar) -> Result<Self, Error> {
        sizes(&[x_length, y_length, z_length])?;
        Ok(Self::cuboid(x_length, y_length, z_length))
    }

    /// As [`round_cuboid`](Self::round_cuboid).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize) for the sides, [`NegativeSize`](Error::NegativeSize)
    /// for the radius.
    pub fn try_round_cuboid(
        x_length: Scalar,
        y_length: Scalar,
        z_length: Scalar,
        border_radius: Scalar,
    ) -> Result<Self, Error> {
        sizes(&[x_length, y_length, z_length])?;
        sizes_or_zero(&[border_radius])?;
        Ok(Self::round_cuboid(x_length, y_length, z_length, border_radius))
    }

    /// As [`cylinder`](Self::cylinder).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize).
    pub fn try_cylinder(radius: Scalar, height: Scalar) -> Result<Self, Error> {
        sizes(&[radius, height])?;
        Ok(Self::cylinder(radius, height))
    }

    /// As [`cone`](Self::cone).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize).
    pub fn try_cone(radius: Scalar, height: Scalar) -> Result<Self, Error> {
        sizes(&[radius, height])?;
        Ok(Self::cone(radius, height))
    }

    /// As [`voxelized_trimesh`](Self::voxelized_trimesh).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize), [`InvalidElement`](Error::InvalidElement),
    /// [`NoElements`](Error::NoElements), [`TooManyVoxels`](Error::TooManyVoxels), [`Empty`](Error::Empty).
    pub fn try_voxelized_trimesh(
        vertices: &[Vector],
        indices: &[[u32; 3]],
        size: Scalar,
        fill_mode: FillMode,
    ) -> Result<Self, Error> {
        voxel_size(vertices, size)?;
        all_elements(vertices, indices)?;
        made(Self::voxelized_trimesh(vertices, indices, size, fill_mode))
    }

    /// As [`heightfield`](Self::heightfield).
    ///
    /// # Errors
    ///
    /// [`TooFewHeights`](Error::TooFewHeights), [`UnevenHeights`](Error::UnevenHeights),
    /// [`InvalidSize`](Error::InvalidSize) for the extents, [`InvalidPoint`](Error::InvalidPoint)
    /// for a height.
    pub fn try_heightfield(heights: Vec<Vec<Scalar>>, scale: Vector) -> Result<Self, Error> {
        if heights.len() < 2 || heights.iter().any(|line| line.len() < 2) {
            return Err(Error::TooFewHeights);
        }
        if heights.iter().any(|line| line.len() != heights[0].len()) {
            return Err(Error::UnevenHeights);
        }
        sizes(&[scale.x, scale.z])?;
        let is_height = |h: &Scalar| h.abs() <= MAX_LENGTH;
        if is_usable(scale) && heights.iter().flatten().all(is_height) {
            Ok(Self::heightfield(heights, scale))
        } else {
            Err(Error::InvalidPoint)
        }
    }
}
