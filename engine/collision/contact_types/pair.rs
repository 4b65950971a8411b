//! A contact of two colliders: [`ContactEdge`] names it, [`ContactPair`] has its manifolds.

use bevy_ecs::entity::Entity;
use bevy_reflect::Reflect;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use bitflags::bitflags;

use super::{dim::ContactManifold, point::ContactPoint};
use crate::math::{Scalar, Vector};

/// The id of a contact. The ids of removed contacts are used again.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, Debug, PartialEq)]
pub struct ContactId(pub u32);

crate::type_path::type_path!(ContactId, "collision::contact_types");

impl ContactId {
    /// The id of no contact.
    pub const PLACEHOLDER: Self = Self(u32::MAX);
}

impl core::fmt::Display for ContactId {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "ContactId({})", self.0)
    }
}

/// State of a [`ContactEdge`], as bits.
#[repr(transparent)]
#[derive(Hash, Clone, Copy, PartialEq, Eq, Debug, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, opaque, Hash, Clone, Debug, PartialEq)]
pub struct ContactEdgeFlags(u8);

crate::type_path::type_path!(ContactEdgeFlags, "collision::contact_types");

bitflags! {
    impl ContactEdgeFlags: u8 {
        /// The colliders touch.
        const TOUCHING = 1 << 0;
        /// The bodies sleep.
        const SLEEPING = 1 << 1;
        /// A collider has `CollisionEventsEnabled`.
        const CONTACT_EVENTS = 1 << 2;
    }
}

/// Two colliders with overlapping boxes, without their manifolds.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactEdge {
    /// The id of the contact.
    pub id: ContactId,
    /// The first collider.
    pub collider1: Entity,
    /// The second collider.
    pub collider2: Entity,
    /// The body of the first collider, if it has one in the simulation.
    pub body1: Option<Entity>,
    /// The body of the second collider, if it has one in the simulation.
    pub body2: Option<Entity>,
    /// The index of the [`ContactPair`] among the active or the sleeping pairs of the graph.
    pub pair_index: usize,
    /// State bits.
    pub flags: ContactEdgeFlags,
}

impl ContactEdge {
    /// An edge without bodies and bits.
    pub fn new(collider1: Entity, collider2: Entity) -> Self {
        Self {
            id: ContactId::PLACEHOLDER,
            collider1,
            collider2,
            body1: None,
            body2: None,
            pair_index: 0,
            flags: ContactEdgeFlags::empty(),
        }
    }

    /// Whether the colliders touch.
    pub fn is_touching(&self) -> bool {
        self.flags.contains(ContactEdgeFlags::TOUCHING)
    }

    /// Whether the bodies sleep.
    pub fn is_sleeping(&self) -> bool {
        self.flags.contains(ContactEdgeFlags::SLEEPING)
    }

    /// Whether a collider has `CollisionEventsEnabled`.
    pub fn events_enabled(&self) -> bool {
        self.flags.contains(ContactEdgeFlags::CONTACT_EVENTS)
    }
}

/// State of a [`ContactPair`], as bits.
#[repr(transparent)]
#[derive(Hash, Clone, Copy, PartialEq, Eq, Debug, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(type_path = false, opaque, Hash, Clone, Debug, PartialEq)]
pub struct ContactPairFlags(u16);

crate::type_path::type_path!(ContactPairFlags, "collision::contact_types");

bitflags! {
    impl ContactPairFlags: u16 {
        /// The colliders touch.
        const TOUCHING = 1 << 0;
        /// The boxes of the colliders are apart.
        const DISJOINT_AABB = 1 << 1;
        /// The colliders started touching in the last step.
        const STARTED_TOUCHING = 1 << 2;
        /// The colliders stopped touching in the last narrow phase.
        const STOPPED_TOUCHING = 1 << 3;
        /// The solver pushes the bodies apart if the colliders touch: neither is a sensor, and a body is
        /// dynamic.
        const GENERATE_CONSTRAINTS = 1 << 4;
        /// The contact began to generate constraints in the last step.
        const STARTED_GENERATING_CONSTRAINTS = 1 << 5;
        /// The first body is static.
        const STATIC1 = 1 << 6;
        /// The second body is static.
        const STATIC2 = 1 << 7;
        /// [`CollisionHooks`](crate::prelude::CollisionHooks) modify the contact.
        const MODIFY_CONTACTS = 1 << 8;
    }
}

