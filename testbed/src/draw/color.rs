//! Colours of bodies, and the way between stored and linear light.

use bevy_math::Vec3;

use super::{Drawable, Role};

/// Behind everything.
pub const BACKGROUND: Vec3 = Vec3::new(0.955, 0.955, 0.94);
/// Outlines.
pub const INK: Vec3 = Vec3::new(0.13, 0.14, 0.17);
const STATIC: Vec3 = Vec3::new(0.70, 0.70, 0.68);
const KINEMATIC: Vec3 = Vec3::new(0.46, 0.50, 0.56);
const SLEEPING: Vec3 = Vec3::new(0.62, 0.63, 0.66);

/// Ten colours that are told apart easily, for the dynamic bodies in turn.
const PALETTE: [[u8; 3]; 10] = [
    [78, 121, 167],
    [242, 142, 43],
    [89, 161, 79],
    [225, 87, 89],
    [118, 183, 178],
    [237, 201, 72],
    [176, 122, 161],
    [255, 157, 167],
    [156, 117, 95],
    [120, 170, 220],
];

/// The colour of a drawable, sRGB in 0..1.
pub fn of(drawable: &Drawable) -> Vec3 {
    match drawable.role {
        Role::Static => STATIC,
        Role::Kinematic => KINEMATIC,
        Role::Dynamic => {
            // A stride that is coprime to the palette, so that neighbours in rows and columns differ.
            let spread = drawable.body.wrapping_mul(0x9e37_79b1) >> 16;
            let color = bytes(PALETTE[spread as usize % PALETTE.len()]);
            if drawable.asleep { color.lerp(SLEEPING, 0.55) * 0.9 } else { color }
        }
    }
}

fn bytes(rgb: [u8; 3]) -> Vec3 {
    Vec3::new(f32::from(rgb[0]), f32::from(rgb[1]), f32::from(rgb[2])) / 255.0
}

/// From stored to linear light, by the usual approximation of sRGB's curve.
pub fn to_linear(color: Vec3) -> Vec3 {
    color.powf(2.2)
}

/// From linear light to stored bytes.
pub fn to_bytes(linear: Vec3) -> [u8; 3] {
    stored_bytes(linear.clamp(Vec3::ZERO, Vec3::ONE).powf(1.0 / 2.2))
}

/// Rounds a stored colour to bytes.
pub fn stored_bytes(color: Vec3) -> [u8; 3] {
    let scaled = (color.clamp(Vec3::ZERO, Vec3::ONE) * 255.0).round();
    [scaled.x as u8, scaled.y as u8, scaled.z as u8]
}
