//! Surfaces of height fields.

use super::grid2::Layout;
use crate::math::Vector;
use crate::shape::ShapeError;
use crate::shape::adjacency::NO_FACET;
use crate::shape::surface::Surface;

impl Surface {
    /// The line through vertices. No two vertices may be in one place.
    ///
    /// # Errors
    /// If there is no segment, or a vertex is not finite.
    pub fn line(vertices: Vec<Vector>) -> Result<Self, ShapeError> {
        if vertices.len() < 2 || vertices.len() > (NO_FACET >> 2) as usize {
            return Err(ShapeError::Degenerate);
        }
        if !vertices.iter().all(|v| v.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        let count = vertices.len() as u32 - 1;
        let facets = (0..count).map(|i| [i, i + 1]).collect();
        let after = |i: u32| if i + 1 < count { i + 1 } else { NO_FACET };
        let neighbors = (0..count).map(|i| [i.checked_sub(1).unwrap_or(NO_FACET), after(i)]).collect();
        Ok(Self { vertices, facets, neighbors, outward: 0.0, layout: Layout::Line })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Aabb;

    fn hills(count: usize) -> Vec<Vector> {
        let height = |i: usize| ((i * 7) % 11) as f32 * 0.1;
        (0..count).map(|i| Vector { x: i as f32 * 0.7, y: height(i) }).collect()
    }

    #[test]
    fn a_line_has_the_neighbors_of_its_facets() {
        for count in [2, 3, 9, 40] {
            let line = Surface::line(hills(count)).expect("a line");
            let plain = Surface::new(hills(count), line.facets.clone()).expect("a surface");
            assert_eq!(line.neighbors, plain.neighbors, "{count}");
            assert_eq!((line.outward(), plain.outward()), (0.0, 0.0));
        }
    }

    #[test]
    fn the_tree_of_a_line_finds_all_that_touches() {
        let line = Surface::line(hills(40)).expect("a line");
        let tree = line.tree();
        let all = |facet: u32| Aabb::around(line.corners(facet));
        let facets = 0..line.len() as u32;
        assert_eq!(tree.bounds(), facets.clone().fold(Aabb::EMPTY, |sum, facet| sum.union(&all(facet))));
        for facet in facets.clone() {
            let near = all(facet).grown(0.1);
            let mut found = vec![0; line.len()];
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
    fn what_is_no_line_is_an_error() {
        assert!(Surface::line(Vec::new()).is_err() && Surface::line(hills(1)).is_err());
        assert!(Surface::line(vec![Vector::ZERO, Vector::ONE * f32::NAN]).is_err());
    }
}
