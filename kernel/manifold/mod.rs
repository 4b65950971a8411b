//! Contact manifolds: points with feature ids, from two shapes and their relative pose.
//!
//! Each pair of native shapes has one function without allocations. All functions work in the frame of shape
//! A, with the normal from A to B; the narrow phase transforms the result to the world. Points lie midway
//! between the two surfaces. Points have separations up to the prediction distance; points with a positive
//! separation are speculative contacts.

mod border;
mod composite;
#[cfg_attr(feature = "2d", path = "dim2/mod.rs")]
#[cfg_attr(feature = "3d", path = "dim3/mod.rs")]
mod dim;
mod local;
mod merge;
mod pairs;
mod parts;
mod query;
mod screen;
#[cfg(test)]
mod tests_pairs;

pub use composite::{CompositeBuffers, collide_composite, collide_each_part};
pub use dim::midstep_rims;
pub use local::{LocalManifold, LocalPoint};
pub use pairs::collide;
use query::PairInput;
pub use query::{FeatureCache, ManifoldQuery};
