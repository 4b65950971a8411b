//! Collision detection: [colliders](collider), the [broad phase](broad_phase) that finds pairs of
//! overlapping boxes, and the [narrow phase](narrow_phase) that computes contacts.
//! [`Collisions`](contact_types::Collisions) gives access to contacts, and
//! [collision events](collision_events) report changes.

pub(crate) mod app_pairs;
pub mod broad_phase;
pub mod collider;
pub mod collision_events;
pub mod collision_hits;
pub mod contact_types;
pub(crate) mod contacts;
pub(crate) mod custom_contacts;
pub(crate) mod diagnostics;
pub mod hooks;
pub(crate) mod local_points;
pub mod narrow_phase;
pub(crate) mod pairs;
pub(crate) mod removal;
pub(crate) mod touch;

pub use diagnostics::CollisionDiagnostics;

/// The names of this module that most apps use.
pub mod prelude {
    #[cfg(all(feature = "collider-from-mesh", feature = "default-collider"))]
    pub use super::collider::ColliderCachePlugin;
    #[cfg(feature = "default-collider")]
    pub use super::collider::{
        Collider, ColliderConstructor, ColliderConstructorHierarchy, ColliderConstructorHierarchyReady,
        ColliderConstructorPlugin, ColliderConstructorReady, ColliderError, FillMode, TrimeshFlags,
        VhacdParameters,
    };
    pub use super::{
        broad_phase::{BroadPhaseCorePlugin, BroadPhaseSystems, BvhBroadPhasePlugin},
        collider::{
            AabbContext, AnyCollider, ColliderAabb, ColliderBackendPlugin, ColliderDisabled, ColliderMarker,
            CollidingEntities, CollisionLayers, CollisionMargin, ContactManifoldContext, IntoCollider,
            LayerMask, PhysicsLayer, ScalableCollider, Sensor, SimpleCollider,
            collider_hierarchy::{ColliderHierarchyPlugin, ColliderOf, RigidBodyColliders},
            collider_transform::{ColliderTransform, ColliderTransformPlugin},
        },
        collision_events::{CollisionEnd, CollisionEventsEnabled, CollisionStart},
        collision_hits::{CollisionHit, CollisionHitsEnabled},
        contact_types::{
            Collisions, ContactEdge, ContactGraph, ContactManifold, ContactPair, ContactPairFlags,
            ContactPoint,
        },
        hooks::{ActiveCollisionHooks, CollisionHooks},
        narrow_phase::{NarrowPhaseConfig, NarrowPhasePlugin, NarrowPhaseSystems},
    };
    #[expect(deprecated, reason = "former names stay importable")]
    pub use super::{
        collision_events::{OnCollisionEnd, OnCollisionStart},
        narrow_phase::NarrowPhaseSet,
    };
}
