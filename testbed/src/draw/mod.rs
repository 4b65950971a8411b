//! Drawing without a GPU: shapes as plain geometry, a rasteriser for the plane, one for space, PNG files.

pub mod color;
pub mod form;
pub mod image;
pub mod raster2;
pub mod raster3;
mod shadow;
mod triangle;

use std::sync::Arc;

use bevy_math::{Quat, Vec3};

pub use form::Form;
pub use image::Image;

/// The kind of a body, for its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Never moves.
    Static,
    /// Moves by its velocity only.
    Kinematic,
    /// Moves by forces and contacts.
    Dynamic,
}

/// A collider to draw: its geometry and where it is.
#[derive(Clone, Debug)]
pub struct Drawable {
    /// The shape in its own frame; colliders with equal shapes share it.
    pub form: Arc<Form>,
    /// Position in metres.
    pub translation: Vec3,
    /// Orientation.
    pub rotation: Quat,
    /// Number of its body, counted in order of spawning: chooses the colour.
    pub body: u32,
    /// Kind of its body.
    pub role: Role,
    /// Whether its body sleeps: drawn dimmer.
    pub asleep: bool,
    /// Whether to draw it as glass, see `scenes::Glass`.
    pub glass: bool,
}

/// What part of the world to draw and from where.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Lowest corner of what has to be in the picture.
    pub min: Vec3,
    /// Highest corner of what has to be in the picture.
    pub max: Vec3,
    /// Direction towards the viewer; the plane is always seen from +z.
    pub eye: Vec3,
}

/// Draws a world of either dimension.
pub fn draw(drawables: &[Drawable], view: View, flat: bool, width: usize, height: usize) -> Image {
    if flat {
        raster2::draw(drawables, view, width, height)
    } else {
        raster3::draw(drawables, view, width, height)
    }
}
