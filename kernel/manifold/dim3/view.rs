//! A view of every polyhedral core: hulls by reference; boxes, triangles, segments and points as scaled
//! copies on the stack. The same code collides all of them.

use crate::math::{F32x4, Lane, Num, Pose, Vector, max};
use crate::shape::{Edge, EdgeBlock, Face, FaceBlock, Hull, Shape, farthest};

/// The convex polyhedron, possibly flat, that a shape is without its radius.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub vertices: &'a [Vector],
    pub blocks: &'a [Vector<F32x4>],
    pub faces: &'a [Face],
    pub loops: &'a [u32],
    pub edges: &'a [Edge],
    pub edge_blocks: &'a [EdgeBlock],
    pub face_blocks: &'a [FaceBlock],
    /// The faces around each vertex, one vertex after another. Then the index of each vertex' first face in
    /// this list, and the length of the list.
    pub fans: (&'a [u32], &'a [u32]),
    /// A point inside.
    pub center: Vector,
    /// The approximate distance from the centre to the farthest vertex.
    pub extent: f32,
    /// The radius of the surface around the polyhedron.
    pub radius: f32,
}

impl View<'_> {
    /// The vertex farthest along a direction, and its distance.
    #[inline(always)]
    pub fn farthest(&self, direction: Vector) -> (usize, f32) {
        let (index, value) = farthest(self.blocks, direction);
        (index.min(self.vertices.len() - 1), value)
    }

    /// The index of the vertex farthest along a direction.
    #[inline]
    pub fn support(&self, direction: Vector) -> usize {
        self.farthest(direction).0
    }

    /// The faces around a vertex.
    #[inline]
    pub fn fan(&self, vertex: usize) -> &[u32] {
        let (faces, starts) = self.fans;
        &faces[starts[vertex] as usize..starts[vertex + 1] as usize]
    }

    /// The number of vertices of a face, or of all if there is none.
    #[inline]
    pub fn corners_of(&self, face: Option<usize>) -> usize {
        face.map_or(self.vertices.len(), |face| self.faces[face].count as usize)
    }

    /// The vertices of a face, counter-clockwise.
    #[inline]
    pub fn outline(&self, face: usize) -> &[u32] {
        let f = &self.faces[face];
        &self.loops[f.first as usize..(f.first + f.count) as usize]
    }
}

impl<'a> From<&'a Hull> for View<'a> {
    fn from(hull: &'a Hull) -> Self {
        Self {
            vertices: hull.vertices(),
            blocks: hull.blocks(),
            faces: hull.faces(),
            loops: hull.loops(),
            edges: hull.edges(),
            edge_blocks: hull.edge_blocks(),
            face_blocks: hull.face_blocks(),
            fans: hull.fans(),
            center: hull.centroid(),
            extent: hull.reach() + hull.radius(),
            radius: hull.radius(),
        }
    }
}

const fn edge(tail: u32, head: u32, left: u32, right: u32) -> Edge {
    Edge { tail, head, left, right }
}

/// Bit k of a corner's index is its side of axis k; face 2k is the lower face of axis k.
const CUBE_LOOPS: [u32; 24] = [0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4, 2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6];
const CUBE_EDGES: [Edge; 12] = [
    edge(0, 1, 2, 4),
    edge(2, 3, 4, 3),
    edge(4, 5, 5, 2),
    edge(6, 7, 3, 5),
    edge(0, 2, 4, 0),
    edge(1, 3, 1, 4),
    edge(4, 6, 0, 5),
    edge(5, 7, 5, 1),
    edge(0, 4, 0, 2),
    edge(1, 5, 2, 1),
    edge(2, 6, 3, 0),
    edge(3, 7, 1, 3),
];
const CUBE_FANS: [u32; 24] = [0, 2, 4, 1, 2, 4, 0, 3, 4, 1, 3, 4, 0, 2, 5, 1, 2, 5, 0, 3, 5, 1, 3, 5];
const CUBE_FAN_STARTS: [u32; 9] = [0, 3, 6, 9, 12, 15, 18, 21, 24];

/// Vectors four side by side.
const fn wide(x: [f32; 4], y: [f32; 4], z: [f32; 4]) -> Vector<F32x4> {
    Vector { x: F32x4::new(x), y: F32x4::new(y), z: F32x4::new(z) }
}

/// Four vectors side by side.
#[inline(always)]
pub(super) fn four(v: [Vector; 4]) -> Vector<F32x4> {
    wide(v.map(|v| v.x), v.map(|v| v.y), v.map(|v| v.z))
}

