//! Surfaces of facets, with the neighbours of each facet.

use super::adjacency::{Borders, NO_FACET};
use super::dim::{Hull, Layout, face_normal, signed_volume};
use super::part_tree::PartTree;
use super::{Aabb, ShapeError};
use crate::math::{DIM, Vector, max, min};

/// Surfaces with more facets are not tested for being solids. A larger number makes building slower, and
/// hulls of more faces are slower than surfaces.
const MOST_FACETS_OF_SOLID: usize = 256;

/// Surfaces with more facets are not tested for being closed: they are levels, not bodies.
const MOST_FACETS_OF_BODY: usize = 1 << 16;

/// Corners within this share of a hull's size are on the hull. A larger share flattens dents; a smaller one
/// rejects surfaces that are uneven by rounding.
const ON_HULL: f32 = 1.0e-4;

/// A two-sided surface without thickness, of triangles in 3D and segments in 2D.
#[derive(Clone, Debug)]
pub struct Surface {
    pub(super) vertices: Vec<Vector>,
    pub(super) facets: Vec<[u32; DIM]>,
    /// The facet across each border of each facet, [`NO_FACET`] if there is none or more than one.
    pub(super) neighbors: Vec<[u32; DIM]>,
    /// 1 if the surface is closed and its facets face outward, -1 if they face inward, 0 otherwise.
    pub(super) outward: f32,
    /// The arrangement of its facets, if it is known.
    pub(in crate::shape) layout: Layout,
}

impl Surface {
    /// The surface of `facets`, which are indices of `vertices`. Facets that meet at equal vertices are
    /// neighbours.
    ///
    /// # Errors
    /// If there is no facet, a vertex is not finite, or an index is out of range.
    pub fn new(vertices: Vec<Vector>, facets: Vec<[u32; DIM]>) -> Result<Self, ShapeError> {
        if facets.is_empty() || facets.len() > (NO_FACET >> 2) as usize {
            return Err(ShapeError::Degenerate);
        }
        let in_range = |facet: &[u32; DIM]| facet.iter().all(|i| (*i as usize) < vertices.len());
        if !facets.iter().all(in_range) {
            return Err(ShapeError::OutOfRange);
        }
        if !vertices.iter().all(|v| v.is_finite()) {
            return Err(ShapeError::NotFinite);
        }
        let borders = Borders::new(&vertices, &facets);
        let neighbors = borders.neighbors(&facets);
        let mut surface = Self { vertices, facets, neighbors, outward: 0.0, layout: Layout::Any };
        let is_body = surface.facets.len() <= MOST_FACETS_OF_BODY && surface.is_closed();
        if is_body && borders.agree(&surface.facets) {
            surface.outward = surface.side();
        }
        Ok(surface)
    }

    /// The vertices.
    pub fn vertices(&self) -> &[Vector] {
        &self.vertices
    }

    /// The corners of a facet.
    #[inline]
    pub fn corners(&self, facet: u32) -> [Vector; DIM] {
        self.facets[facet as usize].map(|i| self.vertices[i as usize])
    }

    /// 1 if the facets face out of the volume that the surface bounds, -1 if they face into it, 0 if the
    /// surface is not closed or its facets do not agree.
    #[inline]
    pub fn outward(&self) -> f32 {
        self.outward
    }

    /// The solid that the surface bounds, if it is closed and convex. The facets may face either way.
    pub(super) fn solid(&self) -> Option<Hull> {
        if self.facets.len() > MOST_FACETS_OF_SOLID || !self.is_closed() {
            return None;
        }
        let facets = self.facets.iter().filter(|facet| !self.is_empty(facet));
        let corners: Vec<Vector> = facets.flatten().map(|i| self.vertices[*i as usize]).collect();
        let near = ON_HULL * Aabb::around(corners.iter().copied()).half().max_element();
        if !self.bulges(near) {
            return None;
        }
        let hull = Hull::around(&corners)?;
        let is_on_hull = |facet: &[Vector]| {
            hull.planes().any(|(normal, offset)| facet.iter().all(|c| (c.dot(normal) - offset).abs() <= near))
        };
        corners.chunks(DIM).all(is_on_hull).then_some(hull)
    }

    /// Whether no facet has neighbours on both sides of its plane, by more than a distance. This holds for
    /// convex surfaces, and takes much less time than making a hull.
    fn bulges(&self, near: f32) -> bool {
        (0..self.facets.len() as u32).all(|facet| {
            let corners = self.corners(facet);
            let Some(normal) = face_normal(corners) else { return true };
            let beside = self.neighbors(facet).into_iter().filter(|neighbor| *neighbor != NO_FACET);
            let heights = beside.flat_map(|n| self.corners(n)).map(|at| (at - corners[0]).dot(normal));
            let (low, high) = heights.fold((0.0, 0.0), |(low, high), h| (min(low, h), max(high, h)));
            low >= -near || high <= near
        })
    }

    /// The vertex farthest along a direction.
    pub fn farthest(&self, direction: Vector) -> Vector {
        let further = |a: Vector, b: Vector| if b.dot(direction) > a.dot(direction) { b } else { a };
        self.vertices.iter().copied().reduce(further).unwrap_or(Vector::ZERO)
    }

    /// The facets across the borders of a facet: in 3D border `k` is the side from corner `k` to the next, in
    /// 2D corner `k`.
    #[inline]
    pub fn neighbors(&self, facet: u32) -> [u32; DIM] {
        self.neighbors[facet as usize]
    }

