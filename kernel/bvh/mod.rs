//! Bounding-volume trees: which boxes may touch a box, a ray or a swept box, and which pairs may touch.
//!
//! A [`Tree`] holds one kind of collider; [`Trees`] all kinds. Broad phase: moving leaves
//! [`enlarge`](Tree::enlarge), [`FoundPairs::find`] asks for the partners of what moved, and
//! [`rebuild_partial`](Tree::rebuild_partial) mends the tree while nobody asks.
//!
//! After Catto, "Dynamic Bounding Volume Hierarchies" (GDC 2019), and the partial rebuild of his
//! Box2D v3; binned splitting after Wald, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies" (2007).

mod build;
mod fit;
#[cfg(test)]
mod measure;
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
