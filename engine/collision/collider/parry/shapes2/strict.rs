//! 2D constructors that return an error where their namesakes without `try_` repair. See `shapes3` for 3D.

use super::super::{
    Collider, ColliderError as Error, FillMode,
    input::{MAX_LENGTH, is_usable},
    strict::{all_elements, made, points, sizes, sizes_or_zero, voxel_size},
};
use crate::math::{AdjustPrecision, Scalar, Vector};

/// Maximum number of sides of a regular polygon.
const MOST_SIDES: u32 = 10_000;

impl Collider {
    /// As [`circle`](Self::circle).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize).
    pub fn try_circle(radius: Scalar) -> Result<Self, Error> {
        sizes(&[radius])?;
        Ok(Self::circle(radius))
    }

    /// As [`ellipse`](Self::ellipse).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize).
    pub fn try_ellipse(half_width: Scalar, half_height: Scalar) -> Result<Self, Error> {
        sizes(&[half_width, half_height])?;
        Ok(Self::ellipse(half_width, half_height))
    }

    /// As [`rectangle`](Self::rectangle).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize).
    pub fn try_rectangle(x_length: Scalar, y_length: Scalar) -> Result<Self, Error> {
        sizes(&[x_length, y_length])?;
        Ok(Self::rectangle(x_length, y_length))
    }

    /// As [`round_rectangle`](Self::round_rectangle).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize) for the sides, [`NegativeSize`](Error::NegativeSize)
    /// for the radius.
    pub fn try_round_rectangle(
        x_length: Scalar,
        y_length: Scalar,
        border_radius: Scalar,
    ) -> Result<Self, Error> {
        sizes(&[x_length, y_length])?;
        sizes_or_zero(&[border_radius])?;
        Ok(Self::round_rectangle(x_length, y_length, border_radius))
    }

    /// As [`regular_polygon`](Self::regular_polygon).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize), [`InvalidSides`](Error::InvalidSides).
    pub fn try_regular_polygon(circumradius: f32, sides: u32) -> Result<Self, Error> {
        sizes(&[circumradius.adjust_precision()])?;
        match sides {
            3..=MOST_SIDES => Ok(Self::regular_polygon(circumradius, sides)),
            _ => Err(Error::InvalidSides),
        }
    }

    /// As [`convex_polyline`](Self::convex_polyline).
    ///
    /// # Errors
    ///
    /// [`InvalidPoint`](Error::InvalidPoint), [`NotConvex`](Error::NotConvex).
    pub fn try_convex_polyline(corners: Vec<Vector>) -> Result<Self, Error> {
        points(&corners)?;
        Self::convex_polyline(corners).ok_or(Error::NotConvex)
    }

    /// As [`voxelized_polyline`](Self::voxelized_polyline).
    ///
    /// # Errors
    ///
    /// [`InvalidSize`](Error::InvalidSize), [`InvalidElement`](Error::InvalidElement),
    /// [`NoElements`](Error::NoElements), [`TooManyVoxels`](Error::TooManyVoxels), [`Empty`](Error::Empty).
    pub fn try_voxelized_polyline(
        vertices: &[Vector],
        indices: &[[u32; 2]],
        size: Scalar,
        fill_mode: FillMode,
    ) -> Result<Self, Error> {
        voxel_size(vertices, size)?;
        all_elements(vertices, indices)?;
        made(Self::voxelized_polyline(vertices, indices, size, fill_mode))
    }

    /// As [`heightfield`](Self::heightfield).
    ///
    /// # Errors
    ///
    /// [`TooFewHeights`](Error::TooFewHeights), [`InvalidSize`](Error::InvalidSize) for the width,
    /// [`InvalidPoint`](Error::InvalidPoint) for a height.
    pub fn try_heightfield(heights: Vec<Scalar>, scale: Vector) -> Result<Self, Error> {
        if heights.len() < 2 {
            return Err(Error::TooFewHeights);
        }
        sizes(&[scale.x])?;
        let is_height = |h: &Scalar| h.abs() <= MAX_LENGTH;
        if is_usable(scale) && heights.iter().all(is_height) {
            Ok(Self::heightfield(heights, scale))
        } else {
            Err(Error::InvalidPoint)
        }
    }
}
