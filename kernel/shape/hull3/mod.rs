//! The convex polyhedron: vertices, polygonal faces, and edges with their adjacent faces.

mod half_edges;
mod mass;
mod mesh;
mod quickhull;
mod rounded;
#[cfg(test)]
mod tests;
mod wide;

use self::half_edges::HalfEdges;
use super::MassProperties;
use crate::math::{F32x4, Lane, Num, Rot, Vector, max, min};
use crate::shape::primitives::{direction_or, hit_of_stretch};
use crate::shape::{Aabb, RayHit, ShapeError};

/// A face of a hull: its plane and the range of its vertices in the list of loops.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Face {
    /// The outward unit normal.
    pub normal: Vector,
    /// The signed distance from the origin to the plane along the normal, in metres.
    pub offset: f32,
    /// The start of the face's loop.
    pub(crate) first: u32,
    /// The number of vertices of the loop.
    pub(crate) count: u32,
}

/// An edge of a hull. Seen from outside, it runs counter-clockwise around the `left` face.
///
/// On the Gauss map (each face is a point of the unit sphere, its normal) the edge is the arc from the left
/// normal to the right normal, a turn about the direction of the edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    /// The vertex at its start.
    pub tail: u32,
    /// The vertex at its end.
    pub head: u32,
    /// The face around which it runs counter-clockwise.
    pub left: u32,
    /// The face on its other side.
    pub right: u32,
}

/// Four edges side by side, for the wide search over pairs of edges.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeBlock {
    /// The unit direction from tail to head.
    pub direction: Vector<F32x4>,
    /// The normal of the left face.
    pub left: Vector<F32x4>,
    /// The normal of the right face.
    pub right: Vector<F32x4>,
    /// The vertex at its start.
    pub tail: Vector<F32x4>,
}

/// Four faces side by side, for the search for the face with the largest separation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FaceBlock {
    /// The outward unit normal.
    pub normal: Vector<F32x4>,
    /// The signed distance from the origin to the plane along the normal.
    pub offset: F32x4,
}

/// A convex polyhedron, or all points within a radius of it.
///
/// Immutable. Vertices, faces and edges are stored twice: single, and four side by side for the searches of
/// the narrow phase.
#[derive(Clone, Debug)]
pub struct Hull {
    vertices: Vec<Vector>,
    blocks: Vec<Vector<F32x4>>,
    faces: Vec<Face>,
    loops: Vec<u32>,
    edges: Vec<Edge>,
    edge_blocks: Vec<EdgeBlock>,
    face_blocks: Vec<FaceBlock>,
    fans: Vec<u32>,
    fan_starts: Vec<u32>,
    unit_mass: MassProperties,
    centroid: Vector,
    extent: f32,
    radius: f32,
}

impl PartialEq for Hull {
    fn eq(&self, other: &Self) -> bool {
        self.vertices == other.vertices
            && self.faces == other.faces
            && self.loops == other.loops
            && self.radius == other.radius
    }
}

/// Packs vectors four side by side. The last vector is repeated to fill the last block.
pub(crate) fn pack(values: &[Vector]) -> impl Iterator<Item = Vector<F32x4>> + '_ {
    values.chunks(4).map(|chunk| {
        let mut block = Vector::<F32x4>::splat(chunk[0]);
        for lane in 1..4 {
            block.set(lane, chunk[lane.min(chunk.len() - 1)]);
        }
        block
    })
}

/// The index of the vector farthest along `direction`, at a tie the lowest index, and its distance.
#[inline(always)]
pub(crate) fn farthest(blocks: &[Vector<F32x4>], direction: Vector) -> (usize, f32) {
    let d = Vector::<F32x4>::splat(direction);
    let mut best = blocks[0].dot(d);
    let mut at = F32x4::ZERO;
    let mut number = F32x4::ZERO;
    for block in &blocks[1..] {
        number += F32x4::ONE;
        let value = block.dot(d);
        let better = best.lt(value);
        best = F32x4::select(better, value, best);
        at = F32x4::select(better, number, at);
    }
    largest(best, at)
}

