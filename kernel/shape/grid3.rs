//! Height fields: surfaces over a grid. Neighbours and tree follow from the grid, in linear time.

use crate::math::Vector;
use crate::shape::Aabb;
use crate::shape::adjacency::NO_FACET;
use crate::shape::part_tree::{Builder, PartTree};

/// The arrangement of the facets of a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::shape) enum Layout {
    /// Not known.
    Any,
    /// Two facets for each square of a grid, given the number of squares per row and the number of rows.
    Grid([usize; 2]),
}

/// A square of a grid: its place in its row, and the number of the row.
type Square = [usize; 2];

/// The facets over a grid with the given number of squares per row and of rows, and the neighbours of each
/// facet.
pub(super) fn facets(squares: [usize; 2], is_turned: impl Fn(usize, usize) -> bool) -> [Vec<[u32; 3]>; 2] {
    let row = squares[0] + 1;
    let count = 2 * squares[0] * squares[1];
    let (mut facets, mut neighbors) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for j in 0..squares[1] {
        for i in 0..squares[0] {
            let first = first_facet(squares, [i, j]);
            // The facets beyond the sides AB, CD, AC and BD.
            let before = if j > 0 { first_facet(squares, [i, j - 1]) + 1 } else { NO_FACET };
            let after = if j + 1 < squares[1] { first_facet(squares, [i, j + 1]) } else { NO_FACET };
            let beside = |exists: bool, i: usize, of_turned: u32| {
                if !exists {
                    return NO_FACET;
                }
                first_facet(squares, [i, j]) + if is_turned(i, j) { of_turned } else { 1 - of_turned }
            };
            let left = beside(i > 0, i.wrapping_sub(1), 0);
            let right = beside(i + 1 < squares[0], i + 1, 1);
            let a = (i + j * row) as u32;
            let [b, c, d] = [a + 1, a + row as u32, a + row as u32 + 1];
            if is_turned(i, j) {
                facets.extend([[a, b, d], [a, d, c]]);
                neighbors.extend([[before, right, first + 1], [first, after, left]]);
            } else {
                facets.extend([[a, b, c], [b, d, c]]);
                neighbors.extend([[before, first + 1, left], [right, after, first]]);
            }
        }
    }
    [facets, neighbors]
}

/// The first of the two facets of a square.
fn first_facet(squares: [usize; 2], [i, j]: Square) -> u32 {
    2 * (i + j * squares[0]) as u32
}

impl Layout {
    /// The tree over the facets of a surface with this arrangement, if it is known.
    pub(in crate::shape) fn tree(self, vertices: &[Vector]) -> Option<PartTree> {
        let Self::Grid(squares) = self else { return None };
        let vertex = |[i, j]: Square| vertices[i + j * (squares[0] + 1)];
        let side = |end: Square, count: usize| (vertex(end) - vertex([0, 0])).length() / count as f32;
        let sides = [side([squares[0], 0], squares[0]), side([0, squares[1]], squares[1])];
        let mut builder = Builder::with_parts(2 * squares[0] * squares[1]);
        Halving { vertices, squares, sides }.grow(&mut builder, [[0, 0], squares]);
        Some(builder.finish())
    }
}

/// Divides a grid into halves.
struct Halving<'a> {
    vertices: &'a [Vector],
    squares: [usize; 2],
    /// The approximate sides of a square, in metres.
    sides: [f32; 2],
}

impl Halving<'_> {
    /// Adds the tree over the squares from `low` to `high`, excluding `high`. Returns its box.
    fn grow(&self, builder: &mut Builder, [low, high]: [Square; 2]) -> Aabb {
        let counts = [high[0] - low[0], high[1] - low[1]];
        if counts[0] * counts[1] <= 2 {
            return self.leaf(builder, [low, high]);
        }
        let lengths = [0, 1].map(|k: usize| counts[k] as f32 * self.sides[k]);
        let axis = usize::from(counts[0] == 1 || counts[1] > 1 && lengths[1] > lengths[0]);
        let (mut middle_high, mut middle_low) = (high, low);
        middle_high[axis] = low[axis] + counts[axis].div_ceil(2);
        middle_low[axis] = middle_high[axis];
        builder.branch(
            |builder| self.grow(builder, [low, middle_high]),
            |builder| self.grow(builder, [middle_low, high]),
        )
    }

    fn leaf(&self, builder: &mut Builder, [low, high]: [Square; 2]) -> Aabb {
        let row = self.squares[0] + 1;
        let rows = low[1]..=high[1];
        let corners = rows.flat_map(|j| &self.vertices[low[0] + j * row..=high[0] + j * row]);
        let aabb = Aabb::around(corners.copied());
        let squares = (low[1]..high[1]).flat_map(|j| (low[0]..high[0]).map(move |i| [i, j]));
        let firsts = squares.map(|square| first_facet(self.squares, square));
        builder.leaf(firsts.flat_map(|first| [first, first + 1]), aabb)
    }
}
