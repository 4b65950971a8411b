//! [`CharacterCrouch`]: a second, lower shape of a character.

use bevy_ecs::{prelude::*, system::SystemParam};
use bevy_reflect::prelude::*;
#[cfg(feature = "serialize")]
use bevy_reflect::{ReflectDeserialize, ReflectSerialize};

use super::{
    bodies::BodiesAround,
    controller::{CharacterController, CharacterInput, CharacterState},
    move_and_slide::MoveAndSlide,
    mover::Mover,
    system::{feet_of, solidity},
    velocity_project::vector,
};
use crate::{
    collision::collider::{Collider, CollisionLayers},
    dynamics::rigid_body::RigidBodyDisabled,
    math::Vector,
    physics_transform::{Position, Rotation},
};

/// The shapes of a character that can crouch.
///
/// While [`CharacterInput::crouch`] is set, the [`Collider`] of the character is the lower shape. Afterwards
/// it is the upper shape again, as soon as that touches nothing. The feet stay where they are.
/// [`CharacterState::is_crouching`] tells the present shape. Spawn the character with the upper shape.
///
/// ```
/// # use avian::{math::*, prelude::*};
/// # use bevy_ecs::prelude::*;
/// fn spawn(mut commands: Commands) {
///     let standing = Collider::capsule(0.4, 1.0);
///     let crouching = Collider::capsule(0.4, 0.2);
///     commands.spawn((
///         CharacterController::default(),
///         standing.clone(),
///         CharacterCrouch { standing, crouching },
///     ));
/// }
/// ```
#[derive(Component, Clone, Debug, Reflect)]
#[cfg_attr(feature = "serialize", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serialize", reflect(Serialize, Deserialize))]
#[reflect(Debug, Component)]
pub struct CharacterCrouch {
    /// The shape of the standing or walking character.
    pub standing: Collider,
    /// The shape of the crouching character.
    pub crouching: Collider,
}

/// A character that can crouch, with its present state.
type Standing = (
    Entity,
    &'static CharacterController,
    &'static CharacterCrouch,
    &'static CharacterInput,
    &'static CharacterState,
    &'static Collider,
    &'static Position,
    &'static Rotation,
    Option<&'static CollisionLayers>,
);

/// The characters that can crouch, and the colliders around them.
#[derive(SystemParam)]
pub(super) struct Room<'w, 's> {
    characters: Query<'w, 's, Standing, Without<RigidBodyDisabled>>,
    moves: MoveAndSlide<'w, 's>,
    bodies: BodiesAround<'w, 's>,
}

/// A character with its new shape, and the displacement of its position.
struct Change {
    entity: Entity,
    shape: Collider,
    way: Vector,
}

impl Room<'_, '_> {
    /// The characters that crouch or stand up in this step.
    fn changes(&self) -> Vec<Change> {
        let mut changes = Vec::new();
        for (entity, controller, crouch, input, state, shape, position, rotation, layers) in &self.characters
        {
            if input.crouch == state.is_crouching || *position == Position::PLACEHOLDER {
                continue;
            }
            let next = if input.crouch { &crouch.crouching } else { &crouch.standing };
            let up = vector(controller.up);
            let way = up * (feet_of(shape, rotation, up) - feet_of(next, rotation, up));
            let unit = self.moves.length_unit.0;
            let is_solid = solidity(&self.moves, &self.bodies, controller.friends, layers);
            let mover = Mover {
                queries: &self.moves.spatial_query,
                is_solid: &is_solid,
                ignored: self.bodies.colliders_of(entity).collect(),
                shape: next,
                rotation: (*rotation).into(),
                filter: &controller.filter,
                skin: (controller.skin_width * unit).max(0.0),
                unit,
            };
            if way.is_finite() && (input.crouch || mover.fits(position.0 + way)) {
                changes.push(Change { entity, shape: next.clone(), way });
            }
        }
        changes
    }
}

/// The components that a change of shape writes.
type Stance = (&'static mut Collider, &'static mut Position, &'static mut CharacterState);

/// Applies the shapes of characters that crouch or stand up.
pub(super) fn change_stances(mut params: ParamSet<(Room, Query<Stance>)>) {
    let changes = params.p0().changes();
    let mut stances = params.p1();
    for Change { entity, shape, way } in changes {
        let Ok((mut collider, mut position, mut state)) = stances.get_mut(entity) else { continue };
        *collider = shape;
        position.0 += way;
        state.is_crouching = !state.is_crouching;
        if let Some(carrier) = &mut state.carrier {
            carrier.rider += way;
        }
    }
}
