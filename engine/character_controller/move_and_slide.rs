//! [`MoveAndSlide`]: moves a shape by a velocity, and slides it along colliders.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};
use core::time::Duration;

pub use super::velocity_project::{project_velocity, project_velocity_bruteforce};
use super::{
    mover::{Mover, Recovery, Sweep},
    planes::{Plane, add_facing},
    velocity_project::{along, vector},
};
use crate::{
    collision::{
        collider::{Collider, CollisionLayers, Sensor, collider_hierarchy::ColliderOf},
        contact_types::ContactPoint,
    },
    dynamics::solver::PhysicsLengthUnit,
    math::{AdjustPrecision, AsF32, Dir, RotationValue, Scalar, Vector},
    physics_transform::{Position, Rotation},
    spatial_query::{NearPart, SpatialQuery, SpatialQueryFilter},
};

/// The cosine of 5 degrees.
pub const COS_5_DEGREES: Scalar = 0.996_194_7;

/// The minimum share of its speed at which a shape that touches a collider counts as parting from it.
const PARTING: Scalar = 1.0e-3;

/// A system parameter that moves a shape driven by the game, and slides it along colliders.
///
/// It is for kinematic characters that set their own [`Position`] or `Transform`, not for bodies that move by
/// a velocity. It does not handle floors, slopes and stairs; for these see
/// [`character_controller`](crate::character_controller).
///
/// The shape keeps [`skin_width`](MoveAndSlideConfig::skin_width) from all colliders. Only colliders of
/// bodies stop it; it passes through sensors and disabled colliders. Queries see the components as they are
/// now.
///
/// ```
/// # use avian::{math::*, prelude::*};
/// # use bevy_ecs::prelude::*;
/// # use bevy_time::prelude::*;
/// #[derive(Component)]
/// struct Velocity(Vector);
///
/// fn walk(
///     mut players: Query<(Entity, &Collider, &Position, &Rotation, &mut Velocity)>,
///     mover: MoveAndSlide,
///     time: Res<Time>,
///     mut commands: Commands,
/// ) {
///     for (player, shape, from, turn, mut velocity) in &mut players {
///         let filter = SpatialQueryFilter::from_excluded_entities([player]);
///         let config = MoveAndSlideConfig::default();
///         let (turn, dt) = ((*turn).into(), time.delta());
///         let moved = mover.move_and_slide(shape, from.0, turn, velocity.0, dt, &config, &filter, |hit| {
///             println!("{} is in the way", hit.entity);
///             MoveAndSlideHitResponse::Accept
///         });
///         velocity.0 = moved.projected_velocity;
///         // The mover reads positions, so that they are written later.
///         commands.entity(player).insert(Position(moved.position));
///     }
/// }
/// ```
#[derive(SystemParam)]
pub struct MoveAndSlide<'w, 's> {
    /// Queries of all colliders.
    pub spatial_query: SpatialQuery<'w, 's>,
    /// The colliders that stop a shape.
    pub colliders: Query<
        'w,
        's,
        (&'static Collider, &'static Position, &'static Rotation, Option<&'static CollisionLayers>),
        (With<ColliderOf>, Without<Sensor>),
    >,
    /// The length of a metre.
    pub length_unit: Res<'w, PhysicsLengthUnit>,
}

