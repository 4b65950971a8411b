//! [`DynamicMover`]: a dynamic body that walks by forces.

use bevy_ecs::prelude::*;
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::controller::{CharacterInput, CharacterState};
use crate::{
    dynamics::rigid_body::{CoefficientCombine, Friction, LockedAxes, RigidBody},
    math::{Dir, Scalar},
    spatial_query::SpatialQueryFilter,
};

/// A character that is a dynamic body: forces drive it toward [`CharacterInput::velocity`], and a spring
/// between its feet and the ground carries it.
///
/// All forces act on it, and it acts on other bodies, by its mass: blasts throw it, it pushes crates, and it
/// tilts a raft. For exact motion see [`CharacterController`](super::controller::CharacterController), which
/// has the same input, state and events.
///
/// - The spring pulls as well as pushes, so that the character follows stairs down and crests of hills. Steps
///   lower than [`float_height`](Self::float_height) pass below its collider.
/// - The character walks slopes up to [`max_slope`](Self::max_slope) at the horizontal input speed, and
///   stands on them without sliding.
/// - Dynamic ground gets the opposite of all forces.
/// - The body does not turn, has no friction of its own, and does not sleep.
///
/// Of [`CharacterState`] it uses all fields about the ground. [`fall`](CharacterState::fall) holds the
/// velocity that is kept from the ground that it left; the input in the air is relative to this velocity.
///
/// ```
/// # use avian::{math::*, prelude::*};
/// # use bevy_ecs::prelude::*;
/// # use bevy_transform::components::Transform;
/// fn spawn(mut commands: Commands) {
///     // 1.5 m tall, 0.3 m above the ground.
///     let shape = Collider::capsule(0.4, 0.7);
///     commands.spawn((DynamicMover::default(), shape, Mass(70.0), Transform::from_xyz(0.0, 2.0, 0.0)));
/// }
///
/// fn walk(mut players: Query<(&mut CharacterInput, &CharacterState), With<DynamicMover>>) {
///     for (mut input, state) in &mut players {
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
#[require(RigidBody::Dynamic, LockedAxes::ROTATION_LOCKED, Friction = smooth(), CharacterInput, CharacterState)]
pub struct DynamicMover {
    /// The upward direction of the character. It may change at any time. +y by default.
    pub up: Dir,
    /// The steepest slope that the character walks on, in radians. 50 degrees by default.
    pub max_slope: Scalar,
    /// The distance between the collider and the ground at which the spring carries its weight, in metres, as
    /// all lengths here scaled by [`PhysicsLengthUnit`](crate::prelude::PhysicsLengthUnit). 0.3 by default.
    /// At 0 there is no spring, and the collider slides on the ground.
    pub float_height: Scalar,
    /// How far the ground may drop beyond [`float_height`](Self::float_height) without the character leaving
    /// it, in metres. 0.3 by default.
    pub snap_distance: Scalar,
    /// The frequency of the spring in Hz. 5 by default.
    pub frequency: Scalar,
    /// The damping ratio of the spring; 1 is critical. 1 by default.
    pub damping_ratio: Scalar,
    /// The largest acceleration on the ground in m/s². Times the mass, it is the largest force with which the
    /// character pushes. 40 by default.
    pub max_acceleration: Scalar,
    /// The largest acceleration in the air in m/s². 10 by default.
    pub max_air_acceleration: Scalar,
    /// The colliders that count as ground. Its own colliders need not be excluded.
    pub filter: SpatialQueryFilter,
}

/// No friction with anything.
fn smooth() -> Friction {
    Friction::new(0.0).with_combine_rule(CoefficientCombine::Min)
}

impl Default for DynamicMover {
    fn default() -> Self {
        Self {
            up: Dir::Y,
            max_slope: 0.872_664_6,
            float_height: 0.3,
            snap_distance: 0.3,
            frequency: 5.0,
            damping_ratio: 1.0,
            max_acceleration: 40.0,
            max_air_acceleration: 10.0,
            filter: SpatialQueryFilter::DEFAULT,
        }
    }
}
