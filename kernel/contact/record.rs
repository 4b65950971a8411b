//! The record of a contact, kept from step to step.

use crate::graph::ColorSlot;
use crate::manifold::FeatureCache;
use crate::math::{MAX_POINTS, NormalMoment, Rot, Vector};
use crate::table::{ColliderTable, FacetMaterial, Material, NONE};

/// Bits of a contact's state.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ContactFlags(pub u16);

impl ContactFlags {
    /// Has points. The solver takes it unless it is a sensor's, immovable or quiet.
    pub const TOUCHING: Self = Self(1 << 0);
    /// Detects only: no rows, no colour, no island.
    pub const SENSOR: Self = Self(1 << 1);
    /// Neither body moves by impulses: no rows, no colour, no island.
    pub const IMMOVABLE: Self = Self(1 << 2);
    /// A shape is known only to the embedder. Manifolds come from its
    /// [`ManifoldSource`](super::ManifoldSource), and are not recycled.
    pub const FOREIGN: Self = Self(1 << 3);
    /// The frozen pose is valid: the manifold may be recycled.
    pub const FROZEN: Self = Self(1 << 4);
    /// The fat boxes no longer overlap: the contact is to be destroyed.
    pub const SEPARATED: Self = Self(1 << 5);
    /// The bodies were placed with deep overlap and have not separated since. Split impulses push them out.
    pub const DEEP: Self = Self(1 << 6);
    /// Body A is not dynamic: normal and anchors turn with it.
    pub const PLATFORM_A: Self = Self(1 << 7);
    /// Body B is not dynamic: normal and anchors turn with it.
    pub const PLATFORM_B: Self = Self(1 << 8);

    /// A shape is [composite](crate::shape::Composite), and no shape is foreign: there may be
    /// several manifolds.
    pub const COMPOSITE: Self = Self(1 << 9);

    /// The embedder changed the manifolds in this step; their surfaces are not the contact's.
    pub const CHANGED: Self = Self(1 << 10);

    /// The embedder wants no response for this pair: no rows, no colour, no island.
    pub const QUIET: Self = Self(1 << 11);

    /// Collider A slid over B as over ground in the last update. Not both slide.
    pub const SLIDES_A: Self = Self(1 << 12);
    /// Collider B slid over A as over ground in the last update.
    pub const SLIDES_B: Self = Self(1 << 13);

    /// A shape is a hull: as it turns, faces may approach that have no points in a full manifold.
    pub const HULL: Self = Self(1 << 14);

    /// The separations, if any, are current at the end of the last step, and the contact needs no update up
    /// to [`calm_until`](Contact::calm_until).
    pub const CALM: Self = Self(1 << 15);

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
    /// The union of the bits.
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
    /// The separation at the frozen pose, in metres. For shapes that meet later in the step, the separation
    /// at the meeting pose.
    pub frozen_separation: f32,
    /// The separation now, in metres.
    pub separation: f32,
    /// The normal impulse of the last substep, N·s; the next step starts from it.
    pub impulse: f32,
    /// The sum of the normal impulses of all substeps of the last step, N·s; 0 if the
    /// [table](super::ContactTable::sum_impulses) keeps no sums.
    pub total_impulse: f32,
    /// Id of the features of both shapes at this point.
    pub feature: u32,
}

/// The contact of two convex shapes, from which the solver's rows are made.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Manifold {
    /// The unit normal from A to B, in world axes.
    pub normal: Vector,
    /// The points; the first `count` are valid.
    pub points: [ManifoldPoint; MAX_POINTS],
    /// The number of points.
    pub count: u8,
    /// Whether it lies at an internal edge: another manifold prevents the same motion, so it is not solved.
    pub is_internal: bool,
    /// Material groups of the touching facets of A and B, 0 for the material of the collider; see
    /// [`FacetMaterials`](crate::table::FacetMaterials).
    pub groups: [u8; 2],
    /// The radii of A and B around their cores (centre, axis, polygon), in metres. Anchors are of the cores:
    /// as a round shape turns, its contact keeps its place relative to the core, not on the surface.
    pub radii: [f32; 2],
    /// The friction impulse in world axes, N·s; the next step starts from it.
    pub friction_impulse: Vector,
    /// The impulse of the friction against turning about the normal, N·m·s.
    pub twist_impulse: NormalMoment,
    /// Normal impulses that the friction limit does not include yet, N·s.
    pub friction_owed: f32,
}

impl Manifold {
    /// The valid points.
    #[inline(always)]
    pub fn points(&self) -> &[ManifoldPoint] {
        &self.points[..usize::from(self.count)]
    }

    /// The number of points that the solver takes.
    #[inline(always)]
    pub fn solved_points(&self) -> u32 {
        if self.is_internal { 0 } else { u32::from(self.count) }
    }

    /// Whether a touching facet has a material of its own.
    #[inline(always)]
    pub fn has_own_surface(&self) -> bool {
        self.groups != [0; 2]
    }

    /// The surface of the manifold of a contact, by the materials of the colliders and of their facets now.
    pub fn surface(&self, contact: &Contact, colliders: &ColliderTable) -> ManifoldSurface {
        let [friction, restitution] = contact.surface;
        if !self.has_own_surface() {
            return ManifoldSurface { friction, restitution, velocity: Vector::ZERO };
        }
        let [a, b] = [0, 1].map(|side| {
            let id = contact.colliders[side];
            let def = &colliders[id].def;
            let own = def.facets.as_ref().and_then(|facets| facets.of_group(self.groups[side]));
            let of_collider = FacetMaterial { material: def.material, velocity: Vector::ZERO };
            let FacetMaterial { material, velocity } = own.copied().unwrap_or(of_collider);
            (material, colliders.poses[id as usize].rotation.rotate(velocity))
        });
        let (Material { friction, restitution }, other) = (a.0, b.0);
        ManifoldSurface {
            friction: friction.mix(other.friction),
            restitution: restitution.mix(other.restitution),
            // A body on A moves along with A's surface, and A moves along with B's surface.
            velocity: a.1 - b.1,
        }
    }
}

