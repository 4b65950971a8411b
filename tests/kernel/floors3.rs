//! Floors of pieces in 3D, and bodies that slide or roll over them.

use super::super::extreme::Dice;
use crate::kernel::math::{Pose, Rot, Vector};
use crate::kernel::shape::{Capsule, Cuboid, Curved, HalfSpace, Hull, Shape, Surface};
use core::f32::consts::FRAC_PI_2;
use std::sync::Arc;

/// A floor: its name, and its pieces with their places.
pub type Floor = (&'static str, Vec<(Shape, Vector)>);

fn cuboid(half: Vector) -> Shape {
    Shape::Cuboid(Cuboid { half })
}

fn hull(half: Vector) -> Shape {
    Shape::Hull(Arc::new(Hull::cuboid(half).expect("a box is solid")))
}

/// Flush tiles from x = -3 to 14.
fn grid(size: f32, make: impl Fn(Vector) -> Shape) -> Vec<(Shape, Vector)> {
    let mut pieces = Vec::new();
    let (columns, rows) = ((17.0 / size) as i32, (4.0 / size) as i32);
    for i in 0..columns {
        for j in 0..rows {
            let place =
                Vector { x: -3.0 + size * (i as f32 + 0.5), y: -0.5, z: size * (j as f32 + 0.5) - 2.13 };
            pieces.push((make(Vector { x: 0.5 * size, y: 0.5, z: 0.5 * size }), place));
        }
    }
    pieces
}

/// Boxes of several sizes and depths whose joints are not in line, as voxels are joined.
fn bricks() -> Vec<(Shape, Vector)> {
    let mut pieces = Vec::new();
    for row in 0..8 {
        let (mut x, mut k) = (-3.0, row);
        while x < 14.0 {
            let length = [0.5, 1.5, 1.0, 2.0, 0.5][k % 5];
            let depth = [0.5, 1.0, 1.5][k % 3];
            let z = 0.5 * row as f32 - 1.88;
            let half = Vector { x: 0.5 * length, y: 0.5 * depth, z: 0.25 };
            pieces.push((cuboid(half), Vector { x: x + half.x, y: -half.y, z }));
            (x, k) = (x + length, k + 1);
        }
    }
    pieces
}

fn compound(pieces: &[(Shape, Vector)]) -> Shape {
    let solids = pieces.iter().map(|(shape, place)| (Pose::new(*place, Rot::IDENTITY), shape.clone()));
    Shape::compound(solids.collect()).expect("boxes are solid")
}

/// Floors of flush pieces, with their top at y = 0, from x = -3 to 14.
pub fn tiles() -> Vec<Floor> {
    let boxes = grid(1.0, cuboid);
    let alone = |shape: Shape| vec![(shape, Vector::ZERO)];
    vec![
        ("one box", vec![(cuboid(Vector { x: 20.0, y: 0.5, z: 20.0 }), Vector::Y * -0.5)]),
        ("half-space", alone(Shape::HalfSpace(HalfSpace { normal: Vector::Y }))),
        ("compound", alone(compound(&boxes))),
        ("boxes", boxes),
        ("small boxes", grid(0.31, cuboid)),
        ("hulls", grid(1.0, hull)),
        ("bricks", bricks()),
        ("voxels", alone(compound(&bricks()))),
        ("mesh", alone(terrain(1.0, |_, _| 0.0))),
        ("fine mesh", alone(terrain(0.17, |_, _| 0.0))),
        ("irregular mesh", alone(irregular(0.4))),
        ("height field", alone(surface(0.5, |_, _| 0.0, |_, _| true))),
    ]
}

/// A surface over x = -3 to 14 and z = -2.13 to 1.87 of squares of two triangles, cut along either diagonal.
pub fn terrain(size: f32, height: impl Fn(f32, f32) -> f32) -> Shape {
    surface(size, height, |i, j| (i + j) % 2 == 0)
}

/// The same with a rule for which diagonal cuts a square.
fn surface(size: f32, height: impl Fn(f32, f32) -> f32, is_first: impl Fn(u32, u32) -> bool) -> Shape {
    let vertex = |i: u32, j: u32| {
        let (x, z) = (-3.0 + size * i as f32, size * j as f32 - 2.13);
        Vector { x, y: height(x, z), z }
    };
    mesh(size, vertex, is_first)
}

/// A flat mesh of triangles of any shape.
fn irregular(size: f32) -> Shape {
    let place = |i: u32, j: u32| {
        let mut dice = Dice::new(u64::from(1000 * i + j));
        let shift = Vector { x: dice.signed(), y: 0.0, z: dice.signed() } * (0.35 * size);
        Vector { x: -3.0 + size * i as f32, y: 0.0, z: size * j as f32 - 2.13 } + shift
    };
    mesh(size, place, |i, j| Dice::new(u64::from(7 * i + 31 * j)).unit() < 0.5)
}

fn mesh(size: f32, vertex: impl Fn(u32, u32) -> Vector, is_first: impl Fn(u32, u32) -> bool) -> Shape {
    let (vertices, facets) = squares([(17.0 / size) as u32 + 1, (4.0 / size) as u32 + 1], vertex, is_first);
    Shape::surface(Surface::new(vertices, facets).expect("a surface"))
}

/// Vertices and triangles of squares, each cut along either diagonal.
pub fn squares(
    [columns, rows]: [u32; 2],
    vertex: impl Fn(u32, u32) -> Vector,
    is_first: impl Fn(u32, u32) -> bool,
) -> (Vec<Vector>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    for i in 0..=columns {
        (0..=rows).for_each(|j| vertices.push(vertex(i, j)));
    }
    let mut facets = Vec::new();
    for i in 0..columns {
        for j in 0..rows {
            let at = |i: u32, j: u32| i * (rows + 1) + j;
            let [a, b, c, d] = [at(i, j), at(i, j + 1), at(i + 1, j + 1), at(i + 1, j)];
            let halves = if is_first(i, j) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
            facets.extend(halves);
        }
    }
    (vertices, facets)
}

/// Flat floors of meshes as they come from editors: in chunks, with triangles twice and from behind, with
/// triangles of which two corners are in one place, and with vertices on the sides of neighbours.
pub fn messy() -> Vec<Floor> {
    let surface = |(vertices, facets): (Vec<Vector>, Vec<[u32; 3]>)| {
        Shape::surface(Surface::new(vertices, facets).expect("a surface"))
    };
    let flat = |size: f32, counts: [u32; 2], from: [f32; 2], across: f32| {
        let at = move |i: u32, j: u32| Vector {
            x: from[0] + size * i as f32,
            y: 0.0,
            z: from[1] + across * j as f32,
        };
        squares(counts, at, |_, _| true)
    };
    let whole = || flat(0.43, [40, 10], [-3.0, -2.03], 0.43);
    let chunk = |k: i32| (surface(flat(0.25, [4, 8], [0.0, -2.03], 0.5)), Vector::X * (k as f32 - 3.0));
    let (vertices, mut twice) = whole();
    let turned: Vec<_> = twice.iter().step_by(3).map(|[a, b, c]| [*c, *b, *a]).collect();
    twice.extend(turned);
    let twice = surface((vertices, twice));
    let (vertices, mut empty) = whole();
    let flat_ones: Vec<_> = empty.iter().step_by(2).map(|[a, b, _]| [*a, *b, *b]).collect();
    empty.extend(flat_ones);
    let empty = surface((vertices, empty));
    let mut strips = (Vec::new(), Vec::new());
    for k in 0..10 {
        let size = [0.31, 0.5, 0.77, 1.0][k % 4];
        let strip = flat(size, [(17.0 / size) as u32, 1], [-3.0, 0.4 * k as f32 - 2.0], 0.4);
        let start = strips.0.len() as u32;
        strips.0.extend(strip.0);
        strips.1.extend(strip.1.iter().map(|facet: &[u32; 3]| facet.map(|i| i + start)));
    }
    vec![
        ("chunks", (0..17).map(chunk).collect()),
        ("triangles twice", vec![(twice, Vector::ZERO)]),
        ("empty triangles", vec![(empty, Vector::ZERO)]),
        ("strips", vec![(surface(strips), Vector::ZERO)]),
    ]
}

/// More shapes that slide over floors, with their rotations.
pub fn more_riders() -> Vec<(&'static str, Shape, Rot)> {
    let lying = Rot::from_axis_angle(Vector::X, FRAC_PI_2);
    let along = Rot::from_axis_angle(Vector::Z, FRAC_PI_2);
    let cylinder = Shape::Curved(Curved { lower: 0.25, upper: 0.25, half_height: 0.3 });
    let cone = Shape::Curved(Curved { lower: 0.3, upper: 0.0, half_height: 0.25 });
    let round = Hull::cuboid(Vector { x: 0.2, y: 0.2, z: 0.2 }).and_then(|h| h.rounded(0.05));
    let yaw = Rot::from_axis_angle(Vector::Y, 0.4);
    vec![
        ("cylinder lying across", cylinder.clone(), lying),
        ("cylinder lying along", cylinder, along),
        ("cone", cone, Rot::IDENTITY),
        ("round box", Shape::Hull(Arc::new(round.expect("good sizes"))), Rot::IDENTITY),
        ("turned box", cuboid(Vector { x: 0.25, y: 0.25, z: 0.25 }), yaw),
    ]
}

/// Shapes that roll along x, with their rotations and radii.
pub fn rollers() -> Vec<(&'static str, Shape, Rot, f32)> {
    let lying = Rot::from_axis_angle(Vector::X, FRAC_PI_2);
    let across = Vector::Z * 0.3;
    let cylinder = Shape::Curved(Curved { lower: 0.25, upper: 0.25, half_height: 0.3 });
    vec![
        ("ball", Shape::Ball(crate::kernel::shape::Ball { radius: 0.25 }), Rot::IDENTITY, 0.25),
        ("capsule", Shape::Capsule(Capsule { a: -across, b: across, radius: 0.2 }), Rot::IDENTITY, 0.2),
        ("cylinder", cylinder, lying, 0.25),
    ]
}

/// The rotation about the vertical that turns x to a level direction.
pub fn heading(direction: Vector) -> Rot {
    let half = (0.5 * (1.0 + direction.x)).sqrt();
    Rot { x: 0.0, y: -0.5 * direction.z / half, z: 0.0, w: half }
}

/// The angular velocity of what rolls in a level direction.
pub fn roll(direction: Vector, rate: f32) -> Vector {
    Vector { x: direction.z, y: 0.0, z: -direction.x } * rate
}

/// Larger floors for a hundred bodies [`apart`], which move by up to 25 m along x.
pub fn laid() -> Vec<Floor> {
    let (columns, rows) = (48, 24);
    let at = |i: u32, j: u32| Vector { x: i as f32 - 2.13, y: 0.0, z: j as f32 - 2.29 };
    let middle = Vector { x: 0.5, y: -0.5, z: 0.5 };
    let tiles = (0..columns * rows).map(|k| (cuboid(Vector::ONE * 0.5), at(k / rows, k % rows) + middle));
    let vertices = (0..=columns).flat_map(|i| (0..=rows).map(move |j| at(i, j))).collect();
    let facets = (0..columns * rows).flat_map(|k| {
        let corner = |i: u32, j: u32| (k / rows + i) * (rows + 1) + k % rows + j;
        let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 1), corner(1, 0)];
        [[a, b, c], [a, c, d]]
    });
    let mesh = Shape::surface(Surface::new(vertices, facets.collect()).expect("a surface"));
    let one = vec![(cuboid(Vector { x: 100.0, y: 0.5, z: 100.0 }), Vector::Y * -0.5)];
    vec![("one box", one), ("tiles", tiles.collect()), ("mesh", vec![(mesh, Vector::ZERO)])]
}

