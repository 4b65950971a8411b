//! Shapes of many convex parts: surfaces of facets, and compounds of solids.

use super::dim::{Facet, Hull, face_normal, signed_volume};
use super::part_tree::PartTree;
use super::{Aabb, ShapeError};
use crate::math::{DIM, Pose, Vector, max, min};

/// No facet.
pub const NO_FACET: u32 = u32::MAX;

/// Surfaces of more facets are not looked at as solids. More takes longer to build; and hulls of more faces are slower than surfaces.
const MOST_FACETS_OF_SOLID: usize = 256;

/// Surfaces of more facets are not looked at for whether they are closed: they are levels, not bodies.
const MOST_FACETS_OF_BODY: usize = 1 << 16;

/// Corners are on a hull up to this share of its size. More flattens dents; less leaves out what rounding makes uneven.
const ON_HULL: f32 = 1.0e-4;

/// A shape of convex parts, with a tree over them. `S` is the shape of solids.
#[derive(Clone, Debug)]
pub struct Composite<S> {
    parts: Parts<S>,
    tree: PartTree,
    /// What a closed convex surface bounds.
    solid: Option<Box<Self>>,
}

#[derive(Clone, Debug)]
enum Parts<S> {
    Surface(Surface),
    Solids(Vec<(Pose, S)>),
}

/// One part of a composite shape.
pub enum Part<'a, S> {
    /// A triangle in 3D, a segment in 2D.
    Facet(Facet),
    /// A solid, at a pose in the composite's frame.
    Solid(&'a Pose, &'a S),
}

/// A two-sided surface without thickness, of triangles in 3D and segments in 2D.
#[derive(Clone, Debug)]
pub struct Surface {
    vertices: Vec<Vector>,
    facets: Vec<[u32; DIM]>,
    /// The facet across each border of each facet, [`NO_FACET`] if there is none or more than one.
    neighbors: Vec<[u32; DIM]>,
    /// 1 if the surface is closed and its facets face outward, -1 if they face inward, else 0.
    outward: f32,
}

impl Surface {
    /// The surface of `facets`, which are indices of `vertices`. Facets that meet at equal vertices are neighbours.
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
        let neighbors = neighbors(&vertices, &facets);
        let outward = outward(&vertices, &facets, &neighbors);
        Ok(Self { vertices, facets, neighbors, outward })
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

    /// Whether its facets face out of what it bounds: 1, or -1 if they face into it; 0 if it is not closed or they do not agree.
    #[inline]
    pub fn outward(&self) -> f32 {
        self.outward
    }