/// The corners of the box of half extents 1.
const CUBE_CORNERS: [Vector<F32x4>; 2] = [
    wide([-1.0, 1.0, -1.0, 1.0], [-1.0, -1.0, 1.0, 1.0], [-1.0, -1.0, -1.0, -1.0]),
    wide([-1.0, 1.0, -1.0, 1.0], [-1.0, -1.0, 1.0, 1.0], [1.0, 1.0, 1.0, 1.0]),
];
/// The face normals of this box.
const CUBE_NORMALS: [Vector<F32x4>; 2] = [
    wide([-1.0, 1.0, 0.0, 0.0], [0.0, 0.0, -1.0, 1.0], [0.0, 0.0, 0.0, 0.0]),
    wide([0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [-1.0, 1.0, 1.0, 1.0]),
];
/// The edges of this box: four along each axis.
const CUBE_EDGE_BLOCKS: [EdgeBlock; 3] = [
    EdgeBlock {
        direction: wide([1.0, 1.0, 1.0, 1.0], [0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0]),
        left: wide([0.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 1.0], [0.0, -1.0, 1.0, 0.0]),
        right: wide([0.0, 0.0, 0.0, 0.0], [0.0, 1.0, -1.0, 0.0], [-1.0, 0.0, 0.0, 1.0]),
        tail: wide([-1.0, -1.0, -1.0, -1.0], [-1.0, 1.0, -1.0, 1.0], [-1.0, -1.0, 1.0, 1.0]),
    },
    EdgeBlock {
        direction: wide([0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0], [0.0, 0.0, 0.0, 0.0]),
        left: wide([0.0, 1.0, -1.0, 0.0], [0.0, 0.0, 0.0, 0.0], [-1.0, 0.0, 0.0, 1.0]),
        right: wide([-1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0], [0.0, -1.0, 1.0, 0.0]),
        tail: wide([-1.0, 1.0, -1.0, 1.0], [-1.0, -1.0, -1.0, -1.0], [-1.0, -1.0, 1.0, 1.0]),
    },
    EdgeBlock {
        direction: wide([0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0]),
        left: wide([-1.0, 0.0, 0.0, 1.0], [0.0, -1.0, 1.0, 0.0], [0.0, 0.0, 0.0, 0.0]),
        right: wide([0.0, 1.0, -1.0, 0.0], [-1.0, 0.0, 0.0, 1.0], [0.0, 0.0, 0.0, 0.0]),
        tail: wide([-1.0, 1.0, -1.0, 1.0], [-1.0, -1.0, 1.0, 1.0], [-1.0, -1.0, -1.0, -1.0]),
    },
];
const TRIANGLE_FANS: [u32; 6] = [0, 1, 0, 1, 0, 1];
const TRIANGLE_FAN_STARTS: [u32; 4] = [0, 2, 4, 6];
const TRIANGLE_LOOPS: [u32; 6] = [0, 1, 2, 0, 2, 1];
const TRIANGLE_EDGES: [Edge; 3] = [edge(0, 1, 0, 1), edge(1, 2, 0, 1), edge(2, 0, 0, 1)];
const SEGMENT_EDGES: [Edge; 3] = [edge(0, 1, 0, 1), edge(0, 1, 1, 2), edge(0, 1, 2, 0)];
const EMPTY_EDGES: EdgeBlock =
    EdgeBlock { direction: Vector::ZERO, left: Vector::ZERO, right: Vector::ZERO, tail: Vector::ZERO };
const NO_FACE: Face = Face { normal: Vector::ZERO, offset: 0.0, first: 0, count: 0 };

/// A small polyhedron on the stack.
pub(super) struct Small {
    vertices: [Vector; 8],
    blocks: [Vector<F32x4>; 2],
    faces: [Face; 6],
    edge_blocks: [EdgeBlock; 3],
    face_blocks: [FaceBlock; 2],
    fans: (&'static [u32], &'static [u32]),
    loops: &'static [u32],
    edges: &'static [Edge],
    vertex_count: usize,
    face_count: usize,
    center: Vector,
    extent: f32,
    radius: f32,
}

impl Small {
    /// One point: the core of a ball.
    pub fn point(at: Vector, radius: f32) -> Self {
        let mut small = Self::bare(at, radius);
        small.fill_block();
        small
    }

    /// One point, whose block is not filled.
    #[inline(always)]
    fn bare(at: Vector, radius: f32) -> Self {
        Self {
            vertices: [at; 8],
            blocks: [Vector::ZERO; 2],
            faces: [NO_FACE; 6],
            edge_blocks: [EMPTY_EDGES; 3],
            face_blocks: [FaceBlock { normal: Vector::ZERO, offset: F32x4::ZERO }; 2],
            fans: (&[], &[]),
            loops: &[],
            edges: &[],
            vertex_count: 1,
            face_count: 0,
            center: at,
            extent: radius,
            radius,
        }
    }

    /// A box: a copy of the box of half extents 1 with other corners and offsets.
    pub fn cuboid(half: Vector) -> Self {
        let side = |bit: usize| if bit == 0 { -1.0 } else { 1.0 };
        let h = half.to_array();
        let wide = Vector::<F32x4>::splat(half);
        let stretched = |v: Vector<F32x4>| Vector { x: v.x * wide.x, y: v.y * wide.y, z: v.z * wide.z };
        let edges = |b: &EdgeBlock| EdgeBlock { tail: stretched(b.tail), ..*b };
        let [lower, upper] = &CUBE_CORNERS;
        let [first, second, third] = &CUBE_EDGE_BLOCKS;
        Self {
            vertices: core::array::from_fn(|i| {
                Vector { x: side(i & 1), y: side(i & 2), z: side(i & 4) }.scale(half)
            }),
            blocks: [stretched(*lower), stretched(*upper)],
            faces: core::array::from_fn(|i| Face {
                normal: Vector::AXES[i / 2] * side(i & 1),
                offset: h[i / 2],
                first: 4 * i as u32,
                count: 4,
            }),
            edge_blocks: [edges(first), edges(second), edges(third)],
            face_blocks: [
                FaceBlock { normal: CUBE_NORMALS[0], offset: F32x4::new([h[0], h[0], h[1], h[1]]) },
                FaceBlock { normal: CUBE_NORMALS[1], offset: wide.z },
            ],
            fans: (&CUBE_FANS, &CUBE_FAN_STARTS),
            loops: &CUBE_LOOPS,
            edges: &CUBE_EDGES,
            vertex_count: 8,
            face_count: 6,
            center: Vector::ZERO,
            extent: half.length(),
            radius: 0.0,
        }
    }

    /// A triangle as a flat hull with two faces; without area, its longest side.
    pub fn triangle(corners: [Vector; 3]) -> Self {
        let [a, b, c] = corners;
        let sides = [b - a, c - b, a - c];
        let Some(Facing { normal, scale: k }) = Facing::of(sides) else {
            let mut longest = 0;
            for i in 1..3 {
                if sides[i].abs().max_element() > sides[longest].abs().max_element() {
                    longest = i;
                }
            }
            return Self::segment(corners[longest], corners[(longest + 1) % 3], 0.0);
        };
        let mut small = Self::bare(a, 0.0);
        (small.vertices[1], small.vertices[2]) = (b, c);
        small.vertices[3] = c;
        small.vertex_count = 3;
        small.center = (a + b + c) * (1.0 / 3.0);
        small.extent = corners.iter().fold(0.0, |m, p| max(m, (*p - small.center).length()));
        let offset = normal.dot(small.center);
        small.faces[0] = Face { normal, offset, first: 0, count: 3 };
        small.faces[1] = Face { normal: -normal, offset: -offset, first: 3, count: 3 };
        small.face_count = 2;
        (small.loops, small.edges) = (&TRIANGLE_LOOPS, &TRIANGLE_EDGES);
        small.fans = (&TRIANGLE_FANS, &TRIANGLE_FAN_STARTS);
        let mut both = Vector::<F32x4>::splat(-normal);
        both.set(0, normal);
        small.face_blocks[0] =
            FaceBlock { normal: both, offset: F32x4::new([offset, -offset, -offset, -offset]) };
        let unit = sides.map(|s| (s * k) * (1.0 / max((s * k).length(), f32::MIN_POSITIVE)));
        small.fill_edges(unit, [[normal; 3], [-normal; 3]]);
        small.fill_block();
        small
    }

    /// A segment with a radius: an edge whose Gauss map is the great circle about it, as three arcs of 120°,
    /// like a thin prism. It has no faces.
    pub fn segment(a: Vector, b: Vector, radius: f32) -> Self {
        let along = b - a;
        let size = along.abs().max_element();
        if !(size > 0.0) {
            return Self::point(a, radius);
        }
        let unit = along * (1.0 / size);
        let unit = unit * (1.0 / unit.length());
        let mut small = Self::bare(a, radius);
        for v in &mut small.vertices[1..] {
            *v = b;
        }
        small.vertex_count = 2;
        small.center = (a + b) * 0.5;
        small.extent = 0.5 * along.length() + radius;
        small.edges = &SEGMENT_EDGES;
        let u = unit.any_orthonormal();
        let v = unit.cross(u);
        // cos 120° and sin 120°.
        let spokes = [u, u * -0.5 + v * 0.866_025_4, u * -0.5 - v * 0.866_025_4];
        small.fill_edges([unit; 3], [spokes, [spokes[1], spokes[2], spokes[0]]]);
        small.fill_block();
        small
    }

    /// Packs the vertices of a polyhedron with up to four. Vertices after the last repeat it.
    #[inline(always)]
    fn fill_block(&mut self) {
        self.blocks[0] = four([self.vertices[0], self.vertices[1], self.vertices[2], self.vertices[3]]);
    }

    /// Packs the edges of a polyhedron with three: their directions, and the normals on both sides.
    #[inline(always)]
    fn fill_edges(&mut self, directions: [Vector; 3], sides: [[Vector; 3]; 2]) {
        let tails = [0, 1, 2].map(|i: usize| self.vertices[self.edges[i].tail as usize]);
        let padded = |[a, b, c]: [Vector; 3]| four([a, b, c, c]);
        let [left, right] = sides.map(padded);
        self.edge_blocks[0] = EdgeBlock { direction: padded(directions), left, right, tail: padded(tails) };
    }

    /// The view of this polyhedron.
    pub fn view(&self) -> View<'_> {
        View {
            vertices: &self.vertices[..self.vertex_count],
            blocks: &self.blocks[..self.vertex_count.div_ceil(4)],
            faces: &self.faces[..self.face_count],
            loops: self.loops,
            edges: self.edges,
            edge_blocks: &self.edge_blocks[..self.edges.len().div_ceil(4)],
            face_blocks: &self.face_blocks[..self.face_count.div_ceil(4)],
            fans: self.fans,
            center: self.center,
            extent: self.extent,
            radius: self.radius,
        }
    }
}