/// Places of bodies 2 m apart.
pub fn apart(count: usize) -> Vec<Vector> {
    (0..count).map(|k| Vector { x: (k / 10) as f32, y: 0.0, z: (k % 10) as f32 } * 2.0).collect()
}

/// A random rotation about the vertical.
pub fn yawed(dice: &mut Dice) -> Rot {
    Rot::from_axis_angle(Vector::Y, 4.0 * dice.signed())
}

/// Solids about a metre wide, as hulls and as the closed meshes of their faces.
pub fn blocks() -> Vec<(&'static str, Shape, Shape)> {
    let sphere = |count: usize| {
        let golden = 2.399_963_2f32;
        let points = (0..count).map(|k| {
            let y = 1.0 - 2.0 * (k as f32 + 0.5) / count as f32;
            let (sin, cos) = (golden * k as f32).sin_cos();
            let r = (1.0 - y * y).sqrt();
            Vector { x: r * cos, y, z: r * sin } * 0.5
        });
        Hull::convex_hull_of(&points.collect::<Vec<_>>())
    };
    let box_like = |top: f32| {
        let corner = |k: u32| {
            let sign = |bit: u32| if k >> bit & 1 == 0 { -0.5 } else { 0.5 };
            let width = if k & 2 == 0 { 1.0 } else { top };
            Vector { x: sign(0) * width, y: sign(1), z: sign(2) * width }
        };
        Hull::convex_hull_of(&(0..8).map(corner).collect::<Vec<_>>())
    };
    let all = [
        ("cube", Hull::cuboid(Vector::ONE * 0.5)),
        ("plate", Hull::cuboid(Vector { x: 0.5, y: 0.1, z: 0.5 })),
        ("sloping sides", box_like(0.6)),
        ("overhanging sides", box_like(1.4)),
        ("wedge", box_like(0.0)),
        ("few corners", sphere(20)),
        ("many corners", sphere(80)),
    ];
    all.into_iter()
        .map(|(name, hull)| {
            let hull = hull.expect("a solid");
            let fan = |face| {
                let outline: &[u32] = hull.outline(face);
                outline[1..].windows(2).map(|pair| [outline[0], pair[0], pair[1]]).collect::<Vec<_>>()
            };
            let facets = hull.faces().iter().flat_map(fan).collect();
            let mesh = Surface::new(hull.vertices().to_vec(), facets).expect("a surface");
            (name, Shape::Hull(Arc::new(hull)), Shape::surface(mesh))
        })
        .collect()
}

