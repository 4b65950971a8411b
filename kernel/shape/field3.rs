//! Surfaces of height fields.

use super::grid3::{Layout, facets};
use crate::math::Vector;
use crate::shape::ShapeError;
use crate::shape::adjacency::NO_FACET;
use crate::shape::surface::Surface;

impl Surface {
    /// The surface over a grid of vertices: `vertices[i + j * row]` is vertex `i` of row `j`. With the
    /// corners (0, 0), (1, 0), (0, 1) and (1, 1) named A, B, C and D, a square has the facets ABC and BDC, or
    /// ABD and ADC if `is_turned` for its corner A. Facets are in the order of their squares, row by row.
    ///
    /// # Errors
    /// If there is no square, a row is not complete, or a vertex is not finite.
    pub fn grid(
        vertices: Vec<Vector>,
        row: usize,
        is_turned: impl Fn(usize, usize) -> bool,
    ) -> Result<Self, ShapeError> {
        let rows = vertices.len().checked_div(row).unwrap_or(0);
        if row < 2 || rows < 2 || rows * row != vertices.len() || vertices.len() > (NO_FACET >> 3) as usize {
            return Err(ShapeError::Degenerate);
        }
        if !vertices.iter().all(|v| v.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        let squares = [row - 1, rows - 1];
        let [facets, neighbors] = facets(squares, is_turned);
        Ok(Self { vertices, facets, neighbors, outward: 0.0, layout: Layout::Grid(squares) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Aabb;

    /// A grid of hills, and whether its squares are turned.
    fn hills(row: usize, rows: usize) -> (Vec<Vector>, impl Fn(usize, usize) -> bool + Copy) {
        let vertex = |i: usize, j: usize| Vector {
            x: j as f32 * 0.7,
            y: ((i * 7 + j * 5) % 11) as f32 * 0.1,
            z: i as f32 * 1.3,
        };
        let vertices = (0..rows).flat_map(|j| (0..row).map(move |i| vertex(i, j))).collect();
        (vertices, |i: usize, j: usize| (i * 3 + j * j).is_multiple_of(4))
    }

    #[test]
    fn a_grid_has_the_neighbors_of_its_facets() {
        for (row, rows) in [(2, 2), (2, 9), (9, 2), (7, 5), (16, 17)] {
            let (vertices, is_turned) = hills(row, rows);
            let grid = Surface::grid(vertices.clone(), row, is_turned).expect("a grid");
            let plain = Surface::new(vertices, grid.facets.clone()).expect("a surface");
            assert_eq!(grid.neighbors, plain.neighbors, "{row} × {rows}");
            assert_eq!((grid.outward(), plain.outward()), (0.0, 0.0));
        }
    }

    #[test]
    fn the_tree_of_a_grid_finds_all_that_touches() {
        let (vertices, is_turned) = hills(14, 9);
        let grid = Surface::grid(vertices, 14, is_turned).expect("a grid");
        let tree = grid.tree();
        let all = |facet: u32| Aabb::around(grid.corners(facet));
        let facets = 0..grid.len() as u32;
        assert_eq!(tree.bounds(), facets.clone().fold(Aabb::EMPTY, |sum, facet| sum.union(&all(facet))));
        for facet in facets.clone() {
            let near = all(facet).grown(0.1);
            let mut found = vec![0; grid.len()];
            tree.query(&near, |part| found[part as usize] += 1);
            for other in facets.clone() {
                let count = found[other as usize];
                assert!(
                    count == 1 || count == 0 && !all(other).overlaps(&near),
                    "{other} near {facet}: {count}"
                );
            }
        }
    }

    #[test]
    fn what_is_no_grid_is_an_error() {
        let (vertices, is_turned) = hills(4, 3);
        for row in [0, 1, 5, 12, 24] {
            assert!(Surface::grid(vertices.clone(), row, is_turned).is_err(), "rows of {row}");
        }
        let mut odd = vertices;
        odd[5].y = f32::NAN;
        assert!(Surface::grid(odd, 4, is_turned).is_err());
        assert!(Surface::grid(Vec::new(), 0, is_turned).is_err());
    }
}