/// The largest of some values and its index, given the largest value of each lane and its index. It has no
/// branches, which would be mispredicted.
#[inline(always)]
pub(crate) fn largest(best: F32x4, at: F32x4) -> (usize, f32) {
    const LANES: F32x4 = F32x4::new([0.0, 1.0, 2.0, 3.0]);
    const NONE: f32 = 1.0e9;
    let value = max(max(best.get(0), best.get(1)), max(best.get(2), best.get(3)));
    let number = at * F32x4::splat(4.0) + LANES;
    let number = F32x4::select(best.eq(F32x4::splat(value)), number, F32x4::splat(NONE));
    let least = min(min(number.get(0), number.get(1)), min(number.get(2), number.get(3)));
    (least as usize, value)
}

impl Hull {
    /// The box with the given half extents, in metres; they must be positive.
    pub fn cuboid(half: Vector) -> Result<Self, ShapeError> {
        if !half.is_finite() {
            return Err(ShapeError::NotFinite);
        }
        if half.min_element() < 0.0 {
            return Err(ShapeError::Negative);
        }
        let sign = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
        let corner = |i: usize| Vector { x: sign(i & 1), y: sign(i & 2), z: sign(i & 4) }.scale(half);
        let faces = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
        Self::from_mesh((0..8).map(corner).collect(), faces.iter().map(|f| f.to_vec()).collect())
    }

    /// Makes a hull from valid parts: each face is a loop of vertices.
    fn assemble(
        vertices: Vec<Vector>,
        planes: &[(Vector, f32)],
        outlines: &[Vec<u32>],
        half_edges: &HalfEdges,
    ) -> Self {
        let mut faces = Vec::with_capacity(planes.len());
        let mut loops = Vec::with_capacity(half_edges.all.len());
        for (outline, (normal, offset)) in outlines.iter().zip(planes) {
            let first = loops.len() as u32;
            faces.push(Face { normal: *normal, offset: *offset, first, count: outline.len() as u32 });
            loops.extend_from_slice(outline);
        }
        let half_edges = half_edges.all.iter().filter(|edge| edge.tail < edge.head);
        let edges: Vec<Edge> = half_edges
            .map(|edge| Edge { tail: edge.tail, head: edge.head, left: edge.face, right: edge.across })
            .collect();
        let (fans, fan_starts) = fans(vertices.len(), outlines);
        let unit_mass = mass::of_polyhedron(&vertices, outlines);
        let extent = vertices.iter().map(|v| (*v - unit_mass.center).length_squared()).fold(0.0, max).sqrt();
        Self {
            blocks: pack(&vertices).collect(),
            edge_blocks: edge_blocks(&vertices, &faces, &edges),
            face_blocks: face_blocks(&faces),
            fans,
            fan_starts,
            vertices,
            faces,
            loops,
            edges,
            unit_mass,
            centroid: unit_mass.center,
            extent,
            radius: 0.0,
        }
    }

    /// The corners, in the hull's frame, in metres.
    pub fn vertices(&self) -> &[Vector] {
        &self.vertices
    }

    /// The radius around the polyhedron, in metres.
    pub fn radius(&self) -> f32 {
        self.radius
    }

    /// The faces.
    pub fn faces(&self) -> &[Face] {
        &self.faces
    }

