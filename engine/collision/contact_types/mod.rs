//! Contacts as the app sees them: [`Collisions`] gives pairs of colliders, with manifolds and their points.

mod contact_graph;
#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
mod dim;
mod feature_id;
mod manifold;
mod pair;
mod point;
mod single_contact;
mod system_param;
pub(crate) mod views;

pub use contact_graph::ContactGraph;
pub use dim::ContactManifold;
pub use feature_id::PackedFeatureId;
pub use pair::{ContactEdge, ContactEdgeFlags, ContactId, ContactPair, ContactPairFlags};
pub use point::ContactPoint;
pub use single_contact::SingleContact;
pub use system_param::Collisions;
