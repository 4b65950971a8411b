//! Constructors of 3D. `shapes2` has those of 2D, and its shapes.

mod collider;
mod primitives;
pub(super) mod scaled;
