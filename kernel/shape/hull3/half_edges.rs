//! The half edges of a polyhedron, each with the faces on both sides.

/// A side of a face, counter-clockwise from outside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct HalfEdge {
    pub(super) tail: u32,
    pub(super) head: u32,
    pub(super) face: u32,
    /// The face on the other side.
    pub(super) across: u32,
}

/// All half edges in ascending order.
pub(super) struct HalfEdges {
    pub(super) all: Vec<HalfEdge>,
    /// The start of each tail's half edges in `all`, followed by the total number.
    starts: Vec<u32>,
}

/// No face.
const NONE: u32 = u32::MAX;

impl HalfEdges {
    /// The half edges of faces over a number of vertices. `None` if a half edge occurs twice, or has no twin:
    /// the faces do not close a surface.
    pub(super) fn of(vertices: usize, faces: &[Vec<u32>]) -> Option<Self> {
        let mut starts = vec![0_u32; vertices + 1];
        faces.iter().flatten().for_each(|tail| starts[*tail as usize + 1] += 1);
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let none = HalfEdge { tail: 0, head: 0, face: 0, across: NONE };
        let mut all = vec![none; starts[vertices] as usize];
        let mut ends = starts.clone();
        for (f, face) in faces.iter().enumerate() {
            for (k, &tail) in face.iter().enumerate() {
                let end = &mut ends[tail as usize];
                let head = face[if k + 1 < face.len() { k + 1 } else { 0 }];
                all[*end as usize] = HalfEdge { tail, head, face: f as u32, across: NONE };
                *end += 1;
            }
        }
        let mut half_edges = Self { all, starts };
        half_edges.sort();
        if half_edges.all.windows(2).any(|w| (w[0].tail, w[0].head) == (w[1].tail, w[1].head)) {
            return None;
        }
        for i in 0..half_edges.all.len() {
            let HalfEdge { tail, head, .. } = half_edges.all[i];
            half_edges.all[i].across = half_edges.at(head, tail).filter(|_| tail != head)?.face;
        }
        Some(half_edges)
    }

    /// Sorts the half edges of each tail.
    fn sort(&mut self) {
        for range in self.starts.windows(2) {
            self.all[range[0] as usize..range[1] as usize].sort_unstable();
        }
    }

    /// The half edge between two vertices.
    #[inline]
    pub(super) fn at(&self, tail: u32, head: u32) -> Option<&HalfEdge> {
        let [start, end] = [tail, tail + 1].map(|at| self.starts[at as usize] as usize);
        let of_tail = &self.all[start..end];
        of_tail.binary_search_by_key(&head, |edge| edge.head).ok().map(|i| &of_tail[i])
    }
}