/// Coefficients and surface velocity of a manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ManifoldSurface {
    /// The coefficient of friction, not negative.
    pub friction: f32,
    /// The coefficient of restitution, not negative.
    pub restitution: f32,
    /// The velocity that friction gives B's surface relative to A's, in world axes, m/s. Only its tangential
    /// part counts.
    pub velocity: Vector,
}

/// The impulse of a point that a sliding collider lost, to be transferred to another point.
#[derive(Clone, Copy, Debug)]
pub(super) struct LostImpulse {
    pub(super) contact: u32,
    /// The number of the point in the contact.
    pub(super) number: u32,
    /// The collider that slides.
    pub(super) collider: u32,
    /// From the centre of mass of the collider's body.
    pub(super) place: Vector,
    /// From the ground to the collider.
    pub(super) normal: Vector,
    pub(super) impulse: f32,
}

/// Parallel manifolds of a sliding collider. Normals differ from the first normal by less than half of the
/// tolerance.
#[derive(Clone, Debug)]
pub(super) struct Parallel {
    pub(super) normal: Vector,
    /// The largest distance of a normal from the first normal.
    pub(super) spread: f32,
    /// The manifolds in the list of all, the highest planes first.
    pub(super) range: core::ops::Range<usize>,
}

/// A point of a sliding collider that may receive a lost impulse.
#[derive(Clone, Copy, Debug)]
pub(super) struct LoadPoint {
    pub(super) contact: u32,
    /// The number of the manifold in the contact.
    pub(super) index: u32,
    /// The number of the point in the manifold.
    pub(super) point: u32,
    /// The number of the point in the collider's list.
    pub(super) order: u32,
    /// From the centre of mass of the collider's body.
    pub(super) place: Vector,
    /// From the ground to the collider.
    pub(super) normal: Vector,
}

/// A manifold between a moving collider and the ground that it slides over.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sliding {
    pub(super) contact: u32,
    /// The manifold's number in the contact.
    pub(super) index: u32,
    /// Its number among the manifolds of the collider.
    pub(super) order: u32,
    /// The collider's side of the contact.
    pub(super) side: usize,
    /// From the ground to the collider.
    pub(super) normal: Vector,
    /// Whether a shape is round.
    pub(super) is_round: bool,
    /// Whether it has more than two points.
    pub(super) is_face: bool,
    /// Unit vector from the first to the second of two points, if a shape is round; otherwise 0.
    pub(super) line: Vector,
    /// Whether the manifold is marked as internal.
    pub(super) is_marked: bool,
    /// The number of its group of parallel manifolds.
    pub(super) group: u32,
    /// Height of its plane along its normal; set only with several groups.
    pub(super) height: f32,
}

/// The relative pose of the bodies at which the manifold was computed, turned since then with a platform.
#[derive(Clone, Copy, Debug, Default)]
pub struct Frozen {
    /// The rotations of bodies A and B.
    pub rotations: [Rot; 2],
    /// From A's to B's centre of mass.
    pub offset: Vector,
    /// Distance up to which points were searched. Without points, a lower bound of the distance between the
    /// shapes. Margins are subtracted; in metres.
    pub prediction: f32,
}

/// A pair of colliders whose fat boxes overlap.
///
/// Field order: hot for all contacts (one cache line in 2D), hot while touching, cold.
#[derive(Clone, Debug)]
#[repr(C)]
#[cfg_attr(feature = "2d", repr(align(64)))]
pub struct Contact {
    /// The colliders, the lower id first.
    pub colliders: [u32; 2],
    /// The bodies of the colliders, or [`NONE`].
    pub bodies: [u32; 2],
    /// Each side's revisions of collider and body when the manifold was computed.
    pub revisions: [u32; 2],
    /// State bits.
    pub flags: ContactFlags,
    /// The number of manifolds in the side pool.
    pub extra_count: u16,
    /// The sum of both bodies' [travels](crate::table::BodyPose::travel) up to which the contact
    /// needs no update.
    pub calm_until: u32,
    /// The pose at which the manifold was computed.
    pub frozen: Frozen,
    /// The last separating axis or reference feature.
    pub cache: FeatureCache,
    /// The first manifold; convex shapes have no other.
    pub manifold: Manifold,
    /// The mixed coefficients of friction and restitution.
    pub surface: [f32; 2],
    /// The slot in the side pool, or [`NONE`].
    pub extra: u32,
    /// The place among its colour's contacts; `None` unless the contact is solved and awake.
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
            calm_until: 0,
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

    /// Whether the solver takes it: it has points and is not inert.
    #[inline(always)]
    pub fn is_solved(&self) -> bool {
        self.flags.has(ContactFlags::TOUCHING) && !self.is_inert()
    }

    /// Whether its bodies may pass through each other: it detects only, or the embedder dropped its manifolds
    /// in this step.
    pub fn is_let_through(&self) -> bool {
        let is_dropped = self.flags.has(ContactFlags::CHANGED) && !self.flags.has(ContactFlags::TOUCHING);
        is_dropped || self.flags.any(ContactFlags::SENSOR.union(ContactFlags::QUIET))
    }

    /// Whether the solver ignores it even if it has points.
    #[inline(always)]
    pub fn is_inert(&self) -> bool {
        self.flags.any(ContactFlags::SENSOR.union(ContactFlags::IMMOVABLE).union(ContactFlags::QUIET))
    }
}
