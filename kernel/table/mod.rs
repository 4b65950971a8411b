//! The dense tables of bodies, colliders and constraints by id: what the stages look up, and nothing that the
//! embedder's own records already say.

mod body;
mod collider;
mod constraint;

pub(crate) use body::BodyParts;
pub use body::{Body, BodyKind, BodyPose, BodyTable, RestSpeed, Velocity};
pub use collider::{
    Collider, ColliderDef, ColliderFlags, ColliderTable, Combine, Fattening, Layers, Material, Reach, Surface,
};
pub(crate) use collider::{MOST_TURN, is_swinging, turn};
pub use constraint::{Constraint, ConstraintTable};

/// No body, collider, contact or row.
pub const NONE: u32 = u32::MAX;
