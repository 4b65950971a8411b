//! Closest points of convex shapes by their support points.
//!
//! A convex shape is a core (a point, a segment, a polytope, or any shape with support points) and a radius
//! around it. Cores that are apart have closest points ([`closest_cores`]); overlap beyond the radii is
//! measured by manifolds.

mod advance;
mod convex;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
pub(crate) mod gjk;
mod simplex;

pub(crate) use advance::{Approach, advance};
pub(crate) use convex::Convex;
pub(crate) use gjk::{Accuracy, Cores, Frame, Search, closest_cores};
