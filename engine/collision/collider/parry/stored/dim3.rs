//! Stored formats of 3D shapes. `dim2.rs` exports the same names.

#[cfg(test)]
#[path = "tests3d.rs"]
pub(super) mod tests;

use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{
    check::{Fault, check_heights, check_lengths, check_normals, check_points, round},
    piece::Piece,
};
use crate::{
    math::{Scalar, Vector},
    parry::{
        math::Rotation,
        shape::{
            Cone, ConvexPolyhedron, Cylinder, HeightField, HeightFieldCellStatus, HeightFieldFlags, Polyline,
            RoundShape, SharedShape, TypedShape,
        },
        utils::Array2,
    },
};

/// Whether a shape has its faces. Parry's hulls of needle-shaped point sets have no faces, and panic.
pub(super) fn has_faces(shape: &SharedShape) -> bool {
    match shape.as_typed_shape() {
        TypedShape::ConvexPolyhedron(hull) => !hull.faces().is_empty(),
        TypedShape::RoundConvexPolyhedron(round) => !round.inner_shape.faces().is_empty(),
        TypedShape::Compound(compound) => compound.shapes().iter().all(|(_, part)| has_faces(part)),
        _ => true,
    }
}

/// Stored format of a rotation: x, y, z, w of the quaternion.
pub(super) type StoredRotation = [Scalar; 4];

/// The stored format of a rotation.
pub(super) fn stored_rotation(rotation: Rotation) -> StoredRotation {
    rotation.to_array()
}

/// The rotation of a stored format.
pub(super) fn rotation(turn: StoredRotation) -> Rotation {
    Rotation::from_array(turn)
}

/// 3D polylines have no flags.
pub(super) fn polyline_flags(_: &Polyline) -> u8 {
    0
}

/// A polyline.
pub(super) fn polyline(vertices: Vec<Vector>, indices: Vec<[u32; 2]>, flags: u8) -> Result<Polyline, Fault> {
    if flags == 0 { Ok(Polyline::new(vertices, Some(indices))) } else { Err("a polyline has unknown flags") }
}

/// Stored format of a height field. Heights and cells are in column order.
#[derive(Serialize, Deserialize)]
#[serde(rename = "HeightField")]
pub(super) struct StoredHeights {
    rows: usize,
    columns: usize,
    heights: Vec<Scalar>,
    /// The bits of parry's `HeightFieldCellStatus`.
    cells: Vec<u8>,
    scale: Vector,
    /// The bits of parry's `HeightFieldFlags`.
    flags: u8,
}

impl StoredHeights {
    /// The stored format of a height field.
    pub fn of(field: &HeightField) -> Self {
        let heights = field.heights();
        Self {
            rows: heights.nrows(),
            columns: heights.ncols(),
            heights: heights.data().to_vec(),
            cells: field.cells_statuses().data().iter().map(|status| status.bits()).collect(),
            scale: field.scale(),
            flags: field.flags().bits(),
        }
    }

    /// The height field of a stored format.
    pub fn shape(self) -> Result<SharedShape, Fault> {
        let (rows, columns) = (self.rows, self.columns);
        if rows < 2 || columns < 2 || rows.checked_mul(columns) != Some(self.heights.len()) {
            return Err("a height field has other rows and columns than heights");
        }
        if (rows - 1) * (columns - 1) != self.cells.len() {
            return Err("a height field has other rows and columns than cells");
        }
        check_lengths([self.scale.x, self.scale.z])?;
        check_heights(&self.heights, self.scale.y)?;
        if self.scale.x == 0.0 || self.scale.z == 0.0 {
            return Err("a height field has no size");
        }
        let status = |bits: &u8| HeightFieldCellStatus::from_bits(*bits).ok_or("a cell has unknown flags");
        let cells = self.cells.iter().map(status).collect::<Result<Vec<_>, Fault>>()?;
        let flags = HeightFieldFlags::from_bits(self.flags).ok_or("a height field has unknown flags")?;
        let heights = Array2::new(rows, columns, self.heights);
        let mut field = HeightField::with_flags(heights, self.scale, flags);
        *field.cells_statuses_mut() = Array2::new(rows - 1, columns - 1, cells);
        Ok(SharedShape::new(field))
    }
}