    /// The planes of the faces: normals and distances from the origin.
    pub fn planes(&self) -> impl Iterator<Item = (Vector, f32)> + '_ {
        self.faces.iter().map(|face| (face.normal, face.offset))
    }

    /// The vertices of a face, as indices, counter-clockwise from outside.
    pub fn outline(&self, face: &Face) -> &[u32] {
        &self.loops[face.first as usize..(face.first + face.count) as usize]
    }

    /// The edges, each once.
    pub fn edges(&self) -> &[Edge] {
        &self.edges
    }

    /// The largest ball around the centroid within the polyhedron: its centre and radius.
    pub fn core(&self) -> (Vector, f32) {
        let center = self.centroid();
        let depths = self.faces().iter().map(|face| face.offset - face.normal.dot(center));
        (center, max(depths.fold(f32::INFINITY, min), 0.0) + self.radius())
    }

    /// The centre of mass of the polyhedron at uniform density, without its radius.
    pub fn centroid(&self) -> Vector {
        self.centroid
    }

    /// The distance from the centroid to the farthest vertex, in metres.
    pub(crate) fn reach(&self) -> f32 {
        self.extent
    }

    /// The vertices of all faces, one face after another.
    pub(crate) fn loops(&self) -> &[u32] {
        &self.loops
    }

    /// The vertices four side by side.
    pub(crate) fn blocks(&self) -> &[Vector<F32x4>] {
        &self.blocks
    }

    /// The edges four side by side. The last edge is repeated to fill the last block.
    pub(crate) fn edge_blocks(&self) -> &[EdgeBlock] {
        &self.edge_blocks
    }

    /// The faces four side by side. The last face is repeated to fill the last block.
    pub(crate) fn face_blocks(&self) -> &[FaceBlock] {
        &self.face_blocks
    }

    /// The faces around each vertex, one vertex after another, and the index of each vertex' first face.
    pub(crate) fn fans(&self) -> (&[u32], &[u32]) {
        (&self.fans, &self.fan_starts)
    }

    /// Whether a point is in the polyhedron, at least `depth` of the face's normal below each face.
    pub fn contains(&self, point: Vector, depth: impl Fn(Vector) -> f32) -> bool {
        self.faces.iter().all(|face| point.dot(face.normal) <= face.offset - depth(face.normal))
    }

    /// The box around the polyhedron turned by `rotation`, radius included.
    pub fn local_aabb(&self, rotation: Rot) -> Aabb {
        let turn = Rot::<F32x4>::splat(rotation);
        let mut low = Vector::<F32x4>::splat(Vector::ONE * f32::INFINITY);
        let mut high = -low;
        for block in &self.blocks {
            let at = turn.rotate(*block);
            low = Vector { x: low.x.min(at.x), y: low.y.min(at.y), z: low.z.min(at.z) };
            high = Vector { x: high.x.max(at.x), y: high.y.max(at.y), z: high.z.max(at.z) };
        }
        let corners = |v: Vector<F32x4>| [0, 1, 2, 3].map(|lane| v.get(lane));
        Aabb::around(corners(low).into_iter().chain(corners(high))).grown(self.radius)
    }

    /// The point farthest along `direction` (any length), radius included.
    pub fn support(&self, direction: Vector) -> Vector {
        let vertex = self.vertices[farthest(&self.blocks, direction).0.min(self.vertices.len() - 1)];
        if self.radius == 0.0 {
            return vertex;
        }
        vertex + direction_or(direction, Vector::X) * self.radius
    }

    /// Mass, centre and inertia at 1 kg/m³.
    pub fn unit_mass(&self) -> MassProperties {
        self.unit_mass
    }

    /// The first hit of a ray along the unit vector `direction` on the hull; see
    /// [`Shape::cast_ray`](crate::shape::Shape::cast_ray).
    ///
    /// The ray is clipped by the plane of each face. The last entry and the first exit bound the range inside
    /// (Cyrus and Beck, 1978).
    pub fn cast_ray(
        &self,
        origin: Vector,
        direction: Vector,
        max_distance: f32,
        solid: bool,
    ) -> Option<RayHit> {
        if self.radius > 0.0 {
            return self.cast_ray_rounded(origin, direction, max_distance, solid);
        }
        let (from, along) = (Vector::<F32x4>::splat(origin), Vector::<F32x4>::splat(direction));
        let (mut enter, mut exit) = (F32x4::splat(f32::NEG_INFINITY), F32x4::splat(f32::INFINITY));
        let (mut enter_at, mut exit_at, mut number) = (F32x4::ZERO, F32x4::ZERO, F32x4::ZERO);
        for block in &self.face_blocks {
            let height = block.normal.dot(from) - block.offset;
            let slope = block.normal.dot(along);
            if F32x4::any(F32x4::and(slope.eq(F32x4::ZERO), F32x4::ZERO.lt(height))) {
                return None;
            }
            let at = -height / slope;
            let enters = F32x4::and(slope.lt(F32x4::ZERO), enter.lt(at));
            let leaves = F32x4::and(F32x4::ZERO.lt(slope), at.lt(exit));
            (enter, enter_at) = (F32x4::select(enters, at, enter), F32x4::select(enters, number, enter_at));
            (exit, exit_at) = (F32x4::select(leaves, at, exit), F32x4::select(leaves, number, exit_at));
            number += F32x4::ONE;
        }
        let (first, enter) = largest(enter, enter_at);
        let (last, exit) = largest(-exit, exit_at);
        let normal_of = |face: usize| self.faces[face.min(self.faces.len() - 1)].normal;
        let normal_at = |entering: bool, _| normal_of(if entering { first } else { last });
        hit_of_stretch((enter, -exit), max_distance, solid, normal_at)
    }

    /// A ball around the shape: its centre and its radius in metres.
    pub(crate) fn ball_around(&self) -> (Vector, f32) {
        (self.centroid, self.extent + self.radius)
    }
}