/// Calls `f` with the polyhedral core of a shape, if it has one.
#[inline(always)]
pub(super) fn with_view<R>(shape: &Shape, f: impl FnOnce(Option<&View>) -> R) -> R {
    let small = match shape {
        Shape::Hull(hull) => return f(Some(&View::from(&**hull))),
        Shape::Cuboid(s) => Small::cuboid(s.half),
        Shape::Triangle(s) => Small::triangle([s.a, s.b, s.c]),
        Shape::Capsule(s) => Small::segment(s.a, s.b, s.radius),
        Shape::Segment(s) => Small::segment(s.a, s.b, 0.0),
        Shape::Ball(s) => Small::point(Vector::ZERO, s.radius),
        Shape::Composite(_) | Shape::Curved(_) | Shape::HalfSpace(_) | Shape::Foreign(_) => return f(None),
    };
    f(Some(&small.view()))
}

/// The normal and scale of a triangle.
pub(super) struct Facing {
    /// The unit normal, counter-clockwise from outside.
    pub normal: Vector,
    /// The inverse of the largest coordinate of its sides, in 1/m. Squares of sides scaled by it do not
    /// overflow.
    pub scale: f32,
}

impl Facing {
    /// For a triangle with the given consecutive sides; `None` without area.
    #[inline(always)]
    pub fn of(sides: [Vector; 3]) -> Option<Self> {
        let size = sides.iter().fold(0.0, |m, s| max(m, s.abs().max_element()));
        let scale = if size > 0.0 { 1.0 / size } else { 0.0 };
        let area = (sides[0] * scale).cross(sides[1] * scale);
        let twice_area = area.length();
        (twice_area > 1.0e-6).then(|| Self { normal: area * (1.0 / twice_area), scale })
    }
}

