//! Bounding-volume trees: which boxes may touch a box, a ray or a swept box, and which pairs may touch.
//!
//! A [`Tree`] holds one kind of collider, [`Trees`] all kinds. In the broad phase the boxes of moving leaves are changed in
//! place, [`FoundPairs::find`] searches for the pairs of these leaves, and the boxes above are recomputed at the end of the
//! step. [`Tree`] tells which change to use when.
//!
//! After Catto, "Dynamic Bounding Volume Hierarchies" (GDC 2019), and the partial rebuild of his
//! Box2D v3; binned splitting after Wald, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies" (2007).

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