/// Stored formats of shapes that only 3D has. The fields are parry's.
#[derive(Serialize, Deserialize)]
pub(super) enum StoredSpecial {
    Cylinder { half_height: Scalar, radius: Scalar },
    RoundCylinder { half_height: Scalar, radius: Scalar, border_radius: Scalar },
    Cone { half_height: Scalar, radius: Scalar },
    RoundCone { half_height: Scalar, radius: Scalar, border_radius: Scalar },
    ConvexPolyhedron(StoredHull),
    RoundConvexPolyhedron { hull: StoredHull, border_radius: Scalar },
}

impl StoredSpecial {
    /// The stored format of a shape.
    pub fn of(shape: TypedShape<'_>) -> Result<Self, Fault> {
        Ok(match shape {
            TypedShape::Cylinder(&Cylinder { half_height, radius }) => Self::Cylinder { half_height, radius },
            TypedShape::RoundCylinder(&RoundShape { inner_shape: shape, border_radius }) => {
                Self::RoundCylinder { half_height: shape.half_height, radius: shape.radius, border_radius }
            }
            TypedShape::Cone(&Cone { half_height, radius }) => Self::Cone { half_height, radius },
            TypedShape::RoundCone(&RoundShape { inner_shape: shape, border_radius }) => {
                Self::RoundCone { half_height: shape.half_height, radius: shape.radius, border_radius }
            }
            TypedShape::ConvexPolyhedron(hull) => Self::ConvexPolyhedron(StoredHull(hull.clone())),
            TypedShape::RoundConvexPolyhedron(RoundShape { inner_shape, border_radius }) => {
                Self::RoundConvexPolyhedron {
                    hull: StoredHull(inner_shape.clone()),
                    border_radius: *border_radius,
                }
            }
            _ => return Err("a shape of a type of the app's own cannot be stored"),
        })
    }

    /// The shape of a stored format.
    pub fn shape(self) -> Result<SharedShape, Fault> {
        Ok(match self {
            Self::Cylinder { half_height, radius } => {
                check_lengths([half_height, radius])?;
                SharedShape::new(Cylinder { half_height, radius })
            }
            Self::RoundCylinder { half_height, radius, border_radius } => {
                check_lengths([half_height, radius])?;
                round(Cylinder { half_height, radius }, border_radius, SharedShape::new)?
            }
            Self::Cone { half_height, radius } => {
                check_lengths([half_height, radius])?;
                SharedShape::new(Cone { half_height, radius })
            }
            Self::RoundCone { half_height, radius, border_radius } => {
                check_lengths([half_height, radius])?;
                round(Cone { half_height, radius }, border_radius, SharedShape::new)?
            }
            Self::ConvexPolyhedron(hull) => SharedShape::new(hull.0),
            Self::RoundConvexPolyhedron { hull, border_radius } => {
                round(hull.0, border_radius, SharedShape::new)?
            }
        })
    }
}

/// A convex polyhedron, stored with parry's names.
pub(super) struct StoredHull(ConvexPolyhedron);

impl Serialize for StoredHull {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        self.0.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for StoredHull {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let fields = HullFields::deserialize(deserializer)?;
        let hull = fields.check().and_then(|()| fields.pieces().build());
        hull.map(Self).map_err(serde::de::Error::custom)
    }
}

/// The fields of parry's polyhedron, in its order and with its names.
#[derive(Deserialize)]
#[serde(rename = "ConvexPolyhedron")]
struct HullFields {
    points: Vec<Vector>,
    vertices: Vec<VertexFields>,
    faces: Vec<FaceFields>,
    edges: Vec<EdgeFields>,
    faces_adj_to_vertex: Vec<u32>,
    edges_adj_to_vertex: Vec<u32>,
    edges_adj_to_face: Vec<u32>,
    vertices_adj_to_face: Vec<u32>,
}

