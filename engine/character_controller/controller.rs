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

/// A character that walks: on floors, slopes and stairs, on platforms that move and turn.
///
/// Add it to an entity with a capsule, a cylinder, a box or another convex
/// [`Collider`](crate::prelude::Collider). The body is kinematic. Each step reads [`CharacterInput`], and
/// sets the velocity of the body so that the step moves it there. What became of it is in [`CharacterState`].
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
    /// The direction against which the character stands. It may change at any time, as on a planet.
    /// +y by default.
    pub up: Dir,
    /// The steepest slope that it walks on, in radians. 50 degrees by default.
    pub max_slope: Scalar,
    /// The highest step that it climbs, in metres, as all lengths here scaled by
    /// [`PhysicsLengthUnit`](crate::prelude::PhysicsLengthUnit). 0.4 by default, 0 for none.
    pub step_height: Scalar,
    /// The way that must be free above a step for it to be climbed, in metres. 0.1 by default.
    pub step_depth: Scalar,
    /// How far below its feet the floor may drop away without the character leaving it, in metres. 0.4 by
    /// default. Slopes up to [`max_slope`](Self::max_slope) are followed at any speed.
    pub snap_distance: Scalar,
    /// The distance kept from all colliders, in metres. 0.01 by default.
    pub skin_width: Scalar,
    /// Its mass in kg, by which it pushes and weighs on dynamic bodies, and slides on light ones that jerk.
    /// 70 by default.
    pub mass: Scalar,
    /// The largest force by which it pushes dynamic bodies, in N. 500 by default, 0 for none.
    pub max_push_force: Scalar,
    /// What the character collides with. Its own colliders need not be excluded.
    pub filter: SpatialQueryFilter,
    /// The layers of its friends: other characters that do not stop it. Those that overlap yield to each
    /// other, each by half of the way. None by default.
    pub friends: LayerMask,
    /// The speed at which it yields to friends, in m/s. Slower than half of its own speed, or
    /// friends push each other along instead of passing. 0.5 by default.
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

/// What a character is to do.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
pub struct CharacterInput {
    /// The velocity at which it is to walk, relative to the ground, in m/s. The part along
    /// [`up`](CharacterController::up) has no effect: slopes and stairs are walked at this horizontal speed.
    /// In the air it is relative to the ground that was left.
    pub velocity: Vector,
    /// The speed at which it is to leave the ground, in m/s; 0 for none. The next step sets it back to 0,
    /// also if there is no ground to leave.
    pub jump: Scalar,
    /// Whether it is to crouch, if it has a [`CharacterCrouch`](super::crouch::CharacterCrouch).
    pub crouch: bool,
}

/// What a character stands on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Default, PartialEq)]
pub enum GroundState {
    /// Ground that it can walk on.
    OnGround,
    /// A slope that is too steep to stand on.
    OnSteepGround,
    /// It touches something that does not support it: a wall, or a ceiling.
    NotSupported,
    /// Nothing.
    #[default]
    InAir,
}

/// Where a character is after a step, and what the next one goes on from.
///
/// It is plain data: a character goes on with the same bits from a copy of its components.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
#[component(map_entities)]
pub struct CharacterState {
    /// What it stands on.
    pub ground: GroundState,
    /// The collider that it stands on, or touches.
    pub ground_entity: Option<Entity>,
    /// The point there, in the world, in metres.
    pub ground_point: Vector,
    /// The outward unit normal there: that of the face beside, if the point is at an edge that
    /// can be stood on.
    pub ground_normal: Vector,
    /// The velocity of the ground at the point in m/s, that of its surface included.
    pub ground_velocity: Vector,
    /// How the ground turns, in rad/s. The character does not turn with it: add this, times the length of the
    /// step, to the direction in which it looks.
    pub ground_spin: AngularVector,
    /// The velocity in the air that is not the character's own, in m/s: that of the ground it left, of its
    /// jump, and of gravity. Zero on the ground. May be written, as by a blow or an updraught.
    pub fall: Vector,
    /// How far a drawn character is to be moved along [`up`](CharacterController::up) so that it climbs steps
    /// smoothly, in metres.
    pub visual_offset: Scalar,
    /// Whether it crouches: also where there is no room to stand up.
    pub is_crouching: bool,
    /// Whether it has no room between something that moves and something that does not.
    pub is_crushed: bool,
    /// The force in N by which it weighs on the dynamic body that it stands on: its weight, once that
    /// body bears it.
    pub load: Scalar,
    /// What carries it.
    pub carrier: Option<Carrier>,
}

/// A body that carries a character, and the character's place on it.
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
    /// The point of the body under the feet, in its frame, in metres. It stays while the character does not
    /// move by itself, so that rounding does not add up.
    pub anchor: Vector,
    /// The velocity of the body under the feet, in m/s.
    pub velocity: Vector,
    /// The velocity at which the character slides on it, in m/s: a light body that jerks does not take a
    /// heavy character along.
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
    /// Whether it stands on ground that it can walk on.
    pub fn is_grounded(&self) -> bool {
        self.ground == GroundState::OnGround
    }

    /// Its velocity that is not its own, in m/s.
    pub(super) fn carried(&self) -> Vector {
        if self.is_grounded() {
            self.ground_velocity + self.carrier.map_or(Vector::ZERO, |carrier| carrier.slip)
        } else {
            self.fall
        }
    }
}

/// The velocity at which the surface of a collider moves, in its frame, in m/s: of a conveyor belt, an
/// escalator. It carries characters.
#[derive(Component, Clone, Copy, Debug, Default, PartialEq, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component, Default, PartialEq)]
pub struct SurfaceVelocity(pub Vector);

/// A character came onto the ground.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CharacterLanded {
    /// The character.
    #[event_target]
    pub character: Entity,
    /// The collider that it stands on.
    pub ground: Entity,
    /// The speed at which it fell onto it, in m/s.
    pub speed: Scalar,
}

/// A character left the ground: it jumped, or walked off, or the ground is gone.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CharacterLeftGround {
    /// The character.
    #[event_target]
    pub character: Entity,
    /// Its velocity in the air that is not its own, in m/s.
    pub fall: Vector,
}

/// A character moved into something other than ground. Sent in each step in which it does.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CharacterHit {
    /// The character.
    #[event_target]
    pub character: Entity,
    /// The collider that it met.
    pub collider: Entity,
    /// The point of the collider, in the world, in metres.
    pub point: Vector,
    /// The outward unit normal of the collider.
    pub normal: Vector,
    /// The impulse by which it pushed a dynamic body, in N·s; 0 for other colliders.
    pub impulse: Scalar,
}

/// A character climbed a step.
#[derive(EntityEvent, Message, Clone, Copy, Debug, PartialEq)]
pub struct CharacterClimbed {
    /// The character.
    #[event_target]
    pub character: Entity,
    /// The step.
    pub collider: Entity,
    /// How far it was raised in this step of the simulation, in metres. A round foot takes several.
    pub height: Scalar,
}
