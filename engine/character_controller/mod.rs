//! Characters: shapes that the game moves, and that slide along obstacles.
//!
//! | I want to | use |
//! |---|---|
//! | have a character walk: floors, slopes, stairs, platforms | [`CharacterController`](controller::CharacterController) |
//! | have one that crouches | [`CharacterCrouch`](crouch::CharacterCrouch) |
//! | have a character that forces move: a dynamic body | [`DynamicMover`](dynamic_mover::DynamicMover) |
//! | write a controller of my own | [`MoveAndSlide`](move_and_slide::MoveAndSlide), a system parameter that moves a shape |

pub mod controller;
pub mod crouch;
pub mod dynamic_mover;
pub mod move_and_slide;
pub mod plugin;

mod bodies;
mod friends;
mod hovering;
mod mover;
mod planes;
mod planning;
mod system;
mod velocity_project;
mod walker;

/// The names of this module that most apps use.
pub mod prelude {
    pub use super::{
        controller::{
            CharacterClimbed, CharacterController, CharacterHit, CharacterInput, CharacterLanded,
            CharacterLeftGround, CharacterState, GroundState, SurfaceVelocity,
        },
        crouch::CharacterCrouch,
        dynamic_mover::DynamicMover,
        move_and_slide::{
            MoveAndSlide, MoveAndSlideConfig, MoveAndSlideHitData, MoveAndSlideHitResponse,
            MoveAndSlideOutput,
        },
        plugin::{CharacterControllerPlugin, CharacterSystems},
    };
}
