//! Characters: shapes that the game moves, and that slide along what they meet.
//!
//! | I want to | use |
//! |---|---|
//! | have a character walk: floors, slopes, stairs, platforms | [`CharacterController`](controller::CharacterController) |
//! | write a controller of my own | [`MoveAndSlide`](move_and_slide::MoveAndSlide), a system parameter that moves a shape |

pub mod controller;
pub mod move_and_slide;
pub mod plugin;

mod bodies;
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
        move_and_slide::{
            MoveAndSlide, MoveAndSlideConfig, MoveAndSlideHitData, MoveAndSlideHitResponse,
            MoveAndSlideOutput,
        },
        plugin::{CharacterControllerPlugin, CharacterSystems},
    };
}