/// Packs edges four side by side with the normals of their faces.
fn edge_blocks(vertices: &[Vector], faces: &[Face], edges: &[Edge]) -> Vec<EdgeBlock> {
    let column = |f: &dyn Fn(&Edge) -> Vector| {
        let values: Vec<Vector> = edges.iter().map(f).collect();
        pack(&values).collect::<Vec<_>>()
    };
    let direction = column(&|e| {
        let d = vertices[e.head as usize] - vertices[e.tail as usize];
        // Scaled first, since the square of a short edge may be subnormal.
        let scale = d.abs().max_element();
        let d = d * (1.0 / max(scale, f32::MIN_POSITIVE));
        d * (1.0 / max(d.length(), f32::MIN_POSITIVE))
    });
    let left = column(&|e| faces[e.left as usize].normal);
    let right = column(&|e| faces[e.right as usize].normal);
    let tail = column(&|e| vertices[e.tail as usize]);
    (0..direction.len())
        .map(|i| EdgeBlock { direction: direction[i], left: left[i], right: right[i], tail: tail[i] })
        .collect()
}

/// Packs faces four side by side.
fn face_blocks(faces: &[Face]) -> Vec<FaceBlock> {
    let normals: Vec<Vector> = faces.iter().map(|f| f.normal).collect();
    let offsets = faces.chunks(4).map(|chunk| {
        let mut block = F32x4::splat(chunk[0].offset);
        for lane in 1..4 {
            block.set(lane, chunk[lane.min(chunk.len() - 1)].offset);
        }
        block
    });
    pack(&normals).zip(offsets).map(|(normal, offset)| FaceBlock { normal, offset }).collect()
}

/// The faces around each vertex, and the index of each vertex' first face, followed by the total number.
fn fans(vertices: usize, outlines: &[Vec<u32>]) -> (Vec<u32>, Vec<u32>) {
    let mut starts = vec![0; vertices + 1];
    outlines.iter().flatten().for_each(|v| starts[*v as usize + 1] += 1);
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let (mut fans, mut ends) = (vec![0; starts[vertices] as usize], starts.clone());
    for (face, outline) in outlines.iter().enumerate() {
        for v in outline {
            let end = &mut ends[*v as usize];
            fans[*end as usize] = face as u32;
            *end += 1;
        }
    }
    (fans, starts)
}

/// The largest extent of some points along an axis; 0 without points.
fn size_of(points: &[Vector]) -> f32 {
    let Some(first) = points.first() else { return 0.0 };
    let low = points.iter().fold(*first, |m, p| m.min(*p)).to_array();
    let high = points.iter().fold(*first, |m, p| m.max(*p)).to_array();
    (0..3).fold(0.0, |size, i| max(size, min(high[i] - low[i], f32::MAX)))
}
