//! Scenes for tests, benchmarks and the testbed.
//!
//! One source makes two packages, `scenes2d` and `scenes3d`. [`all`] lists the scenes with their standard
//! parameters; the modules hold the functions behind them, with free parameters. Every scene uses the
//! engine's public components only, sets its own gravity and friction, and is the same in every run: random
//! choices come from [`Rng`], angles from [`sin_cos`].

pub mod app;
pub mod belts;
pub mod blast;
pub mod breaking;
pub mod bridge;
pub mod bullets;
pub mod card_house;
pub mod cars;
pub mod dominoes;
pub mod growing;
pub mod numbers;
pub mod pile;
pub mod pyramid;
pub mod ragdolls;
pub mod scaled;
pub mod scene;
pub mod sensors;
pub mod slopes;
pub mod terrain;
pub mod towers;
pub mod tumbler;
pub mod walkers;

#[cfg_attr(feature = "2d", path = "dim2.rs")]
#[cfg_attr(feature = "3d", path = "dim3.rs")]
pub mod dim;

pub use app::{DT, SUBSTEPS, headless_app, headless_app_with, step};
pub use numbers::{Rng, sin_cos};
pub use scene::{Bounds, Glass, Scene, Watch, Watched};

#[cfg(test)]
mod tests;

/// Every scene, in the order of the testbed's tour.
pub fn all() -> &'static [Scene] {
    &dim::SCENES
}

/// The scene of that name, if there is one.
pub fn find(name: &str) -> Option<&'static Scene> {
    all().iter().find(|scene| scene.name == name)
}