/// A pose with a rotation matrix, which is faster for several vectors.
#[derive(Clone, Copy)]
pub(super) struct MatrixPose {
    /// The axes of the inner frame.
    pub axes: [Vector; 3],
    /// The origin of the inner frame.
    pub position: Vector,
}

impl MatrixPose {
    #[inline]
    pub fn new(pose: &Pose) -> Self {
        Self { axes: pose.rotation.axes(), position: pose.position }
    }

    /// The pose of the outer frame in the inner frame.
    #[inline]
    pub fn inverse(&self) -> Self {
        let [x, y, z] = self.axes;
        let axes = [
            Vector { x: x.x, y: y.x, z: z.x },
            Vector { x: x.y, y: y.y, z: z.y },
            Vector { x: x.z, y: y.z, z: z.z },
        ];
        Self { axes, position: -self.direction_in(self.position) }
    }

    /// Rotates a direction to the outer frame.
    #[inline(always)]
    pub fn direction<N: Lane>(&self, v: Vector<N>) -> Vector<N> {
        let [x, y, z] = self.axes.map(Vector::<N>::splat);
        x * v.x + y * v.y + z * v.z
    }

    /// Transforms a point to the outer frame.
    #[inline(always)]
    pub fn point<N: Lane>(&self, v: Vector<N>) -> Vector<N> {
        self.direction(v) + Vector::<N>::splat(self.position)
    }

    /// Rotates a direction to the inner frame.
    #[inline(always)]
    pub fn direction_in<N: Lane>(&self, v: Vector<N>) -> Vector<N> {
        let [x, y, z] = self.axes.map(|axis| Vector::<N>::splat(axis).dot(v));
        Vector { x, y, z }
    }
}
