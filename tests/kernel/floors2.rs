//! Floors of pieces in 2D, and bodies that slide or roll over them.

use super::super::extreme::Dice;
use crate::kernel::math::{Angular, Pose, Rot, Vector};
use crate::kernel::shape::{Ball, Cuboid, HalfSpace, Hull, Segment, Shape, Surface};
use std::sync::Arc;

/// A floor: its name, and its pieces with their places.
pub type Floor = (&'static str, Vec<(Shape, Vector)>);

fn cuboid(half: Vector) -> Shape {
    Shape::Cuboid(Cuboid { half })
}

fn hull(half: Vector) -> Shape {
    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    let corners = corners.map(|(x, y)| Vector { x: x * half.x, y: y * half.y });
    Shape::Hull(Arc::new(Hull::convex_hull_of(&corners, 0.0).expect("a box is solid")))
}

/// Flush tiles from x = -3 to 14.
fn row(size: f32, make: impl Fn(Vector) -> Shape) -> Vec<(Shape, Vector)> {
    let half = Vector { x: 0.5 * size, y: 0.5 };
    let place = |i: i32| Vector { x: -3.0 + size * (i as f32 + 0.5), y: -0.5 };
    (0..(17.0 / size) as i32).map(|i| (make(half), place(i))).collect()
}

/// Boxes of several sizes and depths, as voxels are joined.
fn bricks() -> Vec<(Shape, Vector)> {
    let (mut x, mut pieces) = (-3.0, Vec::new());
    while x < 14.0 {
        let length = [0.5, 1.5, 1.0, 2.0, 0.5][pieces.len() % 5];
        let depth = [0.5, 1.0, 1.5][pieces.len() % 3];
        let half = Vector { x: 0.5 * length, y: 0.5 * depth };
        pieces.push((cuboid(half), Vector { x: x + half.x, y: -half.y }));
        x += length;
    }
    pieces
}

fn compound(pieces: &[(Shape, Vector)]) -> Shape {
    let solids = pieces.iter().map(|(shape, place)| (Pose::new(*place, Rot::IDENTITY), shape.clone()));
    Shape::compound(solids.collect()).expect("boxes are solid")
}

/// Floors of flush pieces, with their top at y = 0, from x = -3 to 14.
pub fn tiles() -> Vec<Floor> {
    let boxes = row(1.0, cuboid);
    let alone = |shape: Shape| vec![(shape, Vector::ZERO)];
    let segment = |half: Vector| Shape::Segment(Segment { a: Vector::X * half.x, b: Vector::X * -half.x });
    let mut segments = row(1.0, segment);
    segments.iter_mut().for_each(|(_, place)| place.y = 0.0);
    vec![
        ("one box", vec![(cuboid(Vector { x: 20.0, y: 0.5 }), Vector::Y * -0.5)]),
        ("half-space", alone(Shape::HalfSpace(HalfSpace { normal: Vector::Y }))),
        ("compound", alone(compound(&boxes))),
        ("boxes", boxes),
        ("small boxes", row(0.31, cuboid)),
        ("hulls", row(1.0, hull)),
        ("bricks", bricks()),
        ("voxels", alone(compound(&bricks()))),
        ("segments", segments),
        ("polyline", alone(terrain(1.0, |_, _| 0.0))),
        ("fine polyline", alone(terrain(0.17, |_, _| 0.0))),
        ("irregular polyline", alone(irregular(0.4))),
    ]
}

/// A line over x = -3 to 14 of segments of one length along x.
pub fn terrain(size: f32, height: impl Fn(f32, f32) -> f32) -> Shape {
    let place = |i: u32| -3.0 + size * i as f32;
    line((17.0 / size) as u32 + 1, |i| Vector { x: place(i), y: height(place(i), 0.0) })
}

/// A level line of segments of any length.
fn irregular(size: f32) -> Shape {
    let shift = |i: u32| 0.45 * size * Dice::new(u64::from(i)).signed();
    line((17.0 / size) as u32 + 1, |i| Vector { x: -3.0 + size * i as f32 + shift(i), y: 0.0 })
}

fn line(count: u32, vertex: impl Fn(u32) -> Vector) -> Shape {
    let facets = (0..count).map(|i| [i, i + 1]).collect();
    Shape::surface(Surface::new((0..=count).map(vertex).collect(), facets).expect("a line"))
}

/// Level lines as they come from editors: in chunks, and with points twice.
pub fn messy() -> Vec<Floor> {
    let chunk = |k: i32| {
        let at = |i: u32| Vector::X * [0.0, 0.4, 1.0][i as usize];
        (line(2, at), Vector::X * (k as f32 - 3.0))
    };
    let twice = line(69, |i| Vector::X * ((i / 2) as f32 * 0.5 - 3.0));
    vec![("chunks", (0..17).map(chunk).collect()), ("points twice", vec![(twice, Vector::ZERO)])]
}

/// More shapes that slide over floors, with their rotations.
pub fn more_riders() -> Vec<(&'static str, Shape, Rot)> {
    let half = Vector { x: 0.2, y: 0.2 };
    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    let corners = corners.map(|(x, y)| Vector { x: x * half.x, y: y * half.y });
    let round = Hull::convex_hull_of(&corners, 0.05).expect("a box is solid");
    let slab = Vector { x: 0.8, y: 0.1 };
    vec![
        ("round box", Shape::Hull(Arc::new(round)), Rot::IDENTITY),
        ("slab", Shape::Cuboid(Cuboid { half: slab }), Rot::IDENTITY),
    ]
}

/// Shapes that roll along x, with their rotations and radii.
pub fn rollers() -> Vec<(&'static str, Shape, Rot, f32)> {
    vec![("ball", Shape::Ball(Ball { radius: 0.25 }), Rot::IDENTITY, 0.25)]
}

/// The rotation about the vertical that turns x to a level direction: none in 2D.
pub fn heading(_: Vector) -> Rot {
    Rot::IDENTITY
}

/// The angular velocity of what rolls along x.
pub fn roll(direction: Vector, rate: f32) -> Angular {
    Angular { z: -direction.x * rate }
}

/// Larger floors for a hundred bodies [`apart`], which move by up to 25 m along x.
pub fn laid() -> Vec<Floor> {
    let at = |i: u32| Vector { x: i as f32 - 2.13, y: 0.0 };
    let middle = Vector { x: 0.5, y: -0.5 };
    let segment = Segment { a: Vector::X * 0.5, b: Vector::X * -0.5 };
    let places = (0..230).map(at);
    let tiles = places.clone().map(|place| (cuboid(Vector::ONE * 0.5), place + middle)).collect();
    let segments = places.map(|place| (Shape::Segment(segment), place + Vector::X * 0.5)).collect();
    let one = vec![(cuboid(Vector { x: 400.0, y: 0.5 }), Vector::Y * -0.5)];
    vec![
        ("one box", one),
        ("tiles", tiles),
        ("segments", segments),
        ("polyline", vec![(line(230, at), Vector::ZERO)]),
    ]
}

/// Places of bodies 2 m apart.
pub fn apart(count: usize) -> Vec<Vector> {
    (0..count).map(|k| Vector { x: 2.0 * k as f32, y: 0.0 }).collect()
}

/// A random rotation about the vertical: none in 2D.
pub fn yawed(_: &mut Dice) -> Rot {
    Rot::IDENTITY
}

/// Solids about a metre wide, as hulls and as the closed polylines of their sides.
pub fn blocks() -> Vec<(&'static str, Shape, Shape)> {
    let wheel = |count: usize| {
        let corner =
            |k| Rot::from_angle(core::f32::consts::TAU * k as f32 / count as f32).rotate(Vector::X * 0.5);
        Hull::convex_hull_of(&(0..count).map(corner).collect::<Vec<_>>(), 0.0)
    };
    let box_like = |top: f32, height: f32| {
        let corners = [[-0.5, -height], [0.5, -height], [0.5 * top, height], [-0.5 * top, height]];
        Hull::convex_hull_of(&corners.map(|[x, y]| Vector { x, y }), 0.0)
    };
    let all = [
        ("square", box_like(1.0, 0.5)),
        ("plate", box_like(1.0, 0.1)),
        ("sloping sides", box_like(0.6, 0.5)),
        ("overhanging sides", box_like(1.4, 0.5)),
        ("wedge", box_like(0.0, 0.5)),
        ("few corners", wheel(6)),
        ("many corners", wheel(24)),
    ];
    all.into_iter()
        .map(|(name, hull)| {
            let hull = hull.expect("a solid");
            let count = hull.vertices().len() as u32;
            let facets = (0..count).map(|k| [k, (k + 1) % count]).collect();
            let line = Surface::new(hull.vertices().to_vec(), facets).expect("a surface");
            (name, Shape::Hull(Arc::new(hull)), Shape::surface(line))
        })
        .collect()
}

/// Solids that are not convex, with their convex hulls and their closed polylines, and a plank.
pub fn bent() -> Vec<(&'static str, Shape, Shape)> {
    let ell = [[-0.5, -0.5], [0.5, -0.5], [0.5, -0.2], [-0.2, -0.2], [-0.2, 0.5], [-0.5, 0.5]];
    let plank = [[-1.0, -0.04], [1.0, -0.04], [1.0, 0.04], [-1.0, 0.04]];
    [("ell", &ell[..]), ("plank", &plank[..])]
        .into_iter()
        .map(|(name, outline)| {
            let corners: Vec<_> = outline.iter().map(|[x, y]| Vector { x: *x, y: *y }).collect();
            let count = corners.len() as u32;
            let facets = (0..count).map(|k| [k, (k + 1) % count]).collect();
            let hull = Hull::convex_hull_of(&corners, 0.0).expect("a solid");
            let line = Surface::new(corners, facets).expect("a surface");
            (name, Shape::Hull(Arc::new(hull)), Shape::surface(line))
        })
        .collect()
}

/// The rotation of a box that has an edge ahead, and the height of its middle over the floor: a
/// half size is 0.2.
pub fn on_edge() -> (Rot, f32) {
    (Rot::from_angle(core::f32::consts::FRAC_PI_4), 0.2 * core::f32::consts::SQRT_2)
}

/// A floor on y = 0 up to x = 0 and a wall on x = 0, in segments of a size, with a seam at a height.
pub fn wall_and_floor(size: f32, seam: f32) -> Shape {
    let count = (2.0 / size) as u32;
    let floor = (0..=count).map(|k| Vector { x: size * k as f32 - 2.0, y: 0.0 });
    let wall = (0..=count).map(|k| Vector { x: 0.0, y: seam + size * k as f32 });
    let corners: Vec<_> = floor.chain(wall).collect();
    let facets = (1..corners.len() as u32).map(|k| [k - 1, k]).collect();
    Shape::surface(Surface::new(corners, facets).expect("a surface"))
}

/// Bodies that are widest at their foot.
pub fn feet() -> Vec<(&'static str, Shape)> {
    let corner = |x: f32, y: f32| Vector { x, y };
    let triangle = crate::kernel::shape::Triangle {
        a: corner(-0.2, -0.13),
        b: corner(0.2, -0.13),
        c: corner(0.0, 0.27),
    };
    let corners = [corner(-0.3, -0.2), corner(0.3, -0.2), corner(0.2, 0.2), corner(-0.2, 0.2)];
    let trapezoid = Hull::convex_hull_of(&corners, 0.0).expect("it is solid");
    let flat = [corner(-0.3, -0.05), corner(0.3, -0.05), corner(0.0, 0.05)];
    let flat = Hull::convex_hull_of(&flat, 0.0).expect("it is solid");
    vec![
        ("triangle", Shape::Triangle(triangle)),
        ("trapezoid", Shape::Hull(Arc::new(trapezoid))),
        ("flat triangle", Shape::Hull(Arc::new(flat))),
    ]
}