    /// The number of facets.
    pub(super) fn len(&self) -> usize {
        self.facets.len()
    }

    /// The tree over the facets' boxes.
    pub(super) fn tree(&self) -> PartTree {
        self.layout.tree(&self.vertices).unwrap_or_else(|| {
            let boxes: Vec<Aabb> = (0..self.len() as u32).map(|i| Aabb::around(self.corners(i))).collect();
            PartTree::new(&boxes)
        })
    }

    /// The sign of the volume that the surface bounds, if it is closed.
    fn side(&self) -> f32 {
        let origin = self.vertices[self.facets[0][0] as usize];
        let volume = |facet: &[u32; DIM]| signed_volume(facet.map(|i| self.vertices[i as usize] - origin));
        let all: f64 = self.facets.iter().map(volume).sum();
        if all == 0.0 { 0.0 } else { all.signum() as f32 }
    }

    /// Whether two corners of a facet are in one place.
    fn is_empty(&self, facet: &[u32; DIM]) -> bool {
        let corners = facet.map(|i| self.vertices[i as usize]);
        (0..DIM).any(|k| corners[k] == corners[(k + 1) % DIM])
    }

    /// Whether there is a neighbour across each border. Borders of empty facets do not count.
    fn is_closed(&self) -> bool {
        let is_inner = |neighbors: &[u32; DIM]| neighbors.iter().all(|facet| *facet != NO_FACET);
        let mut all = self.facets.iter().zip(&self.neighbors);
        all.all(|(facet, neighbors)| is_inner(neighbors) || self.is_empty(facet))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(i: usize, j: usize) -> Vector {
        Vector::X * i as f32 + Vector::AXES[DIM - 1] * j as f32
    }

    /// A strip of flat facets: squares of two triangles in 3D, segments in 2D. Each facet has its own
    /// vertices.
    fn strip(count: usize) -> Surface {
        let (mut vertices, mut facets) = (Vec::new(), Vec::new());
        for i in 0..count {
            let halves = if DIM == 2 {
                vec![vec![corner(i, 0), corner(i + 1, 0)]]
            } else {
                let [a, b, c, d] = [corner(i, 0), corner(i + 1, 0), corner(i + 1, 1), corner(i, 1)];
                vec![vec![a, b, c], vec![a, c, d]]
            };
            for half in halves {
                let start = vertices.len() as u32;
                vertices.extend(half);
                facets.push(core::array::from_fn(|k| start + k as u32));
            }
        }
        Surface::new(vertices, facets).expect("a surface")
    }

    #[test]
    fn facets_at_equal_vertices_are_neighbors() {
        let surface = strip(5);
        let count = surface.facets.len() as u32;
        for facet in 0..count {
            let mut beside: Vec<u32> =
                surface.neighbors(facet).into_iter().filter(|n| *n != NO_FACET).collect();
            beside.sort_unstable();
            let shared = |other: u32| {
                let corners = surface.corners(other);
                surface.corners(facet).iter().filter(|c| corners.contains(c)).count()
            };
            let expected: Vec<u32> = (0..count).filter(|o| *o != facet && shared(*o) == DIM - 1).collect();
            assert_eq!(beside, expected, "of facet {facet}");
        }
    }

    /// Levels are exported with duplicate facets, from both sides, and with facets that have two corners in
    /// one place.
    #[test]
    fn doubled_and_empty_facets_leave_neighbors() {
        let plain = strip(5);
        let mut facets = plain.facets.clone();
        let mut turned = facets[2];
        turned.swap(0, DIM - 1);
        facets.insert(0, turned);
        facets.push(facets[4]);
        let mut empty = facets[3];
        empty[1] = empty[0];
        facets.push(empty);
        let messy = Surface::new(plain.vertices.clone(), facets).expect("a surface");
        let count = plain.facets.len() as u32;
        for facet in 0..count {
            // In the messy surface the turned facet is the first, so all others are one later.
            let known = |n: &u32| if *n == 0 { 2 } else { *n - 1 };
            let beside = messy.neighbors(facet + 1).map(|n| if n == NO_FACET { n } else { known(&n) });
            assert_eq!(beside, plain.neighbors(facet), "of facet {facet}");
        }
        let sorted = |mut list: [u32; DIM]| {
            list.sort_unstable();
            list
        };
        assert_eq!(sorted(messy.neighbors(0)), sorted(messy.neighbors(3)), "of the turned facet");
        assert_eq!(messy.neighbors(count + 1), messy.neighbors(4), "of the doubled facet");
        assert_eq!(messy.neighbors(count + 2), [NO_FACET; DIM], "of the empty facet");
    }

    #[test]
    fn what_is_no_surface_is_an_error() {
        let facet: [u32; DIM] = core::array::from_fn(|k| k as u32);
        let good: Vec<Vector> = (0..DIM).map(|i| corner(i, i)).collect();
        assert!(Surface::new(good.clone(), vec![facet]).is_ok());
        assert!(Surface::new(good.clone(), Vec::new()).is_err());
        assert!(Surface::new(good[1..].to_vec(), vec![facet]).is_err());
        let mut odd = good;
        odd[0] = Vector::ONE * f32::NAN;
        assert!(Surface::new(odd, vec![facet]).is_err());
    }
}