/// Solids that are not convex, with their convex hulls and their closed meshes, and a plank.
pub fn bent() -> Vec<(&'static str, Shape, Shape)> {
    let ell = [[-0.5, -0.5], [0.5, -0.5], [0.5, -0.2], [-0.2, -0.2], [-0.2, 0.5], [-0.5, 0.5]];
    let plank = [[-1.0, -0.04], [1.0, -0.04], [1.0, 0.04], [-1.0, 0.04]];
    [("ell", &ell[..], 3, 0.3), ("plank", &plank[..], 0, 0.2)]
        .into_iter()
        .map(|(name, outline, middle, half)| {
            let count = outline.len() as u32;
            let ring = |z: f32| outline.iter().map(move |[x, y]| Vector { x: *x, y: *y, z });
            let corners: Vec<_> = ring(-half).chain(ring(half)).collect();
            let sides = (0..count).flat_map(|k| {
                let next = (k + 1) % count;
                [[k, next, next + count], [k, next + count, k + count]]
            });
            let caps = (1..count - 1).flat_map(|k| {
                let [a, b] = [(middle + k) % count, (middle + k + 1) % count];
                [[middle, b, a], [middle + count, a + count, b + count]]
            });
            let facets = sides.chain(caps).collect();
            let hull = Hull::convex_hull_of(&corners).expect("a solid");
            let mesh = Surface::new(corners, facets).expect("a surface");
            (name, Shape::Hull(Arc::new(hull)), Shape::surface(mesh))
        })
        .collect()
}

