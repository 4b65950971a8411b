//! 3D parts of the proofs. `dim2.rs` has those of 2D.

use avian::{math::Vector, prelude::*};

/// Moment of inertia of a ball, divided by m r²: a solid sphere.
pub const BALL_INERTIA: f32 = 0.4;

/// A box.
pub fn sized_block(x: f32, y: f32, depth: f32) -> Collider {
    Collider::cuboid(x, y, depth)
}

/// A vector.
pub fn sized(x: f32, y: f32, depth: f32) -> Vector {
    Vector::new(x, y, depth)
}

/// The angular velocity about z.
pub fn spin_of(velocity: AngularVelocity) -> f32 {
    velocity.0.z
}

/// Unit vectors along the ground: twelve, 30 degrees apart, none along an axis.
pub fn directions() -> Vec<Vector> {
    (0..12)
        .map(|i| {
            let (sin, cos) = scenes::sin_cos((10.0 + 30.0 * i as f32) * core::f32::consts::PI / 180.0);
            Vector::new(cos, 0.0, sin)
        })
        .collect()
}

/// The bits of a rotation.
pub fn rotation_bits(rotation: Rotation) -> Vec<u32> {
    rotation.0.to_array().map(f32::to_bits).into()
}

/// The rotation about z as a component.
pub fn turned(angle: f32) -> Rotation {
    Rotation(scenes::scene::turned(angle))
}

/// Mass of a solid sphere of density 1.
pub fn ball_mass(radius: f32) -> f32 {
    4.0 / 3.0 * core::f32::consts::PI * radius * radius * radius
}

/// Every shape with its own constructor, each about a metre across.
pub fn shapes() -> Vec<Collider> {
    (0..scenes::dim::PIECES - 1).map(|kind| scenes::dim::piece(kind).remove(0).0).collect()
}

/// Closes the open sides of a flat container: the walls in front and behind, with their positions.
pub fn side_walls(half_width: f32) -> Vec<(Collider, Vector)> {
    let side = 2.0 * half_width + 8.0;
    [-1.0, 1.0]
        .map(|s| (Collider::cuboid(side, side, 4.0), Vector::new(0.0, half_width, s * (half_width + 2.0))))
        .into()
}

/// Boxes across one layer of a container: columns and rows.
pub const LAYER: (u32, u32) = (4, 4);

/// No rotation.
pub fn upright() -> LockedAxes {
    LockedAxes::new().lock_rotation_x().lock_rotation_y().lock_rotation_z()
}

/// Maximum displacement of the top of a settled pyramid, in metres: one hundredth of a box.
pub const PYRAMID_UNREST: f32 = 0.01;

/// Layers of a heap of about a hundred pieces.
pub const PILE_LAYERS: u32 = 3;

/// An angular velocity about z.
pub fn about_z(w: f32) -> Vector {
    Vector::Z * w
}

/// Walls without thickness at x = 0.
pub fn thin_walls() -> Vec<(&'static str, Collider)> {
    let corner = |y: f32, z: f32| Vector::new(0.0, y, z);
    let vertices = vec![corner(-4.0, -4.0), corner(4.0, -4.0), corner(4.0, 4.0), corner(-4.0, 4.0)];
    let field = Collider::heightfield(vec![vec![0.0; 9]; 9], Vector::new(8.0, 1.0, 8.0));
    let upright = Rotation(scenes::scene::turned(core::f32::consts::FRAC_PI_2));
    vec![
        ("mesh", Collider::trimesh(vertices, vec![[0, 1, 2], [0, 2, 3]])),
        ("height field", Collider::compound(vec![(Vector::ZERO, upright, field)])),
        ("triangle", Collider::triangle(corner(-20.0, -20.0), corner(20.0, -20.0), corner(0.0, 20.0))),
    ]
}
