//! One file per engine.

#[cfg(feature = "avian")]
pub mod app;
#[cfg(feature = "avian")]
pub mod avian2d;
#[cfg(feature = "avian")]
pub mod avian3d;
#[cfg(feature = "avian")]
pub mod bare;
#[cfg(feature = "box2d")]
pub mod box2d;
#[cfg(feature = "box3d")]
pub mod box3d;
#[cfg(feature = "rapier")]
pub mod rapier2d;
#[cfg(feature = "rapier")]
pub mod rapier3d;