    /// The solid that the surface bounds, if it is closed and convex, whichever way its facets face.
    pub(super) fn solid(&self) -> Option<Hull> {
        if self.facets.len() > MOST_FACETS_OF_SOLID
            || !is_closed(&self.vertices, &self.facets, &self.neighbors)
        {
            return None;
        }
        let facets = self.facets.iter().filter(|facet| !is_empty(&self.vertices, facet));
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

    /// Whether no facet's neighbours are on both sides of its plane, by more than a distance. This holds for convex surfaces, and takes
    /// much less time than to make a hull.
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

    /// The facets across the borders of a facet: in 3D border `k` is the side from corner `k` to the next, in 2D corner `k`.
    #[inline]
    pub fn neighbors(&self, facet: u32) -> [u32; DIM] {
        self.neighbors[facet as usize]
    }
}

/// The facet across each border of each facet. Facets that there are several times count as one, and those with two corners in one
/// place not at all.
fn neighbors(vertices: &[Vector], facets: &[[u32; DIM]]) -> Vec<[u32; DIM]> {
    let names = welded(vertices);
    let mut borders: Vec<(u64, u32)> = Vec::with_capacity(DIM * facets.len());
    for (i, facet) in facets.iter().enumerate() {
        borders.extend((0..DIM).map(|k| (border_name(&names, facet, k), (i as u32) << 2 | k as u32)));
    }
    borders.sort_unstable();
    let is_crowded = borders.windows(3).any(|same| same[0].0 == same[2].0);
    let first = if is_crowded { first_equals(&names, facets) } else { Vec::new() };
    if is_crowded {
        borders.retain(|(_, at)| first[(at >> 2) as usize] == at >> 2);
    }
    let mut all = vec![[NO_FACET; DIM]; facets.len()];
    for same in borders.chunk_by(|a, b| a.0 == b.0) {
        if let [(_, a), (_, b)] = same
            && a >> 2 != b >> 2
        {
            all[(a >> 2) as usize][(a & 3) as usize] = b >> 2;
            all[(b >> 2) as usize][(b & 3) as usize] = a >> 2;
        }
    }
    for (i, first) in
        first.into_iter().enumerate().filter(|(i, first)| *first != *i as u32 && *first != NO_FACET)
    {
        let known: [u64; DIM] = core::array::from_fn(|k| border_name(&names, &facets[first as usize], k));
        for k in 0..DIM {
            let name = border_name(&names, &facets[i], k);
            let at = known.iter().position(|known| *known == name);
            all[i][k] = at.map_or(NO_FACET, |at| all[first as usize][at]);
        }
    }
    all
}

/// See [`Surface::outward`].
fn outward(vertices: &[Vector], facets: &[[u32; DIM]], neighbors: &[[u32; DIM]]) -> f32 {
    let is_body = facets.len() <= MOST_FACETS_OF_BODY && is_closed(vertices, facets, neighbors);
    if !is_body || !agree(vertices, facets) {
        return 0.0;
    }
    let origin = vertices[facets[0][0] as usize];
    let volume = |facet: &[u32; DIM]| signed_volume(facet.map(|i| vertices[i as usize] - origin));
    let all: f64 = facets.iter().map(volume).sum();
    if all == 0.0 { 0.0 } else { all.signum() as f32 }
}

/// Whether two corners of a facet are in one place.
fn is_empty(vertices: &[Vector], facet: &[u32; DIM]) -> bool {
    let corners = facet.map(|i| vertices[i as usize]);
    (0..DIM).any(|k| corners[k] == corners[(k + 1) % DIM])
}

/// Whether there is a neighbour across each border, but for those of empty facets.
fn is_closed(vertices: &[Vector], facets: &[[u32; DIM]], neighbors: &[[u32; DIM]]) -> bool {
    let is_inner = |neighbors: &[u32; DIM]| neighbors.iter().all(|facet| *facet != NO_FACET);
    facets.iter().zip(neighbors).all(|(facet, neighbors)| is_inner(neighbors) || is_empty(vertices, facet))
}

/// Whether neighbours run through their common borders in opposite directions.
fn agree(vertices: &[Vector], facets: &[[u32; DIM]]) -> bool {
    let names = welded(vertices);
    let mut ways: Vec<[u32; 2]> = facets
        .iter()
        .filter(|facet| !is_empty(vertices, facet))
        .flat_map(|facet| {
            let names = facet.map(|i| names[i as usize]);
            (0..DIM).map(move |k| match DIM {
                2 => [names[k], k as u32],
                _ => [names[k], names[(k + 1) % DIM]],
            })
        })
        .collect();
    ways.sort_unstable();
    ways.windows(2).all(|pair| pair[0] != pair[1])
}

/// A number for the ends of a border: in 3D a side from one corner to the next, in 2D one corner.
fn border_name(names: &[u32], facet: &[u32; DIM], k: usize) -> u64 {
    let [a, b] = [k, (k + DIM - 2) % DIM].map(|end| names[facet[end] as usize]);
    u64::from(a.min(b)) << 32 | u64::from(a.max(b))
}

/// For each facet the first with the same corners; [`NO_FACET`] if two of them are in one place.
fn first_equals(names: &[u32], facets: &[[u32; DIM]]) -> Vec<u32> {
    let mut keys: Vec<([u32; DIM], u32)> = Vec::with_capacity(facets.len());
    for (i, facet) in facets.iter().enumerate() {
        let mut key = facet.map(|corner| names[corner as usize]);
        key.sort_unstable();
        keys.push((key, i as u32));
    }
    keys.sort_unstable();
    let mut first = vec![NO_FACET; facets.len()];
    for same in keys.chunk_by(|a, b| a.0 == b.0) {
        let is_flat = same[0].0.windows(2).any(|pair| pair[0] == pair[1]);
        if !is_flat {
            same.iter().for_each(|(_, i)| first[*i as usize] = same[0].1);
        }
    }
    first
}

/// The first of all vertices at the same place, for each vertex.
fn welded(vertices: &[Vector]) -> Vec<u32> {
    // Zero and minus zero are the same place.
    let key = |i: u32| vertices[i as usize].to_array().map(|c| (c + 0.0).to_bits());
    let mut order: Vec<u32> = (0..vertices.len() as u32).collect();
    order.sort_unstable_by_key(|i| (key(*i), *i));
    let mut names = vec![0; vertices.len()];
    for same in order.chunk_by(|a, b| key(*a) == key(*b)) {
        same.iter().for_each(|i| names[*i as usize] = same[0]);
    }
    names
}

impl<S> Composite<S> {
    /// A surface as a shape. If it is closed and convex, `solid` is the solid that it bounds, as the only part of a composite.
    pub fn of_surface(surface: Surface, solid: Option<Self>) -> Self {
        let boxes: Vec<Aabb> =
            (0..surface.facets.len() as u32).map(|i| Aabb::around(surface.corners(i))).collect();
        Self { tree: PartTree::new(&boxes), parts: Parts::Surface(surface), solid: solid.map(Box::new) }
    }