/// Settings of [`MoveAndSlide::move_and_slide`].
#[derive(Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub struct MoveAndSlideConfig {
    /// Maximum number of sweeps per move. After the last one the rest of the move is lost. 4 by default.
    pub move_and_slide_iterations: usize,
    /// Maximum number of depenetration rounds before and after a move. 16 by default.
    pub depenetration_iterations: usize,
    /// The overlap with the skin that depenetration may leave, in metres, scaled by [`PhysicsLengthUnit`].
    /// 0.0001 by default.
    pub max_depenetration_error: Scalar,
    /// The deepest overlap that depenetration resolves, in metres, scaled by [`PhysicsLengthUnit`]. A shape
    /// with a deeper overlap stays in place. 0.5 by default.
    pub penetration_rejection_threshold: Scalar,
    /// The distance that the shape keeps from colliders, in metres, scaled by [`PhysicsLengthUnit`]. 0.01 by
    /// default.
    pub skin_width: Scalar,
    /// Outward normals of planes that the velocity never points into. None by default.
    pub planes: Vec<Dir>,
    /// Planes whose normals have a larger dot product count as one plane: the one that the velocity points
    /// into more. [`COS_5_DEGREES`] by default.
    pub plane_similarity_dot_threshold: Scalar,
    /// Maximum number of planes that a velocity is projected on at once, including [`planes`](Self::planes).
    /// 20 by default.
    pub max_planes: usize,
}

impl Default for MoveAndSlideConfig {
    fn default() -> Self {
        Self {
            move_and_slide_iterations: 4,
            depenetration_iterations: 16,
            max_depenetration_error: 1.0e-4,
            penetration_rejection_threshold: 0.5,
            skin_width: 0.01,
            planes: Vec::new(),
            plane_similarity_dot_threshold: COS_5_DEGREES,
            max_planes: 20,
        }
    }
}

/// Settings of [`MoveAndSlide::depenetrate`]: a subset of [`MoveAndSlideConfig`].
#[derive(Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub struct DepenetrationConfig {
    /// See [`MoveAndSlideConfig::depenetration_iterations`].
    pub depenetration_iterations: usize,
    /// See [`MoveAndSlideConfig::max_depenetration_error`].
    pub max_depenetration_error: Scalar,
    /// See [`MoveAndSlideConfig::penetration_rejection_threshold`].
    pub penetration_rejection_threshold: Scalar,
    /// See [`MoveAndSlideConfig::skin_width`].
    pub skin_width: Scalar,
}

impl Default for DepenetrationConfig {
    fn default() -> Self {
        Self::from(&MoveAndSlideConfig::default())
    }
}

impl From<&MoveAndSlideConfig> for DepenetrationConfig {
    fn from(config: &MoveAndSlideConfig) -> Self {
        Self {
            depenetration_iterations: config.depenetration_iterations,
            max_depenetration_error: config.max_depenetration_error,
            penetration_rejection_threshold: config.penetration_rejection_threshold,
            skin_width: config.skin_width,
        }
    }
}

/// The result of moving a shape.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, PartialEq)]
pub struct MoveAndSlideOutput {
    /// The new position of the shape in metres.
    pub position: Vector,
    /// The velocity of the shape in m/s, without the components that pointed into planes. A character that
    /// keeps its speed along the floor should not reuse it as its velocity, but take its wanted velocity
    /// again.
    pub projected_velocity: Vector,
}

/// A plane that a shape hit in [`MoveAndSlide::move_and_slide`], and the state of the move, which may be
/// changed.
#[derive(Debug, PartialEq)]
pub struct MoveAndSlideHitData<'a> {
    /// The collider of this plane.
    pub entity: Entity,
    /// How far the shape moved in this sweep until it was [`skin_width`](MoveAndSlideConfig::skin_width)
    /// away, in metres. 0 if it touched at the start of the move.
    pub distance: Scalar,
    /// The nearest point of the collider, in the world, in metres.
    pub point: Vector,
    /// The outward normal of the collider. The velocity is projected on the plane with this normal.
    pub normal: &'a mut Dir,
    /// The position of the shape, in metres.
    pub position: &'a mut Vector,
    /// The velocity of the shape in m/s, before it is projected.
    pub velocity: &'a mut Vector,
    /// How far the shape would move until it touches the collider itself, in metres; where it slides,
    /// measured along the normal.
    pub collision_distance: Scalar,
}

impl MoveAndSlideHitData<'_> {
    /// Whether the shape overlaps the collider.
    pub fn intersects(&self) -> bool {
        self.collision_distance == 0.0
    }
}