/// The neighbours of a vertex.
#[derive(Deserialize)]
#[serde(rename = "Vertex")]
struct VertexFields {
    first_adj_face_or_edge: u32,
    num_adj_faces_or_edge: u32,
}

/// The edges of a face.
#[derive(Deserialize)]
#[serde(rename = "Face")]
struct FaceFields {
    first_vertex_or_edge: u32,
    num_vertices_or_edges: u32,
    normal: Vector,
}

/// The ends and sides of an edge.
#[derive(Deserialize)]
#[serde(rename = "Edge")]
struct EdgeFields {
    vertices: [u32; 2],
    faces: [u32; 2],
    dir: Vector,
    deleted: bool,
}

impl HullFields {
    /// Whether all indices exist and all numbers are finite, which parry assumes.
    fn check(&self) -> Result<(), Fault> {
        if self.points.len() < 4 || self.faces.len() < 4 || self.vertices.len() != self.points.len() {
            return Err("a hull has too few points or faces");
        }
        check_points(&self.points)?;
        check_normals(&self.edges.iter().map(|edge| edge.dir).collect::<Vec<_>>())?;
        check_normals(&self.faces.iter().map(|face| face.normal).collect::<Vec<_>>())?;
        let below = |indices: &[u32], count: usize| indices.iter().all(|i| (*i as usize) < count);
        let within = |first: u32, count: u32, list: &[u32]| {
            first.checked_add(count).is_some_and(|end| end as usize <= list.len())
        };
        let (points, faces, edges) = (self.points.len(), self.faces.len(), self.edges.len());
        let lists = below(&self.faces_adj_to_vertex, faces)
            && below(&self.edges_adj_to_vertex, edges)
            && below(&self.edges_adj_to_face, edges)
            && below(&self.vertices_adj_to_face, points)
            && self.faces_adj_to_vertex.len() == self.edges_adj_to_vertex.len()
            && self.vertices_adj_to_face.len() == self.edges_adj_to_face.len();
        let around_vertices = self.vertices.iter().all(|v| {
            let list = &self.faces_adj_to_vertex;
            within(v.first_adj_face_or_edge, v.num_adj_faces_or_edge, list)
        });
        let around_faces = self.faces.iter().all(|f| {
            let list = &self.vertices_adj_to_face;
            f.num_vertices_or_edges >= 3 && within(f.first_vertex_or_edge, f.num_vertices_or_edges, list)
        });
        let at_edges =
            self.edges.iter().all(|edge| below(&edge.vertices, points) && below(&edge.faces, faces));
        if lists && around_vertices && around_faces && at_edges {
            Ok(())
        } else {
            Err("a hull has an index out of range")
        }
    }

    fn pieces(&self) -> Piece {
        let indices = |list: &[u32]| Piece::list(list, |i| Piece::Index(*i));
        let vertex = |v: &VertexFields| indices(&[v.first_adj_face_or_edge, v.num_adj_faces_or_edge]);
        let face = |f: &FaceFields| {
            let [first, count] = [f.first_vertex_or_edge, f.num_vertices_or_edges].map(Piece::Index);
            Piece::List(vec![first, count, Piece::vector(f.normal)])
        };
        let edge = |e: &EdgeFields| {
            let (vertices, faces) = (indices(&e.vertices), indices(&e.faces));
            Piece::List(vec![vertices, faces, Piece::vector(e.dir), Piece::Flag(e.deleted)])
        };
        Piece::List(vec![
            Piece::vectors(&self.points),
            Piece::list(&self.vertices, vertex),
            Piece::list(&self.faces, face),
            Piece::list(&self.edges, edge),
            indices(&self.faces_adj_to_vertex),
            indices(&self.edges_adj_to_vertex),
            indices(&self.edges_adj_to_face),
            indices(&self.vertices_adj_to_face),
        ])
    }
}
