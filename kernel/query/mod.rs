//! Spatial queries: rays, shape casts, nearest points and overlaps.
//!
//! For two shapes at poses: [`closest`], [`visit_closest`], [`overlaps`], [`cast_shape`], [`project_point`].
//! For all colliders in trees: a [`Ray`] or a [`ShapeCast`] is made once and visits the colliders that it may
//! meet.
//!
//! All queries are read-only, accept any numbers, and give the same bits for the same input. Distances are in
//! metres.

mod cast;
mod closest;
mod hits;
mod near;
mod point;
mod ray;
mod shape_cast;
#[cfg(test)]
pub(crate) mod tests;

pub use cast::{CastConfig, CastHit, cast_shape};
pub use closest::{Closest, closest, overlaps, visit_closest};
pub use hits::{Hit, Nearest, sort_hits};
pub use near::{visit_near, visit_touching};
pub use point::{Projection, contains_point, project_point};
pub use ray::{Ray, RayCastHit};
pub use shape_cast::{ShapeCast, ShapeCastHit};
