//! Errors of collider constructors.

/// Why a constructor of [`Collider`](super::Collider) whose name starts with `try_` made no collider.
///
/// Sizes and coordinates may be up to 10,000 km. Sizes are at least 10 µm.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ColliderError {
    /// A size that must be positive is not.
    #[error("a size is zero, negative, too large or not a number")]
    InvalidSize,
    /// A size that may be zero is negative or not finite.
    #[error("a size is negative, too large or not a number")]
    NegativeSize,
    /// A point is not finite, or outside the limits.
    #[error("a point is too far away or not a number")]
    InvalidPoint,
    /// A normal is zero or not finite.
    #[error("a normal has no direction")]
    NoDirection,
    /// Both ends of a segment are at the same place.
    #[error("the ends of a segment are at the same place")]
    NoLength,
    /// The corners of a triangle are on a line.
    #[error("the corners of a triangle are on a line")]
    NoArea,
    /// The points of a hull are on a line, or in 3D in a plane.
    #[error("the points span no hull")]
    NoHull,
    /// The points are not the corners of a convex polygon in order.
    #[error("the points are not the corners of a convex polygon in order")]
    NotConvex,
    /// A polygon has fewer than three or more than 10,000 sides.
    #[error("a polygon has fewer than three sides or too many")]
    InvalidSides,
    /// The segment or triangle with this index has corners that do not exist, are equal, or cannot be used.
    #[error("element {0} has corners that do not exist, are the same or cannot be used")]
    InvalidElement(u32),
    /// No segment or triangle has distinct corners that exist.
    #[error("there are no segments or triangles whose corners exist and differ")]
    NoElements,
    /// There are no voxels within ± 2²⁴ cells.
    #[error("there are no voxels, or only some that are too far away")]
    NoVoxels,
    /// The voxel with this index is more than 2²⁴ cells from the origin.
    #[error("voxel {0} is too far away")]
    InvalidVoxel(u32),
    /// There would be more than 8 million voxels.
    #[error("the voxels are too small for the size of the shape: there would be too many")]
    TooManyVoxels,
    /// A height field has fewer than two heights in a row.
    #[error("a height field has fewer than two heights in a row")]
    TooFewHeights,
    /// The rows of a height field differ in length.
    #[error("the rows of a height field differ in length")]
    UnevenHeights,
    /// A parameter of a convex decomposition is out of its range.
    #[error("a parameter of the decomposition is out of its range")]
    InvalidParameters,
    /// A convex decomposition failed.
    #[error("the decomposition found no parts")]
    NoDecomposition,
    /// A compound has no parts.
    #[error("a compound has no parts")]
    NoParts,
    /// A part of a compound has a position that is not finite, or an invalid rotation.
    #[error("the pose of a part is too far away or has no rotation")]
    InvalidPose,
    /// A scale is not finite, or almost zero along an axis.
    #[error("a scale is zero or not a number")]
    InvalidScale,
    /// A shape of the app's own type cannot be scaled.
    #[error("a shape of its type cannot be scaled like this")]
    UnscalableShape,
    /// Nothing is left after preprocessing.
    #[error("nothing of what the shape is made from can be used")]
    Empty,
    /// A constructor from a mesh was given no mesh.
    #[error("there is no mesh")]
    NoMesh,
    /// A mesh has no triangles that can be used.
    #[error("the mesh has no triangles that can be used")]
    NoMeshTriangles,
    /// A mesh has points or lines.
    #[error("the mesh has points or lines instead of triangles")]
    NotTriangles,
    /// A mesh has no positions.
    #[error("the mesh has no positions")]
    NoMeshPositions,
    /// The data of a mesh was moved to the render world.
    #[error("the data of the mesh is in the render world only: keep it with `RenderAssetUsages::all()`")]
    MeshNotReadable,
}
