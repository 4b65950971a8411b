//! Bounding-volume trees: which boxes may touch a given box, ray or swept box, and which pairs of boxes may
//! touch.
//!
//! A [`Tree`] holds one kind of collider, [`Trees`] all kinds. The broad phase changes the boxes of moving
//! leaves in place and [`FoundPairs::find`] searches for the pairs of these leaves. The boxes above the
//! leaves are recomputed at the end of the step. [`Tree`] tells which change to use when.
//!
//! After Catto, "Dynamic Bounding Volume Hierarchies" (GDC 2019), and the partial rebuild of his Box2D v3.
//! Binned splitting is after Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies" (2007).

mod build;
mod fit;
mod meet;
#[cfg(test)]
mod oracle;
mod pairs;
mod query;
mod stack;
mod tree;
mod validate;

pub use pairs::{FoundPairs, Known, Mover, Movers, PairMask, TreeKind, Trees};
pub use tree::{ProxyId, Tree};