/// The effect of a hit on a move.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum MoveAndSlideHitResponse {
    /// The shape slides along the plane.
    #[default]
    Accept,
    /// The shape passes through the collider in the rest of this move.
    Ignore,
    /// The move ends here.
    Abort,
}

/// The first collider that a moving shape hits.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, PartialEq)]
pub struct MoveHitData {
    /// The collider.
    pub entity: Entity,
    /// How far the shape can move until its distance to the collider is the skin width, in metres.
    pub distance: Scalar,
    /// The nearest point of the collider at the hit, in the world, in metres.
    pub point1: Vector,
    /// The nearest point of the shape at the hit, in the world, in metres.
    pub point2: Vector,
    /// The outward unit normal of the collider.
    pub normal1: Vector,
    /// The outward unit normal of the shape.
    pub normal2: Vector,
    /// How far the shape can move until it touches the plane of the collider at the hit, in metres.
    pub collision_distance: Scalar,
}

impl MoveHitData {
    /// Whether the shape overlaps the collider from the start.
    pub fn intersects(self) -> bool {
        self.collision_distance == 0.0
    }
}

impl MoveAndSlide<'_, '_> {
    /// Moves a shape by a velocity in m/s, for a time, and slides it along colliders. `on_hit` is called for
    /// each plane that the shape touches and does not leave, at the start of the move and after each sweep.
    /// It may be called several times for the same plane.
    ///
    /// Before and after the move the shape is moved out of overlaps. If the position or velocity is infinite
    /// or NaN, the shape does not move, and the resulting velocity is zero.
    #[expect(clippy::too_many_arguments, reason = "as in Avian")]
    pub fn move_and_slide(
        &self,
        shape: &Collider,
        shape_position: Vector,
        shape_rotation: RotationValue,
        mut velocity: Vector,
        delta_time: Duration,
        config: &MoveAndSlideConfig,
        filter: &SpatialQueryFilter,
        mut on_hit: impl FnMut(MoveAndSlideHitData) -> MoveAndSlideHitResponse,
    ) -> MoveAndSlideOutput {
        if !(velocity.is_finite() && shape_position.is_finite()) {
            return MoveAndSlideOutput { position: shape_position, projected_velocity: Vector::ZERO };
        }
        let is_solid = |entity| self.colliders.contains(entity);
        let mut mover = self.mover(&is_solid, shape, shape_rotation, config.skin_width, filter);
        let recovery = self.recovery(&config.into());
        let mut position = shape_position + mover.recovery(shape_position, &recovery, &|_| 1.0);
        let mut left: Scalar = delta_time.as_secs_f64().adjust_precision();
        let mut planes: Vec<Plane> =
            config.planes.iter().map(|normal| Plane::facing(vector(*normal))).collect();
        let mut wanted = velocity;
        let mut stopped_by: Option<Sweep> = None;
        for round in 0..=config.move_and_slide_iterations {
            let mut slide = Slide {
                config,
                mover: &mut mover,
                planes: &mut planes,
                wanted: &mut wanted,
                position: &mut position,
                velocity: &mut velocity,
            };
            if slide.meet(stopped_by, &mut on_hit) == MoveAndSlideHitResponse::Abort {
                break;
            }
            let movement = velocity * left;
            if round == config.move_and_slide_iterations || !(movement.length() > 0.0) {
                break;
            }
            stopped_by = mover.sweep(position, movement);
            let Some(hit) = stopped_by else {
                position += movement;
                break;
            };
            let share = (hit.distance / movement.length()).min(1.0);
            position += movement * share;
            left *= 1.0 - share;
        }
        position += mover.recovery(position, &recovery, &|_| 1.0);
        MoveAndSlideOutput { position, projected_velocity: velocity }
    }

