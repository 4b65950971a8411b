//! Results of shapes: ray hits, and errors of constructors.

use crate::math::Vector;

/// The hit of a ray on a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The distance along the (unit) direction, in metres.
    pub distance: f32,
    /// The outward unit normal; zero if the ray starts inside a solid shape.
    pub normal: Vector,
}

/// The reason why values do not make a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ShapeError {
    /// A coordinate, length or radius is NaN or infinite.
    NotFinite,
    /// A radius or half extent is negative.
    Negative,
    /// Fewer distinct points than span the shape, or all points on a line (or plane).
    Degenerate,
    /// An outline or mesh is not convex.
    NotConvex,
    /// An index names no vertex.
    OutOfRange,
}

impl core::fmt::Display for ShapeError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "a coordinate, length or radius is NaN or infinite",
            Self::Negative => "a radius or half extent is negative",
            Self::Degenerate => "the points do not span a shape",
            Self::NotConvex => "the points are not in convex position",
            Self::OutOfRange => "an index names no vertex",
        })
    }
}

impl core::error::Error for ShapeError {}
