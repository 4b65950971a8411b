//! 3D parts of the tests.

mod leaning;
mod round;
mod spin;

#[path = "floors3.rs"]
pub mod floors;
#[path = "golden3.rs"]
pub mod golden_dim;
#[path = "joints3.rs"]
mod joints;
#[path = "rubbing3.rs"]
mod rubbing;

use super::extreme::Dice;
pub use floors::{more_riders, terrain, tiles};

use crate::kernel::math::{Angular, InvInertia, Rot, Vector};
use crate::kernel::shape::{Cuboid, Curved, Hull, MassProperties, Shape, Surface};
use std::sync::Arc;

/// The inverse inertia of a body.
pub fn inverse_inertia(mass: &MassProperties) -> InvInertia {
    mass.inertia.inverse()
}

/// A hull `unit` times as large.
pub fn scaled_hull(hull: &Hull, unit: f32) -> Hull {
    let vertices: Vec<Vector> = hull.vertices().iter().map(|p| *p * unit).collect();
    let faces = hull.faces().iter().map(|face| hull.outline(face).to_vec()).collect();
    let scaled = Hull::from_mesh(vertices, faces).and_then(|scaled| scaled.rounded(hull.radius() * unit));
    scaled.expect("scaling keeps a hull a hull")
}

/// A frustum `unit` times as large.
pub fn scaled_curved(curved: &Curved, unit: f32) -> Curved {
    let Curved { lower, upper, half_height } = *curved;
    Curved { lower: lower * unit, upper: upper * unit, half_height: half_height * unit }
}

/// The rotation by an angle in the plane of x and y.
pub fn turned(angle: f32) -> Rot {
    Rot::from_axis_angle(Vector::Z, angle)
}

/// The part of an angular velocity in the plane of x and y.
pub fn spin_of(w: Angular) -> f32 {
    w.z
}

/// An angular velocity in the plane of x and y.
pub fn spin(z: f32) -> Angular {
    Vector { x: 0.0, y: 0.0, z }
}

/// A box of the given size.
pub fn sized(x: f32, y: f32, depth: f32) -> Vector {
    Vector { x, y, z: depth }
}

/// The moment of inertia of a solid ball, divided by m r².
pub const BALL_INERTIA: f32 = 0.4;

/// Piles that fall asleep: width in bodies, number of bodies, number of seeds, seconds.
pub const PILES: [(usize, usize, u64, usize); 2] = [(5, 100, 4, 8), (7, 441, 2, 12)];

/// Shapes that are hard to bring to rest, about a metre wide: a coin, a needle, an icosahedron, and a hull of
/// twelve corners by chance.
pub fn restless() -> Vec<(&'static str, Shape)> {
    let hull =
        |points: &[Vector]| Shape::Hull(Arc::new(Hull::convex_hull_of(points).expect("they span a solid")));
    let golden = 0.5 * (1.0 + 5.0f32.sqrt());
    let signs = [(-1.0, -golden), (-1.0, golden), (1.0, -golden), (1.0, golden)];
    let icosahedron: Vec<_> = signs
        .into_iter()
        .flat_map(|(a, b)| [sized(0.0, a, b), sized(a, b, 0.0), sized(b, 0.0, a)])
        .map(|corner| corner * (0.5 / corner.length()))
        .collect();
    let mut dice = Dice::new(77);
    let twelve: Vec<_> = (0..12)
        .map(|_| sized(dice.signed(), dice.signed(), dice.signed()))
        .map(|corner| corner * (0.5 / corner.length()))
        .collect();
    vec![
        ("coin", Shape::Curved(Curved { lower: 0.5, upper: 0.5, half_height: 0.05 })),
        ("needle", Shape::Cuboid(Cuboid { half: sized(0.03, 0.5, 0.03) })),
        ("icosahedron", hull(&icosahedron)),
        ("hull of 12", hull(&twelve)),
    ]
}

/// The angular momentum of rotation.
pub fn spin_momentum(inverse: InvInertia, rotation: Rot, w: Angular) -> Angular {
    rotation.rotate(inverse.inverse().apply(rotation.inverse_rotate(w)))
}