    /// The first hit of a moving shape, over a movement in metres. `skin_width` is scaled by
    /// [`PhysicsLengthUnit`].
    ///
    /// A collider that is nearer than the skin at the start is hit at distance 0, unless the movement is
    /// along it or away from it. `None` also if a number is infinite or NaN.
    pub fn cast_move(
        &self,
        shape: &Collider,
        shape_position: Vector,
        shape_rotation: RotationValue,
        movement: Vector,
        skin_width: Scalar,
        filter: &SpatialQueryFilter,
    ) -> Option<MoveHitData> {
        let is_solid = |entity| self.colliders.contains(entity);
        let mover = self.mover(&is_solid, shape, shape_rotation, skin_width, filter);
        let Sweep { part, distance, collision_distance } = mover.sweep(shape_position, movement)?;
        let NearPart { entity, points: [point1, point2], normal, .. } = part;
        let (normal1, normal2) = (normal, -normal);
        Some(MoveHitData { entity, distance, point1, point2, normal1, normal2, collision_distance })
    }

    /// Whether a shape has room at a position: no collider is nearer than `skin_width`, which is in metres,
    /// scaled by [`PhysicsLengthUnit`]. Use it before a character stands up or appears somewhere. Exclude its
    /// own colliders in the filter. `false` if a number is infinite or NaN. Beyond Avian.
    pub fn fits(
        &self,
        shape: &Collider,
        shape_position: Vector,
        shape_rotation: RotationValue,
        skin_width: Scalar,
        filter: &SpatialQueryFilter,
    ) -> bool {
        let is_solid = |entity| self.colliders.contains(entity);
        self.mover(&is_solid, shape, shape_rotation, skin_width, filter).fits(shape_position)
    }

    /// The displacement in metres that moves a shape and its skin out of overlaps. It is the shortest one if
    /// the colliders are flat. Between colliders without enough room it leads to the middle.
    pub fn depenetrate(
        &self,
        shape: &Collider,
        shape_position: Vector,
        shape_rotation: RotationValue,
        config: &DepenetrationConfig,
        filter: &SpatialQueryFilter,
    ) -> Vector {
        let is_solid = |entity| self.colliders.contains(entity);
        let mover = self.mover(&is_solid, shape, shape_rotation, config.skin_width, filter);
        mover.recovery(shape_position, &self.recovery(config), &|_| 1.0)
    }

    /// The displacement in metres that moves a shape by at least the given distances along the given normals,
    /// up to an error of [`max_depenetration_error`](DepenetrationConfig::max_depenetration_error).
    ///
    /// Planes are resolved one after the other, in several rounds, so that the displacement is near the
    /// shortest one.
    pub fn depenetrate_intersections(
        &self,
        config: &DepenetrationConfig,
        intersections: &[(Dir, Scalar)],
    ) -> Vector {
        let error = config.max_depenetration_error * self.length_unit.0;
        let mut way = Vector::ZERO;
        for _ in 0..config.depenetration_iterations {
            let mut is_done = true;
            for (normal, distance) in intersections {
                let normal = vector(*normal);
                let left = distance - way.dot(normal);
                if left > error {
                    way += normal * left;
                    is_done = false;
                }
            }
            if is_done {
                break;
            }
        }
        way
    }

    /// Calls `callback` with each convex part of a collider within `prediction_distance` metres of a shape,
    /// until it returns `false`. The arguments are the collider, the point midway between collider and shape
    /// with its penetration, and the normal from the collider to the shape. Parts of a collider with about
    /// the same normal count as one.
    ///
    /// Anchors are relative to the positions of the shape and of the collider.
    pub fn intersections(
        &self,
        shape: &Collider,
        shape_position: Vector,
        shape_rotation: RotationValue,
        prediction_distance: Scalar,
        filter: &SpatialQueryFilter,
        mut callback: impl FnMut(Entity, &ContactPoint, Dir) -> bool,
    ) {
        let is_solid = |entity| self.colliders.contains(entity);
        let mover = self.mover(&is_solid, shape, shape_rotation, 0.0, filter);
        for part in mover.near(shape_position, prediction_distance) {
            let Ok(normal) = Dir::new(part.normal.f32()) else { continue };
            let point = part.points[0].midpoint(part.points[1]);
            let origin = self.colliders.get(part.entity).map_or(point, |(_, position, ..)| position.0);
            let contact = ContactPoint::new(point - shape_position, point - origin, point, -part.distance);
            if !callback(part.entity, &contact, normal) {
                return;
            }
        }
    }

