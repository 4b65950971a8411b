//! Buffers and results of one worker of the narrow phase.

use super::record::{LostImpulse, Manifold, Parallel, Sliding};
use super::recycle::RecycleBatch;
use crate::manifold::{CompositeBuffers, LocalManifold};
use crate::math::Vector;

/// Buffers of one worker, kept between steps. Every contact writes them, so each worker has its own cache
/// lines.
#[derive(Clone, Debug, Default)]
#[repr(align(128))]
pub struct WorkerBuffers {
    /// Manifolds of the current contact, in A's frame.
    pub(super) local: Vec<LocalManifold>,
    pub(super) composite: CompositeBuffers,
    /// Contacts that may be recycled.
    pub(super) batch: RecycleBatch,
    /// Manifolds after the first of the last updated contact.
    pub extra: Vec<Manifold>,
    /// Contacts that began or ended to touch, or whose boxes came apart.
    pub(super) changed: Vec<u32>,
    /// Contacts whose manifolds after the first are to be stored, with their count.
    pub(super) stored: Vec<(u32, usize)>,
    /// The manifolds of `stored`, in the same order.
    pub(super) pool: Vec<Manifold>,
    /// Sliding colliders, one entry per contact with points, and whether this contact alone requires a
    /// comparison.
    pub(super) sliding: Vec<(u32, bool)>,
    /// Manifolds of the current sliding collider.
    pub(super) slides: Vec<Sliding>,
    /// Groups of parallel manifolds in `slides`.
    pub(super) parallel: Vec<Parallel>,
    /// (contact, manifold) pairs whose [`is_internal`](Manifold::is_internal) changes.
    pub(super) internal: Vec<(u32, u32)>,
    /// (contact, manifold) pairs with their new normals, from the ground to the collider.
    pub(super) turned: Vec<(u32, u32, Vector)>,
    /// Loaded points that sliding colliders lost.
    pub(super) lost: Vec<LostImpulse>,
    /// Whether any contact overlaps deeply.
    pub(super) any_deep: bool,
}

impl WorkerBuffers {
    /// Clears the results of the last update.
    pub(super) fn clear(&mut self) {
        self.changed.clear();
        self.stored.clear();
        self.pool.clear();
        self.sliding.clear();
        self.internal.clear();
        self.turned.clear();
        self.lost.clear();
        self.any_deep = false;
    }
}