/// A surface 2 m wide with a profile in the plane of x and y.
pub fn channel(profile: &[[f32; 2]]) -> Shape {
    let vertex = |i: u32, j: u32| {
        let [x, y] = profile[i as usize];
        Vector { x, y, z: 2.0 * j as f32 - 1.0 }
    };
    let (vertices, facets) = floors::squares([profile.len() as u32 - 1, 1], vertex, |_, _| true);
    Shape::surface(Surface::new(vertices, facets).expect("a surface"))
}

/// A cylinder that stands upright; in 2D its outline.
pub fn cylinder(radius: f32, half_height: f32) -> Shape {
    Shape::Curved(Curved { lower: radius, upper: radius, half_height })
}

/// A cone that stands upright; in 2D its outline.
pub fn cone(radius: f32, half_height: f32) -> Shape {
    Shape::Curved(Curved { lower: radius, upper: 0.0, half_height })
}

/// The kinetic energy of rotation.
pub fn spin_energy(inverse: InvInertia, rotation: Rot, w: Angular) -> f64 {
    let local = rotation.inverse_rotate(w);
    0.5 * f64::from(local.dot(inverse.inverse().apply(local)))
}

/// A closed box of 4 by 4 by 4 metres on y = 0: half its width, its walls by size and place, and the middles
/// of its cells of a metre.
pub fn container() -> (f32, Vec<(Vector, Vector)>, Vec<Vector>) {
    let walls = [Vector::X, Vector::Y, Vector::Z].into_iter().flat_map(|axis| {
        let size = Vector::ONE * 12.0 - axis * 8.0;
        [-4.0, 4.0].map(|side| (size, Vector::Y * 2.0 + axis * side))
    });
    let cell = |i: i32| (i % 4) as f32 + 0.5;
    let cells = (0..64).map(|i| Vector { x: cell(i) - 2.0, y: cell(i / 16), z: cell(i / 4) - 2.0 });
    (2.0, walls.collect(), cells.collect())
}

/// The part of a position across the xy plane.
pub fn across(p: Vector) -> f32 {
    p.z
}

/// A random rotation.
pub fn any_rotation(dice: &mut Dice) -> Rot {
    Rot { x: dice.signed(), y: dice.signed(), z: dice.signed(), w: dice.signed() + 1.5 }.normalized()
}

/// A random angular velocity of any length.
pub fn any_spin(dice: &mut Dice) -> Angular {
    Vector { x: dice.signed(), y: dice.signed(), z: dice.signed() }
}

/// A hull of the given half extents: an octahedron.
pub fn hull_of(half: Vector) -> Shape {
    let points: Vec<_> = Vector::AXES.into_iter().flat_map(|a| [a.scale(half), a.scale(-half)]).collect();
    Hull::convex_hull_of(&points).map_or(Shape::Cuboid(Cuboid { half }), |hull| Shape::Hull(Arc::new(hull)))
}

/// Unit axes about which a level plate can tilt.
pub fn tilts() -> Vec<Angular> {
    let skew = Vector { x: 2.0, y: 1.0, z: 2.0 } * (1.0 / 3.0);
    vec![Vector::X, Vector::Z, skew]
}

/// The upright axis on a level plate.
pub fn upright() -> Option<Angular> {
    Some(Vector::Y)
}

/// Round tables and what stands on them.
pub fn turntables() -> Vec<(&'static str, Shape, Shape)> {
    let curved =
        |lower: f32, upper: f32, half_height: f32| Shape::Curved(Curved { lower, upper, half_height });
    let table = || curved(4.0, 4.0, 0.5);
    vec![
        ("coin", table(), curved(0.3, 0.3, 0.03)),
        ("cylinder", table(), curved(0.2, 0.2, 0.3)),
        ("cone", table(), curved(0.3, 0.0, 0.25)),
        ("frustum", table(), curved(0.3, 0.2, 0.2)),
        ("box", table(), Shape::Cuboid(Cuboid { half: Vector::ONE * 0.2 })),
    ]
}

