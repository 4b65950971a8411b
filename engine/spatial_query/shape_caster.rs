//! Shapes that are cast from an entity in every run of a schedule, and settings of shape casts.

use bevy_derive::{Deref, DerefMut};
use bevy_ecs::{
    entity::{EntityMapper, MapEntities},
    prelude::*,
};
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::{SpatialQueryFilter, frame::CasterFrame};
use crate::{
    collision::collider::Collider,
    math::{AdjustPrecision, Dir, RotationValue, Scalar, Vector, VectorF32},
    physics_transform::Rotation,
};

/// Casts a shape from its entity once per run of the schedule: the shape moves along a line, without
/// rotation. The hits are in [`ShapeHits`].
///
/// Origin, rotation and direction are in the frame of the entity, so that the cast moves and turns with it.
///
/// ```
/// # use avian::{math::*, prelude::*};
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// fn setup(mut commands: Commands) {
///     // What a capsule of this size would land on, falling.
///     let shape = Collider::capsule(0.4, 1.0);
///     let caster = ShapeCaster::new(shape, Vector::ZERO, Default::default(), Dir::NEG_Y).with_max_hits(1);
///     commands.spawn((RigidBody::Kinematic, caster));
/// }
///
/// fn print_hits(hits: Query<&ShapeHits>) {
///     for hit in hits.iter().flatten() {
///         println!("{} m above {}", hit.distance, hit.entity);
///     }
/// }
/// ```
#[derive(Component, Clone, Debug, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default)]
#[require(ShapeHits)]
pub struct ShapeCaster {
    /// Whether the shape is cast. A disabled caster has no hits. True by default.
    pub enabled: bool,
    /// The shape.
    #[reflect(ignore)]
    pub shape: Collider,
    /// The start of the shape, in the entity's frame, in metres.
    pub origin: Vector,
    /// The rotation of the shape in the entity's frame: an angle in radians in 2D, a quaternion in 3D.
    pub shape_rotation: RotationValue,
    /// The direction of the cast, in the entity's frame. Along x by default.
    pub direction: Dir,
    /// Maximum number of hits: the nearest ones are kept. 1 by default.
    pub max_hits: u32,
    /// The length of the cast in metres. No limit by default.
    pub max_distance: Scalar,
    /// The distance between shape and collider at which they count as hit, in metres. 0 by default.
    pub target_distance: Scalar,
    /// See [`ShapeCastConfig::compute_contact_on_penetration`]. True by default.
    pub compute_contact_on_penetration: bool,
    /// See [`ShapeCastConfig::ignore_origin_penetration`]. False by default.
    pub ignore_origin_penetration: bool,
    /// Whether the shape passes through the colliders of its entity, and of the body that the entity belongs
    /// to. True by default.
    pub ignore_self: bool,
    /// The filter of the colliders that the shape can hit. All by default.
    pub query_filter: SpatialQueryFilter,
    global_origin: Vector,
    global_shape_rotation: RotationValue,
    global_direction: Dir,
}

impl Default for ShapeCaster {
    fn default() -> Self {
        Self::new(Collider::default(), Vector::ZERO, RotationValue::from(Rotation::IDENTITY), Dir::X)
    }
}

impl ShapeCaster {
    /// A shape with an origin in metres, a rotation (radians in 2D, a quaternion in 3D) and a direction, all
    /// in the entity's frame.
    pub fn new(
        shape: impl Into<Collider>,
        origin: Vector,
        shape_rotation: RotationValue,
        direction: Dir,
    ) -> Self {
        Self {
            enabled: true,
            shape: shape.into(),
            origin,
            shape_rotation,
            direction,
            max_hits: 1,
            max_distance: Scalar::MAX,
            target_distance: 0.0,
            compute_contact_on_penetration: true,
            ignore_origin_penetration: false,
            ignore_self: true,
            query_filter: SpatialQueryFilter::DEFAULT,
            global_origin: origin,
            global_shape_rotation: shape_rotation,
            global_direction: direction,
        }
    }

    /// The same cast from another origin, in metres.
    pub fn with_origin(mut self, origin: Vector) -> Self {
        self.origin = origin;
        self
    }

    /// The same cast in another direction.
    pub fn with_direction(mut self, direction: Dir) -> Self {
        self.direction = direction;
        self
    }

    /// The same cast with another value of [`target_distance`](Self::target_distance), in metres.
    pub fn with_target_distance(mut self, target_distance: Scalar) -> Self {
        self.target_distance = target_distance;
        self
    }

    /// The same cast with another value of
    /// [`compute_contact_on_penetration`](Self::compute_contact_on_penetration).
    pub fn with_compute_contact_on_penetration(mut self, compute_contact: bool) -> Self {
        self.compute_contact_on_penetration = compute_contact;
        self
    }

    /// The same cast with another value of [`ignore_origin_penetration`](Self::ignore_origin_penetration).
    pub fn with_ignore_origin_penetration(mut self, ignore: bool) -> Self {
        self.ignore_origin_penetration = ignore;
        self
    }

    /// The same cast with another value of [`ignore_self`](Self::ignore_self).
    pub fn with_ignore_self(mut self, ignore: bool) -> Self {
        self.ignore_self = ignore;
        self
    }

    /// The same cast with another length, in metres.
    pub fn with_max_distance(mut self, max_distance: Scalar) -> Self {
        self.max_distance = max_distance;
        self
    }

    /// The same cast with at most this number of hits.
    pub fn with_max_hits(mut self, max_hits: u32) -> Self {
        self.max_hits = max_hits;
        self
    }

    /// The same cast with another filter.
    pub fn with_query_filter(mut self, query_filter: SpatialQueryFilter) -> Self {
        self.query_filter = query_filter;
        self
    }