/// The rotation of a box that has an edge ahead, and the height of its middle over the floor: a
/// half size is 0.2.
pub fn on_edge() -> (Rot, f32) {
    (Rot::from_axis_angle(Vector::Y, 0.5 * FRAC_PI_2), 0.2)
}

/// A floor on y = 0 up to x = 0 and a wall on x = 0, in squares of a size, with a seam at z = 0.
pub fn wall_and_floor(size: f32, _seam: f32) -> Shape {
    let count = (2.0 / size) as u32;
    let floor = (0..=count).map(|k| Vector { x: size * k as f32 - 2.0, y: 0.0, z: 0.0 });
    let wall = (1..=count).map(|k| Vector { x: 0.0, y: size * k as f32, z: 0.0 });
    let profile: Vec<_> = floor.chain(wall).collect();
    let (rows, columns) = (profile.len() as u32 - 1, 2 * count);
    let across = |k: u32| Vector::Z * (size * k as f32 - 2.0);
    let corners = profile.iter().flat_map(|at| (0..=columns).map(move |k| *at + across(k))).collect();
    let facets = (0..rows * columns).flat_map(|k| {
        let corner = |i: u32, j: u32| (k / columns + i) * (columns + 1) + k % columns + j;
        let [a, b, c, d] = [corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)];
        [[a, b, d], [a, d, c]]
    });
    Shape::surface(Surface::new(corners, facets.collect()).expect("a surface"))
}

/// Bodies that are widest at their foot.
pub fn feet() -> Vec<(&'static str, Shape)> {
    let corner = |x: f32, y: f32, z: f32| Vector { x, y, z };
    let square =
        [corner(-0.3, -0.2, -0.3), corner(-0.3, -0.2, 0.3), corner(0.3, -0.2, 0.3), corner(0.3, -0.2, -0.3)];
    let hull = |points: &[Vector]| Shape::Hull(Arc::new(Hull::convex_hull_of(points).expect("it is solid")));
    let top = square.map(|p| corner(0.6 * p.x, 0.2, 0.6 * p.z));
    vec![
        ("pyramid", hull(&[&square[..], &[corner(0.0, 0.4, 0.0)]].concat())),
        ("frustum", hull(&[square, top].concat())),
        ("cone", Shape::Curved(Curved { lower: 0.3, upper: 0.0, half_height: 0.25 })),
        ("flat cone", Shape::Curved(Curved { lower: 0.3, upper: 0.0, half_height: 0.05 })),
    ]
}
