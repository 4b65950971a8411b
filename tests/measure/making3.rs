//! 3D parts of [`making`](super).

use super::measure::pairs::Dice;
use crate::kernel;
use kernel::math::Vector;
use kernel::shape::{Hull, Surface};

/// The vertices of a square height field of 129 × 129 heights.
pub fn field(dice: &mut Dice) -> Vec<Vector> {
    let vertex = |i: u32, y: f32| Vector { x: (i / 129) as f32, y, z: (i % 129) as f32 };
    (0..129 * 129).map(|i| vertex(i, dice.between(0.0, 1.0))).collect()
}

/// The number of its triangles.
pub const FACETS: u32 = 2 * 128 * 128;

/// Its surface.
pub fn surface_of_field(vertices: Vec<Vector>) -> Surface {
    Surface::grid(vertices, 129, |_, _| false).expect("a grid")
}

/// The hull of some points.
pub fn hull(points: &[Vector]) -> Hull {
    Hull::convex_hull_of(points).expect("a hull")
}

/// A hull of the same faces.
pub fn again(hull: &Hull) -> Hull {
    let faces = hull.faces().iter().map(|face| hull.outline(face).to_vec()).collect();
    Hull::from_mesh(hull.vertices().to_vec(), faces).expect("a hull")
}