    /// Enables the cast from now on.
    pub fn enable(&mut self) {
        self.enabled = true;
    }

    /// Disables the cast. Its hits are cleared.
    pub fn disable(&mut self) {
        self.enabled = false;
    }

    /// The origin in the world when the shape was last cast, in metres.
    pub fn global_origin(&self) -> Vector {
        self.global_origin
    }

    /// The rotation in the world when the shape was last cast: an angle in radians in 2D, a quaternion in 3D.
    pub fn global_shape_rotation(&self) -> RotationValue {
        self.global_shape_rotation
    }

    /// The direction in the world when the shape was last cast.
    pub fn global_direction(&self) -> Dir {
        self.global_direction
    }

    /// Places the cast in the world.
    pub(super) fn place(&mut self, frame: &CasterFrame) {
        self.global_origin = frame.point(self.origin);
        self.global_direction = frame.direction(self.direction);
        self.global_shape_rotation =
            RotationValue::from(frame.rotation * Rotation::from(self.shape_rotation));
    }

    /// The settings of the cast.
    pub(super) fn config(&self) -> ShapeCastConfig {
        ShapeCastConfig {
            max_distance: self.max_distance,
            target_distance: self.target_distance,
            compute_contact_on_penetration: self.compute_contact_on_penetration,
            ignore_origin_penetration: self.ignore_origin_penetration,
        }
    }
}

/// Settings of a shape cast.
#[derive(Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub struct ShapeCastConfig {
    /// The length of the cast in metres. No limit by default.
    pub max_distance: Scalar,
    /// The distance between shape and collider at which they count as hit, in metres. 0 by default.
    pub target_distance: Scalar,
    /// Whether to compute points and normals, of least depth, if the shape overlaps a collider at the start.
    /// True by default. Otherwise they are unspecified, which is faster.
    pub compute_contact_on_penetration: bool,
    /// Whether to ignore colliders that the shape overlaps at the start, unless it moves deeper into them.
    /// False by default: such colliders are hit at distance 0.
    pub ignore_origin_penetration: bool,
}

impl Default for ShapeCastConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl ShapeCastConfig {
    /// The defaults.
    pub const DEFAULT: Self = Self {
        max_distance: Scalar::MAX,
        target_distance: 0.0,
        compute_contact_on_penetration: true,
        ignore_origin_penetration: false,
    };

    /// The defaults with another length of the cast, in metres.
    pub const fn from_max_distance(max_distance: Scalar) -> Self {
        Self { max_distance, ..Self::DEFAULT }
    }

    /// The defaults with another target distance, in metres.
    pub const fn from_target_distance(target_distance: Scalar) -> Self {
        Self { target_distance, ..Self::DEFAULT }
    }

    /// The same settings with another length of the cast, in metres.
    pub const fn with_max_distance(mut self, max_distance: Scalar) -> Self {
        self.max_distance = max_distance;
        self
    }

    /// The same settings with another target distance, in metres.
    pub const fn with_target_distance(mut self, target_distance: Scalar) -> Self {
        self.target_distance = target_distance;
        self
    }
}

/// The hits of a [`ShapeCaster`], nearest first. Hits at the same distance are in the order in which
/// colliders entered the simulation.
#[derive(Component, Clone, Debug, Default, Deref, DerefMut, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[component(map_entities)]
pub struct ShapeHits(pub Vec<ShapeHitData>);

impl ShapeHits {
    /// The hits, nearest first. They are already in this order, unless the app changed them.
    pub fn iter_sorted(&self) -> std::vec::IntoIter<ShapeHitData> {
        let mut hits = self.0.clone();
        hits.sort_by(|a, b| a.distance.total_cmp(&b.distance));
        hits.into_iter()
    }
}

impl IntoIterator for ShapeHits {
    type Item = ShapeHitData;
    type IntoIter = std::vec::IntoIter<ShapeHitData>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.into_iter()
    }
}

impl<'a> IntoIterator for &'a ShapeHits {
    type Item = &'a ShapeHitData;
    type IntoIter = core::slice::Iter<'a, ShapeHitData>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl<'a> IntoIterator for &'a mut ShapeHits {
    type Item = &'a mut ShapeHitData;
    type IntoIter = core::slice::IterMut<'a, ShapeHitData>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter_mut()
    }
}

impl MapEntities for ShapeHits {
    fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
        self.0.iter_mut().for_each(|hit| hit.map_entities(mapper));
    }
}

/// The hit of a cast shape.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, PartialEq)]
pub struct ShapeHitData {
    /// The collider.
    pub entity: Entity,
    /// How far the shape moved, in metres.
    pub distance: Scalar,
    /// The point on the collider at the hit, in the world, in metres.
    pub point1: Vector,
    /// The point on the cast shape at the hit, in the world, in metres.
    pub point2: Vector,
    /// The outward unit normal of the collider, in the world.
    pub normal1: Vector,
    /// The outward unit normal of the cast shape, in the world.
    pub normal2: Vector,
}

impl ShapeHitData {
    /// The position of the shape's origin at the hit, in the world, in metres. Takes the origin and direction
    /// that the shape was cast with.
    ///
    /// The surfaces meet at [`point1`](Self::point1) and [`point2`](Self::point2).
    pub fn point(&self, origin: Vector, direction: Dir) -> Vector {
        origin + VectorF32::from(direction).adjust_precision() * self.distance
    }
}

impl MapEntities for ShapeHitData {
    fn map_entities<M: EntityMapper>(&mut self, mapper: &mut M) {
        self.entity = mapper.get_mapped(self.entity);
    }
}
