//! Inputs of the functions that compute manifolds, and the cache from one step to the next.

use crate::math::{Pose, Vector};
use core::cell::Cell;

/// Inputs of the function of a convex pair besides the shapes.
#[derive(Clone, Copy)]
pub(super) struct PairInput<'a> {
    /// The pose of B in A's frame.
    pub pose: &'a Pose,
    /// Points up to this distance are found, in metres.
    pub prediction: f32,
    /// The cache of the pair, from the last step and for the next step.
    pub cache: &'a Cell<FeatureCache>,
}

/// Inputs of a manifold computation besides the shapes: distance, motion, ground and groups.
#[derive(Clone, Copy, Debug)]
pub struct ManifoldQuery<'a> {
    /// Points up to this distance are found, in metres.
    pub prediction: f32,
    /// Motion of B relative to A until the end of the step, in A's frame. Parts that may be passed by are
    /// swept to their time of impact.
    pub motion: Vector,
    /// Parts farther away than this may be passed by. Nearer parts count as met, or may be met by turning.
    pub met: f32,
    /// Whether A and B are ground: not dynamic. Ground is never inside a dynamic shape.
    pub ground: [bool; 2],
    /// The group of each facet of A and of B; facets beyond the list have 0. Manifolds of different groups
    /// are not merged.
    pub groups: [&'a [u8]; 2],
}

impl<'a> ManifoldQuery<'a> {
    /// All facets of both shapes in one group.
    pub const ALIKE: [&'static [u8]; 2] = [&[]; 2];

    /// A query up to a distance, without motion.
    pub fn up_to(prediction: f32) -> Self {
        Self { prediction, motion: Vector::ZERO, met: f32::INFINITY, ground: [false; 2], groups: Self::ALIKE }
    }

    /// The query with A and B swapped. `pose` is B's pose in A's frame.
    pub(super) fn swapped(&self, pose: &Pose) -> Self {
        let ([own, other], [a, b]) = (self.ground, self.groups);
        let motion = pose.rotation.inverse_rotate(-self.motion);
        Self { motion, ground: [other, own], groups: [b, a], ..*self }
    }

    /// The group of a part of one side.
    pub(super) fn group(&self, side: usize, part: u32) -> u8 {
        self.groups[side].get(part as usize).copied().unwrap_or(0)
    }
}

/// The separating axis or reference feature of a pair's last manifold: eight bytes in its contact.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FeatureCache {
    /// The kind of axis: 0 is none; the function of the pair numbers the other kinds.
    pub kind: u8,
    /// A feature of shape A.
    pub a: u8,
    /// A feature of shape B.
    pub b: u8,
    /// The separation along that axis when it was found, in metres.
    pub separation: f32,
}

impl FeatureCache {
    /// An empty cache.
    pub const NONE: Self = Self { kind: 0, a: 0, b: 0, separation: 0.0 };
}
