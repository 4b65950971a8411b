//! Constructors and shapes of 2D. See `shapes3` for 3D.

mod collider;
pub(super) mod ellipse;
pub(super) mod from_constructor;
#[cfg(feature = "collider-from-mesh")]
pub(super) mod from_mesh;
mod primitives;
pub(super) mod regular_polygon;
pub(super) mod scaled;
mod strict;

pub use ellipse::EllipseColliderShape;
pub use regular_polygon::RegularPolygonColliderShape;
