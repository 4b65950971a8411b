//! What is kept of a pair of colliders from step to step.

use crate::graph::ColorSlot;
use crate::manifold::FeatureCache;
use crate::math::{MAX_POINTS, Rot, Vector};
use crate::table::NONE;

/// Bits of a contact's state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactFlags(pub u16);

impl ContactFlags {
    /// Has points, so that it takes part in the solver (or would, were it not a sensor's).
    pub const TOUCHING: Self = Self(1 << 0);
    /// Detects only: no rows, no colour, no island.
    pub const SENSOR: Self = Self(1 << 1);
    /// Neither body moves by impulses: no rows, no colour, no island.
    pub const IMMOVABLE: Self = Self(1 << 2);
    /// A shape is known only to the embedder: manifolds come through its source, and are not recycled.
    pub const FOREIGN: Self = Self(1 << 3);
    /// The frozen pose is valid, so that the manifold may be recycled.
    pub const FROZEN: Self = Self(1 << 4);
    /// The fat boxes do not overlap any more: to be destroyed.
    pub const APART: Self = Self(1 << 5);
    /// Was put to overlap by more than a tenth of the smaller side's reach, and has not come apart since.
    pub const DEEP: Self = Self(1 << 6);
    /// Body A is not dynamic: normal and anchors turn with it.
    pub const PLATFORM_A: Self = Self(1 << 7);
    /// Body B is not dynamic: normal and anchors turn with it.
    pub const PLATFORM_B: Self = Self(1 << 8);

    /// Whether all bits of `other` are set.
    #[inline(always)]
    pub fn has(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }
    /// Sets or clears the bits of `other`.
    #[inline(always)]
    pub fn set(&mut self, other: Self, on: bool) {
        self.0 = if on { self.0 | other.0 } else { self.0 & !other.0 };
    }
    /// The bits of either.
    pub const fn union(self, other: Self) -> Self {
        Self(self.0 | other.0)
    }
    /// Whether any bit of `other` is set.
    #[inline(always)]
    pub fn any(self, other: Self) -> bool {
        self.0 & other.0 != 0
    }
}

/// One point of a manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ManifoldPoint {
    /// From body A's centre of mass, in world axes, at the frozen pose.
    pub anchor: Vector,
    /// The separation at the frozen pose, in metres.
    pub frozen_separation: f32,
    /// The separation now, in metres.
    pub separation: f32,
    /// The normal impulse of the last substep, N·s; the next step starts from it.
    pub impulse: f32,
    /// Which features of the shapes make this point.
    pub feature: u32,
}

/// The contact of two convex parts: what the solver's rows are made of.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Manifold {
    /// The unit normal from A to B, in world axes.
    pub normal: Vector,
    /// The points; the first `count` are valid.
    pub points: [ManifoldPoint; MAX_POINTS],
    /// How many points there are.
    pub count: u32,
    /// How far below the surfaces of A and B their cores are, in metres. As a round shape turns, the contact
    /// stays where it is on the surface, and keeps its place against the core only.
    pub rounding: [f32; 2],
    /// The friction impulse in world axes, N·s; the next step starts from it.
    pub friction_impulse: Vector,
    /// The impulse of the friction against turning about the normal, N·m·s; 0 in 2D.
    pub twist_impulse: f32,
}

impl Manifold {
    /// The valid points.
    #[inline(always)]
    pub fn points(&self) -> &[ManifoldPoint] {
        &self.points[..self.count as usize]
    }
}

/// The pose of the bodies that the manifold belongs to: how they stood when it was last computed in full, turned
/// since then with a platform.
#[derive(Clone, Copy, Debug, Default)]
pub struct Frozen {
    /// The rotations of bodies A and B.
    pub rotations: [Rot; 2],
    /// From A's to B's centre of mass.
    pub offset: Vector,
    /// The distance up to which points were looked for, or, if there were none, up to which there are none; margins
    /// aside, in metres.
    pub prediction: f32,
}

/// A pair of colliders whose fat boxes overlap.
///
/// What a contact without points is asked for in every step comes first, in the plane within one cache line; then what
/// pushing needs; last what is of use only when it comes or goes.
#[derive(Clone, Debug)]
#[repr(C)]
#[cfg_attr(feature = "2d", repr(align(64)))]
pub struct Contact {
    /// The colliders, the lower id first.
    pub colliders: [u32; 2],
    /// The bodies they belong to, or [`NONE`].
    pub bodies: [u32; 2],
    /// Each side's revisions of collider and body when the manifold was computed.
    pub revisions: [u32; 2],
    /// State bits.
    pub flags: ContactFlags,
    /// How many manifolds stand in the side pool besides the inline one.
    pub extra_count: u16,
    /// The pose that anchors and normal were computed at.
    pub frozen: Frozen,
    /// The last separating axis or reference feature.
    pub cache: FeatureCache,
    /// The first (for native pairs: only) manifold.
    pub manifold: Manifold,
    /// The coefficients of friction and restitution of both surfaces together.
    pub surface: [f32; 2],
    /// Where in the side pool, or [`NONE`].
    pub extra: u32,
    /// The place among its colour's contacts; `None` unless it touches, responds and is awake.
    pub slot: Option<ColorSlot>,
    /// Next and previous contact of the same collider, for each side, as `contact << 1 | side`.
    pub(super) next: [u32; 2],
    pub(super) previous: [u32; 2],
}

impl Contact {
    /// A new pair, not touching.
    pub(super) fn new(colliders: [u32; 2], bodies: [u32; 2], flags: ContactFlags) -> Self {
        Self {
            colliders,
            bodies,
            flags,
            extra_count: 0,
            extra: NONE,
            slot: None,
            surface: [0.0; 2],
            revisions: [0; 2],
            cache: FeatureCache::NONE,
            frozen: Frozen::default(),
            manifold: Manifold::default(),
            next: [NONE; 2],
            previous: [NONE; 2],
        }
    }

    /// Whether it has points and pushes.
    #[inline(always)]
    pub fn is_solved(&self) -> bool {
        self.flags.has(ContactFlags::TOUCHING) && !self.is_inert()
    }

    /// Whether it would not push if it had points.
    #[inline(always)]
    pub fn is_inert(&self) -> bool {
        self.flags.any(ContactFlags::SENSOR.union(ContactFlags::IMMOVABLE))
    }
}
