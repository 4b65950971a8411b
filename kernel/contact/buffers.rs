//! What one worker of the narrow phase computes with, and what it leaves for the table.

use super::record::{LostImpulse, Manifold, Parallel, Sliding};
use super::recycle::RecycleBatch;
use crate::manifold::{CompositeBuffers, LocalManifold};
use crate::math::Vector;

/// Buffers of one worker, kept between steps. They are written with every contact, so each worker's are in
/// cache lines of their own.
#[derive(Clone, Debug, Default)]
#[repr(align(128))]
pub struct WorkerBuffers {
    /// The manifolds of the contact at hand, in A's frame.
    pub(super) local: Vec<LocalManifold>,
    pub(super) composite: CompositeBuffers,
    /// Contacts that may be recycled.
    pub(super) batch: RecycleBatch,
    /// The manifolds after the first of the contact that was updated last.
    pub extra: Vec<Manifold>,
    /// Contacts that began or ended to touch, or whose boxes came apart.
    pub(super) changed: Vec<u32>,
    /// Contacts whose manifolds after the first are to be stored, and how many these are.
    pub(super) stored: Vec<(u32, usize)>,
    /// The manifolds of `stored`, one contact's after the other's.
    pub(super) pool: Vec<Manifold>,
    /// Colliders that slide, by each of their contacts with points, and whether its manifolds have to be
    /// compared in any case.
    pub(super) sliding: Vec<(u32, bool)>,
    /// The manifolds of the sliding collider at hand.
    pub(super) slides: Vec<Sliding>,
    /// Those that are parallel.
    pub(super) parallel: Vec<Parallel>,
    /// Contacts, and the numbers of those of their manifolds, whose
    /// [`is_internal`](Manifold::is_internal) changes.
    pub(super) internal: Vec<(u32, u32)>,
    /// Manifolds that get other normals, from the ground to the collider.
    pub(super) turned: Vec<(u32, u32, Vector)>,
    /// Points under load that sliding colliders lost.
    pub(super) lost: Vec<LostImpulse>,
    /// Whether any contact overlaps deeply.
    pub(super) any_deep: bool,
}

impl WorkerBuffers {
    /// Empties what the last update left for the table.
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
