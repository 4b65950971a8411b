//! [`CharacterController`]: the components of a character that walks.

use bevy_ecs::{entity::MapEntities, prelude::*};
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use crate::{
    collision::collider::LayerMask,
    dynamics::rigid_body::RigidBody,
    math::{AngularVector, Dir, Scalar, Vector},
    physics_transform::{Position, Rotation},
    spatial_query::SpatialQueryFilter,
};

/// A character that walks on floors, slopes and stairs, and on platforms that move and turn.
///
/// Add it to an entity with a capsule, a cylinder, a box or another convex
/// [`Collider`](crate::prelude::Collider). The body is kinematic. Each step reads [`CharacterInput`], and
/// sets the velocity of the body to the motion of the character. The result is in [`CharacterState`].
///
/// ```
/// # use avian::{math::*, prelude::*};
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// # #[derive(Component)]
/// # struct Player;
/// fn spawn(mut commands: Commands) {
///     commands.spawn((
///         Player,
///         CharacterController::default(),
///         Collider::capsule(0.4, 1.0),
///         Transform::from_xyz(0.0, 2.0, 0.0),
///         TransformInterpolation,
///     ));
/// }
///
/// fn walk(mut players: Query<(&mut CharacterInput, &CharacterState), With<Player>>) {
///     for (mut input, state) in &mut players {
///         // To the right, in m/s, and a hop at each landing.
///         input.velocity = Vector::X * 4.0;
///         if state.is_grounded() {
///             input.jump = 5.0;
///         }
///     }
/// }
/// ```
#[derive(Component, Clone, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[require(RigidBody::Kinematic, CharacterInput, CharacterState)]
pub struct CharacterController {
    /// The upward direction of the character. It may change at any time, as on a planet. +y by default.
    pub up: Dir,
    /// The steepest slope that the character walks on, in radians. 50 degrees by default.
    pub max_slope: Scalar,
    /// The highest step that the character climbs, in metres, as all lengths here scaled by
    /// [`PhysicsLengthUnit`](crate::prelude::PhysicsLengthUnit). 0.4 by default, 0 for none.
    pub step_height: Scalar,
    /// The depth of free space needed above a step to climb it, in metres. 0.1 by default.
    pub step_depth: Scalar,
    /// How far the floor may drop below the feet without the character leaving it, in metres. 0.4 by default.
    /// Slopes up to [`max_slope`](Self::max_slope) are followed at any speed.
    pub snap_distance: Scalar,
    /// The distance kept from all colliders, in metres. 0.01 by default.
    pub skin_width: Scalar,
    /// The mass in kg with which the character pushes and weighs on dynamic bodies. It also determines how
    /// much the character slides on light bodies that jerk. 70 by default.
    pub mass: Scalar,
    /// The largest force with which the character pushes dynamic bodies, in N. 500 by default, 0 for none.
    pub max_push_force: Scalar,
    /// The colliders that stop the character. Its own colliders need not be excluded.
    pub filter: SpatialQueryFilter,
    /// The layers of friends: other characters that do not stop this one. Overlapping friends yield to each
    /// other, each by half of the overlap. None by default.
    pub friends: LayerMask,
    /// The speed at which the character yields to friends, in m/s. It should be less than half of the walking
    /// speed, or friends push each other along instead of passing. 0.5 by default.
    pub yield_speed: Scalar,
}

impl Default for CharacterController {
    fn default() -> Self {
        Self {
            up: Dir::Y,
            max_slope: 0.872_664_6,
            step_height: 0.4,
            step_depth: 0.1,
            snap_distance: 0.4,
            skin_width: 0.01,
            mass: 70.0,
            max_push_force: 500.0,
            filter: SpatialQueryFilter::DEFAULT,
            friends: LayerMask::NONE,
            yield_speed: 0.5,
        }
    }
}

/// The input of a character.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
pub struct CharacterInput {
    /// The wanted velocity relative to the ground, in m/s. The part along [`up`](CharacterController::up) has
    /// no effect: slopes and stairs are walked at this horizontal speed. In the air the velocity is relative
    /// to the ground that the character left.
    pub velocity: Vector,
    /// The speed of a jump off the ground, in m/s; 0 for none. The next step resets it to 0, even if the
    /// character is not on the ground.
    pub jump: Scalar,
    /// Whether to crouch, if the character has a [`CharacterCrouch`](super::crouch::CharacterCrouch).
    pub crouch: bool,
}

/// The ground below a character.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub enum GroundState {
    /// Ground that the character can walk on.
    OnGround,
    /// A slope that is too steep to stand on.
    OnSteepGround,
    /// The character touches a collider that does not support it: a wall, or a ceiling.
    NotSupported,
    /// The character touches nothing.
    #[default]
    InAir,
}

