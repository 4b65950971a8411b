//! Neighbouring facets of a surface: facets that meet at equal vertices.

use crate::math::{DIM, Vector};

/// No facet.
pub const NO_FACET: u32 = u32::MAX;

/// No vertex.
const NONE: u32 = u32::MAX;

/// The borders of the facets of a surface: in 3D the sides from one corner to the next, in 2D the corners.
pub(super) struct Borders {
    /// For each vertex, the first vertex at the same place.
    names: Vec<u32>,
    /// All borders, sorted.
    all: Vec<Border>,
}

/// A border of a facet.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Border {
    /// The names of both ends, in ascending order.
    names: [u32; 2],
    /// The facet, and the number of the border in it in the lowest two bits.
    at: u32,
}

impl Borders {
    /// The borders of facets given by vertex indices.
    pub(super) fn new(vertices: &[Vector], facets: &[[u32; DIM]]) -> Self {
        let names = welded(vertices);
        let all = sorted(&names, facets);
        Self { names, all }
    }

    /// The facet across each border of each facet. Facets that occur several times count as one, and facets
    /// with two corners in one place do not count.
    pub(super) fn neighbors(&self, facets: &[[u32; DIM]]) -> Vec<[u32; DIM]> {
        let Self { names, all } = self;
        let mut neighbors = vec![[NO_FACET; DIM]; facets.len()];
        if !all.windows(3).any(|same| same[0].names == same[2].names) {
            connect(all, &mut neighbors);
            return neighbors;
        }
        let first = first_equals(names, facets);
        let is_first = |border: &&Border| first[(border.at >> 2) as usize] == border.at >> 2;
        connect(&all.iter().filter(is_first).copied().collect::<Vec<_>>(), &mut neighbors);
        let is_copy = |(i, first): &(usize, u32)| *first != *i as u32 && *first != NO_FACET;
        for (i, first) in first.iter().copied().enumerate().filter(is_copy) {
            let known: [_; DIM] = core::array::from_fn(|k| ends(names, &facets[first as usize], k));
            for k in 0..DIM {
                let ends = ends(names, &facets[i], k);
                let at = known.iter().position(|known| *known == ends);
                neighbors[i][k] = at.map_or(NO_FACET, |at| neighbors[first as usize][at]);
            }
        }
        neighbors
    }

    /// Whether neighbours run through their common borders in opposite directions. Facets with two corners in
    /// one place do not count.
    pub(super) fn agree(&self, facets: &[[u32; DIM]]) -> bool {
        let Self { names, all } = self;
        // In 2D a corner is the end of one facet and the start of the next.
        let way = |border: &Border| {
            let k = (border.at & 3) as usize;
            let facet = facets[(border.at >> 2) as usize].map(|corner| names[corner as usize]);
            let is_empty = (0..DIM).any(|k| facet[k] == facet[(k + 1) % DIM]);
            let is_forward = if DIM == 2 { k == 0 } else { facet[k] < facet[(k + 1) % DIM] };
            (!is_empty).then_some(is_forward)
        };
        all.chunk_by(|a, b| a.names == b.names).all(|same| {
            let ways = || same.iter().filter_map(way);
            ways().filter(|is_forward| *is_forward).count() <= 1 && ways().filter(|is| !is).count() <= 1
        })
    }
}

/// Makes two facets neighbours if they alone share a border.
fn connect(borders: &[Border], neighbors: &mut [[u32; DIM]]) {
    for same in borders.chunk_by(|a, b| a.names == b.names) {
        if let [Border { at: a, .. }, Border { at: b, .. }] = *same
            && a >> 2 != b >> 2
        {
            neighbors[(a >> 2) as usize][(a & 3) as usize] = b >> 2;
            neighbors[(b >> 2) as usize][(b & 3) as usize] = a >> 2;
        }
    }
}

/// The names of the ends of a border, in ascending order. In 2D both are the name of the corner.
fn ends(names: &[u32], facet: &[u32; DIM], k: usize) -> [u32; 2] {
    let [a, b] = [k, (k + DIM - 2) % DIM].map(|end| names[facet[end] as usize]);
    [a.min(b), a.max(b)]
}

/// All borders in ascending order: sorted by the lower end first, which leaves few borders to be compared.
fn sorted(names: &[u32], facets: &[[u32; DIM]]) -> Vec<Border> {
    let borders = facets.iter().enumerate().flat_map(|(i, facet)| {
        (0..DIM).map(move |k| Border { names: ends(names, facet, k), at: (i as u32) << 2 | k as u32 })
    });
    let mut starts = vec![0_u32; names.len() + 1];
    borders.clone().for_each(|border| starts[border.names[0] as usize + 1] += 1);
    let mut sum = 0;
    for start in &mut starts {
        sum += *start;
        *start = sum;
    }
    let mut all = vec![Border { names: [0; 2], at: 0 }; DIM * facets.len()];
    for border in borders {
        let place = &mut starts[border.names[0] as usize];
        all[*place as usize] = border;
        *place += 1;
    }
    all.chunk_by_mut(|a, b| a.names[0] == b.names[0]).for_each(<[_]>::sort_unstable);
    all
}

/// For each facet, the first facet with the same corners; [`NO_FACET`] if two of its corners are in one
/// place.
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

/// For each vertex, the first vertex at the same place.
pub(super) fn welded(vertices: &[Vector]) -> Vec<u32> {
    // Zero and minus zero are the same place.
    let key = |v: Vector| v.to_array().map(|c| (c + 0.0).to_bits());
    // A hash table of places, at most half full.
    let mask = (2 * vertices.len()).next_power_of_two() - 1;
    let mut table = vec![NONE; mask + 1];
    let mut names = Vec::with_capacity(vertices.len());
    for (i, v) in vertices.iter().enumerate() {
        let key_of_this = key(*v);
        let mut at = hash(key_of_this) as usize & mask;
        while table[at] != NONE && key(vertices[table[at] as usize]) != key_of_this {
            at = (at + 1) & mask;
        }
        if table[at] == NONE {
            table[at] = i as u32;
        }
        names.push(table[at]);
    }
    names
}

/// Mixes all bits of a place into the lowest bits (a product folded to its halves).
fn hash(key: [u32; DIM]) -> u64 {
    key.into_iter().fold(0x9e37_79b9_7f4a_7c15, |hash: u64, part| {
        let product = u128::from(hash ^ u64::from(part)) * 0xa076_1d64_78bd_642f;
        (product ^ (product >> 64)) as u64
    })
}
