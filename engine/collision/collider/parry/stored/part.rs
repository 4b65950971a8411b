//! Stored formats of shapes that may be part of a compound.

use serde::{Deserialize, Serialize};

use super::{
    check::{Fault, check_lengths, check_normals, check_points, round},
    dim,
};
use crate::{
    collision::collider::parry::constructors::MAX_VOXEL,
    math::{Scalar, Vector},
    parry::{
        math::IVector,
        shape::{Ball, Capsule, Cuboid, HalfSpace, Segment, SharedShape, Triangle, TypedShape, Voxels},
    },
};

/// Stored format of one shape. The fields are parry's.
#[derive(Serialize, Deserialize)]
pub(super) enum Part {
    Ball { radius: Scalar },
    Cuboid { half_extents: Vector },
    RoundCuboid { half_extents: Vector, border_radius: Scalar },
    Capsule { a: Vector, b: Vector, radius: Scalar },
    Segment { a: Vector, b: Vector },
    Triangle { a: Vector, b: Vector, c: Vector },
    RoundTriangle { a: Vector, b: Vector, c: Vector, border_radius: Scalar },
    HalfSpace { normal: Vector },
    HeightField(dim::StoredHeights),
    Voxels { size: Vector, cells: Vec<IVector> },
    OfDimension(dim::StoredSpecial),
}

impl Part {
    /// The stored format of a shape. Compounds and meshes are errors here.
    pub fn of(shape: &SharedShape) -> Result<Self, Fault> {
        Ok(match shape.as_typed_shape() {
            TypedShape::Ball(ball) => Self::Ball { radius: ball.radius },
            TypedShape::Cuboid(cuboid) => Self::Cuboid { half_extents: cuboid.half_extents },
            TypedShape::RoundCuboid(round) => {
                let half_extents = round.inner_shape.half_extents;
                Self::RoundCuboid { half_extents, border_radius: round.border_radius }
            }
            TypedShape::Capsule(capsule) => {
                let Segment { a, b } = capsule.segment;
                Self::Capsule { a, b, radius: capsule.radius }
            }
            TypedShape::Segment(&Segment { a, b }) => Self::Segment { a, b },
            TypedShape::Triangle(&Triangle { a, b, c }) => Self::Triangle { a, b, c },
            TypedShape::RoundTriangle(round) => {
                let Triangle { a, b, c } = round.inner_shape;
                Self::RoundTriangle { a, b, c, border_radius: round.border_radius }
            }
            TypedShape::HalfSpace(half_space) => Self::HalfSpace { normal: half_space.normal },
            TypedShape::HeightField(field) => Self::HeightField(dim::StoredHeights::of(field)),
            TypedShape::Voxels(voxels) => {
                Self::Voxels { size: voxels.voxel_size(), cells: filled_cells(voxels) }
            }
            other => Self::OfDimension(dim::StoredSpecial::of(other)?),
        })
    }

    /// The shape of a stored format.
    pub fn shape(self) -> Result<SharedShape, Fault> {
        Ok(match self {
            Self::Ball { radius } => {
                check_lengths([radius])?;
                SharedShape::new(Ball { radius })
            }
            Self::Cuboid { half_extents } => {
                check_lengths(half_extents.to_array())?;
                SharedShape::new(Cuboid { half_extents })
            }
            Self::RoundCuboid { half_extents, border_radius } => {
                check_lengths(half_extents.to_array())?;
                round(Cuboid { half_extents }, border_radius, SharedShape::new)?
            }
            Self::Capsule { a, b, radius } => {
                check_points(&[a, b])?;
                check_lengths([radius])?;
                SharedShape::new(Capsule { segment: Segment { a, b }, radius })
            }
            Self::Segment { a, b } => {
                check_points(&[a, b])?;
                SharedShape::new(Segment { a, b })
            }
            Self::Triangle { a, b, c } => {
                check_points(&[a, b, c])?;
                SharedShape::new(Triangle { a, b, c })
            }
            Self::RoundTriangle { a, b, c, border_radius } => {
                check_points(&[a, b, c])?;
                round(Triangle { a, b, c }, border_radius, SharedShape::new)?
            }
            Self::HalfSpace { normal } => {
                check_normals(&[normal])?;
                SharedShape::new(HalfSpace { normal })
            }
            Self::HeightField(heights) => heights.shape()?,
            Self::Voxels { size, cells } => voxels(size, &cells)?,
            Self::OfDimension(special) => special.shape()?,
        })
    }
}

/// The filled cells, in parry's order.
fn filled_cells(voxels: &Voxels) -> Vec<IVector> {
    let [low, high] = voxels.domain();
    // Parry computes the domain by rounding: one more cell on each side misses none.
    let mut filled: Vec<_> = voxels.voxels_in_range(low - IVector::ONE, high + IVector::ONE).collect();
    filled.retain(|voxel| !voxel.state.is_empty());
    filled.sort_unstable_by_key(|voxel| voxel.linear_id.flat_id());
    filled.into_iter().map(|voxel| voxel.grid_coords).collect()
}

fn voxels(size: Vector, cells: &[IVector]) -> Result<SharedShape, Fault> {
    check_lengths(size.to_array())?;
    let in_range = |c: &IVector| c.to_array().iter().all(|v| v.unsigned_abs() as u64 <= MAX_VOXEL as u64);
    if cells.is_empty() || size.min_element() <= 0.0 || !cells.iter().all(in_range) {
        return Err("voxels have no size, or a cell is out of range");
    }
    Ok(SharedShape::voxels(size, cells))
}
