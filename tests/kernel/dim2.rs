//! 2D parts of the tests.

#[path = "floors2.rs"]
pub mod floors;
#[path = "golden2.rs"]
pub mod golden_dim;

use super::extreme::Dice;
pub use floors::{more_riders, terrain, tiles};

use crate::kernel::math::{Angular, InvInertia, Rot, Vector};
use crate::kernel::shape::{Cuboid, Curved, Hull, MassProperties, Shape, Surface};
use std::sync::Arc;

/// The inverse inertia of a body.
pub fn inverse_inertia(mass: &MassProperties) -> InvInertia {
    InvInertia { zz: if mass.inertia > 0.0 { 1.0 / mass.inertia } else { 0.0 } }
}

/// A hull `unit` times as large.
pub fn scaled_hull(hull: &Hull, unit: f32) -> Hull {
    let vertices: Vec<Vector> = hull.vertices().iter().map(|p| *p * unit).collect();
    Hull::from_convex(&vertices, hull.radius() * unit).expect("scaling keeps a hull a hull")
}

/// An ellipse `unit` times as large.
pub fn scaled_curved(curved: &Curved, unit: f32) -> Curved {
    Curved { half: curved.half * unit }
}

/// The rotation by an angle in the plane of x and y.
pub fn turned(angle: f32) -> Rot {
    Rot::from_angle(angle)
}

/// The part of an angular velocity in the plane of x and y.
pub fn spin_of(w: Angular) -> f32 {
    w.z
}

/// A box of the given size. `depth` is used in 3D only.
pub fn sized(x: f32, y: f32, _depth: f32) -> Vector {
    Vector { x, y }
}

/// An angular velocity in the plane.
pub fn spin(z: f32) -> Angular {
    Angular { z }
}

/// The moment of inertia of a solid ball, divided by m r².
pub const BALL_INERTIA: f32 = 0.5;

/// Piles that fall asleep: width in bodies, number of bodies, number of seeds, seconds.
pub const PILES: [(usize, usize, u64, usize); 2] = [(10, 100, 4, 8), (21, 441, 2, 12)];

/// Shapes that are hard to bring to rest, about a metre wide: a coin, a needle, a triangle, a round box,
/// and an octagon.
pub fn restless() -> Vec<(&'static str, Shape)> {
    let hull = |points: &[Vector], radius: f32| {
        Shape::Hull(Arc::new(Hull::convex_hull_of(points, radius).expect("they span an area")))
    };
    let corner = |i: i32| turned(i as f32 * core::f32::consts::FRAC_PI_4).rotate(Vector::X) * 0.5;
    let octagon: Vec<_> = (0..8).map(corner).collect();
    let square: Vec<_> =
        [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, y)| sized(x, y, 0.0) * 0.4).into();
    let triangle = [sized(-0.5, -0.4, 0.0), sized(0.5, -0.4, 0.0), sized(0.0, 0.6, 0.0)];
    vec![
        ("coin", Shape::Cuboid(Cuboid { half: sized(0.5, 0.05, 0.0) })),
        ("needle", Shape::Cuboid(Cuboid { half: sized(0.5, 0.03, 0.0) })),
        ("triangle", hull(&triangle, 0.0)),
        ("round box", hull(&square, 0.1)),
        ("octagon", hull(&octagon, 0.0)),
    ]
}

/// The angular momentum of rotation.
pub fn spin_momentum(inverse: InvInertia, _rotation: Rot, w: Angular) -> Angular {
    Angular { z: w.z / inverse.zz }
}

/// A surface with a profile in the plane of x and y.
pub fn channel(profile: &[[f32; 2]]) -> Shape {
    let vertices = profile.iter().map(|[x, y]| Vector { x: *x, y: *y }).collect();
    let facets = (1..profile.len() as u32).map(|k| [k - 1, k]).collect();
    Shape::surface(Surface::new(vertices, facets).expect("a line"))
}

/// A cylinder that stands upright; in 2D its outline.
pub fn cylinder(radius: f32, half_height: f32) -> Shape {
    Shape::Cuboid(Cuboid { half: Vector { x: radius, y: half_height } })
}

/// A cone that stands upright; in 2D its outline.
pub fn cone(radius: f32, half_height: f32) -> Shape {
    let corners = [(-radius, -half_height), (radius, -half_height), (0.0, half_height)];
    let corners: Vec<_> = corners.into_iter().map(|(x, y)| Vector { x, y }).collect();
    Shape::Hull(Arc::new(Hull::convex_hull_of(&corners, 0.0).expect("a triangle is solid")))
}

/// The kinetic energy of rotation.
pub fn spin_energy(inverse: InvInertia, _rotation: Rot, w: Angular) -> f64 {
    if inverse.zz > 0.0 { 0.5 * f64::from(w.z * w.z / inverse.zz) } else { 0.0 }
}

