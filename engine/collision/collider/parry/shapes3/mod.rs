//! Constructors of 3D. `shapes2` has the constructors of 2D, and its shapes.

mod collider;
pub(super) mod from_constructor;
#[cfg(feature = "collider-from-mesh")]
pub(super) mod from_mesh;
mod primitives;
pub(super) mod scaled;
mod strict;