    /// As [`project_velocity`].
    #[must_use]
    pub fn project_velocity(v: Vector, normals: &[Dir]) -> Vector {
        project_velocity(v, normals)
    }

    fn mover<'a>(
        &'a self,
        is_solid: &'a dyn Fn(Entity) -> bool,
        shape: &'a Collider,
        rotation: RotationValue,
        skin_width: Scalar,
        filter: &'a SpatialQueryFilter,
    ) -> Mover<'a> {
        let unit = self.length_unit.0;
        let skin = (skin_width * unit).max(0.0);
        let queries = &self.spatial_query;
        Mover { queries, is_solid, ignored: Vec::new(), shape, rotation, filter, skin, unit }
    }

    fn recovery(&self, config: &DepenetrationConfig) -> Recovery {
        let unit = self.length_unit.0;
        Recovery {
            rounds: config.depenetration_iterations,
            error: config.max_depenetration_error * unit,
            deepest: config.penetration_rejection_threshold * unit,
            up: Vector::ZERO,
        }
    }
}

/// The state of a move between two sweeps.
struct Slide<'a, 'm> {
    config: &'a MoveAndSlideConfig,
    mover: &'a mut Mover<'m>,
    /// All planes hit in this move. The wanted velocity is projected on all of them at once: projected one
    /// after the other, they would throw a shape from wall to wall in a corner.
    planes: &'a mut Vec<Plane>,
    wanted: &'a mut Vector,
    position: &'a mut Vector,
    velocity: &'a mut Vector,
}

impl Slide<'_, '_> {
    /// Reports the touched parts, and turns the velocity along them.
    fn meet(
        &mut self,
        stopped_by: Option<Sweep>,
        on_hit: &mut impl FnMut(MoveAndSlideHitData) -> MoveAndSlideHitResponse,
    ) -> MoveAndSlideHitResponse {
        let mut response = MoveAndSlideHitResponse::Accept;
        let distance = stopped_by.map_or(0.0, |hit| hit.distance);
        let parts = if *self.velocity == Vector::ZERO {
            Vec::new()
        } else {
            self.mover.touching(*self.position, stopped_by.map(|hit| hit.part))
        };
        for part in parts {
            if self.mover.ignored.contains(&part.entity)
                || part.normal.dot(*self.velocity) > PARTING * self.velocity.length()
            {
                continue;
            }
            let Ok(mut normal) = Dir::new(part.normal.f32()) else { continue };
            let gap = part.distance.max(0.0);
            let before = *self.velocity;
            response = on_hit(MoveAndSlideHitData {
                entity: part.entity,
                distance,
                point: part.points[0],
                normal: &mut normal,
                position: &mut *self.position,
                velocity: &mut *self.velocity,
                collision_distance: if gap > 0.0 { distance + gap } else { 0.0 },
            });
            if *self.velocity != before {
                *self.wanted = *self.velocity;
            }
            match response {
                MoveAndSlideHitResponse::Accept => self.add_plane(vector(normal)),
                MoveAndSlideHitResponse::Ignore => self.mover.ignored.push(part.entity),
                MoveAndSlideHitResponse::Abort => break,
            }
        }
        *self.velocity = along(*self.wanted, self.planes);
        response
    }

    fn add_plane(&mut self, normal: Vector) {
        let similarity = self.config.plane_similarity_dot_threshold;
        let is_similar = |plane: &Plane| plane.normal.dot(normal) > similarity;
        if self.planes.len() < self.config.max_planes || self.planes.iter().any(is_similar) {
            add_facing(self.planes, normal, *self.wanted, similarity);
        }
    }
}
