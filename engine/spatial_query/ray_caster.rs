//! Rays that are cast from an entity in every run of a schedule.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::{
    entity::{EntityMapper, MapEntities},
    prelude::*,
};
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::SpatialQueryFilter;
#[cfg(feature = "default-collider")]
use super::frame::CasterFrame;
use crate::math::{AdjustPrecision, Dir, Ray, Scalar, Vector, VectorF32};

/// Casts a ray from its entity once per run of the schedule. The hits are in [`RayHits`].
///
/// Origin and direction are in the frame of the entity, so that the ray moves and turns with it.
///
/// ```
/// # use avian::{math::*, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn setup(mut commands: Commands) {
///     commands.spawn((RigidBody::Kinematic, RayCaster::new(Vector::ZERO, Dir::X).with_max_distance(50.0)));
/// }
///
/// fn print_hits(casters: Query<(&RayCaster, &RayHits)>) {
///     for (ray, hits) in &casters {
///         for hit in hits {
///             println!("{} at {}", hit.entity, ray.get_global_point(hit.distance));
///         }
///     }
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[require(RayHits)]
pub struct RayCaster {
    /// Whether the ray is cast. A disabled caster has no hits. True by default.
    pub enabled: bool,
    /// The start of the ray, in the entity's frame, in metres.
    pub origin: Vector,
    /// The direction of the ray, in the entity's frame. Along x by default.
    pub direction: Dir,
    /// Maximum number of hits: the nearest ones are kept. No limit by default.
    pub max_hits: u32,
    /// The length of the ray in metres. No limit by default.
    pub max_distance: Scalar,
    /// Whether a ray that starts inside a collider hits it at distance 0. Otherwise the ray hits the boundary
    /// from within. True by default.
    pub solid: bool,
    /// Whether the ray passes through the colliders of its entity, and of the body that the entity belongs
    /// to. True by default.
    pub ignore_self: bool,
    /// The filter of the colliders that the ray can hit. All by default.
    pub query_filter: SpatialQueryFilter,
    global_origin: Vector,
    global_direction: Dir,
}

impl Default for RayCaster {
    fn default() -> Self {
        Self {
            enabled: true,
            origin: Vector::ZERO,
            direction: Dir::X,
            max_hits: u32::MAX,
            max_distance: Scalar::MAX,
            solid: true,
            ignore_self: true,
            query_filter: SpatialQueryFilter::DEFAULT,
            global_origin: Vector::ZERO,
            global_direction: Dir::X,
        }
    }
}

impl From<Ray> for RayCaster {
    fn from(ray: Ray) -> Self {
        Self::from_ray(ray)
    }
}

impl RayCaster {
    /// A ray with an origin in metres and a direction, both in the entity's frame.
    pub fn new(origin: Vector, direction: Dir) -> Self {
        Self { origin, direction, global_origin: origin, global_direction: direction, ..Self::default() }
    }

    /// A ray in the entity's frame.
    pub fn from_ray(ray: Ray) -> Self {
        Self::new(ray.origin.adjust_precision(), ray.direction)
    }

    /// The same ray from another origin, in metres.
    pub fn with_origin(mut self, origin: Vector) -> Self {
        self.origin = origin;
        self
    }

    /// The same ray in another direction.
    pub fn with_direction(mut self, direction: Dir) -> Self {
        self.direction = direction;
        self
    }

    /// The same ray with another value of [`solid`](Self::solid).
    pub fn with_solidness(mut self, solid: bool) -> Self {
        self.solid = solid;
        self
    }

    /// The same ray with another value of [`ignore_self`](Self::ignore_self).
    pub fn with_ignore_self(mut self, ignore: bool) -> Self {
        self.ignore_self = ignore;
        self
    }

    /// The same ray with another length, in metres.
    pub fn with_max_distance(mut self, max_distance: Scalar) -> Self {
        self.max_distance = max_distance;
        self
    }

    /// The same ray with at most this number of hits.
    pub fn with_max_hits(mut self, max_hits: u32) -> Self {
        self.max_hits = max_hits;
        self
    }