    /// Solids as one shape; `aabb` gives the box of each in the composite's frame.
    pub fn of_solids(solids: Vec<(Pose, S)>, aabb: impl Fn(&Pose, &S) -> Aabb) -> Self {
        let boxes: Vec<Aabb> = solids.iter().map(|(pose, solid)| aabb(pose, solid)).collect();
        Self { tree: PartTree::new(&boxes), parts: Parts::Solids(solids), solid: None }
    }

    /// The solid that a closed convex surface bounds, as the only part of a composite.
    pub fn solid(&self) -> Option<&Self> {
        self.solid.as_deref()
    }

    /// The number of parts.
    pub fn len(&self) -> usize {
        match &self.parts {
            Parts::Surface(surface) => surface.facets.len(),
            Parts::Solids(solids) => solids.len(),
        }
    }

    /// Whether there are no parts.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A part.
    #[inline]
    pub fn part(&self, index: u32) -> Part<'_, S> {
        match &self.parts {
            Parts::Surface(surface) => Part::Facet(Facet::from(surface.corners(index))),
            Parts::Solids(solids) => {
                let (pose, solid) = &solids[index as usize];
                Part::Solid(pose, solid)
            }
        }
    }

    /// The surface, if it is one.
    pub fn surface(&self) -> Option<&Surface> {
        match &self.parts {
            Parts::Surface(surface) => Some(surface),
            Parts::Solids(_) => None,
        }
    }

    /// The solids with their poses; none if it is a surface.
    pub fn solids(&self) -> &[(Pose, S)] {
        match &self.parts {
            Parts::Surface(_) => &[],
            Parts::Solids(solids) => solids,
        }
    }

    /// The tree over the parts' boxes, in the composite's frame.
    pub fn tree(&self) -> &PartTree {
        &self.tree
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn corner(i: usize, j: usize) -> Vector {
        Vector::X * i as f32 + Vector::AXES[DIM - 1] * j as f32
    }

    /// A strip of flat facets: squares of two triangles in 3D, segments in 2D. Each has its own vertices.
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

    /// Levels are exported with facets twice, from both sides, and with facets of which two corners are in one place.
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
            // In the messy surface the first is the one that was turned, so that all others are one later.
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
