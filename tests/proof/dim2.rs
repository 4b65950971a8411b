//! 2D parts of the proofs. `dim3.rs` has those of 3D.

use avian::{math::Vector, prelude::*};

/// Moment of inertia of a ball, divided by m r²: a disc.
pub const BALL_INERTIA: f32 = 0.5;

/// A box; its depth is ignored.
pub fn sized_block(x: f32, y: f32, _depth: f32) -> Collider {
    Collider::rectangle(x, y)
}

/// A vector; its depth is ignored.
pub fn sized(x: f32, y: f32, _depth: f32) -> Vector {
    Vector::new(x, y)
}

/// The angular velocity about z.
pub fn spin_of(velocity: AngularVelocity) -> f32 {
    velocity.0
}

/// Unit vectors along the ground.
pub fn directions() -> Vec<Vector> {
    vec![Vector::X, Vector::NEG_X]
}

/// The bits of a rotation.
pub fn rotation_bits(rotation: Rotation) -> Vec<u32> {
    [rotation.cos, rotation.sin].map(f32::to_bits).into()
}

/// The rotation about z as a component.
pub fn turned(angle: f32) -> Rotation {
    Rotation::radians(angle)
}

/// Mass of a disc of density 1.
pub fn ball_mass(radius: f32) -> f32 {
    core::f32::consts::PI * radius * radius
}

/// Every shape with its own constructor, each about a metre across.
pub fn shapes() -> Vec<Collider> {
    (0..scenes::dim::PIECES - 1).map(|kind| scenes::dim::piece(kind).remove(0).0).collect()
}

/// Closes the open sides of a flat container: there are none in 2D.
pub fn side_walls(_half_width: f32) -> Vec<(Collider, Vector)> {
    Vec::new()
}

/// Boxes across one layer of a container: columns and rows.
pub const LAYER: (u32, u32) = (8, 1);

/// No rotation.
pub fn upright() -> LockedAxes {
    LockedAxes::new().lock_rotation()
}

/// Maximum displacement of the top of a settled pyramid, in metres: one hundredth of a box.
pub const PYRAMID_UNREST: f32 = 0.01;

/// Layers of a heap of about a hundred pieces.
pub const PILE_LAYERS: u32 = 12;

/// An angular velocity about z.
pub fn about_z(w: f32) -> f32 {
    w
}

/// Walls without thickness at x = 0.
pub fn thin_walls() -> Vec<(&'static str, Collider)> {
    let points: Vec<_> = (0..=8).map(|i| Vector::new(0.0, i as f32 - 4.0)).collect();
    vec![
        ("segment", Collider::segment(Vector::new(0.0, -4.0), Vector::new(0.0, 4.0))),
        ("polyline", Collider::polyline(points, None)),
    ]
}
