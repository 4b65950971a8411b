//! 2D parts of [`making`](super).

use super::measure::pairs::Dice;
use crate::kernel;
use kernel::math::Vector;
use kernel::shape::{Hull, Surface};

/// The vertices of a height field of 16385 heights.
pub fn field(dice: &mut Dice) -> Vec<Vector> {
    (0..=FACETS).map(|i| Vector { x: i as f32, y: dice.between(0.0, 1.0) }).collect()
}

/// The number of its segments.
pub const FACETS: u32 = 16384;

/// Its surface.
pub fn surface_of_field(vertices: Vec<Vector>) -> Surface {
    Surface::line(vertices).expect("a line")
}

/// The hull of some points.
pub fn hull(points: &[Vector]) -> Hull {
    Hull::convex_hull_of(points, 0.0).expect("a hull")
}

/// A hull of the same corners.
pub fn again(hull: &Hull) -> Hull {
    Hull::from_convex(hull.vertices(), 0.0).expect("a hull")
}