    /// The same ray with another filter.
    pub fn with_query_filter(mut self, query_filter: SpatialQueryFilter) -> Self {
        self.query_filter = query_filter;
        self
    }

    /// Enables the ray from now on.
    pub fn enable(&mut self) {
        self.enabled = true;
    }

    /// Disables the ray. Its hits are cleared.
    pub fn disable(&mut self) {
        self.enabled = false;
    }

    /// The origin in the world when the ray was last cast, in metres.
    pub fn global_origin(&self) -> Vector {
        self.global_origin
    }

    /// The direction in the world when the ray was last cast.
    pub fn global_direction(&self) -> Dir {
        self.global_direction
    }

    /// The point at a distance along the ray, in the entity's frame, in metres.
    pub fn get_point(&self, distance: Scalar) -> Vector {
        self.origin + VectorF32::from(self.direction).adjust_precision() * distance
    }

    /// The point at a distance along the ray, in the world, in metres.
    pub fn get_global_point(&self, distance: Scalar) -> Vector {
        self.global_origin + VectorF32::from(self.global_direction).adjust_precision() * distance
    }

    /// Places the ray in the world.
    #[cfg(feature = "default-collider")]
    pub(super) fn place(&mut self, frame: &CasterFrame) {
        self.global_origin = frame.point(self.origin);
        self.global_direction = frame.direction(self.direction);
    }
}

/// The hits of a [`RayCaster`], nearest first. Hits at the same distance are in the order in which colliders
/// entered the simulation.
#[derive(Component, Clone, Debug, Default, Deref, DerefMut, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[component(map_entities)]
pub struct RayHits(pub Vec<RayHitData>);

impl RayHits {
    /// The hits, nearest first. They are already in this order, unless the app changed them.
    pub fn iter_sorted(&self) -> std::vec::IntoIter<RayHitData> {
        let mut hits = self.0.clone();
        hits.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        hits.into_iter()
    }
}

impl IntoIterator for RayHits {
    type Item = RayHitData;
    type IntoIter = std::vec::IntoIter<RayHitData>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a RayHits {
    type Item = &'a RayHitData;
    type IntoIter = core::slice::Iter<'a, RayHitData>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<'a> IntoIterator for &'a mut RayHits {
    type Item = &'a mut RayHitData;
    type IntoIter = core::slice::IterMut<'a, RayHitData>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter_mut()
    }
}

impl MapEntities for RayHits {
    fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
        self.0.iter_mut().for_each(|hit| hit.map_entities(mapper));
    }
}

/// The hit of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, PartialEq)]
pub struct RayHitData {
    /// The collider.
    pub entity: Entity,
    /// The distance along the ray, in metres.
    pub distance: Scalar,
    /// The outward unit normal of the collider, in the world. Zero if the ray starts inside a solid collider.
    pub normal: Vector,
}

impl RayHitData {
    /// The point where the ray hits, in the world, in metres. Takes the origin and direction that the ray
    /// was cast with.
    ///
    /// [`RayCaster::get_global_point`] does the same for the hits of a caster.
    ///
    /// ```
    /// # use avian::{math::Dir, prelude::*};
    /// # use bevy_ecs::prelude::*;
    /// fn shoot(queries: SpatialQuery, gun: Single<&Position, With<Gun>>) {
    ///     let (origin, direction) = (gun.0, Dir::X);
    ///     if let Some(hit) = queries.cast_ray(origin, direction, 100.0, true, &SpatialQueryFilter::default()) {
    ///         println!("{} is hit at {}", hit.entity, hit.point(origin, direction));
    ///     }
    /// }
    /// # #[derive(Component)]
    /// # struct Gun;
    /// ```
    pub fn point(&self, origin: Vector, direction: Dir) -> Vector {
        origin + VectorF32::from(direction).adjust_precision() * self.distance
    }
}

impl MapEntities for RayHitData {
    fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
        self.entity = mapper.get_mapped(self.entity);
    }
}