/// A closed box of 8 by 8 metres on y = 0: half its width, its walls by size and place, and the middles of
/// its cells of a metre.
pub fn container() -> (f32, Vec<(Vector, Vector)>, Vec<Vector>) {
    let (long, thick) = (Vector { x: 16.0, y: 4.0 }, Vector { x: 4.0, y: 16.0 });
    let walls = [(long, 0.0, -2.0), (long, 0.0, 10.0), (thick, -6.0, 4.0), (thick, 6.0, 4.0)];
    let cells = (0..64).map(|i| Vector { x: (i % 8) as f32 - 3.5, y: (i / 8) as f32 + 0.5 });
    (4.0, walls.map(|(size, x, y)| (size, Vector { x, y })).into(), cells.collect())
}

/// The part of a position across the xy plane.
pub fn across(_: Vector) -> f32 {
    0.0
}

/// A random rotation.
pub fn any_rotation(dice: &mut Dice) -> Rot {
    Rot::from_angle(4.0 * dice.signed())
}

/// A random angular velocity of any length.
pub fn any_spin(dice: &mut Dice) -> Angular {
    Angular { z: dice.signed() }
}

/// A hull of the given half extents: a rhombus.
pub fn hull_of(half: Vector) -> Shape {
    let points: Vec<_> = Vector::AXES.into_iter().flat_map(|a| [a.scale(half), a.scale(-half)]).collect();
    Hull::convex_hull_of(&points, 0.0)
        .map_or(Shape::Cuboid(Cuboid { half }), |hull| Shape::Hull(Arc::new(hull)))
}

/// Unit axes about which a level plate can tilt.
pub fn tilts() -> Vec<Angular> {
    vec![spin(1.0)]
}

/// The upright axis on a level plate: none in 2D.
pub fn upright() -> Option<Angular> {
    None
}

/// Round tables and what stands on them: none in 2D.
pub fn turntables() -> Vec<(&'static str, Shape, Shape)> {
    Vec::new()
}

/// Shapes that slide over floors.
pub fn riders() -> Vec<(&'static str, Shape)> {
    let half = Vector { x: 0.25, y: 0.25 };
    let corners: Vec<_> = (0..6)
        .map(|i| {
            let angle = (i as f32 + 0.5) * core::f32::consts::TAU / 6.0;
            Vector { x: 0.3 * angle.sin(), y: 0.3 * angle.cos() }
        })
        .collect();
    let along = Vector::X * 0.3;
    vec![
        ("box", Shape::Cuboid(Cuboid { half })),
        ("hull", Shape::Hull(Arc::new(Hull::convex_hull_of(&corners, 0.0).expect("a hexagon is solid")))),
        ("ball", Shape::Ball(crate::kernel::shape::Ball { radius: 0.25 })),
        ("capsule along", Shape::Capsule(crate::kernel::shape::Capsule { a: -along, b: along, radius: 0.2 })),
        ("ellipse", Shape::Curved(Curved { half: Vector { x: 0.35, y: 0.25 } })),
    ]
}

/// Small bodies of a size that are shot at walls.
pub fn bullets(size: f32) -> Vec<(&'static str, Shape)> {
    let half = 0.5 * size;
    let along = Vector::X * (0.5 * half);
    vec![
        ("box", Shape::Cuboid(Cuboid { half: Vector::ONE * half })),
        ("ball", Shape::Ball(crate::kernel::shape::Ball { radius: half })),
        (
            "capsule",
            Shape::Capsule(crate::kernel::shape::Capsule { a: -along, b: along, radius: 0.5 * half }),
        ),
        ("rhombus", hull_of(Vector { x: half, y: 0.6 * half })),
        ("ellipse", Shape::Curved(Curved { half: Vector { x: half, y: 0.6 * half } })),
    ]
}

/// The angle of a joint in the plane of x and y, and its other angles.
pub const TURN: usize = crate::kernel::solver::coordinate::ANGLE;
pub const SWINGS: core::ops::Range<usize> = TURN + 1..TURN + 1;

/// The basis of a joint's frame in which [`TURN`] is about the axis out of the plane of x and y.
pub fn hinge_basis() -> Rot {
    Rot::IDENTITY
}

/// A rotation by an angle about some axis.
pub fn any_axis_turn(angle: f32) -> Rot {
    Rot::from_angle(angle)
}

/// The angle of a rotation along its axis.
pub fn turn_vector(turn: Rot) -> Angular {
    Angular { z: f64::from(turn.sin).atan2(f64::from(turn.cos)) as f32 }
}

/// The coordinates of a limb's twist: none.
pub const LIMB: core::ops::Range<usize> = TURN..TURN;
/// The coordinate of a limb's swing, and how far the other way its limits go.
pub const SWING: (usize, f32) = (TURN, -1.0);

/// The basis of a frame whose x axis is along a limb that hangs down.
pub fn limb_basis() -> Rot {
    Rot::IDENTITY
}

/// Places side by side, a unit apart.
pub fn plot(number: usize) -> Vector {
    Vector { x: number as f32, y: 0.0 }
}
