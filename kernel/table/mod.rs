//! Dense tables of bodies, colliders and constraints by id, for all stages of a step.

mod body;
mod collider;
mod constraint;
mod facets;
mod material;

pub use body::{Body, BodyKind, BodyPose, BodyTable, RestSpeed, Velocity};
pub(crate) use body::{BodyParts, FAR, TravelScale};
pub use collider::{BodySize, Collider, ColliderDef, ColliderFlags, ColliderTable, Fattening, Layers, Reach};
pub(crate) use collider::{is_swinging, turn};
pub use constraint::{Constraint, ConstraintTable};
pub use facets::{FacetMaterial, FacetMaterials, MAX_FACET_MATERIALS};
pub use material::{Combine, Material, Surface};

/// The absent id: no body, collider, contact or row.
pub const NONE: u32 = u32::MAX;