/// Shapes that slide over floors.
pub fn riders() -> Vec<(&'static str, Shape)> {
    let half = Vector { x: 0.25, y: 0.25, z: 0.25 };
    let corners: Vec<_> = (0..12)
        .map(|i| {
            let (angle, y) = ((i % 6) as f32 * core::f32::consts::TAU / 6.0, if i < 6 { -0.2 } else { 0.2 });
            Vector { x: 0.3 * angle.cos(), y, z: 0.3 * angle.sin() }
        })
        .collect();
    let across = Vector::Z * 0.3;
    let along = Vector::X * 0.3;
    vec![
        ("box", Shape::Cuboid(Cuboid { half })),
        ("hull", Shape::Hull(Arc::new(Hull::convex_hull_of(&corners).expect("a prism is solid")))),
        ("ball", Shape::Ball(crate::kernel::shape::Ball { radius: 0.25 })),
        (
            "capsule across",
            Shape::Capsule(crate::kernel::shape::Capsule { a: -across, b: across, radius: 0.2 }),
        ),
        ("capsule along", Shape::Capsule(crate::kernel::shape::Capsule { a: -along, b: along, radius: 0.2 })),
        ("cylinder", Shape::Curved(Curved { lower: 0.3, upper: 0.3, half_height: 0.2 })),
    ]
}

/// Small bodies of a size that are shot at walls.
pub fn bullets(size: f32) -> Vec<(&'static str, Shape)> {
    let half = 0.5 * size;
    let along = Vector::Y * (0.5 * half);
    let rim = (0..32).map(|i| {
        let angle = (i % 16) as f32 * core::f32::consts::TAU / 16.0;
        Vector { x: half * angle.cos(), y: if i < 16 { -half } else { half }, z: half * angle.sin() }
    });
    let rim: Vec<_> = rim.collect();
    vec![
        ("cube", Shape::Cuboid(Cuboid { half: Vector::ONE * half })),
        ("ball", Shape::Ball(crate::kernel::shape::Ball { radius: half })),
        (
            "capsule",
            Shape::Capsule(crate::kernel::shape::Capsule { a: -along, b: along, radius: 0.5 * half }),
        ),
        ("prism", Shape::Hull(Arc::new(Hull::convex_hull_of(&rim).expect("a prism is solid")))),
        ("cylinder", Shape::Curved(Curved { lower: half, upper: half, half_height: half })),
        ("cone", Shape::Curved(Curved { lower: half, upper: 0.0, half_height: half })),
    ]
}

/// The angle of a joint in the plane of x and y, and its other angles.
pub const TURN: usize = crate::kernel::solver::coordinate::TWIST;
pub const SWINGS: core::ops::Range<usize> = TURN + 1..TURN + 3;

/// The basis of a joint's frame in which [`TURN`] is about the axis out of the plane of x and y.
pub fn hinge_basis() -> Rot {
    Rot::from_axis_angle(Vector::Y, -core::f32::consts::FRAC_PI_2)
}

/// A rotation by an angle about some axis.
pub fn any_axis_turn(angle: f32) -> Rot {
    Rot::from_axis_angle(Vector { x: 2.0 / 7.0, y: -3.0 / 7.0, z: 6.0 / 7.0 }, angle)
}

/// The angle of a rotation along its axis.
pub fn turn_vector(turn: Rot) -> Angular {
    let sign = if turn.w < 0.0 { -1.0 } else { 1.0 };
    let axis = Vector { x: turn.x, y: turn.y, z: turn.z } * sign;
    let sine = f64::from(axis.length_squared()).sqrt();
    let angle = 2.0 * sine.atan2(f64::from(turn.w * sign));
    if sine > 0.0 { axis * (angle / sine) as f32 } else { axis }
}

/// The coordinates of a limb's twist.
pub const LIMB: core::ops::Range<usize> = TURN..TURN + 1;
/// The coordinate of a limb's swing, and how far the other way its limits go.
pub const SWING: (usize, f32) = (crate::kernel::solver::coordinate::CONE, 0.0);

/// The basis of a frame whose x axis is along a limb that hangs down.
pub fn limb_basis() -> Rot {
    Rot::from_axis_angle(Vector::Z, -core::f32::consts::FRAC_PI_2)
}

/// Places side by side, a unit apart, in rows of three.
pub fn plot(number: usize) -> Vector {
    Vector { x: (number % 3) as f32, y: 0.0, z: (number / 3) as f32 }
}
