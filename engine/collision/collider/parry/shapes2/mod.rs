//! Constructors and shapes of 2D. `shapes3` has those of 3D.

mod collider;
pub(super) mod ellipse;
mod primitives;
pub(super) mod regular_polygon;
pub(super) mod scaled;

pub use ellipse::EllipseColliderShape;
pub use regular_polygon::RegularPolygonColliderShape;
