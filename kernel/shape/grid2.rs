//! Height fields: surfaces of consecutive segments. Neighbours and tree follow from this order, in linear
//! time.

use crate::math::Vector;
use crate::shape::Aabb;
use crate::shape::part_tree::{Builder, PartTree};

/// The arrangement of the facets of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::shape) enum Layout {
    /// Not known.
    Any,
    /// One after the other along a line.
    Line,
}

impl Layout {
    /// The tree over the facets of a surface with this arrangement, if it is known.
    pub(in crate::shape) fn tree(self, vertices: &[Vector]) -> Option<PartTree> {
        if self == Self::Any {
            return None;
        }
        let mut builder = Builder::with_parts(vertices.len() - 1);
        grow(&mut builder, vertices, 0, vertices.len() - 1);
        Some(builder.finish())
    }
}

/// Adds the tree over the facets from `low` to `high`, excluding `high`. Returns its box.
fn grow(builder: &mut Builder, vertices: &[Vector], low: usize, high: usize) -> Aabb {
    if high - low <= 4 {
        let corners = vertices[low..=high].iter().copied();
        return builder.leaf(low as u32..high as u32, Aabb::around(corners));
    }
    let middle = low + (high - low).div_ceil(2);
    builder.branch(
        |builder| grow(builder, vertices, low, middle),
        |builder| grow(builder, vertices, middle, high),
    )
}
