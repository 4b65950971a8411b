//! Height fields: surfaces of segments that follow each other. Neighbours and tree follow from that, in linear time.

use crate::math::Vector;
use crate::shape::Aabb;
use crate::shape::part_tree::{Builder, PartTree};

/// How the facets of a surface lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::shape) enum Layout {
    /// Not known.
    Any,
    /// One after the other along a line.
    Line,
}

impl Layout {
    /// The tree over the facets of a surface that lie so, if that is known.
    pub(in crate::shape) fn tree(self, vertices: &[Vector]) -> Option<PartTree> {
        if self == Self::Any {
            return None;
        }
        let mut builder = Builder::with_parts(vertices.len() - 1);
        grow(&mut builder, vertices, 0, vertices.len() - 1);
        Some(builder.finish())
    }
}

/// Adds the tree over the facets from `low` up to `high`, which is not among them. Returns its box.
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