/// The state of a character after a step, from which the next step continues.
///
/// It is plain data: a character continues with the same bits from a copy of its components.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[component(map_entities)]
pub struct CharacterState {
    /// The kind of ground below the character.
    pub ground: GroundState,
    /// The collider that the character stands on or touches.
    pub ground_entity: Option<Entity>,
    /// The contact point on this collider, in the world, in metres.
    pub ground_point: Vector,
    /// The outward unit normal at the point. At an edge that the character can stand on, it is the normal of
    /// the adjacent face.
    pub ground_normal: Vector,
    /// The velocity of the ground at the point in m/s, including its surface velocity.
    pub ground_velocity: Vector,
    /// The angular velocity of the ground, in rad/s. The character does not turn with the ground: add this,
    /// times the length of the step, to its view direction.
    pub ground_spin: AngularVector,
    /// The part of the velocity in the air that does not come from walking, in m/s: from the ground that the
    /// character left, its jump, and gravity. Zero on the ground. May be written, for example by a blast or
    /// an updraught.
    pub fall: Vector,
    /// The offset for drawing the character along [`up`](CharacterController::up), in metres, so that it
    /// climbs steps smoothly.
    pub visual_offset: Scalar,
    /// Whether the character crouches. It stays crouched where there is no room to stand up.
    pub is_crouching: bool,
    /// Whether the character is squeezed between a moving and a fixed obstacle.
    pub is_crushed: bool,
    /// The force in N with which the character weighs on the dynamic body below: its weight, once that body
    /// bears it.
    pub load: Scalar,
    /// The body that carries the character.
    pub carrier: Option<Carrier>,
}

/// A body that carries a character, and the position of the character on it.
#[derive(Clone, Copy, Debug, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, PartialEq)]
pub struct Carrier {
    /// The body.
    pub body: Entity,
    /// The expected position of the body after the step, in metres.
    pub position: Position,
    /// The expected rotation of the body.
    pub rotation: Rotation,
    /// The expected position of the character after the step, in metres.
    pub rider: Vector,
    /// The point of the body under the feet, in its frame, in metres. It is kept while the character does not
    /// move on its own, so that rounding errors do not add up.
    pub anchor: Vector,
    /// The velocity of the body under the feet, in m/s.
    pub velocity: Vector,
    /// The velocity at which the character slides on the body, in m/s: a light body that jerks does not take
    /// a heavy character along.
    pub slip: Vector,
}

impl MapEntities for CharacterState {
    fn map_entities<E: EntityMapper>(&mut self, mapper: &mut E) {
        self.ground_entity = self.ground_entity.map(|entity| mapper.get_mapped(entity));
        if let Some(carrier) = &mut self.carrier {
            carrier.body = mapper.get_mapped(carrier.body);
        }
    }
}

impl CharacterState {
    /// Whether the character stands on ground that it can walk on.
    pub fn is_grounded(&self) -> bool {
        self.ground == GroundState::OnGround
    }

    /// The velocity of the character without its walking, in m/s.
    pub(super) fn carried(&self) -> Vector {
        if self.is_grounded() {
            self.ground_velocity + self.carrier.map_or(Vector::ZERO, |carrier| carrier.slip)
        } else {
            self.fall
        }
    }
}

/// The velocity of a collider's surface, in its frame, in m/s, as of a conveyor belt or an escalator. The
/// surface carries characters.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
pub struct SurfaceVelocity(pub Vector);

/// A character landed on the ground.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CharacterLanded {
    /// The character.
    #[event_target]
    pub character: Entity,
    /// The collider that the character stands on.
    pub ground: Entity,
    /// The speed of the fall at landing, in m/s.
    pub speed: Scalar,
}

/// A character left the ground: it jumped, walked off, or the ground disappeared.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CharacterLeftGround {
    /// The character.
    #[event_target]
    pub character: Entity,
    /// The part of its velocity in the air that does not come from walking, in m/s.
    pub fall: Vector,
}

/// A character moved into a collider other than ground. Sent in each step in which it does.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CharacterHit {
    /// The character.
    #[event_target]
    pub character: Entity,
    /// The collider that the character hit.
    pub collider: Entity,
    /// The point of the collider, in the world, in metres.
    pub point: Vector,
    /// The outward unit normal of the collider.
    pub normal: Vector,
    /// The impulse with which the character pushed a dynamic body, in N·s; 0 for other colliders.
    pub impulse: Scalar,
}

/// A character climbed a step.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CharacterClimbed {
    /// The character.
    #[event_target]
    pub character: Entity,
    /// The collider of the step.
    pub collider: Entity,
    /// How far the character rose in this simulation step, in metres. A round foot takes several.
    pub height: Scalar,
}