/// Two colliders with overlapping boxes, and their contact manifolds.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPair {
    /// The id of the contact.
    pub contact_id: ContactId,
    /// The first collider.
    pub collider1: Entity,
    /// The second collider.
    pub collider2: Entity,
    /// The body of the first collider, if it has one in the simulation.
    pub body1: Option<Entity>,
    /// The body of the second collider, if it has one in the simulation.
    pub body2: Option<Entity>,
    /// The manifolds: one for two convex shapes, or several for meshes and compounds.
    pub manifolds: Vec<ContactManifold>,
    /// State bits.
    pub flags: ContactPairFlags,
}

impl ContactPair {
    /// A pair without bodies, manifolds and bits.
    pub fn new(collider1: Entity, collider2: Entity, contact_id: ContactId) -> Self {
        Self {
            contact_id,
            collider1,
            collider2,
            body1: None,
            body2: None,
            manifolds: Vec::new(),
            flags: ContactPairFlags::empty(),
        }
    }

    /// The sum of all normal impulses as a vector, N·s. It pushes the second body.
    pub fn total_normal_impulse(&self) -> Vector {
        self.manifolds
            .iter()
            .fold(Vector::ZERO, |sum, manifold| sum + manifold.normal * manifold.total_normal_impulse())
    }

    /// The sum of the normal impulses of all points, N·s. Unlike the length of
    /// [`total_normal_impulse`](Self::total_normal_impulse), opposite impulses add up.
    pub fn total_normal_impulse_magnitude(&self) -> Scalar {
        self.manifolds.iter().fold(0.0, |sum, manifold| sum + manifold.total_normal_impulse())
    }

    /// The largest normal impulse of a point as a vector, N·s.
    pub fn max_normal_impulse(&self) -> Vector {
        let largest = |a: &&ContactManifold, b: &&ContactManifold| {
            a.max_normal_impulse().total_cmp(&b.max_normal_impulse())
        };
        let manifold = self.manifolds.iter().max_by(largest);
        manifold.map_or(Vector::ZERO, |manifold| manifold.normal * manifold.max_normal_impulse())
    }

    /// The largest normal impulse of a point, N·s.
    pub fn max_normal_impulse_magnitude(&self) -> Scalar {
        self.manifolds.iter().fold(0.0, |max, manifold| max.max(manifold.max_normal_impulse()))
    }

    /// Whether the colliders touch.
    pub fn is_touching(&self) -> bool {
        self.flags.contains(ContactPairFlags::TOUCHING)
    }

    /// Whether the boxes of the colliders are apart.
    pub fn aabbs_disjoint(&self) -> bool {
        self.flags.contains(ContactPairFlags::DISJOINT_AABB)
    }

    /// Whether the colliders started touching in the last step, as known after the solver.
    pub fn collision_started(&self) -> bool {
        self.flags.contains(ContactPairFlags::STARTED_TOUCHING)
    }

    /// Whether the colliders stopped touching in the last narrow phase. If their boxes separated as well, the
    /// pair is removed at once.
    pub fn collision_ended(&self) -> bool {
        self.flags.contains(ContactPairFlags::STOPPED_TOUCHING)
    }

    /// Whether the solver pushes the bodies apart if the colliders touch.
    pub fn generates_constraints(&self) -> bool {
        self.flags.contains(ContactPairFlags::GENERATE_CONSTRAINTS)
    }

    /// The point with the deepest overlap.
    pub fn find_deepest_contact(&self) -> Option<&ContactPoint> {
        let deepest = self.manifolds.iter().filter_map(ContactManifold::find_deepest_contact);
        deepest.max_by(|a, b| a.penetration.total_cmp(&b.penetration))
    }
}
